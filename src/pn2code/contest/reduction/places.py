"""Rules that remove places."""

from __future__ import annotations

from collections import defaultdict
from math import gcd

from pn2code.contest.reduction.net import Affine, Net

MOST_CANDIDATES = 8
"""Places that are compared with one that may be implied."""


def constant_places(net: Net) -> int:
    """A place that no transition changes: what needs more than it holds is dead, for the others it is no obstacle."""
    removed = 0
    for p in list(net.marking):
        if all(
            net.pre[t].get(p, 0) == net.post[t].get(p, 0) for t in net.takers[p] | net.putters[p]
        ):
            tokens = net.marking[p]
            for t in [t for t in net.takers[p] if net.pre[t][p] > tokens]:
                net.remove_transition(t)
            net.remove_place(p, Affine(tokens, {}))
            removed += 1
    return removed


def sink_places(net: Net) -> int:
    """A place from which nothing is taken, and at which nobody looks."""
    found = [p for p in net.marking if not net.takers[p] and p not in net.visible]
    for p in found:
        net.remove_place(p)
    return len(found)


def proportional_places(net: Net) -> int:
    """Two places that all transitions change in proportion: one follows from the other.

    With b * m(p) - a * m(q) constant, p is no obstacle if the tokens that each taker needs in q are, in proportion,
    those that it needs in p. A visible place is replaced in the question, which needs b = 1.
    """
    groups: dict[tuple[tuple[int, int], ...], list[tuple[int, int]]] = defaultdict(list)
    for p in net.marking:
        row = sorted(net.row(p).items())
        if row:
            scale = gcd(*(n for _, n in row))
            groups[tuple((t, n // scale) for t, n in row)].append((p, scale))
    removed = 0
    for group in groups.values():
        if len(group) < 2:
            continue
        for p, a in list(group):
            others = [(q, b) for q, b in group if q != p][:MOST_CANDIDATES]
            for q, b in others:
                if _follows(net, p, a, q, b):
                    group.remove((p, a))
                    removed += 1
                    break
    return removed


def _follows(net: Net, p: int, a: int, q: int, b: int) -> bool:
    """Remove p if it follows from q, with the rows a * r and b * r."""
    rest = b * net.marking[p] - a * net.marking[q]  # b * m(p) = a * m(q) + rest, always
    if any(a * net.pre[t].get(q, 0) + rest < b * net.pre[t][p] for t in net.takers[p]):
        return False
    if p not in net.visible:
        net.remove_place(p)
        return True
    if a % b or rest % b:
        return False
    net.remove_place(p, Affine(rest // b, {q: a // b}))
    return True


def implied_places(net: Net) -> int:
    """A place that always holds at least as much as another one that its takers need as well."""
    removed = 0
    for p in list(net.marking):
        takers = net.takers[p]
        if p in net.visible or not takers:
            continue
        common = set.intersection(*(set(net.pre[t]) for t in takers)) - {p}
        for q in sorted(common)[:MOST_CANDIDATES]:
            if _is_implied(net, p, q):
                net.remove_place(p)
                removed += 1
                break
    return removed


def _is_implied(net: Net, p: int, q: int) -> bool:
    if net.marking[p] < net.marking[q]:
        return False
    if any(net.pre[t][p] > net.pre[t][q] for t in net.takers[p]):
        return False
    return all(
        net.post[t].get(p, 0) - net.pre[t].get(p, 0) >= net.post[t].get(q, 0) - net.pre[t].get(q, 0)
        for t in net.takers[p] | net.putters[p] | net.takers[q] | net.putters[q]
    )


def common_weights(net: Net) -> int:
    """A place whose arcs have a common factor: it counts in units of it, and the rest never matters."""
    changed = 0
    for p in net.marking:
        if p in net.visible or not net.takers[p]:
            continue
        weights = [net.pre[t][p] for t in net.takers[p]] + [net.post[t][p] for t in net.putters[p]]
        scale = gcd(*weights)
        if scale > 1:
            for ends, arcs in ((net.takers, net.pre), (net.putters, net.post)):
                for t in ends[p]:
                    arcs[t][p] //= scale
            net.marking[p] //= scale
            changed += 1
    return changed
