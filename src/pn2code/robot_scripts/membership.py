"""Whether a value is in a colour set: that of the variable that takes it, or of the place that gets it.

    var s : SMALL;  and an arc `in flag : s` from a place of colour set INT
    ->  s >= 0 and s <= 3
    place Count : SMALL;  and an arc `out Count : s + 1`
    ->  s + 1 >= 0 and s + 1 <= 3

Where all values that may come are in the colour set, nothing is asked.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Set
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.terms import Symbol
from pn2code.robot_scripts import lists
from pn2code.robot_scripts.failing import Known
from pn2code.robot_scripts.operations import builtin, item_of, logical_not, others_of
from pn2code.robot_scripts.unsupported import UnsupportedError
from pn2code.robot_scripts.values import (
    FALSE,
    TRUE,
    Rec,
    Rows,
    Scalar,
    Value,
    conjunction,
    disjunction,
    scalars_in,
    select,
)
from pn2code.tdl import tree as t
from pn2code.tdl import types as tdl


def of_pattern(pattern: core.Pat, source: Colset | None) -> Iterator[tuple[Symbol, Colset | None]]:
    """The variables of a pattern, each with the colour set of what it takes; None: that is not known."""
    match pattern:
        case core.PVar(symbol):
            yield symbol, source
        case core.PAs(symbol, inner):
            yield symbol, source
            yield from of_pattern(inner, source)
        case core.PRecord(fields):
            parts = parts_of(source)
            for label, part in fields:
                yield from of_pattern(part, parts.get(label))
        case core.PCon(constructor, core.PRecord(((_, head), (_, tail)))) if (
            constructor.name == "::"
        ):
            one = None if source is None else source.whole
            is_list = one is not None and one.kind is Kind.LIST
            yield from of_pattern(head, one.components[0] if is_list and one else None)
            yield from of_pattern(tail, _longer(source, -1))
        case core.PCon(argument=argument) if argument is not None:
            yield from of_pattern(argument, None)
        case _:
            return


def conditions(
    symbol: Symbol, value: Value, source: Colset | None, span: Span
) -> list[t.Expression]:
    """What has to be so of a value that a variable is to have.

    Raises:
        UnsupportedError: scripts cannot ask it.
    """
    if symbol.colset is None:
        return []
    try:
        return [e for e in _of(symbol.colset, value, source, span) if e != t.Value(True)]
    except _UnaskableError as problem:
        colset = problem.args[0]
        raise UnsupportedError(
            f"variable `{symbol.name}` takes only what is in colour set `{colset.name}`, and a script cannot ask "
            "whether a value is in it: give the variable the colour set of the place, or of what is computed",
            span,
        ) from None


@frozen
class Where:
    """Where a token is put.

    Args:
        taken: the variables (by their uid) whose values are in their colour sets, because an arc or an equation binds
            them.
        known: of numbers.
        value_of: the value of an expression of the net there.
    """

    taken: Set[int]
    known: Known
    value_of: Callable[[core.Exp], Value]

    def under(self, condition: t.Expression, holds: bool) -> Where:
        """The same where a condition holds, or does not."""
        return replace(self, known=self.known.with_condition(condition, holds))


def of_token(colset: Colset, e: core.Exp, there: Where) -> list[t.Expression]:
    """What has to be so of a token that a place of a colour set gets.

    Args:
        colset: of the place.
        e: the expression of the net that gives it.
        there: what is known.

    Raises:
        UnsupportedError: scripts cannot ask it.
    """
    try:
        return [
            condition
            for part, inner, of in _components(colset, there.value_of(e), e, e.span)
            for condition in _of_part(part, inner, of, there, e.span)
        ]
    except _UnaskableError as problem:
        place = problem.args[0]
        raise UnsupportedError(
            f"what is put here has to be in colour set `{place.name}`, and a script cannot ask whether a value is in "
            "it: put the value of a variable of this colour set, or a constant"
            + (_OF_LISTS if place.kind is Kind.LIST else ""),
            e.span,
        ) from None


_OF_LISTS = (
    ", or a list that is made of such variables and of items that are written out (`item :: l`, `l ^^ [item]`, "
    "`rev l`, `if c then item :: l else l`)"
)


def _components(
    c: Colset, value: Value, e: core.Exp | None, span: Span
) -> Iterator[tuple[Colset, Value, core.Exp | None]]:
    """The parts of a value that have bounds, with what gives each of them where that is written."""
    c = c.resolved
    if not has_bounds(c):
        return
    if c.kind not in (Kind.RECORD, Kind.PRODUCT) or isinstance(e, core.Var | core.Select):
        yield c, value, e
        return
    written = dict(e.fields) if isinstance(e, core.RecordExp) else {}
    for label, part in parts_of(c).items():
        yield from _components(part, select(value, label, span), written.get(label), span)


def _of_part(
    c: Colset, value: Value, e: core.Exp | None, there: Where, span: Span
) -> list[t.Expression]:
    """What has to be so of a part of a token."""
    source = _source(e, there.taken)
    if source is not None and source.resolved == c:
        return []
    element = c.components[0].resolved if c.kind is Kind.LIST and c.components[0] else None
    if element is not None and e is not None and has_bounds(element):
        assert isinstance(value, Scalar | Rows), "it is a list"
        found = _items(element, value, e, there)
        if found is not None:
            length = replace(c, name="", low=found.low, high=found.high)
            return [*found.asked, *_unless_known(c, value, length, there.known, e.span)]
    return list(_unless_known(c, value, source, there.known, span))


@frozen
class _Items:
    """Of a list: what has to be so of its items, and how many there are at least and at most (None: any number)."""

    asked: tuple[t.Expression, ...]
    low: int
    high: int | None

    def before(self, other: _Items) -> _Items:
        """Of a list with the items of both."""
        high = None if self.high is None or other.high is None else self.high + other.high
        return _Items((*self.asked, *other.asked), self.low + other.low, high)


def _items(element: Colset, value: Scalar | Rows, e: core.Exp, there: Where) -> _Items | None:
    """Of a list some items of which are written out: `n - 1 :: l`, `l ^^ [n]`, `if a then [n] else l`.

    Args:
        element: the colour set that the items are to have.

    None: some of its other items are not known.
    """
    match e:
        case core.ListExp(items):
            if any(lists.items_of(x.exp) is None for x in scalars_in(value)):
                return None
            found = _Items((), 0, 0)
            for item in items:
                found = found.before(_item(element, item_of(value), item, there))
                value = others_of(value)
            return found
        case core.Apply(core.Builtin("List.@"), core.RecordExp(((_, front), (_, behind)))):
            parts = [_items_of(element, x, there) for x in (front, behind)]
            both = [x for x in parts if x is not None]
            return both[0].before(both[1]) if len(both) == len(parts) else None
        case core.Apply(core.Builtin("List.rev"), of):
            return _items_of(element, of, there)
        case core.If(condition, then, otherwise):
            return _either_items(element, condition, then, otherwise, there)
    if (cons := _cons(e)) is not None:
        rest = _items(element, others_of(value), cons[1], there)
        return None if rest is None else _item(element, item_of(value), cons[0], there).before(rest)
    source = _source(e, there.taken)
    whole = None if source is None else source.whole
    if whole is None or whole.kind is not Kind.LIST:
        return None
    if whole.components[0] is None or whole.components[0].resolved != element:
        return None
    low, high = (x if isinstance(x, int) else None for x in (whole.low, whole.high))
    return _Items((), low or 0, high)


def _items_of(element: Colset, e: core.Exp, there: Where) -> _Items | None:
    value = there.value_of(e)
    assert isinstance(value, Scalar | Rows), "it is a list"
    return _items(element, value, e, there)


def _item(element: Colset, value: Value, e: core.Exp, there: Where) -> _Items:
    """Of one item that is written out."""
    asked: list[t.Expression] = []
    source = _source(e, there.taken)
    if source is None or source.resolved != element:
        for part, inner, given in _components(element, value, e, e.span):
            asked += _of_part(part, inner, given, there, e.span)
    return _Items(tuple(asked), 1, 1)


def _either_items(
    element: Colset, condition: core.Exp, then: core.Exp, otherwise: core.Exp, there: Where
) -> _Items | None:
    """Of one of two lists: each is asked where it is chosen."""
    test = there.value_of(condition)
    assert isinstance(test, Scalar), "it is a truth value"
    found: list[_Items] = []
    for e, holds in ((then, True), (otherwise, False)):
        if test.exp == (FALSE if holds else TRUE):
            continue
        one = _items_of(element, e, there.under(test.exp, holds))
        if one is None:
            return None
        skipped = logical_not(test.exp) if holds else test.exp
        if one.asked and skipped != FALSE:
            asked = disjunction([skipped, conjunction(list(one.asked))])
            one = replace(one, asked=(asked,))
        found.append(one)
    highs = [x.high for x in found if x.high is not None]
    return _Items(
        tuple(condition for x in found for condition in x.asked),
        min(x.low for x in found),
        max(highs) if len(highs) == len(found) else None,
    )


def _cons(e: core.Exp) -> tuple[core.Exp, core.Exp] | None:
    """The first item and the others of `a :: l`."""
    match e:
        case core.Apply(core.Con(constructor), core.RecordExp(((_, item), (_, others)))) if (
            constructor.name == "::"
        ):
            return item, others
    return None


def _source(e: core.Exp | None, taken: Set[int]) -> Colset | None:
    """The colour set that the value of an expression is in, where its variables say so."""
    match e:
        case core.Var(symbol) if symbol.uid in taken:
            return symbol.colset
        case core.Select(label, record):
            return parts_of(_source(record, taken)).get(label)
        case core.If(_, then, otherwise):
            return _either(_source(then, taken), _source(otherwise, taken))
        case core.Apply(core.Builtin("List.tl"), of):
            return _longer(_source(of, taken), -1)
        case core.Apply(core.Builtin("List.rev"), of):
            return _source(of, taken)
        case core.Apply() if (both := _cons(e)) is not None:
            one, rest = (_source(x, taken) for x in both)
            whole = None if rest is None else rest.whole
            is_same = one is not None and whole is not None and whole.kind is Kind.LIST
            is_same = is_same and whole is not None and whole.components[0] == one
            return _longer(rest, 1) if is_same else None
        case _:
            return None


def _either(a: Colset | None, b: Colset | None) -> Colset | None:
    """The colour set of values that are in one of two, where it can be told: the same, or lists of the same items."""
    if a == b or a is None or b is None:
        return a if a == b else None
    one, other = a.whole, b.whole
    if one.kind is not Kind.LIST or one.components != other.components or one.kind != other.kind:
        return None
    low = min(x.low if isinstance(x.low, int) else 0 for x in (one, other))
    highs = [x.high for x in (one, other) if isinstance(x.high, int)]
    return replace(one, name="", low=low, high=max(highs) if len(highs) == 2 else None)


def _longer(c: Colset | None, by: int) -> Colset | None:
    """The colour set of lists that are longer by some items than those of another one."""
    whole = None if c is None else c.whole
    if whole is None or whole.kind is not Kind.LIST:
        return None
    low, high = (x + by if isinstance(x, int) else None for x in (whole.low, whole.high))
    return replace(whole, name="", low=low if low is None else max(0, low), high=high)


def _unless_known(
    c: Colset, value: Value, source: Colset | None, known: Known, span: Span
) -> Iterator[t.Expression]:
    if isinstance(value, Scalar) and c.kind is Kind.INT:
        found = known.range_of(value.exp)
        if isinstance(c.low, int) and found.low < c.low:
            yield _compared("Int.>=", value, c.low, span)
        if isinstance(c.high, int) and found.high > c.high:
            yield _compared("Int.<=", value, c.high, span)
        return
    if c.kind is Kind.STRING and isinstance(value, Scalar):
        text = value.exp
        if isinstance(text, t.Name):
            constant = known.constants.get(text.name)
            text = t.Value(constant) if isinstance(constant, str) else text
        if isinstance(text, t.Value) and _is_text_of(c, str(text.value)):
            return
    yield from (e for e in _of(c, value, source, span) if e != t.Value(True))


def _is_text_of(c: Colset, text: str) -> bool:
    low, high = c.low, c.high
    if isinstance(low, str) and any(x < low for x in text):
        return False
    if isinstance(high, str) and any(x > high for x in text):
        return False
    return c.length is None or c.length[0] <= len(text) <= c.length[1]


class _UnaskableError(Exception):
    pass


def _of(c: Colset, value: Value, source: Colset | None, span: Span) -> Iterator[t.Expression]:
    c = c.resolved
    source = None if source is None else source.resolved
    if c == source or not has_bounds(c):
        return
    if c.kind in (Kind.RECORD, Kind.PRODUCT):
        inner = parts_of(source)
        for label, part in parts_of(c).items():
            yield from _of(part, select(value, label, span), inner.get(label), span)
        return
    if c.kind is Kind.LIST and isinstance(value, Scalar | Rows):
        yield from _of_length(c, value, source, span)
        return
    if c.kind not in (Kind.INT, Kind.REAL) or not isinstance(value, Scalar):
        raise _UnaskableError(c)
    own = source if source is not None and source.kind is c.kind else None
    name = "Int" if c.kind is Kind.INT else "Real"
    # Bounds of colour sets of one kind can be compared.
    if c.low is not None and not (own and own.low is not None and own.low >= c.low):  # type: ignore[operator]
        yield _compared(f"{name}.>=", value, c.low, span)
    # Bounds of colour sets of one kind can be compared.
    if c.high is not None and not (own and own.high is not None and own.high <= c.high):  # type: ignore[operator]
        yield _compared(f"{name}.<=", value, c.high, span)


def _of_length(
    c: Colset, value: Scalar | Rows, source: Colset | None, span: Span
) -> Iterator[t.Expression]:
    """What has to be so of a list: how long it is. What its items are has to be known."""
    element = c.components[0]
    own = source if source is not None and source.kind is Kind.LIST else None
    assert element is not None
    column = value.first if isinstance(value, Rows) else value.exp
    items = lists.items_of(column)
    if has_bounds(element) and items != ():
        inner = None if own is None else own.components[0]
        if inner is None or inner.resolved != element.resolved:
            raise _UnaskableError(c)
    count = Scalar(lists.count(column), tdl.Type.INT)
    if isinstance(c.low, int) and not (own and isinstance(own.low, int) and own.low >= c.low):
        yield from _if_open("Int.>=", count, c.low, span)
    if isinstance(c.high, int) and not (own and isinstance(own.high, int) and own.high <= c.high):
        yield from _if_open("Int.<=", count, c.high, span)


def _if_open(name: str, count: Scalar, end: int, span: Span) -> Iterator[t.Expression]:
    if isinstance(count.exp, t.Value) and type(count.exp.value) is int:
        is_so = count.exp.value >= end if name == "Int.>=" else count.exp.value <= end
        yield t.Value(is_so)
    elif end > 0 or name == "Int.<=":
        yield _compared(name, count, end, span)


def _compared(name: str, value: Scalar, end: int | float | str, span: Span) -> t.Expression:
    assert not isinstance(end, str), "the ends of numbers are numbers"
    kind = tdl.Type.INT if name.startswith("Int") else tdl.Type.REAL
    limit = Scalar(t.Value(end), kind)
    found = builtin(name, Rec((("1", value), ("2", limit))), span)
    assert isinstance(found, Scalar)
    return found.exp


def parts_of(c: Colset | None) -> dict[str, Colset]:
    """The components of a record or product by label."""
    c = None if c is None else c.whole
    if c is None or c.kind not in (Kind.RECORD, Kind.PRODUCT):
        return {}
    labels = c.labels or tuple(str(i) for i in range(1, len(c.components) + 1))
    return {x: part for x, part in zip(labels, c.components, strict=True) if part is not None}


def has_bounds(c: Colset) -> bool:
    """Whether some value of its type is not in a colour set."""
    if c.kind is Kind.SUBSET or c.low is not None or c.high is not None or c.length is not None:
        return True
    return any(has_bounds(part) for part in c.components if part is not None)
