"""Who watches a run while it goes on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from pn2code.robot.transforms import Array
    from pn2code.run.engine import Engine


class Observer(Protocol):
    """Who watches a run: the progress line, the camera."""

    def begun(self, engine: Engine) -> None:
        """The arms stand at HOME, nothing has happened yet."""

    def advanced(self, engine: Engine) -> None:
        """Time has moved to `engine.now`; the commands that end now are finished."""

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None:
        """The arms stood like this (rad) at time t."""

    def ended(self, engine: Engine) -> None:
        """The run is over; `engine.record` has the verdict."""
