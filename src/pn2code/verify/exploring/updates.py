"""What a transition does with the token of a place that holds at most one: which such uses commute.

    uses = access(t, place)      # None: nothing is known
    uses["count"]                # Access(How.GROWS)
    commute(uses, other)         # whether two transitions may do these in either order

A transition that takes the token `n` and puts `n + 1` instead does with it what adding does, if nothing else in the
transition depends on `n`. Then it is enabled whatever the token is, and two of this kind give the same token in
either order. They occur with another `n` after one another, which changes nothing else: a binding stands for all
that differ in such variables. Tokens that are tuples or records are looked at component by component.

| | the component of the token |
|---|---|
| `IDLE` | is put back, and nothing depends on it |
| `READS` | is put back, and something in the transition may depend on it |
| `GROWS`, `SHRINKS` | has a constant added, subtracted |
| `ADDS` | has any amount added or subtracted that does not depend on it, and no number is out of range |
| `RAISES`, `LOWERS` | becomes the greater, the smaller one of itself and an amount that does not depend on it |
| `SETS` | becomes a constant, whatever it was |
| `CHANGES` | anything else |

Why these commute: two that read change nothing; a component that is idle in one of two transitions is seen and changed
by the other one only; addition, maximum and minimum are associative and commutative; a constant that is set twice
is set.

*Exceptions*: `n + 1` may raise one (an overflow, or a number that the colour set does not have), and what raises one
must be found in the reduced space, too. Two that both add, or both subtract, may be exchanged: what raises an exception
now raises one after the other has occurred as well, since the number is farther out of range then, and the other way
round one of the two raises one at the latest where the sum is out of range. Of one that adds and one that subtracts the
second may keep the first from raising an exception: these commute only where no number is out of range, in
`intinf` without bounds. So only a single addition of a constant counts, and not `n + 1 - 1`, which may raise an
exception although its sum is in range. Maximum, minimum and constants raise one because of their amount, whatever the
token is. This is so in ranges of numbers; of sums, maxima and minima in subsets nothing is said. And a variable takes
any token of the place: its colour set is that of the place.

Sums of reals depend on their order, and equal reals may differ in the sign of a zero, so nothing is said of them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from enum import Enum

from pn2code.base.frozen import frozen
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.reals import may_hold_reals
from pn2code.net.flat import (
    ArcKind,
    BindAll,
    BindEquation,
    BindRandom,
    FlatArc,
    FlatNet,
    FlatTransition,
)
from pn2code.net.put_token import token_put
from pn2code.net.uses import pattern_variables, walk


class How(Enum):
    """What becomes of a component."""

    IDLE = "idle"
    READS = "reads"
    GROWS = "grows"
    SHRINKS = "shrinks"
    ADDS = "adds"
    RAISES = "raises"
    LOWERS = "lowers"
    SETS = "sets"
    CHANGES = "changes"


_SAME = frozenset({How.READS, How.GROWS, How.SHRINKS, How.ADDS, How.RAISES, How.LOWERS, How.SETS})
"""Two transitions that do the same commute."""
_BLIND = frozenset(How) - {How.READS, How.CHANGES}
"""A transition that does one of these takes any token."""
_AMOUNT = {
    "Int.+": How.ADDS,
    "Int.-": How.ADDS,
    "IntInf.+": How.ADDS,
    "IntInf.-": How.ADDS,
    "Int.max": How.RAISES,
    "Int.min": How.LOWERS,
}
_EITHER_SIDE = frozenset({"Int.+", "IntInf.+", "Int.max", "Int.min"})


@frozen
class Access:
    """What is done with a component; `value` is the constant of `SETS`."""

    how: How
    value: core.Exp | None = None


Accesses = Mapping[str, Access]
"""By label of the component; "" is the whole token."""


def commute(one: Accesses, other: Accesses) -> bool:
    """Whether two transitions may occur in either order, as far as this place goes."""
    return all(_commute(a, b) for a, b in _pairs(one, other))


def is_moved_by(one: Accesses, other: Accesses) -> bool:
    """Whether what the other does to the token may decide whether the one is enabled."""
    return any(
        a.how not in _BLIND and b.how not in (How.IDLE, How.READS) for a, b in _pairs(one, other)
    )


def _pairs(one: Accesses, other: Accesses) -> Iterator[tuple[Access, Access]]:
    for label in {*one, *other}:
        yield _part(one, label), _part(other, label)


def _part(uses: Accesses, label: str) -> Access:
    """What is done with a component, or with the whole token, of a token that may have been looked at the other way."""
    if label in uses:
        return uses[label]
    if label:
        whole = uses[""] if "" in uses else Access(How.CHANGES)
        return whole if whole.how in (How.IDLE, How.READS) else Access(How.CHANGES)
    kinds = {a.how for a in uses.values()}
    for how in (How.IDLE, How.READS):
        if kinds <= {How.IDLE, how}:
            return Access(how)
    return Access(How.CHANGES)


def _commute(a: Access, b: Access) -> bool:
    if How.IDLE in (a.how, b.how):
        return True
    return a.how is b.how and a.how in _SAME and a.value == b.value


def accesses(net: FlatNet, t: FlatTransition, place: int) -> Accesses | None:
    """What a transition does with the only token of a place; None: it does not just replace or test it."""
    colset = net.places[place].colset
    arcs = {a.kind: a for a in t.arcs if a.place == place}
    count = sum(a.place == place for a in t.arcs)
    is_signed = may_hold_reals(colset.type, net.program.datatypes)
    if is_signed or colset.timed or count != len(arcs):
        return None
    match arcs:
        case {ArcKind.BOTH: FlatArc() as tested} if count == 1:
            return _looked_at(net, t, tested, None, colset)
        case {ArcKind.INPUT: FlatArc() as taken, ArcKind.OUTPUT: FlatArc() as put} if count == 2:
            return _looked_at(net, t, taken, put, colset)
    return None


def _looked_at(
    net: FlatNet, t: FlatTransition, taken: FlatArc, put: FlatArc | None, colset: Colset
) -> Accesses | None:
    assert taken.inscription is not None
    terms = taken.inscription.terms
    if (
        len(terms) != 1
        or terms[0].whole
        or terms[0].delay is not None
        or not _is_one(terms[0].coefficient)
    ):
        return None
    value = terms[0].value if put is None else token_put(put)
    if value is None:
        return None
    uses = _Uses(t)
    parts = _parts(terms[0].pattern, value, colset)
    if parts is None:  # a token that is only tested, or replaced
        is_kept = put is None or (terms[0].value == value and _is_constant(value))
        return {"": Access(How.READS if is_kept else How.CHANGES)}
    found: dict[str, Access] = {}
    for label, (variable, demanded, becomes, among) in parts.items():
        if variable is None:
            is_kept = put is None or demanded == becomes
            found[label] = Access(How.READS if is_kept else How.CHANGES)
            continue
        inside = 1 if put is None else 1 + uses.of(becomes).count(variable)
        is_own = (
            uses.everywhere[variable] == inside
            and variable not in uses.bound
            and variable.colset is not None
            and variable.colset.resolved == among.resolved
        )
        found[label] = _becomes(variable, becomes, uses, is_own=is_own)
    return found


def _becomes(variable: core.Symbol, value: core.Exp, uses: _Uses, *, is_own: bool) -> Access:
    """What becomes of a variable's value; `is_own`: nothing else depends on it."""
    if isinstance(value, core.Var) and value.symbol == variable:
        return Access(How.IDLE if is_own else How.READS)
    if not is_own:
        return Access(How.CHANGES)
    if isinstance(value, core.Lit | core.Con):
        return Access(How.SETS, value)
    match value:
        case core.Apply(core.Builtin(name), core.RecordExp((("1", left), ("2", right)))) if (
            name in _AMOUNT
        ):
            if _is(left, variable) and variable not in uses.of(right):
                return Access(_changed(name, right, variable))
            if name in _EITHER_SIDE and _is(right, variable) and variable not in uses.of(left):
                return Access(_changed(name, left, variable))
    return Access(How.CHANGES)


