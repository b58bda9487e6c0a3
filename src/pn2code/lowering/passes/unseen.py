"""Leaves out what nobody looks at: values that do nothing but go to a local that is not read, and what surrounds them.

What an evaluation *does* stays: it may raise an exception, change a reference, write a file. `with_seen` rewrites the
programs of the net; after it, everything that is still there is printed.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from operator import is_
from typing import Any

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes, parts_of
from pn2code.ir.nodes import Ir, Rep, Stmt

_PURE_OPERATIONS = ("zero", "list.nil")
_STATEMENTS = "tuple[Stmt, ...]"


def with_seen(net: ir.NetIR) -> ir.NetIR:
    """The net, without what nobody looks at."""

    def function(f: ir.Function) -> ir.Function:
        body = seen(f.body)
        read = {n.local.uid for n in ir_nodes(body) if isinstance(n, ir.Use)}
        return replace(f, body=body, unread=tuple(p for p in f.parameters if p.uid not in read))

    return replace(
        net,
        functions=tuple(map(function, net.functions)),
        globals=tuple(replace(g, setup=seen(g.setup)) for g in net.globals),
        places=tuple(replace(p, initial=seen(p.initial)) for p in net.places),
        predicates=tuple(replace(p, body=seen(p.body)) for p in net.predicates),
        transitions=tuple(
            replace(
                t, enumerate=seen(t.enumerate), fire=seen(t.fire), thresholds=seen(t.thresholds)
            )
            for t in net.transitions
        ),
    )


def seen(statements: tuple[Stmt, ...]) -> tuple[Stmt, ...]:
    """The statements without those that no evaluation can tell from none."""
    read = _read(statements)
    while True:
        kept = _without(statements, read)
        if kept is statements:
            return statements
        statements = kept
        before, read = read, _read(statements)
        if read == before:
            return statements


def does_nothing(value: Ir) -> bool:
    """Whether a value need not be computed when nobody looks at it."""
    return not any(
        isinstance(n, (ir.FunCall, ir.NewRef))
        or (isinstance(n, ir.Op) and n.name not in _PURE_OPERATIONS)
        for n in ir_nodes(value)
    )


def _without(statements: tuple[Stmt, ...], read: frozenset[int]) -> tuple[Stmt, ...]:
    """What is left of them; the same object where all of them are."""
    kept = tuple(kept for s in statements for kept in _kept(s, read))
    is_whole = len(kept) == len(statements) and all(map(is_, kept, statements))
    return statements if is_whole else kept


def _kept(s: Stmt, read: frozenset[int]) -> Iterator[Stmt]:
    match s:
        case ir.Let(local=local, value=value) | ir.Assign(local=local, value=value):
            if local.uid in read:
                yield s
            else:
                yield from _done(value)
        case ir.Declare(local=local):
            if local.uid in read:
                yield s
        case ir.Do(value=value):
            yield from _done(value)
        case ir.SetGlobal(value=value) if value.type.rep is Rep.UNIT:
            yield from _done(value)
        case ir.SetContents(reference=reference, value=value):
            goes_to = reference.local.uid if isinstance(reference, ir.Use) else None
            if value.type.rep is Rep.UNIT or (goes_to is not None and goes_to not in read):
                yield from _done(value)
            else:
                yield s
        case ir.If(condition=condition):
            then, otherwise = _without(s.then, read), _without(s.otherwise, read)
            if then is s.then and otherwise is s.otherwise and (then or otherwise):
                yield s
            elif then or otherwise:
                yield replace(s, then=then, otherwise=otherwise)
            else:
                yield from _done(condition)
        case _:
            yield _within(s, read)


def _within(s: Any, read: frozenset[int]) -> Stmt:
    """A statement with others inside it, without those of them that are unseen."""
    changed = {}
    for name in _nested(s.__class__):
        before = getattr(s, name)
        if (left := _without(before, read)) is not before:
            changed[name] = left
    return replace(s, **changed) if changed else s  # type: ignore[no-any-return]  # a statement like `s`


def _done(value: Ir) -> Iterator[Stmt]:
    """What is left of a value that nobody looks at."""
    if not does_nothing(value):
        yield ir.Do(value)


@cache
def _nested(kind: type[Any]) -> tuple[str, ...]:
    """The fields of a statement that hold statements."""
    fields: dict[str, Any] = getattr(kind, "__dataclass_fields__", {})
    return tuple(name for name, f in fields.items() if f.type == _STATEMENTS)


def _read(statements: tuple[Stmt, ...]) -> frozenset[int]:
    """The locals whose values somebody looks at."""
    known: frozenset[int] | None = None
    assigned: set[int] = set()
    while True:
        found = frozenset(_uses(statements, known, assigned))
        if found == known or assigned <= found:  # with all of them read, no value is left out
            return found
        known = found


def _uses(item: object, known: frozenset[int] | None, assigned: set[int]) -> Iterator[int]:
    """The locals that are read.

    Args:
        item: statements.
        known: those that are, as far as is known; what goes to others alone is not looked at.
        assigned: gets the locals that are given a value.
    """
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
            case ir.Let(local=local, value=value) | ir.Assign(local=local, value=value):
                assigned.add(local.uid)
                if known is not None and local.uid not in known and does_nothing(value):
                    continue
            case ir.Do(value=value) if does_nothing(value):
                continue
            case ir.SetContents(reference=ir.Use(local=local), value=value) if _is_plain(item):
                assigned.add(local.uid)
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


def _is_plain(s: ir.SetContents) -> bool:
    """Whether it assigns to a variable in C, not to what a pointer points to."""
    return isinstance(s.reference, ir.Use) and (
        s.reference.type.rep is not Rep.REF or s.value.type == s.reference.type
    )
