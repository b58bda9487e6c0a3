"""Which part a move goes to, of those that a tool may touch because it grips their kind.

    grips = GripContacts(cell)
    grips.between("arm/tool_tip", "box.2")      # ("arm", "box.2"): permitted because `arm` grips boxes; else None
    ends = MoveEnds.of(cell.robot("arm"), "", motion.trajectory)
    ends.is_at(part, T_world_part)              # whether the move begins or ends at this part

On lines and arcs the contact links of a tool may touch the part that is gripped, put down or worked on, and no other
one of its kind. Runs and the proofs over all runs ask the same question, about one move and one part; so it does not
matter which other parts there are.
"""

from __future__ import annotations

import fnmatch

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.hulls import Hull
from pn2code.robot.part import Part, carried_to
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import PART_CONTACT, CellRobot, RobotCell
from pn2code.robot.trajectories import Trajectory
from pn2code.robot.transforms import Array, difference, inverse, matrix_of

BEYOND = 0.03
"""m: so far beyond its ends a move leads to a part, too: the rest of the way is another line."""
_NEAR_END = 0.01
"""Of the way: from here to its end it gives the direction in which that leads."""


class GripContacts:
    """Contacts that are permitted only because a tool grips parts of a kind."""

    def __init__(self, cell: RobotCell) -> None:
        self._rules = cell.scene.contacts
        self._known: dict[tuple[str, str], tuple[str, str] | None] = {}

    def between(self, a: str, b: str) -> tuple[str, str] | None:
        """The robot that grips, and the part; None: nothing permits it, or something else does."""
        if (a, b) not in self._known:
            self._known[a, b] = self._looked_up(a, b)
        return self._known[a, b]

    def _looked_up(self, a: str, b: str) -> tuple[str, str] | None:
        found = None
        for tool, part in ((a, b), (b, a)):
            for rule in self._rules:
                if fnmatch.fnmatchcase(tool, rule.a) and fnmatch.fnmatchcase(part, rule.b):
                    if not rule.grips:
                        return None
                    found = tool.partition("/")[0], part
        return found


@frozen(eq=False)
class _End:
    """One end of a move.

    Args:
        q: the joint position; grip: `T_world_tcp` of the tool that grips.
        points: of all tool frames, in the world; outward: where the move leads, away from its middle, of length 1, or
            0 if it only turns.
    """

    q: Array
    grip: Array
    points: tuple[Array, ...]
    outward: Array


@frozen(eq=False)
class MoveEnds:
    """Both ends of a move."""

    robot: CellRobot
    ends: tuple[_End, ...]

    @staticmethod
    def of(robot: CellRobot, tool: str, path: Trajectory) -> MoveEnds:
        """Of a move with a tool that is changed, or without ("")."""
        joints = path.on_way(np.array([0.0, _NEAR_END, 1.0 - _NEAR_END, 1.0]))
        frames = [robot.T_world_base @ robot.kinematics.forward(q) for q in joints]
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
            ends.append(_End(joints[end], grip, points, outward))
        return MoveEnds(robot, tuple(ends))

    def is_at(self, part: Part, frame: Array, less: float = 0.0) -> bool:
        """Whether the tool grips a part or works on it at an end of the move, or up to `BEYOND` further straight on.

        It works on a part if a tool frame is in it or touches it.

        Args:
            frame: where the part is in the world; of one that the robot itself moves that is worked out.
            less: m and rad, by how much what counts is narrowed.
        """
        kind = part.kind
        assert isinstance(kind, PartKind), "tools are coupled, not gripped"
        hulls = Hull.of(kind.shape)
        for end in self.ends:
            own = part.carrier == self.robot.name
            at = carried_to(self.robot, end.q, part) if own else frame
            if _is_gripped(kind, at, end, less):
                return True
            back = inverse(at)
            turned = back[:3, :3] @ end.outward
            for point in end.points:
                place = back[:3, :3] @ point + back[:3, 3]
                if any(_is_met(hull, place, turned, PART_CONTACT - less) for hull in hulls):
                    return True
        return False


def _is_gripped(kind: PartKind, frame: Array, end: _End, less: float) -> bool:
    """Whether a part is where a tool grips it, or further on in the direction of the move."""
    for grip in kind.grips or (None,):
        place = frame if grip is None else frame @ matrix_of(grip)
        off = place[:3, 3] - end.grip[:3, 3]
        off = off - min(max(float(off @ end.outward), 0.0), BEYOND) * end.outward
        if float(np.linalg.norm(off)) > kind.tolerance - less:
            continue
        if grip is None or difference(place, end.grip)[1] <= kind.angle - less:
            return True
    return False


def _is_met(hull: Hull, point: Array, outward: Array, around: float) -> bool:
    """Whether a point that goes straight on comes into a convex body, or as near to each of its faces."""
    off = hull.normals @ point - (hull.normals @ hull.corners.T).max(axis=1) - around
    speed = hull.normals @ outward
    leaves, enters = speed > 1e-9, speed < -1e-9
    first = max(0.0, float((off[enters] / -speed[enters]).max(initial=0.0)))
    last = min(BEYOND, float((off[leaves] / -speed[leaves]).min(initial=BEYOND)))
    return bool((off[~leaves & ~enters] <= 0.0).all()) and first <= last