def _changed(name: str, amount: core.Exp, variable: core.Symbol) -> How:
    """What a function with this amount does to a variable's value."""
    how = _AMOUNT[name]
    among = variable.colset.resolved if variable.colset is not None else None
    if among is None or among.kind not in (Kind.INT, Kind.INTINF):
        return How.CHANGES  # of a subset: what is legal need not be all numbers of a range
    if how is not How.ADDS:
        return how
    if among.kind is Kind.INTINF and among.low is None and among.high is None:
        return how
    if not isinstance(amount, core.Lit) or not isinstance(amount.value, int):
        return How.CHANGES
    is_more = (amount.value >= 0) == name.endswith("+")
    return How.GROWS if is_more else How.SHRINKS


def _is(e: core.Exp, variable: core.Symbol) -> bool:
    return isinstance(e, core.Var) and e.symbol == variable


_Part = tuple[core.Symbol | None, core.Exp | None, core.Exp, Colset]


def _parts(pattern: core.Pat | None, value: core.Exp, colset: Colset) -> dict[str, _Part] | None:
    """Label -> the variable that the component is bound to, and what it becomes; None: neither is known."""
    base = colset.resolved
    match pattern, value:
        case core.PVar(symbol), _:
            return {"": (symbol, None, value, colset)}
        case core.PRecord(fields), core.RecordExp(made) if base.kind in (Kind.PRODUCT, Kind.RECORD):
            becomes = dict(made)
            found: dict[str, _Part] = {}
            for label, p in fields:
                k = base.labels.index(label) if base.kind is Kind.RECORD else int(label) - 1
                among = base.components[k]
                if among is None:
                    return None
                if isinstance(p, core.PVar):
                    found[label] = (p.symbol, None, becomes[label], among)
                else:
                    found[label] = (None, _constant(p), becomes[label], among)
            return found
    return None


