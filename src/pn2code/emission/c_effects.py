"""What an occurrence can change about what is enabled: for the hosts, that look again only where they must."""

from __future__ import annotations

from collections.abc import Callable

from pn2code.emission.c_places import staying_pairs
from pn2code.lowering import ir
from pn2code.lowering.calls import called, ir_nodes
from pn2code.lowering.functions import is_impure_builtin

_EXAMINED = (
    ir.ForTokens, ir.TokenValue, ir.UnlessAvailable, ir.UnlessHeld, ir.UnlessEmpty, ir.Take, ir.TakeAll,
)  # fmt: skip
_CHANGED = (ir.Take, ir.TakeAll, ir.Put, ir.PutAll, ir.Reset)
_READ = (*_EXAMINED, ir.Reset)


class Effects:
    """Of the transitions of a net on each other.

    Args:
        net: the net.
    """

    def __init__(self, net: ir.NetIR) -> None:
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
            for take, put in staying_pairs(t.fire)
            if not net.places[take.place].timed and self.is_pure(take.value)
            for s in (take, put)
        }
        moves = [n for n in ir_nodes(t.fire) if isinstance(n, _CHANGED) and id(n) not in staying]
        return frozenset(n.place for n in moves)

    def is_pure(self, item: object) -> bool:
        """Whether nothing but the binding and the marking decides: no references, random numbers, step()."""
        return not self.reaches(item, self._is_impure)

    def looks(self, item: object) -> bool:
        """Whether more than the binding, the marking and the stream of random numbers decides."""
        return self.reaches(item, self._is_look)

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
            case ir.Op(name=name):
                return is_impure_builtin(name) and not is_draw(node)
            case ir.Contents() | ir.AddressOf():
                return True
            case ir.GlobalUse(name=name):
                return name in self._references
        return False


def is_draw(node: object) -> bool:
    """Whether a piece of IR takes numbers from the stream of random numbers."""
    if isinstance(node, ir.Op):
        return node.name.startswith(("Random.", "prim.do_random")) or node.name == "Ms.random"
    return isinstance(node, ir.Fill) and node.name == "ran"


def _places(statements: tuple[ir.Stmt, ...], kinds: tuple[type, ...]) -> frozenset[int]:
    return frozenset(n.place for n in ir_nodes(statements) if isinstance(n, kinds))  # type: ignore[attr-defined]
