"""The CPN ML functions of monitors: checked with the net's declarations, made ready to be called.

For each monitor CPN Tools declares a datatype of the binding elements it may see, `Page'Trans of int * {x: INT, ...}`,
then the functions that the author wrote. Data collectors are structures for the monitors after them:
`Queue_Delay.count ()`, `.last ()`, `.avrg ()`, ...

    program = elaborate(monitors, flat, elaborator, d)
    ready = program.ready(evaluator, statistics)           # values of the functions, by monitor
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field, replace
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostic, Diagnostics, Severity, SourceText, Span
from pn2code.ml.core.terms import Con, Dec, Let, RecBind, RecordExp, Symbol, Var
from pn2code.ml.core.types import label_key, record
from pn2code.ml.elaborate import Elaborator
from pn2code.ml.typing.context import BY_SOCKETS
from pn2code.monitors.codes import MONITOR_ERROR, UNSUPPORTED_MONITOR
from pn2code.monitors.kinds import COLLECTORS, Kind, Monitor, ml_name
from pn2code.net import generative
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.values.data import UNIT, Data, Native, Value

_WRITTEN = frozenset({Kind.DATA_COLLECTION, Kind.BREAKPOINT, Kind.WRITE_IN_FILE, Kind.USER_DEFINED})
"""Kinds with functions that the author writes."""
_ORDER = ("auxiliary", "aux", "init", "predicate", "observer", "stop", "action")
"""CPN Tools declares them in this order, so that later ones may use earlier ones."""
_NAMES = {
    "init": "init",
    "predicate": "pred",
    "observer": "obs",
    "stop": "stop",
    "action": "action",
}
_NEEDED = {
    Kind.DATA_COLLECTION: ("predicate", "observer"),
    Kind.BREAKPOINT: ("predicate",),
    Kind.WRITE_IN_FILE: ("predicate", "observer"),
    Kind.USER_DEFINED: ("predicate", "observer", "action"),
}
_IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_']*")
_MOST = 3
"""Errors that are told of one monitor."""

OBSERVED = ("int", "real", "IntInf.int")
"""Types of the numbers that a data collector may observe, in the order in which CPN Tools tries them."""


@frozen
class Checked:
    """A monitor whose functions are well-typed.

    Args:
        monitor: it.
        symbols: its functions by name ("pred", "obs", "init", "stop", "action").
        observed: of a data collector: the type of its values.
        constructors: tags in the datatype of its binding elements, by name.
        tokens: of a breakpoint or data collector that looks at no marking: for each of these names a function of the
            instance's number and the binding, which gives one unit or the observed value when the predicate is true,
            and nothing otherwise.
        span: a piece of text of its functions.
    """

    monitor: Monitor
    symbols: Mapping[str, Symbol]
    observed: str = "int"
    constructors: Mapping[str, int] | None = None
    tokens: Mapping[str, Symbol] = field(default_factory=dict)
    span: Span | None = None


@frozen
class MonitorProgram:
    """The monitors of a net.

    Args:
        monitors: those that work, in order of the file.
        declarations: their functions, in order of evaluation.
        statistics: what stands for a statistic of a collector: symbol -> (id of the monitor, function).
    """

    monitors: tuple[Checked, ...]
    declarations: tuple[Dec, ...]
    statistics: Mapping[Symbol, tuple[str, str]]

    def ready(
        self, evaluator: Evaluator, statistic: Callable[[str, str], Value]
    ) -> dict[str, dict[str, Value]]:
        """The functions by id of the monitor and name.

        Args:
            evaluator: of the game that is watched.
            statistic: gives what a function of a collector gives now.
        """
        for symbol, (identity, name) in self.statistics.items():
            evaluator.globals[symbol.uid] = _statistic(statistic, identity, name)
        symbols = [s for m in self.monitors for s in m.symbols.values()]
        if not symbols:
            return {}
        span = _span(self.declarations)
        fields = tuple((str(i), Var(s, s.type, span)) for i, s in enumerate(symbols, 1))
        body = RecordExp(fields, record({str(i): s.type for i, s in enumerate(symbols, 1)}), span)
        found: Any = evaluator.value(Let(self.declarations, body, body.type, span))
        values = iter(found)
        return {m.monitor.id: {name: next(values) for name in m.symbols} for m in self.monitors}


def _span(declarations: Sequence[Dec]) -> Span:
    return next(d.span for d in declarations if d.span is not None)


def _statistic(statistic: Callable[[str, str], Value], identity: str, name: str) -> Native:
    return Native(name, 1, lambda evaluator, unit: statistic(identity, name))


def elaborate(
    monitors: Sequence[Monitor],
    flat: FlatNet,
    elaborator: Elaborator,
    d: Diagnostics,
    *,
    connected: bool = False,
) -> MonitorProgram:
    """Checks the functions of all monitors; those that are wrong are warned of and left out.

    A monitor may use collectors that stand after it in the file: those that fail are tried again.

    Args:
        monitors: of the net.
        flat: the net.
        elaborator: that has seen its declarations.
        d: gets the warnings.
        connected: whether a run has connections to other programs; if not, monitors that use some are left out.
    """
    done: dict[str, Checked] = {}
    declarations: list[Dec] = []
    stubs: dict[str, tuple[str, str]] = {}
    problems: dict[str, list[Diagnostic]] = {}
    with elaborator.aside(Diagnostics()) as outer:
        waiting = list(monitors)
        while waiting:
            left = []
            for monitor in waiting:
                own = Diagnostics()
                checked, made = _Functions(monitor, flat, elaborator, own, connected).check()
                if checked is None:
                    problems[monitor.id] = own.items
                    left.append(monitor)
                    continue
                done[monitor.id] = checked
                declarations += made
                if monitor.kind in COLLECTORS and _IDENTIFIER.fullmatch(monitor.ml_name):
                    stubs.update(_declare_structure(checked, flat, elaborator))
            if len(left) == len(waiting):
                break
            waiting = left
        else:
            left = []
    for monitor in left:
        _report(monitor, problems[monitor.id], d)
    statistics = {outer.globals[name]: stub for name, stub in stubs.items()}
    standing = [
        dec
        for dec in outer.declarations
        if not (isinstance(dec, RecBind) and all(s in statistics for s, _ in dec.bindings))
    ]
    return MonitorProgram(
        tuple(done[m.id] for m in monitors if m.id in done),
        (*standing, *declarations),
        statistics,
    )


def _report(monitor: Monitor, problems: Iterable[Diagnostic], d: Diagnostics) -> None:
    """What is wrong with a monitor, as warnings."""
    unsupported = [p for p in problems if p.code.startswith("unsupported-")]
    wrong = [p for p in problems if p.severity is Severity.ERROR and p not in unsupported]
    for p in (unsupported or wrong)[:_MOST]:
        origin = p.origin if p.origin.line else replace(monitor.origin, part=p.origin.part)
        d.warning(
            UNSUPPORTED_MONITOR if unsupported else MONITOR_ERROR,
            f"monitor `{monitor.name}`: {p.message}",
            p.span if p.span is not None and p.origin.line else origin,
            label=p.label,
            notes=p.notes,
            hint=p.hint or "the monitor is left out of the simulation",
        )


# --- one monitor -----------------------------------------------------------------------------------


class _Functions:
    """The functions of one monitor."""

    def __init__(
        self,
        m: Monitor,
        flat: FlatNet,
        elaborator: Elaborator,
        d: Diagnostics,
        connected: bool,
    ) -> None:
        self.m = m
        self.connected = connected
        self.flat = flat
        self.elaborator = elaborator
        self.d = d
        names = {constructor(t): t for t in reversed(m.transitions)}
        self.transitions = [names[name] for name in sorted(names)]

    def check(self) -> tuple[Checked | None, tuple[Dec, ...]]:
        """With their declarations; None after errors, and for what cannot run here."""
        m = self.m
        if m.kind not in _WRITTEN:
            return Checked(m, {}), ()
        missing = [_NAMES[f] for f in _NEEDED[m.kind] if f not in m.functions]
        if missing:
            self.d.error(MONITOR_ERROR, f"the function `{missing[0]}` is missing", m.origin)
            return None, ()
        if m.kind is Kind.DATA_COLLECTION and m.option("timed") and not self.flat.timed:
            self.d.error(
                MONITOR_ERROR,
                "a timed data collector needs a place with a timed colour set, and the net has none",
                m.origin,
                hint="it is left out of the simulation; switch off its option `Timed`",
            )
            return None, ()
        observed = "int"
        with self.elaborator.aside(self.d) as inner:
            self.elaborator.declarations(self.generated(self.binding_elements()))
            for name in sorted(m.functions, key=_order):
                self.elaborator.declarations(m.functions[name])
            if not self.d.has_errors:
                observed = self.observed()
                for name, type_text in self.types(observed).items():
                    self.elaborator.declarations(self.constrained(name, type_text))
                if self.gives_tokens(inner.declarations, observed):
                    self.elaborator.declarations(self.generated(self.tokens(observed)))
        if not self.d.has_errors:
            declarations = (*self.flat.program.declarations, *inner.declarations)
            generative.refuse_beside(declarations, (), self.d)
        if self.d.has_errors or any(map(self.is_unsupported, self.d)):
            return None, ()
        symbols = {name: inner.globals[f"CPN'{name}"] for name in self.types(observed)}
        tags = {constructor(t): tag for tag, t in enumerate(self.transitions)}
        tokens = {}
        if self.gives_tokens(inner.declarations, observed):
            tokens = {name: inner.globals[f"CPN'tokens'{tag}"] for name, tag in tags.items()}
        span = _span(inner.declarations)
        return Checked(m, symbols, observed, tags, tokens, span), inner.declarations

    def is_unsupported(self, item: Diagnostic) -> bool:
        """Whether it says that something cannot run here."""
        return item.code.startswith("unsupported-") and not (
            self.connected and BY_SOCKETS in item.message
        )

    def gives_tokens(self, declarations: Sequence[Dec], observed: str) -> bool:
        """Whether all that the monitor sees is one unit or number at occurrences (`Checked.tokens`)."""
        if self.m.places:
            return False
        if self.m.kind is Kind.BREAKPOINT:
            return True
        return (
            self.m.kind is Kind.DATA_COLLECTION
            and observed in ("int", "real")
            and all(_gives_nothing(declarations, f) for f in ("init", "stop"))
        )

    def tokens(self, observed: str) -> str:
        """The functions of `Checked.tokens`."""
        is_collector = self.m.kind is Kind.DATA_COLLECTION
        kind, given = (observed, "CPN'obs CPN'e") if is_collector else ("unit", "()")
        return "\n".join(
            f"fun CPN'tokens'{tag} (CPN'i : int, CPN'b : {_variables(t)}) : {kind} list = "
            f"let val CPN'e = {constructor(t)} (CPN'i, CPN'b) in if CPN'pred CPN'e then [{given}] else [] end;"
            for tag, t in enumerate(self.transitions)
        )

    def generated(self, text: str) -> SourceText:
        """A text of ours, at the position of the monitor."""
        return SourceText(text, replace(self.m.origin, line=0, column=0))

    def constrained(self, name: str, type_text: str) -> SourceText:
        """A function under a name of ours, with the type that it must have."""
        source = "action o obs" if name == "action" else name
        return self.generated(f"val CPN'{name} : {type_text} = {source}")

    def observed(self) -> str:
        """The type of numbers that a data collector observes."""
        if self.m.kind is not Kind.DATA_COLLECTION:
            return "int"
        for candidate in OBSERVED:
            quiet = Diagnostics()
            with self.elaborator.aside(quiet):
                self.elaborator.declarations(
                    self.constrained("obs", f"{self.subnet()} -> {candidate}")
                )
            if not quiet.has_errors:
                return candidate
        return "int"

    def types(self, observed: str) -> dict[str, str]:
        """The type of each function that the monitor calls."""
        subnet, markings = self.subnet(), self.markings()
        given = {_NAMES[f] for f in self.m.functions if f in _NAMES}
        option = f"({observed}) option"
        found = {
            Kind.DATA_COLLECTION: {
                "pred": f"{subnet} -> bool",
                "obs": f"{subnet} -> {observed}",
                "init": f"{markings} -> {option}",
                "stop": f"{markings} -> {option}",
            },
            Kind.BREAKPOINT: {"pred": f"{subnet} -> bool"},
            Kind.WRITE_IN_FILE: {
                "pred": f"{subnet} -> bool",
                "obs": f"{subnet} -> string",
                "init": f"{markings} -> string",
                "stop": f"{markings} -> string",
            },
            Kind.USER_DEFINED: {
                "pred": f"{subnet} -> bool",
                "action": f"{subnet} -> unit",
                "init": f"{markings} -> unit",
                "stop": f"{markings} -> unit",
            },
        }[self.m.kind]
        return {name: text for name, text in found.items() if name in given}

    def binding_elements(self) -> str:
        """The datatype of the binding elements: all variables of each transition, outputs of code segments included."""
        if not self.transitions:
            return "type BindElem = unit"
        return "datatype BindElem = " + " | ".join(
            f"{constructor(t)} of int * {_variables(t)}" for t in self.transitions
        )

    def subnet(self) -> str:
        """The type of what `pred` and `obs` are given."""
        parts = [*(["BindElem"] if self.transitions else []), *self._marking_types()]
        return " * ".join(parts) or "unit"

    def markings(self) -> str:
        """The type of what `init` and `stop` are given."""
        return " * ".join(self._marking_types()) or "unit"

    def _marking_types(self) -> list[str]:
        colsets = [self.flat.places[p.place].colset for p in self.m.places]
        return [f"{c.name} {'tms' if c.timed else 'ms'}" for c in colsets]


def _gives_nothing(declarations: Sequence[Dec], name: str) -> bool:
    """Whether a function is `fun name ... = NONE` in all its rules, or is not declared."""
    found = [
        function
        for dec in declarations
        if isinstance(dec, RecBind)
        for symbol, function in dec.bindings
        if symbol.name == name
    ]
    return all(
        isinstance(rule.body, Con) and rule.body.constructor.name == "NONE"
        for function in found[-1:]
        for rule in function.rules
    )


def _order(name: str) -> int:
    return _ORDER.index(name) if name in _ORDER else 0


def constructor(t: FlatTransition) -> str:
    """The name of a transition's binding elements."""
    return f"{ml_name(t.page)}'{ml_name(t.short)}"


