"""Which functions, and which tables of types, come into the program, and what they need of the runtime.

`with_used` writes it into the net (`used`), the places (`refers`) and the variables (`is_held`).
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir
from pn2code.ir.allocating import MAY_ALLOCATE, maker
from pn2code.ir.calls import called, ir_nodes
from pn2code.ir.operations import op_needs_table
from pn2code.ir.types import Rep, closure, holds_reference

_REFERRING = frozenset({Rep.STRING, Rep.LIST, Rep.UNION, Rep.BIG})
"""Representations of values that refer into the arena."""
_FILES = "prim.do_file_"
"""The operations that read and write files."""


def with_used(net: ir.NetIR) -> ir.NetIR:
    """The net, with what this pass finds."""
    definitions = {d.name: d for d in net.definitions}
    descriptors = {d.name: d for d in net.descriptors}

    def refers(p: ir.Place) -> bool:
        return any(descriptors[k].type.rep in _REFERRING for k in closure(descriptors, {p.table}))

    def is_held(g: ir.Global) -> bool:
        return g.is_reference or holds_reference(definitions, g.type)

    net = replace(
        net,
        places=tuple(replace(p, refers=refers(p)) for p in net.places),
        globals=tuple(replace(g, is_held=is_held(g)) for g in net.globals),
    )
    return replace(net, used=_Search(net).run())


class _Search:
    """Of a net."""

    def __init__(self, net: ir.NetIR) -> None:
        self._net = net
        self._files: set[int] = set()
        """ids of bodies that read or write files"""
        self._makers: set[str] = set()
        self._definitions = {d.name: d for d in net.definitions}
        self._descriptors = {d.name: d for d in net.descriptors}
        self._functions = {f.key: f for f in net.functions}
        self._called_in: dict[int, list[str]] = {}
        self._mentioned: dict[int, frozenset[str]] = {}
        """both by id of a body, all of which belong to the net"""

    def run(self) -> ir.Used:
        """What comes into the program, and after all that what the predicates alone need."""
        predicates = self._net.predicates
        functions = self._called(with_predicates=False)
        tables = self._tables(functions)
        known, known_tables = {f.key for f in functions}, set(tables)
        further = [f for f in self._called(with_predicates=True) if f.key not in known]
        further_tables = self._tables([*functions, *further], predicates)
        return ir.Used(
            functions=tuple(f.key for f in functions),
            tables=tuple(tables),
            further_functions=tuple(f.key for f in further),
            further_tables=tuple(k for k in further_tables if k not in known_tables),
            files=bool(self._files),
            makers=tuple(sorted(self._makers)),
        )

    def _called(self, *, with_predicates: bool) -> list[ir.Function]:
        """Those that are called, or that decide about members of subsets, in order."""
        roots: list[str] = []
        for predicate in self._net.predicates if with_predicates else ():
            roots += self._calls_in(predicate.body)
        for t in self._net.transitions:
            roots += [k for b in (t.enumerate, t.fire, t.thresholds) for k in self._calls_in(b)]
        for p in self._net.places:
            roots += self._calls_in(p.initial)
        for g in self._net.globals:
            roots += self._calls_in(g.setup)
        found: set[str] = set()
        while True:
            while roots:
                key = roots.pop()
                if key not in found:
                    found.add(key)
                    roots += self._calls_in(self._functions[key].body)
            functions = [f for f in self._net.functions if f.key in found]
            tables = self._tables(functions, self._net.predicates if with_predicates else ())
            roots = [m for key in tables if (m := self._descriptors[key].member) and m not in found]
            if not roots:
                return functions

    def _calls_in(self, body: object) -> list[str]:
        """The functions that a body calls itself."""
        known = self._called_in.get(id(body))
        if known is None:
            known = self._called_in[id(body)] = called(body)
        return known

    def _tables(
        self, functions: Iterable[ir.Function], predicates: Iterable[ir.Predicate] = ()
    ) -> list[str]:
        """Keys of tables in order of dependence."""
        roots = {p.table for p in self._net.places}
        bodies: list[object] = [f.body for f in functions]
        bodies += [p.body for p in predicates]
        for t in self._net.transitions:
            roots |= {v.table for v in t.variables}
            bodies += [t.enumerate, t.fire, t.thresholds]
        bodies += [p.initial for p in self._net.places] + [g.setup for g in self._net.globals]
        roots |= {g.table for g in self._net.globals if g.is_held}
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
            op = node if isinstance(node, ir.Op) else None
            if table and isinstance(table, str) and (op is None or op_needs_table(op)):
                found.add(table)
            if op is not None:
                if op.name == "Colset.all":
                    found.add(f"type {op.type}")
                if op.name.startswith(_FILES):
                    self._files.add(id(body))
            if node.__class__ in MAY_ALLOCATE and (
                made := maker(node, self._definitions, self._net.int_bits)
            ):
                self._makers.add(made)
        self._mentioned[id(body)] = frozenset(found)
        return self._mentioned[id(body)]
