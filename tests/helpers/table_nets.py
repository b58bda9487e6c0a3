"""Random place/transition nets as tables of elements, and what is true of them, found by brute force.

The program `table_net.c` explores them: with thousands of nets the reductions of the explorer are compared with the
whole graph.
"""

from __future__ import annotations

import itertools
import json
import os
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random
from types import SimpleNamespace
from typing import Any

from helpers.explored import Explorers
from pn2code.base.resources import cnative_folder
from pn2code.emission import c_flags
from pn2code.unfold.net import UnfoldedTransition
from pn2code.verify.exploring.irrelevant_elements import irrelevant

PLACES = 32
SOURCE = Path(__file__).with_name("table_net.c")
Marking = tuple[int, ...]
Permutation = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class TableNet:
    """A net; `groups` and `exchanges` are the rows of the table about its symmetries."""

    initial: Marking
    elements: tuple[UnfoldedTransition, ...]
    rotations: tuple[tuple[int, Permutation, Permutation | None], ...] = ()
    exchanges: tuple[tuple[int, ...], tuple[tuple[int, tuple[int, ...]], ...]] | None = None

    def text(self) -> str:
        """The table, and behind its end the initial marking."""
        places = [SimpleNamespace(index=i, initial=n) for i, n in enumerate(self.initial)]
        unfolding: Any = SimpleNamespace(places=places, transitions=self.elements)
        rows: list[list[Any]] = [["pn2code-elements", 1], [1, PLACES], [len(places)]]
        rows += [[0, i] for i in range(len(places))]
        rows += [[len(self.elements)]]
        for t, is_irrelevant in zip(self.elements, irrelevant(unfolding), strict=True):
            row = [0, int(not is_irrelevant)]
            for tokens in (t.pre, t.post):
                row += [len(tokens), *itertools.chain.from_iterable(tokens.items())]
            for some in (t.inhibitors, t.resets):
                row += [len(some), *some]
            rows.append(row)
        rows.append([len(self.rotations)])
        for order, rotation, reflection in self.rotations:
            rows += [[order, int(reflection is not None)], list(rotation)]
            rows += [] if reflection is None else [list(reflection)]
        if self.exchanges is None:
            rows.append([0])
        else:
            classes, counters = self.exchanges
            rows += [[len(classes)], list(classes)]
            rows += [[shape, len(points), *points] for shape, points in counters]
        rows += [["end"], list(self.initial)]
        return "\n".join(" ".join(map(str, row)) for row in rows) + "\n"

    def graph(self, most: int) -> set[Marking] | None:
        """All markings; None if there are more, or a place gets too full."""
        seen = {self.initial}
        todo = [self.initial]
        while todo:
            for marking in self.after(todo.pop()):
                if marking not in seen:
                    if len(seen) >= most or max(marking) > 15:
                        return None
                    seen.add(marking)
                    todo.append(marking)
        return seen

    def after(self, marking: Marking) -> list[Marking]:
        """The successors."""
        return [fired(marking, t) for t in self.elements if is_enabled(marking, t)]

    def dead(self, markings: set[Marking]) -> set[Marking]:
        """Those without successors."""
        return {m for m in markings if not any(is_enabled(m, t) for t in self.elements)}


def is_enabled(marking: Marking, t: UnfoldedTransition) -> bool:
    """Whether the tokens are there."""
    return all(marking[p] >= n for p, n in t.pre.items()) and not any(
        marking[p] for p in t.inhibitors
    )


def fired(marking: Marking, t: UnfoldedTransition) -> Marking:
    """The marking afterwards."""
    after = list(marking)
    for p, n in t.pre.items():
        after[p] -= n
    for p, n in t.post.items():
        after[p] += n
    for p in t.resets:
        after[p] = 0
    return tuple(after)


def random_element(r: Random, places: int, index: int, wild: bool) -> UnfoldedTransition:
    """One that does not make too many tokens."""
    pre = {p: r.choice((1, 1, 1, 2)) for p in r.sample(range(places), r.choice((1, 1, 2, 2, 3)))}
    post: dict[int, int] = {}
    for _ in range(max(r.randint(0, sum(pre.values())), r.randint(0, sum(pre.values())))):
        p = r.choice(list(pre)) if r.random() < 0.15 else r.randrange(places)
        post[p] = post.get(p, 0) + 1
    some = tuple(p for p in r.sample(range(places), 2) if wild and r.random() < 0.15)
    resets = tuple(p for p in r.sample(range(places), 2) if wild and r.random() < 0.1)
    return UnfoldedTransition(index, 0, (), "", pre, post, some, resets)


