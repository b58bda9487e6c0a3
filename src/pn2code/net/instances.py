"""Page instances: the tree that substitution transitions span, with names and numbers.

Order: depth first from each prime page in order of the file; an instance comes before those below
it, and these in the order of their substitution transitions.

CPN Tools' numbers of the instances of one page (from 1) follow another order, found by experiment: it takes the
substitution transitions that lead to the page in the order of their names, and numbers all instances through the
first one, in the order of the instances of its page, then all through the second, and so on. Example: Top has A = Sub
and B = Sub; Sub has D = Leaf and C = Leaf. The instances of Leaf are A/C: 1, B/C: 2, A/D: 3, B/D: 4.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.net.engine_names import sent_name
from pn2code.net.typed import TypedNet, TypedPage


@frozen
class PageInstance:
    """One instance of a page.

    Args:
        index: position in the order.
        page: the page.
        path: names from the prime page down, joined with "/": "Top/Robot1".
        number: CPN Tools' number among the instances of the page.
        parent: index of the instance with the substitution transition; -1 for prime pages.
        through: id of that transition; "" for prime pages.
        sockets: port id -> socket id on the parent's page.
    """

    index: int
    page: TypedPage
    path: str
    number: int
    parent: int
    through: str
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
    stack = [(p.id, names[p.id], -1, "", dict[str, str]()) for p in reversed(prime)]
    segments = {
        p.id: unique_names((s.id, _segment(s.name)) for s in p.substitutions) for p in net.pages
    }
    while stack:
        identity, path, parent, through, sockets = stack.pop()
        page = pages[identity]
        index = len(found)
        found.append(PageInstance(index, page, path, 0, parent, through, sockets))
        for s in reversed(page.substitutions):
            below = f"{path}/{segments[identity][s.id]}"
            stack.append((s.subpage, below, index, s.id, {q.port: q.socket for q in s.ports}))
    numbers = _numbers(net, found)
    return [replace(i, number=numbers[i.index]) for i in found]


def _numbers(net: TypedNet, instances: Iterable[PageInstance]) -> dict[int, int]:
    """CPN Tools' number of each instance, by its index."""
    made: dict[tuple[str, int], int] = {}
    of_page: dict[str, list[int]] = {p.id: [] for p in net.pages}
    for i in instances:
        if i.parent < 0:
            of_page[i.page.id].append(i.index)
        else:
            made[i.through, i.parent] = i.index
    leading: dict[str, list[tuple[str, str]]] = {p.id: [] for p in net.pages}
    for page in net.pages:
        for s in page.substitutions:
            leading[s.subpage].append((page.id, s.id))
    captions = {t.id: t.caption for page in net.net.document.pages for t in page.transitions}
    for page_id in _parents_first(leading):
        ways = leading[page_id]
        ways.sort(key=lambda way: (sent_name(captions[way[1]]), _slot(way[1], len(captions))))
        for above, through in ways:
            of_page[page_id].extend(made[through, i] for i in of_page[above])
    return {i: n for listed in of_page.values() for n, i in enumerate(listed, 1)}


def _parents_first(leading: Mapping[str, Iterable[tuple[str, str]]]) -> list[str]:
    """The pages, each after those that lead to it."""
    done: dict[str, None] = {}
    for start in leading:
        stack = [start]
        while stack:
            above = [p for p, _ in leading[stack[-1]] if p not in done]
            if above:
                stack.extend(above)
            else:
                done.setdefault(stack.pop())
    return list(done)


def _slot(identity: str, transitions: int) -> int:
    """Where the engine keeps a transition in its hash table, which has room for more than there are.

    Substitution transitions of one name, on different pages, are taken in this order.
    """
    hashed = 0
    for byte in identity.encode():
        hashed = 33 * hashed + 720 + byte
    return hashed % max(32, 1 << transitions.bit_length())


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
