"""The backend without a simulator: exact kinematics, no distances, no pictures."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pn2code.robot.backend import BackendName, Beside, Camera, Clearance, Picture
from pn2code.robot.part import Part
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import Array


class FakeBackend:
    """Remembers joint positions; the TCP follows from the kinematics."""

    name: BackendName = "fake"

    def __init__(self, cell: RobotCell) -> None:
        self._cell = cell
        self._q = {r.name: np.array(r.home) for r in cell.moving}

    def set_joints(self, robot: str, q: Sequence[float] | Array) -> None:
        """Puts a robot at a joint position, rad."""
        self._q[robot] = np.asarray(q, float)

    def tcp(self, robot: str) -> Array:
        """`T_world_tcp` by forward kinematics."""
        r = self._cell.robot(robot)
        return np.asarray(r.T_world_base @ r.kinematics.forward(self._q[robot]))

    def clearances(self, limit: float) -> tuple[Clearance, ...] | None:
        """None: distances are not known here."""
        return None

    def set_part(self, part: Part) -> None:
        """Nothing is shown or measured."""

    def remove_part(self, name: str) -> None:
        """Nothing is shown or measured."""

    def around(self, name: str, limit: float) -> tuple[Beside, ...] | None:
        """None: distances are not known here."""
        return None

    def light_zone(self, name: str) -> None:
        """Nothing is shown."""

    def hidden(
        self, eye: tuple[float, float, float], points: Sequence[tuple[float, float, float]]
    ) -> int:
        """Nothing is seen."""
        return 0

    def render(self, camera: Camera, width: int, height: int) -> Picture | None:
        """None: no pictures."""
        return None

    def close(self) -> None:
        """Nothing to release."""
