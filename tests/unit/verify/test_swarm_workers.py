"""Workers of a swarm that are not there or cannot carry out a search, and options that do not go together."""

from __future__ import annotations

import importlib.util
import os
from pathlib import Path

import pytest
import typer

from pn2code.cli.options import Exit, code_of
from pn2code.cli.verify_swarm import check_options, endings
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.properties import meaning as m
from pn2code.toolchain.kept_files import digest_of_runtime
from pn2code.toolchain.programs import Host
from pn2code.verify.exploring.limits import Reduction
from pn2code.verify.swarm import task
from pn2code.verify.swarm.cluster import Cluster
from pn2code.verify.swarm.task import Job

HOST = Host("explore")


def test_without_the_package_it_is_said_what_to_type(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    d = Diagnostics()
    with Cluster(1) as pool:
        assert not pool.start(d)
    assert [e.code for e in d.errors] == ["swarm-unavailable"]
    assert d.errors[0].hint == "`pip install 'pn2code[swarm]'` brings it"
    assert code_of(d) == Exit.USAGE


def test_a_worker_of_another_version_refuses() -> None:
    said = task.run(Job("one", HOST, (), "another runtime"), 0, ())
    assert said == {"said": None, "problem": "the worker has another version of pn2code"}


def job(name: str, folder: Path, script: str) -> Job:
    """A job whose explorer is a script."""
    program = folder / "explore"
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    runtime = digest_of_runtime(HOST.runtime())
    return Job(name, HOST, (), runtime, str(program), ("--arena", "1"), "? q", str(folder))


def test_what_an_explorer_says_comes_with_its_runs(tmp_path: Path) -> None:
    """Of the folder in which it has worked nothing is left."""
    script = (
        'while [ "$1" != --query-trace-to ]; do shift; done; echo run >"$2"3.trace.jsonl; echo "{}"'
    )
    found = task.run(job("two", tmp_path, script), 5, ("--swarm", "6"))
    assert found == {"said": {}, "files": {"query-3.trace.jsonl": b"run\n"}}
    assert os.listdir(tmp_path) == ["explore"]  # noqa: PTH208


@pytest.mark.parametrize(
    ("script", "problem"),
    [
        ("echo no room >&2; exit 2", "the explorer ended without a report; no room"),
        ("kill -9 $$", "the explorer ended by signal 9"),
    ],
)
def test_an_explorer_without_a_report(tmp_path: Path, script: str, problem: str) -> None:
    assert task.run(job("three", tmp_path, script), 0, ()) == {"said": None, "problem": problem}


def test_what_is_not_wanted_any_more_does_not_begin(tmp_path: Path) -> None:
    own = job("four", tmp_path, "echo '{}'")
    task.end("four", 3, gently=True)
    task.end("four", 5, gently=True)
    nothing = {"said": None, "problem": ""}
    assert [task.run(own, i, ())["said"] for i in (0, 2)] == [{}, {}]
    assert [task.run(own, i, ()) for i in (3, 4, 9)] == [nothing] * 3


def test_options_that_do_not_go_together() -> None:
    check_options(None, None, None, (Reduction.SYMMETRY,), (("--order", True),))
    check_options(4, None, 2, (Reduction.TIME,), (("--order", False),))
    for given in (
        (None, "tcp://host:1", None, (), ()),
        (None, None, 2, (), ()),
        (4, "tcp://host:1", 2, (), ()),
        (4, None, None, (Reduction.PARTIAL_ORDER,), ()),
        (4, None, None, (), (("--spill", True),)),
    ):
        with pytest.raises(typer.BadParameter):
            check_options(*given)


def test_what_ends_a_swarm() -> None:
    """Properties that a marking violates; not what is reachable, unless it is expected not to be."""
    dead = m.Invariant(m.negation(m.DEAD))
    reachable = m.Invariant(m.negation(m.DEAD), wanted=False)
    asked = (
        *((dead, True), (dead, False), (reachable, True), (reachable, False)),
        *((m.Bound(0, None, 3), True), (m.Branching(m.DEAD), True)),
    )
    properties = tuple(
        m.Property(f"p{i}", "", "", "ctl", expect, what, (), Origin("net"))
        for i, (what, expect) in enumerate(asked)
    )
    assert endings(m.Properties(properties=properties)) == (0, 3, 4)
