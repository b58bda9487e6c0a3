"""Arithmetic that cannot overflow: in explorers it is C's own, without a test after each operation.

`with_ranges` follows the least and the greatest value of an integer from variables of small colour sets and constants:
with `k` in 0..3 it is `b->k + 2`, not `pn_int_add(cx, b->k, 2)`. That is less to compile, and less to do. Nothing is
taken to be known of the variables that a code segment gives, nor of parameters and references.

A variable has a value of its colour set wherever the search has found a binding (`checks` rests on that, too); in a
search that looks at values one by one (`UnlessLegal`) only those of other variables are known.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes, parts_of
from pn2code.ir.types import Descriptor

Range = tuple[int, int]
"""The least and the greatest value."""
LEAST, MOST = -(2**30), 2**30 - 1
"""What `int` has room for where it is narrowest; the product of two such numbers is no more than C has room for."""
EXACT = {"Int.+": "exact.+", "Int.-": "exact.-", "Int.*": "exact.*", "Int.~": "exact.~"}
"""The operations of C that are the same as long as nothing overflows."""
DIVISIONS = {"Int.div": "exact.div", "Int.mod": "exact.mod"}
"""Those that are the same for what is not negative, divided by what is positive."""

_OVERFLOWING = frozenset({*EXACT, *DIVISIONS})


def _may_overflow(node: object) -> bool:
    return node.__class__ is ir.Op and node.name in _OVERFLOWING


def with_ranges(net: ir.NetIR) -> ir.NetIR:
    """The net, with what this pass finds; `constant` of the globals is known."""
    if not net.has_successors:
        return net
    descriptors = {d.name: d for d in net.descriptors}
    constants = {g.name: g.constant for g in net.globals if g.constant is not None}

    def transition(t: ir.Transition) -> ir.Transition:
        tables = known_tables(t)
        tried = {n.variable for n in ir_nodes(t.enumerate) if isinstance(n, ir.UnlessLegal)}
        searched = tuple("" if i in tried else table for i, table in enumerate(tables))
        search = Ranges(descriptors, constants, searched)
        occurrence = Ranges(descriptors, constants, tables)
        return replace(
            t, enumerate=search.rewritten(t.enumerate), fire=occurrence.rewritten(t.fire)
        )

    return replace(net, transitions=tuple(map(transition, net.transitions)))


def known_tables(t: ir.Transition) -> tuple[str, ...]:
    """Of each variable the key of its colour set, if a binding always has a value of that; "": it is not known."""
    return tuple("" if v.is_output else v.table for v in t.variables)


class Ranges:
    """Of the integers in a program.

    Args:
        descriptors: of all types and colour sets.
        constants: `val`s that always are the same.
        tables: of each variable the key of the colour set that its value is known to be of, or "".
    """

    def __init__(
        self,
        descriptors: Mapping[str, Descriptor],
        constants: Mapping[str, ir.Const],
        tables: Sequence[str],
    ) -> None:
        self._descriptors, self._constants, self._tables = descriptors, constants, tables

    def rewritten(self, node: Any) -> Any:
        """Statements, or a value, with operations that cannot overflow."""
        return self._rewritten(node) if any(map(_may_overflow, ir_nodes(node))) else node

    def _rewritten(self, node: Any) -> Any:
        if isinstance(node, tuple):
            return tuple(map(self._rewritten, node))
        if not parts_of(node):
            return node
        changed = {}
        for name in _names(node.__class__):
            old = getattr(node, name)
            new = self._rewritten(old)
            if new is not old and new != old:
                changed[name] = new
        if changed:
            node = replace(node, **changed)
        return self._operation(node) if isinstance(node, ir.Op) else node

    def _operation(self, e: ir.Op) -> ir.Op:
        if e.name in EXACT:
            return replace(e, name=EXACT[e.name]) if self._result(e) is not None else e
        if e.name in DIVISIONS:
            divided, divisor = map(self.of, e.arguments)
            if divided is not None and divisor is not None and divided[0] >= 0 and divisor[0] > 0:
                return replace(e, name=DIVISIONS[e.name])
        return e

    def _result(self, e: ir.Op) -> Range | None:
        """That of an operation none of whose results overflows."""
        parts = [self.of(a) for a in e.arguments]
        if any(part is None for part in parts):
            return None
        ends = [part for part in parts if part is not None]
        match e.name.rpartition(".")[2], ends:
            case "+", [(a, b), (c, d)]:
                found = a + c, b + d
            case "-", [(a, b), (c, d)]:
                found = a - d, b - c
            case "*", [(a, b), (c, d)]:
                products = a * c, a * d, b * c, b * d
                found = min(products), max(products)
            case "~", [(a, b)]:
                found = -b, -a
            case _:
                return None
        return found if found[0] >= LEAST and found[1] <= MOST else None

    def of(self, e: ir.Ir) -> Range | None:
        """The range of an integer; None: it is not known, or it is none."""
        if e.type != ir.INT:
            return None
        match e:
            case ir.Const(value=int(value)):
                return (value, value) if LEAST <= value <= MOST else None
            case ir.GlobalUse(name=name) if name in self._constants:
                return self.of(self._constants[name])
            case ir.Select(_, then, otherwise):
                one, other = self.of(then), self.of(otherwise)
                if one is None or other is None:
                    return None
                return min(one[0], other[0]), max(one[1], other[1])
            case ir.Op(name="exact.div", arguments=(divided, _)):
                found = self.of(divided)
                return None if found is None else (0, found[1])
            case ir.Op(name="exact.mod", arguments=(_, divisor)):
                found = self.of(divisor)
                return None if found is None else (0, found[1] - 1)
            case ir.Op() if e.name in EXACT.values():
                return self._result(e)
            case ir.Bound() | ir.Member():
                return self._of_table(self._table(e))
        return None

    def _table(self, e: ir.Ir) -> str:
        """The key of the colour set that a value is known to be of; "": it is not known."""
        match e:
            case ir.Bound(index=index):
                return self._tables[index]
            case ir.Member(record, label):
                of_record = self._table(record)
                return dict(self._descriptors[of_record].fields).get(label, "") if of_record else ""
        return ""

    def _of_table(self, table: str) -> Range | None:
        if not table:
            return None
        d = self._descriptors[table]
        low, high = d.low, d.high
        if d.type != ir.INT or d.is_index or not isinstance(low, int) or not isinstance(high, int):
            return None
        return (low, high) if low >= LEAST and high <= MOST else None


@cache
def _names(kind: type) -> tuple[str, ...]:
    """The fields of a node that may contain nodes."""
    return tuple(f.name for f in dataclasses.fields(kind))
