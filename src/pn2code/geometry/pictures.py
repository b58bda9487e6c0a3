"""Pictures of arms where they touch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from pn2code.geometry.answers import Pair
from pn2code.robot.backend import Camera
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.robot_cell import RobotCell


def draw(cell: RobotCell, pairs: Sequence[Pair], folder: Path, stem: str) -> tuple[Pair, ...]:
    """A picture of each pair that touches, with a red ball where it does; the pairs with the names of the files."""
    from pn2code.robot.render import picture, save

    wanted = [p for p in pairs if p.where is not None and p.joints]
    if not wanted:
        return tuple(pairs)
    out = []
    backend = BulletBackend(cell)
    try:
        for number, pair in enumerate(pairs, 1):
            if pair not in wanted or pair.where is None:
                out.append(pair)
                continue
            for robot in cell.robots:
                backend.set_joints(robot.name, robot.home)
            for name, q in pair.joints:
                backend.set_joints(name, q)
            backend.mark(pair.where.point, 0.05)
            file = folder / f"{stem}-{number}.png"
            image = picture(backend, _camera(cell, backend, pair.where.point))
            out.append(replace(pair, picture=str(file)) if save(image, file) else pair)
    finally:
        backend.close()
    return tuple(out)


def _camera(cell: RobotCell, backend: BulletBackend, point: tuple[float, float, float]) -> Camera:
    """From above, beside the arms, with all bases in view, and so that nothing hides where they touch."""
    from pn2code.robot.render import unhidden

    x, y, z = point
    far = max([2.0, *(max(abs(r.base.x - x), abs(r.base.y - y)) for r in cell.robots)])
    return unhidden(
        backend,
        "touch",
        np.array([x, y, 0.8 * z]),
        np.array([point]),
        distance=2.27 * far,
        azimuth=-41.0,
        elevation=29.0,
    )
