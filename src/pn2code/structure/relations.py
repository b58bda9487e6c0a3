"""Relations between numbers of tokens and the numbers that tokens carry, and what follows for pairs of transitions.

    found = relations(net)
    found.exclude(3, 7)      # transitions 3 and 7 are never both enabled

A place that holds one token at most, `Left : INT`, is a counter: what transitions put instead of the token that they
take changes its *value* by a number (`n` becomes `n - 1`). So values can be in an invariant beside numbers of tokens:

    Feeder + Feeding + ... + Stowing - value of Left = 0

In the matrix a value is a row like those of places (`skeleton.counts`), with the same columns: one for each transition,
and further ones for what changes it by an amount that is not known. It may have a negative weight, numbers of tokens
may not.

Where two transitions are both enabled, each place holds what either of them demands (the greater number, if both demand
some), and a value is the constant that one of them demands. If the weighted sum of these is greater than it ever is,
although other places hold no tokens, that never is the case. In the example `End` demands the value 0 of `Left`,
`Stowed` a token of `Stowing`: 1 - 0 > 0. The same is true if they demand different constants of a place with one token.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.ml.core import terms as core
from pn2code.ml.core.reals import may_hold_reals
from pn2code.ml.core.types import INT
from pn2code.net.flat import FlatNet
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet
from pn2code.structure import flows
from pn2code.structure.analysis import start_of, without_resets
from pn2code.structure.bounds import constant_of, place_bounds
from pn2code.structure.skeleton import TOKEN, Counter, Flow, Mode, Skeleton, counted, skeleton
from pn2code.structure.sums import Part, Sum, add, scaled
from pn2code.structure.symbolic import Symbolic

MOST_RELATIONS = 2_000


@frozen
class Relation:
    """`sum of weight * number of tokens + sum of weight * value = total`, in every reachable marking.

    Args:
        tokens: place -> weight, all positive.
        values: place -> weight of the sum of the numbers that its tokens are.
        total: what it is.
    """

    tokens: Mapping[int, int]
    values: Mapping[int, int]
    total: int


class Relations:
    """What is known of a net.

    Args:
        found: the relations.
        single: places that hold at most one token.
        least: of each transition, place -> tokens without which it is disabled.
        constant: of each transition, place of `single` -> the constant that its token has to be.
        growing: of each transition, places of which it may increase the number of tokens.
        kept: of each transition, places to which it puts just what it takes there.
    """

    def __init__(
        self,
        found: Sequence[Relation],
        single: frozenset[int],
        least: Sequence[Mapping[int, int]],
        constant: Sequence[Mapping[int, core.Exp]],
        growing: Sequence[frozenset[int]],
        kept: Sequence[frozenset[int]],
    ) -> None:
        self.found = found
        self.single = single
        self.least = least
        self.constant = constant
        self.growing = growing
        self.kept = kept
        at: dict[int, set[int]] = {}
        for k, relation in enumerate(found):
            for p in relation.tokens:
                at.setdefault(p, set()).add(k)
        self._of = [frozenset(k for p in own for k in at.get(p, ())) for own in least]
        self._with = [
            frozenset(k for k, r in enumerate(found) if any(p in r.values for p in own))
            for own in constant
        ]

    def exclude(self, one: int, other: int) -> bool:
        """Whether it is proven that two transitions are never both enabled."""
        mine, its = self.constant[one], self.constant[other]
        if any(p in its and its[p] != value for p, value in mine.items()):
            return True
        either = (self._of[one] | self._with[one]) & (self._of[other] | self._with[other])
        return any(self._is_broken(self.found[k], one, other) for k in either)

    def _is_broken(self, relation: Relation, one: int, other: int) -> bool:
        mine, its = self.least[one], self.least[other]
        total = sum(w * max(mine.get(p, 0), its.get(p, 0)) for p, w in relation.tokens.items())
        for p, weight in relation.values.items():
            value = self.constant[one].get(p) or self.constant[other].get(p)
            if not isinstance(value, core.Lit) or not isinstance(value.value, int):
                return False
            total += weight * value.value
        return total > relation.total


def relations(net: FlatNet, storage: Mapping[str, str] | None = None) -> Relations:
    """Of a net with its own initial marking."""
    begin = start_of(net, storage or {}, ())
    symbolic = Symbolic(net, begin.evaluator)
    skel = skeleton(net, symbolic)
    plain = flows.semiflows(without_resets(skel)).vectors
    bounds = place_bounds(skel, begin.initial, plain, (), programs=0)
    single = frozenset(p for p, b in bounds.items() if b.bound is not None and b.bound <= 1)
    constant = tuple(_constants(net, flow, single) for flow in skel.flows)
    kept = tuple(_kept(net, t, flow, skel) for t, flow in enumerate(skel.flows))
    counters = sorted(
        {
            p
            for own in constant
            for p in own
            if net.places[p].colset.type == INT and begin.marking[p] is not None
        }
    )
    found = _plain(plain, begin.initial)
    if counters:
        found += _valued(skel, Counter(symbolic), counters, begin.initial, begin.marking)
    by_transition: list[list[Mode]] = [[] for _ in net.transitions]
    for mode in skel.modes:
        by_transition[mode.transition].append(mode)
    return Relations(
        found[:MOST_RELATIONS],
        single,
        tuple(map(_least, by_transition)),
        constant,
        tuple(_growing(modes, skel) for modes in by_transition),
        kept,
    )


# --- of a transition -------------------------------------------------------------------------------


def _least(modes: Sequence[Mode]) -> dict[int, int]:
    places = set.intersection(*(set(m.take) for m in modes)) if modes else set()
    found = {p: min(m.take[p].low for m in modes) for p in places}
    return {p: n for p, n in found.items() if n > 0}


def _growing(modes: Sequence[Mode], skel: Skeleton) -> frozenset[int]:
    """A place that is cleared holds fewer tokens than the change says."""
    return frozenset(
        p
        for m in modes
        for p in m.put
        if p in m.unknown or m.delta.get(p, 0) > 0 or m.transition in skel.resets.get(p, ())
    )


def _kept(net: FlatNet, t: int, flow: Flow, skel: Skeleton) -> frozenset[int]:
    """Equal expressions give equal tokens, but for the sign of a zero."""
    return frozenset(
        p
        for p, taken in flow.take.items()
        if taken == flow.put.get(p)
        and not may_hold_reals(net.places[p].colset.type, net.program.datatypes)
        and t not in skel.resets.get(p, ())
    )


def _constants(net: FlatNet, flow: Flow, single: frozenset[int]) -> dict[int, core.Exp]:
    found: dict[int, core.Exp] = {}
    for p, taken in flow.take.items():
        is_signed = may_hold_reals(net.places[p].colset.type, net.program.datatypes)
        if p in single and len(taken) == 1 and not is_signed:
            ((part, n),) = taken.items()
            value = part.atom.value
            is_one = n == 1 and not (part.conditions or part.whole or part.steps)
            if is_one and isinstance(value, core.Lit | core.Con):
                found[p] = value
    return found


# --- invariants --------------------------------------------------------------------------------------


def _plain(vectors: Sequence[flows.Vector], initial: Sequence[int | None]) -> list[Relation]:
    totals = ((v, constant_of(v, initial)) for v in vectors)
    return [Relation(v, {}, n) for v, n in totals if n is not None and min(v.values()) > 0]


@frozen
class _Column:
    """A change of a value that is not a known number: of an expression, or of a multi-set.

    Args:
        what: which; None: it is like no other.
        part: what it belongs to.
    """

    what: core.Exp | None
    part: Part | int


def _valued(
    skel: Skeleton,
    counter: Counter,
    counters: Sequence[int],
    initial: Sequence[int | None],
    marking: Sequence[MultiSet | TimedMultiSet | None],
) -> list[Relation]:
    """Those in which a value of a counter is. Each has two rows, of which one is negative: its weight has any sign."""
    places = len(initial)
    rows: list[dict[int, int]] = [{} for _ in range(places + 2 * len(counters))]
    count = 0
    for t, flow in enumerate(skel.flows):
        own: dict[Part | _Column, int] = {}
        changes = {
            p: add(flow.put.get(p, {}), scaled(flow.take.get(p, {}), -1))
            for p in sorted({*flow.take, *flow.put})
        }
        entries: list[tuple[int, Mapping[Any, int], int]] = [
            (p, counted(change, counter), 1) for p, change in changes.items()
        ]
        for k, p in enumerate(counters):
            is_cleared = t in skel.resets.get(p, ())
            value = {_Column(None, p): 1} if is_cleared else _value(changes.get(p, {}))
            entries += [(places + 2 * k, value, 1), (places + 2 * k + 1, value, -1)]
        for row, change, sign in entries:
            for key, n in change.items():
                column = own.setdefault(key, count + len(own))
                rows[row][column] = rows[row].get(column, 0) + sign * n
        count += len(own)
    for p in skel.resets:
        rows[p][-1 - p] = 1
    found = []
    for vector in flows.semiflows(rows).vectors:
        tokens = {p: w for p, w in vector.items() if p < places}
        weights = (
            vector.get(places + 2 * k, 0) - vector.get(places + 2 * k + 1, 0)
            for k in range(len(counters))
        )
        values = {p: w for p, w in zip(counters, weights, strict=True) if w}
        total = constant_of(tokens, initial)
        if values and total is not None:
            total += sum(w * sum(_numbers(marking[p])) for p, w in values.items())
            found.append(Relation(tokens, values, total))
    return found


def _numbers(held: MultiSet | TimedMultiSet | None) -> Iterator[int]:
    assert isinstance(held, MultiSet)
    for value in held:
        assert isinstance(value, int)
        yield value


def _value(parts: Sum) -> dict[Part | _Column, int]:
    """The sum of the numbers that tokens are: as many as a number says, and multiples of what is not known."""
    found: dict[Part | _Column, int] = {}

    def more(key: Part | _Column, n: int) -> None:
        found[key] = found.get(key, 0) + n

    for part, n in parts.items():
        if part.whole or part.steps or part.atom.serial:
            more(_Column(None, part), n)
            continue
        todo: list[tuple[core.Exp, int]] = [(part.atom.value, n)]
        while todo:
            e, weight = todo.pop()
            match e:
                case core.Lit(value) if isinstance(value, int):
                    more(Part(part.conditions, TOKEN, False), weight * value)
                case core.Apply(core.Builtin("Int.+" | "Int.-" as name), core.RecordExp(fields)):
                    sides = dict(fields)
                    todo.append((sides["1"], weight))
                    todo.append((sides["2"], weight if name == "Int.+" else -weight))
                case _:
                    more(_Column(e, Part(part.conditions, TOKEN, False)), weight)
    return {key: n for key, n in found.items() if n}
