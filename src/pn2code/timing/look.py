"""`pn2code time CELL`: durations of all commands, and of all cycles, in the layouts of a cell.

found = look(opened, None, limits, folder, d)          # Times; None after an error that was reported
found.layouts[0].cycle.most
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

from pn2code.base.deadline import Deadline, TimeIsOverError
from pn2code.base.frozen import frozen
from pn2code.base.how_far import HowFar, Say, silent
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import OwnerKind
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.geometry.check import cells_of
from pn2code.geometry.graph import CellGraph, explore_cell, most_held
from pn2code.geometry.legs import Stand
from pn2code.geometry.runs import Run, write
from pn2code.geometry.words import numbers, reason, words
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import pose_of
from pn2code.timing import codes
from pn2code.timing.answers import ENDLESS, NO_END, Command, Cycle, Ending, Fault, Layout
from pn2code.timing.anyhow import Anyhow
from pn2code.timing.doings import NS, Doings
from pn2code.timing.longest import TimedPath, TimedPaths, longest_inside
from pn2code.timing.search import TIE, Search
from pn2code.timing.unstopped import Unstopped
from pn2code.verdict.opened import OpenNet
from pn2code.verdict.programs import partition_of
from pn2code.verify.controller.control_types import CellProgram
from pn2code.verify.controller.not_modelled import NotModelledError
from pn2code.verify.exploring.limits import Limits

PLANNED = "each command takes its planned time, and messages and the supervisor none (docs/time.md)"
AT_ONCE = "sensors and people answer at once"
CLOCK_RUNS = "a unit of the net's time is a second (`--time-scale 1`)"
_HALTS = "a script may come to where none of its transitions is possible, and stop the cell"
RAISES = "a condition of a script may raise an exception, and stop the cell"
_OPEN = {
    "waits": "how long a script waits cannot be computed",
    "armless": "a robot has no arm in cell.toml, so that nobody knows how long its moves take",
    "belt": "how far a belt runs depends on the parts on it, which are not followed",
    "time": "the time was over before all situations were looked at",
    "situations": "the cell can come to more situations than were looked at",
}


_OF_CYCLES = 0.8
"""Of what is left of a limited time, the part in which cycles are looked at: answers take some, too."""


@frozen(eq=False)
class Times:
    """What is known of a cell.

    Args:
        why: why nothing is known; "": something is.
        reply_timeout_s: how long the supervisor waits for an answer before it stops the cell.
    """

    layouts: tuple[Layout, ...]
    reply_timeout_s: float
    why: str = ""

    def row(self) -> dict[str, Any]:
        """For programs (docs/time.md)."""
        return {
            "why": self.why or None,
            "reply_timeout_s": self.reply_timeout_s,
            "layouts": [x.row() for x in self.layouts],
        }


@frozen(eq=False)
class Measured:
    """All that was gone through in one layout: with planned times, and in whatever order things end; and of the former
    the runs that nothing stops."""

    search: Search
    anyhow: Anyhow
    runs: Unstopped


def look(
    opened: OpenNet,
    layout: str | None,
    limits: Limits,
    folder: Path | None,
    d: Diagnostics,
    stage: Callable[[str], None] = lambda _text: None,
    measured: Callable[[Measured], None] = lambda _layout: None,
    program: CellProgram | None = None,
    say: Say = silent,
) -> Times | None:
    """Measures everything; None after an error that was reported.

    Args:
        opened: the cell.
        layout: only this one; None: all of them.
        limits: of the exploration.
        folder: where a fastest and a slowest run are written; None: nowhere.
        d: gets the errors.
        stage: hears in words what is done; say: and how far it is.
        measured: hears of each layout what was gone through.
        program: what was compiled of this cell, in which nothing is wrong; None: nothing.
    """
    config = opened.config
    if config is None:
        d.error(
            codes.TIME_NO_CELL,
            "only a cell has durations, and there is no cell.toml",
            Origin(opened.flat.file),
            hint="give a cell.toml or its folder; a net alone is played by `pn2code simulate`",
        )
        return None
    known = None if program is None else program.running.partition
    partition = known or partition_of(opened, config, d)
    cells = cells_of(config, layout, d)
    if partition is None or cells is None:
        return None
    timeout = config.supervisor.reply_timeout_s
    stage("exploring the cell as its programs run ...")
    try:
        graph = explore_cell(
            partition, opened.storage, limits, d, opened.initial, program, most=most_held()
        )
    except NotModelledError as problem:
        return Times((), timeout, f"the cell as it runs cannot be modelled: {problem}")
    if graph is None:
        return None
    if not graph.arcs:
        return Times((), timeout, reason(graph.why, graph.raised))
    made = []
    for name, cell in cells:
        stage("measuring commands and cycles ...")
        one = _Look(graph, cell, config, name, folder, opened)
        made.append(one.layout(say, limits.deadline))
        measured(Measured(one.search, one.anyhow, one.runs))
    return Times(tuple(made), timeout)


class _Look:
    """One layout."""

    def __init__(
        self,
        graph: CellGraph,
        cell: RobotCell,
        config: CellConfig,
        name: str,
        folder: Path | None,
        opened: OpenNet,
    ) -> None:
        self.graph, self.cell, self.name = graph, cell, name
        self.folder, self.opened = folder, opened
        self.doings = Doings(graph, cell)
        self.anyhow = Anyhow(self.doings)
        self.search = Search(self.doings)
        self.timeout = round(config.supervisor.reply_timeout_s * NS)
        owners = graph.partition.owners
        self.owner = {o.index: o.name for o in owners}

    def layout(self, say: Say, deadline: Deadline) -> Layout:
        """All that is known; what holds in whatever order commands end is looked at first, and has to be known."""
        self.anyhow.explore(HowFar(say, "measuring commands", noun="situations"))
        try:
            with deadline.share(_OF_CYCLES).enforced():
                self.search.explore(HowFar(say, "measuring cycles", noun="situations"))
        except TimeIsOverError:
            self.search.why = self.search.why or "time"
        return Layout(
            self.name,
            tuple(self._commands()),
            tuple(self._faults()),
            self._cycle(),
            len(self.graph.arcs),
            _clause(self.anyhow.why),
            tuple(o.name for o in self.graph.partition.owners if o.kind is OwnerKind.DEVICE),
        )

    @cached_property
    def runs(self) -> Unstopped:
        """Those of the search that nothing stops, once all are known that there are."""
        return Unstopped(self.search, self.timeout)

    def _transition(self, element: int) -> str:
        return self.graph.running.net.transitions[self.graph.elements[element].transition].name

    def _commands(self) -> Iterator[Command]:
        found: dict[tuple[str, str, str, str], list[tuple[int, str]]] = {}
        for (element, _), stand in self.anyhow.met.items():
            doing = self.doings.of(element, stand)
            robot = self.owner[self.graph.elements[element].owner]
            for part in doing.parts if doing is not None else ():
                key = (robot, self._transition(element), words(part.command), part.kind)
                for ns in {part.ns, part.ns if part.least is None else part.least}:
                    found.setdefault(key, []).append((ns, self._pose(robot, part.start)))
        order = {name: i for i, name in enumerate(self.owner.values())}
        for key in sorted(found, key=lambda k: order[k[0]]):
            times = sorted(set(found[key]))
            (least, least_from), (most, most_from) = times[0], times[-1]
            places = len({pose for _, pose in times})
            yield Command(*key, least, most, least_from, most_from, places)

    def _pose(self, robot: str, stand: Stand | None) -> str:
        if stand is None or self.cell.robot(robot).is_device:
            return ""
        own = self.cell.robot(robot)
        return numbers(pose_of(own.T_world_base @ own.of_tool(stand.tool, stand.T_base_tcp)))

    def _faults(self) -> Iterator[Fault]:
        for (element, _), why in self.anyhow.faults.items():
            yield Fault(self._transition(element), why)

    def _cycle(self) -> Cycle:
        search, anyhow = self.search, self.anyhow
        is_known = not search.why
        around = self.runs.around() if is_known and search.cycle else []
        occurring = (e for e in around if not self.graph.elements[e].is_step)
        repeats = tuple(dict.fromkeys(map(self._transition, occurring)))
        at_least = at_most = None
        if not anyhow.why:
            at_least = anyhow.least()
            if anyhow.adds_up:
                way, _ = anyhow.most()
                at_most = None if way is None else way.ns
        is_bounded = search.why == "belt" and not anyhow.why and anyhow.adds_up
        owed = [] if search.why else [*self._owed()]
        most_owed = [*self._owed_anyhow()] if is_bounded else []
        work = [*self._owed_by_work()] if search.why and not anyhow.why else []
        late = tuple(self._late([*owed, *work], most_owed))
        # Of robots without an arm, and of what is told by more than tokens, nothing is known.
        stops = [] if self.doings.why else [*search.faults, *anyhow.faults.values()]
        stops = [why for why in dict.fromkeys(stops) if why]
        return Cycle(
            tuple(self._endings()),
            _clause(search.why),
            repeats,
            at_least,
            at_most,
            tuple(self._others(late)),
            len(search.situations),
            max((ns for _, ns in [*owed, *most_owed] if ns is not None), default=None),
            late,
            tuple(stops),
            has_stops=self.doings.stops,
            bounded=tuple(self._bounded(late)) if is_bounded else None,
            never=tuple(self._never()) if is_known else (),
        )

    def _endings(self) -> Iterator[Ending]:
        search = self.search
        is_known = not search.why
        # What was seen before a limit is all that there is before that time; of other reasons nothing is certain.
        is_first = is_known or (
            search.why == "situations" and not (self.doings.why or self.doings.stops)
        )
        several = len(search.endings) > 1
        taken = {""}
        for places, ending in search.endings.items():
            best = ending.best if is_first else None
            worst = ending.worst if is_known else None
            word = re.sub(r"[^\w+-]+", "_", places[-1].rpartition(".")[2])
            numbered = (f"{word}{k}" for k in itertools.count(2))
            own = word if word not in taken else next(x for x in numbered if x not in taken)
            taken.add(own)
            short = f"-{own}" if several else ""
            yield Ending(
                places,
                None if best is None else best.ns,
                None if worst is None else worst.ns,
                self._run(best if is_known else None, f"fastest{short}"),
                self._run(worst, f"slowest{short}"),
                0 if worst is None else worst.ns - self._surely(worst, ending.nodes),
            )

    def _surely(self, worst: TimedPath, nodes: Sequence[int]) -> int:
        """ns: some run to these situations that nothing stops takes no less, whatever ends before what it is a tie
        with; 0: there is none."""
        if not self.runs.is_all:
            longest = self.runs.longest(nodes)
            return 0 if longest is None else longest.ns
        held_up = self.search.held_up(0, worst.arcs)
        if not held_up:
            return worst.ns
        found = TimedPaths(self.search.surely(), self.search.ends).longest(nodes)
        return worst.ns - held_up if found is None else max(found.ns, worst.ns - held_up)

    def _others(self, late: Sequence[str]) -> Iterator[str]:
        """What runs may do that do not come to the end."""
        search = self.search
        yield from (f"a run may stop: {why}" for why in search.faults)
        if search.stuck:
            yield "a run may come to where nothing more happens, before its end"
        yield from self._two_messages()
        yield from late
        if search.halts:
            yield _HALTS
        if search.may_raise():
            yield RAISES
        if search.is_endless and not search.cycle:
            yield ENDLESS
        if not search.ends and not search.why:
            yield NO_END

    def _two_messages(self) -> Iterator[str]:
        for name in self.search.overfull():
            yield f"channel `{name}` may come to hold two messages, and then the cell stops"

    def _bounded(self, late: Sequence[str]) -> Iterator[str]:
        """What runs may do that do not come to the end, in whatever order things end."""
        anyhow = self.anyhow
        yield from (f"a run may stop: {why}" for why in dict.fromkeys(anyhow.faults.values()))
        yield from self._two_messages()
        yield from late
        if anyhow.halts:
            yield _HALTS
        if not anyhow.is_sure():
            yield "a run may come to where nothing more happens, or go on for ever, before its end"

    def _never(self) -> Iterator[str]:
        """What the net permits, but planned times do not: such as a timer that is over before the answer, or never."""
        net, elements = self.graph.running.net, self.graph.elements
        marks = {mark for arcs in self.search.successors for _, _, mark in arcs if mark >= 0}
        occurs = {elements[mark].transition for mark in marks}
        permitted = {e.transition for e in elements if not e.is_step and e.owner >= 0}
        for transition in sorted(permitted - occurs):
            yield net.transitions[transition].name

    def _owed(self) -> Iterator[tuple[str, int | None]]:
        """Who may owe an answer, and for how long at most (ns; None: without a limit, or for ever)."""
        for owner in self.graph.partition.owners:
            if owner.index in self.runs.owed:
                yield owner.phrase, self.runs.owed[owner.index]

    def _owed_anyhow(self) -> Iterator[tuple[str, int | None]]:
        """The same in whatever order things end: no more than this."""
        for owner in self.graph.partition.owners:
            place = self.graph.running.owing.get(owner.index)
            if place is not None:
                yield owner.phrase, self.anyhow.inside(place)

    def _owed_by_work(self) -> Iterator[tuple[str, int | None]]:
        """The same where not all situations are known: how long by what they do themselves while they owe it.

        Whoever waits meanwhile owes it for longer still, so only what is too long is known.
        """
        elements, marked, shortest = self.graph.elements, self.graph.marked, self.anyhow.shortest
        for owner in self.graph.partition.owners:
            place = self.graph.running.owing.get(owner.index)
            if place is None:
                continue
            own = [
                [
                    (to, shortest(ns, mark) if elements[mark].owner == owner.index else 0, mark)
                    for to, ns, mark in x
                ]
                for x in self.anyhow.successors
            ]
            owing = [i for i, (state, _) in enumerate(self.anyhow.nodes) if place in marked[state]]
            yield owner.phrase, longest_inside(own, owing)

    def _late(
        self,
        owed: Sequence[tuple[str, int | None]],
        most_owed: Sequence[tuple[str, int | None]],
    ) -> Iterator[str]:
        """Who may owe an answer for longer than the supervisor waits for it.

        Args:
            owed: for how long at most (ns; None: without a limit).
            most_owed: where that is not known: no longer than this, so that it is not excluded.
        """
        told = set[str]()
        for is_bound, (who, ns) in [*((False, x) for x in owed), *((True, x) for x in most_owed)]:
            if who in told or (ns is not None and ns + TIE <= self.timeout):
                continue
            told.add(who)
            after = "after" if not is_bound else "as late as after"
            when = "at any time, or never" if ns is None else f"{after} {ns / NS:.3f} s"
            yield (
                f"an answer of {who} may come {when}, later than reply_timeout_s "
                f"({self.timeout / NS:g} s) allows"
            )

    def _run(self, way: TimedPath | None, which: str) -> Run | None:
        if way is None or self.folder is None:
            return None
        stem = re.sub(r"[^A-Za-z0-9_.-]+", "_", self.opened.flat.name) or "net"
        layout = f"-{self.name}" if self.name else ""
        file = self.folder / f"{stem}.{which}{layout}.trace.jsonl"
        elements = self.search.elements(way)
        return write(self.graph, elements, (), file, self.opened.initial)


def _clause(why: str) -> str:
    return _OPEN.get(why) or reason(why)
