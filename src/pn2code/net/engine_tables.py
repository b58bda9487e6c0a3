"""The tables in which CPN Tools' syntax check keeps the variables of a transition: groups that are bound one by one.

Its public sources say how. Variables, arcs and conditions that have to do with each other are a group. Variables in an
expression that are new wait until one is met that has a group; otherwise the expression is a group of its own. What
connects two groups makes one of them. An arc from a place that has been met belongs to the group of the first arc
from it, whatever its variables are; and there the tables break:

* it gives the group its waiting variables a second time: the check ends with `InternalError: insert_transvar`;
* it does not know that the group has become a part of another one: `InternalError: ins_compressed`;
* the variables may be those of another group: their numbers then mean others.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field

from pn2code.base.frozen import frozen, record
from pn2code.ml.core.terms import Symbol
from pn2code.net.engine_parts import Item, Seen, Summand

Name = Symbol | int
"""A variable, or the number of one that stands for another one."""


class BrokenError(Exception):
    """CPN Tools' check of the page ends with an internal error, which is the message."""


@record
class Known:
    """A variable in a group: its number there, how many expressions have it, whether something may bind it."""

    group: int
    number: int
    expressions: int = 1
    bindable: bool = False


@frozen
class Leaf:
    """A summand with its names, and the number of its arc."""

    arc: int
    coefficient: tuple[Name, ...] | None
    delay: tuple[Name, ...]
    entries: tuple[tuple[Name, ...], ...]
    is_record: bool
    is_pattern: bool

    def names(self) -> tuple[Name, ...]:
        """Those of its value."""
        return tuple(n for entry in self.entries for n in entry)


@record
class ArcExpression:
    """What is taken from a place, by one arc or several."""

    place: str
    leaves: list[Leaf]
    is_sum: bool


@frozen
class Condition:
    """A condition: two sides with their names, and whether each is a pattern; one that only tests has none."""

    tested: tuple[Name, ...]
    sides: tuple[tuple[tuple[Name, ...], bool], ...] = ()


@record
class Group:
    """A group of variables, arcs and conditions."""

    names: list[Name] = field(default_factory=list)
    count: int = 0
    arcs: list[ArcExpression] = field(default_factory=list)
    conditions: list[Condition] = field(default_factory=list)


class Tables:
    """The tables, filled arc by arc and condition by condition."""

    def __init__(self) -> None:
        self.known: dict[Name, Known] = {}
        self.groups: dict[int, Group] = {}
        self.is_parted = False
        """Whether an arc from a place that has been met has variables of another group."""
        self.twice: dict[int, Symbol] = {}
        """The variable for which a number stands."""
        self._places: dict[str, int] = {}
        self._next = 0
        self._second = 0
        self._waiting: dict[Name, Name | None] = {}
        self._met: set[Symbol] = set()
        self._stand_ins: dict[int, Symbol] = {}
        self._group: int | None = None

    # --- expressions

    def arc(self, place: str, summands: Iterable[Summand], number: int = 0) -> None:
        """An arc that takes tokens from a place.

        Raises:
            BrokenError: as CPN Tools.
        """
        leaves = [self._leaf(s, number) for s in summands]
        expression = ArcExpression(place, leaves, len(leaves) > 1)
        group = self._places.get(place)
        if group is None:
            self._places[place] = self._next if self._group is None else self._group
            self._insert(expression)
            return
        if self._group is not None and self._group != group:
            self.is_parted = True
        self._move(group)
        found = self.groups.get(group)
        if found is None:
            raise BrokenError("ins_compressed")
        before = next((a for a in found.arcs if a.place == place), None)
        if before is not None:
            found.arcs.remove(before)
            expression = ArcExpression(place, [*leaves, *before.leaves], True)
        found.arcs.append(expression)
        self._clear()

    def condition(self, item: Item) -> None:
        """A condition of the guard."""
        if item.sides is None:
            names: list[Name] = []
            for seen in item.tested:
                found = self._names(seen)
                names += found if len(item.tested) > 1 else self._own(found)
                self._forget()
            self._insert(Condition(tuple(names)))
            return
        sides = []
        for side in item.sides:
            found = self._names(side.seen)
            sides.append((tuple(found if side.is_pattern else self._own(found)), side.is_pattern))
            self._keep() if side.is_pattern else self._forget()
        tested = tuple(n for names_of, _ in sides for n in names_of)
        self._insert(Condition(tested, tuple(sides)))

    def _leaf(self, s: Summand, number: int) -> Leaf:
        delay = self._own(self._names(s.delay))
        coefficient = None if s.coefficient is None else tuple(self._names(s.coefficient))
        entries = [self._names(seen) for seen in s.entries]
        if not s.is_pattern:
            entries = [self._own(names) for names in entries]
        self._keep() if s.is_pattern else self._forget()
        whole = tuple(map(tuple, entries))
        return Leaf(number, coefficient, tuple(delay), whole, s.is_record, s.is_pattern)

    # --- variables

    def _names(self, seen: Seen) -> list[Name]:
        return [self._name(symbol) for symbol in seen]

    def _name(self, symbol: Symbol) -> Name:
        if symbol in self._met:
            self._second += 1
            self._stand_ins[self._second] = symbol
            return self._second
        self._met.add(symbol)
        known = self.known.get(symbol)
        if known is None:
            if self._group is None:
                self._waiting[symbol] = None
            else:
                self._put(symbol, self._group, None)
            return symbol
        if self._group is None:
            self._group = known.group
            self._move(known.group)
        else:
            self._merge(self._group, known.group)
            self._group = known.group
        known.expressions += 1
        return symbol

    def _own(self, names: Iterable[Name]) -> list[Name]:
        return [n for n in names if not (isinstance(n, int) and n in self._stand_ins)]

    def _keep(self) -> None:
        for n, symbol in self._stand_ins.items():
            if self._group is None:
                self._waiting[n] = symbol
            else:
                self._put(n, self._group, symbol)
        self._forget()

    def _forget(self) -> None:
        self._stand_ins.clear()
        self._met.clear()

    def _clear(self) -> None:
        self._waiting.clear()
        self._forget()
        self._group = None

    # --- groups

    def _insert(self, expression: ArcExpression | Condition) -> None:
        group = self._group
        if group is None:
            group = self._next
            self._next += 1
            self._add(group, expression)
            self._move(group)
        else:
            self._add(group, expression)
        self._clear()

    def _add(self, group: int, expression: ArcExpression | Condition) -> None:
        found = self.groups.setdefault(group, Group())
        if isinstance(expression, Condition):
            found.conditions.append(expression)
        else:
            found.arcs.append(expression)

    def _move(self, group: int) -> None:
        for name, other in list(self._waiting.items()):
            self._put(name, group, other)

    def _put(self, name: Name, group: int, other: Name | None) -> None:
        found = self.groups.get(group)
        if found is None or name in self.known:
            raise BrokenError("insert_transvar")
        self.known[name] = Known(group, found.count)
        found.count += 1
        found.names.append(name)
        if isinstance(other, Symbol) and isinstance(name, int):
            self.twice[name] = other
            equal = (((name,), True), ((other,), True))
            self._add(group, Condition((name, other), equal))

    def _merge(self, source: int, target: int) -> None:
        if source == target:
            return
        old, new = self.groups.pop(source), self.groups[target]
        for name in reversed(old.names):
            known = self.known[name]
            known.group, known.number = target, new.count
            new.count += 1
        new.names = [*new.names, *old.names]
        new.arcs = [*old.arcs, *new.arcs]
        new.conditions = [*old.conditions, *new.conditions]
