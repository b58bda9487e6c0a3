"""A proof that no reachable marking satisfies a condition, which needs no solver to be checked.

    proof = equation.proof(condition, until)         # found with linear programs (equation.py)
    is_proof(proof, condition, tables)               # True: it is one, in integers

It is a tree. At a `Leaf` some comparisons that hold there contradict each other: with factors f they add up to
f * a * m <= f * b; a weight w of the places is at most f * a everywhere, so that w * m <= f * b; no transition lowers
w * m, and in the beginning it is more than f * b. A marked trap holds a token for ever: that is one more comparison.
A `Split` looks at the two cases of a comparison of integers, and a `Choice` at the parts of an `or`.

The number of steps of a transition is a place as well, which only it fills; these have the numbers after those of the
net.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.contest import certificates
from pn2code.contest.conditions import AtMost, Condition, Dead, Junction, junction
from pn2code.contest.tables import Tables


@frozen
class Leaf:
    """Comparisons that no reachable marking satisfies.

    Args:
        rows: comparisons of the condition, and of cases, that are used.
        traps: sets of places that hold a token for ever.
        factors: of the rows, then of the traps.
        weight: by place, what no transition lowers.
    """

    rows: tuple[AtMost, ...]
    traps: tuple[tuple[int, ...], ...]
    factors: tuple[int, ...]
    weight: Mapping[int, int]

    def all_rows(self) -> tuple[AtMost, ...]:
        """The comparisons, those of traps included."""
        return (*self.rows, *map(of_trap, self.traps))

    @property
    def limit(self) -> int:
        """What the weight would be at most."""
        return sum(f * r.limit for f, r in zip(self.factors, self.all_rows(), strict=True))


@frozen
class Choice:
    """One of the parts of an `or` holds: a proof for each."""

    of: Junction
    parts: tuple[Proof, ...]


@frozen
class Split:
    """A comparison holds, or its opposite."""

    row: AtMost
    holds: Proof
    fails: Proof


Proof = Leaf | Choice | Split


def of_trap(places: Sequence[int]) -> AtMost:
    """That one of the places holds a token."""
    return AtMost(tuple((p, -1) for p in sorted(places)), -1)


def leaves(proof: Proof) -> Iterator[Leaf]:
    """All of a proof."""
    match proof:
        case Leaf():
            yield proof
        case Choice(_, parts):
            for part in parts:
                yield from leaves(part)
        case Split(_, holds, fails):
            yield from leaves(holds)
            yield from leaves(fails)


def spread(condition: Condition, tables: Tables) -> tuple[list[AtMost], list[Junction]]:
    """The comparisons that a condition consists of, and the `or`s of which a part must hold."""
    if isinstance(condition, Dead):
        condition = dead(tables)
    rows: list[AtMost] = []
    choices: list[Junction] = []
    todo = [condition]
    while todo:
        match todo.pop():
            case AtMost() as row:
                rows.append(row)
            case Junction(True, parts):
                todo.extend(parts)
            case Junction(False) as choice:
                choices.append(choice)
    return rows, choices


def dead(tables: Tables) -> Condition:
    """No transition is enabled, as comparisons."""
    return junction(
        True,
        [junction(False, [AtMost(((p, 1),), n - 1) for p, n in pre.items()]) for pre in tables.pre],
    )


def is_proof(proof: Proof, condition: Condition, tables: Tables) -> bool:
    """Whether it proves that no reachable marking satisfies the condition."""
    return _Checker(tables).is_so(proof, frozenset(), frozenset(), condition)


class _Checker:
    def __init__(self, tables: Tables) -> None:
        self.tables = tables
        places = len(tables.initial)
        self.effects = []
        for t, (pre, post) in enumerate(zip(tables.pre, tables.post, strict=True)):
            effect = {p: post.get(p, 0) - pre.get(p, 0) for p in pre.keys() | post.keys()}
            self.effects.append({**effect, places + t: 1})
        self.initial = (*tables.initial, *([0] * len(tables.pre)))

    def is_so(
        self,
        proof: Proof,
        rows: frozenset[AtMost],
        choices: frozenset[Junction],
        more: Condition,
    ) -> bool:
        """Whether what is known, and `more`, cannot be."""
        new_rows, new_choices = spread(more, self.tables)
        rows, choices = rows.union(new_rows), choices.union(new_choices)
        match proof:
            case Leaf():
                return self._is_leaf(proof, rows)
            case Choice(of, parts):
                return (
                    of in choices
                    and len(of.parts) == len(parts)
                    and all(
                        self.is_so(p, rows, choices - {of}, c)
                        for p, c in zip(parts, of.parts, strict=True)
                    )
                )
            case Split(row, holds, fails):
                return self.is_so(holds, rows, choices, row) and self.is_so(
                    fails, rows, choices, row.opposite()
                )

    def _is_leaf(self, leaf: Leaf, rows: frozenset[AtMost]) -> bool:
        if not rows.issuperset(leaf.rows) or not all(map(self._is_trap, leaf.traps)):
            return False
        all_rows = leaf.all_rows()
        return len(all_rows) == len(leaf.factors) and certificates.is_refuted(
            all_rows, leaf.factors, leaf.weight, self.initial, self.effects
        )

    def _is_trap(self, places: Sequence[int]) -> bool:
        """Whether they hold a token in the beginning, and what takes from them puts into them."""
        inside = frozenset(places)
        if not all(0 <= p < len(self.tables.initial) for p in inside):
            return False
        if not any(self.tables.initial[p] for p in inside):
            return False
        return all(
            inside & {p for p, n in post.items() if n}
            for pre, post in zip(self.tables.pre, self.tables.post, strict=True)
            if inside & pre.keys()
        )
