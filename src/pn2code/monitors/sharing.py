"""Which references of a net its monitors share with it.

The token game that follows a compiled run has references of its own. What monitors do to them reaches the compiled net
only through that game, that is, not at all: where both use the same reference and a monitor changes one, the run needs
the token game alone.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from pn2code.ml.core.terms import Dec, RecBind, Symbol, ValBind
from pn2code.ml.core.types import TCon, TFun, TRecord, Type
from pn2code.monitors.functions import MonitorProgram
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.effects import Effect, Effects
from pn2code.semantics.evaluation.used_symbols import variables


def shared_references(program: MonitorProgram, net: FlatNet) -> tuple[str, ...]:
    """The names of the references that both use; () when no monitor changes any reference."""
    everything = (*net.program.declarations, *program.declarations)
    effects = Effects(replace(net.program, declarations=everything))
    if not any(Effect.WRITE in effects.of(dec) for dec in program.declarations):
        return ()
    uses = _Uses(net.program.declarations)
    watching = uses.references(program.declarations)
    playing = uses.references(_inscriptions(net))
    return tuple(sorted({s.name for s in watching & playing}))


def _inscriptions(net: FlatNet) -> Iterable[Any]:
    """All expressions and patterns that the net evaluates while it runs."""
    for t in net.transitions:
        yield from t.guards
        yield t.delay
        yield t.code.action if t.code else None
        for arc in t.arcs:
            if arc.inscription is not None:
                yield arc.inscription.value
                for term in arc.inscription.terms:
                    yield from (term.coefficient, term.value, term.delay)
    for colset in net.program.colsets.values():
        yield from (colset.predicate, colset.members)


class _Uses:
    """What declarations use, directly or not."""

    def __init__(self, declarations: Iterable[Dec]) -> None:
        self._of: dict[Symbol, frozenset[Symbol]] = {}
        for dec in declarations:
            if isinstance(dec, RecBind):
                self._of.update({symbol: variables(body) for symbol, body in dec.bindings})
            elif isinstance(dec, ValBind):
                self._of.update(dict.fromkeys(variables(dec.pattern), variables(dec.value)))

    def references(self, nodes: Iterable[Any]) -> set[Symbol]:
        """The globals that hold references, among all that some expressions use."""
        todo = [s for node in nodes if node is not None for s in variables(node)]
        found: set[Symbol] = set()
        while todo:
            symbol = todo.pop()
            if symbol not in found:
                found.add(symbol)
                todo.extend(self._of.get(symbol, ()))
        return {s for s in found if s.is_global and _holds_reference(s.type)}


def _holds_reference(t: Type) -> bool:
    match t:
        case TCon(name, arguments):
            return name == "ref" or any(map(_holds_reference, arguments))
        case TRecord(fields):
            return any(_holds_reference(field) for _, field in fields)
        case TFun():
            return False  # what it uses is looked at by itself
        case _:
            return False
