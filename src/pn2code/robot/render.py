"""Pictures and films of the cell.

    for camera in cameras(cell, backend):
        save(picture(backend, camera), folder / f"{camera.name}.png")
    with Film(folder / "run.mp4", backend, camera) as film: film.frame()

Cameras are placed from where the robots, their tools and the panel are, so they suit any cell.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from pn2code.base.closing import Closing
from pn2code.robot.backend import BEFORE, Backend, Camera, Picture
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import Array

Point = tuple[float, float, float]
WIDTH, HEIGHT = 1280, 720
_TOGETHER = 0.6
"""m: tools that are no further apart are seen together."""


def cameras(cell: RobotCell, backend: Backend) -> tuple[Camera, ...]:
    """`overview`, `behind` (from the other side), `tools` (where the TCPs are now), `seam`."""
    low, high = _extent(cell)
    centre = (low + high) / 2.0
    size = float(np.linalg.norm((high - low)[:2]))
    overview = camera_at(
        "overview", centre, azimuth=-40.0, elevation=24.0, distance=0.98 * size + 1.5
    )
    behind = camera_at("behind", centre, azimuth=50.0, elevation=20.0, distance=1.15 * size + 1.5)
    tips = np.array([backend.tcp(r.name)[:3, 3] for r in cell.robots])
    middle = tips.mean(axis=0)
    spread = float(np.abs(tips - middle).max())
    # Close-ups: past the edge of the panel, along x, slightly from above.
    tools = camera_at("tools", middle, azimuth=-28.0, elevation=16.0, distance=1.5 + 1.6 * spread)
    seam = camera_at("seam", middle, azimuth=-6.0, elevation=12.0, distance=3.0 + 1.2 * spread)
    return (overview, behind, tools, seam)


def close_up(cell: RobotCell, backend: Backend, robot: str) -> Camera:
    """Of what a tool does: `tools`, but from where nothing hides its TCP; of the tool alone if others are far away."""
    tip = backend.tcp(robot)[:3, 3]
    tips = np.array([backend.tcp(r.name)[:3, 3] for r in cell.robots])
    near = tips[np.linalg.norm(tips - tip, axis=1) <= _TOGETHER]
    middle = near.mean(axis=0)
    spread = float(np.abs(near - middle).max())
    return unhidden(backend, "tools", middle, near, distance=1.5 + 1.6 * spread)


def unhidden(
    backend: Backend,
    name: str,
    target: Array,
    points: Array,
    *,
    distance: float,
    azimuth: float = -28.0,
    elevation: float = 16.0,
    about: float = 0.04,
) -> Camera:
    """A camera from which the least of some places is hidden: as it is told if that is no worse, else from beside.

    Args:
        about: m: so far around each place counts as well.
    """
    off = about * np.vstack([np.zeros(3), np.eye(3), -np.eye(3)])
    places = [
        (float(x), float(y), float(z)) for x, y, z in (points[:, None] + off[None]).reshape(-1, 3)
    ]
    turns = sorted(range(-180, 180, 20), key=abs)
    ways = [(azimuth + a, e) for e in (elevation, 32.0, 48.0) for a in turns]
    views = [camera_at(name, target, azimuth=a, elevation=e, distance=distance) for a, e in ways]
    return min(views, key=lambda view: _unseen(backend, view, places))


def _unseen(backend: Backend, view: Camera, places: list[Point]) -> int:
    """How much is hidden; what stands between the eye and the first place counts for all of them.

    A ray out of a thing does not meet it, so that an eye inside of one would see everything: a ray to the eye does.
    """
    first, eye = np.array(places[0]), np.array(view.eye)
    x, y, z = (first + BEFORE * (eye - first) / np.linalg.norm(eye - first)).tolist()
    is_behind = backend.hidden((x, y, z), [view.eye])
    return backend.hidden(view.eye, places) + len(places) * is_behind


def _extent(cell: RobotCell) -> tuple[Array, Array]:
    points = []
    for r in cell.robots:
        base = r.T_world_base[:3, 3]
        points += [base - [0.5, 0.5, base[2]], base + [0.5, 0.5, 1.8]]
    if cell.scene.panel is not None:
        p = cell.scene.panel
        points += [
            np.array([p.x_from, p.axis_y - p.radius * 0.9, 0.0]),
            np.array([p.x_to, p.axis_y, p.axis_z + p.radius * 0.9]),
        ]
    for o in cell.scene.objects:
        points.append(np.array([o.pose.x, o.pose.y, o.pose.z]))
    return np.min(points, axis=0), np.max(points, axis=0)


def camera_at(
    name: str, target: Array, *, azimuth: float, elevation: float, distance: float
) -> Camera:
    """From `distance` away in a direction: azimuth from +x towards +y, degrees."""
    a, e = math.radians(azimuth), math.radians(elevation)
    way = np.array([math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)])
    x, y, z = (target + distance * way).tolist()
    tx, ty, tz = target.tolist()
    return Camera(name, (x, y, max(z, 0.2)), (tx, ty, tz), 42.0)


def picture(
    backend: Backend, camera: Camera, width: int = WIDTH, height: int = HEIGHT, *, smooth: int = 1
) -> Picture | None:
    """A picture; None when the backend has no eyes.

    Args:
        smooth: rendered this many times larger and averaged, for clean edges, which takes its square
            as long; 1: edges are softened instead.
    """
    large = backend.render(camera, width * smooth, height * smooth)
    if large is None:
        return None
    if smooth == 1:
        return soften(large)
    blocks = large.reshape(height, smooth, width, smooth, 3).astype(np.uint16)
    return np.asarray(blocks.sum(axis=(1, 3)) // (smooth * smooth), np.uint8)


def soften(image: Picture) -> Picture:
    """Takes the stairs out of edges: pixels of high contrast are mixed with their neighbours."""
    colours = image.astype(np.float32)
    padded = np.pad(colours, ((1, 1), (1, 1), (0, 0)), mode="edge")
    rows = padded[:-2] + 2.0 * padded[1:-1] + padded[2:]
    blurred = (rows[:, :-2] + 2.0 * rows[:, 1:-1] + rows[:, 2:]) / 16.0
    light = padded.mean(axis=2)
    around = np.stack([light[:-2, 1:-1], light[2:, 1:-1], light[1:-1, :-2], light[1:-1, 2:]])
    contrast = around.max(axis=0) - around.min(axis=0)
    share = np.clip((contrast - 12.0) / 40.0, 0.0, 0.9)[:, :, None]
    return np.asarray(colours + share * (blurred - colours), np.uint8)


def save(image: Picture | None, path: Path) -> bool:
    """Writes a PNG; False when there is no picture."""
    if image is None:
        return False
    import imageio.v2 as imageio  # whoever makes no pictures does not wait for it

    imageio.imwrite(path, image)
    return True


class Film(Closing):
    """An mp4 (or gif, by the file's suffix) made frame by frame."""

    def __init__(
        self, path: Path, backend: Backend, camera: Camera, *, fps: int = 12, width: int = 960,
        height: int = 540,
    ) -> None:  # fmt: skip
        import imageio.v2 as imageio

        self._backend, self._camera, self._size = backend, camera, (width, height)
        options: dict[str, Any] = {"fps": fps}
        if path.suffix == ".mp4":
            options |= {"quality": 7, "macro_block_size": 2, "ffmpeg_log_level": "error"}
        else:
            options = {"duration": 1000.0 / fps, "loop": 0}
        self._writer: Any = imageio.get_writer(path, **options)

    def frame(self) -> None:
        """Adds a picture of the robots where they are now."""
        image = picture(self._backend, self._camera, *self._size)
        if image is not None:
            self._writer.append_data(image)

    def close(self) -> None:
        """Finishes the file."""
        self._writer.close()
