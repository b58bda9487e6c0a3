"""Explorations that tests share: those that would have the same answer, and no others."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from helpers.explorations import LARGE, Cached
from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.meanwhile import Meanwhile

NET = flat("net n\n  standard\n  page P\n    place A = 1\n")
BOUND = {
    "lower_multiset": [[1, 7]],
    "lower_colours": 1,
    "upper_multiset": [[2, 7]] * 3,
    "upper_colours": 3,
}
FOUND = {
    "complete": True,
    "error": None,
    "nodes": LARGE,
    "bounds": [BOUND],
    "seconds": 5.0,
    "threads": 2,
}
Ask = Callable[..., int]


@pytest.fixture
def ask(tmp_path: Path) -> Ask:
    """How often it was really explored so far."""
    calls: list[list[str]] = []

    def asked(
        *options: str,
        program: str = "explore-1",
        questions: str = "",
        found: dict[str, Any] = FOUND,
        limits: Limits | None = None,
        search: Meanwhile | None = None,
        makes: str = "",
    ) -> int:
        table = tmp_path / f"table-{len(list(tmp_path.iterdir()))}"
        table.write_text(questions)

        def run(_net: object, _program: object, options: list[str], *_: object) -> dict[str, Any]:
            calls.append(options)
            if makes:
                (tmp_path / makes).touch()
            return found

        given = [*options, "--queries", str(table), "--progress"]
        said = Cached(run, tmp_path)(
            NET, Path(program), given, ExploreOptions(), limits or Limits(), Diagnostics(), search
        )
        assert said == found
        return len(calls)

    return asked


@pytest.mark.parametrize(
    "again",
    [
        (),
        ("--memory", "5", "--parent", "7", "--progress-every", "0.5"),
        ("--max-states", str(LARGE + 1)),
        ("--multiset-limit", "3"),
        ("--multiset-limit", "2", "--whole", "0"),
    ],
)
def test_what_would_be_the_same_is_not_explored_again(ask: Ask, again: tuple[str, ...]) -> None:
    whole = again[2:] if "--whole" in again else ()
    assert ask("--memory", "4", "--parent", "6", "--max-states", "900000", *whole) == 1
    assert ask(*again) == 1
    assert ask(*again, limits=Limits(processor_seconds=10.0)) == 1


@pytest.mark.parametrize(
    "again",
    [
        {"program": "explore-2"},
        {"questions": "another"},
        {"limits": Limits(memory=100)},
        {"limits": Limits(processor_seconds=9.9)},
        {"search": Meanwhile(NET, {}, None, is_limited=False)},
        *({"options": o} for o in (
            ["--threads", "2"], ["--reduce", "time"], ["--no-graph"], ["--whole", "0"], ["--max-seconds", "9"],
            ["--max-states", str(LARGE)], ["--multiset-limit", "2"], ["--write-graph", "g"],
        )),
    ],
)  # fmt: skip
def test_anything_else_is(ask: Ask, again: dict[str, Any]) -> None:
    options = again.pop("options", ())
    assert ask() == 1
    assert ask(*options, **again) == 2


@pytest.mark.parametrize(
    "found",
    [
        {"nodes": LARGE - 1},
        {"complete": False},
        {"error": {"kind": "capacity"}},
        {"bounds": [{**BOUND, "upper_colours": 4}]},
    ],
)
def test_what_is_small_or_left_something_out_is_not_kept(ask: Ask, found: dict[str, Any]) -> None:
    assert [ask(found={**FOUND, **found}) for _ in range(2)] == [1, 2]


def test_what_has_written_a_run_is_not_kept(ask: Ask, tmp_path: Path) -> None:
    option = ("--trace-to", str(tmp_path / "net.dead-"))
    assert [ask(*option, makes=f"net.dead-{n}.jsonl") for n in range(2)] == [1, 2]


def test_who_else_wants_it_reads_it(ask: Ask, tmp_path: Path) -> None:
    ask()
    (kept,) = [f for f in tmp_path.iterdir() if f.stat().st_size > 100]
    kept.write_text(json.dumps({**FOUND, "nodes": LARGE + 5}))
    assert ask(found={**FOUND, "nodes": LARGE + 5}) == 1
