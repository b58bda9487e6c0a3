"""Whether a move leads to a part that its tool grips or works on, or away from one.

    ends = MoveEnds.of(cell.robot("arm"), "", motion.trajectory)
    ends.is_at(box, T_world_part)              # whether the move begins or ends at a part of this kind

Which contacts that permits `led_contacts` says.
"""

from __future__ import annotations

from dataclasses import field

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.active_motion import PATHS, MotionKind, turned_by
from pn2code.robot.hulls import Hull
from pn2code.robot.laid import BEYOND
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import PART_CONTACT, CellRobot
from pn2code.robot.tools_table import ToolKind
from pn2code.robot.trajectories import Trajectory
from pn2code.robot.transforms import Array, difference, inverse, matrix_of

_NEAR_END = 0.01
"""Of the way: from here to its end it gives the direction in which that leads."""

Piece = tuple[float, float]
"""Of a move: from where to where, as fractions of its way."""


@frozen(eq=False)
class End:
    """One end of a move.

    Args:
        q: the joint position; grip: `T_world_tcp` of the tool that grips; coupling: of what couples it.
        points: of all tool frames, in the world; outward: where the move leads, away from its middle, of length 1, or
            0 if it only turns.
    """

    q: Array
    grip: Array
    coupling: Array
    points: tuple[Array, ...]
    outward: Array

    def is_at(self, kind: PartKind, frame: Array, less: float = 0.0) -> bool:
        """Whether the tool grips a part or works on it there, or up to `BEYOND` further straight on.

        It works on a part if a tool frame is in it or touches it.

        Args:
            frame: where the part is in the world.
            less: m and rad, by how much what counts is narrowed.
        """
        if _is_gripped(kind, frame, self, less):
            return True
        back = inverse(frame)
        turned = back[:3, :3] @ self.outward
        hulls = Hull.of(kind.shape)
        for point in self.points:
            place = back[:3, :3] @ point + back[:3, 3]
            if any(_is_met(hull, place, turned, PART_CONTACT - less) for hull in hulls):
                return True
        return False

    def couples(self, kind: ToolKind, place: Array, less: float = 0.0) -> bool:
        """Whether a tool that lies at a place is coupled or left there, or up to `BEYOND` further straight on."""
        way, turn = _off(place, self.coupling, self.outward)
        return way <= kind.tolerance - less and turn <= kind.angle - less


@frozen(eq=False)
class MoveEnds:
    """Both ends of a move.

    Args:
        tool: in use; "": none.
        is_path: whether it is a line or an arc; turning: the turntables, belts and other axes that it moves.
        length: m, of the way of the TCP, on the plate if it is led there.
        known: what was asked about it, and the answers.
    """

    robot: CellRobot
    ends: tuple[End, ...]
    tool: str
    is_path: bool
    turning: frozenset[str]
    length: float = 0.0
    known: dict[object, tuple[bool, ...]] = field(default_factory=dict)

    @staticmethod
    def of(robot: CellRobot, tool: str, path: Trajectory, kind: MotionKind = "lin") -> MoveEnds:
        """Of a move with a tool that is changed, or without ("")."""
        joints = path.on_way(np.array([0.0, _NEAR_END, 1.0 - _NEAR_END, 1.0]))
        frames = robot.T_world_base @ robot.kinematics.forward_many(joints)
        back = inverse(robot.kinematics.T_flange_tcp)
        further = [
            back @ own.T_flange_tcp
            for name, own in robot.tcps.items()
            if name == tool or name not in robot.tools
        ]
        ends = []
        for end, near in ((0, 1), (3, 2)):
            frame, grip = frames[end], robot.of_tool(tool, frames[end])
            way = grip[:3, 3] - robot.of_tool(tool, frames[near])[:3, 3]
            length = float(np.linalg.norm(way))
            outward = way / length if length > 1e-9 else np.zeros(3)
            points = (grip[:3, 3], *((frame @ own)[:3, 3] for own in further))
            ends.append(End(joints[end], grip, frame, points, outward))
        return MoveEnds(
            robot, tuple(ends), tool, kind in PATHS, turned_by(robot, path), path.length
        )

    def is_within(self, way: float, piece: Piece, end: int) -> bool:
        """Whether a piece of the move is no further (m) from its beginning (`end` 0), or its end (1), along the way."""
        first, last = piece
        return (last if end == 0 else 1.0 - first) * self.length <= way

    def is_at(self, kind: PartKind, frame: Array, less: float = 0.0) -> bool:
        """Whether one of them is at a part that stands there."""
        return any(end.is_at(kind, frame, less) for end in self.ends)


def _is_gripped(kind: PartKind, frame: Array, end: End, less: float) -> bool:
    """Whether a part is where a tool grips it, or further on in the direction of the move."""
    for grip in kind.grips or (None,):
        place = frame if grip is None else frame @ matrix_of(grip)
        way, turn = _off(place, end.grip, end.outward)
        if way <= kind.tolerance - less and (grip is None or turn <= kind.angle - less):
            return True
    return False


def _off(place: Array, frame: Array, outward: Array) -> tuple[float, float]:
    """How far (m) and how much turned (rad) a place is from a frame that goes straight on."""
    off = place[:3, 3] - frame[:3, 3]
    off = off - min(max(float(off @ outward), 0.0), BEYOND) * outward
    return float(np.linalg.norm(off)), difference(place, frame)[1]


def _is_met(hull: Hull, point: Array, outward: Array, around: float) -> bool:
    """Whether a point that goes straight on comes into a convex body, or as near to each of its faces."""
    off = hull.normals @ point - (hull.normals @ hull.corners.T).max(axis=1) - around
    speed = hull.normals @ outward
    leaves, enters = speed > 1e-9, speed < -1e-9
    first = max(0.0, float((off[enters] / -speed[enters]).max(initial=0.0)))
    last = min(BEYOND, float((off[leaves] / -speed[leaves]).min(initial=BEYOND)))
    return bool((off[~leaves & ~enters] <= 0.0).all()) and first <= last
