"""Contacts that are permitted only with what a move leads to, or comes from.

    led = LedContacts(cell)
    led.between("arm/tool_tip", "box.2")    # LedContact("arm", "", "box.2"): because the tool grips boxes
    led.between("arm/box.1", "pallet")      # LedContact("arm", "box.1", "pallet"): it can be put there
    led.between("arm/link_4", "pallet")     # None: something else permits it, or nothing does
    led.of_move(contact, ends, (carried, other), stands, (s, s))     # Led.NEAR: it leads there, and is there soon

On lines and arcs a tool may touch the part that is gripped, put down or worked on, and no other one of its kind. A part
that is carried may touch what it is put on or has been lifted from, and the jaws of the clamp in whose place it is.
All that near the end that is there: as far along the way of the TCP as `PartKind.way` of the part that is gripped or
carried says. Further away the move leads there, so what comes near is no news, but nothing may be touched yet.
What couples tools may touch the one that is coupled or left, and that one what holds it in its rack. What rides on a
plate, belt or other axis that moves may touch of what stands only that on which it stands before or afterwards.

Runs, the proofs over all runs and the search for places of arms ask the same question, about one move and one contact;
so it does not matter what else is there.
"""

from __future__ import annotations

import fnmatch
import math
from collections.abc import Callable, Iterator, Mapping
from enum import Enum

import numpy as np

from pn2code.base.frozen import frozen, replace
from pn2code.robot.backend import Clearance
from pn2code.robot.clamps import holding
from pn2code.robot.gripped import End, MoveEnds, Piece
from pn2code.robot.ground import Ground
from pn2code.robot.hulls import Hull
from pn2code.robot.laid import BEYOND, STEPS, is_laid
from pn2code.robot.part import Part, carried_to
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.tools_table import ToolKind
from pn2code.robot.transforms import Array, matrix_of


@frozen
class LedContact:
    """A robot that moves, the part in its tool ("": the tool itself), and what that touches: a part, or a thing."""

    robot: str
    part: str
    other: str

    @property
    def owner(self) -> str:
        """The robot or device of which the other thing is an axis; "": it is none."""
        return self.other.partition("/")[0] if "/" in self.other else ""

    def is_with(self, ends: MoveEnds | None) -> bool:
        """Whether the other thing is an axis that its owner moves: nothing may be put on it then."""
        return bool(self.part) and ends is not None and self.other in ends.turning


EARLY = ", further from where the move leads than `contact_way` of the part"
"""Of two that may touch, but not here."""


class Led(Enum):
    """What a move has to do with a contact that is permitted only if it leads there, or comes from there."""

    ELSEWHERE = "it leads elsewhere: both keep apart as any two"
    FAR = "it leads there, but is not near yet, or no more: they come near, and do not touch"
    NEAR = "it leads there and is near: the contact is permitted"


def with_move(gap: Clearance, led: Led) -> Clearance:
    """A permitted contact, as far as the move permits it."""
    if led is Led.NEAR:
        return gap
    return replace(gap, allowed=None if led is Led.ELSEWHERE else 0.0, is_early=led is Led.FAR)


Touching = tuple[Part | None, Part | None]
"""The part that is carried, and the one that is touched; None: a tool, or a thing of the scene."""


