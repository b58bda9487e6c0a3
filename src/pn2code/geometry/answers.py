"""What is known of the geometry of a cell: moves, pairs, and what would keep pairs apart."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Literal

from pn2code.base.frozen import frozen
from pn2code.geometry.claims import kept_apart
from pn2code.geometry.runs import Run
from pn2code.robot.backend import Clearance
from pn2code.robot.part import Part
from pn2code.robot.transforms import Array


@frozen(eq=False)
class Nearest:
    """How near two arms come, with what they hold.

    Args:
        where: what was measured (None: nothing so near); between: of it what and what, and who holds it, in words.
        least: m that are certain, of all pairs.
    """

    where: Clearance | None
    least: float
    between: str = ""


STOPPED = "looked at as far as runs get: a move before is impossible"
Verdict = Literal["yes", "no", "unknown"]
_WORST: tuple[Verdict, ...] = ("no", "unknown", "yes")


def worst(verdicts: list[Verdict]) -> Verdict:
    """That of several together."""
    return min(verdicts, key=_WORST.index, default="yes")


@frozen
class Move:
    """A command of an arm from one place.

    Args:
        robot, transition: who does it, and the (first) transition that commands it.
        command: in words; begins: the TCP pose where it begins, in words; of a device its axes.
        kind: "ptp", "lin", or what an arm does that stands.
        answer: whether it can be done; problem: why not, or why it is not known.
        limit: deg, the least distance from a limit of an axis; axis: which one (from 1).
        condition: the worst condition number; of an arm in a singularity it is inf.
        scene, itself: m, the least clearance that is certain, from the scene and from the arm itself; `apart`: the
            nearest thing. None: not measured.
        run: leads to where it is under way, if something is wrong.
    """

    robot: str
    transition: str
    command: str
    begins: str
    kind: str
    answer: Verdict
    problem: str = ""
    limit: float | None = None
    axis: int = 0
    condition: float | None = None
    scene: float | None = None
    itself: float | None = None
    apart: Clearance | None = None
    run: Run | None = None

    def row(self) -> dict[str, Any]:
        """For programs."""
        return {
            "robot": self.robot,
            "transition": self.transition,
            "command": self.command,
            "from": self.begins,
            "kind": self.kind,
            "answer": self.answer,
            "problem": self.problem,
            "limit_deg": _rounded(self.limit, 4),
            "axis": self.axis or None,
            "condition": _rounded(self.condition, 3),
            "singular": self.condition is not None and math.isinf(self.condition),
            "clearance_m": _rounded(self.scene, 5),
            "own_clearance_m": _rounded(self.itself, 5),
            "nearest": [self.apart.a, self.apart.b] if self.apart else None,
            "run": run_row(self.run),
        }


@frozen(eq=False)
class Around:
    """What else is there where two things touch.

    Args:
        stands: of each arm and device where it rests, or has begun what it does (rad).
        parts: also those in tools and on plates.
    """

    stands: Mapping[str, Array]
    parts: tuple[Part, ...]


@frozen
class Pair:
    """Two things that can be under way at once and do not surely keep apart.

    Args:
        robots: whose they are; the second "" of a part that stands.
        doing: transitions and commands, in words.
        things: of what rests, its name if that is not the arm or device but what stands on it.
        answer: "no" or "unknown"; says: why.
        where: what meets what, and where; distance: m, negative: an overlap; least: nowhere is it less (None: unknown).
        joints: where the arms are then, by robot, rad.
        run: in which they are under way.
        is_held: whether one of them is a clamp that holds what the other one takes along: no free zone would help.
        do: what the user can do; "": see the proposals.
        around: what else is there then, for pictures; None: nobody knows.
    """

    robots: tuple[str, str]
    transitions: tuple[str, str]
    doing: tuple[str, str]
    answer: Verdict
    says: str
    where: Clearance | None = None
    distance: float = 0.0
    joints: tuple[tuple[str, tuple[float, ...]], ...] = ()
    run: Run | None = None
    picture: str = ""
    least: float | None = None
    is_held: bool = False
    do: str = ""
    things: tuple[str, str] = ("", "")
    around: Around | None = None

    def row(self) -> dict[str, Any]:
        """For programs."""
        return {
            "robots": [r for r in self.robots if r],
            "transitions": list(self.transitions),
            "doing": list(self.doing),
            "things": [x or None for x in self.things],
            "answer": self.answer,
            "says": self.says,
            "links": [self.where.a, self.where.b] if self.where else None,
            "point_m": [round(v, 4) for v in self.where.point] if self.where else None,
            "distance_m": round(self.distance, 6),
            "at_least_m": _rounded(self.least, 6),
            "joints": {name: [round(v, 6) for v in q] for name, q in self.joints},
            "run": run_row(self.run),
            "picture": self.picture or None,
        }


@frozen
class Rest:
    """An arm or device that rests in a zone, or a part on a turntable, lift or belt of one.

    Args:
        at: where (the TCP pose, of a device where its axes are, of a part its place); from_start: already when a run
            begins.
        thing: the part, and on what; "": it is the arm or device.
    """

    robot: str
    at: str
    from_start: bool
    thing: str = ""


@frozen
class Served:
    """A place of the net that keeps some of a zone's transitions from others, but not all of them.

    Args:
        place: its token is taken whenever one of `during` is under way, and not always while one of `but` is.
    """

    place: str
    during: tuple[str, ...]
    but: tuple[str, ...]


@frozen
class Proposal:
    """A place that would keep pairs apart.

    Args:
        robots: that share the zone; transitions: of which not two may be under way at once.
        name: of the new place, with one token, or of one that is there.
        takes, gives: the transitions of the supervisor that take the token, and that give it back.
        takes_when, gives_when: of each of them in which case, in CPN ML; "": whenever it occurs.
        while_: the places that are marked meanwhile; while_with: with which tokens, "": any.
        rests: of what only rests in the zone: who, where, and whether it does from the start.
        works: whether the pairs keep apart with it, and the cell still comes to its end; says: what was found.
        is_there: the place is there, and `takes` and `gives` are those that have to use it as well.
        served: places that are there and keep some of the transitions apart.
        refused: what `generate` would say of the supervisor with it, and does not say without; "": nothing.
    """

    robots: tuple[str, ...]
    transitions: tuple[str, ...]
    name: str = ""
    takes: tuple[str, ...] = ()
    gives: tuple[str, ...] = ()
    while_: tuple[str, ...] = ()
    takes_when: tuple[str, ...] = ()
    gives_when: tuple[str, ...] = ()
    while_with: tuple[str, ...] = ()
    rests: tuple[Rest, ...] = ()
    works: bool = False
    says: str = ""
    is_there: bool = False
    served: tuple[Served, ...] = ()
    refused: str = ""

    def row(self) -> dict[str, Any]:
        """For programs."""
        return {
            "robots": list(self.robots),
            "transitions": list(self.transitions),
            "place": self.name or None,
            "place_is_there": self.is_there,
            "served": [
                {"place": x.place, "during": list(x.during), "but_not": list(x.but)}
                for x in self.served
            ],
            "takes": list(self.takes),
            "gives": list(self.gives),
            "while": list(self.while_),
            "takes_when": [x or None for x in self.takes_when],
            "gives_when": [x or None for x in self.gives_when],
            "while_with": [x or None for x in self.while_with],
            "rests": [
                {
                    "robot": x.robot,
                    "at": x.at,
                    "from_start": x.from_start,
                    "thing": x.thing or None,
                }
                for x in self.rests
            ],
            "works": self.works,
            "says": self.says,
            "refused": self.refused or None,
        }


@frozen
class Open:
    """Where it is that not all is known.

    Args:
        owners: whose programs; transitions: what is under way then.
        why: in general; says: what of it is known; do: what can be done.
        run: in which these are under way.
    """

    owners: tuple[str, ...]
    transitions: tuple[str, ...]
    why: str
    says: str
    do: str
    run: Run | None = None

    def row(self) -> dict[str, Any]:
        """For programs."""
        return {
            "owners": list(self.owners),
            "transitions": list(self.transitions),
            "why": self.why,
            "says": self.says,
            "do": self.do,
            "run": run_row(self.run),
        }


@frozen
class Layout:
    """What is known of a layout.

    Args:
        name: "" where there are none.
        states, situations: that were seen; looked: pairs of legs that were compared, and `queries` distances measured.
        open: why not all situations are known; "": they are.
        nearest: the pair of arms that comes nearest, if all keep apart.
        stopped: whether runs stop at a move that is impossible, so that nobody looked at what would come after it.
        devices: those of which something moves.
        open_at: where it is that not all situations are known.
        is_wider: the states are those of a net that does more than the cell.
    """

    name: str
    states: int
    situations: int
    moves: tuple[Move, ...]
    pairs: tuple[Pair, ...]
    looked: int
    queries: int
    seconds: float
    open: str = ""
    proposals: tuple[Proposal, ...] = ()
    nearest: Nearest | None = None
    stopped: bool = False
    devices: tuple[str, ...] = ()
    is_wider: bool = False
    open_at: tuple[Open, ...] = ()

    @property
    def of_moves(self) -> Verdict:
        """Whether each move can be done from wherever the arm can be then."""
        found = worst([m.answer for m in self.moves])
        return "unknown" if self.open and found == "yes" else found

    @property
    def of_pairs(self) -> Verdict:
        """Whether no two arms, and no arm and part, collide in any interleaving that the net permits."""
        found = worst([p.answer for p in self.pairs])
        return "unknown" if (self.open or self.stopped) and found == "yes" else found

    @property
    def pairs_open(self) -> str:
        """Why not all pairs are known although all situations are; "": they are."""
        return STOPPED if self.stopped else ""

    @property
    def answer(self) -> Verdict:
        """Both together."""
        return worst([self.of_moves, self.of_pairs])

    def row(self) -> dict[str, Any]:
        """For programs (docs/geometry.md)."""
        return {
            "layout": self.name or None,
            "devices": list(self.devices),
            "pairs_says": kept_apart(devices=bool(self.devices)),
            "answer": self.answer,
            "moves_answer": self.of_moves,
            "pairs_answer": self.of_pairs,
            "open": self.open or None,
            "open_at": [x.row() for x in self.open_at],
            "pairs_open": self.pairs_open or None,
            "states": self.states,
            "wider": self.is_wider,
            "situations": self.situations,
            "pairs_compared": self.looked,
            "distances_measured": self.queries,
            "seconds": round(self.seconds, 2),
            "nearest": self._nearest_row(),
            "moves": [m.row() for m in self.moves],
            "pairs": [p.row() for p in self.pairs],
            "proposals": [p.row() for p in self.proposals],
        }

    def _nearest_row(self) -> dict[str, Any] | None:
        if self.nearest is None:
            return None
        where = self.nearest.where
        return {
            "links": [where.a, where.b] if where else None,
            "between": self.nearest.between or None,
            "distance_m": round(where.distance, 5) if where else None,
            "at_least_m": round(self.nearest.least, 5),
        }


def run_row(run: Run | None) -> dict[str, Any] | None:
    """For programs."""
    if run is None:
        return None
    return {
        "trace": str(run.file) if run.file is not None else None,
        "steps": run.steps,
        "under_way": run.under_way,
    }


def _rounded(value: float | None, digits: int) -> float | None:
    if value is None or value != value or value in (float("inf"), float("-inf")):
        return None
    return round(value, digits)
