"""Rules that make one step of two, around a place that is left at once, or entered late."""

from __future__ import annotations

from pn2code.base.components import components
from pn2code.contest.reduction.net import Goal, Net

MOST_PAIRS = 64
"""New transitions for one place."""


def _fits(net: Net, before: set[int], after: set[int]) -> bool:
    """Whether there are not too many pairs: in all, no more transitions than there were in the beginning."""
    pairs = len(before) * len(after)
    room = net.transitions_before - len(net.pre)
    return pairs <= len(before) + len(after) + max(0, min(room, MOST_PAIRS))


def post_agglomeration(net: Net) -> int:
    """What leaves p needs nothing but p, and nobody looks at it: it can follow at once on what has filled p.

    Waiting in p is of no use: whatever else occurs finds the same tokens or more. With several transitions after p all
    arcs at p have the same weight, so that each filling is for one of them; the rest that p holds is less than that.
    On a path that waits in p for ever other transitions go on for ever, as they do without waiting. For branching time
    there is only one transition after p, since with several the choice would be made earlier.
    """
    done = 0
    for p in list(net.marking):
        before, after = net.putters[p], net.takers[p]
        if p in net.visible or not after or not before.isdisjoint(after):
            continue
        if not _fits(net, before, after) or not _can_follow(net, p):
            continue
        if net.marking[p] >= net.pre[next(iter(after))][p]:
            _empty(net, p)
        _joined(net, p)
        done += 1
    return done


def _can_follow(net: Net, p: int) -> bool:
    after = net.takers[p]
    if any(len(net.pre[f]) != 1 or not net.is_invisible(f) for f in after):
        return False
    weights = {net.pre[f][p] for f in after}
    if len(weights) != 1:
        return False
    weight = weights.pop()
    if net.goal is Goal.BRANCHING and len(after) > 1:
        return False
    if len(after) == 1:
        return all(net.post[h][p] % weight == 0 for h in net.putters[p])
    return net.marking[p] < weight and all(net.post[h][p] == weight for h in net.putters[p])


def _empty(net: Net, p: int) -> None:
    """Let the only transition after p occur as often as it can."""
    (f,) = net.takers[p]
    times, net.marking[p] = divmod(net.marking[p], net.pre[f][p])
    for q, n in net.post[f].items():
        net.marking[q] += times * n


def pre_agglomeration(net: Net) -> int:
    """What fills p fills nothing else, and nobody looks at it: it can wait until what comes after p needs it.

    Waiting leaves tokens where they are, which hinders nobody. For deadlocks no other transition may take them
    meanwhile: only what fills p takes from its inputs, and it has inputs. So it is for linear time: what fills p cannot
    go on for ever by itself. For branching time each transition before p has inputs of its own, so that it hinders none
    of the others.
    """
    done = 0
    for p in list(net.marking):
        before, after = net.putters[p], net.takers[p]
        if p in net.visible or not before or not after or not before.isdisjoint(after):
            continue
        if _fits(net, before, after) and _can_wait(net, p):
            _joined(net, p)
            done += 1
    return done


def _can_wait(net: Net, p: int) -> bool:
    before, after = net.putters[p], net.takers[p]
    if any(len(net.post[h]) != 1 or not net.is_invisible(h) for h in before):
        return False
    weights = {net.post[h][p] for h in before}
    if len(weights) != 1:
        return False
    weight = weights.pop()
    if net.marking[p] >= weight or any(net.pre[f][p] % weight for f in after):
        return False
    if len(before) > 1 and any(net.pre[f][p] != weight for f in after):
        return False
    if net.goal is Goal.BRANCHING:
        return all(net.pre[h] and all(net.takers[q] == {h} for q in net.pre[h]) for h in before)
    if net.goal is not Goal.REACHABILITY:
        return all(net.pre[h] and all(net.takers[q] <= before for q in net.pre[h]) for h in before)
    return True


def _joined(net: Net, p: int) -> None:
    """Each transition before p with each one after it, as often as the weights say; p goes."""
    before, after = sorted(net.putters[p]), sorted(net.takers[p])
    for h in before:
        for f in after:
            put, taken = net.post[h][p], net.pre[f][p]
            h_times, f_times = (1, put // taken) if put >= taken else (taken // put, 1)
            net.add_transition(
                _sum(net.pre[h], h_times, net.pre[f], f_times, p),
                _sum(net.post[h], h_times, net.post[f], f_times, p),
            )
    for t in (*before, *after):
        net.remove_transition(t)
    net.remove_place(p)


def _sum(
    a: dict[int, int], times_a: int, b: dict[int, int], times_b: int, but: int
) -> dict[int, int]:
    """Both together, without one place."""
    found = {p: n * times_a for p, n in a.items() if p != but}
    for p, n in b.items():
        if p != but:
            found[p] = found.get(p, 0) + n * times_b
    return found


def free_moves(net: Net) -> int:
    """Places between which a token can go round without anything else are one place.

    But for reachability a step that changes nothing stays: where a token can go round, nothing is dead, and a path may
    do nothing else for ever.
    """
    moves: dict[int, list[int]] = {}
    for t, pre in net.pre.items():
        post = net.post[t]
        if len(pre) == 1 and len(post) == 1:
            (p, n), (q, m) = *pre.items(), *post.items()
            if n == m == 1 and p != q and net.visible.isdisjoint((p, q)):
                moves.setdefault(p, []).append(q)
    merged = 0
    for ring in [c for c in components(moves, lambda p: moves.get(p, ())) if len(c) > 1]:
        _merge(net, ring)
        merged += len(ring) - 1
    return merged


def _merge(net: Net, ring: list[int]) -> None:
    """All places of a ring become its first one."""
    kept, members = ring[0], set(ring)
    touched = {t for p in ring for t in net.takers[p] | net.putters[p]}
    net.marking[kept] = sum(net.marking[p] for p in ring)
    for t in touched:
        pre, post = _moved(net.pre[t], kept, members), _moved(net.post[t], kept, members)
        net.remove_transition(t)
        if pre != post or net.goal is not Goal.REACHABILITY:
            net.add_transition(pre, post)
    for p in ring[1:]:
        net.remove_place(p)


def _moved(arcs: dict[int, int], kept: int, members: set[int]) -> dict[int, int]:
    found = {p: n for p, n in arcs.items() if p not in members}
    inside = sum(n for p, n in arcs.items() if p in members)
    if inside:
        found[kept] = inside
    return found