def _variables(t: FlatTransition) -> str:
    fields = ", ".join(f"{s.name}: {s.colset.name}" for s in t.variables if s.colset is not None)
    return f"{{{fields}}}" if fields else "unit"


# --- the collectors as structures ------------------------------------------------------------------


def _declare_structure(
    checked: Checked, flat: FlatNet, elaborator: Elaborator
) -> dict[str, tuple[str, str]]:
    """The structure of a collector, and the names of the functions that stand for its statistics.

    The functions of the structure call these; what they give is decided when the monitors run.
    """
    m = checked.monitor
    data = "real" if checked.observed == "real" else "IntInf.int"
    total = data if data == "real" or not is_timed(m, flat) else "time"
    types = {
        "count": "int", "min": data, "max": data, "first": data, "last": data, "sum": total, "ss": total,
        "avrg": "real", "ssd": "real", "vari": "real", "std": "real",
    }  # fmt: skip
    if is_timed(m, flat):
        types.update(dict.fromkeys(("starttime", "lasttime", "interval"), "time"))
    stubs = {name: f"CPN'{m.ml_name}'{name}" for name in types}
    origin = replace(m.origin, line=0, column=0)
    for name, stub in stubs.items():
        text = f'fun {stub} () : {types[name]} = raise CPN\'Error "{name}"'
        elaborator.declarations(SourceText(text, origin))
    members = " ".join(f"fun {name} () = {stub} ()" for name, stub in stubs.items())
    elaborator.declarations(SourceText(f"structure {m.ml_name} = struct {members} end", origin))
    return {stub: (m.id, name) for name, stub in stubs.items()}


def is_timed(m: Monitor, flat: FlatNet) -> bool:
    """Whether the values of a collector are weighted with time."""
    if m.kind is Kind.DATA_COLLECTION:
        return m.option("timed") and flat.timed
    return flat.timed and m.kind in (Kind.MARKING_SIZE, Kind.LIST_LENGTH)


# --- values ----------------------------------------------------------------------------------------


def binding_element(checked: Checked, t: FlatTransition, binding: Mapping[Symbol, Value]) -> Value:
    """`Top'T (1, {x = 5})` as a value."""
    labels = sorted(
        (s for s in t.variables if s.colset is not None), key=lambda s: label_key(s.name)
    )
    name = constructor(t)
    fields = tuple(binding[s] for s in labels) if labels else UNIT
    assert checked.constructors is not None
    return Data(name, checked.constructors[name], (t.instance_number, fields))
