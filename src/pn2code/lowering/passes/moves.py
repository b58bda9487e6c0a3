"""What the programs of transitions take and put, and how plain the search for a binding is.

`with_moves` writes it into the places (`added`) and transitions (`staying`, `is_plain`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir


def with_moves(net: ir.NetIR) -> ir.NetIR:
    """The net, with what this pass finds."""
    return replace(
        net,
        places=tuple(
            replace(p, added=most) for p, most in zip(net.places, _added(net), strict=True)
        ),
        transitions=tuple(
            replace(t, staying=_staying(t.fire), is_plain=_is_plain(t.enumerate))
            for t in net.transitions
        ),
    )


def _added(net: ir.NetIR) -> tuple[int, ...]:
    """For each place: the most entries that one occurrence may add before it is asked whether they fit."""
    most: Counter[int] = Counter()
    for t in net.transitions:
        most |= puts(t.fire)
    return tuple(most[p.index] for p in net.places)


def puts(statements: Iterable[ir.Stmt]) -> Counter[int]:
    """By place, the most `Put`s on any way through the statements."""
    total: Counter[int] = Counter()
    for s in statements:
        match s:
            case ir.Put(place=place):
                total[place] += 1
            case ir.If(then=then, otherwise=otherwise):
                total += puts(then) | puts(otherwise)
            case _:
                pass
    return total


def _is_plain(statements: Iterable[ir.Stmt]) -> bool:
    """Whether each choice of tokens, one for each input arc, gives a binding: a search of loops and nothing else."""
    return all(
        _is_plain(s.body)
        if isinstance(s, ir.ForTokens)
        else isinstance(s, ir.Bind | ir.Yield | ir.Note)
        for s in statements
    )


def is_count(e: ir.Ir) -> bool:
    """A constant number of tokens, at least one."""
    return isinstance(e, ir.Const) and isinstance(e.value, int) and 0 < e.value < 2**31


def is_pair(takes: tuple[ir.Stmt, ...], timed: tuple[bool, ...]) -> bool:
    """Whether one token each of two values of one untimed place is wanted."""
    wanted = [s for s in takes if isinstance(s, ir.Take)]
    return (
        len(wanted) == 2
        and len({s.place for s in wanted}) == 1
        and not timed[wanted[0].place]
        and all(isinstance(s.count, ir.Const) and s.count.value == 1 for s in wanted)
        and all(isinstance(s, ir.Take | ir.Let | ir.Note) for s in takes)
    )


def _staying(statements: tuple[ir.Stmt, ...]) -> tuple[tuple[int, int], ...]:
    """The positions of takes and puts of the same tokens, as of arcs in both directions."""
    puts = [(i, s) for i, s in enumerate(statements) if isinstance(s, ir.Put)]
    found: list[tuple[int, int]] = []
    for position, take in enumerate(statements):
        if not isinstance(take, ir.Take):
            continue
        for k, (other, put) in enumerate(puts):
            if (put.place, put.value, put.count) == (take.place, take.value, take.count):
                found.append((position, other))
                del puts[k]
                break
    return tuple(found)
