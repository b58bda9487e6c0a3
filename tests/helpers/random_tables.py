"""Random place/transition nets as tables, and what is true of them, worked out in Python from the whole graph."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass

from pn2code.contest.formulas import AtMost, Constant, Fireable, Formula, Op, Tokens, Truth
from pn2code.contest.tables import Tables

Marking = tuple[int, ...]


def random_tables(draw: random.Random) -> Tables:
    """Some tokens that move about, with weights and side conditions; as many are put as are taken, or fewer."""
    places = draw.randint(2, 5)
    pre, post = [], []
    for _ in range(draw.randint(2, 6)):
        taken: dict[int, int] = {}
        for _ in range(draw.randint(1, 3)):
            p = draw.randrange(places)
            taken[p] = taken.get(p, 0) + 1
        put: dict[int, int] = {}
        for _ in range(sum(taken.values()) - draw.choice((0, 0, 0, 1))):
            p = draw.choice([*taken, draw.randrange(places)])
            put[p] = put.get(p, 0) + 1
        pre.append(taken)
        post.append(put)
    initial = tuple(draw.choice((0, 0, 1, 2, 3)) for _ in range(places))
    return Tables(
        initial,
        tuple(pre),
        tuple(post),
        {f"p{p}": (p,) for p in range(places)},
        {f"t{t}": (t,) for t in range(len(pre))},
    )


def restless_tables(draw: random.Random) -> Tables:
    """As above, with more places, larger weights, and transitions that put more than they take."""
    places = draw.randint(2, 7)
    pre, post = [], []
    for _ in range(draw.randint(2, 7)):
        taken: dict[int, int] = {}
        for _ in range(draw.randint(1, 4)):
            p = draw.randrange(places)
            taken[p] = taken.get(p, 0) + 1
        put: dict[int, int] = {}
        for _ in range(max(0, sum(taken.values()) + draw.choice((-2, -1, 0, 0, 0, 1, 1)))):
            p = draw.randrange(places) if draw.random() < 0.6 else draw.choice([*taken])
            put[p] = put.get(p, 0) + 1
        pre.append(taken)
        post.append(put)
    return Tables(
        tuple(draw.choice((0, 0, 0, 1, 2, 3, 5)) for _ in range(places)),
        tuple(pre),
        tuple(post),
        {f"p{p}": (p,) for p in range(places)},
        {f"t{t}": (t,) for t in range(len(pre))},
    )


def sparse_tables(draw: random.Random) -> Tables:
    """Places in a row with some cross connections: much is there for the rules to do."""
    places = draw.randint(2, 7)
    pre, post = [], []
    for _ in range(draw.randint(2, 8)):
        weight = draw.choice((1, 1, 1, 1, 2))
        taken = {draw.randrange(places): weight for _ in range(draw.choice((0, 1, 1, 1, 1, 2, 2)))}
        put = {draw.randrange(places): weight for _ in range(draw.choice((0, 1, 1, 1, 2)))}
        if draw.random() < 0.2 and taken:
            put |= taken
        if sum(put.values()) > sum(taken.values()) and draw.random() < 0.8:
            put = {}
        pre.append(taken)
        post.append(put)
    initial = tuple(draw.choice((0, 0, 0, 1, 2)) for _ in range(places))
    return Tables(
        initial,
        tuple(pre),
        tuple(post),
        {f"p{p}": (p,) for p in range(places)},
        {f"t{t}": (t,) for t in range(len(pre))},
    )


def random_condition(draw: random.Random, tables: Tables, depth: int = 2) -> Formula:
    """A formula about one marking."""
    kind = draw.randrange(5 if depth else 2)
    if kind == 0:
        names = draw.sample(sorted(tables.transitions), draw.randint(1, 2))
        return Fireable(tuple(names))
    if kind == 1:
        sides = [_number(draw, tables), _number(draw, tables)]
        return AtMost(*sides)
    if kind == 2:
        return Op("not", (random_condition(draw, tables, depth - 1),))
    parts = tuple(random_condition(draw, tables, depth - 1) for _ in range(draw.randint(2, 3)))
    return Op("and" if kind == 3 else "or", parts)


def _number(draw: random.Random, tables: Tables) -> Constant | Tokens:
    if draw.random() < 0.4:
        return Constant(draw.randint(0, 3))
    names = draw.sample(sorted(tables.places), draw.randint(1, 2))
    return Tokens(tuple(names))


def random_branching(draw: random.Random, tables: Tables, depth: int = 3) -> Formula:
    """A formula of CTL."""
    kind = draw.randrange(12) if depth else 0
    if kind < 2:
        return random_condition(draw, tables, 1)
    if kind == 2:
        return Op("not", (random_branching(draw, tables, depth - 1),))
    if kind < 5:
        parts = tuple(random_branching(draw, tables, depth - 1) for _ in range(2))
        return Op("and" if kind == 3 else "or", parts)
    path = draw.choice("AE")
    operator = draw.choice("XFGU")
    parts = tuple(random_branching(draw, tables, depth - 1) for _ in range(1 + (operator == "U")))
    return Op(path, (Op(operator, parts),))


@dataclass(frozen=True)
class Graph:
    """All markings, the initial one first, with their successors by number."""

    tables: Tables
    markings: list[Marking]
    successors: list[list[int]]
    arcs: int

    @staticmethod
    def of(tables: Tables, most: int = 3000) -> Graph | None:
        """The graph; None if it is larger than that."""
        number = {tables.initial: 0}
        markings, successors, arcs = [tables.initial], [], 0
        while len(successors) < len(markings):
            marking = markings[len(successors)]
            found = []
            for t in range(len(tables.pre)):
                if not enabled(tables, marking, t):
                    continue
                after = list(marking)
                for p, n in tables.pre[t].items():
                    after[p] -= n
                for p, n in tables.post[t].items():
                    after[p] += n
                target = tuple(after)
                if target not in number:
                    number[target] = len(markings)
                    markings.append(target)
                found.append(number[target])
                arcs += 1
            successors.append(found)
            if len(markings) > most:
                return None
        return Graph(tables, markings, successors, arcs)

    @property
    def sizes(self) -> tuple[int, int, int, int]:
        """Markings, arcs, the most tokens in a place and in a marking."""
        markings = self.markings
        return len(markings), self.arcs, max(map(max, markings)), max(map(sum, markings))

    def where(self, f: Formula) -> set[int]:
        """The markings in which a formula of CTL holds. A path that ends in a dead marking is a path."""
        everywhere = set(range(len(self.markings)))
        match f:
            case Truth(value):
                return everywhere if value else set()
            case AtMost(left, right):
                return {
                    i
                    for i, m in enumerate(self.markings)
                    if self.value(left, m) <= self.value(right, m)
                }
            case Fireable(names):
                wanted = [t for name in names for t in self.tables.transitions[name]]
                return {
                    i
                    for i, m in enumerate(self.markings)
                    if any(enabled(self.tables, m, t) for t in wanted)
                }
            case Op("not", (p,)):
                return everywhere - self.where(p)
            case Op("and", parts):
                return set.intersection(*map(self.where, parts))
            case Op("or", parts):
                return set.union(*map(self.where, parts))
            case Op("E", (Op("X", (p,)),)):
                return self.before(self.where(p))
            case Op("A", (Op("X", (p,)),)):
                return everywhere - self.before(everywhere - self.where(p))
            case Op("E", (Op("F", (p,)),)):
                return self.exists_until(everywhere, self.where(p))
            case Op("A", (Op("G", (p,)),)):
                return everywhere - self.exists_until(everywhere, everywhere - self.where(p))
            case Op("A", (Op("F", (p,)),)):
                return self.always_until(everywhere, self.where(p))
            case Op("E", (Op("G", (p,)),)):
                return everywhere - self.always_until(everywhere, everywhere - self.where(p))
            case Op("E", (Op("U", (p, q)),)):
                return self.exists_until(self.where(p), self.where(q))
            case Op("A", (Op("U", (p, q)),)):
                return self.always_until(self.where(p), self.where(q))
        raise AssertionError(f)

    def value(self, number: Constant | Tokens, marking: Marking) -> int:
        """A number in a marking."""
        if isinstance(number, Constant):
            return number.value
        return sum(marking[p] for name in number.places for p in self.tables.places[name])

    def next(self, i: int) -> list[int]:
        """What follows a marking on a path: a dead one follows itself."""
        return self.successors[i] or [i]

    def before(self, of: set[int]) -> set[int]:
        """The markings with a successor in a set."""
        return {i for i, found in enumerate(self.successors) if not of.isdisjoint(found)}

    def exists_until(self, p: set[int], q: set[int]) -> set[int]:
        """The least set with q, and with p where a successor is in it."""
        return _least(q, lambda known: p & self.before(known))

    def always_until(self, p: set[int], q: set[int]) -> set[int]:
        """The least set with q, and with p where there are successors and all of them are in it."""
        return _least(
            q,
            lambda known: {
                i for i in p if self.successors[i] and known.issuperset(self.successors[i])
            },
        )

    def lasts(self, allowed: set[int], somewhere: set[int]) -> bool:
        """Whether a run from the initial marking stays in `allowed` from some time on, and is often in `somewhere`."""
        for i in allowed & somewhere:
            if not self.successors[i]:
                return True  # it stays there
            later = {j for j in self.successors[i] if j in allowed}
            while True:
                more = later | {k for j in later for k in self.successors[j] if k in allowed}
                if more == later:
                    break
                later = more
            if i in later:
                return True
        return False


def enabled(tables: Tables, marking: Marking, t: int) -> bool:
    """Whether the tokens are there."""
    return all(marking[p] >= n for p, n in tables.pre[t].items())


def _least(start: set[int], more: Callable[[set[int]], set[int]]) -> set[int]:
    known = set(start)
    while not (found := more(known)) <= known:
        known |= found
    return known
