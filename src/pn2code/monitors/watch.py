"""Monitors at work: they watch a game, step by step, and say when it must stop.

    watch = Watch(program, game, flat)
    watch.start()
    for ...: game.fire(element); stopped = watch.occurred(element)
    watch.stop()
    watch.results()

After each step first the monitors work that watch the transition which occurred, then those without transitions; both
in order of the file. Marking size and list length belong to the first kind in timed nets (they watch all transitions
around their place) and to the second in untimed ones, as in CPN Tools.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from dataclasses import field, replace
from typing import Any

from pn2code.base.frozen import frozen, record
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.monitors.codes import MONITOR_FILE, UNSUPPORTED_MONITOR
from pn2code.monitors.folder import Folder
from pn2code.monitors.functions import Checked, MonitorProgram, binding_element, is_timed
from pn2code.monitors.kinds import BREAKPOINTS, COLLECTORS, Kind, Monitor, kind_text
from pn2code.monitors.statistics import Number, Statistics, Untimed
from pn2code.monitors.statistics import Timed as TimedStatistics
from pn2code.net.flat import FlatNet, PlaceInstance
from pn2code.semantics.evaluation.files import FileProblem, Files
from pn2code.semantics.game.errors import GameError, running
from pn2code.semantics.game.marking import BindingElement, PlaceMarking
from pn2code.semantics.game.report import time_text
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.library.builtins_real_texts import format_real
from pn2code.semantics.values.data import Data, MlUnavailable, Value, int_text
from pn2code.semantics.values.multiset import MultiSet


class _Unavailable(Exception):
    """A function of a monitor applied something that is not available here."""


@frozen
class Breakpoint:
    """A breakpoint that was reached."""

    monitor: Monitor

    def row(self) -> dict[str, str]:
        """For reports."""
        return {
            "id": self.monitor.id,
            "name": self.monitor.name,
            "kind": kind_text(self.monitor.kind),
        }


@record
class _Running:
    """A monitor at work."""

    checked: Checked
    functions: Mapping[str, Value]
    transitions: frozenset[int]
    statistics: Statistics | None = None
    active: bool = True
    written: int = 0
    calls: int = 0
    broken_files: set[str] = field(default_factory=set)

    @property
    def monitor(self) -> Monitor:
        return self.checked.monitor

    @property
    def kind(self) -> Kind:
        return self.checked.monitor.kind


class Watch:
    """The monitors of a game.

    Args:
        program: the monitors and their functions.
        game: the game, at its start.
        d: gets warnings while the monitors run.
        folder: where they write.
        breakpoints: whether breakpoints stop the game.
    """

    def __init__(
        self,
        program: MonitorProgram,
        game: Game,
        d: Diagnostics,
        *,
        folder: Folder | None = None,
        breakpoints: bool = True,
    ) -> None:
        self.game = game
        self.net = game.net
        self.d = d
        self.folder = folder or Folder(Files())
        by_id: dict[str, _Running] = {}
        with running(Origin(game.net.file, part="monitors"), "a function of a monitor"):
            ready = program.ready(
                game.evaluator, lambda identity, name: _member(by_id[identity], name)
            )
        self.monitors = [
            self._running(c, ready.get(c.monitor.id, {}))
            for c in program.monitors
            if breakpoints or c.monitor.kind not in BREAKPOINTS
        ]
        by_id.update({m.monitor.id: m for m in self.monitors})
        self._by_transition: dict[int, list[_Running]] = {}
        for m in self.monitors:
            for index in m.transitions:
                self._by_transition.setdefault(index, []).append(m)
        self._each_step = [m for m in self.monitors if not m.transitions]

    def __bool__(self) -> bool:
        """Whether there is any monitor."""
        return bool(self.monitors)

    # --- the life of a game ----------------------------------------------------------------------

    def start(self) -> None:
        """Before the first step.

        Raises:
            GameError: a function of a monitor raises an exception.
        """
        self._set_clock()
        for m in self.monitors:
            self._guarded(m, self._init)

    def occurred(self, element: BindingElement) -> Breakpoint | None:
        """After a step; gives the breakpoint that stops the game.

        Raises:
            GameError: a function of a monitor raises an exception.
        """
        self._set_clock()
        reached: Breakpoint | None = None
        watching = self._by_transition.get(element.transition, ())
        for m in (*watching, *self._each_step):
            if self._guarded(m, lambda m: self._step(m, element)) and reached is None:
                reached = Breakpoint(m.monitor)
        return reached

    def time_grew(self) -> Breakpoint | None:
        """After the clock was moved on: only transition-enabled breakpoints look then."""
        self._set_clock()
        for m in self.monitors:
            if m.kind is Kind.TRANSITION_ENABLED and self._transition_enabled(m):
                return Breakpoint(m.monitor)
        return None

    def stop(self) -> None:
        """After the last step.

        Raises:
            GameError: a function of a monitor raises an exception.
        """
        self._set_clock()
        for m in self.monitors:
            self._guarded(m, self._stop)

    def results(self) -> list[dict[str, Any]]:
        """What each collector has collected, how much each writer has written, in order of the file."""
        rows: list[dict[str, Any]] = []
        for m in self.monitors:
            row = result_row(m.monitor, m.statistics)
            if m.kind is Kind.WRITE_IN_FILE:
                row.update(file=self.folder.path(_file(m.monitor)), written=m.written)
            elif m.kind is Kind.USER_DEFINED:
                row["calls"] = m.calls
            rows.append(row)
        return rows

    # --- one monitor -----------------------------------------------------------------------------

    def _running(self, checked: Checked, functions: Mapping[str, Value]) -> _Running:
        m = checked.monitor
        statistics: Statistics | None = None
        if m.kind in COLLECTORS:
            zero: Number = 0.0 if checked.observed == "real" else 0
            timed = is_timed(m, self.net)
            statistics = TimedStatistics(self._now, zero) if timed else Untimed(zero)
        return _Running(checked, functions, self._transitions(m), statistics)

    def _transitions(self, m: Monitor) -> frozenset[int]:
        """The indices of the transitions after whose occurrences a monitor works; none: after every step."""
        match m.kind:
            case Kind.MARKING_SIZE | Kind.LIST_LENGTH:
                place = m.places[0].place
                return frozenset(around(self.net, place) if self.net.timed else ())
            case Kind.PLACE_CONTENT | Kind.TRANSITION_ENABLED:
                return frozenset()
            case Kind.COUNT_OCCURRENCES:
                return frozenset({m.transitions[0].index})
            case _:
                # All instances: which of them count is the business of `pred`.
                watched = {t.id for t in m.transitions}
                return frozenset(t.index for t in self.net.transitions if t.id in watched)

    def _init(self, m: _Running) -> None:
        if m.statistics is not None and m.monitor.option("logging"):
            self._write(m, _log(m.monitor), _LOG_HEADER)
        match m.kind:
            case Kind.MARKING_SIZE | Kind.LIST_LENGTH:
                self._collect(m, self._measured(m))
            case Kind.DATA_COLLECTION:
                self._collect_option(m, "init")
            case Kind.WRITE_IN_FILE:
                self._write(m, _file(m.monitor), "")
                self._append(m, "init")
            case Kind.USER_DEFINED if "init" in m.functions:
                self._call(m, "init", self._markings(m))
            case _:
                pass

    def _step(self, m: _Running, element: BindingElement) -> bool:
        """Lets a monitor work after a step; whether it wants to stop the game."""
        match m.kind:
            case Kind.MARKING_SIZE | Kind.LIST_LENGTH:
                self._collect(m, self._measured(m))
            case Kind.COUNT_OCCURRENCES:
                self._collect(m, 1)
            case Kind.PLACE_CONTENT:
                empty = len(self._tokens(m.monitor.places[0])) == 0
                return empty == m.monitor.option("if is empty")
            case Kind.TRANSITION_ENABLED:
                return self._transition_enabled(m)
            case _:
                subnet = self._subnet(m, element)
                if not self._call(m, "pred", subnet):
                    return False
                match m.kind:
                    case Kind.BREAKPOINT:
                        return True
                    case Kind.DATA_COLLECTION:
                        value: Any = self._call(m, "obs", subnet)
                        self._collect(m, value)
                    case Kind.WRITE_IN_FILE:
                        text: Any = self._call(m, "obs", subnet)
                        self._write(m, _file(m.monitor), text)
                    case _:
                        self._call(m, "action", subnet)
                        m.calls += 1
        return False

    def _stop(self, m: _Running) -> None:
        match m.kind:
            case Kind.MARKING_SIZE | Kind.LIST_LENGTH if self.net.timed:
                self._collect(m, self._measured(m))
            case Kind.DATA_COLLECTION:
                self._collect_option(m, "stop")
            case Kind.WRITE_IN_FILE:
                self._append(m, "stop")
            case Kind.USER_DEFINED if "stop" in m.functions:
                self._call(m, "stop", self._markings(m))
            case _:
                pass

    def _guarded(self, m: _Running, work: Callable[[_Running], Any]) -> Any:
        """A monitor that uses what is not available here is put aside; the game goes on."""
        if not m.active:
            return None
        try:
            return work(m)
        except _Unavailable as unavailable:
            m.active = False
            self.d.warning(
                UNSUPPORTED_MONITOR,
                f"monitor `{m.monitor.name}`: {unavailable}",
                m.monitor.origin,
                hint="the simulation goes on without the monitor",
            )
            return None

    # --- what monitors see -----------------------------------------------------------------------

    def _now(self) -> Number:
        return self.game.marking.time

    def _set_clock(self) -> None:
        self.game.evaluator.now = self.game.marking.time
        self.game.evaluator.steps = self.game.steps

    def _tokens(self, place: PlaceInstance) -> PlaceMarking:
        return self.game.marking.places[place.place]

    def _measured(self, m: _Running) -> int:
        """The size of the marking, or the length of the list that is the only token."""
        place = m.monitor.places[0]
        tokens = self._tokens(place)
        if m.kind is Kind.MARKING_SIZE:
            return len(tokens)
        if len(tokens) != 1:
            raise GameError(not_one_list(m.monitor, len(tokens)), m.monitor.origin)
        token: Any = next(iter(tokens))
        return len(token.value if self.net.places[place.place].colset.timed else token)

    def _transition_enabled(self, m: _Running) -> bool:
        wanted = m.monitor.transitions[0].index
        enabled = any(t.index == wanted for t in self.game.enabled_transitions(self.game.marking))
        return enabled == m.monitor.option("if is enabled")

    def _multiset(self, place: PlaceInstance) -> Value:
        """The marking of a place as a list, sorted."""
        colset = self.net.places[place.place].colset
        tokens = self._tokens(place)
        if isinstance(tokens, MultiSet):
            values = self.game.colours.sorted(colset, tokens.counts)
            return tuple(v for v in values for _ in range(tokens.counts[v]))
        values = self.game.colours.sorted(colset, tokens.stamps)
        return tuple(token for v in values for token in tokens.tokens(v))

    def _markings(self, m: _Running) -> Value:
        parts = tuple(self._multiset(p) for p in m.monitor.places)
        return parts[0] if len(parts) == 1 else parts

    def _subnet(self, m: _Running, element: BindingElement) -> Value:
        parts = [self._multiset(p) for p in m.monitor.places]
        if m.monitor.transitions:
            t = self.net.transitions[element.transition]
            parts.insert(0, binding_element(m.checked, t, element.binding))
        return parts[0] if len(parts) == 1 else tuple(parts)

    def _call(self, m: _Running, name: str, argument: Value) -> Value:
        origin = replace(m.monitor.origin, part=f"function `{name}`")
        with running(origin, f"function `{name}` of monitor `{m.monitor.name}`"):
            connections = self.game.evaluator.files.connections
            once = nullcontext() if connections is None else connections.computed_once()
            try:
                with once:
                    return self.game.evaluator.apply(m.functions[name], argument)
            except MlUnavailable as unavailable:
                raise _Unavailable(str(unavailable)) from None

    # --- what monitors do ------------------------------------------------------------------------

    def _collect(self, m: _Running, value: Number) -> None:
        assert m.statistics is not None
        m.statistics.update(value)
        if m.monitor.option("logging"):
            text = self._logged(value)
            time = time_text(self.game.marking.time)
            line = f"{text} {m.statistics.count} {self.game.steps} {time}\n"
            self._write(m, _log(m.monitor), line)

    def _logged(self, value: Number) -> str:
        """As CPN Tools writes it."""
        if isinstance(value, int):
            return int_text(value)
        return format_real(self.game.evaluator, _LOGGED, value)

    def _collect_option(self, m: _Running, name: str) -> None:
        if name in m.functions:
            value: Any = self._call(m, name, self._markings(m))
            if value.argument is not None:
                self._collect(m, value.argument)

    def _append(self, m: _Running, name: str) -> None:
        if name in m.functions:
            text: Any = self._call(m, name, self._markings(m))
            self._write(m, _file(m.monitor), text)

    def _write(self, m: _Running, name: str, text: str) -> None:
        if name == _file(m.monitor):
            m.written += len(text)
        if name in m.broken_files:
            return
        try:
            self.folder.append(name, text)
        except (OSError, FileProblem) as problem:
            m.broken_files.add(name)
            said = problem.strerror if isinstance(problem, OSError) else problem.message
            reason = (said or str(problem)).lower()
            self.d.warning(
                MONITOR_FILE,
                f"monitor `{m.monitor.name}` cannot write `{self.folder.path(name)}`: {reason}",
                m.monitor.origin,
                hint="the simulation goes on without the file",
            )


_LOGGED = Data("FIX", 0)
"""How reals are written: with six digits behind the point, of at most 15."""
_LOG_HEADER = "#data counter step time\n"
_FUNCTIONS = {"avrg": "avg", "vari": "variance"}
"""The names of the ML functions, where ours are others."""


def _member(m: _Running, name: str) -> Value:
    """What a function of a collector's structure gives."""
    assert m.statistics is not None
    return m.statistics.values()[_FUNCTIONS.get(name, name)]


