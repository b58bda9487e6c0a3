"""Time laws: what limits a move, and how fast it goes along its path; computed by `ruckig`."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.transforms import Array

LONGEST = 3600.0
"""s: a move that takes longer is no move."""


@frozen(eq=False)
class MotionLimits:
    """What a robot may do, in SI units; arrays are per axis.

    Args:
        velocity: rad/s, already scaled by the configured fraction.
        acceleration: rad/s2; jerk rad/s3.
        axis_velocity: the axes' own limit, rad/s: what a linear move is checked against.
        linear_*: of the TCP along a line, m/s, m/s2, m/s3.
        angular_velocity: of the TCP's turning on a linear move, rad/s.
    """

    velocity: Array
    acceleration: Array
    jerk: Array
    axis_velocity: Array
    linear_velocity: float
    linear_acceleration: float
    linear_jerk: float
    angular_velocity: float


class Law:
    """A jerk-limited law of one parameter from 0 to 1, from rest to rest; `duration` s.

    `uneven`: a bound on how fast its speed changes (1/s2) where it may be greatest at any time; 0: it is so half way.
    """

    uneven = 0.0

    def __init__(self, velocity: float, acceleration: float, jerk: float) -> None:
        # Whoever only looks where arms stand needs no time laws.
        from ruckig import InputParameter, Result, Ruckig, RuckigError, Trajectory

        request = InputParameter(1)
        request.current_position = [0.0]
        request.target_position = [1.0]
        request.max_velocity = [velocity]
        request.max_acceleration = [acceleration]
        request.max_jerk = [jerk]
        self._law = Trajectory(1)
        try:
            result = Ruckig(1).calculate(request, self._law)
        except RuckigError:
            raise MotionFault(
                "bad-command",
                "no time law was found: a speed, acceleration or jerk is far too small or too large",
            ) from None
        if self._law.duration > LONGEST:
            raise MotionFault(
                "bad-command",
                f"the move would take longer than {LONGEST / 3600.0:g} h: its speed, acceleration or jerk is too small",
            )
        # `Working` is what an offline calculation answers when all is well.
        if result not in (Result.Working, Result.Finished):
            raise MotionFault("bad-command", f"no time law was found ({result.name})")
        self.duration = float(self._law.duration)

    def at(self, t: float) -> tuple[float, float]:
        """Parameter and its speed."""
        position, speed, _ = self._law.at_time(min(max(t, 0.0), self.duration))
        return float(position[0]), float(speed[0])
