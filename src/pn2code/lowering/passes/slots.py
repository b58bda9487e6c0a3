"""Slots: untimed places that hold one token at most, kept as `{ value, full }` instead of as a sorted array.

To take from a slot is a test and a read, to put is a test and a write. An occurrence looks whether all slots are as it
needs them before it changes the first, so nothing has to be put back.

`with_slots` writes it into the places (`is_slot`) and transitions (`is_flat`), and again whenever bounds of places have
become known.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Iterator, Sequence

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.lowering.passes.moves import is_count, puts


def with_slots(net: ir.NetIR) -> ir.NetIR:
    """The net, with what this pass finds."""
    slots = _slots(net)
    return replace(
        net,
        places=tuple(replace(p, is_slot=p.index in slots) for p in net.places),
        transitions=tuple(
            replace(t, is_flat=_is_flat(t.enumerate, slots)) for t in net.transitions
        ),
    )


def _slots(net: ir.NetIR) -> frozenset[int]:
    """The places that are slots: proven (or declared) to hold one token at most, and nobody moves more at a time."""
    found = {p.index for p in net.places if _is_small(p)}
    for t in net.transitions if found else ():
        found.difference_update(_excluded(t))
    return frozenset(found)


def _is_small(p: ir.Place) -> bool:
    return p.bound is not None and p.bound <= 1 and p.capacity == 1 and not p.timed and not p.packed


def _excluded(t: ir.Transition) -> Iterator[int]:
    """Places with which a transition does what a slot cannot: look for several tokens, or take or put several."""
    for node in (*ir_nodes(t.enumerate), *ir_nodes(t.fire), *ir_nodes(t.thresholds)):
        match node:
            case (
                ir.UnlessAvailable(place=place, count=count)
                | ir.UnlessHeld(place=place, count=count)
            ) if count != 1:
                yield place
            case ir.Take(place=place, count=count) if not _is_one(count):
                yield place
    yield from _followed(t.enumerate)
    takes = Counter(s.place for s in t.fire if isinstance(s, ir.Take))
    yield from (place for place, n in takes.items() if n > 1)
    yield from (place for place, n in puts(t.fire).items() if n > 1)


def _is_one(count: ir.Ir) -> bool:
    return is_count(count) and isinstance(count, ir.Const) and count.value == 1


def _followed(statements: tuple[ir.Stmt, ...]) -> Iterator[int]:
    """Places of loops after which something follows in the same sequence."""
    for i, s in enumerate(statements):
        if isinstance(s, ir.ForTokens | ir.ForValues):
            yield from _followed(s.body)
        if isinstance(s, ir.ForTokens) and i + 1 < len(statements):
            yield s.place


def _is_flat(statements: Sequence[ir.Stmt], slots: Container[int]) -> bool:
    """Whether a search gives one binding at most, and does so last: of a slot there is one token to look at."""
    if not statements or any(isinstance(n, ir.Yield) for n in ir_nodes(tuple(statements[:-1]))):
        return False
    last = statements[-1]
    if isinstance(last, ir.ForTokens):
        return last.place in slots and _is_flat(last.body, slots)
    return isinstance(last, ir.Yield)
