"""Monitors without functions, told to the compiled simulator (cnative/src/simulate_watch.c).

simple = Simple.of(program, net, breakpoints=True)       # None: the token game has to watch
simple.options()                                         # ["--watch", "S 3 0,4", ...]
simple.rows(report["watched"], time)                     # as Watch.results()
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pn2code.monitors.functions import MonitorProgram, is_timed
from pn2code.monitors.kinds import BREAKPOINTS, COLLECTORS, Kind, Monitor
from pn2code.monitors.statistics import Number, restored
from pn2code.monitors.watch import Breakpoint, around, result_row
from pn2code.net.flat import FlatNet

MOST = 256
"""Monitors that the simulator takes."""
_SIMPLE = frozenset(
    {
        Kind.MARKING_SIZE,
        Kind.LIST_LENGTH,
        Kind.COUNT_OCCURRENCES,
        Kind.PLACE_CONTENT,
        Kind.TRANSITION_ENABLED,
    }
)


@dataclass(frozen=True, slots=True)
class Simple:
    """The monitors of a net, all of them simple."""

    monitors: tuple[Monitor, ...]
    net: FlatNet

    @staticmethod
    def of(program: MonitorProgram, net: FlatNet, *, breakpoints: bool) -> Simple | None:
        """The monitors at work, if all of them are simple."""
        monitors = tuple(
            c.monitor for c in program.monitors if breakpoints or c.monitor.kind not in BREAKPOINTS
        )
        if len(monitors) > MOST or any(m.kind not in _SIMPLE for m in monitors):
            return None
        return Simple(monitors, net)

    def options(self) -> list[str]:
        """For the simulator's command line."""
        return [word for m in self.monitors for word in ("--watch", self._option(m))]

    def _option(self, m: Monitor) -> str:
        match m.kind:
            case Kind.MARKING_SIZE | Kind.LIST_LENGTH:
                letter = "s" if m.kind is Kind.MARKING_SIZE else "l"
                place = m.places[0].place
                if not self.net.timed:
                    return f"{letter} {place} *"
                return f"{letter.upper()} {place} {','.join(map(str, around(self.net, place)))}"
            case Kind.COUNT_OCCURRENCES:
                index = m.transitions[0].index
                return f"c {index} {index}"
            case Kind.PLACE_CONTENT:
                letter = "e" if m.option("if is empty") else "f"
                return f"{letter} {m.places[0].place} *"
            case _:
                letter = "n" if m.option("if is enabled") else "d"
                return f"{letter} {m.transitions[0].index} *"

    def rows(
        self, watched: Sequence[Mapping[str, Number]], time: Number
    ) -> tuple[dict[str, Any], ...]:
        """What each has collected."""
        return tuple(
            result_row(m, self._statistics(m, found, time) if m.kind in COLLECTORS else None)
            for m, found in zip(self.monitors, watched, strict=True)
        )

    def _statistics(self, m: Monitor, found: Mapping[str, Number], time: Number) -> Any:
        return restored(found, time if is_timed(m, self.net) else None)

    def breakpoint(self, index: int) -> Breakpoint:
        """The one that stopped the run."""
        return Breakpoint(self.monitors[index])
