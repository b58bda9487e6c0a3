"""What `verify` said of a cell, held against runs of its programs."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

from tools.adversary.cells import Cell
from tools.adversary.claims import Claim, Moment
from tools.adversary.wander import Built, Run
from typer.testing import CliRunner

from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.input_files import begin
from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.marking import BindingElement, PlaceMarking
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.colour_json import from_json


@dataclass(frozen=True)
class Said:
    """The answers of `verify --json`: of each check and of each claim, and the bounds that it gives."""

    code: int
    controller: Mapping[str, Mapping[str, Any]]
    channel_model: tuple[Mapping[str, Any], ...]
    claims: tuple[str, ...]
    whole: Mapping[str, Any]


def ways(r: Random, *, is_timed: bool) -> list[str]:
    """How `verify` goes about it: mostly as it does by itself; else reduced, approximately, or not to the end."""
    how = r.random()
    if how < 0.5:
        return []
    if how < 0.65:
        return ["--max-states", str(r.choice([5, 30, 100, 400]))]
    if how < 0.7:
        return ["--approximate", r.choice(["bitstate", "hash"])]
    kinds = ["partial-order", "symmetry", *(["time"] if is_timed else [])]
    return [x for kind in r.sample(kinds, r.randint(1, 2)) for x in ("--reduce", kind)]


MOST_STATES = 300_000
"""Of a cell that grows for ever. Not seconds: the same cell gets the same answers on every machine, busy or not."""


def ask(folder: Path, cell: Cell, how: Sequence[str] = ()) -> Said | str:
    """Asks, with more options; a text when nothing was answered."""
    options = [x for c in cell.claims for x in ("--property", c.text)]
    if "--max-states" not in how:
        options += ["--max-states", str(MOST_STATES)]
    traces = folder / "traces"
    traces.mkdir(exist_ok=True)
    done = CliRunner().invoke(
        app,
        [
            "verify",
            str(folder),
            "--json",
            "--traces",
            str(traces),
            *how,
            *options,
        ],
    )
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    try:
        found = json.loads(done.stdout)
    except ValueError:
        return f"exit code {done.exit_code}: {done.stdout[-300:]}{done.stderr[-700:]}"
    return Said(
        done.exit_code,
        {c["check"]: c for c in found.get("controller", ())},
        tuple(found.get("medium", ())),
        tuple(p["answer"] for p in found["properties"]),
        found,
    )


def begun(built: Built) -> Mapping[str, PlaceMarking]:
    """What the places of input files begin with, by name."""
    partition, config = built.generated.partition, built.generated.config
    assert config is not None
    d = Diagnostics()
    found = begin(partition.net, config, d)
    assert not d.errors, [e.message for e in d.errors]
    initial = Game(found.net, config.storage).own_initial_marking
    return {g.name: initial.places[g.place] for g in found.given}


def markings(
    net: FlatNet, run: Run, initial: Mapping[str, PlaceMarking], storage: Mapping[str, str]
) -> list[Moment] | str:
    """The moments after each occurrence; a text when one was not possible.

    What a script announces just before it stops may be what no token can come of: that is no occurrence.
    """
    game = Game(net, storage, initial=initial)
    found = [_moment(game)]
    names = {t.name: t for t in net.transitions}
    for line in run.record.events:
        if "transition" not in line:
            continue
        t = names[line["transition"]]
        outputs = t.code.outputs if t.code else ()
        given: dict[Symbol, Any] = {
            s: from_json(s.colset, line["binding"][s.name])
            for s in t.variables
            if s not in outputs and s.colset is not None
        }
        element = BindingElement.make(t, given)
        if net.timed:
            game.set_time(
                max(game.marking.time, line["t"] + 1e-6)
            )  # rounded as the supervisor does
        why = game.why_disabled(game.marking, element, priorities=False)
        if why is not None:
            return f"{t.name}: {why}"
        try:
            game.marking, _ = game.occur(game.marking, element)
        except GameError as error:
            is_last = run.end != "finished" and line is run.record.events[-1]
            return found if is_last else f"{t.name}: {error}"
        found.append(_moment(game, t.name))
    return found


def _moment(game: Game, fired: str = "") -> Moment:
    held = {p.name: m for p, m in zip(game.net.places, game.marking.places, strict=True)}
    return Moment({name: len(m) for name, m in held.items()}, fired, held)


def contradictions(cell: Cell, said: Said, runs: Sequence[Run], built: Built) -> Iterator[str]:
    """Each thing that was said and is not so."""
    net, initial = built.generated.partition.net, begun(built)
    config = built.generated.config
    assert config is not None
    told: set[str] = set()
    for i, run in enumerate(runs):
        for text in _of_run(cell, said, run, markings(net, run, initial, config.storage)):
            if text not in told:
                yield f"run {i} ({run.end} {run.why}): {text}"
            told.add(text)
    ends = [r.end for r in runs if r.end != "crashed"]
    if not cell.has_sensors and _answer(said, "non-blocking") == "yes" and set(ends) == {"endless"}:
        yield "non-blocking is yes, but no run comes to an end"


def _answer(said: Said, check: str) -> str:
    return str(said.controller[check]["answer"]) if check in said.controller else ""


def _of_run(cell: Cell, said: Said, run: Run, found: list[Moment] | str) -> Iterator[str]:
    if isinstance(found, str):
        yield f"the run is none of the net: {found}"
        return
    is_over = run.end in ("finished", "stuck")
    for claim, answer in zip(cell.claims, said.claims, strict=True):
        at = claim.broken(found, is_over=is_over) if answer == claim.answer else None
        if at is not None:
            yield f"`{claim.text}` is {answer}, but not after {at} steps"
    if _answer(said, "capacity") == "yes":
        for claim in cell.capacities:
            if claim.broken(found, is_over=is_over) is not None:
                yield f"capacity is yes, but {claim.places[0]} holds more than {claim.most} tokens"
    whole = [m["answer"] for m in said.channel_model[:1]]
    # A script may stop by itself before anybody notices; only where non-blocking is yes that may not be.
    is_own = _SCRIPT.search(run.why) and _answer(said, "non-blocking") != "yes"
    # One that has been killed may have said before that it has finished: then it owes what it never will answer.
    said_so = ("died", "dead", "ended", "gone", "has not answered", "owes an answer")
    is_said = any(w in run.why for w in said_so)
    if run.end == "crashed" and not (is_own or is_said):
        yield "a side died, but nobody says so"
    if run.end == "stuck":
        if _answer(said, "non-blocking") == "yes":
            yield "non-blocking is yes"
        if whole == ["yes"]:
            yield "the cell with its medium is yes"
    if run.end == "stopped":
        broken = _whose(run.why)
        if _answer(said, broken) == "yes":
            yield f"{broken} is yes, but the cell was stopped"
        if whole == ["yes"]:
            yield "the cell with its medium is yes"
    most = said.controller.get("bounded-response", {})
    if most.get("answer") == "yes" and run.most_firings > most["value"]:
        yield f"at most {most['value']} firings in a cycle, but there were {run.most_firings}"
    yield from _bounds(said, found)


_SCRIPT = re.compile(r"^\w+\.tdl:\d+: ")
"""A reason that a script gives by itself: `dev1.tdl:46: dev1: nothing can happen`."""
_CHECKS = {
    "would be overwritten": "channels",
    "overrun": "channels",
    "no end of firing": "finite-response",
    "is full": "capacity",
    "memory": "memory",
}
"""What a stop says, and the check that is about it; `non-blocking` is about all others."""


def _whose(why: str) -> str:
    return next((check for words, check in _CHECKS.items() if words in why), "non-blocking")


def _bounds(said: Said, found: Sequence[Moment]) -> Iterator[str]:
    """The numbers of tokens that places can have in the cell as it runs."""
    for row in said.whole.get("cell", {}).get("bounds") or []:
        place, held = row["place"], [at.tokens[row["place"]] for at in found]
        if max(held) > row["upper"]:
            yield f"at most {row['upper']} tokens in {place}, but there were {max(held)}"
        if min(held) < row["lower"]:
            yield f"at least {row['lower']} tokens in {place}, but there were {min(held)}"


def claims_text(claims: Sequence[Claim]) -> str:
    """For a report."""
    return "\n".join(c.text for c in claims)
