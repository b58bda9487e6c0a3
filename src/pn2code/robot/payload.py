"""What an arm may carry, and what that changes: masses of tools and parts against the robot's data.

rating = arm.urdf.rating                        # Rating(7.0, (16.6, 16.6, 9.4)); None: its description says nothing
for load in loads(tool, kinds): rating.exceeded(load, centre)       # "" or "9.2 kg, but 7 kg are rated"
rating.factors(5.0)                             # (0.8, 0.6): of the speeds and accelerations of the axes

In the URDF of an arm:

    <pn2code payload="7" moments="16.6 16.6 9.4"/>
    <pn2code load="3.5" speed="1" acceleration="1"/>
    <pn2code load="7" speed="0.8" acceleration="0.6"/>
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.transforms import Array, inverse, matrix_of

if TYPE_CHECKING:
    from pn2code.robot.parts_table import PartKind

GRAVITY = 9.80665
_SLACK = 1e-9


@frozen
class Rating:
    """What the description of an arm says about loads.

    Args:
        payload: kg, of tool and part together.
        moments: Nm, that the load may make about axes 4, 5 and 6; (): nothing is said.
        derating: loads (kg), rising, each with the fractions of the axes' speeds and accelerations that are left.
    """

    payload: float
    moments: tuple[float, ...] = ()
    derating: tuple[tuple[float, float, float], ...] = ()

    def exceeded(self, load: Load, centre: Array | None) -> str:
        """What is too much about a load, in words; "": nothing.

        Args:
            centre: where axes 4, 5 and 6 meet, in the frame of the flange, and the direction of axis 6 there: (2, 3).
        """
        if load.mass > self.payload + _SLACK:
            return f"{load.mass:g} kg, but {self.payload:g} kg are rated"
        if not self.moments or centre is None:
            return ""
        arm = load.centre - centre[0]
        # Axes 4 and 5 can stand across whatever lies from where they meet to the load, axis 6 turns about its own line.
        across = float(np.linalg.norm(np.cross(centre[1], arm)))
        arms = (float(np.linalg.norm(arm)),) * 2 + (across,)
        for axis, (most, length) in enumerate(zip(self.moments, arms, strict=True), 4):
            moment = GRAVITY * load.mass * length
            if moment > most + _SLACK:
                return (
                    f"{load.mass:g} kg, {1000.0 * length:.0f} mm from axis {axis}: {moment:.4g} Nm, but {most:g} Nm "
                    "are rated"
                )
        return ""

    def factors(self, mass: float) -> tuple[float, float]:
        """The fractions of speeds and accelerations that are left with a load; in between they are interpolated."""
        if not self.derating:
            return 1.0, 1.0
        loads, speeds, accelerations = zip(*self.derating, strict=True)
        return float(np.interp(mass, loads, speeds)), float(np.interp(mass, loads, accelerations))


@frozen(eq=False)
class Load:
    """What hangs on a flange: its mass (kg), its centre in the frame of the flange (m), and what it is, in words."""

    mass: float
    centre: Array
    words: str


def together(
    tool: tuple[str, float, Array] | None, parts: Iterable[tuple[str, float, Array]]
) -> Load:
    """A tool with several parts: of each its name, its mass, and where it is in the frame of the flange."""
    name, own, at = tool or ("", 0.0, np.zeros(3))
    parts = list(parts)
    mass = own + sum(m for _, m, _ in parts)
    middle = own * at + sum((m * np.asarray(x) for _, m, x in parts), np.zeros(3))
    said = f"its tool `{name}`" if tool else "no tool"
    words = f"{said} and {', '.join(f'`{n}`' for n, _, _ in parts)}"
    return Load(mass, np.asarray(middle / mass if mass > 0.0 else at), words)


def loads(
    tool: tuple[str, float, Array] | None, T_flange_tcp: Array, kinds: Iterable[PartKind]
) -> Iterator[Load]:
    """The tool alone, and with each part that it takes, however that is gripped.

    Args:
        tool: its name, mass and centre; None: there is none.
        T_flange_tcp: where parts are gripped.
        kinds: of parts that it takes; those without a mass weigh nothing.
    """
    name, own, at = tool or ("", 0.0, np.zeros(3))
    said = f"its tool `{name}` ({own:g} kg)" if tool else "no tool"
    yield Load(own, at, said)
    for kind in kinds:
        grips = [inverse(matrix_of(g)) for g in kind.grips] or [np.eye(4)]
        for grip in grips:
            centre = (T_flange_tcp @ grip)[:3, 3]
            mass = own + kind.mass
            middle = (own * at + kind.mass * centre) / mass if mass > 0.0 else at
            words = f"{said} and a part `{kind.name}` ({kind.mass:g} kg)"
            yield Load(mass, np.asarray(middle), words)
