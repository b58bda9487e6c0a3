"""Random walks of a cell with moving arms: programs take any time, arms are anywhere on their way.

fault = wander(graph, cell, Random(1), steps=400)       # None, or what touches

This knows nothing of situations and pairs: each robot begins a transition where the graph has it, goes a random part of
its way while others do what they do, and lets it occur when its way is done; then the graph must still have it.
Distances are measured as in a run.
"""

from __future__ import annotations

from random import Random

import numpy as np
from tools.geometry.eyes import Eyes

from pn2code.geometry.graph import CellGraph
from pn2code.robot.active_motion import Motion, MotionKind, turned, turned_by
from pn2code.robot.belts import until_stop
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.clamps import closed_on, closing, holding, nearest, on_nothing, shut, taken_along
from pn2code.robot.commands import Command, Move, ToolAction
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.gripped import MoveEnds
from pn2code.robot.led_contacts import Led, LedContact, LedContacts
from pn2code.robot.monitor import Monitor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.part import PartFault
from pn2code.robot.riders import tilted
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import matrix_of
from pn2code.run.handling import PartKeeper


class _Arm:
    """A robot: what it does, and how far it is."""

    def __init__(self, executor: RobotExecutor) -> None:
        self.executor = executor
        self.element = -1
        self.left: list[Command] = []
        self.part = 0.0
        self._ends: tuple[Motion, MoveEnds] | None = None

    @property
    def kind(self) -> MotionKind | None:
        motion = self.executor.motion
        return motion.kind if motion is not None else None

    def joints(self) -> np.ndarray:
        motion = self.executor.motion
        if motion is None:
            return self.executor.q
        return np.asarray(motion.q(motion.began + self.part * motion.duration))

    @property
    def ends(self) -> MoveEnds:
        """Of what it does now."""
        motion = self.executor.motion
        assert motion is not None
        if self._ends is None or self._ends[0] is not motion:
            robot, tool = self.executor.robot, self.executor.tool
            made = MoveEnds.of(robot, tool, motion.trajectory, motion.kind)
            self._ends = motion, made
        return self._ends[1]

    def begin(self, parts: PartKeeper) -> None:
        self.part = 0.0
        robot = self.executor.robot
        parts.parts.stand(robot.name, self.executor.q)
        command = until_stop(robot, parts.parts, self.left.pop(0))
        motion = self.executor.begin(command, 0.0)
        line = turned_by(robot, motion.trajectory, robot.belts)
        for plate in turned(robot, motion):
            parts.parts.turn(plate, line if plate in line else frozenset())

    def pulls(self, cell: RobotCell, parts: PartKeeper, joints: dict[str, np.ndarray]) -> str:
        """What it takes out of a clamp that holds it, as it begins to move; "": nothing."""
        motion, robot = self.executor.motion, self.executor.robot
        if motion is None or not isinstance(motion.command, Move):
            return ""
        present = parts.parts.present.values()
        for part, frame in taken_along(robot, self.executor.q, present, turned(robot, motion)):
            for held in holding(cell, part.kind, frame):
                if held.holds(joints[held.device.name]):
                    return held.words(robot.name, part.name, joints[held.device.name])
        return ""

    def is_held(self, device: _Arm, ends: list[np.ndarray], parts: PartKeeper) -> str:
        """That a clamp of a device has just closed on what it takes along; "": none has."""
        motion, robot = self.executor.motion, self.executor.robot
        if motion is None or not isinstance(motion.command, Move):
            return ""
        going = parts.parts.present.values(), turned(robot, motion)
        way = motion.trajectory.q(0.0), self.joints()
        held = shut(device.executor.robot, ends[0], ends[1])
        return next(filter(None, (closed_on(parts.cell, x, robot, way, going) for x in held)), "")

    def turning(self) -> frozenset[str]:
        motion = self.executor.motion
        return frozenset() if motion is None else turned(self.executor.robot, motion)

    def advance(self, most: float) -> Motion | None:
        """Goes on; the motion that is done then."""
        motion = self.executor.motion
        self.part = min(1.0, self.part + most)
        if self.part < 1.0 or motion is None:
            return None
        self.executor.finish()
        return motion


def handle(name: str, command: Command, executor: RobotExecutor | None, parts: PartKeeper) -> None:
    """What a command does to a part at its end."""
    if isinstance(command, ToolAction) and command.handling is not None:
        tcp = None if executor is None else matrix_of(executor.pose)
        parts.handle(name, command.handling, tcp)


