"""By how much transitions change the numbers in tokens: the sum of those of a place, or of one component of them.

    changes(net)[Amount(place, "stored")]      # {transition: 1, ...}; what is not there does not change it

A transition that takes `t`, or `{stored = n, scrapped = k}`, and puts `{stored = #stored t + 1, scrapped = ...}` or
`n + 1` makes the sum greater by 1, however many tokens the place holds; so does one that puts a token 1, or takes a
token ~1. A place of which another use is made (a term for several tokens, a condition, a reset arc, any other
expression) is left out.
"""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.net.flat import ArcKind, FlatArc, FlatNet, FlatTransition, Term
from pn2code.net.put_token import token_put


@frozen
class Amount:
    """What is added up over the tokens of a place.

    Args:
        place: its index.
        label: None: 1 for each token; "": the number that it is; else this component of it.
    """

    place: int
    label: str | None = None


def changes(net: FlatNet) -> dict[Amount, dict[int, int]]:
    """Of all amounts of numbers that are known to change by constants: by transition, by how much."""
    found: dict[Amount, dict[int, int]] = {}
    for place in net.places:
        for label in _labels(place.colset):
            own = _of(net, place.index, label)
            if own is not None and any(own.values()):
                found[Amount(place.index, label)] = own
    return found


def _labels(colset: Colset) -> tuple[str, ...]:
    """Of the numbers in a token."""
    base = colset.resolved
    if base.kind is Kind.INT:
        return ("",)
    if base.kind not in (Kind.RECORD, Kind.PRODUCT):
        return ()
    labels = (
        base.labels if base.kind is Kind.RECORD else map(str, range(1, 1 + len(base.components)))
    )
    parts = zip(labels, base.components, strict=True)
    return tuple(k for k, part in parts if part is not None and part.resolved.kind is Kind.INT)


def _of(net: FlatNet, place: int, label: str) -> dict[int, int] | None:
    found: dict[int, int] = {}
    for t in net.transitions:
        arcs = [a for a in t.arcs if a.place == place and a.kind is not ArcKind.INHIBITOR]
        change = 0 if all(a.kind is ArcKind.BOTH for a in arcs) else _change(t, arcs, label)
        if change is None:
            return None
        found[t.index] = change
    return {t: n for t, n in found.items() if n}


def _change(t: FlatTransition, arcs: list[FlatArc], label: str) -> int | None:
    """By how much an occurrence changes the sum; None: that is not known."""
    kinds = [a.kind for a in arcs]
    if not set(kinds) <= {ArcKind.INPUT, ArcKind.OUTPUT} or len(set(kinds)) < len(kinds):
        return None
    term: Term | None = None
    value: core.Exp | None = None
    for arc in arcs:
        if arc.kind is ArcKind.INPUT:
            term = _one_token(arc)
        else:
            value = token_put(arc)
    before: core.Symbol | int | None = 0  # where nothing is taken
    whole = None
    if ArcKind.INPUT in kinds:
        if term is None:
            return None
        before, whole = _before(term, label)
    if t.code is not None and {before, whole}.intersection(t.code.outputs):
        return None
    if ArcKind.OUTPUT not in kinds:
        return -before if isinstance(before, int) else None
    after = None if value is None else _component(value, label, whole)
    return None if after is None else _difference(before, after, label, whole)


def _one_token(arc: FlatArc) -> Term | None:
    """The term of an arc that takes one token, whatever the binding is; None: it takes others."""
    terms = arc.inscription.terms if arc.inscription is not None else ()
    if len(terms) != 1 or terms[0].whole or _number(terms[0].coefficient) != 1:
        return None
    return terms[0]


def _number(e: core.Exp) -> int | None:
    return e.value if isinstance(e, core.Lit) and isinstance(e.value, int) else None


def _before(term: Term, label: str) -> tuple[core.Symbol | int | None, core.Symbol | None]:
    """As `_taken`, of a term that may have no variables."""
    if term.pattern is not None:
        return _taken(term.pattern, label)
    fixed = _component(term.value, label, None)
    return (None if fixed is None else _number(fixed)), None


def _taken(
    pattern: core.Pat | None, label: str
) -> tuple[core.Symbol | int | None, core.Symbol | None]:
    """What the number is bound to, or has to be; and what the whole token is bound to."""
    match pattern:
        case core.PVar(symbol):
            return (symbol if not label else None), symbol
        case core.PRecord(fields) if label:
            return _taken(dict(fields).get(label), "")[0], None
        case core.PLit(int() as value) if not label:
            return value, None
    return None, None


def _component(value: core.Exp, label: str, whole: core.Symbol | None) -> core.Exp | None:
    """The expression of the number in the token that is put."""
    if not label:
        return value
    if isinstance(value, core.RecordExp):
        return dict(value.fields).get(label)
    is_same = isinstance(value, core.Var) and value.symbol == whole
    return core.Select(label, value, value.type, value.span) if is_same else None


def _difference(
    before: core.Symbol | int | None, after: core.Exp, label: str, whole: core.Symbol | None
) -> int | None:
    """`after` less what the number was."""
    match after:
        case core.Var(symbol) if symbol == before:
            return 0
        case core.Select(name, core.Var(symbol)) if symbol == whole and name == label and label:
            return 0
        case core.Lit(int() as value) if isinstance(before, int):
            return value - before
        case core.Apply(core.Builtin("Int.+" | "Int.-" as name), core.RecordExp(fields)):
            sides = dict(fields)
            first, second = sides["1"], sides["2"]
            if name == "Int.+" and isinstance(first, core.Lit):
                first, second = second, first
            more, inner = _number(second), _difference(before, first, label, whole)
            if more is None or inner is None:
                return None
            return inner + (more if name == "Int.+" else -more)
    return None
