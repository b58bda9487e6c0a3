"""Legs in space: where the links of an arm are within a piece of a leg, and by how much their points may be off.

    arm = ArmShape.of(robot, backend)
    track = Track(arm, leg)
    rows = track.knots(np.array([0.25]), np.array([0.5]))
    rows.spread                     # (1, links): in this quarter of the way no point of a link is further than this (m)
                                    # from where it is in the middle of it

Joint moves are straight lines of joint positions. When the joints turn one after the other, the last one first, each
turns what comes after it about an axis that stands still meanwhile; so a point goes no further than the sum of angle
times distance from the axis. On lines the joints come from the inverse kinematics: `lines` says how far each may turn.
"""

from __future__ import annotations

import itertools

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.geometry.legs import Leg
from pn2code.geometry.lines import Follower
from pn2code.robot.active_motion import turned_by
from pn2code.robot.along import AlongTrajectory
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.gripped import MoveEnds
from pn2code.robot.part import Part
from pn2code.robot.placed_links import placed_links
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.trajectories import JointTrajectory, LinearTrajectory, Still
from pn2code.robot.transforms import Array, Flags, Numbers

FEW = 2
"""So many pieces take about as long as some more of them do, so these are worked out at once: what they are divided
into ..."""
AHEAD, AHEAD_ON_LINES = 2, 1
"""... so many times. On lines a piece takes eight times as long."""


@frozen(eq=False)
class Link:
    """A rigid piece: a box, and the capsule around it, in the frame of the joint that moves it.

    Args:
        name: as in messages, "robot1/link_4".
        joint: which axis moves it last, from 1; 0: none; one more than there are: it is on the flange.
        corners: (8, 3); ends: of the capsule's axis, (2, 3); radius: of the capsule.
    """

    name: str
    joint: int
    corners: Array
    ends: Array
    radius: float

    @staticmethod
    def of(name: str, joint: int, T_joint_link: Array, low: Array, high: Array) -> Link:  # noqa: N803
        """Around a box in the frame of the link."""
        corners = np.array(list(itertools.product(*zip(low, high, strict=True))))
        middle, half = (low + high) / 2.0, (high - low) / 2.0
        long = int(np.argmax(half))
        radius = float(np.hypot(*np.delete(half, long)))
        ends = np.stack([middle, middle])
        ends[0, long] -= half[long]
        ends[1, long] += half[long]
        turn, shift = T_joint_link[:3, :3].T, T_joint_link[:3, 3]
        return Link(name, joint, corners @ turn + shift, ends @ turn + shift, radius)


@frozen(eq=False)
class ArmShape:
    """The links of an arm with its tool that have a shape."""

    robot: CellRobot
    links: tuple[Link, ...]

    @staticmethod
    def of(robot: CellRobot, backend: BulletBackend) -> ArmShape:
        """As the collision library has them."""
        links = []
        for name, joint, frame in placed_links(robot):
            box = backend.box(robot.name, name)
            if box is not None:
                links.append(Link.of(f"{robot.name}/{name}", joint, frame, *box))
        return ArmShape(robot, tuple(links))

    def holding(self, part: Part, low: Array, high: Array) -> Link:
        """A part that its tool or a turntable of it carries, as a further link."""
        if part.plate:
            axis = self.robot.index(part.plate.partition("/")[2])
            return Link.of(part.name, axis + 1, part.frame, low, high)
        frame = self.robot.kinematics.T_flange_tcp @ part.frame
        beyond = len(self.robot.arm.axes) + 1
        return Link.of(f"{self.robot.name}/{part.name}", beyond, frame, low, high)

    def moved(self, link: Link) -> Flags:
        """By which axes a link is moved, (axes,)."""
        joints = self.robot.kinematics.joints
        count = len(self.robot.arm.axes)
        if joints.stop < link.joint <= count:  # a turntable
            return np.asarray(np.arange(count) == link.joint - 1)
        return np.asarray(np.arange(count) < min(link.joint, joints.stop))


@frozen(eq=False)
class Knots:
    """Pieces of a leg, each by its middle.

    Args:
        q: joint positions in the middle, (n, axes).
        ends: of the capsules in the world, (n, links, 2, 3).
        spread: (n, links), see above; lost: nothing is known of these pieces, whatever it says, (n,).
    """

    q: Array
    ends: Array
    spread: Array
    lost: Flags

    def only(self, row: int) -> Knots:
        """One of them."""
        one = slice(row, row + 1)
        return Knots(self.q[one], self.ends[one], self.spread[one], self.lost[one])

    def pick(self, rows: Numbers) -> Knots:
        """Some of them."""
        return Knots(self.q[rows], self.ends[rows], self.spread[rows], self.lost[rows])


