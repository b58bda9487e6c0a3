"""Page instances: the tree that substitution transitions span, with names and numbers.

Order: depth first from each prime page in order of the file; an instance comes before those below
it, and these in the order of their substitution transitions.

CPN Tools' numbers of the instances of one page (from 1) follow another order, found by experiment:
depth first too, but below a page that is not a prime page the substitution transitions count from
the last to the first. Example: Top has A = Sub and B = Sub; Sub has C = Leaf and D = Leaf. The
instances of Sub are A: 1, B: 2; those of Leaf are A/C: 2, A/D: 1, B/C: 4, B/D: 3.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from pn2code.net.typed import TypedNet, TypedPage


@dataclass(frozen=True, slots=True)
class PageInstance:
    """One instance of a page.

    Args:
        index: position in the order.
        page: the page.
        path: names from the prime page down, joined with "/": "Top/Robot1".
        number: CPN Tools' number among the instances of the page.
        parent: index of the instance with the substitution transition; -1 for prime pages.
        sockets: port id -> socket id on the parent's page.
    """

    index: int
    page: TypedPage
    path: str
    number: int
    parent: int
    sockets: Mapping[str, str]

    def name(self, element: str) -> str:
        """Unique readable name of an element: "Top.Robot1.Accept"."""
        return f"{self.path.replace('/', '.')}.{element}"


def measure(net: TypedNet) -> tuple[int, int]:
    """Size of the hierarchy, cheap however large it is.

    Returns:
        How many places and transitions the flat net would have, before merging, and how many pages stand one
        below the other.
    """
    pages = {p.id: p for p in net.pages}
    totals: dict[str, int] = {}
    depths: dict[str, int] = {}
    for start in net.pages:
        # Post-order with an explicit stack; recursion of pages has been refused by the linker.
        stack = [(start.id, False)]
        while stack:
            identity, expanded = stack.pop()
            if identity in totals:
                continue
            page = pages[identity]
            below = [s.subpage for s in page.substitutions]
            if expanded or not below:
                own = len(page.places) + len(page.transitions) + 1
                totals[identity] = own + sum(totals[b] for b in below)
                depths[identity] = 1 + max((depths[b] for b in below), default=0)
            else:
                stack.append((identity, True))
                stack.extend((b, False) for b in below)
    return sum(totals[p] for p in net.prime_pages), max(depths.values(), default=0)


def expand(net: TypedNet) -> list[PageInstance]:
    """All page instances, in order."""
    pages = {p.id: p for p in net.pages}
    found: list[PageInstance] = []
    prime = [pages[i] for i in net.prime_pages]
    names = unique_names((p.id, _segment(p.name)) for p in prime)
    stack = [(p.id, names[p.id], -1, dict[str, str]()) for p in reversed(prime)]
    segments = {
        p.id: unique_names((s.id, _segment(s.name)) for s in p.substitutions) for p in net.pages
    }
    while stack:
        identity, path, parent, sockets = stack.pop()
        page = pages[identity]
        index = len(found)
        found.append(PageInstance(index, page, path, 0, parent, sockets))
        for s in reversed(page.substitutions):
            below = f"{path}/{segments[identity][s.id]}"
            stack.append((s.subpage, below, index, {q.port: q.socket for q in s.ports}))
    return [replace(i, number=n) for i, n in zip(found, _numbers(found), strict=True)]


def _numbers(instances: Sequence[PageInstance]) -> list[int]:
    """CPN Tools' number of each instance, in the order of `instances`."""
    below: list[list[int]] = [[] for _ in instances]
    for i in instances:
        if i.parent >= 0:
            below[i.parent].append(i.index)
    counts: dict[str, int] = {}
    numbers = [0] * len(instances)
    stack = [i.index for i in reversed(instances) if i.parent < 0]
    while stack:
        index = stack.pop()
        page = instances[index].page.id
        counts[page] = numbers[index] = counts.get(page, 0) + 1
        # The last one on the stack comes first.
        prime = instances[index].parent < 0
        stack.extend(reversed(below[index]) if prime else below[index])
    return numbers


def _segment(name: str) -> str:
    """A name as a part of a path, which is split at "/"."""
    return name.replace("/", "_")


def unique_names(items: Iterable[tuple[str, str]]) -> dict[str, str]:
    """Names by id, made unique: of equal names the later ones get `_2`, `_3`, ... (skipping names that are taken)."""
    listed = list(items)
    taken = {name for _, name in listed}
    used: set[str] = set()
    result: dict[str, str] = {}
    for identity, name in listed:
        chosen, n = name, 1
        while chosen in used or (n > 1 and chosen in taken):
            n += 1
            chosen = f"{name}_{n}"
        used.add(chosen)
        result[identity] = chosen
    return result
