"""Monitors that the compiled simulator watches by itself (cnative/src/simulate/simulate_watch.c).

simple = Simple.of(program, net, breakpoints=True)       # None: the token game has to watch
simple.options()                                         # ["--watch", "S 3 0,4", ...]
simple.rows(report["watched"], time)                     # as Watch.results()
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import Any

from pn2code.base.frozen import frozen
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


@frozen
class Simple:
    """The monitors of a net, all of them simple.

    Args:
        monitors: those with predicates first, as they look first (`Watch.occurred`), then as in the file.
        net: the net.
        own: by id of a monitor with functions the place that gets what it sees (`compiling.py`).
        reals: the ids of the collectors that observe reals.
        order: their numbers in order of the file.
    """

    monitors: tuple[Monitor, ...]
    net: FlatNet
    own: Mapping[str, int] = field(default_factory=dict)
    reals: frozenset[str] = frozenset()
    order: tuple[int, ...] = ()

    @staticmethod
    def of(
        program: MonitorProgram,
        net: FlatNet,
        *,
        breakpoints: bool,
        own: Mapping[str, int] | None = None,
    ) -> Simple | None:
        """The monitors at work, if all of them are simple, or have a place in `own`."""
        of = own or {}
        given = [
            c.monitor for c in program.monitors if breakpoints or c.monitor.kind not in BREAKPOINTS
        ]
        monitors = sorted(given, key=lambda m: m.id not in of)
        if len(monitors) > MOST or any(m.kind not in _SIMPLE and m.id not in of for m in monitors):
            return None
        reals = frozenset(c.monitor.id for c in program.monitors if c.observed == "real")
        return Simple(tuple(monitors), net, of, reals, tuple(map(monitors.index, given)))

    def options(self) -> list[str]:
        """For the simulator's command line."""
        return [word for m in self.monitors for word in ("--watch", self._option(m))]

    def _option(self, m: Monitor) -> str:
        match m.kind:
            case Kind.BREAKPOINT:
                return f"f {self.own[m.id]} *"
            case Kind.DATA_COLLECTION:
                letter = "r" if m.id in self.reals else "i"
                watched = {t.id for t in m.transitions}
                when = [str(t.index) for t in self.net.transitions if t.id in watched]
                return f"{letter.upper() if is_timed(m, self.net) else letter} {self.own[m.id]} {','.join(when)}"
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
        rows = [
            result_row(m, self._statistics(m, found, time) if m.kind in COLLECTORS else None)
            for m, found in zip(self.monitors, watched, strict=True)
        ]
        return tuple(rows[i] for i in self.order)

    def _statistics(self, m: Monitor, found: Mapping[str, Number], time: Number) -> Any:
        return restored(found, time if is_timed(m, self.net) else None)

    def breakpoint(self, index: int) -> Breakpoint:
        """The one that stopped the run."""
        return Breakpoint(self.monitors[index])
