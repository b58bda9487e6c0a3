"""What of a net's declarations can be reached from its inscriptions: of the rest nothing has to run."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from pn2code.diagnostics import Diagnostic, Origin
from pn2code.ml.codes import UNSUPPORTED_BUILTIN
from pn2code.ml.core.terms import Builtin, Dec, Exp, Lambda, RecBind, Symbol, ValBind, Var
from pn2code.ml.library.builtins import BUILTINS
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.net.uses import pattern_variables, walk


def reached(net: FlatNet) -> Iterator[Exp]:
    """Every expression that a run of the net can come to: of inscriptions, initial markings, code segments, of the
    declarations that they use, and of those that are evaluated at the start."""
    todo: list[Exp] = []
    for place in net.places:
        if place.initial is not None:
            todo.append(place.initial[0])
    for colset in net.program.colsets.values():
        todo += [e for e in (colset.members, colset.predicate) if e is not None]
    for t in net.transitions:
        todo += inscriptions(t)
    yield from reached_from(net.program.declarations, todo)


def reached_from(declarations: Iterable[Dec], texts: Iterable[Exp]) -> Iterator[Exp]:
    """Every expression that evaluating some can come to, and the declarations that they use or that are evaluated
    themselves."""
    declared: dict[Symbol, Exp] = {}
    todo = list(texts)
    for dec in declarations:
        if isinstance(dec, ValBind):
            declared.update(dict.fromkeys(pattern_variables(dec.pattern), dec.value))
            if not isinstance(dec.value, Lambda):
                todo.append(dec.value)
        elif isinstance(dec, RecBind):
            declared.update(dec.bindings)
    seen: set[int] = set()
    while todo:
        root = todo.pop()
        if id(root) in seen:
            continue
        seen.add(id(root))
        for e in walk(root):
            yield e
            if isinstance(e, Var) and e.symbol in declared:
                todo.append(declared[e.symbol])


def inscriptions(t: FlatTransition) -> Iterator[Exp]:
    """All that is evaluated for a transition: whole inscriptions, the terms of those of arcs as their parts."""
    yield from t.guards
    if t.delay is not None:
        yield t.delay
    if t.code is not None:
        yield t.code.action
    for arc in t.arcs:
        if arc.inscription is not None:
            yield arc.inscription.value


def unused_functions(net: FlatNet) -> Callable[[Diagnostic], bool]:
    """Tells the warnings of functions that cannot run here and that no run of the net comes to."""
    used = {
        (*_place(e.span.source.origin), e.name.rpartition(".")[2])
        for e in reached(net)
        if isinstance(e, Builtin) and e.name in BUILTINS and BUILTINS[e.name].unsupported
    }

    def is_unused(warning: Diagnostic) -> bool:
        if warning.code != UNSUPPORTED_BUILTIN or warning.span is None:
            return False
        name = warning.message.split("`")[1].rpartition(".")[2]
        return (*_place(warning.span.source.origin), name) not in used

    return is_unused


def _place(origin: Origin) -> tuple[str, str]:
    """Of each element a function is warned of once, so its part of the element tells."""
    return origin.element_id or str(origin), origin.part
