"""What the programs of transitions take and put, and how plain the search for a binding is."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from pn2code.ir import nodes as ir


def rooms(net: ir.NetIR) -> tuple[int, ...]:
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


def is_plain(statements: Iterable[ir.Stmt]) -> bool:
    """Whether each choice of tokens, one for each input arc, gives a binding: a search of loops and nothing else."""
    return all(
        is_plain(s.body)
        if isinstance(s, ir.ForTokens)
        else isinstance(s, ir.Bind | ir.Yield | ir.Note)
        for s in statements
    )


def is_count(e: ir.Ir) -> bool:
    """A constant number of tokens, at least one."""
    return isinstance(e, ir.Const) and isinstance(e.value, int) and 0 < e.value < 2**31


def staying_pairs(statements: tuple[ir.Stmt, ...]) -> list[tuple[ir.Take, ir.Put]]:
    """Takes and puts of the same tokens, as of arcs in both directions: nothing need be done about them."""
    puts = [s for s in statements if isinstance(s, ir.Put)]
    found: list[tuple[ir.Take, ir.Put]] = []
    for take in statements:
        if not isinstance(take, ir.Take):
            continue
        for put in puts:
            if (put.place, put.value, put.count) == (take.place, take.value, take.count):
                found.append((take, put))
                puts.remove(put)
                break
    return found
