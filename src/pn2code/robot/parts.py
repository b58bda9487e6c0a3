"""Parts in a run: where each is, who carries it, and what an action of a tool or device does to it.

    parts = Parts(cell)
    done = parts.handle("robot1", Handling("takes", "blank"), T_world_tcp)      # PartChange; PartFault if it cannot be
    parts.poses({"robot1": T_world_tcp})                                        # {"blank.1": T_world_part}

Parts have the name of their kind and a number, in the order in which they come into the cell. A part that is carried
keeps its place in the tool. Nothing here measures distances: what a part rests on, and what it touches, is the
backend's to say.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.commands import Handling, Pose
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import Array, describe, difference, inverse, matrix_of, pose_of


class PartFault(Exception):  # noqa: N818
    """An action that cannot be: nothing to grip, nothing to release, a place that is taken."""


@frozen(eq=False)
class Part:
    """One part.

    Args:
        frame: `T_world_part`, or `T_tcp_part` while it is carried.
        holder: the robot that carries it, "" if it stands.
    """

    name: str
    kind: PartKind
    frame: Array
    holder: str = ""


@frozen
class PartChange:
    """What has become of a part.

    Args:
        effect: as in `Handling`; part: its name.
        pose: where it is, or was when it left, in the world.
    """

    effect: str
    part: str
    pose: Pose


@dataclass(slots=True)
class Parts:
    """All parts of a cell; begins with those that are there at the start."""

    cell: RobotCell
    present: dict[str, Part] = field(default_factory=dict)
    _numbers: dict[str, Iterator[int]] = field(init=False)

    def __post_init__(self) -> None:
        """Puts the parts of the start into the cell."""
        self._numbers = {kind: itertools.count(1) for kind in self.cell.parts}
        for kind in self.cell.parts.values():
            for pose in kind.at:
                self._add(kind, matrix_of(pose))

    def copy(self) -> Parts:
        """The same parts, to be handled otherwise; a new one gets the first number that none has."""
        out = Parts(self.cell)
        out.present = dict(self.present)
        used = [name.rsplit(".", 1) for name in self.present]
        for kind in self.cell.parts:
            last = max((int(number) for own, number in used if own == kind), default=0)
            out._numbers[kind] = itertools.count(last + 1)
        return out

    def held_by(self, robot: str) -> Part | None:
        """The part that a robot carries."""
        return next((p for p in self.present.values() if p.holder == robot), None)

    def pose(self, part: Part, T_world_tcp: Array) -> Array:
        """`T_world_part`; the TCP is that of its holder, if it has one."""
        return T_world_tcp @ part.frame if part.holder else part.frame

    def handle(self, who: str, handling: Handling, T_world_tcp: Array | None) -> PartChange:
        """Does to a part what an action does at its end.

        Args:
            who: the robot or device, for messages.
            T_world_tcp: of the robot; None: a device.

        Raises PartFault when it is not possible; nothing has changed then.
        """
        kind = self.cell.parts[handling.part]
        match handling.effect:
            case "takes":
                assert T_world_tcp is not None, "only a tool takes parts"
                return self._take(who, kind, T_world_tcp)
            case "releases":
                assert T_world_tcp is not None, "only a tool releases parts"
                return self._release(who, kind, T_world_tcp)
            case "creates":
                return self._create(who, kind, handling.place)
            case "removes":
                return self._remove(who, kind, handling.place)

    def _take(self, robot: str, kind: PartKind, tcp: Array) -> PartChange:
        held = self.held_by(robot)
        if held is not None:
            raise PartFault(
                f"`{robot}` takes a part `{kind.name}`, but its tool holds `{held.name}` already"
            )
        standing = [p for p in self.present.values() if p.kind is kind and not p.holder]
        at = f"at TCP pose {describe(pose_of(tcp))}"
        if not standing:
            raise PartFault(f"`{robot}` grips air: there is no part `{kind.name}` to take, {at}")
        near = min(standing, key=lambda p: _off(p, tcp))
        way, turn = _off(near, tcp)
        if way > kind.tolerance or turn > kind.angle:
            off = f"{1000.0 * way:.1f} mm"
            off += f" and {math.degrees(turn):.1f} deg" if turn > kind.angle else ""
            raise PartFault(
                f"`{robot}` grips air: the nearest part `{kind.name}`, `{near.name}`, is {off} from where it can be "
                f"gripped (at most {1000.0 * kind.tolerance:g} mm, {math.degrees(kind.angle):g} deg), {at}"
            )
        self.present[near.name] = Part(near.name, kind, inverse(tcp) @ near.frame, robot)
        return PartChange("takes", near.name, pose_of(near.frame))

    def _release(self, robot: str, kind: PartKind, tcp: Array) -> PartChange:
        held = self.held_by(robot)
        if held is None or held.kind is not kind:
            what = f"`{held.name}`" if held else "nothing"
            raise PartFault(
                f"`{robot}` releases a part `{kind.name}`, but its tool holds {what}, "
                f"at TCP pose {describe(pose_of(tcp))}"
            )
        frame = tcp @ held.frame
        self.present[held.name] = Part(held.name, kind, frame)
        return PartChange("releases", held.name, pose_of(frame))

    def _create(self, who: str, kind: PartKind, place: str) -> PartChange:
        pose = self.cell.places[place]
        there = self._at(place, kind)
        if there is not None:
            raise PartFault(
                f"`{who}` puts a part `{kind.name}` at place `{place}`, but `{there.name}` is there"
            )
        return PartChange("creates", self._add(kind, matrix_of(pose)).name, pose)

    def _remove(self, who: str, kind: PartKind, place: str) -> PartChange:
        there = self._at(place, kind)
        if there is None or there.kind is not kind:
            what = f"`{there.name}` is there" if there else "no part is there"
            raise PartFault(
                f"`{who}` removes a part `{kind.name}` from place `{place}`, but {what}"
            )
        del self.present[there.name]
        return PartChange("removes", there.name, pose_of(there.frame))

    def is_seen(self, place: str, kind: str = "") -> bool:
        """Whether a part (of a kind; "": of any) stands at a place, as it would be found there to be removed."""
        spot = matrix_of(self.cell.places[place])
        return any(
            not p.holder
            and kind in ("", p.kind.name)
            and difference(p.frame, spot)[0] <= p.kind.tolerance
            for p in self.present.values()
        )

    def _at(self, place: str, kind: PartKind) -> Part | None:
        """The part that stands at a place: those of the kind first."""
        spot = matrix_of(self.cell.places[place])
        near = [
            p
            for p in self.present.values()
            if not p.holder and difference(p.frame, spot)[0] <= p.kind.tolerance
        ]
        return min(near, key=lambda p: p.kind is not kind, default=None)

    def _add(self, kind: PartKind, frame: Array) -> Part:
        part = Part(f"{kind.name}.{next(self._numbers[kind.name])}", kind, np.asarray(frame))
        self.present[part.name] = part
        return part


def _off(part: Part, tcp: Array) -> tuple[float, float]:
    """How far (m) and how much turned (rad) the TCP is from where the part can be gripped."""
    if not part.kind.grips:
        return difference(part.frame, tcp)[0], 0.0
    offs = [difference(part.frame @ matrix_of(g), tcp) for g in part.kind.grips]
    fits = [o for o in offs if o[1] <= part.kind.angle]
    return min(fits or offs)
