"""What an occurrence need not look at again: takes of what the search has found, puts of what is of the colour set.

`with_checks` writes it into the statements of `fire` (`Take.is_found`, `Put.is_legal`). In explorers it also follows
how large integers can be (`ranges`).
"""

from __future__ import annotations

from collections.abc import Container, Iterable

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir
from pn2code.ir.types import is_restricted
from pn2code.lowering.passes.ranges import Ranges, known_tables


def with_checks(net: ir.NetIR) -> ir.NetIR:
    """The net, with what this pass finds; `constant` of the globals is known."""
    known = _Known(net)
    return replace(net, transitions=tuple(map(known.transition, net.transitions)))


class _Known:
    """What is known of the values in the programs of a net."""

    def __init__(self, net: ir.NetIR) -> None:
        self._descriptors = {d.name: d for d in net.descriptors}
        self._places = net.places
        self._constants = {g.name: g.constant for g in net.globals if g.constant is not None}
        self._references = frozenset(g.name for g in net.globals if g.is_reference)
        self._follows_ranges = net.has_successors

    def transition(self, t: ir.Transition) -> ir.Transition:
        """The transition, with its takes and puts marked."""
        tables = known_tables(t)
        takes = [s for s in t.fire if isinstance(s, ir.Take)]
        return replace(t, fire=tuple(self._statements(t.fire, tables, takes)))

    def _statements(
        self, statements: Iterable[ir.Stmt], tables: tuple[str, ...], takes: list[ir.Take]
    ) -> Iterable[ir.Stmt]:
        """`tables`: of each variable the key of its descriptor, "" where its value is not known to be of it."""
        for s in statements:
            match s:
                case ir.Take():
                    yield replace(s, is_found=_is_found(s.value, self._references))
                case ir.Put():
                    yield replace(s, is_legal=self._is_legal(s, tables, takes))
                case ir.If():
                    then, otherwise = (
                        tuple(self._statements(way, tables, takes)) for way in (s.then, s.otherwise)
                    )
                    yield replace(s, then=then, otherwise=otherwise)
                case _:
                    yield s

    def _is_legal(self, s: ir.Put, tables: tuple[str, ...], takes: list[ir.Take]) -> bool:
        """Whether the value is of the place's colour set, or the very one that is taken from a place of it."""
        table = self._places[s.place].table
        return self._is_within(s.value, table, tables) or any(
            self._places[t.place].table == table and t.value == s.value for t in takes
        )

    def _is_within(self, value: ir.Ir, table: str, tables: tuple[str, ...]) -> bool:
        """Whether a value is of a colour set: all values of its type are, or it is put together from variables."""
        if not is_restricted(self._descriptors, table):
            return True
        if isinstance(value, ir.Bound):
            return tables[value.index] == table
        own = self._descriptors[table]
        number = self._number(value)
        if number is not None and own.low is not None and own.high is not None:
            return not own.member and own.low <= number <= own.high
        if self._follows_ranges and own.type == ir.INT and not own.member:
            found = Ranges(self._descriptors, self._constants, tables).of(value)
            if found is not None and own.low is not None and own.high is not None:
                return own.low <= found[0] and found[1] <= own.high
        if not isinstance(value, ir.MakeStruct) or own.member:
            return False
        parts = dict(own.fields)
        return all(
            label in parts and self._is_within(part, parts[label], tables)
            for label, part in value.fields
        )

    def _number(self, value: ir.Ir) -> int | None:
        """The integer that a value always is; None: not known, or it is none."""
        known = self._constants.get(value.name) if isinstance(value, ir.GlobalUse) else value
        if not isinstance(known, ir.Const) or known.type != ir.INT:
            return None
        return known.value if isinstance(known.value, int) else None


def _is_found(value: ir.Ir, references: Container[str]) -> bool:
    """Whether a value that is taken is the one that the search has bound or compared.

    What is worked out anew may be something else (random numbers, files, references), but for `()`.
    """
    return value.type.rep is ir.Rep.UNIT or _is_structural(value, references)


def _is_structural(value: ir.Ir, references: Container[str]) -> bool:
    """Whether a value is put together from constants and variables alone: each evaluation gives the same."""
    match value:
        case ir.Const() | ir.EnumValue() | ir.Bound():
            return True
        case ir.GlobalUse(name=name):
            return name not in references
        case ir.MakeStruct(fields=fields):
            return all(_is_structural(part, references) for _, part in fields)
        case ir.MakeUnion(argument=argument):
            return argument is None or _is_structural(argument, references)
        case ir.Op(name="list.cons", arguments=arguments):
            return all(_is_structural(part, references) for part in arguments)
    return False
