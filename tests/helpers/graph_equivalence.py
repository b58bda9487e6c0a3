"""Whether two graphs with labels at their nodes look the same: to paths, to branching time, or step by step.

A graph is a list of labels and a list of successors; node 0 is the initial one, and one without successors follows
itself.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence

Labels = Sequence[Hashable]
Successors = Sequence[Sequence[int]]
Pair = tuple[tuple[Labels, Successors], tuple[Labels, Successors]]


def same_traces(pair: Pair) -> bool:
    """Whether both have the same maximal paths, if repeated labels count as one.

    Sets of nodes that a sequence of labels can lead to are followed side by side; in each of them the sequence may end
    if one of its nodes can keep its label for ever. Sequences without an end follow from their beginnings (König).
    """
    ends = [_lasting(*g) for g in pair]
    start = tuple(_closed({0}, *g) for g in pair)
    if pair[0][0][0] != pair[1][0][0]:
        return False
    seen, todo = {start}, [start]
    while todo:
        sets = todo.pop()
        if len({not ends[i].isdisjoint(s) for i, s in enumerate(sets)}) > 1:
            return False
        nexts = [_by_label(s, *g) for s, g in zip(sets, pair, strict=True)]
        if nexts[0].keys() != nexts[1].keys():
            return False
        for label in nexts[0]:
            after = tuple(_closed(n[label], *g) for n, g in zip(nexts, pair, strict=True))
            if after not in seen:
                seen.add(after)
                todo.append(after)
    return True


def _closed(nodes: Iterable[int], labels: Labels, successors: Successors) -> frozenset[int]:
    found, todo = set(nodes), list(nodes)
    while todo:
        node = todo.pop()
        for after in successors[node]:
            if labels[after] == labels[node] and after not in found:
                found.add(after)
                todo.append(after)
    return frozenset(found)


def _by_label(
    nodes: Iterable[int], labels: Labels, successors: Successors
) -> dict[Hashable, set[int]]:
    found: dict[Hashable, set[int]] = {}
    for node in nodes:
        for after in successors[node]:
            if labels[after] != labels[node]:
                found.setdefault(labels[after], set()).add(after)
    return found


def _lasting(labels: Labels, successors: Successors) -> set[int]:
    """The nodes that can keep their label for ever."""
    left = set(range(len(labels)))
    while True:
        gone = {
            n
            for n in left
            if successors[n]
            and not any(m in left and labels[m] == labels[n] for m in successors[n])
        }
        if not gone:
            return left
        left -= gone


def same_branching(pair: Pair) -> bool:
    """Whether they are bisimilar up to stuttering, and where one can stay for ever, so can the other.

    These are the nodes that CTL* without next does not tell apart (De Nicola, Vaandrager 1995).
    """
    labels, successors, start = _side_by_side(pair)
    blocks = _numbered(labels)
    while True:
        staying = _lasting(blocks, successors)
        keys = []
        for n in range(len(blocks)):
            inner = _closed({n}, blocks, successors)
            leads = frozenset(
                blocks[m] for i in inner for m in successors[i] if blocks[m] != blocks[n]
            )
            keys.append((blocks[n], leads, not staying.isdisjoint(inner)))
        new = _numbered(keys)
        if len(set(new)) == len(set(blocks)):
            return blocks[0] == blocks[start]
        blocks = new


def same_steps(pair: Pair) -> bool:
    """Whether they are bisimilar; nodes without successors are told apart from those that follow themselves."""
    labels, successors, start = _side_by_side(pair)
    blocks = _numbered(labels)
    while True:
        new = _numbered(
            [(b, frozenset(blocks[m] for m in successors[n])) for n, b in enumerate(blocks)]
        )
        if len(set(new)) == len(set(blocks)):
            return blocks[0] == blocks[start]
        blocks = new


def _side_by_side(pair: Pair) -> tuple[list[Hashable], list[list[int]], int]:
    (a, after_a), (b, after_b) = pair
    n = len(a)
    return [*a, *b], [*map(list, after_a), *([m + n for m in own] for own in after_b)], n


def _numbered(keys: Iterable[Hashable]) -> list[int]:
    numbers: dict[Hashable, int] = {}
    return [numbers.setdefault(k, len(numbers)) for k in keys]
