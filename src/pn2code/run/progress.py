"""The progress of a run on a terminal: one line that changes."""

from __future__ import annotations

from collections.abc import Mapping
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.status import Status

from pn2code.robot.transforms import Array
from pn2code.run.engine import Engine


class Progress:
    """An observer that shows time, activity and what each robot does. Off a terminal it prints activities only."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._status: Status | None = None
        self._activity = ""

    def __enter__(self) -> Self:
        if self._console.is_terminal:
            self._status = self._console.status("starting", spinner="dots")
            self._status.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._status is not None:
            self._status.stop()

    def say(self, text: str) -> None:
        """A stage before the run begins."""
        if self._status is not None:
            self._status.update(text)

    def begun(self, engine: Engine) -> None:
        """The run begins."""
        self.say("running")

    def advanced(self, engine: Engine) -> None:
        """Shows where the cell is."""
        if engine.activity != self._activity:
            self._activity = engine.activity
            if self._activity:
                self._console.print(f"{engine.now:8.2f} s  {self._activity}", highlight=False)
        if self._status is not None:
            doing = "   ".join(
                f"{r.name}: {r.motion.kind if r.motion else 'waits'}" for r in engine.robots
            )
            self._status.update(f"{engine.now:7.2f} s   {doing}")

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None:
        """Nothing: samples are too many for a terminal."""

    def ended(self, engine: Engine) -> None:
        """Nothing: the summary says it."""
