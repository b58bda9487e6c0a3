"""How the run of a cell goes on."""

from __future__ import annotations

from collections.abc import Mapping

from rich.console import Console

from pn2code.base.progress_line import SILENCE_S, Line
from pn2code.robot.transforms import Array
from pn2code.run.engine import Engine


class Progress(Line):
    """An observer that shows time, activity and what each robot does. Off a terminal it prints activities only."""

    def __init__(self, console: Console) -> None:
        super().__init__(shown=console.is_terminal, stream=console.file, first="starting")
        self._console = console
        self._activity = ""
        self._started = self._clock()

    def begun(self, engine: Engine) -> None:
        """The run begins."""
        self._started = self._clock()
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
        self.say(f"{engine.now:7.2f} s{self._pace(engine.now)}   {doing}")

    def _pace(self, now: float) -> str:
        """How fast the cell's time goes by; nobody knows how long the run will last."""
        passed = self._clock() - self._started
        return f", {now / passed:.1f} s a second" if passed >= SILENCE_S else ""

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None:
        """Nothing: samples are too many for a terminal."""

    def ended(self, engine: Engine) -> None:
        """Nothing: the summary says it."""