def _file(m: Monitor) -> str:
    extension = m.options.get("file extension", "").strip()
    return f"{m.ml_name}.{extension}" if extension else m.ml_name


def _log(m: Monitor) -> str:
    return f"logfiles/{m.ml_name}.log"


def around(net: FlatNet, place: int) -> list[int]:
    """The indices of the transitions with an arc to or from a place."""
    return [t.index for t in net.transitions if any(arc.place == place for arc in t.arcs)]


def result_row(monitor: Monitor, statistics: Statistics | None) -> dict[str, Any]:
    """Which monitor it is, and what it has collected."""
    row: dict[str, Any] = {
        "id": monitor.id,
        "name": monitor.name,
        "kind": kind_text(monitor.kind),
    }
    if statistics is not None:
        row["timed"] = isinstance(statistics, TimedStatistics)
        row.update({k: _finite(v) for k, v in statistics.values().items()})
    return row


def not_one_list(monitor: Monitor, tokens: int) -> str:
    """What is wrong when a list is to be measured and there are no lists, or several."""
    return (
        f"monitor `{monitor.name}` measures the list in place `{monitor.places[0].name}`, "
        f"which holds {tokens} tokens instead of one"
    )


def _finite(x: Number) -> Number | None:
    return None if isinstance(x, float) and not math.isfinite(x) else x
