"""Pictures of arms where they touch: near, from a side where nothing hides it, and in a corner the whole cell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from pn2code.geometry.answers import Pair
from pn2code.geometry.shown import Shown
from pn2code.robot.backend import Camera, Picture
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.robot_cell import RobotCell

_BALL = 0.016
"""Its radius, of the distance of the camera."""
_NEAREST, _FURTHEST = 0.8, 2.4
"""m: of the camera from where they touch."""
_INSET = (400, 225)
_RING = 60.0
"""Pixels: the radius of the ring around where they touch, as the ball may be inside of both."""
_RED, _WHITE = (230, 13, 13), (255, 255, 255)


def draw(cell: RobotCell, pairs: Sequence[Pair], folder: Path, stem: str) -> tuple[Pair, ...]:
    """A picture of each pair that touches, with a red ball and a ring where it does, and with what else is there then.

    Gives the pairs with the names of the files.
    """
    from pn2code.robot.render import save

    wanted = [p for p in pairs if p.where is not None and p.joints]
    if not wanted:
        return tuple(pairs)
    out = []
    backend = BulletBackend(cell)
    try:
        shown = Shown(backend)
        for number, pair in enumerate(pairs, 1):
            if pair not in wanted or pair.where is None:
                out.append(pair)
                continue
            _arrange(cell, backend, shown, pair)
            file = folder / f"{stem}-{number}.png"
            image = _picture(cell, backend, pair, pair.where.point)
            out.append(replace(pair, picture=str(file)) if save(image, file) else pair)
    finally:
        backend.close()
    return tuple(out)


def _arrange(cell: RobotCell, backend: BulletBackend, shown: Shown, pair: Pair) -> None:
    """Everything where it is then."""
    around = pair.around
    for robot in cell.moving:
        q = around.stands.get(robot.name, robot.home) if around is not None else robot.home
        backend.set_joints(robot.name, q)
    for name, q in pair.joints:
        backend.set_joints(name, q)
    shown.show(around.parts if around is not None else ())


def _picture(
    cell: RobotCell, backend: BulletBackend, pair: Pair, point: tuple[float, float, float]
) -> Picture | None:
    from pn2code.robot.render import picture

    near, whole = _near(cell, backend, pair, point), _whole(cell, point)
    backend.mark(point, _BALL * float(np.linalg.norm(np.subtract(near.eye, point))))
    image = picture(backend, near)
    inset = picture(backend, whole, *_INSET, smooth=2)
    if image is None or inset is None:
        return None
    _ring(image, _RING)
    _ring(inset, _RING / 4.0)
    (height, width), (h, w) = image.shape[:2], inset.shape[:2]
    image[height - h - 15 : height - 9, width - w - 15 : width - 9] = _WHITE
    image[height - h - 12 : height - 12, width - w - 12 : width - 12] = inset
    return image


def _ring(image: Picture, radius: float) -> None:
    """Around the middle, at which the camera looks."""
    height, width = image.shape[:2]
    rows, columns = np.ogrid[:height, :width]
    off = np.hypot(rows - (height - 1) / 2.0, columns - (width - 1) / 2.0) - radius
    image[np.abs(off) < 3.5] = _WHITE
    image[np.abs(off) < 2.0] = _RED


def _near(
    cell: RobotCell, backend: BulletBackend, pair: Pair, point: tuple[float, float, float]
) -> Camera:
    """As far from where they touch as the nearer of both arms reaches there, from a side where nothing hides it."""
    from pn2code.robot.render import unhidden

    arms = [r for r in cell.robots if r.name in pair.robots]
    reach = min(
        (float(np.linalg.norm(r.T_world_base[:3, 3] - point)) for r in arms), default=_NEAREST
    )
    return unhidden(
        backend,
        "near",
        np.array(point),
        np.array([point]),
        distance=min(max(1.2 * reach, _NEAREST), _FURTHEST),
        azimuth=-41.0,
        elevation=24.0,
        about=0.1,
    )


def _whole(cell: RobotCell, point: tuple[float, float, float]) -> Camera:
    """From above, beside the arms, with all bases in view, and where they touch in the middle."""
    from pn2code.robot.render import camera_at

    x, y, _ = point
    far = max([2.0, *(max(abs(r.base.x - x), abs(r.base.y - y)) for r in cell.robots)])
    return camera_at("touch", np.array(point), azimuth=-41.0, elevation=29.0, distance=3.2 * far)