def wander(graph: CellGraph, cell: RobotCell, choice: Random, steps: int) -> str | None:
    """What happens on a random walk: what touches, or a command that cannot be carried out; None: nothing."""
    backend = BulletBackend(cell, looks=False)
    try:
        return _walk(graph, cell, backend, choice, steps)
    except MotionFault as fault:
        return f"cannot move: {fault.message}"
    except PartFault as fault:
        return f"cannot handle a part: {fault}"
    finally:
        backend.close()


def _walk(
    graph: CellGraph, cell: RobotCell, backend: BulletBackend, choice: Random, steps: int
) -> str | None:
    monitor = Monitor(cell, backend, searched=0.05)
    parts = PartKeeper(cell, backend)
    parts.begin()
    names = {r.name for r in cell.moving}
    arms = {
        o.index: _Arm(RobotExecutor(cell.robot(o.name), cell.motion, cell.frames))
        for o in graph.partition.owners
        if o.name in names
    }

    def look() -> dict[str, np.ndarray]:
        """Where everything is now."""
        parts.parts.turning = frozenset().union(*(a.turning() for a in arms.values()))
        joints = {a.executor.robot.name: a.joints() for a in arms.values()}
        for name, q in joints.items():
            parts.parts.stand(name, q)
        return joints

    led = LedContacts(cell)

    def led_to(contact: LedContact) -> Led:
        present = parts.parts.present
        own = next(a for a in arms.values() if a.executor.robot.name == contact.robot)
        touching = present.get(contact.part), present.get(contact.other)
        joints = {a.executor.robot.name: a.joints() for a in arms.values()}
        at = own.part, own.part
        return led.of_move(contact, own.ends, touching, joints.__getitem__, at)

    eyes = Eyes(graph, cell)
    state = 0
    pace = {owner: choice.choice([0.02, 0.1, 0.4]) for owner in arms}
    for step in range(steps):
        look()
        busy = {owner: arm for owner, arm in arms.items() if arm.element >= 0}
        free = [
            (element, target)
            for element, target in graph.arcs[state]
            if graph.elements[element].owner not in busy
        ]
        begun: _Arm | None = None
        if free and (not busy or choice.random() < 0.5):
            element, target = choice.choice(free)
            owner = graph.elements[element].owner
            if eyes.first(element):
                element, target = eyes.as_seen(state, element, look(), parts.parts)
            commands = graph.commands(element)
            if owner in arms and commands:
                begun = arms[owner]
                begun.element, begun.left = element, list(commands)
            else:
                for command in commands:  # of a device of which nothing moves
                    handle(graph.partition.owners[owner].name, command, None, parts)
                if not eyes.first(element):
                    element, target = eyes.as_seen(state, element, look(), parts.parts)
                state = target
        elif busy:
            owner = choice.choice(sorted(busy))
            arm = busy[owner]
            done = arm.advance(choice.random() * pace[owner])
            if done is not None:
                joints = look()
                robot = arm.executor.robot
                if line := turned_by(robot, done.trajectory, robot.belts):
                    parts.run_out(line)
                ends = [done.trajectory.q(t) for t in (0.0, done.duration)]
                for held in closing(robot, ends[0], ends[1]):
                    near = nearest(cell, held, parts.parts.everywhere(joints))
                    if near.off > 0.0:
                        return on_nothing(held, near)
                for other in arms.values():
                    if other is not arm and (why := other.is_held(arm, ends, parts)):
                        return why
                handle(robot.name, done.command, arm.executor, parts)
                if arm.left:
                    begun = arm
                else:
                    if not eyes.first(arm.element):
                        arm.element, _ = eyes.as_seen(state, arm.element, look(), parts.parts)
                    state = dict(graph.arcs[state])[arm.element]
                    arm.element = -1
        else:
            return None
        if begun is not None:
            begun.begin(parts)
            if pulled := begun.pulls(cell, parts, look()):
                return pulled
        for name, q in look().items():
            if why := tilted(cell.robot(name), q, parts.parts.present.values()):
                return why
        found = monitor.check(
            float(step),
            look(),
            kinds={a.executor.robot.name: a.kind for a in arms.values() if a.kind is not None},
            calm=[a.executor.robot.name for a in arms.values() if not a.turning()],
            turning=parts.parts.turning,
            led_to=led_to,
        )
        if found.fault is not None:
            return found.fault.message
    return None