class Track:
    """A leg of an arm, with the parts that it and its turntables carry.

    Args:
        shape: of the arm.
        leg: one that can be carried out.
        load: what is carried, as links.
        parts: the same for the collision library.
    """

    def __init__(
        self, shape: ArmShape, leg: Leg, load: tuple[Link, ...] = (), parts: tuple[Part, ...] = ()
    ) -> None:
        assert leg.path is not None
        self.shape, self.leg, self.parts = shape, leg, parts
        self.links = shape.links + load
        self.radii = np.array([x.radius for x in self.links])
        self._corners = np.stack([x.corners for x in self.links])
        self._ends = np.stack([x.ends for x in self.links])
        self._joints = np.array([x.joint for x in self.links])
        self._moved = np.stack([shape.moved(x) for x in self.links])
        arm = shape.robot.arm
        self._slides = [arm.slides(j) for j in range(len(arm.axes))]
        self.names = {x.name: i for i, x in enumerate(self.links)}
        assert len(self.names) == len(self.links), "each link has a name of its own"
        self._rows: dict[tuple[float, float], tuple[int, int]] = {}
        self._kept: list[Knots] = []
        self._follower: Follower | None = None
        self._is_lost = False
        self._both: MoveEnds | None = None
        self.is_still = isinstance(leg.path, Still) or (
            isinstance(leg.path, JointTrajectory) and not np.any(leg.path.turns)
        )
        path = leg.path.led if isinstance(leg.path, AlongTrajectory) else leg.path
        if isinstance(path, LinearTrajectory):
            self._follower = Follower(path.kinematics, path)

    @property
    def robot(self) -> str:
        """Whose it is."""
        return self.leg.robot

    @property
    def is_calm(self) -> bool:
        """Whether its turntables stand meanwhile."""
        return not self.turning

    @property
    def turning(self) -> frozenset[str]:
        """Its turntables, or belts and other axes of a device, that move meanwhile."""
        assert self.leg.path is not None
        return turned_by(self.shape.robot, self.leg.path)

    @property
    def ends(self) -> MoveEnds:
        """Both ends of the leg, with the tool in use; they are worked out once."""
        if self._both is None:
            assert self.leg.path is not None
            leg = self.leg
            self._both = MoveEnds.of(self.shape.robot, leg.start.tool, self.leg.path, leg.kind)
        return self._both

    @property
    def trouble(self) -> str:
        """Why nothing is known of what lies between samples of pieces that this question was about; "": it is."""
        return self._follower.trouble if self._follower is not None and self._is_lost else ""

    def begin(self) -> None:
        """A question begins: what others have asked before, here or in another process, is none of its business."""
        self._is_lost = False

    def knots(self, a: Array, b: Array) -> Knots:
        """The pieces from fraction a to b of the way, (n,) each; each is worked out once."""
        keys = list(zip(a.tolist(), b.tolist(), strict=True))
        new = [key for key in dict.fromkeys(keys) if key not in self._rows]
        if new:
            new = self._with_parts(new)
            ends = np.array(new)
            found = self._worked_out(ends[:, 0], ends[:, 1])
            first = len(self._kept)
            self._kept.append(found)
            for row, key in enumerate(new):
                self._rows[key] = (first, row)
        where = [self._rows[key] for key in keys]
        if len(where) == 1:
            batch, row = where[0]
            found = self._kept[batch].only(row)
        elif len({batch for batch, _ in where}) == 1:
            found = self._kept[where[0][0]].pick(np.array([row for _, row in where]))
        else:
            found = Knots(
                np.stack([self._kept[batch].q[row] for batch, row in where]),
                np.stack([self._kept[batch].ends[row] for batch, row in where]),
                np.stack([self._kept[batch].spread[row] for batch, row in where]),
                np.stack([self._kept[batch].lost[row] for batch, row in where]),
            )
        self._is_lost = self._is_lost or bool(found.lost.any())
        return found

    def batch(self, a: float, b: float) -> tuple[Knots, int]:
        """A piece that has been asked for among those that were worked out together, and which of them it is."""
        number, row = self._rows[a, b]
        return self._kept[number], row

    def _with_parts(self, new: list[tuple[float, float]]) -> list[tuple[float, float]]:
        """Pieces that are new; if they are few, also what they will be divided into, which is asked for next."""
        if self.is_still or len(new) > FEW:
            return new
        wanted, latest = dict.fromkeys(new), new
        for _ in range(AHEAD if self._follower is None else AHEAD_ON_LINES):
            middles = [(a, (a + b) / 2.0, b) for a, b in latest]
            latest = [half for a, m, b in middles for half in ((a, m), (m, b))]
            wanted |= dict.fromkeys(key for key in latest if key not in self._rows)
        return list(wanted)

    def _worked_out(self, a: Array, b: Array) -> Knots:
        path = self.leg.path
        assert path is not None
        rigid: Array | None = None
        lost = np.zeros(len(a), bool)
        if self._follower is not None:
            q, turns, lost = self._follower.pieces(a, b)
            rigid = (b - a) / 2.0
            if isinstance(path, AlongTrajectory):
                q, own = path.whole(q, (a + b) / 2.0), turns
                turns = np.abs(path.delta) * rigid[:, None]
                turns[:, path.joints] = own
        elif isinstance(path, JointTrajectory):
            q = path.on_way((a + b) / 2.0)
            turns = np.abs(path.turns) * ((b - a) / 2.0)[:, None]
        else:
            q, turns = path.on_way(a), np.zeros((len(a), len(self.shape.robot.arm.axes)))
        return self._placed(q, turns, rigid, lost)

    def boxes(self, q: Array) -> Array:
        """The corners of each link in the world, at joint positions (n, axes): (n, links, 8, 3)."""
        frames = self.shape.robot.kinematics.link_frames(q)
        base = self.shape.robot.T_world_base
        eye = np.eye(4)[None].repeat(len(q), 0)
        placed = base @ np.stack([eye, *frames], axis=1)[:, self._joints]
        turn, shift = placed[..., :3, :3].transpose(0, 1, 3, 2), placed[..., None, :3, 3]
        return np.asarray(self._corners @ turn + shift)

    def speeds(self, a: Array, b: Array) -> Array:
        """How far points of a link go at most for one unit of the way, anywhere in pieces from a to b, (n, links).

        That is what it is in the middle of the piece if each axis goes as it does on average, and what can be different
        in the piece: how fast axes go, and how all turn what they carry.
        """
        path = self.leg.path
        assert path is not None
        half = (b - a) / 2.0
        if self._follower is not None:
            low, high = self._follower.rates(a, b)
            _, turns, _ = self._follower.pieces(a, b)  # of what is lost, `low` is not known
            if isinstance(path, AlongTrajectory):
                low, high = (self._whole(path, x) for x in (low, high))
                own, turns = turns, np.abs(path.delta) * half[:, None]
                turns[:, path.joints] = own
        elif isinstance(path, JointTrajectory):
            low = high = np.repeat(path.turns[None], len(a), axis=0)
            turns = np.abs(low) * half[:, None]
        else:
            return np.zeros((len(a), len(self.links)))
        q = self.knots(a, b).q
        is_known = np.isfinite(low).all(axis=1) & np.isfinite(turns).all(axis=1)
        out = np.full((len(a), len(self.links)), np.inf)
        if is_known.any():
            some = (x[is_known] for x in (q, low, high, turns, half))
            out[is_known] = self._of_known(*some)
        if self._follower is not None:
            last = self.shape.robot.kinematics.joints.stop
            for i, link in enumerate(self.links):
                if link.joint in (last, low.shape[1] + 1):
                    out[:, i] = np.minimum(out[:, i], self._on_line(link, np.ones(len(a))))
        return out

    @staticmethod
    def _whole(path: AlongTrajectory, own: Array) -> Array:
        out = np.repeat(np.asarray(path.delta, float)[None], len(own), axis=0)
        out[:, path.joints] = own
        return out

    def _of_known(self, q: Array, low: Array, high: Array, turns: Array, half: Array) -> Array:
        mean, off = (low + high) / 2.0, (high - low) / 2.0
        most = self._fastest(q, np.abs(mean) + off, turns)
        step = 1e-6
        both = [self.boxes(q + x * step * mean) for x in (-1.0, 1.0)]
        now = np.linalg.norm(both[1] - both[0], axis=3).max(axis=2) / (2.0 * step)
        turning = [not slides for slides in self._slides]
        turn = (np.abs(mean) + off)[:, turning].sum(axis=1)
        more = self._fastest(q, off, turns) + 2.0 * (turn * half)[:, None] * most
        return np.asarray(np.minimum(most, now + more + 1e-6))

    def _fastest(self, q: Array, rates: Array, turns: Array) -> Array:
        """As `_placed` has it: each axis turns what comes behind it, which is no further from it than there."""
        kinematics = self.shape.robot.kinematics
        frames = kinematics.link_frames(q)
        axes = kinematics.axes_of(frames)
        back = np.linalg.inv(self.shape.robot.T_world_base)
        corners = self.boxes(q) @ back[:3, :3].T + back[:3, 3]
        spread, fast = np.zeros((2, len(q), len(self.links)))
        origins = np.stack([f[:, :3, 3] for f in frames[: axes.shape[1]]], axis=1)
        off = _off_axes(axes, origins, corners)
        for j in reversed(range(rates.shape[1])):
            if self._slides[j]:
                way, speed = turns[:, j, None], rates[:, j, None] * np.ones_like(spread)
            else:
                arm = off[:, j] + spread
                way, speed = turns[:, j, None] * arm, rates[:, j, None] * arm
            fast = np.where(self._moved[:, j], fast + speed, fast)
            spread = np.where(self._moved[:, j], spread + way, spread)
        return fast

    def _placed(self, q: Array, turns: Array, rigid: Array | None, lost: Flags) -> Knots:
        kinematics = self.shape.robot.kinematics
        frames = kinematics.link_frames(q)
        axes = kinematics.axes_of(frames)
        base = self.shape.robot.T_world_base
        whole = np.empty((len(q), len(frames) + 1, 4, 4))
        whole[:, 0] = np.eye(4)
        whole[:, 1:] = np.stack(frames, axis=1)
        turn, shift = whole[:, :, :3, :3], whole[:, :, :3, 3]
        turn, shift = turn[:, self._joints].transpose(0, 1, 3, 2), shift[:, self._joints, None]
        corners = self._corners @ turn + shift
        ends = (self._ends @ turn + shift) @ base[:3, :3].T + base[:3, 3]
        spread = np.zeros((len(q), len(self.links)))
        off = _off_axes(axes, whole[:, 1 : axes.shape[1] + 1, :3, 3], corners)
        for j in reversed(range(turns.shape[1])):
            arm = 1.0 if self._slides[j] else off[:, j] + spread
            more = spread + turns[:, j, None] * arm
            spread = np.where(self._moved[:, j], more, spread)
        if rigid is not None:
            last = kinematics.joints.stop
            for i, link in enumerate(self.links):
                if link.joint in (last, turns.shape[1] + 1):
                    spread[:, i] = np.minimum(spread[:, i], self._on_line(link, rigid))
        return Knots(q, ends, spread, lost)

    def _on_line(self, link: Link, half: Array) -> Array:
        """How far a link beyond the last axis goes in half a piece of a line: as the TCP does."""
        path = self.leg.path
        assert isinstance(path, LinearTrajectory | AlongTrajectory)
        kinematics = self.shape.robot.kinematics
        led = path.led if isinstance(path, AlongTrajectory) else path
        tcp = led.kinematics.T_flange_tcp
        corners = link.corners
        if link.joint == kinematics.joints.stop:
            corners = (corners - kinematics.T_axis_flange[:3, 3]) @ kinematics.T_axis_flange[:3, :3]
        arm = float(np.linalg.norm(corners - tcp[:3, 3], axis=1).max())
        carried = 0.0
        if isinstance(path, AlongTrajectory):
            carried = float(np.abs(path.delta[: self.shape.robot.arm.tracks]).sum())
        return np.asarray(half * (path.line.length + path.line.angle * arm + carried))


def _off_axes(axes: Array, origins: Array, corners: Array) -> Array:
    """How far the furthest corner of each link (n, links, 8, 3) is from each axis (n, axes, 3): (n, axes, links)."""
    x, y, z = np.moveaxis(corners[:, None] - origins[:, :, None, None], -1, 0)
    u, v, w = np.moveaxis(axes, -1, 0)[..., None, None]
    a, b, c = v * z - w * y, w * x - u * z, u * y - v * x
    return np.asarray(np.sqrt((a * a + b * b + c * c).max(axis=3)))
