"""Pictures of a run at moments that mean something, and a film of all of it."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from pathlib import Path

from pn2code.robot.render import Film, cameras, close_up, picture, save
from pn2code.robot.transforms import Array
from pn2code.run.engine import Engine

SIZE = (960, 540)
"""Of a picture. PyBullet renders without a GPU here: a close-up takes a second in this size, and two in twice as many
pixels."""
FRAMES_PER_SECOND = 12
FILM_SPEED = 8.0
"""Simulated seconds per second of film."""


class Album:
    """An observer with a camera.

    Takes a picture of the whole cell at the start, at the end of each activity and when the cell is
    stopped, and a close-up of the
    tools at the first use of each tool action.

    Args:
        out: folder for `picture-NN-<moment>.png` and `cell.mp4`.
        pictures, video: what to make.

    What looks like an earlier picture is not written again; the record says which moments a picture shows. Of a cell
    without arms there is nothing to show: `is_empty` says so from its start on.
    """

    def __init__(self, out: Path, *, pictures: bool = True, video: bool = False) -> None:
        self._out = out
        self._pictures = pictures
        self._video = video
        self._film: Film | None = None
        self._next_frame = 0.0
        self._activity = ""
        self._actions: set[str] = set()
        self._number = 0
        self._taken: dict[bytes, str] = {}
        self.is_empty = False

    def begun(self, engine: Engine) -> None:
        """The arms stand at HOME."""
        for old in self._out.glob("picture-*.png"):
            old.unlink()
        if not engine.cell.robots:
            self.is_empty = self._pictures or self._video
            self._pictures = self._video = False
        self._take(engine, "start", "overview")
        if self._video:
            camera = cameras(engine.cell, engine.backend)[0]
            self._film = Film(self._out / "cell.mp4", engine.backend, camera, fps=FRAMES_PER_SECOND)

    def advanced(self, engine: Engine) -> None:
        """Looks whether this moment is worth a picture."""
        if engine.activity != self._activity:
            if self._activity:
                self._take(engine, self._activity, "overview")
            self._activity = engine.activity

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None:
        """A close-up of each tool action that is new; exposes the film."""
        for robot in engine.robots:
            action = robot.tool_action()
            if action and action not in self._actions:
                self._actions.add(action)
                self._take(engine, action, "tools", robot.name)
        # While nothing moves there are no samples: the film then shows the last one for as long as it takes.
        while self._film is not None and t >= self._next_frame:
            self._next_frame += FILM_SPEED / FRAMES_PER_SECOND
            self._film.frame()

    def ended(self, engine: Engine) -> None:
        """The last picture; what went wrong from near."""
        good = engine.record.verdict == "finished"
        self._take(engine, "end" if good else "fault", "overview")
        if not good:
            self._take(engine, "fault-near", "tools")
        if self._film is not None:
            self._film.close()
            self._film = None

    def _take(self, engine: Engine, moment: str, view: str, robot: str = "") -> None:
        if not self._pictures:
            return
        cell, backend = engine.cell, engine.backend
        if robot in {r.name for r in cell.robots}:
            camera = close_up(cell, backend, robot)
        else:
            camera = next(c for c in cameras(cell, backend) if c.name == view)
        image = picture(engine.backend, camera, *SIZE)
        if image is None:
            return
        seen = hashlib.sha256(image.tobytes()).digest()
        if seen not in self._taken:
            self._number += 1
            name = re.sub(r"[^a-z0-9]+", "-", moment.lower()).strip("-") or "moment"
            self._taken[seen] = f"picture-{self._number:02}-{name}.png"
            save(image, self._out / self._taken[seen])
        engine.record.pictures.setdefault(self._taken[seen], []).append(moment)
