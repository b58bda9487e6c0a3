"""What an occurrence can change about what is enabled: for the hosts, that look again only where they must."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from pn2code.emission.c_places import staying_pairs
from pn2code.lowering import ir
from pn2code.lowering.calls import called, ir_nodes
from pn2code.lowering.functions import is_impure_builtin

_EXAMINED = (
    ir.ForTokens, ir.TokenValue, ir.UnlessAvailable, ir.UnlessHeld, ir.UnlessEmpty, ir.Take, ir.TakeAll,
)  # fmt: skip
_CHANGED = (ir.Take, ir.TakeAll, ir.Put, ir.PutAll, ir.Reset)


class Effects:
    """Of the transitions of a net on each other.

    Args:
        net: the net.
    """

    def __init__(self, net: ir.NetIR) -> None:
        self._functions: Mapping[str, ir.Function] = {f.key: f for f in net.functions}
        self._references = {g.name for g in net.globals if g.is_reference}
        self._examined = [_places(t.enumerate, _EXAMINED) for t in net.transitions]
        self._changed = [self._changed_by(net, t) for t in net.transitions]
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
        return not reaches(self._functions, item, self._is_impure)

    def _is_impure(self, node: object) -> bool:
        match node:
            case ir.Op(name=name):
                return is_impure_builtin(name) or name == "Time.step"
            case ir.Contents() | ir.AddressOf():
                return True
            case ir.GlobalUse(name=name):
                return name in self._references
            case ir.Fill(name=name):
                return name == "ran"
        return False


def _places(statements: tuple[ir.Stmt, ...], kinds: tuple[type, ...]) -> frozenset[int]:
    return frozenset(n.place for n in ir_nodes(statements) if isinstance(n, kinds))  # type: ignore[attr-defined]


def reaches(
    functions: Mapping[str, ir.Function], item: object, what: Callable[[object], bool]
) -> bool:
    """Whether there is something of a kind in IR, directly or in a function that is called."""
    waiting: list[object] = [item]
    seen: set[str] = set()
    while waiting:
        body = waiting.pop()
        if any(map(what, ir_nodes(body))):
            return True
        calls = [key for key in called(body) if key not in seen]  # type: ignore[arg-type]
        seen.update(calls)
        waiting += [functions[key].body for key in calls]
    return False
