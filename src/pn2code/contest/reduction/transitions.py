"""Rules that remove transitions."""

from __future__ import annotations

from collections import defaultdict

from pn2code.contest.reduction.net import Goal, Net

MOST_COMPARED = 50
"""Transitions of the same effect that are compared with one."""


def dead_transitions(net: Net) -> int:
    """A transition that needs a place of a siphon without tokens, or more than a place has that is never filled."""
    marked = {p for p, n in net.marking.items() if n}
    missing = {t: len(pre.keys() - marked) for t, pre in net.pre.items()}
    todo = [t for t, n in missing.items() if not n]
    live = set(todo)
    while todo:
        for p in net.post[todo.pop()]:
            if p in marked:
                continue
            marked.add(p)
            for t in net.takers[p]:
                missing[t] -= 1
                if not missing[t]:
                    live.add(t)
                    todo.append(t)
    dead = net.pre.keys() - live
    for p, tokens in net.marking.items():
        needy = [t for t in net.takers[p] if net.pre[t][p] > tokens]
        if needy and all(net.post[t][p] <= net.pre[t].get(p, 0) for t in net.putters[p]):
            dead.update(needy)
    for t in dead:
        net.remove_transition(t)
    return len(dead)


def idle_transitions(net: Net) -> int:
    """A transition that changes nothing leads nowhere."""
    found = [t for t in net.pre if net.pre[t] == net.post[t]]
    for t in found:
        net.remove_transition(t)
    return len(found)


def identical_transitions(net: Net) -> int:
    """Of two transitions with the same effect the one that needs as much as the other, or more."""
    groups: dict[frozenset[tuple[int, int]], list[int]] = defaultdict(list)
    for t in net.pre:
        groups[frozenset(net.effect(t).items())].append(t)
    removed = 0
    for group in groups.values():
        kept: list[int] = []
        for t in sorted(group, key=lambda t: sum(net.pre[t].values())):
            if any(_needs_less(net, u, t) for u in kept[:MOST_COMPARED]):
                net.remove_transition(t)
                removed += 1
            else:
                kept.append(t)
    return removed


def _needs_less(net: Net, u: int, t: int) -> bool:
    needed = net.pre[t]
    return all(needed.get(p, 0) >= n for p, n in net.pre[u].items())


def losing_transitions(net: Net) -> int:
    """A transition that only takes, from places at which nobody looks: without it there is more to go on with."""
    found = [
        t for t in net.pre if net.is_invisible(t) and max(net.effect(t).values(), default=0) <= 0
    ]
    for t in found:
        net.remove_transition(t)
    return len(found)


def irrelevant_parts(net: Net) -> int:
    """Only what changes the visible places matters, and what changes places that such transitions need, and so on."""
    assert net.goal is Goal.REACHABILITY
    todo = list(net.visible)
    places = set(todo)
    transitions: set[int] = set()
    while todo:
        p = todo.pop()
        for t in net.takers[p] | net.putters[p]:
            if t in transitions or net.pre[t].get(p, 0) == net.post[t].get(p, 0):
                continue
            transitions.add(t)
            new = net.pre[t].keys() - places
            places |= new
            todo.extend(new)
    away = net.pre.keys() - transitions
    for t in away:
        net.remove_transition(t)
    unseen = net.marking.keys() - places
    for p in unseen:
        net.remove_place(p)
    return len(away) + len(unseen)
