"""One random cell: what turns say of it, held against the whole space, in several ways.

* *the net of turns*: looked at in turns, and as a whole. If the former has no cycle the latter has none; it has as many
  dead states, each place holds the same, the same transitions occur, the same needs memory, an exception is raised in
  both or in none, and what is asked about single places, groups and orders has the same answers.
* *limits*: the states in which tokens are counted up to a limit stand for all markings: whatever occurs, or is held, in
  these does so in those, and what is said of those is true of these.
* *the checks of the supervisor*: with turns and without, wherever turns say anything; and with limits, which tell what
  is so of random properties as well (`asked`).
* *the medium*: the same; and what the cell as it runs says of its files (`files`).
* *the closed net*: what is said of it where its tokens are counted up to a limit (`closed`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random
from typing import Any

from tools.adversary.cells import random_cell as adversary_cell
from tools.reduction_cells import asked, closed, files
from tools.reduction_cells.flows import flow
from tools.reduction_cells.limited import Limited
from tools.reduction_cells.mutants import MUTANTS, NO_GROUPS, RASH
from tools.reduction_cells.numbered import counters
from tools.reduction_cells.peers import peers
from tools.reduction_cells.registers import registers
from tools.reduction_cells.shops import shop
from tools.reduction_cells.stations import stations
from tools.reduction_cells.talks import talks

from helpers.netbuilder import cpn
from helpers.random_cells import random_cell
from pn2code.arms import Arms
from pn2code.cell.divide import divide
from pn2code.cell.partition import Partition
from pn2code.channel_model import check as medium
from pn2code.channel_model.rules import Rules
from pn2code.cli.nets import open_net
from pn2code.diagnostics import Diagnostics
from pn2code.properties import meaning as m
from pn2code.verdict.opened import OpenNet
from pn2code.verify.controller import by_turns, control, control_questions
from pn2code.verify.controller.control_types import Control, Plan
from pn2code.verify.controller.not_modelled import NotModelledError
from pn2code.verify.controller.premises import Premises
from pn2code.verify.controller.running import Running
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.programs import Generated, Sizes
from pn2code.verify.exploring.result import Bounds, Exploration
from pn2code.verify.exploring.turns import Turns

NONE = m.Properties()
MOST = 40_000
"""States of a cell; larger ones are left out."""
MADE: Mapping[str, Callable[[Random], tuple[str, str]]] = {
    "shops": shop,
    "peers": peers,
    "stations": stations,
    "talks": talks,
    "registers": registers,
    "counters": counters,
}


@dataclass(frozen=True)
class Verdict:
    """What came of a cell: what is wrong, which mutants it shows, and counts."""

    wrong: tuple[str, ...]
    shown: frozenset[str]
    counts: Counter[str]


def make(seed: int, folder: Path, family: str = "mixed") -> None:
    """The files of a cell of a family; "mixed": of three that are wrong more often."""
    r = Random(seed)
    which = r.random()
    inputs: tuple[tuple[str, str], ...] = ()
    if family in MADE:
        net, toml = MADE[family](r)
    elif which < 0.6:
        net, toml = flow(r, many=which >= 0.5)
    elif which < 0.75:
        net, toml = random_cell(r)
    else:
        cell = adversary_cell(r)
        net, toml, inputs = cell.net, cell.toml, cell.inputs
    (folder / "cell.cpn").write_bytes(cpn(net))
    (folder / "cell.toml").write_text(toml, encoding="utf-8")
    for name, text in inputs:
        (folder / name).write_text(text, encoding="utf-8")


class _Cell:
    def __init__(self, opened: OpenNet, partition: Partition) -> None:
        self.opened, self.partition = opened, partition
        assert opened.config is not None
        self.plan = Plan(
            storage=opened.storage,
            order_decides=True,
            options=ExploreOptions(quick=True),
            premises=Premises.of(partition, opened.config, {}),
            primitives=opened.config.primitives,
            arms=Arms.of(opened.config, Diagnostics()),
        )

    def checked(
        self,
        turns_from: int | None,
        counts_from: int | None = None,
        properties: m.Properties = NONE,
        most: int = MOST,
    ) -> Control | None:
        """The checks of the supervisor, and properties."""
        limits = Limits(
            max_states=most,
            threads=1,
            traces=0,
            turns_from=turns_from,
            counts_from=counts_from,
        )
        options = replace(self.plan.options, predicates=properties.predicates)
        plan = replace(self.plan, properties=properties, options=options)
        return control.examine(self.partition, plan, limits, Diagnostics())

    def medium(self, turns_from: int | None) -> medium.Answer:
        """That of its medium."""
        limits = Limits(max_states=MOST, threads=1, traces=0, turns_from=turns_from)
        run = medium.Run(limits, Diagnostics(), ExploreOptions(quick=True))
        return medium.whole(self.partition, self.opened.storage, run, Rules())


class _Space:
    """The net of turns, explored in several ways by one program."""

    def __init__(self, cell: _Cell, running: Running, *, first: bool) -> None:
        self.cell, self.running = cell, running
        self.made = Generated()
        self.questions = (
            control_questions.of_cell(running, cell.plan, in_turns=True)
            if first
            else control_questions.of_orders(running, cell.plan.firings, in_turns=True)
        )

    def explored(self, table: Turns | None) -> Exploration | None:
        """With the table, or as a whole."""
        options = ExploreOptions(
            turns=table,
            generated=self.made,
            sizes=self.made.sizes or Sizes.start(self.running.net, self.cell.plan.storage),
            questions=self.questions,
            quick=True,
        )
        limits = Limits(max_states=MOST, threads=1, traces=0)
        return explore(self.running.net, self.cell.plan.storage, limits, Diagnostics(), options)

    def asked(self) -> list[str]:
        """The kinds of the questions."""
        lines = self.questions.split("\n")
        return [line.split()[1] for line in lines if line.startswith("? ")]


def differences(
    space: _Space, whole: Exploration, reduced: Exploration, *, is_rash: bool = False
) -> Iterator[str]:
    """What turns should keep, and do not; `is_rash`: also where there is a cycle."""
    if (reduced.error is None) != (whole.error is None):
        yield f"an exception: {reduced.error} / {whole.error}"
    if reduced.error is not None or whole.error is not None:
        return
    rows = list(zip(space.asked(), reduced.answers, whole.answers, strict=True))
    endless = [(a["answer"], b["answer"]) for kind, a, b in rows if kind == "restless"]
    if any(a == "no" for a, _ in endless) and not is_rash:
        return  # a cycle: nothing is said
    if not is_rash and any(b == "no" for _, b in endless):
        yield "the whole space has a cycle"
        return
    for number, (kind, a, b) in enumerate(rows):
        is_same = a["answer"] == b["answer"] and (
            kind not in ("bound", "bounded-response") or a["value"] == b["value"]
        )
        if not is_same:
            yield f"question {number}, {kind}: {_short(a)} / {_short(b)}"
    yield from found_differences(reduced, whole)


def _short(row: Mapping[str, Any]) -> str:
    return f"{row['answer']} {row.get('value')}"


def found_differences(
    reduced: Exploration, whole: Exploration, places: int | None = None
) -> Iterator[str]:
    """Of two spaces what does not depend on questions."""
    if places is None and reduced.dead_count != whole.dead_count:
        yield f"dead states: {reduced.dead_count} / {whole.dead_count}"
    one, other = reduced.bounds or (), whole.bounds or ()
    for p, (a, b) in enumerate(zip(one, other, strict=False)):
        if _sorted(a) != _sorted(b) and (places is None or p < places):
            yield f"bounds of place {p}: {a} / {b}"
    if places is None:
        if reduced.dead_transitions() != whole.dead_transitions():
            yield "transitions that never occur"
        if reduced.arena != whole.arena:
            yield f"memory: {reduced.arena} / {whole.arena}"


def _sorted(b: Bounds) -> Bounds:
    """With the colours in an order that does not depend on the way through the states."""

    def fixed(
        found: tuple[tuple[int, Any], ...] | None,
    ) -> tuple[tuple[int, Any], ...] | None:
        return None if found is None else tuple(sorted(found, key=repr))

    return replace(
        b,
        lower_multiset=fixed(b.lower_multiset),
        upper_multiset=fixed(b.upper_multiset),
    )


def judge(
    seed: int,
    folder: Path,
    *,
    mutants: bool,
    wants_medium: bool,
    family: str = "mixed",
    only_verdicts: bool = False,
) -> Verdict:
    """Makes a cell, and compares; `only_verdicts`: not the spaces as well."""
    make(seed, folder, family)
    d = Diagnostics()
    opened = open_net(folder, {}, warnings=d)
    partition = divide(opened.flat, opened.config, d) if opened.config is not None else None
    if partition is None or d.has_errors:
        return Verdict((), frozenset(), Counter(["refused"]))
    if opened.flat.timed:
        return Verdict((), frozenset(), Counter(["timed"]))
    cell = _Cell(opened, partition)
    try:
        loose = by_turns.loosened(partition)
    except NotModelledError:
        return Verdict((), frozenset(), Counter(["not modelled"]))
    if loose is None:
        return Verdict((), frozenset(), Counter(["no turns"]))
    counts: Counter[str] = Counter(["cells"])
    wrong: list[str] = []
    shown: set[str] = set()
    if not only_verdicts:
        wrong += _of_spaces(cell, loose, counts, shown if mutants else None)
    r = Random(seed)
    wrong += _of_checks(cell, r, counts)
    wrong += _of_properties(cell, r, counts, shown if mutants else None)
    wrong += closed.judged(opened, partition, counts)
    if wants_medium:
        wrong += _of_medium(cell, counts)
        wrong += files.judged(partition, opened.storage, counts, shown if mutants else None)
    return Verdict(tuple(wrong), frozenset(shown), counts)


def _of_spaces(
    cell: _Cell, loose: tuple[Running, Turns], counts: Counter[str], shown: set[str] | None
) -> Iterator[str]:
    """`shown` gets the names of mutants that are noticed, if they are tried."""
    running, table = loose
    for first in (True, False):
        space = _Space(cell, running, first=first)
        whole = space.explored(None)
        if whole is None or not (whole.complete or whole.error):
            counts["too large"] += 1
            continue
        reduced = space.explored(table)
        if reduced is None or not (reduced.complete or reduced.error):
            yield "turns do not end"
            continue
        counts["states"] += whole.nodes
        counts["states in turns"] += reduced.nodes
        counts["smaller"] += reduced.nodes < whole.nodes
        counts["no cycle"] += all(
            row["answer"] != "no"
            for kind, row in zip(space.asked(), reduced.answers, strict=False)
            if kind == "restless"
        )
        yield from (f"first {first}: {x}" for x in differences(space, whole, reduced))
        if shown is not None:
            shown.update(_shown(space, table, whole, reduced))
        bed = Limited.of(cell.partition, cell.plan) if first else None
        if bed is not None:
            yield from bed.judged(whole, counts)
            if shown is not None:
                shown.update(bed.shown(whole))


def _shown(space: _Space, table: Turns, whole: Exploration, reduced: Exploration) -> Iterator[str]:
    """Mutants that are noticed."""
    others = {name: mutant(table) for name, mutant in MUTANTS.items()}
    others[NO_GROUPS] = by_turns.table_of(space.running, [])
    for name, other in others.items():
        found = space.explored(other)
        if found is None or any(differences(space, whole, found)):
            yield name
    if any(differences(space, whole, reduced, is_rash=True)):
        yield RASH


def _of_checks(cell: _Cell, r: Random, counts: Counter[str]) -> Iterator[str]:
    first = r.choice(FEW)
    found = cell.checked(MOST, first)
    is_less = found is not None and (found.is_counted or found.reduced_orders)
    counted = found if is_less else None
    counts["checks with limits"] += found is not None and found.is_counted
    counts["orders with limits, or in turns"] += found is not None and found.reduced_orders
    reduced = cell.checked(1)
    if reduced is None or not reduced.reduced or reduced.found is None:
        counts["checks of the whole"] += 1
        if counted is None:
            return
        reduced = None
    counts["checks in turns"] += reduced is not None
    whole = cell.checked(None) if counted is not None else found
    if whole is None or whole.found is None:
        yield "the whole cannot be checked"
        return
    if not whole.found.complete:
        counts["only in turns"] += 1
        return
    if counted is not None:
        yield from (f"with limits: {x}" for x in _other_checks(counted, whole, _LIMITED))
        if counted.row()["dead_transitions"] != whole.row()["dead_transitions"]:
            yield "with limits: transitions that never occur"
    if reduced is None or reduced.found is None:
        return
    yield from _other_checks(reduced, whole, _SIZES)
    places = len(cell.partition.net.places)
    yield from found_differences(reduced.found, whole.found, places)


def _of_properties(
    cell: _Cell, r: Random, counts: Counter[str], shown: set[str] | None
) -> Iterator[str]:
    """`shown` gets the names of wrong versions that are noticed, if they are tried."""
    properties = asked.properties(r, cell.opened, cell.partition)
    told = asked.OfStates.of(properties, cell.partition, cell.plan)
    if told is None:
        return
    whole = cell.checked(None, properties=properties)
    if whole is None or whole.found is None or not whole.found.complete:
        return
    yield from told.judged(whole, counts)
    part = cell.checked(None, properties=properties, most=r.choice(FEW))
    if part is not None:
        yield from asked.of_part(properties, part, whole, counts)
    of_states = asked.of_states(properties, cell.partition)
    turned = cell.checked(1, properties=of_states)
    counts["properties asked in turns"] += len(of_states.properties) * (
        turned is not None and turned.reduced
    )
    if turned is not None:
        yield from asked.in_turns(of_states, properties, turned, whole)
    for name, change in asked.WRONG_PROPERTIES.items() if shown is not None else ():
        other = asked.OfStates.of(properties, cell.partition, cell.plan, change)
        if other is not None and any(other.wrong(whole)):
            shown.add(name)


def _other_checks(mine: Control, whole: Control, sizes: tuple[str, ...]) -> Iterator[str]:
    for a, b in zip(mine.checks, whole.checks, strict=True):
        one = (a.name, a.answer, a.is_accepted, None if a.name in sizes else a.value)
        other = (b.name, b.answer, b.is_accepted, None if b.name in sizes else b.value)
        if one != other:
            yield f"check: {one} / {other}: {a.says} / {b.says}"
        if a.name == "bounded-response" and (a.value or 0) < (b.value or 0):
            yield f"check: {a.says} / {b.says}"


_SIZES = ("non-blocking", "confluence")
"""Checks of which the value is a number of states, or of steps of one run."""
_LIMITED = (*_SIZES, "bounded-response", "messages", "reach", "memory")
"""The same where a state stands for many markings: there may be more of what is counted.

What memory is needed while questions about orders are answered counts in `memory`, too, and they are not asked then;
what firings need is compared by `Limited`.
"""
FEW = (40, 150, 400)
"""States before tokens are counted up to a limit: one of these."""


def _of_medium(cell: _Cell, counts: Counter[str]) -> Iterator[str]:
    reduced = cell.medium(1)
    if not reduced.reduced:
        counts["medium of the whole"] += 1
        return
    counts["medium in turns"] += 1
    whole = cell.medium(None)
    if whole.answer == "inconclusive":
        counts["medium only in turns"] += 1
    elif whole.answer != "yes":
        yield f"medium: {whole.answer} {whole.why}"
    else:
        counts["medium states"] += whole.nodes
        counts["medium states in turns"] += reduced.nodes
