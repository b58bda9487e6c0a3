"""How the arms moved: what an observer of a run notes, and its form in a description.

    motion = Motion()
    run_cell(path, options, d, [motion])
    motion.described()            # {"robot1": {"t": {...}, "q": {...}}, ...}
    motion.at("robot1", 33.42)    # joint position, rad

Each arm has samples of its own. While it stands still only the first and the last one are kept: between two equal
samples nothing moves; between two others a cubic goes through the samples, with the slopes that their neighbours give
(`slopes`). The page does the same.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from pn2code.base.frozen import record
from pn2code.replay.arrays import packed_reals
from pn2code.robot.transforms import Array

if TYPE_CHECKING:
    from pn2code.run.engine import Engine


@record
class _Path:
    t: list[float] = field(default_factory=list)
    q: list[tuple[float, ...]] = field(default_factory=list)

    def add(self, t: float, q: tuple[float, ...]) -> None:
        if self.t and t <= self.t[-1]:
            return
        if len(self.t) > 1 and q == self.q[-1] == self.q[-2]:
            self.t[-1] = t
            return
        self.t.append(t)
        self.q.append(q)


class Motion:
    """An observer of a run (`run.observer.Observer`)."""

    def __init__(self) -> None:
        self._paths: dict[str, _Path] = {}

    def begun(self, engine: Engine) -> None:
        """The arms stand at HOME."""
        for robot in engine.cell.moving:
            self._paths[robot.name] = _Path([0.0], [_single(robot.home)])

    def advanced(self, engine: Engine) -> None:
        """Nothing: samples come by themselves."""

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None:
        """The arms stood like this at time t."""
        for name, q in joints.items():
            self._paths.setdefault(name, _Path()).add(t, _single(q))

    def ended(self, engine: Engine) -> None:
        """Nothing: what stands still stays."""

    def at(self, robot: str, t: float) -> Array:
        """The joint position at a moment, as the page shows it."""
        path = self._paths[robot]
        return interpolated(np.array(path.t), np.array(path.q), t)

    def described(self) -> dict[str, Any]:
        """All paths, packed: times in s, joint positions in rad, one row a sample."""
        return {
            name: {
                "t": packed_reals(path.t, double=True),
                "q": packed_reals(np.array(path.q).reshape(-1), double=False),
            }
            for name, path in self._paths.items()
        }


def _single(q: ArrayLike) -> tuple[float, ...]:
    """In single precision, as in the description (0.3 µm at the end of an arm), so that all see the same."""
    return tuple(np.asarray(q, np.float32).tolist())


def slopes(t: Array, q: Array) -> Array:
    """The velocity at each sample: that of the parabola through it and its neighbours, zero beside a rest."""
    out = np.zeros_like(q)
    if len(t) < 3:
        return out
    h = np.diff(t)[:, None]
    d = np.diff(q, axis=0) / h
    out[1:-1] = (h[1:] * d[:-1] + h[:-1] * d[1:]) / (h[1:] + h[:-1])
    still = ~np.diff(q, axis=0).any(axis=1)
    out[:-1][still] = 0.0
    out[1:][still] = 0.0
    return out


def interpolated(t: Array, q: Array, now: float) -> Array:
    """The joint position between the samples."""
    if now <= t[0]:
        return np.asarray(q[0])
    if now >= t[-1]:
        return np.asarray(q[-1])
    i = int(np.searchsorted(t, now, side="right")) - 1
    low, high = max(i - 1, 0), min(i + 3, len(t))
    m = slopes(t[low:high], q[low:high]) if high - low > 2 else np.zeros((high - low, q.shape[1]))
    a, b = i - low, i - low + 1
    h = t[i + 1] - t[i]
    x = (now - t[i]) / h
    return np.asarray(
        (1 + 2 * x) * (1 - x) ** 2 * q[i]
        + x * (1 - x) ** 2 * h * m[a]
        + x * x * (3 - 2 * x) * q[i + 1]
        + x * x * (x - 1) * h * m[b]
    )
