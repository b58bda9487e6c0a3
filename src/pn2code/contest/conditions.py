"""What is asked of one marking, as a tree that can be worked with: comparisons, joined by `and` and `or`.

    condition = parsed("and 2 enabled 1 4 not sum 1 0 1 3")   # the engine's own words (`cnative`: tables_read.c)
    simple = condition.without_enabled(tables.pre)            # comparisons only, none of them negated

Numbers of tokens are integers, so that the opposite of `sum <= limit` is `-sum <= -limit - 1`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from pn2code.base.frozen import frozen


@frozen
class AtMost:
    """The sum of factor * tokens is at most `limit`; `factors` are (place, factor), by place, none of them 0."""

    factors: tuple[tuple[int, int], ...]
    limit: int

    def opposite(self) -> AtMost:
        """It is more than that."""
        return AtMost(tuple((p, -n) for p, n in self.factors), -self.limit - 1)

    def holds(self, marking: Sequence[int]) -> bool:
        """Whether it is true of a marking."""
        return sum(n * marking[p] for p, n in self.factors) <= self.limit


@frozen
class Junction:
    """All of the parts (`is_all`), or one of them. Without parts: true, or false."""

    is_all: bool
    parts: tuple[Condition, ...]


@frozen
class Dead:
    """No transition is enabled. It stands only alone: the question for a deadlock."""


Condition = AtMost | Junction | Dead
TRUE = Junction(True, ())
FALSE = Junction(False, ())


class TooLargeError(Exception):
    """A condition has more comparisons than can be worked with."""


MOST_PARTS = 200_000
"""Comparisons of a condition."""
MOST_CHARACTERS = 400_000
"""Of a question in the engine's own words, of which conditions are made: with more of them that would take too long."""


def at_most(factors: Mapping[int, int], limit: int) -> Condition:
    """A comparison; true or false if it is so for all numbers of tokens."""
    terms = tuple(sorted((p, n) for p, n in factors.items() if n))
    if all(n > 0 for _, n in terms) and limit < 0:
        return FALSE
    if all(n < 0 for _, n in terms) and limit >= 0:
        return TRUE
    return AtMost(terms, limit)


def junction(is_all: bool, parts: Iterator[Condition] | Sequence[Condition]) -> Condition:
    """The parts joined, as short as is seen at once."""
    found: dict[Condition, None] = {}
    for part in parts:
        if isinstance(part, Junction) and part.is_all == is_all:
            found.update(dict.fromkeys(part.parts))
        elif isinstance(part, Junction) and not part.parts:
            return part
        else:
            found[part] = None
    if len(found) > MOST_PARTS:
        raise TooLargeError
    return next(iter(found)) if len(found) == 1 else Junction(is_all, tuple(found))


def parsed(text: str, pre: Sequence[Mapping[int, int]]) -> Condition:
    """A formula without operators of time in the engine's own words.

    Args:
        text: the formula.
        pre: by transition, what it takes.

    Raises:
        TooLargeError: it has too many comparisons.
        ValueError: it is no such formula.
    """
    if text.split() == ["dead"]:
        return Dead()
    return _Reader(text.split(), pre).formula(True)


class _Reader:
    def __init__(self, words: list[str], pre: Sequence[Mapping[int, int]]) -> None:
        self.words = iter(words)
        self.pre = pre
        self.made = 0
        self.needs: dict[tuple[int, int, bool], Condition] = {}
        """By place, tokens and what is wanted: bindings of one transition need the same again and again."""

    def number(self) -> int:
        return int(next(self.words))

    def formula(self, wanted: bool) -> Condition:
        """The formula that follows, or its opposite."""
        word = next(self.words)
        match word:
            case "true" | "false":
                return TRUE if (word == "true") == wanted else FALSE
            case "not":
                return self.formula(not wanted)
            case "and" | "or":
                parts = [self.formula(wanted) for _ in range(self.number())]
                return junction((word == "and") == wanted, parts)
            case "sum":
                terms = [(self.number(), self.number()) for _ in range(self.number())]
                return self.comparison(dict(terms), self.number(), wanted)
            case "enabled":
                found = [self.number() for _ in range(self.number())]
                return junction(not wanted, [self.enabled(t, wanted) for t in found])
        raise ValueError(f"`{word}` begins no formula about one marking")

    def enabled(self, t: int, wanted: bool) -> Condition:
        return junction(wanted, [self.need(p, n, wanted) for p, n in self.pre[t].items()])

    def need(self, place: int, tokens: int, wanted: bool) -> Condition:
        key = place, tokens, wanted
        found = self.needs.get(key)
        if found is None:
            found = self.needs[key] = self.comparison({place: 1}, tokens - 1, not wanted)
        else:
            self.count()
        return found

    def count(self) -> None:
        self.made += 1
        if self.made > MOST_PARTS:
            raise TooLargeError

    def comparison(self, factors: Mapping[int, int], limit: int, wanted: bool) -> Condition:
        self.count()
        if wanted:
            return at_most(factors, limit)
        return at_most({p: -n for p, n in factors.items()}, -limit - 1)


def text(c: Condition) -> str:
    """The condition in the engine's own words."""
    match c:
        case Dead():
            return "dead"
        case AtMost(factors, limit):
            terms = "".join(f" {p} {n}" for p, n in factors)
            return f"sum {len(factors)}{terms} {limit}"
        case Junction(is_all, parts):
            if not parts:
                return "true" if is_all else "false"
            return f"{'and' if is_all else 'or'} {len(parts)} {' '.join(map(text, parts))}"


def places(c: Condition) -> set[int]:
    """The places that it looks at."""
    match c:
        case AtMost(factors, _):
            return {p for p, _ in factors}
        case Junction(_, parts):
            return set().union(*map(places, parts))
    return set()


def holds(c: Condition, marking: Sequence[int]) -> bool:
    """Whether a condition other than `Dead` is true of a marking."""
    if isinstance(c, AtMost):
        return c.holds(marking)
    assert isinstance(c, Junction)
    return (all if c.is_all else any)(holds(p, marking) for p in c.parts)


def mapped(c: Condition, change: Callable[[AtMost], Condition]) -> Condition:
    """The condition with each comparison replaced."""
    match c:
        case AtMost():
            return change(c)
        case Junction(is_all, parts):
            return junction(is_all, [mapped(p, change) for p in parts])
    return c
