"""What all that is printed of one net has in common: names, types, how places are kept, printers of functions."""

from __future__ import annotations

from pn2code.diagnostics import Origin
from pn2code.emission import c_orders, c_packed
from pn2code.emission.c_expressions import Expressions
from pn2code.emission.c_net_statements import NetStatements
from pn2code.emission.c_own import OwnPlaces
from pn2code.emission.c_types import Types
from pn2code.emission.names import Names, Scope
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import NetIR
from pn2code.lowering.nets.packing import KEY_BITS, key_bits
from pn2code.lowering.passes.alike import has_places_by_table

_MOST_INLINED = 150
"""Transitions of a net for which the compiler is told to put searches where they are called."""


class Frame:
    """Of one net; see `c.py`."""

    def __init__(self, net: NetIR, version: str) -> None:
        self._net = net
        self._version = version
        self._names = Names()
        self._definitions = {d.name: d for d in net.definitions}
        self._types = Types(self._names, self._definitions)
        self._descriptors = {d.name: d for d in net.descriptors}
        self._functions = {f.key: f for f in net.functions}
        self._blocks: dict[str, tuple[str, str, Origin]] = {}
        self._place_names = tuple(self._names.place(p.index, p.name) for p in net.places)
        for t in net.transitions:
            self._names.transition(t.index, t.name)
        for definition in net.definitions:
            self._names.type(definition.name)
        self._multisets = tuple(f"&{self._names.multiset(p.index, p.name)}" for p in net.places)
        self._tokens = tuple(f"m->{name}." for name in self._place_names)
        self._holders = tuple(f"&m->{name}" for name in self._place_names)
        self._tables = tuple(self._names.table(p.table) for p in net.places)
        self._timed = tuple(p.timed for p in net.places)
        self._token_types = tuple(p.type for p in net.places)
        self._global_hints = {g.name: g.hint for g in net.globals}
        self._slots = frozenset(p.index for p in net.places if p.is_slot)
        self._needs_context = frozenset(f.key for f in net.functions if f.needs_context)
        self._orders = c_orders.Orders(self._types, self._names, self._descriptors)
        self._numbers = c_packed.Numbers(self._types, self._names, self._descriptors)
        self._packed = self._numbers.of_places(
            net.places,
            lambda key: self._functions[key].is_pure,
            by_table=has_places_by_table(net),
        )
        self._has_packed = any(self._packed)
        self._has_inlined = net.has_successors and len(net.transitions) <= _MOST_INLINED
        self._has_words = (
            self._has_inlined
            and not net.timed
            and all(p.packed for p in net.places)
            and 0 < key_bits(net.places) <= KEY_BITS
        )
        self._key = (1 << key_bits(net.places)) - 1
        self._referring = tuple(p.index for p in net.places if p.refers)
        self._kept = tuple(map(self._kept_in, net.places))
        self._room = self._rooms_of_arrays()

    def _kept_in(self, p: ir.Place) -> str:
        """The stem of the C type that holds the tokens of a place, and of its functions; "": it is packed."""
        if p.packed:
            return ""
        if p.index in self._slots:
            return self._names.kept(p.table, "slot")
        kind = "timed_array" if p.timed else "array"
        return self._names.kept(p.table, f"{kind}_{p.capacity}")

    def _rooms_of_arrays(self) -> dict[str, int]:
        """By what holds the tokens: entries of untimed arrays behind their capacity, for what an occurrence adds."""
        found: dict[str, int] = {}
        for p in self._net.places:
            if not p.timed:
                # gcc warns of loops that would go through an array of one, though they never do.
                kept = self._kept[p.index]
                found[kept] = max(found.get(kept, 0), p.added, 2 - p.capacity)
        return found

    # --- pieces --------------------------------------------------------------------------------

    def _printer(
        self, statements: tuple[ir.Stmt, ...], binding: str = "", own: OwnPlaces | None = None
    ) -> tuple[NetStatements, Expressions, Scope]:
        scope = Scope()
        x = Expressions(self._types, self._net.real_time, scope, binding)
        x.functions = self._functions
        x.int_bits = self._net.int_bits
        x.needs_context = self._needs_context
        x.place_names = self._place_names
        x.tokens, x.holders, x.kept = self._tokens, self._holders, self._kept
        x.multisets = self._multisets
        x.packed = self._packed
        x.slots = self._slots
        x.global_hints = self._global_hints
        s = NetStatements(self._types, x, scope, self._net.real_time)
        s.multisets = self._multisets
        s.timed = self._timed
        s.slots = self._slots
        if self._has_packed:
            s.number_of = self._numbers.if_whole
        s.token_types = self._token_types
        s.tables_of_places = self._tables
        if own:
            own.reserve(scope)
            x.place_names = own.names(x.place_names)
            x.tokens, x.holders = own.tokens(x.tokens), own.holders(x.holders)
            s.multisets = x.multisets = own.multisets(x.multisets)
        return s, x, scope

    def _block(self, element: str, kind: str, origin: Origin) -> str:
        number = str(len(self._blocks))
        self._blocks[number] = (element, kind, origin)
        return number
