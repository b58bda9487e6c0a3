"""Carrying out commands: one executor per robot, no clock of its own.

    executor = RobotExecutor(cell.robot("robot1"), cell.motion)
    motion = executor.begin(MoveJoint(pose), now)       # plans everything; MotionFault if it cannot be done
    motion.q(now + 0.5)                                 # at any time
    executor.finish()                                   # the robot is where the motion ends

The same commands give the same motions, whatever shows them: backends only replay joint positions.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import assert_never

import numpy as np

from pn2code.robot.active_motion import Motion, MotionKind
from pn2code.robot.along import AlongTrajectory, Led, plan_led
from pn2code.robot.blend import plan_through
from pn2code.robot.carried import WithAxes
from pn2code.robot.commands import (
    Along,
    Command,
    Measure,
    Move,
    MoveAxes,
    MoveCircular,
    MoveExternal,
    MoveHome,
    MoveJoint,
    MoveLinear,
    Pose,
    ToolAction,
    Wait,
    tcp_of,
)
from pn2code.robot.kinematics import Kinematics
from pn2code.robot.motion import plan_circ, plan_lin, plan_ptp, swivel_of
from pn2code.robot.motion_checks import check_axes
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.out_of_reach import unreachable
from pn2code.robot.robot_cell import CellRobot, MotionConfig
from pn2code.robot.time_law import MotionLimits
from pn2code.robot.tool_use import expect_tool, tool_after
from pn2code.robot.trajectories import LinearTrajectory, Still, Swivel, Trajectory
from pn2code.robot.transforms import Array, describe, difference, inverse, matrix_of, pose_of

CHECK_LENGTH = 0.005  # m: on a line, samples are no further apart than this on average,
CHECK_ANGLE = math.radians(2.0)  # nor than this
_OWN = np.eye(4)
_NO_FRAMES: Mapping[str, Pose] = MappingProxyType({})


class RobotExecutor:
    """One robot's state between commands: its joint position, and its tool in use; begins at HOME.

    Args:
        robot: the arm.
        config: how it moves.
        frames: in which poses can be given beside the world, by name; each in the world.
    """

    def __init__(
        self, robot: CellRobot, config: MotionConfig, frames: Mapping[str, Pose] = _NO_FRAMES
    ) -> None:
        self.robot = robot
        self.tool = robot.begins_with
        """Which of the tools that it changes is in use; "": none."""
        self._config = config
        self._limits = {tool: robot.limits(config, tool) for tool in ("", *robot.tools)}
        own = inverse(robot.kinematics.T_flange_tcp)
        self._tcps = {name: own @ k.T_flange_tcp for name, k in robot.tcps.items()}
        self._frames = {name: matrix_of(pose) for name, pose in frames.items()}
        self._T_world_base = robot.T_world_base
        self._T_base_world = inverse(self._T_world_base)
        self.q: Array = np.array(robot.home)
        # The pose commanded last, which is where the TCP is to 1e-9 m: increments add to it, so that
        # rounding of the inverse does not add up over a program.
        self._T_base_tcp = robot.kinematics.forward(self.q)
        self._next: tuple[Array, Array, str] | None = None
        self.motion: Motion | None = None

    @property
    def T_base_tcp(self) -> Array:  # noqa: N802
        """Where the TCP has been told to be, between motions."""
        return self._T_base_tcp

    def stand(self, q: Array, T_base_tcp: Array, tool: str) -> None:
        """Puts the robot where another one has stood between motions: its `q`, `T_base_tcp` and `tool`."""
        self.q, self._T_base_tcp, self.tool = q, T_base_tcp, tool
        self.motion = self._next = None

    def told(self, command: Command) -> Command:
        """A command as it is meant now: a move that names no TCP is one of the tool in use."""
        if self.tool and isinstance(command, MoveJoint | MoveLinear | MoveCircular):
            return command if command.tcp else replace(command, tcp=self.tool)
        return command

    @property
    def pose(self) -> Pose:
        """TCP pose in the world, between motions."""
        return pose_of(self._T_world_base @ self._T_base_tcp)

    def begin(self, command: Command, now: float) -> Motion:
        """Plans a command from the current position.

        Raises MotionFault, with robot and pose in the message, when it cannot be carried out; the
        robot then stands where it stood.
        """
        if self.motion is not None:
            raise RuntimeError(f"{self.robot.name} is still moving")
        command = self.told(command)
        try:
            expect_tool(self.robot, self.tool, command)
            self.motion = self._plan(command, now)
        except MotionFault as fault:
            raise self._named(fault, command) from None
        return self.motion

    def finish(self) -> None:
        """The motion has reached its end."""
        if self.motion is None or self._next is None:
            raise RuntimeError(f"{self.robot.name} is not moving")
        self.q, self._T_base_tcp, self.tool = self._next
        self.motion = self._next = None

    def stop(self, now: float) -> None:
        """The motion is broken off: the robot stands where it is at that time."""
        if self.motion is not None:
            self.q = self.motion.q(now)
            self._T_base_tcp = self.robot.kinematics.forward(self.q)
            self.motion = self._next = None

    def _plan(self, command: Command, now: float) -> Motion:
        if self.robot.is_device and not isinstance(command, MoveExternal | ToolAction | Wait):
            raise MotionFault("bad-command", "it has no arm")
        match command:
            case MoveJoint():
                return self._to_pose(command, now)
            case MoveHome():
                return self._to_axes(command, now, self._home())
            case MoveAxes():
                return self._to_axes(command, now, self._axes(command))
            case MoveExternal():
                return self._to_axes(command, now, self._towards(command.along))
            case MoveLinear():
                return self._linear(command, now)
            case MoveCircular():
                return self._circular(command, now)
            case ToolAction():
                return self._standing(command, "tool", now, command.duration)
            case Wait():
                return self._standing(command, "wait", now, command.duration)
            case Measure():
                seconds = self._config.measure_duration
                return self._standing(command, "measure", now, seconds, command.nominal)
            case _:
                assert_never(command)

    def reach(self, command: Move) -> None:
        """Raises MotionFault, with robot and pose, when no joint position puts the TCP where a move leads.

        Of a line or an arc only its end is looked at, in the branch of joint moves; nothing of increments, which begin
        wherever the tool is. Of a pose that external axes decide on as well (`depends`) only how the tool is turned,
        which tracks do not change.
        """
        meant = self.told(command)
        assert isinstance(meant, Move)
        command = meant
        told: Command = command
        if isinstance(command, MoveLinear | MoveCircular):
            told = MoveJoint(
                command.target, frame=command.frame, tcp=command.tcp, arm_angle=command.arm_angle
            )
        try:
            expect_tool(self.robot, self.tool, command)
            match command:
                case MoveAxes():
                    self._axes(command)
                case MoveExternal():
                    self._towards(command.along)
                case MoveHome():
                    pass
                case MoveJoint() | MoveLinear() | MoveCircular():
                    q = self._towards(command.along)
                    if command.frame != "tool" and not self.depends(command):
                        self._found(command, q)
                    elif command.frame != "tool" and command.frame not in self.robot.turning:
                        self._expect_turn(command, q)
        except MotionFault as fault:
            raise self._named(fault, told) from None

    def seen_from_arm(self, command: MoveJoint | MoveLinear | MoveCircular) -> Array:
        """The pose that a move leads to, from the base of the arm, wherever tracks have carried it then."""
        k = self.robot.kinematics
        meant = self.told(command)
        assert isinstance(meant, MoveJoint | MoveLinear | MoveCircular)
        command = meant
        q = np.array(self.q)
        for a in command.along:
            q[self.robot.index(a.axis)] = a.position
        target = self._of_tool(self._in_base(command.target, command, q), command)
        return inverse(k.T_base_arm(q)) @ target if isinstance(k, WithAxes) else target

    def depends(self, command: Move) -> bool:
        """Whether it depends on where external axes stand what joint positions a move to a pose leads to."""
        return bool(self.undecided(command))

    def undecided(self, command: Move) -> frozenset[str]:
        """The external axes on which it depends so, and which the move does not tell where to go."""
        if isinstance(command, MoveAxes | MoveExternal | MoveHome) or command.frame == "tool":
            return frozenset()
        needed = {a.name for a in self.robot.axes.tracks}
        if command.frame in self.robot.turning:
            index, _ = self.robot.turning[command.frame]
            needed.add(self.robot.arm.axes[index])
        return frozenset(needed - {a.axis for a in command.along})

    def _found(
        self, command: MoveJoint | MoveLinear | MoveCircular, q: Array
    ) -> tuple[Array, Array]:
        """The joint position nearest to `q`, with the external axes as there, and where the tool's TCP is then."""
        target = self._of_tool(self._in_base(command.target, command, q), command)
        angle = self._arm_angle(command)
        found = self.robot.kinematics.nearest(target, q, self.robot.branch, angle)
        if found is None:
            tip = self._tcp(command)[1] if command.tcp else None
            raise unreachable(self.robot, target, q, angle, command.target, tip)
        return found.q, target

    def _expect_turn(self, command: MoveJoint | MoveLinear | MoveCircular, q: Array) -> None:
        """Raises MotionFault where the arm cannot turn its tool so, wherever tracks have carried it."""
        k = self.robot.kinematics
        target = self._of_tool(self._in_base(command.target, command, q), command)
        arm = inverse(k.T_base_arm(q)) if isinstance(k, WithAxes) else np.eye(4)
        if refused := k.alone.refused(arm @ target):
            raise MotionFault("unreachable", refused)

    def _arm_angle(self, command: MoveJoint | MoveLinear | MoveCircular) -> float | None:
        """What a move says of the arm angle; None: nothing."""
        if command.arm_angle is None:
            return None
        if self.robot.kinematics.alone.arm_angle is None:
            raise MotionFault(
                "bad-command", "it has no arm angle: its arm does not have seven axes"
            )
        if not math.isfinite(command.arm_angle):
            raise MotionFault("bad-command", f"an arm angle of {command.arm_angle} is not possible")
        return command.arm_angle

    def _swivel(self, command: MoveLinear | MoveCircular) -> Swivel | None:
        """How the arm angle goes on a line: increments of the tool keep it where nothing is said."""
        angle = self._arm_angle(command)
        return swivel_of(self.robot.kinematics, self.q, angle, command.frame == "tool")

    def _tcp(self, command: MoveJoint | MoveLinear | MoveCircular) -> tuple[Kinematics, Array]:
        """The kinematics to the TCP that a move refers to, and where that is in the frame of the tool's own."""
        if not command.tcp:
            return self.robot.kinematics, _OWN
        if command.tcp not in self._tcps:
            raise MotionFault("bad-command", f"it has no tool frame `{command.tcp}`")
        return self.robot.tcps[command.tcp], self._tcps[command.tcp]

    def _of_tool(self, frame: Array, command: MoveJoint | MoveLinear | MoveCircular) -> Array:
        """Where the tool's own TCP is when the one that a move refers to is at `frame`."""
        return np.asarray(frame @ inverse(self._tcp(command)[1])) if command.tcp else frame

    def _begins(self, command: MoveLinear | MoveCircular) -> Array:
        """Where the TCP that a move refers to is when it begins, in the base frame."""
        return (
            np.asarray(self._T_base_tcp @ self._tcp(command)[1])
            if command.tcp
            else self._T_base_tcp
        )

    def _in_base(
        self, pose: Pose, command: MoveJoint | MoveLinear | MoveCircular, q: Array
    ) -> Array:
        """A pose of the world, of a frame that has a name, or of the tool, in the base frame."""
        plate, own = self._given(pose, command)
        if plate is None:
            return own
        k = self.robot.kinematics
        assert isinstance(k, WithAxes), "a plate is an external axis"
        return np.asarray(k.T_base_table(plate, float(q[plate])) @ own)

    def _given(
        self, pose: Pose, command: MoveJoint | MoveLinear | MoveCircular
    ) -> tuple[int | None, Array]:
        """A pose on the plate of a turntable, by its index; or, of other frames, in the base frame."""
        own, frame = self._checked(pose), command.frame
        if frame == "world":
            return None, np.asarray(self._T_base_world @ own)
        if frame == "tool":
            assert not isinstance(command, MoveJoint), "increments are on lines and arcs"
            return None, np.asarray(self._begins(command) @ own)
        if frame in self.robot.turning:
            index, place = self.robot.turning[frame]
            return index, matrix_of(place) @ own
        if frame not in self._frames:
            raise MotionFault(
                "bad-command", f"there is no frame `{frame}` in cell.toml that it can move in"
            )
        return None, np.asarray(self._T_base_world @ (self._frames[frame] @ own))

    def _axes(self, command: MoveAxes) -> Array:
        """The joint position of a command, which is inside the limits."""
        k = self.robot.kinematics
        own = np.array(command.axes)
        if own.shape != k.alone.arm.lower.shape or not np.isfinite(own).all():
            count = len(k.alone.arm.lower)
            raise MotionFault(
                "bad-command",
                f"a joint position has {count} finite {'numbers' if k.alone.slides.any() else 'angles'}, not "
                f"{command.axes}",
            )
        # Of what slides, scripts give mm where they give degrees of what turns.
        own[k.alone.slides] = np.degrees(own[k.alone.slides]) / 1000.0
        q = self._towards(command.along)
        q[k.joints] = k.alone.arm.meant(own)
        check_axes(k, q)
        return q

    def _home(self) -> Array:
        """The arm at HOME, external axes where they are."""
        q = np.array(self.robot.home)
        joints = self.robot.kinematics.joints
        q[: joints.start], q[joints.stop :] = self.q[: joints.start], self.q[joints.stop :]
        return q

    def _towards(self, along: tuple[Along, ...]) -> Array:
        """The joint position with external axes where a command takes them, which is inside their limits."""
        q = np.array(self.q)
        for a in along:
            axis = self.robot.axes.axis(a.axis)
            if axis is None or axis.is_track is not a.is_track:
                kind = "track" if a.is_track else "turntable"
                if self.robot.is_device:
                    kind = "axis that slides" if a.is_track else "axis that turns"
                raise MotionFault("bad-command", f"it has no {kind} `{a.axis}`")
            if not math.isfinite(a.position):
                raise MotionFault("bad-command", f"`{a.axis}` cannot go to {a.position}")
            moved = [(self.robot.index(k), v) for k, v in self.robot.axes.moved(a.axis, a.position)]
            arm, i = self.robot.arm, moved[0][0]
            if not axis.lower - 1e-9 <= a.position <= axis.highest + 1e-9:
                called = f"`{a.axis}`" if self.robot.is_device else arm.called(i)
                raise MotionFault(
                    "joint-limit",
                    f"{called} would be at {arm.beyond(i, a.position, axis.lower, axis.highest)}",
                )
            for index, position in moved:
                q[index] = position if axis.belt is None else q[index] + position
        return q

    def _limited(self, command: Move) -> MotionLimits:
        """What the arm may do on this command."""
        part, limits = command.acceleration, self._limits[self.tool]
        if part == 1.0:
            return limits
        if not 0.0 < part <= 1.0:
            raise MotionFault(
                "bad-command",
                f"acceleration must be a fraction above 0 and at most 1, but it is {part:g}",
            )
        return replace(
            limits,
            acceleration=limits.acceleration * part,
            linear_acceleration=limits.linear_acceleration * part,
        )

    def _to_pose(self, command: MoveJoint, now: float) -> Motion:
        q, target = self._found(command, self._towards(command.along))
        path = plan_ptp(self.robot.kinematics, self.q, q, self._limited(command), command.speed)
        return self._moving(command, "ptp", now, path, q, target)

    def _to_axes(self, command: MoveHome | MoveAxes | MoveExternal, now: float, q: Array) -> Motion:
        k = self.robot.kinematics
        path = plan_ptp(k, self.q, q, self._limited(command), command.speed)
        kind: MotionKind = "axis" if self.robot.is_device else "ptp"
        return self._moving(command, kind, now, path, q, k.forward(q))

    def _linear(self, command: MoveLinear, now: float) -> Motion:
        if self.robot.axes or command.along:
            return self._along(command, "blend" if command.via else "lin", now)
        if command.via:
            return self._through(command, now)
        target = self._in_base(command.target, command, self.q)
        path = plan_lin(
            self._tcp(command)[0],
            self.q,
            self._begins(command),
            target,
            self._limited(command),
            command.speed,
            self._swivel(command),
        )
        end = self._of_tool(target, command)
        return self._moving(command, "lin", now, path, path.q(path.duration), end)

    def _through(self, command: MoveLinear, now: float) -> Motion:
        """Lines through poses on the way, with rounded corners."""
        goals = [self._in_base(pose, command, self.q) for pose in (*command.via, command.target)]
        path = plan_through(
            self._tcp(command)[0],
            self.q,
            [self._begins(command), *goals],
            command.blend,
            self._limited(command),
            command.speed,
            self._swivel(command),
        )
        end = self._of_tool(goals[-1], command)
        return self._moving(command, "blend", now, path, path.q(path.duration), end)

    def _along(self, command: MoveLinear | MoveCircular, kind: MotionKind, now: float) -> Motion:
        """A line or an arc of a robot that has external axes."""
        end = self._towards(command.along)
        k, _ = self._tcp(command)
        assert isinstance(k, WithAxes), "it has external axes"
        plate, target = self._given(command.target, command)
        via, zone = None, 0.0
        through: tuple[Array, ...] = ()
        if isinstance(command, MoveCircular):
            _, via = self._given(command.via, command)
        elif command.via:
            through = tuple(self._given(pose, command)[1] for pose in command.via)
            zone = command.blend
        begins = self._begins(command)
        wanted = Led(self.q, end, begins, plate, target, via, self._swivel(command), through, zone)
        path = plan_led(k, wanted, self._limited(command), command.speed)
        last = path.q(path.duration)
        if plate is not None:
            target = k.T_base_table(plate, float(last[plate])) @ target
        return self._moving(command, kind, now, path, last, self._of_tool(target, command))

    def _circular(self, command: MoveCircular, now: float) -> Motion:
        if self.robot.axes or command.along:
            return self._along(command, "circ", now)
        via = self._in_base(command.via, command, self.q)
        target = self._in_base(command.target, command, self.q)
        path = plan_circ(
            self._tcp(command)[0],
            self.q,
            self._begins(command),
            via,
            target,
            self._limited(command),
            command.speed,
            self._swivel(command),
        )
        end = self._of_tool(target, command)
        return self._moving(command, "circ", now, path, path.q(path.duration), end)

    def _checked(self, pose: Pose) -> Array:
        values = (pose.x, pose.y, pose.z, pose.rx, pose.ry, pose.rz)
        if not all(map(math.isfinite, values)):
            raise MotionFault("bad-command", f"the pose has a number that is not finite: {values}")
        return matrix_of(pose)

    def _named(self, fault: MotionFault, command: Command) -> MotionFault:
        """The fault with the robot's name and the pose in the world."""
        if fault.pose is not None:
            pose = pose_of(self._T_world_base @ matrix_of(fault.pose))
        elif isinstance(command, MoveJoint) and command.frame == "world":
            pose = command.target
        elif isinstance(command, MoveJoint) and command.frame in self._frames:
            pose = pose_of(self._frames[command.frame] @ matrix_of(command.target))
        else:
            own = self.robot.of_tool(self.tool, self._T_base_tcp)
            pose = pose_of(self._T_world_base @ own)
        message = f"{self.robot.words}: {fault.message}"
        if not self.robot.is_device:
            message += f", at TCP pose {describe(pose)}"
        return MotionFault(
            fault.kind, message, robot=self.robot.name, pose=pose, q=fault.q, time=fault.time
        )

    def _standing(
        self,
        command: Command,
        kind: MotionKind,
        now: float,
        seconds: float,
        result: Pose | None = None,
    ) -> Motion:
        if not (seconds >= 0.0 and math.isfinite(seconds)):
            raise MotionFault("bad-command", f"a duration of {seconds:g} s is not possible")
        path = Still(self.q, seconds)
        return self._moving(command, kind, now, path, self.q, self._T_base_tcp, result)

    def _moving(
        self, command: Command, kind: MotionKind, now: float, path: Trajectory,
        q_end: Array, T_end: Array, result: Pose | None = None,
    ) -> Motion:  # fmt: skip
        self._next = (q_end, T_end, tool_after(self.tool, command))
        target = pose_of(self._T_world_base @ T_end)
        step = self._config.sample
        if isinstance(path, AlongTrajectory) or (
            isinstance(path, LinearTrajectory) and (kind in ("circ", "blend") or tcp_of(command))
        ):
            way, turn = path.line.length, path.line.angle
            parts = math.ceil(max(way / CHECK_LENGTH, turn / CHECK_ANGLE, 1.0) - 1e-6)
            step = max(step, path.duration / parts)
        elif kind == "lin":
            way, turn = difference(matrix_of(self.pose), matrix_of(target))
            parts = math.ceil(max(way / CHECK_LENGTH, turn / CHECK_ANGLE, 1.0) - 1e-6)
            step = max(step, path.duration / parts)
        elif kind not in ("ptp", "axis"):
            step = max(step, path.duration)
        return Motion(self.robot.name, command, kind, now, path, self.pose, target, result, step)
