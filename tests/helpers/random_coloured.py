"""Random symmetric nets: all kinds of sorts and operators, together as no family of the contest has them."""

from __future__ import annotations

import random

from helpers.coloured_nets import (
    DOT,
    ColouredNet,
    Enum,
    Partition,
    Product,
    Range,
    Term,
    add,
    all_,
    eq,
    less,
    ne,
    pred,
    succ,
    times,
    tup,
)

SORTS: dict[str, Enum | Range | Product | Partition] = {
    "C": Enum(("c0", "c1", "c2")),
    "D": Enum(("d0", "d1"), cyclic=False),
    "N": Range(2, 4),
    "L": Range(1, 2),
    "K": Partition("C", {"low": ("c0",), "high": ("c1", "c2")}),
    "CD": Product(("C", "D")),
    "NC": Product(("N", "C")),
    "CC": Product(("C", "C")),
    "DKD": Product(("D", "K", "D")),
    "LN": Product(("L", "N")),
}
SIMPLE = ("C", "D", "N", "K", "L")
VARIABLES = {"x": "C", "y": "C", "d": "D", "e": "D", "n": "N", "m": "N", "k": "K", "l": "L"}


def random_coloured(draw: random.Random) -> ColouredNet:
    """A net with few tokens, in which about as many are put as are taken."""
    return _Made(draw).net()


class _Made:
    def __init__(self, draw: random.Random) -> None:
        self.draw = draw
        self.places = {f"p{i}": draw.choice((DOT, *SORTS)) for i in range(draw.randint(2, 4))}

    def net(self) -> ColouredNet:
        """The net."""
        initial = {p: (sort, self.marking(sort)) for p, sort in self.places.items()}
        transitions = [self.transition(f"t{i}") for i in range(self.draw.randint(2, 4))]
        return ColouredNet(SORTS, VARIABLES, initial, transitions)

    def marking(self, sort: str) -> Term:
        kind = self.draw.randrange(4)
        if kind == 0:
            return None
        if kind == 1 and sort in ("D", "K", DOT):
            return (
                times(self.draw.randint(1, 2), self.constant(sort)) if sort == DOT else all_(sort)
            )
        if kind == 2:
            return add(self.constant(sort), times(2, self.constant(sort)))
        return times(1, self.constant(sort))

    def transition(self, name: str) -> tuple[str, Term, dict[str, Term], dict[str, Term]]:
        names = list(self.places)
        takes = {
            p: self.many(self.places[p])
            for p in self.draw.sample(names, self.draw.choice((1, 1, 2)))
        }
        puts = {
            p: self.many(self.places[p])
            for p in self.draw.sample(names, self.draw.choice((0, 1, 1, 2)))
        }
        guard = self.guard(2) if self.draw.random() < 0.5 else None
        return name, guard, takes, puts

    def many(self, sort: str) -> Term:
        """A multi-set, mostly of one token."""
        kind = self.draw.randrange(12)
        if kind == 0 and sort not in ("NC", "CC", "CD", "DKD", "LN"):
            return all_(sort)
        if kind == 1:
            return times(2, self.one(sort))
        if kind == 2:
            return add(self.one(sort), self.one(sort))
        if kind == 3 and sort in SIMPLE:
            return less(all_(sort), self.one(sort))
        found = SORTS.get(sort)
        if kind == 4 and isinstance(found, Product):
            at = self.draw.randrange(len(found.parts))
            return tup(*(all_(s) if i == at else self.one(s) for i, s in enumerate(found.parts)))
        return self.one(sort)

    def one(self, sort: str) -> Term:
        """One value."""
        if sort == DOT:
            return DOT
        found = SORTS[sort]
        if isinstance(found, Product):
            return tup(*map(self.one, found.parts))
        if self.draw.random() < 0.3:
            return self.constant(sort)
        variable = self.draw.choice([v for v, s in VARIABLES.items() if s == sort])
        if sort == "K":
            return self.draw.choice((variable, ("part", "K", self.one("C"))))
        if sort == "C":
            return self.draw.choice((variable, variable, succ(variable), pred(pred(variable))))
        return variable

    def constant(self, sort: str) -> Term:
        if sort == DOT:
            return DOT
        match SORTS[sort]:
            case Enum(values=values):
                return self.draw.choice(values)
            case Range(low=low, high=high):
                return ("number", sort, self.draw.randint(low, high))
            case Partition(classes=classes):
                return self.draw.choice(sorted(classes))
            case Product(parts=parts):
                return tup(*map(self.constant, parts))

    def guard(self, depth: int) -> Term:
        kind = self.draw.randrange(7 if depth else 4)
        if kind == 0:
            sort = self.draw.choice(("CD", "CC", "NC", "DKD", "LN"))
            return self.draw.choice((eq, ne))(self.one(sort), self.one(sort))
        if kind == 1:
            sort = self.draw.choice(SIMPLE)
            return self.draw.choice((eq, ne))(self.one(sort), self.one(sort))
        if kind < 4:
            sort = self.draw.choice(("C", "D", "N", "L"))
            names = ("lessthan", "lessthanorequal", "greaterthan", "greaterthanorequal")
            return (self.draw.choice(names), self.one(sort), self.one(sort))
        if kind == 4:
            return ("not", self.guard(depth - 1))
        parts = [self.guard(depth - 1) for _ in range(self.draw.randint(2, 3))]
        return ("and" if kind == 5 else "or", *parts)
