"""Which values of IR statements somebody looks at when they are printed as C."""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes, parts_of
from pn2code.ir.nodes import Ir, Rep, Stmt


def does_nothing(value: Ir) -> bool:
    """Whether a value need not be computed when nobody looks at it."""
    return not any(
        isinstance(n, (ir.FunCall, ir.NewRef))
        or (isinstance(n, ir.Op) and n.name not in ("zero", "list.nil"))
        for n in ir_nodes(value)
    )


def is_plain(s: ir.SetContents) -> bool:
    """Whether it assigns to a variable in C, not to what a pointer points to."""
    return isinstance(s.reference, ir.Use) and (
        s.reference.type.rep is not Rep.REF or s.value.type == s.reference.type
    )


def used_locals(statements: tuple[Stmt, ...]) -> frozenset[int]:
    """The locals whose values are looked at by what is printed."""
    used: frozenset[int] | None = None
    while True:
        found = frozenset(_used(statements, used))
        if found == used:
            return found
        used = found


def _used(item: object, known: frozenset[int] | None) -> Iterator[int]:
    """`known`: the locals that are used as far as is known; what goes to others is not looked at."""
    waiting = [item]
    while waiting:
        item = waiting.pop()
        match item:
            case tuple():
                waiting.extend(item)
                continue
            case ir.Use(local=local):
                if local.type.rep is not Rep.UNIT:  # which has no variable
                    yield local.uid
            case ir.Let(local=local, value=value) | ir.Assign(local=local, value=value) if (
                known is not None and local.uid not in known and does_nothing(value)
            ):
                continue
            case ir.Do(value=value) if does_nothing(value):
                continue
            case ir.If(then=(), otherwise=()):
                continue
            case ir.SetContents(reference=ir.Use(local=local), value=value) if is_plain(item):
                if known is None or local.uid in known or not does_nothing(value):
                    waiting.append(value)
                continue
            case ir.SetContents(value=value) if value.type.rep is Rep.UNIT:
                if not does_nothing(value):
                    waiting.append(value)
                continue
            case ir.Fill(local=local):
                yield local.uid
            case ir.ForList(until=until) if until is not None:
                yield until.uid
        waiting.extend(parts_of(item))
