"""The whole check of a layout: situations, moves, pairs, and what would keep pairs apart.

looking = Look(graph, cell, Options(folder, "cell"), "")
looking.answer()                                          # answers.Layout
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from pn2code.base.deadline import OverError
from pn2code.base.frozen import frozen
from pn2code.base.how_far import HowFar, Say, silent
from pn2code.geometry.activities import Activity, Doing
from pn2code.geometry.answers import Layout, Move, Open, Pair, Proposal, Verdict
from pn2code.geometry.apart import Apart
from pn2code.geometry.around import around_of
from pn2code.geometry.compare import Comparison
from pn2code.geometry.contents import Load, spots
from pn2code.geometry.doubts import APART
from pn2code.geometry.graph import CellGraph
from pn2code.geometry.legs import Leg, Planner
from pn2code.geometry.part_names import as_in_runs, as_seen, gap_as_seen, like, shown
from pn2code.geometry.pieces import ROUNDING
from pn2code.geometry.progress import LATE, Meeting, Progress, Seen
from pn2code.geometry.runs import Run, write
from pn2code.geometry.shown import Shown
from pn2code.geometry.situation import ON_PLATE, Met, Side
from pn2code.geometry.situations import Situations
from pn2code.geometry.where import at_rest, stands_at
from pn2code.geometry.words import carrying, numbers, reason, words
from pn2code.geometry.zones import Explore, Refused, Zones, sides_of
from pn2code.robot.backend import Clearance
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import MoveJoint
from pn2code.robot.led_contacts import EARLY
from pn2code.robot.motion_checks import other_branches
from pn2code.robot.robot_cell import PART_CONTACT, RobotCell
from pn2code.robot.transforms import pose_of

_NOWHERE = Clearance("robots", "", "", "", 0.0, None, (0.0, 0.0, 0.0))
MOST_RUNS = 40
"""Traces that are written."""
MOST_DEPTHS = 6_000
"""Distances after which no more overlaps are searched for where they are deepest; one of each two robots always is."""


@frozen
class Options:
    """How.

    Args:
        folder: of the traces; stem: what their names begin with.
        initial: markings that files gave, for the headers of traces.
        explore: explores a changed cell; None: no proposals.
        stage: hears in words what is done; say: and how far it is.
        jobs: processes that sweep.
        refused: what `generate` would say of a changed cell.
    """

    folder: Path
    stem: str
    initial: str | None = None
    explore: Explore | None = None
    stage: Callable[[str], None] = lambda _text: None
    jobs: int = 1
    say: Say = silent
    refused: Refused = lambda _changed: ""


class Look:
    """One layout."""

    def __init__(self, graph: CellGraph, cell: RobotCell, options: Options, layout: str) -> None:
        self.graph, self.cell, self.options, self.layout = graph, cell, options, layout
        self.planner = Planner(cell)
        self.backend = BulletBackend(cell, looks=False)
        shown = Shown(self.backend)
        self.doing = Doing(self.planner, cell, shown)
        self.comparison = Comparison(cell, self.planner, shown)
        self.robots = tuple(r.name for r in cell.moving)
        self.runs: dict[tuple[Situations, int, tuple[int, ...]], Run] = {}
        self._numbered = 0
        self.progress = Progress()

    def close(self) -> None:
        """Ends the collision library."""
        self.backend.close()

    def answer(self) -> Layout:
        """All that is known."""
        began = time.perf_counter()
        found = self.situations(self.graph)
        seen = self.progress.seen = self.seen(found)
        bad = {sides: pair for sides, pair in seen.arms.items() if pair.answer == "no"}
        touching = [sides for sides, pair in bad.items() if not pair.is_held]
        touching += dict.fromkeys(x for x in found.at_once() if x not in touching)
        explore = self.options.explore
        zones = None
        if touching and explore is not None:
            self.options.stage("looking for a place that guards the zone ...")
            zones = Zones(found, self.comparison, explore, self.options.refused).proposals(
                seen.arms, touching
            )
        return self.layout_of(found, seen.moves, seen.pairs, began, tuple(zones or ()))

    def so_far(self) -> Layout:
        """What is wrong, when the time is up: only that is certain. How deep things overlap is not searched for."""
        began, known = time.perf_counter(), self.progress
        found = known.found
        if found is not None and known.seen is not None:  # a place that helps was being looked for
            return self.layout_of(found, known.seen.moves, known.seen.pairs, began)
        moves, pairs = list(known.moves), list(known.pairs)
        if found is not None and not found.graph.wider:
            moves += self._wrong_moves(found)
            touching = [m for m in (*known.arms.values(), *known.parts.values()) if m.is_touch]
            first = {m.told: m for m in reversed(touching)}
            pairs += [_met(m, m.apart, self._run(found, m.met)) for m in reversed(first.values())]
            pairs += self._turning(found)
        return Layout(
            self.layout,
            len(found.graph.arcs) if found is not None else 0,
            len(found.situations) if found is not None else 0,
            tuple(moves),
            tuple(pairs),
            self.comparison.compared,
            self.comparison.sweeper.queries,
            0.0,
            LATE,
            devices=tuple(r.name for r in self.cell.devices),
        )

    def _wrong_moves(self, found: Situations) -> Iterator[Move]:
        """What cannot be done, of what was looked at, and of what cannot even be planned."""
        known = self.progress
        yield from (m for m in known.at_start if m.answer == "no")
        yield from (m for m in (*known.rows.values(), *known.handled.values()) if m.answer == "no")
        told: set[object] = set(known.handled)
        for (number, _element), met in found.activities.items():
            activity = self.doing.activities[number]
            for leg, contents in activity.legs:
                load = contents.load(leg.robot)
                own = (leg.number, spots(tuple(p for p in load if p.holder)))
                if leg.fault is not None and own not in known.rows and own not in told:
                    told.add(own)
                    yield self._move(found, leg, load, met)
            if activity.is_part:
                row = self._handling(found, activity, met)
                key = (row.transition, row.command, row.begins)
                if key not in told:
                    told.add(key)
                    yield row

    def situations(self, graph: CellGraph) -> Situations:
        """All of them."""
        self.options.stage("looking where arms can be ...")
        found = Situations(graph, self.doing, self.robots)
        self.progress.begin(found)
        found.explore(HowFar(self.options.say, "looking where arms can be", noun="situations"))
        return found

    def seen(self, found: Situations) -> Seen:
        """All moves, and what does not surely keep apart."""
        self.options.stage("sweeping moves ...")
        at_start = self.progress.at_start = tuple(self._at_start())
        moves = [*at_start, *self._moves(found)]
        self.options.stage("sweeping pairs ...")
        arms = self._pairs(found)
        return Seen(tuple(moves), arms, (*self._parts(found), *self._turning(found)))

    def layout_of(
        self,
        found: Situations,
        moves: tuple[Move, ...],
        pairs: tuple[Pair, ...],
        began: float,
        proposals: tuple[Proposal, ...] = (),
    ) -> Layout:
        """With the sizes of what was looked at."""
        is_apart = not found.stopped and not any(p.answer == "no" for p in pairs)
        return Layout(
            self.layout,
            len(found.graph.arcs),
            len(found.situations),
            moves,
            pairs,
            self.comparison.compared,
            self.comparison.sweeper.queries,
            time.perf_counter() - began,
            reason(found.why),
            proposals,
            self.comparison.nearest() if is_apart else None,
            found.stopped,
            tuple(r.name for r in self.cell.devices),
            open_at=tuple(self._open_at(found)),
        )

    def _open_at(self, found: Situations) -> Iterator[Open]:
        """Where it is that not all is known, but for what is wrong there."""
        for doubt in found.doubts:
            if not doubt.is_sure:
                who = [_who(found, e) for e in doubt.met.elements]
                yield Open(
                    tuple(owner for _, owner in who),
                    tuple(t for t, _ in who),
                    reason(doubt.why),
                    doubt.says,
                    doubt.do,
                    self._run(found, doubt.met),
                )

    def _turning(self, found: Situations) -> Iterator[Pair]:
        """Parts that are handled on plates which move."""
        for doubt in found.doubts:
            if doubt.is_sure:
                (t, owner), (u, other) = (_who(found, e) for e in doubt.met.elements)
                does = tuple(
                    "; ".join(dict.fromkeys(map(words, found.graph.commands(e))))
                    for e in doubt.met.elements
                )
                run = self._run(found, doubt.met)
                yield Pair(
                    (owner, other), (t, u), (does[0], does[1]), "no", doubt.says, run=run, do=APART
                )

    # --- moves -----------------------------------------------------------------------------------

    def _moves(self, found: Situations) -> list[Move]:
        rows, handled = self.progress.rows, self.progress.handled
        looked: set[tuple[int, str]] = set()
        activities = (self.doing.activities[number] for number, _ in found.activities)
        legs = ((x, c.load(x.robot)) for a in activities for x, c in a.legs)
        with self.comparison.moves_ahead(filter(self._is_looked_at, legs), self.options.jobs):
            self._each_move(found, rows, looked, handled)
        return [*rows.values(), *handled.values()]

    @staticmethod
    def _is_looked_at(moved: tuple[Leg, Load]) -> bool:
        """An arm at rest with nothing in its tool is no move, but for where it rests at all."""
        leg, load = moved
        return leg.fault is not None or leg.is_moving or bool(load) or leg.command is None

    def _each_move(
        self,
        found: Situations,
        rows: dict[tuple[int, str], Move],
        looked: set[tuple[int, str]],
        handled: dict[tuple[str, str, str], Move],
    ) -> None:
        more = HowFar(self.options.say, "sweeping moves", total=len(found.activities))
        for (number, _element), met in found.activities.items():
            more()
            activity = self.doing.activities[number]
            for leg, contents in activity.legs:
                load = contents.load(leg.robot)
                key = (leg.number, spots(load))
                is_at_rest = leg.fault is None and not leg.is_moving
                if key in looked or not self._is_looked_at((leg, load)):
                    continue
                looked.add(key)
                row = self._move(found, leg, load, met)
                # Whatever stands on its turntables meanwhile, it is one move: the worst of them is told.
                held = tuple(p for p in load if p.holder)
                own = (leg.number, spots(held))
                is_told = leg.command is not None and not (is_at_rest and not held)
                if is_told or row.answer != "yes":
                    rows[own] = min(rows[own], row, key=_how_bad) if own in rows else row
            if activity.is_part or activity.doubt:
                row = self._handling(found, activity, met)
                key_ = (row.transition, row.command, row.begins)
                if key_ not in handled or (handled[key_].answer, row.answer) == ("unknown", "no"):
                    handled[key_] = row

    def _at_start(self) -> list[Move]:
        """Parts that cannot be where cell.toml puts them."""
        out = []
        for part, trouble in self.doing.overlaps_at_start():
            answer: Verdict = "no" if trouble.margin < -ROUNDING else "unknown"
            does = f"stands at {numbers(pose_of(part.frame))}"
            placed = "at its `rack`" if part.is_tool else f"as `[parts.{part.kind.name}]` places it"
            why = f"`{part.name}`, {placed}, {trouble.text}"
            out.append(Move(part.name, "", does, "", "part", answer, why))
        return out

    def _handling(self, found: Situations, activity: Activity, met: Met) -> Move:
        """What an action cannot do to a part, or perhaps cannot."""
        t, owner = _who(found, met.elements[0])
        begins = ""
        if activity.end is not None:
            begins = stands_at(self.cell.robot(owner), activity.end)
        does = words(activity.command)
        run = self._run(found, met)
        answer: Verdict = "no" if activity.is_part else "unknown"
        why = activity.fault or activity.doubt
        return Move(owner, t, does, begins, "tool", answer, why, run=run)

    def _move(self, found: Situations, leg: Leg, load: Load, met: Met) -> Move:
        t, _ = _who(found, met.elements[0])
        begins = stands_at(self.cell.robot(leg.robot), leg.start)
        held = [p for p in load if p.holder]
        does = words(leg.command) + carrying(leg.command, held)
        if leg.fault is not None:
            return Move(
                leg.robot,
                t,
                does,
                begins,
                leg.kind,
                "no",
                leg.fault.message,
                run=self._run(found, met),
            )
        is_device = self.cell.robot(leg.robot).is_device
        margins = self.comparison.margins(leg)
        scene, itself = self.comparison.around(leg, load)
        answer: Verdict = "yes"
        why = ""
        for apart, what in ((scene, ""), (itself, " of itself")):
            if apart.outcome == "touch" and answer != "no":
                answer, why = "no", touch_in_words(apart) + what + self._elsewhere(leg)
            elif apart.outcome == "open" and answer == "yes":
                answer, why = "unknown", as_in_runs(apart.why)
        for hurry, words_ in (
            self.comparison.hurries(leg, load),
            self.comparison.tilts(leg, load),
        ):
            if hurry == "no" and answer != "no" or hurry == "unknown" and answer == "yes":
                answer, why = hurry, words_
        return Move(
            leg.robot,
            t,
            does,
            begins,
            leg.kind,
            answer,
            why,
            None if is_device else math.degrees(margins.limit),
            0 if is_device else margins.axis + 1,
            None if is_device else margins.condition,
            certain(scene),
            certain(itself),
            gap_as_seen(scene.where),
            self._run(found, met) if answer != "yes" else None,
        )

    def _elsewhere(self, leg: Leg) -> str:
        """The branches in which a joint move to a pose could end besides, if nobody has chosen one; "": none."""
        robot = self.cell.robot(leg.robot)
        if not isinstance(leg.command, MoveJoint) or robot.branch is not None or robot.axes:
            return ""
        kinematics = robot.kinematics
        here = kinematics.branch_of(leg.end.q)
        others = other_branches(
            kinematics, kinematics.forward(leg.end.q), here, kinematics.arm_angle_of(leg.end.q)
        )
        return f"; it ends in branch {here}{others}" if "chooses" in others else ""

    # --- pairs -----------------------------------------------------------------------------------

    def _pairs(self, found: Situations) -> dict[tuple[Side, Side], Pair]:
        """Pairs of arms that are not surely apart; of what two transitions do the first that touches."""
        met_ = self.progress.arms
        activities = self.doing.activities
        pairs = [(activities[n], activities[m]) for n, m in found.pairs]
        all_sides = [
            found.sides(*pair, met) for pair, met in zip(pairs, found.pairs.values(), strict=True)
        ]

        touching: set[tuple[Side, Side]] = set()

        def is_open(i: int) -> bool:
            return all_sides[i] not in touching

        more = HowFar(self.options.say, "sweeping pairs", total=len(pairs))
        with self.comparison.pairs_ahead(pairs, self.options.jobs, is_open):
            for i, met in enumerate(found.pairs.values()):
                more()
                if is_open(i) and self._pair(pairs[i], all_sides[i], met, met_, found):
                    touching.add(all_sides[i])
        return dict(zip(met_, self._reported(found, met_.values()), strict=True))

    def _pair(
        self,
        pair: tuple[Activity, Activity],
        sides: tuple[Side, Side],
        met: Met,
        met_: dict[tuple[Side, Side], Meeting],
        found: Situations,
    ) -> bool:
        """Notes where two activities do not surely keep apart; gives whether they touch."""
        a, b = pair
        touches = False
        for leg, other, apart in self.comparison.activities(a, b):
            if apart.outcome == "clear":
                continue
            own = sides_of(found, sides, pair, (leg, other), apart)
            known = met_.get(own)
            is_touch = apart.outcome == "touch"
            touches = touches or is_touch
            if known is None or (is_touch and known.apart.outcome != "touch"):
                first, second = (
                    "" if side[1] == ON_PLATE else _who(found, e)[0]
                    for side, e in zip(own, met.elements, strict=True)
                )
                names = apart.where or _NOWHERE
                (does, thing), (its, its_thing) = (
                    self._does(activity, side, x, name)
                    for activity, side, x, name in zip(
                        pair, own, (leg, other), (names.a, names.b), strict=True
                    )
                )
                robots, things = (leg.robot, other.robot), (thing, its_thing)
                legs = (x for x in (*a.legs, *b.legs) if x[0] is leg or x[0] is other)
                around = around_of(found, met, legs)
                met_[own] = Meeting(
                    robots, (first, second), (does, its), apart, met, things, around
                )
            if is_touch and own == sides:
                break
        return touches

    def _does(self, activity: Activity, side: Side, leg: Leg, name: str) -> tuple[str, str]:
        """A command in words; of what is at rest where it stands, and what it is if it is no arm or device."""
        if side[1] == ON_PLATE:
            contents = next(c for own, c in activity.legs if own is leg)
            part = like(name, contents)[0]
            return f"stands at {at_rest(self.cell, part, leg.start)}", shown(name)
        if leg.command is not None:
            return words(leg.command), ""
        where = stands_at(self.cell.robot(leg.robot), leg.start)
        return f"stands at {where}" if where else "stands", ""

    def _reported(self, found: Situations, meetings: Iterable[Meeting]) -> list[Pair]:
        """With how deep they touch: surely of one of each two robots, of others as far as that takes not too long."""
        meetings = list(meetings)
        first: dict[tuple[object, ...], Meeting] = {}
        for m in meetings:
            first.setdefault(m.told, m)
        touching = [m for m in first.values() if m.apart.outcome == "touch"]
        touching.sort(key=lambda m: m.apart.nearest)
        deepest = set({m.robots: m for m in reversed(touching)}.values())
        depths: dict[Meeting, Apart] = {}
        begun = self.comparison.sweeper.queries
        for m in sorted(touching, key=lambda m: m not in deepest):
            asked = self.comparison.sweeper.queries - begun
            if m in deepest or asked < MOST_DEPTHS:
                depths[m] = self.comparison.deepest(m.apart)
        made = {
            key: _met(m, depths.get(m, m.apart), self._run(found, m.met))
            for key, m in first.items()
        }
        return [made[m.told] for m in meetings]

    def _parts(self, found: Situations) -> list[Pair]:
        """Arms, with what they carry, and parts that stand."""
        parts = found.parts() if found.beside else {}
        bad = self.progress.parts
        more = HowFar(self.options.say, "sweeping parts that stand", total=len(found.beside))
        for (number, i, where), met in found.beside.items():
            more()
            leg, contents = self.doing.activities[number].legs[i]
            part = parts[where]
            t, _ = _who(found, met.elements[0])
            key = (leg.robot, t, part.kind.name)
            if key in bad and bad[key].apart.outcome == "touch":
                continue
            apart = self.comparison.beside((leg, contents.load(leg.robot)), part)
            if apart.outcome == "clear" or (key in bad and apart.outcome == "open"):
                continue
            stands = f"{part.kind.name} stands at {numbers(pose_of(part.frame))}"
            does = (words(leg.command), stands)
            around = around_of(found, met, [(leg, contents)])
            bad[key] = Meeting((leg.robot, ""), (t, ""), does, apart, met, around=around)
        return self._reported(found, bad.values())

    # --- words and runs --------------------------------------------------------------------------

    def _run(self, found: Situations, met: Met) -> Run | None:
        """A run to where something is under way; None: there are enough of them, or perhaps there is none."""
        if found.graph.wider:
            return None
        key = (found, met.situation, met.elements)
        if key not in self.runs and len(self.runs) < MOST_RUNS:
            self._numbered += 1
            layout = f"-{self.layout}" if self.layout else ""
            name = f"{self.options.stem}.geometry{layout}-{self._numbered}.trace.jsonl"
            file = self.options.folder / name
            under_way = [e for e in met.elements if e >= 0]
            try:
                path = found.path_to(met.situation)
                self.runs[key] = write(found.graph, path, under_way, file, self.options.initial)
            except OverError:
                file.unlink(missing_ok=True)  # half of it is no run
                raise
        return self.runs.get(key)

    def keep_runs(self, rows: Iterable[Move | Pair | Open]) -> None:
        """Removes the traces of all others."""
        kept = {row.run for row in rows if row.run is not None}
        for key, run in [*self.runs.items()]:
            if run not in kept:
                del self.runs[key]
                if run.file is not None:
                    run.file.unlink(missing_ok=True)


def _how_bad(row: Move) -> tuple[int, float]:
    """The worst comes first: an answer that is not yes, then the least clearance from the scene."""
    clearance = row.scene if row.scene is not None else -math.inf
    return ("no", "unknown", "yes").index(row.answer), clearance


def _who(found: Situations, element: int) -> tuple[str, str]:
    """The transition and the owner; of an arm that stands nobody."""
    if element < 0:
        return "", ""
    e = found.graph.elements[element]
    partition = found.graph.partition
    return partition.net.transitions[e.transition].name, partition.owners[e.owner].name


def _met(meeting: Meeting, apart: Apart, run: Run | None) -> Pair:
    """Two things that do not surely keep apart; a part has no robot, and no joints."""
    is_touch = apart.outcome == "touch"
    says = touch_in_words(apart) if is_touch else as_in_runs(apart.why)
    apart = as_seen(apart)
    joints = zip(meeting.robots, apart.joints, strict=False)
    return Pair(
        meeting.robots,
        meeting.transitions,
        meeting.doing,
        "no" if is_touch else "unknown",
        says,
        apart.where,
        apart.where.distance if apart.where else 0.0,
        tuple((r, tuple(map(float, q))) for r, q in joints if r),
        run,
        around=meeting.around,
        least=_most_in(apart) if is_touch else None,
        is_held=is_touch and bool(apart.why),
        things=meeting.things,
    )


def certain(apart: Apart) -> float | None:
    """The distance (m) below which nothing comes, negative where it touches; None: that is not known."""
    return None if apart.outcome == "open" or math.isinf(apart.least) else apart.least


def _most_in(apart: Apart) -> float:
    """The least distance (m) that the links which touch can have anywhere on the way."""
    assert apart.where is not None
    # Nearer to where the move leads they may touch, and may be deeper by so much than here.
    permitted = PART_CONTACT if apart.where.is_early else apart.nearest - apart.where.distance
    return min(apart.least - permitted, apart.where.distance)


def touch_in_words(apart: Apart) -> str:
    """Which links overlap, where, by how much, and that it is nowhere much more, if that is known."""
    gap = apart.where
    assert gap is not None
    if apart.why:
        return as_in_runs(apart.why)
    at = ", ".join(f"{1000.0 * v:.0f}" for v in gap.point)
    least = "" if apart.is_whole else "at least "
    text = f"{shown(gap.a)} and {shown(gap.b)} overlap by {least}{-1000.0 * gap.distance:.1f} mm at ({at}) mm"
    if gap.is_early:
        text += EARLY
    if not apart.is_whole:
        return f"{text}; where it is deepest was not searched for"
    if certain(apart) is None:
        return f"{text}; how deep on the rest of the way is not known"
    most = -1000.0 * _most_in(apart)
    return f"{text}, and nowhere on the way by more than {math.ceil(10.0 * most) / 10.0:.1f} mm"
