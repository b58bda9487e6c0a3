"""What pieces of IR come to, themselves or in the functions that they call: references, random numbers, files."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache

from pn2code.ir import nodes as ir
from pn2code.ir.calls import called, ir_nodes
from pn2code.ir.nodes import Rep
from pn2code.lowering.expressions.purity import is_impure_builtin


class Reach:
    """Of a net. `nodes` are pieces of IR, as `ir_nodes` gives them; those who ask several questions make a list."""

    def __init__(self, net: ir.NetIR) -> None:
        self._functions = net.functions
        self._calls = {f.key: called(f.body) for f in net.functions}
        self._reaching: dict[object, set[str]] = {}
        self._references = {g.name for g in net.globals if g.is_reference}
        self._looked_at: dict[int, tuple[object, tuple[object, ...]]] = {}
        """by id, with what has it"""

    def nodes(self, program: tuple[ir.Stmt, ...]) -> tuple[object, ...]:
        """All pieces of a program of the net, which several passes ask for."""
        found = self._looked_at.get(id(program))
        if found is None:
            found = self._looked_at[id(program)] = program, tuple(ir_nodes(program))
        return found[1]

    def is_pure(self, nodes: Iterable[object]) -> bool:
        """Whether nothing but the binding and the marking decides: no references, random numbers, step()."""
        return not self.reaches(nodes, self._is_impure)

    def looks(self, nodes: Iterable[object]) -> bool:
        """Whether more than the binding, the marking and the stream of random numbers decides."""
        return self.reaches(nodes, self._is_look)

    def looks_outside(self, nodes: Iterable[object]) -> bool:
        """The same without references: whether it may be another time what it is now, in the same state."""
        return self.reaches(nodes, _is_outside)

    def assigns(self, nodes: Iterable[object]) -> bool:
        """Whether it changes what a reference holds that may outlive the evaluation."""
        return self.reaches(nodes, is_assignment)

    def draws(self, nodes: Iterable[object]) -> bool:
        """Whether it takes numbers from the stream of random numbers."""
        return self.reaches(nodes, _is_draw)

    def reaches(self, nodes: Iterable[object], what: Callable[[object], bool]) -> bool:
        """Whether something of a kind is among the pieces, or in a function that is called."""
        reaching = self._functions_reaching(what)
        return any(what(n) or (isinstance(n, ir.FunCall) and n.function in reaching) for n in nodes)

    def all_nodes(self, nodes: Iterable[object]) -> list[object]:
        """The pieces, and all in the functions that they call."""
        bodies = {f.key: f.body for f in self._functions}
        found = list(nodes)
        waiting = [n.function for n in found if isinstance(n, ir.FunCall)]
        known: set[str] = set()
        while waiting:
            key = waiting.pop()
            if key not in known:
                known.add(key)
                found += ir_nodes(bodies[key])
                waiting += self._calls[key]
        return found

    def impure(self) -> frozenset[str]:
        """The functions that are not pure, by key."""
        return frozenset(self._functions_reaching(self._is_impure))

    def _functions_reaching(self, what: Callable[[object], bool]) -> set[str]:
        kind = getattr(what, "__func__", what)  # not what is kept here, if it is its own method
        if kind not in self._reaching:
            found = {f.key for f in self._functions if any(map(what, ir_nodes(f.body)))}
            more = found
            while more:
                more = {
                    key
                    for key, calls in self._calls.items()
                    if key not in found and not found.isdisjoint(calls)
                }
                found |= more
            self._reaching[kind] = found
        return self._reaching[kind]

    def _is_impure(self, node: object) -> bool:
        is_step = isinstance(node, ir.Op) and node.name == "Time.step"
        return is_step or _is_draw(node) or self._is_look(node)

    def _is_look(self, node: object) -> bool:
        match node:
            case ir.Op():
                return _is_outside(node)
            case ir.Contents() | ir.AddressOf():
                return True
            case ir.GlobalUse(name=name):
                return name in self._references
        return False


_DECIDING = (
    ir.FunCall,
    ir.Fill,
    ir.Contents,
    ir.AddressOf,
    ir.GlobalUse,
    ir.SetGlobal,
    ir.SetContents,
)


def deciding(nodes: Iterable[object]) -> list[object]:
    """Those of the pieces that decide what `Reach` answers, for those who ask several questions: they are few."""
    return [
        n for n in nodes if isinstance(n, _DECIDING) or (isinstance(n, ir.Op) and _decides(n.name))
    ]


@cache
def _decides(operation: str) -> bool:
    return is_impure_builtin(operation) or _is_draw_of(operation) or operation == "Time.step"


def _is_outside(node: object) -> bool:
    """Whether a piece of IR looks at files or clocks."""
    return isinstance(node, ir.Op) and is_impure_builtin(node.name) and not _is_draw(node)


def is_assignment(node: object) -> bool:
    """Whether a piece of IR changes what a reference holds that may outlive the evaluation."""
    if isinstance(node, ir.SetGlobal):
        return node.is_reference
    return isinstance(node, ir.SetContents) and node.reference.type.rep is Rep.REF


def _is_draw(node: object) -> bool:
    """Whether a piece of IR takes numbers from the stream of random numbers."""
    if isinstance(node, ir.Op):
        return _is_draw_of(node.name)
    return isinstance(node, ir.Fill) and node.name == "ran"


def _is_draw_of(operation: str) -> bool:
    return operation.startswith(("Random.", "prim.do_random")) or operation == "Ms.random"
