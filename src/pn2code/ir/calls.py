"""Which function calls which: what is used, in what order functions are declared, and which of them are recursive."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from operator import attrgetter
from typing import Any

from pn2code.ir import nodes as ir


def called(item: object) -> list[str]:
    """The keys of the functions that statements, or whatever else of the IR, call, in order of first use."""
    found: dict[str, None] = {}
    for node in ir_nodes(item):
        if isinstance(node, ir.FunCall):
            found.setdefault(node.function)
    return list(found)


def ir_nodes(item: object) -> Iterator[object]:
    """All IR nodes in a statement, expression or tuple of them; types are none."""
    # The innermost loop of all passes: what is known of classes is looked up without a call.
    waiting: list[Any] = [item]
    following, known = waiting.pop, _KNOWN
    while waiting:
        node = following()
        kind = node.__class__
        if kind is tuple:
            waiting += node[::-1]
            continue
        parts = known[kind]
        if parts is not None:
            yield node
            if parts is not _nothing:
                waiting += parts(node)


_VALUE = "bool | int | float | str | None"
_PAIRS = "tuple[tuple[int, int], ...]"
_LEAVES = frozenset(
    {"Effects", "IrType", "Origin", "bool", "int", "str", "tuple[int, ...]", _PAIRS, _VALUE}
)
"""What the annotations of fields say in which there is no node."""


def parts_of(node: Any) -> Sequence[object]:
    """The fields of a node that may contain nodes, from the last to the first; nothing for what is no node."""
    getter = _KNOWN[node.__class__]
    return () if getter is None else getter(node)


def _parts(kind: type) -> Callable[[Any], Sequence[Any]] | None:
    """What gives the fields of a node that may contain nodes, from the last to the first; None for what is no node."""
    fields = getattr(kind, "__dataclass_fields__", {})
    if not fields:
        return None
    names = tuple(reversed([name for name, f in fields.items() if f.type not in _LEAVES]))
    match names:
        case ():
            return _nothing
        case (name,):
            return lambda node: (getattr(node, name),)
        case _:
            return attrgetter(*names)


def _nothing(_node: object) -> tuple[()]:
    """The parts of a node that has none."""
    return ()


class _Known(dict[type, Callable[[Any], Sequence[Any]] | None]):
    """What `_parts` says of a class, asked once."""

    def __missing__(self, kind: type) -> Callable[[Any], Sequence[Any]] | None:
        found = self[kind] = _parts(kind)
        return found


_KNOWN = _Known()


def order_functions(made: dict[str, ir.Function]) -> tuple[ir.Function, ...]:
    """Callees first; functions that call themselves are marked."""
    graph = {key: called(f.body) for key, f in made.items()}
    order: list[str] = []
    components: dict[str, int] = {}
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    recursive: set[str] = set()

    def visit(key: str) -> None:
        index[key] = low[key] = len(index)
        stack.append(key)
        for callee in graph[key]:
            if callee not in index:
                visit(callee)
                low[key] = min(low[key], low[callee])
            elif callee not in components:
                low[key] = min(low[key], index[callee])
        if low[key] == index[key]:
            members = []
            while True:
                member = stack.pop()
                components[member] = index[key]
                members.append(member)
                if member == key:
                    break
            order.extend(reversed(members))
            if len(members) > 1 or key in graph[key]:
                recursive.update(members)

    for key in sorted(made):
        if key not in index:
            visit(key)
    result = []
    for key in order:
        f = made[key]
        is_recursive = key in recursive
        result.append(
            ir.Function(
                f.key,
                f.hint,
                f.parameters,
                f.result,
                f.body,
                f.loops and not is_recursive,
                is_recursive,
                f.source,
                f.origin,
            )  # fmt: skip
        )
    return tuple(result)
