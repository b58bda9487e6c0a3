"""Long branches become procedures, so that the decision they hang on can be read at a glance.

A branch is moved when it is long and nothing jumps into it or out of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import field

from pn2code.base.frozen import record
from pn2code.robot_scripts.ir import Chain, Line, Node, Region, Repeat
from pn2code.tdl import tree as t

LONG = 20
"""A branch of more lines than this becomes a procedure."""

Procedures = tuple[tuple[str, tuple[Node, ...]], ...]


def extract(
    nodes: Iterable[Node], name: Callable[[Region], str]
) -> tuple[tuple[Node, ...], Procedures]:
    """The nodes with calls in place of long branches, and the procedures in order of their first call.

    `name` gives a new name from the net element a branch begins with.
    """
    extractor = _Extractor(name)
    body = extractor.nodes(nodes)
    return body, tuple(extractor.procedures)


def length(nodes: Iterable[Node]) -> int:
    """How many lines of statements."""
    total = 0
    for node in nodes:
        match node:
            case Line():
                total += 1
            case Chain(branches, otherwise):
                total += 1 + sum(1 + length(b) for _, b in branches)
                total += 1 + length(otherwise) if otherwise else 0
            case Repeat(body=body):
                total += 2 + length(body)
            case Region(body=body):
                total += length(body)
            case _:
                pass
    return total


@record
class _Extractor:
    name: Callable[[Region], str]
    procedures: list[tuple[str, tuple[Node, ...]]] = field(default_factory=list)

    def nodes(self, nodes: Iterable[Node]) -> tuple[Node, ...]:
        return tuple(self.node(n) for n in nodes)

    def node(self, node: Node) -> Node:
        match node:
            case Chain(branches, otherwise):
                return Chain(
                    tuple((c, self.branch(b)) for c, b in branches),
                    None if otherwise is None else self.branch(otherwise),
                )
            case Repeat(condition, body):
                return Repeat(condition, self.nodes(body))
            case Region(element, kind, origin, body):
                return Region(element, kind, origin, self.nodes(body))
            case _:
                return node

    def branch(self, body: tuple[Node, ...]) -> tuple[Node, ...]:
        inner = self.nodes(body)
        first = next((n for n in inner if isinstance(n, Region)), None)
        if length(inner) <= LONG or first is None or _jumps(inner, inside_loop=False):
            return inner
        name = self.name(first)
        self.procedures.append((name, inner))
        return (Line(t.Call(t.Target(name))),)


def _jumps(nodes: Iterable[Node], *, inside_loop: bool) -> bool:
    """Whether control enters or leaves the nodes other than from the top to the bottom (or by `stop`)."""
    for node in nodes:
        match node:
            case Line(t.Goto() | t.Label() | t.Return()):
                return True
            case Line(t.Exit()) if not inside_loop:
                return True
            case Chain(branches, otherwise):
                if any(_jumps(b, inside_loop=inside_loop) for _, b in branches):
                    return True
                if _jumps(otherwise or (), inside_loop=inside_loop):
                    return True
            case Repeat(body=body):
                if _jumps(body, inside_loop=True):
                    return True
            case Region(body=body):
                if _jumps(body, inside_loop=inside_loop):
                    return True
            case _:
                pass
    return False
