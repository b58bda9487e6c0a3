"""Random walks: a net compiled to C and the token game side by side, as many steps as asked for or as time allows.

The compiled `walk` (cnative/tests/walk.c) chooses; before each step its enabled binding elements, in order, its model
time and its marking must be those of the token game, and an error of the net must come up in both. A run that comes to
a dead marking or to an error is followed by another one from the initial marking, with the next seed, until there
are enough steps.
"""

from __future__ import annotations

import json
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from helpers.compiled import Comparison, Workshop, lowered
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.net.front import load
from pn2code.semantics.game.token_game import Game, GameError

ROOMS = (0, 4096, 65536)
"""Different tokens that a place can hold, tried one after the other; 0: as many as a supervisor has."""

RUNS = 200
"""Most runs of a net."""

WITHOUT_STEP = 5
"""Runs in which nothing at all occurs, after which a net is left alone."""


@dataclass(frozen=True, slots=True)
class Walk:
    """What became of a net.

    Args:
        net: its path below the collection.
        verdict: "agrees", "differs", "rejected" (by the front end), "unsupported" (by the compiler).
        steps: occurrences that were equal, of all runs together.
        end: why it ended: "steps", "time", or, if no more runs were made, how the last one ended: "dead",
            "error" (of the net, in both).
        detail: what differs, or the error.
        runs: how many there were.
    """

    net: str
    verdict: str
    steps: int = 0
    end: str = ""
    detail: str = ""
    runs: int = 0

    def as_json(self) -> dict[str, Any]:
        """For a file of results."""
        return asdict(self)


def nets(shared: Path) -> list[Path]:
    """All nets of the collections."""
    found = [*(shared / "corpus" / "nets").rglob("*.cpn")]
    found += (shared / "semantics-suite").rglob("*.cpn")
    return sorted(found)


def walk(
    path: Path,
    name: str,
    workshop: Workshop,
    *,
    steps: int,
    seed: int = 1,
    seconds: float = 60.0,
    runs: int = RUNS,
) -> Walk:
    """Compile a net and walk through it, in no more than so many runs and, about, so many seconds of the processor."""
    d = Diagnostics()
    flat = load(path, d)
    if flat is None:
        codes = ", ".join(sorted({e.code for e in d.errors}))
        return Walk(name, "rejected", detail=codes)
    result = Walk(name, "differs")
    for room in ROOMS:
        capacity = {p.name: room for p in flat.places} if room else None
        net, d = lowered(flat, capacity=capacity)
        if net is None:
            first = d.errors[0]
            where = f"{first.code}: {first.message} ({first.origin.describe()})"
            return Walk(name, "unsupported", detail=where)
        try:
            program = workshop.build(net, workshop.folder / name.replace("/", "_"))
        except AssertionError as failure:
            return Walk(name, "differs", detail=f"not compiled: {str(failure)[:2000]}")
        until = time.process_time() + seconds
        result = _runs(flat, name, program, steps=steps, seed=seed, until=until, runs=runs)
        if "place is full" not in result.detail:
            break
    return result


def _runs(
    flat: FlatNet, name: str, program: Path, *, steps: int, seed: int, until: float, runs: int
) -> Walk:
    """One run after the other, until there are enough steps."""
    done = empty = 0
    run = Walk(name, "agrees", end="time")
    for number in range(runs):
        with _lines(program, seed + number, steps - done) as lines:
            run = _follow(flat, name, lines, steps=steps - done, seed=seed + number, until=until)
        done += run.steps
        empty = empty + 1 if run.steps == 0 else 0
        run = replace(run, steps=done, runs=number + 1)
        if run.verdict != "agrees" or run.end not in ("dead", "error") or done == steps:
            break
        if empty == WITHOUT_STEP or time.process_time() > until:
            break
    return replace(run, end="steps") if run.verdict == "agrees" and done == steps else run


@contextmanager
def _lines(program: Path, seed: int, steps: int) -> Iterator[Iterator[dict[str, Any]]]:
    """The lines of a walking program, read while it runs."""
    process = subprocess.Popen(
        [str(program), str(seed), str(steps)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="latin-1",
    )
    assert process.stdout is not None and process.stderr is not None
    try:
        yield map(json.loads, process.stdout)
    finally:
        process.kill()
        process.communicate()


def _follow(
    flat: FlatNet,
    name: str,
    lines: Iterator[dict[str, Any]],
    *,
    steps: int,
    seed: int,
    until: float,
) -> Walk:
    done = 0
    line: dict[str, Any] = {}
    failure = ""
    game: Game | None = None
    try:
        game = Game(flat, seed=seed)
    except GameError as error:
        failure = str(error)
    compare = Comparison(game) if game is not None else None
    for line in lines:
        if game is None or compare is None:
            break
        try:
            game.marking = game.advance_time(game.marking)
            enabled = game.enabled()
        except GameError as error:
            failure = str(error)
            break
        if "error" in line:
            break
        try:
            compare.step(enabled, line, done)
        except AssertionError as different:
            return Walk(name, "differs", done, detail=str(different)[:2000])
        if line["chosen"] < 0:
            return Walk(name, "agrees", done, "dead")
        if done == steps:
            return Walk(name, "agrees", done, "steps")
        if time.process_time() > until:
            return Walk(name, "agrees", done, "time")
        try:
            game.fire(enabled[line["chosen"]], checked=False)
        except GameError as error:
            failure = str(error)
            line = next(lines, {})
            break
        done += 1
    else:
        return Walk(name, "differs", done, detail="the program ended too early")
    if failure and "error" in line:
        return Walk(name, "agrees", done, "error", failure)
    if failure:
        return Walk(name, "differs", done, detail=f"only the token game fails: {failure}")
    return Walk(name, "differs", done, detail=f"only the compiled net fails: {line}")
