"""Whether CPN Tools finds an order in which the arcs and conditions of a group give its variables values.

Its public sources say how: by a search from "no variable has a value, everything is open" to "all have one, nothing is
open". The steps:

* a summand with a coefficient that is a pattern, and has no variable in its coefficient, matches a token: none of its
  variables may have a value;
* a tuple or record finds a token by components, constants or those whose variables have values and are in several
  expressions: none of the other variables may have a value;
* an arc is tested when the variables of its values have values. What is a sum is tested as a whole, in the end; until
  then its summands may bind, one after the other;
* an equation binds the variables of a side that is a pattern, once those of the other side have values;
* a condition is tested when its variables have values;
* all values of a small colour set are tried where no step could give the variable one; of a large one it is refused.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from pn2code.base.frozen import frozen
from pn2code.ml.core.terms import Symbol
from pn2code.net.engine_tables import BrokenError, Condition, Group, Leaf, Name, Tables

MOST = 20_000
"""Markings that are looked at; where there are more, it is not known whether there is an order."""


class StuckError(Exception):
    """CPN Tools finds no order; `names` have no value in the one that gets furthest."""

    def __init__(self, names: frozenset[Name]) -> None:
        super().__init__()
        self.names = names


class UndecidedError(Exception):
    """No order was found among the first `MOST` markings, and there are more."""


class LargeError(Exception):
    """Nothing could give the variable a value, and its colour set is large."""

    def __init__(self, name: Symbol) -> None:
        super().__init__()
        self.name = name


@frozen
class Step:
    """A step: what must be known and open before, and is so afterwards; what it costs CPN Tools.

    Args:
        stands: the number that it makes equal to a variable, which CPN Tools does not compare if both have values.
    """

    needs: int
    gives: int
    weight: int
    may_rebind: bool = False
    stands: frozenset[int] = frozenset()

    def after(self, marking: int) -> int | None:
        """The marking that it leads to; None: it cannot be taken."""
        rest = marking & ~self.needs
        if self.needs & ~marking or (rest & self.gives and not self.may_rebind):
            return None
        return rest | self.gives

    @property
    def tests(self) -> bool:
        """Whether it gives nothing but leave to go on."""
        return not self.gives & ~self.needs


@frozen
class Lookup:
    """A summand whose tokens are found by their known components; `keys`: the components that may be known.

    Instead of a step for each subset of these: one that can be taken gives no name that has a value already, so that
    it is found by all components that are known.
    """

    needs: int
    keys: tuple[int, ...]
    has_constant: bool
    gives: int
    leaf: Leaf
    weight: int = 20

    def after(self, marking: int) -> int | None:
        """The marking that it leads to; None: it cannot be taken."""
        known = [k for k in self.keys if not k & ~marking]
        if self.needs & ~marking or not (known or self.has_constant):
            return None
        rest = marking & ~self.needs
        for k in known:
            rest &= ~k
        return None if rest & self.gives else rest | self.gives


def search(tables: Tables, group: int, is_small: Callable[[Symbol], bool]) -> None:
    """Look for an order.

    Raises:
        StuckError: there is none.
        UndecidedError: it is not known.
        LargeError: a variable could get its value by trying only, and has too many.
        BrokenError: CPN Tools' check ends with an internal error.
    """
    found = tables.groups[group]
    made = Steps(tables, found)
    steps = made.all(is_small)
    every = (1 << found.count) - 1
    start = ((1 << (len(found.arcs) + len(found.conditions))) - 1) << found.count
    tests = [s for s in steps if s.tests]
    others = [s for s in steps if not s.tests]
    best, seen, stack = 0, set[int](), [start]
    while stack:
        marking = _settled(stack.pop(), tests)
        if marking == every:
            return
        if marking in seen:
            continue
        seen.add(marking)
        if len(seen) > MOST:
            raise UndecidedError
        if (marking & every).bit_count() > best.bit_count() or not best:
            best = marking & every
        stack += [after for s in others if (after := s.after(marking)) is not None]
        stack += [after for x in made.lookups if (after := x.after(marking)) is not None]
    names = frozenset(n for n in found.names if not best >> tables.known[n].number & 1)
    raise StuckError(names or frozenset(found.names))


def _settled(marking: int, tests: list[Step]) -> int:
    for s in tests:
        if s.needs & ~marking == 0:
            marking = marking & ~s.needs | s.gives
    return marking


class Steps:
    """The steps of a group."""

    def __init__(self, tables: Tables, group: Group) -> None:
        self._tables = tables
        self._group = group
        self._length = group.count + len(group.arcs) + len(group.conditions)
        self.lookups: list[Lookup] = []
        """Once all steps were asked for."""

    def all(self, is_small: Callable[[Symbol], bool]) -> list[Step]:
        """All but the lookups.

        Raises:
            LargeError: a variable could get its value by trying only, and has too many.
            BrokenError: CPN Tools' check ends with an internal error.
        """
        found: list[Step] = []
        at = self._group.count
        for arc in self._group.arcs:
            names = [n for leaf in arc.leaves for n in leaf.names()]
            if not arc.is_sum:
                leaf = arc.leaves[0]
                names += [*leaf.delay, *(leaf.coefficient or ())]
            tested = self._bits(names)
            found.append(Step(tested | 1 << at, tested, 10))
            for leaf in arc.leaves:
                found += self._leaf(leaf, 1 << at, arc.is_sum)
            at += 1
        for c in self._group.conditions:
            tested = self._bits(c.tested)
            found.append(Step(tested | 1 << at, tested, 2))
            for (names_of, is_pattern), (others, _) in (c.sides, c.sides[::-1]) if c.sides else ():
                if is_pattern:
                    needs, gives = self._bits(others), self._bits(names_of, is_bindable=True)
                    found.append(Step(needs | 1 << at, needs | gives, 1, True, self._stands(c)))
            at += 1
        for name in list(self._group.names):
            known = self._tables.known[name]
            if known.bindable:
                continue
            assert isinstance(name, Symbol)
            if not is_small(name):
                raise LargeError(name)
            found.append(Step(0, 1 << known.number, 1000))
        return found

    def _leaf(self, leaf: Leaf, open_: int, is_sum: bool) -> Iterator[Step]:
        if leaf.coefficient == () and leaf.is_pattern:
            yield self._taken(leaf, open_, is_sum)
        if leaf.coefficient or not leaf.is_record or len(leaf.entries) < 2:
            return
        constant = tuple(e for e in leaf.entries if not e)
        if len(constant) == len(leaf.entries):
            return
        keys = [e for e in leaf.entries if e and self._is_key(e)]
        self._bits(leaf.names(), is_bindable=True)
        if keys or constant:
            step = self._taken(leaf, open_, is_sum)
            bits = tuple(map(self._bits, keys))
            self.lookups.append(Lookup(step.needs, bits, bool(constant), step.gives, leaf))

    def _taken(self, leaf: Leaf, open_: int, is_sum: bool) -> Step:
        delay = self._bits(leaf.delay)
        gives = self._bits(leaf.names(), is_bindable=True) | delay
        return Step(open_ | delay, gives | (open_ if is_sum else 0), 100)

    def _stands(self, condition: Condition) -> frozenset[int]:
        """The numbers in a condition that makes one equal to the variable for which it stands."""
        names = condition.tested
        is_own = any(isinstance(n, int) and self._tables.twice[n] in names for n in names)
        return frozenset(n for n in names if isinstance(n, int)) if is_own else frozenset()

    def _is_key(self, names: tuple[Name, ...]) -> bool:
        return all(n in self._tables.known and self._tables.known[n].expressions > 1 for n in names)

    def _bits(self, names: tuple[Name, ...] | list[Name], *, is_bindable: bool = False) -> int:
        bits = 0
        for name in names:
            known = self._tables.known.get(name)
            if known is None:
                raise BrokenError("get_vids")
            if known.number >= self._length:
                raise BrokenError("IllegalBit")
            known.bindable |= is_bindable
            bits |= 1 << known.number
        return bits
