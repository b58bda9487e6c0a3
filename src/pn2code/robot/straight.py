"""A line or an arc through a straight wrist: axes 4 and 6, which only count together there, as the way goes on.

straight = Straight.of(solve, poses' fractions s, rows, start, wrist)     # None: the way comes near no straight wrist
straight.rows(s, rows)                                                     # the same joint positions, continued

The bend of the wrist has a direction: the point v = sin(axis 5) (cos(axis 4), sin(axis 4)) moves smoothly along the
way, and is zero where the wrist is straight. A way through zero on a straight path of v is continued with axis 4 as it
was and axis 5 of the other sign. So it is where the way begins or ends there; and as long as v stays at zero, axis 6
turns alone. Where v leaves zero in another direction than axis 4 has (or its opposite), axis 4 would have to leap:
`leap` says where, and by how much. (Closed forms have axis 5 of one sign only, and an axis 4 by chance at zero.)
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.three_axes import ThreeAxes
from pn2code.robot.transforms import Array

Solve = Callable[[Array], Array]
"""Joint positions on the branch of the way at fractions of it; NaN out of reach."""

ZERO = 1e-9
"""Length of v: here the wrist is straight."""
_HELD = 1e-5  # so near to straight, axis 4 is held: its closed form has lost half of its digits
_SEEN = 1e-4  # so far from straight, the direction of v is looked at
_CLEAR = 1e-7  # nearer than this, it has none
_SAME = 1e-5  # rad: directions that differ by less are one
_INNER = 1e-6  # of a piece between samples: nearer to its ends, these are nearest to straight
_HALVES = 40
_PARTS = 17
_ZOOMS = 10


@frozen
class Leap:
    """What axis 4 would have to do at once: at which fraction of the way, by how much (rad), and where it is (rad)."""

    s: float
    by: float
    at: float


class Straight:
    """Where on a way the wrist is straight, and how axis 4 stands then.

    Attributes:
        at: fractions of the way, in order; angles: axis 4 there, rad; sides: the sign that axis 5 has from there on,
            times that of its branch.
        near: fractions at which the wrist is nearly straight, to be looked at as well.
        leap: what cannot be done; None: nothing.
    """

    def __init__(self, solve: Solve, start: Array, wrist: tuple[int, ThreeAxes]) -> None:
        self._solve, self._start = solve, start
        self._first, self._axes = wrist
        self.at = np.zeros(0)
        self.angles: list[float] = []
        self.sides: list[int] = []
        self.near: list[float] = []
        self.leap: Leap | None = None

    @classmethod
    def of(
        cls, solve: Solve, s: Array, rows: Array, start: Array, wrist: tuple[int, ThreeAxes]
    ) -> Straight | None:
        """Of a way that was solved at fractions s of it: rows (n, axes); None: its wrist is bent all along."""
        out = cls(solve, start, wrist)
        v = out._bends(rows)
        size, step = np.hypot(*v.T), np.hypot(*np.diff(v, axis=0).T)
        is_straight = size <= ZERO
        # Between two samples the wrist may be straight if they are no further from it than from each other.
        between = np.minimum(size[:-1], size[1:]) <= step
        between &= ~(is_straight[:-1] | is_straight[1:])
        if not (is_straight.any() or between.any()):
            return None
        found = s[is_straight].tolist()
        for i in np.flatnonzero(between).tolist():
            a, b = float(s[i]), float(s[i + 1])
            where, least = out._nearest(a, b)
            if least <= ZERO:
                found.append(where)
            elif _INNER < (where - a) / (b - a) < 1.0 - _INNER:
                out.near.append(where)
        out.at = np.array(sorted(found))
        out._follow()
        return out

    def rows(self, s: Array, rows: Array) -> Array:
        """Joint positions at fractions s, from those on the branch, axes in (-pi, pi]."""
        if not len(self.at):
            return rows
        out = rows.copy()
        first = self._first
        side = np.array([1, *self.sides])[np.searchsorted(self.at, s, side="left")]
        turned = side < 0
        bend = self._axes.bend(out[turned, first + 1])
        out[turned, first + 1] -= 2.0 * bend
        out[turned, first] += math.pi
        out[turned, first + 2] += math.pi
        held = np.flatnonzero(np.hypot(*self._bends(rows).T) <= _HELD)
        if len(held):
            nearest = np.abs(s[held, None] - self.at[None]).argmin(axis=1)
            out[held] = self._held(out[held], np.array(self.angles)[nearest])
        wrist = slice(first, first + 3)
        out[:, wrist] = (out[:, wrist] + math.pi) % (2.0 * math.pi) - math.pi
        return out

    def held(self, q: Array, jacobian: Array) -> Array:
        """The Jacobian (n, m, axes) with axis 4 standing where the wrist is straight: rounding decides how it turns."""
        out = jacobian.copy()
        out[np.hypot(*self._bends(q).T) <= _HELD, :, self._first] = 0.0
        return out

    def _held(self, rows: Array, angle: Array) -> Array:
        """Nearly straight positions with axis 4 at this angle; as they are where the tool would turn by that."""
        first, out = self._first, rows.copy()
        bend = self._axes.bend(rows[:, first + 1])
        away = angle - rows[:, first]
        bent, over = np.sin(bend) * np.cos(away), np.cos(bend)
        out[:, first] = angle
        out[:, first + 1] += np.arctan2(bent, over) - bend
        out[:, first + 2] -= np.where(over > 0.0, away, -away)
        off = np.abs(np.sin(bend) * np.sin(away))
        return np.where((off <= ZERO)[:, None], out, rows)

    def _bends(self, rows: Array) -> Array:
        """v of joint positions, (n, 2)."""
        bend = np.sin(self._axes.bend(rows[:, self._first + 1]))
        angle = rows[:, self._first]
        return np.stack([bend * np.cos(angle), bend * np.sin(angle)], axis=1)

    def _nearest(self, a: float, b: float) -> tuple[float, float]:
        """Where between two fractions the wrist is nearest to straight, and how near."""
        where, least = a, math.inf
        for _ in range(_ZOOMS):
            s = np.linspace(a, b, _PARTS)
            size = np.nan_to_num(np.hypot(*self._bends(self._solve(s)).T), nan=math.inf)
            i = int(np.argmin(size))
            where, least = float(s[i]), float(size[i])
            a, b = float(s[max(i - 1, 0)]), float(s[min(i + 1, _PARTS - 1)])
        return where, least

    # Directions

    def _follow(self) -> None:
        """Axis 4 at each place where the wrist is straight, and the sign of axis 5 after it."""
        side, angle = 1, math.nan
        edges = [*self.at.tolist(), 1.0]
        middles = (self.at + np.array(edges[1:])) / 2.0
        stays = np.hypot(*self._bends(self._solve(middles)).T) <= ZERO
        since = 0.0
        for i, s in enumerate(edges[:-1]):
            since = since if i and stays[i - 1] else s
            if s <= 0.0:
                angle = float(self._start[self._first])
            elif i == 0:
                angle = self._direction(s, 0.0)
            if math.isnan(angle):  # nothing is known of what comes before
                angle = float(self._start[self._first])
            after = math.nan if stays[i] else self._direction(s, edges[i + 1])
            if not math.isnan(after):
                by = (after - angle + math.pi / 2.0) % math.pi - math.pi / 2.0
                side = 1 if math.cos(after - angle) > 0.0 else -1
                if abs(by) > _SAME and self.leap is None:
                    self.leap = Leap(since, by, angle)
            self.angles.append(angle)
            self.sides.append(side)
            if i + 1 < len(self.at) and not math.isnan(after):
                angle = self._direction(edges[i + 1], s) + (0.0 if side > 0 else math.pi)

    def _direction(self, s: float, towards: float) -> float:
        """Axis 4 on the branch as a straight place is left towards another fraction: its limit; NaN: it has none."""
        if s == towards:
            return math.nan
        steps = (towards - s) * 0.5 ** np.arange(1, _HALVES)
        rows = self._solve(np.asarray(s + steps, float))
        size = np.nan_to_num(np.hypot(*self._bends(rows).T), nan=0.0)
        seen = np.flatnonzero(size >= _SEEN)
        i = int(seen[-1]) if len(seen) else int(np.argmax(size))
        if size[i] < _CLEAR:
            return math.nan
        here = float(rows[i, self._first])
        before = max(i - 1, 0)
        if size[before] < _CLEAR:
            return here
        # The limit of a smooth way, from twice the distance and once.
        more = (here - float(rows[before, self._first]) + math.pi) % (2.0 * math.pi) - math.pi
        return here + (more if before != i and abs(more) < 0.1 else 0.0)
