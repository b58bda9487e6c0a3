"""What the programs of transitions name in C: slots and arrays, tables of places, sums, the binding.

What a function does not name it does not declare, since compilers warn of that. `with_access` writes it into the
transitions (`search_access`, `fire_access`, `lists_access`, `thresholds_access`), and again whenever it has become
known which places are slots. It follows what `emission.c_net_statements` and `emission.c_firing` print for each
statement.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pn2code.base.frozen import frozen, replace
from pn2code.base.how_far import counted
from pn2code.ir import nodes as ir
from pn2code.ir.calls import parts_of
from pn2code.ir.nodes import Rep
from pn2code.ir.printed import PARTLY_PRINTED, printed_parts
from pn2code.lowering.passes.alike import has_places_by_table
from pn2code.lowering.passes.moves import is_count, is_pair


@frozen
class _Places:
    """What all programs of a net want to know of its places.

    Args:
        timed, packed, slots: of each place.
        units: whether its tokens have no value.
        has_tables: whether packed places are reached by their tables.
        has_successors: of the net.
    """

    timed: tuple[bool, ...]
    packed: tuple[bool, ...]
    slots: tuple[bool, ...]
    units: tuple[bool, ...]
    has_tables: bool
    has_successors: bool

    @staticmethod
    def of(net: ir.NetIR) -> _Places:
        """Looked at once."""
        return _Places(
            tuple(p.timed for p in net.places),
            tuple(bool(p.packed) for p in net.places),
            tuple(p.is_slot for p in net.places),
            tuple(p.type.rep is Rep.UNIT for p in net.places),
            has_places_by_table(net),
            net.has_successors,
        )


def with_access(net: ir.NetIR) -> ir.NetIR:
    """The net, with what this pass finds; all of how places are kept and occurrences are printed is known."""
    places = _Places.of(net)
    transitions = counted(net.transitions, "what transitions need")
    return replace(net, transitions=tuple(_transition(places, t) for t in transitions))


def _transition(places: _Places, t: ir.Transition) -> ir.Transition:
    if t.counts is not None:  # it has no programs
        return t
    has_lists = t.is_direct and any(isinstance(s, ir.TakeAll | ir.PutAll) for s in t.fire)
    search, fire = _Program(places, t.sums), _Occurrence(places, t)
    search.look_at(t.enumerate)
    lists, thresholds = _Program(places), _Program(places)
    lists.look_at(t.fire)
    thresholds.look_at(t.thresholds)
    if t.is_direct:
        fire.run()
    return replace(
        t,
        search_access=search.found(),
        fire_access=fire.found() if t.is_direct else lists.found(),
        lists_access=lists.found() if has_lists else None,
        thresholds_access=thresholds.found(),
    )


_NAMING = frozenset({
    ir.Bound, ir.Bind, ir.ForValues, ir.UnlessLegal, ir.TokenValue, ir.ForTokens, ir.UnlessAvailable, ir.UnlessHeld,
    ir.UnlessEmpty, ir.Wanted, ir.Take, ir.Put, ir.TakeAll, ir.PutAll, ir.Threshold, ir.Reset,
})  # fmt: skip
"""Those that `_Program._parts` looks at; of all others only the parts name something."""


class _Program:
    """What is found in a program that is printed statement by statement.

    Args:
        places: of its net.
        sums: that it calls where it can.
    """

    def __init__(self, places: _Places, sums: tuple[ir.Sum, ...] = ()) -> None:
        self._places = places
        self._sum_numbers = {(s.place, s.multiset): number for number, s in enumerate(sums)}
        self._holders: set[int] = set()
        self._tables: set[int] = set()
        self._sums: set[int] = set()
        self._binding = False

    def found(self) -> ir.Access:
        """All of it."""
        return ir.Access(
            tuple(sorted(self._holders)),
            tuple(sorted(self._tables)),
            tuple(sorted(self._sums)),
            self._binding,
        )

    def look_at(self, item: object) -> None:
        """Note what is named by a piece of IR, or by a tuple of them."""
        waiting: list[Any] = [item]
        while waiting:
            node = waiting.pop()
            kind = node.__class__
            if kind is tuple:
                waiting += node
            elif kind in _NAMING:
                waiting += self._parts(node)
            else:
                waiting += printed_parts(node) if kind in PARTLY_PRINTED else parts_of(node)

    def _parts(self, node: object) -> Iterable[object]:
        """Note what a node names itself, and give those of its parts that are printed."""
        match node:
            case ir.Bound() | ir.Bind() | ir.ForValues() | ir.UnlessLegal():
                self._binding = True
            case ir.TokenValue(place=place) | ir.ForTokens(place=place):
                self._hold(place)
            case ir.UnlessAvailable(place=place):
                if not self._is_slot(place):
                    self._hold(place)
            case ir.UnlessHeld(place=place):
                self._name(place)
                if self._is_slot(place) and self._places.units[place]:
                    return ()
            case ir.UnlessEmpty(place=place):
                self._name(place)
            case ir.Wanted(takes=takes) if self._is_pair(takes):
                for s in takes:
                    if isinstance(s, ir.Take):
                        self._hold(s.place)
                return [s.value if isinstance(s, ir.Take) else s for s in takes]
            case ir.Wanted(takes=(ir.TakeAll() as take,)):
                self._call_sum(take)
            case (
                ir.Take(place=place)
                | ir.Put(place=place)
                | ir.TakeAll(place=place)
                | ir.PutAll(place=place)
                | ir.Threshold(place=place)
                | ir.Reset(place=place)
            ):
                self._hand_over(place)
        return printed_parts(node)

    def _is_pair(self, takes: tuple[ir.Stmt, ...]) -> bool:
        has_slot = any(isinstance(s, ir.Take) and self._is_slot(s.place) for s in takes)
        return not has_slot and is_pair(takes, self._places.timed)

    def _is_slot(self, place: int) -> bool:
        return self._places.slots[place]

    def _name(self, place: int) -> None:
        """By the table where the place is timed, or else directly."""
        if self._places.timed[place]:
            self._hand_over(place)
        else:
            self._hold(place)

    def _hold(self, place: int) -> None:
        if not self._places.packed[place]:
            self._holders.add(place)
        elif self._places.has_tables:
            self._tables.add(place)

    def _hand_over(self, place: int) -> None:
        if self._places.has_tables or not self._places.packed[place]:
            self._tables.add(place)

    def _call_sum(self, s: ir.TakeAll | ir.PutAll) -> None:
        number = self._sum_numbers.get((s.place, s.multiset))
        if number is not None:
            self._sums.add(number)
            self._binding = True


class _Occurrence(_Program):
    """What is found in an occurrence that is printed with the inline functions of its places; see `c_firing`."""

    def __init__(self, places: _Places, t: ir.Transition) -> None:
        super().__init__(places, t.sums)
        self._fire = t.fire
        self._staying = {id(t.fire[i]) for pair in t.staying for i in pair}
        self._puts_back = not places.has_successors
        taken = [s for s in t.fire if isinstance(s, ir.Take) and id(s) not in self._staying]
        self._emptied = {s.place for s in taken if self._is_slot(s.place)}
        puts = [s for s in t.fire if isinstance(s, ir.Put) and id(s) not in self._staying]
        self._filled = {s.place for s in puts if self._is_slot(s.place) and _is_one(s.count)}
        self._adds = False
        self._taken_from: list[int] = []

    def run(self) -> None:
        """Look at all of it."""
        self._go_through(self._fire, is_nested=False)
        if self._adds and self._puts_back:  # where a place is full, what was taken is put back
            for place in self._taken_from:
                self._hand_over(place)

    def _go_through(self, statements: Iterable[ir.Stmt], is_nested: bool) -> None:
        for s in statements:
            match s:
                case ir.Take() | ir.Put() if id(s) in self._staying:
                    pass
                case ir.Take() if self._is_slot(s.place):
                    self._take_from_slot(s)
                case ir.Take():
                    self._taken_from.append(s.place)
                    self._hold(s.place)
                    self.look_at((s.value, s.count))
                case ir.Put() if self._is_slot(s.place):
                    self._put_into_slot(s, is_nested)
                case ir.Put():
                    self._adds = True
                    self._hold(s.place)
                    self._hand_over(s.place)
                    self.look_at((s.value, s.count))
                case ir.TakeAll() | ir.PutAll():
                    self._adds = self._adds or isinstance(s, ir.PutAll)
                    self._call_sum(s)
                case ir.If():
                    self.look_at(s.condition)
                    self._go_through(s.then, is_nested=True)
                    self._go_through(s.otherwise, is_nested=True)
                case _:
                    self.look_at(s)

    def _take_from_slot(self, s: ir.Take) -> None:
        if not s.is_found:
            self.look_at(s.value)
        if not s.is_found or s.place not in self._filled:
            self._hold(s.place)

    def _put_into_slot(self, s: ir.Put, is_nested: bool) -> None:
        is_emptied = s.place in self._emptied
        is_counted = is_nested or not _is_one(s.count)
        is_plain = (
            isinstance(s.value, ir.Const | ir.Bound | ir.Use) and s.value.type.rep is Rep.UNIT
        )
        has_value = is_nested or not s.is_legal or not is_plain
        if has_value:
            self.look_at(s.value)
        if is_counted:
            self.look_at(s.count)
        has_to_be_empty = not (is_emptied and _is_one(s.count))
        if has_to_be_empty or not s.is_legal:
            self._hand_over(s.place)
        becomes_full = is_counted or not is_emptied
        if has_value or becomes_full or (has_to_be_empty and not is_emptied):
            self._hold(s.place)


def _is_one(count: ir.Ir) -> bool:
    return is_count(count) and isinstance(count, ir.Const) and count.value == 1
