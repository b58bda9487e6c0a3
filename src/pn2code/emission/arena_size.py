"""How much memory a deployed program has for lists, strings and the moves of a firing: the size of its arena.

    arena_size.of(net, arriving=[3, 7], seen=None)
    # ArenaSize(0, "proven: the program puts nothing there")

An allocation that is refused is a fault at run time, so a size is small only where a proof says that it is enough. The
proof is for nets that make no value which refers into the arena (`cnative/include/pn/pn_arena.h`): no list, string,
union, reference or unlimited integer, and no call of a function that makes one. What is left are the moves of one
firing, which are forgotten before the next, those of the initial marking, which stay for some time, and one arriving
token. All other nets get what the state space shows, if it is known, but not less than `DEFAULT`: the explored program
has its places packed otherwise than the deployed one, and robots and other files may bring longer values than those
that were explored.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.types import Definition, IrType, Rep, StructDef

DEFAULT = 1 << 22
"""Bytes where nothing is proven: `PN_ARENA_DEFAULT_SIZE`."""
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


@frozen
class ArenaSize:
    """The size of an arena.

    Args:
        bytes: 0: the program has none.
        why: what says that it is enough, a line for people.
        is_proven: it is enough, whatever files and robots bring.
    """

    bytes: int
    why: str
    is_proven: bool = False


UNKNOWN = ArenaSize(DEFAULT, "the usual size; nothing proves it to be enough")


def of(net: ir.NetIR, arriving: Iterable[int], seen: int | None) -> ArenaSize:
    """The size for a program.

    Args:
        net: what is deployed, with the room of its places.
        arriving: the places that get tokens from channels and input files.
        seen: bytes that are enough according to the state space; None: it does not say.
    """
    try:
        found = _proven(net, frozenset(arriving))
    except _UnknownError as unknown:
        if seen is None:
            return ArenaSize(DEFAULT, f"not proven to be enough ({unknown}): the usual size")
        text = f"more than twice what the state space shows, and no less than {DEFAULT:,}; not proven ({unknown})"
        return ArenaSize(max(seen, DEFAULT), text)
    if found == 0:
        return ArenaSize(0, "proven: the program puts nothing there", is_proven=True)
    return ArenaSize(
        found,
        "proven to be enough for the initial marking, the moves of one firing, and a token that arrives",
        is_proven=True,
    )


def _proven(net: ir.NetIR, arriving: frozenset[int]) -> int:
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
        if place.index in arriving and size > ON_STACK:
            firing = max(firing, _aligned(size))
    return 2 * (
        start + firing
    )  # each half has to hold what the initial marking leaves behind, and a firing


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
