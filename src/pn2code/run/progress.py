"""How the run of a cell goes on."""

from __future__ import annotations

from collections.abc import Mapping

from rich.console import Console

from pn2code.base.progress_line import Line
from pn2code.robot.transforms import Array
from pn2code.run.engine import Engine


class Progress(Line):
    """An observer that shows time, activity and what each robot does. Off a terminal it prints activities only."""

    def __init__(self, console: Console) -> None:
        super().__init__(shown=console.is_terminal, stream=console.file, first="starting")
        self._console = console
        self._activity = ""

    def begun(self, engine: Engine) -> None:
        """The run begins."""
        self.say("running")

    def advanced(self, engine: Engine) -> None:
        """Shows where the cell is."""
        if engine.activity != self._activity:
            self._activity = engine.activity
            if self._activity:
                self.clear()
                self._console.print(f"{engine.now:8.2f} s  {self._activity}", highlight=False)
        doing = "   ".join(
            f"{r.name}: {r.motion.kind if r.motion else 'waits'}" for r in engine.robots
        )
        self.say(f"{engine.now:7.2f} s   {doing}")

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None:
        """Nothing: samples are too many for a terminal."""

    def ended(self, engine: Engine) -> None:
        """Nothing: the summary says it."""
