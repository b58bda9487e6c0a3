"""What of a transition does not depend on which places its arcs lead to: equal shapes, equal behaviour.

Shapes are compared exactly. Two are equal only if guards, inscriptions, code segment, delay, priority and the order in
which all of this is evaluated are the same, and so are the net variables, and the declared names that are used. Arcs
that only put tokens, inhibit or clear are in no order, if their inscriptions neither read nor change references: what
they do is done together. What an inscription declares for itself (the `x` of `fn x => ..`) may be another symbol of the
same name and type, as it is on a page that was drawn twice.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Hashable, Iterable
from functools import cache
from typing import Any

from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import ArcKind, BindTerm, FlatArc, FlatNet, FlatTransition
from pn2code.semantics.evaluation.effects import Effect, effects_of

_HELD = frozenset({Effect.READ, Effect.WRITE})
"""What makes the order of two arcs matter: one may read what the other one has changed."""


class Shapes:
    """The shapes of a net's transitions, as numbers: equal numbers, equal shapes."""

    def __init__(self, net: FlatNet) -> None:
        self._numbers: dict[Hashable, int] = {}
        self._known: dict[int, tuple[object, Hashable]] = {}
        """By identity: page instances share their inscriptions. The object is kept, so that its identity is its own."""
        self._effects = effects_of(net.program)
        variables = {s.uid for t in net.transitions for s in t.variables}
        self._fixed = variables | {s.uid for s in net.program.variables.values()}

    def of(self, t: FlatTransition) -> tuple[int, tuple[int, ...]]:
        """The number of a transition's shape, without its arcs, and that of each arc, without its place.

        Arcs of one number may stand for each other.
        """
        ranks: dict[int, int] = {}
        arcs = tuple(self._arc(i, a, ranks) for i, a in enumerate(t.arcs))
        plan = tuple(
            (ranks[s.arc], s.term) if isinstance(s, BindTerm) else self._one(s) for s in t.plan
        )
        shape = (
            tuple(s.uid for s in t.variables),
            self._all(t.guards),
            plan,
            self._one(t.delay),
            self._one(t.code),
            t.priority,
            t.role.value,
        )
        return self._number(shape), arcs

    def _arc(self, index: int, a: FlatArc, ranks: dict[int, int]) -> int:
        """Of one; `ranks` gets its position among those that have an order."""
        is_free = a.kind not in (ArcKind.INPUT, ArcKind.BOTH)
        if a.inscription is not None and not _HELD.isdisjoint(
            self._effects.of(a.inscription.value)
        ):
            is_free = False
        if not is_free:
            ranks[index] = len(ranks)
        return self._number((a.kind.value, ranks.get(index, -1), self._one(a.inscription)))

    def _number(self, shape: Hashable) -> int:
        return self._numbers.setdefault(shape, len(self._numbers))

    def _all(self, nodes: Iterable[object]) -> tuple[Hashable, ...]:
        return tuple(self._one(node) for node in nodes)

    def _one(self, node: object) -> Hashable:
        if node is None:
            return None
        known = self._known.get(id(node))
        if known is None:
            known = self._known[id(node)] = (node, texture(node, self._named))
        return known[1]

    def _named(self, s: Symbol) -> Hashable:
        return ("symbol", s.uid) if s.is_global or s.uid in self._fixed else None


def texture(node: object, named: Callable[[Symbol], Hashable]) -> Hashable:
    """All of a node in one order, without recursion, since texts may be long.

    Args:
        node: an expression, or something made of expressions.
        named: what a symbol stands for; None: it is declared in the node, and another one may stand in its stead.
    """
    own: dict[int, int] = {}
    found: list[Hashable] = []
    waiting: list[Any] = [node]
    while waiting:
        item = waiting.pop()
        if isinstance(item, tuple):
            found.append(("tuple", len(item)))
            waiting += reversed(item)
        elif isinstance(item, Symbol):
            number = (own.setdefault(item.uid, len(own)), item.type)
            found.append(named(item) or ("own", *number, item.generics, item.first_generic))
        elif isinstance(item, Colset):
            found.append(("colset", item.name, item))
        elif fields := compared(item.__class__):
            found.append(type(item).__name__)
            waiting += [getattr(item, name) for name in reversed(fields)]
        else:  # -0.0 is equal to 0.0, and not the same; nor are 1, 1.0 and True
            found.append((type(item).__name__, repr(item)))
    return tuple(found)


@cache
def compared(kind: type) -> tuple[str, ...]:
    """The fields of a node that say what it means; () for what is none."""
    if not dataclasses.is_dataclass(kind):
        return ()
    return tuple(
        f.name for f in dataclasses.fields(kind) if f.compare and f.name not in ("origin", "span")
    )
