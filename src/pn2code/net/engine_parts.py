"""What CPN Tools' syntax check makes of inscriptions: summands, and conditions, with their variables.

Its public sources say how: an input inscription is split at `++`, `+++`, a number before a backquote and `@+`; of each
summand it notes the variables of its coefficient, of its delay, and of its value, or of each component if that is a
tuple or a record. It reads the text from left to right, the delay before what it stands behind. The second time that
a summand has a variable it takes it for a new one, which a condition of its own makes equal to the first; if the value
is no pattern, it forgets the new one, except in coefficients.
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.base.frozen import frozen
from pn2code.ml.core.terms import Apply, Builtin, Exp, PEqual, RecordExp, Sequence, Symbol
from pn2code.net.flat import Form
from pn2code.net.terms import TermReader, binary, split
from pn2code.net.uses import NetVariables, walk_pattern

_DELAYS = ("Time.@+", "Time.token@+")
Seen = tuple[Symbol, ...]
"""Variables in order of the text, as often as they are there."""


@frozen
class Summand:
    """A summand of an input inscription.

    Args:
        coefficient: the variables of its coefficient; None: none is written, and it is a multi-set.
        delay: those of its delay.
        entries: those of each component of a tuple or record; of all else of its value.
        is_record: whether it is one.
        is_pattern: whether the value is a pattern.
    """

    coefficient: Seen | None
    delay: Seen
    entries: tuple[Seen, ...]
    is_record: bool
    is_pattern: bool


@frozen
class Side:
    """A side of an equation in a guard."""

    seen: Seen
    is_pattern: bool


@frozen
class Item:
    """A condition of a guard: an equation, one of whose sides binds variables, or what is only tested."""

    sides: tuple[Side, Side] | None
    tested: tuple[Seen, ...]


class PartReader:
    """Takes inscriptions apart as CPN Tools does."""

    def __init__(self, variables: NetVariables, terms: TermReader) -> None:
        self._variables = variables
        self._terms = terms

    def summands(self, e: Exp, form: Form) -> tuple[Summand, ...]:
        """The summands of an input inscription, in the order of the text."""
        is_token = form in (Form.TOKEN, Form.TIMED_TOKEN)
        return tuple(self._top(e, () if is_token else None, ()))

    def _top(self, e: Exp, coefficient: Seen | None, delay: Seen) -> Iterator[Summand]:
        e = inside(e)
        counted = binary(e, ("Ms.`",))
        if counted is not None:
            yield self._summand(inside(counted[1]), self._seen(counted[0]), delay)
            return
        delayed = binary(e, _DELAYS)
        if delayed is not None:
            yield from self._top(delayed[0], coefficient, self._seen(delayed[1]))
            return
        both = binary(e, ("Ms.++", "Time.+++"))
        if both is not None:
            for part in both:
                yield from self._top(part, None, delay)
            return
        yield self._summand(e, coefficient, delay)

    def _summand(self, e: Exp, coefficient: Seen | None, delay: Seen) -> Summand:
        is_pattern = self.is_pattern(e)
        if isinstance(e, RecordExp):
            entries = tuple(self._seen(x) for _, x in e.fields)
            return Summand(coefficient, delay, entries, True, is_pattern)
        return Summand(coefficient, delay, (self._seen(e),), False, is_pattern)

    def item(self, guard: Exp) -> Item:
        """A condition of a guard."""
        e = inside(guard)
        match e:
            case Apply(Builtin("=") as operator, RecordExp((("1", left), ("2", right)))) if (
                not operator.span.text.startswith("op")
            ):
                a, b = self._side(left), self._side(right)
            case _:
                return Item(None, (self._seen(e),))
        if (a.is_pattern and a.seen) or (b.is_pattern and b.seen):
            return Item((a, b), ())
        return Item(None, (a.seen, b.seen))

    def _side(self, e: Exp) -> Side:
        return Side(self._seen(e), self.is_pattern(e))

    def is_pattern(self, e: Exp) -> bool:
        """Whether SML takes it for a pattern: not with a constant twice, which would be a variable there."""
        pattern = self._terms.pattern(e)
        if pattern is None:
            return False
        constants = [p.value.span.text for p in walk_pattern(pattern) if isinstance(p, PEqual)]
        return len(constants) == len(set(constants))

    def _seen(self, e: Exp) -> Seen:
        return tuple(symbol for symbol, _ in self._variables.sights(e))


def inside(e: Exp) -> Exp:
    """Without parentheses."""
    while isinstance(e, Sequence) and len(e.items) == 1:
        e = e.items[0]
    return e


def has_long_delay(e: Exp) -> bool:
    """Whether a summand has a delay after `@++`: CPN Tools takes all of it for a value, which binds nothing."""
    found = (
        binary(inside(part), ("Time.@++", "Time.token@++")) for part in split(e, ("Time.+++",))
    )
    return any(x is not None for x in found)
