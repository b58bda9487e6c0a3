"""Proofs that a condition is not reachable: right ones of random nets, and wrong ones that are refused."""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import replace
from random import Random

import pytest

from pn2code.contest.conditions import AtMost, Condition, Dead, Junction, holds
from pn2code.contest.equation import StateEquation
from pn2code.contest.proofs import Choice, Leaf, Split, dead, is_proof, leaves
from pn2code.contest.tables import Tables

MOST = 400


def reachable(t: Tables) -> set[tuple[int, ...]] | None:
    """All markings; None: there are many."""
    seen, todo = {t.initial}, [t.initial]
    while todo:
        marking = todo.pop()
        for pre, post in zip(t.pre, t.post, strict=True):
            if any(marking[p] < n for p, n in pre.items()):
                continue
            after = list(marking)
            for p, n in pre.items():
                after[p] -= n
            for p, n in post.items():
                after[p] += n
            if tuple(after) not in seen:
                seen.add(tuple(after))
                todo.append(tuple(after))
        if len(seen) > MOST:
            return None
    return seen


def net(r: Random) -> Tables:
    """A net of few places, in which most transitions put as many tokens as they take."""
    places, transitions = r.randint(3, 5), r.randint(2, 5)

    def arcs(count: int) -> dict[int, int]:
        return {r.randrange(places): r.choice((1, 1, 2)) for _ in range(count)}

    sizes = [r.randint(1, 2) for _ in range(transitions)]
    initial = tuple(r.choice((0, 0, 1, 2)) for _ in range(places))
    return Tables(initial, tuple(map(arcs, sizes)), tuple(map(arcs, sizes)), {}, {})


def condition(r: Random, places: int) -> Condition:
    def row() -> AtMost:
        of = {r.randrange(places): r.choice((1, 1, 2, -1)) for _ in range(r.randint(1, 3))}
        return AtMost(tuple(sorted(of.items())), r.randint(-3, 2))

    match r.randrange(4):
        case 0:
            return Dead()
        case 1:
            return row()
        case _:
            return Junction(True, (row(), Junction(False, (row(), row()))))


def test_what_is_proved_is_not_reachable() -> None:
    seen: Counter[str] = Counter()
    for seed in range(30):
        r = Random(seed)
        t = net(r)
        markings = reachable(t)
        for _ in range(6 if markings is not None else 0):
            c = condition(r, len(t.initial))
            proof = StateEquation(t).proof(c, time.monotonic() + 60.0)
            plain = dead(t) if isinstance(c, Dead) else c
            is_reached = any(holds(plain, m) for m in markings or ())
            seen["reached"] += is_reached
            if proof is None:
                continue
            assert is_proof(proof, c, t) and not is_reached, (seed, c)
            seen[type(proof).__name__] += 1
            seen["traps"] += any(leaf.traps for leaf in leaves(proof))
    assert seen["Leaf"] > 20 and seen["reached"] > 10, seen


RING = Tables(
    (1, 0, 0), ({0: 1}, {1: 1}, {2: 1}), ({1: 1}, {2: 1}, {0: 1}), {}, {}
)  # fmt: skip
TWO = AtMost(((0, -1), (1, -1)), -2)
"""Two tokens in the first two places of a ring with one."""


def test_a_leaf_that_is_changed_is_refused() -> None:
    leaf = StateEquation(RING).proof(TWO, time.monotonic() + 60.0)
    assert isinstance(leaf, Leaf) and is_proof(leaf, TWO, RING)
    other = AtMost(((0, -1), (1, -1)), -1)
    wrong = (
        replace(leaf, weight={p: w - 1 for p, w in leaf.weight.items()}),
        replace(leaf, weight={**leaf.weight, 2: leaf.weight.get(2, 0) + 1}),
        replace(leaf, factors=tuple(-f for f in leaf.factors)),
        replace(leaf, factors=()),
        replace(leaf, rows=(other,)),
        replace(leaf, traps=((1,),), factors=(*leaf.factors, 1)),
    )
    assert not any(is_proof(x, TWO, RING) for x in wrong)
    assert not is_proof(leaf, other, RING), "it proves another condition"


def test_all_cases_are_needed() -> None:
    """Of an `or` each part is refuted by itself, of integers both sides."""
    either = Junction(False, (TWO, AtMost(((2, -1),), -2)))
    proof = StateEquation(RING).proof(either, time.monotonic() + 60.0)
    assert isinstance(proof, Choice) and is_proof(proof, either, RING)
    assert not is_proof(replace(proof, parts=proof.parts[:1]), either, RING)
    assert not is_proof(replace(proof, parts=proof.parts[::-1]), either, RING)
    assert not is_proof(proof, Junction(False, (*either.parts, AtMost(((0, -1),), -1))), RING)
    leaf = StateEquation(RING).proof(TWO, time.monotonic() + 60.0)
    assert isinstance(leaf, Leaf)
    row = AtMost(((2, 1),), 0)
    assert is_proof(Split(row, leaf, leaf), TWO, RING)
    none = replace(leaf, rows=(AtMost(((2, 1),), -1),))
    assert not is_proof(Split(row, leaf, none), TWO, RING)


@pytest.mark.parametrize(("trap", "is_one"), [((0, 1, 2), True), ((0, 1), False), ((1, 2), False)])
def test_traps_are_looked_at_again(trap: tuple[int, ...], *, is_one: bool) -> None:
    """Marked at first, and whatever takes from it puts into it."""
    empty = AtMost(tuple((p, 1) for p in trap), 0)
    leaf = Leaf((empty,), (trap,), (1, 1), {})
    assert is_proof(leaf, empty, RING) is is_one
