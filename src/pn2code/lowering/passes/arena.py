"""How many bytes of arena are proven to be enough: for programs that make no value which refers into it.

Those have no list, string, union, reference or unlimited integer, and call no function that makes one
(`cnative/include/pn/pn_arena.h`). What is left are the moves of one firing, which are forgotten before the next, those
of the initial marking, which stay for some time, and one arriving token.

`with_arena` writes it into the net (`arena`), and again whenever it has become known which places are slots.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.types import Definition, IrType, Rep, StructDef

ALIGNMENT = 32
"""Of what is allocated: at most that of `max_align_t`."""
SCALAR = 16
"""Bytes of a scalar with what may be left free before it, at most."""
MOVE = 96
"""Bytes of a `pn_move_t`, aligned, at most; pn_moves.c is not compiled where it is more."""
ON_STACK = 256
"""Bytes of an arriving token that needs no arena: `pn_colour_t`."""

_REFERRING = frozenset((Rep.STRING, Rep.BIG, Rep.LIST, Rep.UNION, Rep.REF))
_LOOPS = (ir.While, ir.ForList, ir.ForCount, ir.ForTokens, ir.ForValues)


class _UnknownError(Exception):
    """The moves cannot be counted."""


def with_arena(net: ir.NetIR) -> ir.NetIR:
    """The net, with what this pass finds; `used`, `has_moves` and `arrives` are known."""
    try:
        return replace(net, arena=ir.Arena(_proven(net), ""))
    except _UnknownError as unknown:
        return replace(net, arena=ir.Arena(None, str(unknown)))


def _proven(net: ir.NetIR) -> int:
    """Bytes of a net that keeps nothing in the arena between firings; raises `_UnknownError` for others."""
    tables = {*net.used.tables, *net.used.further_tables}
    if any(d.type.rep in _REFERRING for d in net.descriptors if d.name in tables):
        raise _UnknownError("the net has lists, strings, unions, references or unlimited integers")
    if net.used.makers:
        raise _UnknownError(f"{net.used.makers[0]} is called")
    if any(g.is_reference for g in net.globals):
        raise _UnknownError("the net has references")
    sizes = _Sizes(net)
    start, firing = 0, 0
    if net.has_moves:
        start = sum(sizes.moves(p.initial) for p in net.places)
        for t in net.transitions:
            wanted = [
                n.takes for n in ir_nodes((t.enumerate, t.thresholds)) if isinstance(n, ir.Wanted)
            ]
            firing = max(firing, sizes.moves(t.fire), *(sizes.moves(w) for w in wanted), 0)
    for place in net.places:
        size = sizes.of(place.type)
        if place.arrives and size > ON_STACK:
            firing = max(firing, _aligned(size))
    # Each half has to hold what the initial marking leaves behind, and a firing.
    return 2 * (start + firing)


class _Sizes:
    """Upper bounds of bytes: of values in C, and of moves."""

    def __init__(self, net: ir.NetIR) -> None:
        self._definitions: Mapping[str, Definition] = {d.name: d for d in net.definitions}
        self._places: Sequence[ir.Place] = net.places

    def of(self, kind: IrType) -> int:
        """The most that `sizeof` a type can be, on any machine of up to 64 bits."""
        if kind.rep in _REFERRING:
            raise _UnknownError("the net has values that refer to others")
        if kind.rep is not Rep.STRUCT:
            return SCALAR
        definition = self._definitions[kind.name]
        assert isinstance(definition, StructDef)
        return sum(self.of(field) for _, field in definition.fields) or SCALAR

    def moves(self, statements: tuple[ir.Stmt, ...]) -> int:
        """Bytes of the moves of all these statements; of an `If`, of both its ways."""
        found = 0
        for node in ir_nodes(statements):
            match node:
                case ir.Reset():
                    found += MOVE
                case ir.Put(place=place):
                    found += MOVE + self._copy(place)
                case ir.Take(place=place, count=count):
                    found += self._copy(place) + MOVE * self._tokens(place, count)
                case ir.TakeAll() | ir.PutAll():
                    raise _UnknownError("an arc has a computed multi-set")
                case _ if isinstance(node, _LOOPS) and _has_moves(node.body):
                    raise _UnknownError("tokens move in a loop")
                case _:
                    pass
        return found

    def _copy(self, place: int) -> int:
        return _aligned(self.of(self._places[place].type))

    def _tokens(self, place: int, count: ir.Ir) -> int:
        """Moves of one `Take`: of a timed place one for each token, since their stamps differ."""
        if not self._places[place].timed:
            return 1
        if isinstance(count, ir.Const) and isinstance(count.value, int):
            return max(count.value, 0)
        raise _UnknownError("an arc takes a computed number of timed tokens")


def _aligned(size: int) -> int:
    return -(-size // ALIGNMENT) * ALIGNMENT


def _has_moves(statements: tuple[ir.Stmt, ...]) -> bool:
    return any(isinstance(n, ir.Put | ir.Take | ir.Reset) for n in ir_nodes(statements))
