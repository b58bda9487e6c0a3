"""The whole check of a layout: situations, moves, pairs, and what would keep pairs apart.

    answer = look(graph, cell, Options(folder, "cell"))        # answers.Layout
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Partition
from pn2code.geometry import mutex
from pn2code.geometry.activities import Activity, Doing
from pn2code.geometry.answers import Layout, Move, Pair, Proposal, Verdict
from pn2code.geometry.compare import Comparison
from pn2code.geometry.graph import CellGraph
from pn2code.geometry.legs import Leg, Planner
from pn2code.geometry.runs import Run, write
from pn2code.geometry.situations import Met, Situations
from pn2code.geometry.sweeps import Apart
from pn2code.geometry.words import OPEN, numbers, words
from pn2code.robot.backend import Clearance
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.parts import Part
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import pose_of

MOST_RUNS = 40
"""Traces that are written."""

Explore = Callable[[Partition], CellGraph | None]
Side = tuple[int, int, int]
"""(arm, transition, -1), or (arm, -1, where it stands)."""


@frozen
class Options:
    """How.

    Args:
        folder: of the traces; stem: what their names begin with.
        initial: markings that files gave, for the headers of traces.
        explore: explores a changed cell; None: no proposals.
        stage: hears in words what is done.
    """

    folder: Path
    stem: str
    initial: str | None = None
    explore: Explore | None = None
    stage: Callable[[str], None] = lambda _text: None


class Look:
    """One layout."""

    def __init__(self, graph: CellGraph, cell: RobotCell, options: Options, layout: str) -> None:
        self.graph, self.cell, self.options, self.layout = graph, cell, options, layout
        self.planner = Planner(cell)
        self.doing = Doing(self.planner, cell)
        self.backend = BulletBackend(cell, looks=False)
        self.comparison = Comparison(cell, self.planner, self.backend)
        self.robots = tuple(r.name for r in cell.robots)
        self.runs: dict[tuple[int, tuple[int, ...]], Run] = {}
        self.nearest: Clearance | None = None

    def close(self) -> None:
        """Ends the collision library."""
        self.backend.close()

    def answer(self) -> Layout:
        """All that is known."""
        began = time.perf_counter()
        self.options.stage("looking where arms can be ...")
        found = Situations(self.graph, self.doing, self.robots)
        found.explore()
        self.options.stage("sweeping moves ...")
        moves = self._moves(found)
        self.options.stage("sweeping pairs ...")
        pairs, sides = self._pairs(found)
        pairs += self._parts(found)
        proposals: list[Proposal] = []
        if sides and self.options.explore is not None:
            self.options.stage("looking for a zone ...")
            proposals = self._proposals(found, sides)
        return Layout(
            self.layout,
            len(self.graph.arcs),
            len(found.situations),
            tuple(moves),
            tuple(pairs),
            self.comparison.compared,
            self.comparison.sweeper.queries,
            time.perf_counter() - began,
            OPEN.get(found.why, found.why),
            tuple(proposals),
            self.nearest,
        )

    # --- moves -----------------------------------------------------------------------------------

    def _moves(self, found: Situations) -> list[Move]:
        rows: dict[tuple[int, str], Move] = {}
        for (number, _element), met in found.activities.items():
            activity = self.doing.activities[number]
            legs = activity.legs
            for i, (leg, contents) in enumerate(legs):
                held = contents.held_by(leg.robot)
                key = (leg.number, "" if held is None else held.name)
                if key in rows or (leg.fault is None and not leg.is_moving and held is None):
                    continue
                if leg.command is None and leg.fault is None:
                    continue
                problem = activity.fault if i == len(legs) - 1 and activity.is_part else ""
                rows[key] = self._move(found, leg, held, met, problem)
            if activity.fault and activity.is_part and not legs:
                rows[-1 - number, ""] = self._device(found, activity, met)
        return list(rows.values())

    def _device(self, found: Situations, activity: Activity, met: Met) -> Move:
        t, owner = _who(found, met.elements[0])
        run = self._run(found, met)
        return Move(owner, t, "a part", "", "tool", "no", activity.fault, run=run)

    def _move(
        self, found: Situations, leg: Leg, held: Part | None, met: Met, problem: str
    ) -> Move:
        t, _ = _who(found, met.elements[0])
        base = self.cell.robot(leg.robot).T_world_base
        begins = numbers(pose_of(base @ leg.start.T_base_tcp))
        does = words(leg.command) + (f" with {held.name}" if held is not None else "")
        if leg.fault is not None:
            return Move(
                leg.robot, t, does, begins, leg.kind, "no", leg.fault.message,
                run=self._run(found, met),
            )
        margins = self.comparison.margins(leg)
        scene, itself = self.comparison.around(leg, held)
        answer: Verdict = "yes"
        why = ""
        for apart, what in ((scene, ""), (itself, " of itself")):
            if apart.outcome == "touch" and answer != "no":
                answer, why = "no", _touch(apart) + what
            elif apart.outcome == "open" and answer == "yes":
                answer, why = "unknown", apart.why
        if problem:
            answer, why = "no", problem
        return Move(
            leg.robot,
            t,
            does,
            begins,
            leg.kind,
            answer,
            why,
            math.degrees(margins.limit),
            margins.axis + 1,
            margins.condition,
            _least(scene),
            _least(itself),
            scene.where,
            self._run(found, met) if answer != "yes" else None,
        )

    # --- pairs -----------------------------------------------------------------------------------

    def _pairs(self, found: Situations) -> tuple[list[Pair], list[tuple[Side, Side]]]:
        bad: dict[tuple[Side, Side], Pair] = {}
        for (one, other), met in found.pairs.items():
            a, b = self.doing.activities[one], self.doing.activities[other]
            sides = self._sides(found, a, b, met)
            if sides in bad and bad[sides].answer == "no":
                continue
            for leg, contents in a.legs:
                for second, more in b.legs:
                    apart = self.comparison.two(
                        (leg, contents.held_by(leg.robot)), (second, more.held_by(second.robot))
                    )
                    self._note_nearest(apart)
                    if apart.outcome == "clear" or (
                        sides in bad and (bad[sides].answer == "no" or apart.outcome == "open")
                    ):
                        continue
                    bad[sides] = self._pair(found, leg, second, apart, met)
        touching = [sides for sides, pair in bad.items() if pair.answer == "no"]
        return list(bad.values()), touching

    def _note_nearest(self, apart: Apart) -> None:
        if apart.outcome == "clear" and apart.where is not None:
            if self.nearest is None or apart.where.distance < self.nearest.distance:
                self.nearest = apart.where

    def _sides(self, found: Situations, a: Activity, b: Activity, met: Met) -> tuple[Side, Side]:
        one, other = (
            self._side(found, activity, element)
            for activity, element in zip((a, b), met.elements, strict=True)
        )
        return one, other

    def _side(self, found: Situations, activity: Activity, element: int) -> Side:
        leg = activity.legs[0][0]
        arm = self.robots.index(leg.robot)
        if element < 0:
            return (arm, -1, leg.start.number)
        return (arm, found.graph.elements[element].transition, -1)

    def _pair(self, found: Situations, leg: Leg, other: Leg, apart: Apart, met: Met) -> Pair:
        names = [_who(found, e)[0] for e in met.elements]
        does = (words(leg.command), words(other.command))
        joints = tuple(
            (x.robot, tuple(map(float, q)))
            for x, q in zip((leg, other), apart.joints, strict=False)
        )
        is_touch = apart.outcome == "touch"
        return Pair(
            (leg.robot, other.robot),
            (names[0], names[1]),
            does,
            "no" if is_touch else "unknown",
            _touch(apart) if is_touch else apart.why,
            apart.where,
            apart.where.distance if apart.where else 0.0,
            joints,
            self._run(found, met),
        )

    def _parts(self, found: Situations) -> list[Pair]:
        """Arms, with what they carry, and parts that stand."""
        parts = found.parts() if found.beside else {}
        bad: dict[tuple[str, str, str], Pair] = {}
        for (number, i, where), met in found.beside.items():
            leg, contents = self.doing.activities[number].legs[i]
            part = parts[where]
            t, _ = _who(found, met.elements[0])
            key = (leg.robot, t, part.kind.name)
            if key in bad and bad[key].answer == "no":
                continue
            apart = self.comparison.beside((leg, contents.held_by(leg.robot)), part)
            if apart.outcome == "clear" or (key in bad and apart.outcome == "open"):
                continue
            is_touch = apart.outcome == "touch"
            joints = ((leg.robot, tuple(map(float, apart.joints[0]))),) if apart.joints else ()
            bad[key] = Pair(
                (leg.robot, ""),
                (t, ""),
                (words(leg.command), f"`{part.name}` stands"),
                "no" if is_touch else "unknown",
                _touch(apart) if is_touch else apart.why,
                apart.where,
                apart.where.distance if apart.where else 0.0,
                joints,
                self._run(found, met),
            )
        return list(bad.values())

    # --- what would keep them apart --------------------------------------------------------------

    def _proposals(
        self, found: Situations, pairs: list[tuple[Side, Side]]
    ) -> list[Proposal]:
        return [self._proposal(found, zone) for zone in _zones(pairs)]

    def _proposal(self, found: Situations, zone: frozenset[Side]) -> Proposal:
        arms = sorted({side[0] for side in zone})
        robots = tuple(self.robots[a] for a in arms)
        net = self.graph.partition.net
        names = tuple(
            net.transitions[t].name if t >= 0 else f"{self.robots[arm]} stands"
            for arm, t, _ in sorted(zone)
        )
        sides = [
            frozenset[int]().union(*(found.states[s] for s in zone if s[0] == arm)) for arm in arms
        ]
        tried = ""
        places = {p.name: p for p in net.places}
        top = net.places[0].name.split(".")[0] if "." in net.places[0].name else ""
        name = mutex.named([f"{top}.Zone" if top else "Zone"], places)
        before = mutex.stuck(self.graph)
        for number, guard in enumerate(mutex.guards(self.graph, sides)):
            if number == mutex.MOST_TRIED:
                break
            proposal = Proposal(
                robots,
                names,
                name,
                tuple(net.transitions[t].name for t in guard.takes),
                tuple(net.transitions[t].name for t in guard.gives),
                tuple(net.places[p].name for p in guard.places),
            )
            problem, says = self._tried(guard, name, zone, before)
            if not problem:
                return Proposal(
                    *(proposal.robots, proposal.transitions, proposal.name, proposal.takes),
                    *(proposal.gives, proposal.while_, True, says),
                )
            tried = tried or problem
        says = (
            f"no place that was tried helps: {tried}"
            if tried
            else "no place of the supervisor holds a token exactly while only one of these robots is under way: let the "
            "supervisor command them by different transitions, and wait for their answers"
        )
        return Proposal(robots, names, says=says)

    def _tried(
        self,
        guard: mutex.Guard,
        name: str,
        zone: frozenset[Side],
        before: int,
    ) -> tuple[str, str]:
        """Why the net with the place is no better, "" if it is; and what was found."""
        assert self.options.explore is not None
        graph = self.options.explore(mutex.guarded(self.graph.partition, guard, name))
        if graph is None or graph.why:
            return "the net with the place was not seen to its end", ""
        stuck = mutex.stuck(graph)
        if stuck > before:
            return f"with the place, {stuck:,} states have no way to the end", ""
        lost = mutex.fired(self.graph) - mutex.fired(graph)
        if lost:
            t = self.graph.partition.net.transitions[min(lost)].name
            return f"with the place, `{t}` never occurs", ""
        found = Situations(graph, self.doing, self.robots)
        found.explore()
        if self._can_meet(found, zone):
            return "with the place, the arms can still collide", ""
        if found.why:
            return f"with the place, {OPEN.get(found.why, found.why)}", ""
        says = (
            f"checked: with it, none of these pairs is under way at once in any of the {len(graph.arcs):,} states, "
            f"and the cell comes to its end from as many of them as before"
        )
        return "", says

    def _can_meet(self, found: Situations, zone: frozenset[Side]) -> bool:
        """Whether two of a zone are not surely apart."""
        for (one, other), met in found.pairs.items():
            a, b = self.doing.activities[one], self.doing.activities[other]
            if not zone.issuperset(self._sides(found, a, b, met)):
                continue
            for leg, contents in a.legs:
                for second, more in b.legs:
                    apart = self.comparison.two(
                        (leg, contents.held_by(leg.robot)), (second, more.held_by(second.robot))
                    )
                    if apart.outcome != "clear":
                        return True
        return False

    # --- words and runs --------------------------------------------------------------------------

    def _run(self, found: Situations, met: Met) -> Run | None:
        """A run to where something is under way; None: there are enough of them."""
        key = (met.situation, met.elements)
        if key not in self.runs and len(self.runs) < MOST_RUNS:
            number = len(self.runs) + 1
            layout = f"-{self.layout}" if self.layout else ""
            name = f"{self.options.stem}.geometry{layout}-{number}.trace.jsonl"
            self.runs[key] = write(
                found.graph,
                found.way(met.situation),
                [e for e in met.elements if e >= 0],
                self.options.folder / name,
                self.options.initial,
            )
        return self.runs.get(key)


def _who(found: Situations, element: int) -> tuple[str, str]:
    """The transition and the owner; of an arm that stands nobody."""
    if element < 0:
        return "", ""
    e = found.graph.elements[element]
    partition = found.graph.partition
    return partition.net.transitions[e.transition].name, partition.owners[e.owner].name


def _zones(pairs: list[tuple[Side, Side]]) -> list[frozenset[Side]]:
    """Sides that hang together by pairs that touch."""
    groups: list[set[Side]] = []
    for pair in pairs:
        joined = set(pair)
        rest = []
        for group in groups:
            if group & joined:
                joined |= group
            else:
                rest.append(group)
        groups = [*rest, joined]
    return [frozenset(g) for g in groups]


def _least(apart: Apart) -> float | None:
    return None if apart.outcome == "open" else apart.least


def _touch(apart: Apart) -> str:
    gap = apart.where
    assert gap is not None
    at = ", ".join(f"{1000.0 * v:.0f}" for v in gap.point)
    return f"`{gap.a}` and `{gap.b}` overlap by {-1000.0 * gap.distance:.1f} mm at ({at}) mm"