def _constant(p: core.Pat) -> core.Exp | None:
    match p:
        case core.PLit(value, kind, span):
            return core.Lit(value, kind, span)
        case core.PCon(constructor, None, kind, span):
            return core.Con(constructor, kind, span)
    return None


def _is_constant(e: core.Exp) -> bool:
    return all(isinstance(x, core.Lit | core.Con | core.RecordExp) for x in walk(e))


def _is_one(e: core.Exp) -> bool:
    return isinstance(e, core.Lit) and e.value == 1


class _Uses:
    """How often each variable occurs in a transition.

    Args:
        everywhere: in its inscriptions, guards, code segment and delay.
        bound: variables that get their values in other ways than from a token.
    """

    def __init__(self, t: FlatTransition) -> None:
        texts = [*t.guards, t.delay, *(a.inscription.value for a in t.arcs if a.inscription)]
        self.everywhere: Counter[core.Symbol] = Counter()
        self.bound: set[core.Symbol] = set()
        if t.code is not None:
            texts.append(t.code.action)
            self.everywhere.update((*t.code.inputs, *t.code.outputs))
        for e in texts:
            self.everywhere.update(self.of(e))
        for step in t.plan:
            if isinstance(step, BindAll | BindRandom):
                self.bound.add(step.symbol)
            elif isinstance(step, BindEquation):
                self.bound.update(pattern_variables(step.pattern))

    @staticmethod
    def of(e: core.Exp | None) -> list[core.Symbol]:
        """Those in an expression, as often as they occur."""
        return [] if e is None else [x.symbol for x in walk(e) if isinstance(x, core.Var)]