class LedContacts:
    """Those of a cell."""

    def __init__(self, cell: RobotCell) -> None:
        self._cell = cell
        self._rules = cell.scene.contacts
        self._known: dict[tuple[str, str], LedContact | None] = {}

    def between(self, a: str, b: str) -> LedContact | None:
        """What a contact of two is; None: nothing permits it, or it is permitted with whatever a move leads to."""
        if (a, b) not in self._known:
            self._known[a, b] = self._looked_up(a, b)
        return self._known[a, b]

    def _looked_up(self, a: str, b: str) -> LedContact | None:
        found = None
        for one, other in ((a, b), (b, a)):
            for rule in self._rules:
                if fnmatch.fnmatchcase(one, rule.a) and fnmatch.fnmatchcase(other, rule.b):
                    if not rule.led:
                        return None
                    robot, _, name = one.partition("/")
                    found = LedContact(robot, name if rule.led == "part" else "", other)
        return found

    def of_pair(
        self,
        a: str,
        b: str,
        ends_of: Callable[[str], MoveEnds | None],
        parts: Mapping[str, Part],
        stands: Callable[[str], Array],
        piece_of: Callable[[str], Piece],
        less: float = 0.0,
    ) -> Led:
        """What robots' moves have to do with a contact that is permitted as such; NEAR: no move is asked about it.

        Args:
            ends_of: of what a robot or device does, by name; None: it stands, or is not looked at.
            parts: by the names that they have in contacts; stands, less: as of `of_move`.
            piece_of: of the move of a robot that moves, by name.
        """
        rides = parts[a].plate if a in parts else ""
        contact = self.between(a, b) or self.of_rider(a, b, rides)
        if contact is None:
            return Led.NEAR
        if not rides and contact.is_with(ends_of(contact.owner)):
            return Led.ELSEWHERE
        ends = ends_of(contact.robot)
        if ends is None:
            return Led.NEAR
        if rides:
            if rides not in ends.turning or b in ends.turning:
                return Led.NEAR  # it stands, or goes on to a belt that runs as one with its own
        elif not ends.is_path:
            return Led.NEAR
        touching = parts.get(contact.part), parts.get(contact.other)
        return self.of_move(contact, ends, touching, stands, piece_of(contact.robot), less)

    def of_rider(self, a: str, b: str, plate: str) -> LedContact | None:
        """That of a part on a turntable, belt or other axis ("": on none) with what stands; None: rules permit it."""
        if not plate or any(
            fnmatch.fnmatchcase(one, rule.a) and fnmatch.fnmatchcase(other, rule.b)
            for rule in self._rules
            for one, other in ((a, b), (b, a))
        ):
            return None
        return LedContact(plate.partition("/")[0], a, b)

    def of_move(
        self,
        contact: LedContact,
        ends: MoveEnds,
        touching: Touching,
        stands: Callable[[str], Array],
        piece: Piece,
        less: float = 0.0,
    ) -> Led:
        """Whether a move leads to a contact, or comes from one: at its beginning or end, or up to `BEYOND` further.

        Args:
            stands: where the other robots and devices stand, by name.
            piece: of the move: it is near if all of this piece is.
            less: m and rad, by how much what counts is narrowed.
        """
        leading = self._leading(contact, ends, touching, stands, less)
        if not any(leading):
            return Led.ELSEWHERE
        way = _way(touching) - less
        is_near = (x and ends.is_within(way, piece, i) for i, x in enumerate(leading))
        return Led.NEAR if any(is_near) else Led.FAR

    def _leading(
        self,
        contact: LedContact,
        ends: MoveEnds,
        touching: Touching,
        stands: Callable[[str], Array],
        less: float,
    ) -> tuple[bool, ...]:
        """Of its beginning and its end whether they are there."""
        carried, other = touching

        def at(end: End) -> Array | None:
            own = ends.robot.name
            return self._frame(contact.other, other, lambda x: end.q if x == own else stands(x))

        frames = [at(end) for end in ends.ends]
        where = b"".join(frame.tobytes() for frame in frames if frame is not None)
        key = (contact, where, less)
        if key not in ends.known:
            ends.known[key] = tuple(
                self._is_at(end, contact, carried, (other, frame), less, ends)
                for end, frame in zip(ends.ends, frames, strict=True)
            )
        return ends.known[key]

    def _frame(self, name: str, part: Part | None, stands: Callable[[str], Array]) -> Array | None:
        """Where a part or a plate is, in the world; None: it is something else."""
        if part is not None:
            owner = part.carrier
            return carried_to(self._cell.robot(owner), stands(owner), part) if owner else part.frame
        plate = Ground.of(self._cell).plates.get(name)
        if plate is None or not plate.hulls:
            return None  # the body of a belt stands
        return plate.robot.T_world_plate(plate.axis, stands(plate.robot.name))

    def _is_at(
        self,
        end: End,
        contact: LedContact,
        carried: Part | None,
        touched: tuple[Part | None, Array | None],
        less: float,
        ends: MoveEnds,
    ) -> bool:
        other, frame = touched
        if carried is None:
            return self._is_at_tool(end, touched, less, ends)
        at = carried_to(ends.robot, end.q, carried)
        pieces = Ground.of(self._cell).placed(_work(carried), at)
        tops = self._tops(contact.other, other, frame)
        if carried.plate:
            return is_laid(pieces, np.zeros(3), tops, less)
        if is_laid(pieces, end.outward, tops, less):
            return True
        return contact.other in self._jaws(_work(carried), at, end.outward)

    def _is_at_tool(
        self,
        end: End,
        touched: tuple[Part | None, Array | None],
        less: float,
        ends: MoveEnds,
    ) -> bool:
        """Whether the tool is at a part, its coupling at a tool that lies there, or the tool in use at its rack."""
        other, frame = touched
        if other is None:
            kind = ends.robot.tools.get(ends.tool)
            if kind is None or not kind.rack:
                return False
            return end.couples(kind, matrix_of(self._cell.places[kind.rack]), less)
        assert frame is not None, "a part is somewhere"
        if isinstance(other.kind, ToolKind):
            return end.couples(other.kind, frame, less)
        return end.is_at(other.kind, frame, less)

    def _tops(self, name: str, part: Part | None, frame: Array | None) -> list[Hull]:
        ground = Ground.of(self._cell)
        if frame is None:
            return ground.pieces(name)
        if part is not None:
            return ground.placed(_work(part), frame)
        return [hull.at(frame) for hull in ground.plates[name].hulls]

    def _jaws(self, kind: PartKind, at: Array, outward: Array) -> Iterator[str]:
        """Of the clamps in which a part is, or is up to `BEYOND` further on."""
        for way in np.linspace(0.0, BEYOND, STEPS):
            place = at.copy()
            place[:3, 3] += way * outward
            for held in holding(self._cell, kind, place):
                yield from (f"{held.device.name}/{jaw}" for jaw in held.clamp.jaws)


def _way(touching: Touching) -> float:
    """m: how far before and behind it a contact is permitted; of tools, and of what rides on an axis, all the way."""
    carried, other = touching
    part = other if carried is None else carried
    if part is None or part.plate and part is carried or not isinstance(part.kind, PartKind):
        return math.inf
    return part.kind.way


def _work(part: Part) -> PartKind:
    assert isinstance(part.kind, PartKind), "tools are coupled, not gripped or put down"
    return part.kind
