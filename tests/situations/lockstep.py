"""Lock-step: commands that are none, an engine that goes away, and what it can be told from the answers."""

from __future__ import annotations

import os
import subprocess

from helpers.counted import DEADLINE_S, Done, Lab
from situations import situation


@situation
def commands_that_are_none(lab: Lab) -> None:
    unknown = "lock-step: unknown command `{}`; there are `step SECONDS` and `stop REASON`"
    for line, said in (
        ("step", unknown.format("step")),
        ("go", unknown.format("go")),
        ("", unknown.format("")),
        ("x" * 2000, "lock-step: unknown command `xxx"),
        ("x" * 5000, "lock-step: unknown command `xxx"),
        *(
            (f"step {t}", f"lock-step: `step {t}` has no time in seconds")
            for t in ("", "soon", "1 2", "inf", "nan", "1s")
        ),
    ):  # fmt: skip
        done = lab.run("odd.deployed", "--lockstep", stdin=line + "\n").stopped(2, said)
        assert done.out == f"stopped {done.error}\n"


@situation
def told_to_stop(lab: Lab) -> None:
    for line, reason in (
        ("stop", "told to stop"),
        ("stop a wall is near", "a wall is near"),
        ("stop ", ""),
    ):
        done = lab.run("rivet", "--lockstep", stdin=f"step 0\n{line}\n")
        assert (done.code, done.error) == (3, reason)
        first, last = done.out.splitlines()
        assert (
            first.startswith("idle ")
            and first.endswith(" running 120")
            and last == f"stopped {reason}"
        )
        assert (done.shared / "supervisor.status").read_text().splitlines()[::2] == [
            "stopped",
            reason,
        ]


@situation
def the_engine_has_gone(lab: Lab) -> None:
    for said in ("", "step 0\n", "step 0\nstep"):
        done = lab.run("rivet", "--lockstep", stdin=said).stopped(
            130, "the engine has gone (end of input)"
        )
        assert done.out.endswith("stopped the engine has gone (end of input)\n")
    # What cannot be read at all is no command, and nobody waits for it.
    folder = lab.fresh()
    descriptor = os.open(folder, os.O_RDONLY)
    done_ = subprocess.run(
        [lab.program("rivet"), "--lockstep", "--dir", folder / "shared", "--input", folder], stdin=descriptor,
        capture_output=True, text=True, timeout=DEADLINE_S, check=False,
    )  # fmt: skip
    os.close(descriptor)
    assert done_.returncode == 130 and "the engine has gone (end of input)" in done_.stderr


@situation
def signals_in_lockstep(lab: Lab) -> None:
    for n in (1, 2):
        done = lab.run(
            "rivet", "--lockstep", stdin="step 0\nstep 1\nstep 2\n", failing=f"ppoll:{n}:!15"
        )
        done.stopped(130, "interrupted by signal 15")
        assert done.out.endswith("stopped interrupted by signal 15\n")
    lab.run("odd", "--lockstep", stdin="step 0\n", failing="read@pipe:1:4").finished()
    folder = lab.fresh()
    with lab.started("rivet", folder, lockstep=True, failing="ppoll:2:!2") as supervisor:
        assert supervisor.step(0.0).fired == 3, "then it waits for a command"
        end = supervisor.wait(DEADLINE_S)
    Done(end.code, "", end.stderr, folder / "shared").stopped(130, "interrupted by signal 2")


@situation
def nothing_can_be_opened(lab: Lab) -> None:
    done = lab.run("rivet", "--lockstep", stdin="step 0\n", failing="mkdir:1:13")
    assert done.code == 5 and done.out == f"stopped {done.error}\n"
    assert done.error == f"cannot open the shared directory {done.shared}: Permission denied"


@situation
def a_clock_of_its_own(lab: Lab) -> None:
    """Time is what the engine says; it does not go back, and a late answer is late by it."""
    done = lab.run(
        "rivet",
        "--lockstep",
        "--reply-timeout",
        "10",
        stdin="step 5\nstep 3\nstep 15\nstep 16\nstep 16\n",
    )
    done.stopped(
        3, "has not answered flag", " for 10 s; it has not announced itself at all: is it running?"
    )
    assert [line.split()[-1] for line in done.out.splitlines()[:4]] == ["15"] * 4, (
        "answers are read first"
    )
    done = lab.run("rivet", "--lockstep", "--reply-timeout", "0", stdin="step 0\nstep 1e9\n")
    assert [line.split()[-1] for line in done.out.splitlines()[:2]] == ["inf", "inf"]
