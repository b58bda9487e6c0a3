"""What an occurrence can change about what is enabled: for the hosts, that look again only where they must."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

from pn2code.ir import nodes as ir
from pn2code.ir.calls import called, ir_nodes
from pn2code.ir.nodes import Rep
from pn2code.lowering.expressions.purity import is_impure_builtin

_EXAMINED = (
    ir.ForTokens, ir.TokenValue, ir.UnlessAvailable, ir.UnlessHeld, ir.UnlessEmpty, ir.Take, ir.TakeAll,
)  # fmt: skip
_CHANGED = (ir.Take, ir.TakeAll, ir.Put, ir.PutAll, ir.Reset)
_READ = (*_EXAMINED, ir.Reset)


class Effects:
    """Of the transitions of a net on each other.

    Args:
        net: the net.
        holds_reference: whether there may be cells of references in a value of the type.
    """

    def __init__(
        self, net: ir.NetIR, holds_reference: Callable[[ir.IrType], bool] = lambda t: False
    ) -> None:
        self._net = net
        self._holds_reference = holds_reference
        self._functions = net.functions
        self._calls = {f.key: called(f.body) for f in net.functions}
        self._reaching: dict[Callable[[object], bool], set[str]] = {}
        self._references = {g.name for g in net.globals if g.is_reference}
        self._examined = [_places(t.enumerate, _EXAMINED) for t in net.transitions]
        self._changed = [self._changed_by(net, t) for t in net.transitions]
        self._read = [_places((*t.enumerate, *t.fire), _READ) for t in net.transitions]
        self._volatile = [not self.is_pure(t.enumerate) for t in net.transitions]

    def affected(self, transition: int) -> tuple[int, ...]:
        """The transitions that may be enabled in another way after an occurrence of this one, in order."""
        return tuple(
            i
            for i, places in enumerate(self._examined)
            if self._volatile[i] or places & self._changed[transition]
        )

    def touched(self, transition: int) -> tuple[int, ...]:
        """The places whose tokens an occurrence of this transition may change, in order."""
        return tuple(sorted(self._changed[transition]))

    def read(self, transition: int) -> tuple[int, ...]:
        """The places whose tokens decide, with the time, which occurrences there are and what each takes and puts, in
        order; places in which it only puts tokens are not among them."""
        return tuple(sorted(self._read[transition]))

    def _changed_by(self, net: ir.NetIR, t: ir.Transition) -> frozenset[int]:
        """The places whose tokens are others after the occurrence: what stays where it is does not count."""
        staying = {
            id(s)
            for position, other in t.staying
            if isinstance(take := t.fire[position], ir.Take)
            and not net.places[take.place].timed
            and self.is_pure(take.value)
            for s in (take, t.fire[other])
        }
        moves = [n for n in ir_nodes(t.fire) if isinstance(n, _CHANGED) and id(n) not in staying]
        return frozenset(n.place for n in moves)

    def is_pure(self, item: object) -> bool:
        """Whether nothing but the binding and the marking decides: no references, random numbers, step()."""
        return not self.reaches(item, self._is_impure)

    def looks(self, item: object) -> bool:
        """Whether more than the binding, the marking and the stream of random numbers decides."""
        return self.reaches(item, self._is_look)

    def looks_outside(self, item: object) -> bool:
        """The same without references: whether it may be another time what it is now, in the same state."""
        return self.reaches(item, is_outside)

    @cached_property
    def roots(self) -> tuple[ir.Global, ...]:
        """The variables that are state besides the marking, in order.

        Those that transitions assign; and if they assign any, or the contents of any cell, all through which cells are
        reached, and all of which the address is known to others.
        """
        nodes = self._reached(
            tuple((t.enumerate, t.fire, t.thresholds) for t in self._net.transitions)
        )
        if not any(map(is_assignment, nodes)):
            return ()
        assigned = {n.name for n in nodes if isinstance(n, ir.SetGlobal) and n.is_reference}
        everywhere = (self._net.functions, self._net.globals, self._net.transitions)
        assigned |= {n.name for n in ir_nodes(everywhere) if isinstance(n, ir.AddressOf)}
        return tuple(
            g for g in self._net.globals if g.name in assigned or self._holds_reference(g.type)
        )

    def _reached(self, item: object) -> list[object]:
        """All pieces of IR in it and in the functions that it calls."""
        bodies = {f.key: f.body for f in self._functions}
        found: list[object] = list(ir_nodes(item))
        waiting = [n.function for n in found if isinstance(n, ir.FunCall)]
        known: set[str] = set()
        while waiting:
            key = waiting.pop()
            if key not in known:
                known.add(key)
                found += ir_nodes(bodies[key])
                waiting += self._calls[key]
        return found

    def reaches(self, item: object, what: Callable[[object], bool]) -> bool:
        """Whether there is something of a kind in IR, directly or in a function that is called."""
        reaching = self._functions_reaching(what)
        return any(
            what(n) or (isinstance(n, ir.FunCall) and n.function in reaching)
            for n in ir_nodes(item)
        )

    def _functions_reaching(self, what: Callable[[object], bool]) -> set[str]:
        if what not in self._reaching:
            found = {f.key for f in self._functions if any(map(what, ir_nodes(f.body)))}
            more = found
            while more:
                more = {
                    key
                    for key, calls in self._calls.items()
                    if key not in found and not found.isdisjoint(calls)
                }
                found |= more
            self._reaching[what] = found
        return self._reaching[what]

    def _is_impure(self, node: object) -> bool:
        is_step = isinstance(node, ir.Op) and node.name == "Time.step"
        return is_step or is_draw(node) or self._is_look(node)

    def _is_look(self, node: object) -> bool:
        match node:
            case ir.Op():
                return is_outside(node)
            case ir.Contents() | ir.AddressOf():
                return True
            case ir.GlobalUse(name=name):
                return name in self._references
        return False


def is_outside(node: object) -> bool:
    """Whether a piece of IR looks at files or clocks."""
    return isinstance(node, ir.Op) and is_impure_builtin(node.name) and not is_draw(node)


def is_assignment(node: object) -> bool:
    """Whether a piece of IR changes what a reference holds that may outlive the evaluation."""
    if isinstance(node, ir.SetGlobal):
        return node.is_reference
    return isinstance(node, ir.SetContents) and node.reference.type.rep is Rep.REF


def is_draw(node: object) -> bool:
    """Whether a piece of IR takes numbers from the stream of random numbers."""
    if isinstance(node, ir.Op):
        return node.name.startswith(("Random.", "prim.do_random")) or node.name == "Ms.random"
    return isinstance(node, ir.Fill) and node.name == "ran"


def _places(statements: tuple[ir.Stmt, ...], kinds: tuple[type, ...]) -> frozenset[int]:
    return frozenset(n.place for n in ir_nodes(statements) if isinstance(n, kinds))  # type: ignore[attr-defined]
