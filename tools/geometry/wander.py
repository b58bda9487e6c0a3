"""Random walks of a cell with moving arms: programs take any time, arms are anywhere on their way.

fault = wander(graph, cell, Random(1), steps=400)       # None, or what touches

This knows nothing of situations and pairs: each robot begins a transition where the graph has it, goes a random part of
its way while others do what they do, and lets it occur when its way is done; then the graph must still have it.
Distances are measured as in a run.
"""

from __future__ import annotations

from random import Random

import numpy as np

from pn2code.geometry.graph import CellGraph
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import Command, ToolAction
from pn2code.robot.executor import MotionKind, RobotExecutor, turned
from pn2code.robot.monitor import Monitor
from pn2code.robot.motion import MotionFault
from pn2code.robot.parts import PartFault
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

    @property
    def kind(self) -> MotionKind | None:
        motion = self.executor.motion
        return motion.kind if motion is not None else None

    def joints(self) -> np.ndarray:
        motion = self.executor.motion
        if motion is None:
            return self.executor.q
        return np.asarray(motion.q(motion.began + self.part * motion.duration))

    def begin(self, parts: PartKeeper) -> None:
        self.part = 0.0
        robot = self.executor.robot
        parts.parts.stand(robot.name, self.executor.q)
        for plate in turned(robot, self.executor.begin(self.left.pop(0), 0.0)):
            parts.parts.turn(plate)

    def turning(self) -> frozenset[str]:
        motion = self.executor.motion
        return frozenset() if motion is None else turned(self.executor.robot, motion)

    def advance(self, most: float, parts: PartKeeper) -> bool:
        """Goes on; whether all of its commands are done."""
        motion = self.executor.motion
        self.part = min(1.0, self.part + most)
        if self.part < 1.0 or motion is None:
            return False
        self.executor.finish()
        parts.parts.stand(self.executor.robot.name, self.executor.q)
        handle(self.executor.robot.name, motion.command, self.executor, parts)
        if self.left:
            self.begin(parts)
            return False
        return True


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
    names = {r.name for r in cell.robots}
    arms = {
        o.index: _Arm(RobotExecutor(cell.robot(o.name), cell.motion, cell.frames))
        for o in graph.partition.owners
        if o.name in names
    }
    state = 0
    pace = {owner: choice.choice([0.02, 0.1, 0.4]) for owner in arms}
    for step in range(steps):
        parts.parts.turning = frozenset().union(*(a.turning() for a in arms.values()))
        for arm in arms.values():
            parts.parts.stand(arm.executor.robot.name, arm.joints())
        busy = {owner: arm for owner, arm in arms.items() if arm.element >= 0}
        free = [
            (element, target)
            for element, target in graph.arcs[state]
            if graph.elements[element].owner not in busy
        ]
        if free and (not busy or choice.random() < 0.5):
            element, target = choice.choice(free)
            owner = graph.elements[element].owner
            commands = graph.commands(element)
            if owner in arms and commands:
                arms[owner].element, arms[owner].left = element, list(commands)
                arms[owner].begin(parts)
            else:
                for command in commands:  # of a device
                    handle(graph.partition.owners[owner].name, command, None, parts)
                state = target
        elif busy:
            owner = choice.choice(sorted(busy))
            if busy[owner].advance(choice.random() * pace[owner], parts):
                state = dict(graph.arcs[state])[busy[owner].element]
                busy[owner].element = -1
        else:
            return None
        found = monitor.check(
            float(step),
            {a.executor.robot.name: a.joints() for a in arms.values()},
            kinds={a.executor.robot.name: a.kind for a in arms.values() if a.kind is not None},
        )
        if found.fault is not None:
            return found.fault.message
    return None