def random_net(r: Random) -> TableNet:
    """Any net: a heap of elements, or processes that take and put back what they share."""
    wild = r.random() < 0.3
    if r.random() < 0.5:
        places = r.randint(3, 12)
        count = r.randint(places // 2, 2 * places)
        elements = [random_element(r, places, i, wild) for i in range(count)]
        initial = tuple(r.choice((0, 1, 1, 2, 3)) for _ in range(places))
        return TableNet(initial, tuple(elements))
    return processes(r, wild)


def processes(r: Random, wild: bool) -> TableNet:
    """Cycles that take shared tokens one by one, and put them back together or one by one."""
    shared = r.randint(1, 4)
    initial = [r.choice((1, 1, 1, 2)) for _ in range(shared)]
    elements: list[UnfoldedTransition] = []

    def add(pre: dict[int, int], post: dict[int, int]) -> None:
        extra: tuple[int, ...] = (r.randrange(len(initial)),) if wild and r.random() < 0.15 else ()
        extra = tuple(p for p in extra if p not in pre)
        elements.append(UnfoldedTransition(len(elements), 0, (), "", pre, post, extra, ()))

    for _ in range(r.randint(1, 4)):
        idle = len(initial)
        initial.append(1)
        for _ in range(r.randint(1, 2)):
            at, held = idle, []
            for s in r.sample(range(shared), r.randint(1, min(2, shared))):
                initial.append(0)
                add({at: 1, s: 1}, {len(initial) - 1: 1})
                at = len(initial) - 1
                held.append(s)
            if r.random() < 0.3:
                initial.append(0)
                add({at: 1}, {len(initial) - 1: 1, held[0]: 1})
                add({len(initial) - 1: 1}, {idle: 1, **dict.fromkeys(held[1:], 1)})
            elif r.random() < 0.9:
                add({at: 1}, {idle: 1, **dict.fromkeys(held, 1)})
            else:
                add({at: 1}, dict.fromkeys(held, 1))
    if len(initial) > PLACES:
        return processes(r, wild)
    return TableNet(tuple(initial), tuple(elements))


def symmetric_net(r: Random) -> tuple[TableNet, list[Permutation]]:
    """A net that is closed under a group of permutations, and generators of the group."""
    n = r.randint(2, 4)
    shapes = r.choice(([1, 1], [1, 2], [2], [1, 1, 2, 0], [2, 1, 1]))
    if n == 4 and shapes == [2, 1, 1]:
        shapes = [2, 1]
    counters = [
        (k, c) for k, arity in enumerate(shapes) for c in itertools.product(range(n), repeat=arity)
    ]
    index = {c: i for i, c in enumerate(counters)}

    def lifted(move: Sequence[int]) -> Permutation:
        return tuple(index[k, tuple(move[x] for x in c)] for k, c in counters)

    swap = [lifted([1, 0, *range(2, n)])]
    rotation = lifted([(i + 1) % n for i in range(n)])
    reflection = lifted([(-i) % n for i in range(n)])
    kind = r.choice(("full", "rotations", "both", "classes"))
    generators = {
        "full": [*swap, rotation],
        "rotations": [rotation],
        "both": [rotation, reflection],
        "classes": [lifted([1, 0, *range(2, n)])],
    }[kind]
    base = [random_element(r, len(counters), i, r.random() < 0.2) for i in range(r.randint(1, 4))]
    keys: dict[Any, UnfoldedTransition] = {}
    todo = base
    while todo:
        t = todo.pop()
        key = (
            tuple(sorted(t.pre.items())),
            tuple(sorted(t.post.items())),
            tuple(sorted(t.inhibitors)),
            tuple(sorted(t.resets)),
        )
        if key in keys:
            continue
        keys[key] = t
        for g in generators:
            todo.append(
                UnfoldedTransition(
                    0,
                    0,
                    (),
                    "",
                    {g[p]: k for p, k in t.pre.items()},
                    {g[p]: k for p, k in t.post.items()},
                    tuple(g[p] for p in t.inhibitors),
                    tuple(g[p] for p in t.resets),
                )
            )
    elements = tuple(
        UnfoldedTransition(i, 0, (), "", t.pre, t.post, t.inhibitors, t.resets)
        for i, t in enumerate(keys.values())
    )
    orbit: dict[int, int] = {}
    for i in range(len(counters)):
        todo_points = [i]
        while todo_points:
            p = todo_points.pop()
            if p not in orbit:
                orbit[p] = i
                todo_points += [g[p] for g in generators]
    tokens = {i: r.choice((0, 1, 1)) for i in set(orbit.values())}
    initial = tuple(tokens[orbit[i]] for i in range(len(counters)))
    if kind in ("full", "classes"):
        classes = (0,) * n if kind == "full" else (0, 0, *range(1, n - 1))
        exchanges = (classes, tuple(counters))
        return TableNet(initial, elements, exchanges=exchanges), generators
    turned = ((n, rotation, reflection if kind == "both" else None),)
    return TableNet(initial, elements, rotations=turned), generators


def orbits(markings: set[Marking], generators: Sequence[Permutation]) -> int:
    """How many there are of classes of markings that the group maps to each other."""
    left = set(markings)
    count = 0
    while left:
        count += 1
        todo = [left.pop()]
        while todo:
            m = todo.pop()
            for g in generators:
                image = [0] * len(m)
                for p, n in enumerate(m):
                    image[g[p]] = n
                if tuple(image) in left:
                    left.remove(tuple(image))
                    todo.append(tuple(image))
    return count


@dataclass(frozen=True, slots=True)
class TableExplorer:
    """The program."""

    program: Path

    @staticmethod
    def build(explorers: Explorers) -> TableExplorer:
        """Compile it, with the parts of the explorer that are there."""
        folder = explorers.folder / "table_net"
        folder.mkdir(exist_ok=True)
        made = folder / "explore"
        objects = sorted(explorers.host.glob("*.o"))
        command = [
            explorers.compiler,
            c_flags.STANDARD,
            *c_flags.FLOATS,
            "-pthread",
            *explorers.flags,
        ]
        command += [f"-I{cnative_folder() / 'include'}", str(SOURCE), *map(str, objects)]
        done = subprocess.run(
            [*command, "-lm", "-o", str(made)], capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr[-3000:]
        return TableExplorer(made)

    def explore(
        self, net: TableNet, *reductions: str, options: Sequence[str] = ()
    ) -> dict[str, Any]:
        """What it says of a net."""
        table = self.program.with_name("table.txt")
        table.write_text(net.text())
        command = [str(self.program), "--memory", "64", *options]
        for name in reductions:
            command += ["--reduce", name]
        done = subprocess.run(
            [*command, "--elements", str(table)],
            capture_output=True,
            text=True,
            check=False,
            timeout=600,
            env={**os.environ, "PN_TABLE": str(table)},
        )
        assert done.stdout, done.stderr
        found: dict[str, Any] = json.loads(done.stdout)
        return found
