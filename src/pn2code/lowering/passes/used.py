"""Which functions, and which tables of types, come into the program."""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.ir import nodes as ir
from pn2code.ir.calls import called, ir_nodes
from pn2code.ir.operations import op_needs_table
from pn2code.ir.types import closure, holds_reference


class Used:
    """Of a net."""

    def __init__(self, net: ir.NetIR) -> None:
        self._net = net
        self._definitions = {d.name: d for d in net.definitions}
        self._descriptors = {d.name: d for d in net.descriptors}
        self._functions = {f.key: f for f in net.functions}
        self._mentioned: dict[int, frozenset[str]] = {}
        """by id of a body, all of which belong to the net"""

    def functions(self, *, with_predicates: bool) -> list[ir.Function]:
        """Those that are called, or that decide about members of subsets, in order."""
        roots: list[str] = []
        for predicate in self._net.predicates if with_predicates else ():
            roots += called(predicate.body)
        for t in self._net.transitions:
            roots += called(t.enumerate) + called(t.fire) + called(t.thresholds)
        for p in self._net.places:
            roots += called(p.initial)
        for g in self._net.globals:
            roots += called(g.setup)
        found: set[str] = set()
        while True:
            while roots:
                key = roots.pop()
                if key not in found:
                    found.add(key)
                    roots += called(self._functions[key].body)
            functions = [f for f in self._net.functions if f.key in found]
            tables = self.tables(functions, self._net.predicates if with_predicates else ())
            roots = [m for key in tables if (m := self._descriptors[key].member) and m not in found]
            if not roots:
                return functions

    def tables(
        self, functions: Iterable[ir.Function], predicates: Iterable[ir.Predicate] = ()
    ) -> list[str]:
        """Keys in order of dependence."""
        roots = {p.table for p in self._net.places}
        bodies: list[object] = [f.body for f in functions]
        bodies += [p.body for p in predicates]
        for t in self._net.transitions:
            roots |= {v.table for v in t.variables}
            bodies += [t.enumerate, t.fire, t.thresholds]
        bodies += [p.initial for p in self._net.places] + [g.setup for g in self._net.globals]
        roots |= {
            g.table
            for g in self._net.globals
            if g.is_reference or holds_reference(self._definitions, g.type)
        }
        for b in bodies:
            roots |= self._tables_in(b)
        needed = closure(self._descriptors, roots)
        return [key for key in self._descriptors if key in needed]

    def _tables_in(self, body: object) -> frozenset[str]:
        """The tables that a body mentions itself."""
        known = self._mentioned.get(id(body))
        if known is not None:
            return known
        found: set[str] = set()
        for node in ir_nodes(body):
            table = getattr(node, "table", "")
            is_looked_at = not isinstance(node, ir.Op) or op_needs_table(node)
            if isinstance(table, str) and table and is_looked_at:
                found.add(table)
            if isinstance(node, ir.Op) and node.name == "Colset.all":
                found.add(f"type {node.type}")
        self._mentioned[id(body)] = frozenset(found)
        return self._mentioned[id(body)]
