"""What holds in whatever order things end: each state of a cell with where its arms stand, without time.

    anyhow = Anyhow(doings)
    anyhow.explore()
    anyhow.met[(element, stand)]        # the places and elements of which `time` prints the durations
    anyhow.least(), anyhow.most()       # ns: of a cycle in which anything may come late, or early

Each run of the cell, whatever its commands, messages and cycles take, is a way through these states. If each command
takes at least its time, a cycle takes at least what the busiest owner does on the way on which that is least. If each
takes at most its time, and somebody is at work whenever time goes by, a cycle takes at most all that is done on the
way on which that is most.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from pn2code.geometry.legs import Stand
from pn2code.timing.doings import FOREVER, Doings
from pn2code.timing.longest import Arc, TimedPath, TimedPaths, longest_inside, shortest
from pn2code.timing.steps import Kind, kinds, stops

MOST = 600_000
"""States with places of the arms that are looked at, or twice as many as the cell has states if that is more."""
Node = tuple[int, tuple[Stand, ...]]


class Anyhow:
    """Goes through them.

    Args:
        why: why not all are known; "": they are.
        met: by element and number of the place: where the arm stands then (None: a device).
        adds_up: whether all time is that of commands, so that there is an upper bound; in a timed net programs wait.
        halts: a script may find no transition that is possible, and stop the cell.
    """

    def __init__(self, doings: Doings) -> None:
        self.doings, self.graph = doings, doings.graph
        self.why = self.graph.why
        self.adds_up = not self.graph.partition.net.timed
        self.nodes: list[Node] = []
        self.successors: list[list[Arc]] = []
        self.met: dict[tuple[int, int], Stand | None] = {}
        self._numbers: dict[tuple[int, ...], int] = {}
        self._kinds = kinds(self.graph)
        self._stopped = stops(self.graph)
        self.faults: dict[tuple[int, int], str] = {}
        self.halts = False
        self._enabled: dict[int, frozenset[int]] = {}
        self._shorter: dict[int, int] = {}

    def explore(self, more: Callable[[], None] = lambda: None) -> None:
        """Goes through all of them; `more` hears of each."""
        most = max(MOST, 2 * len(self.graph.arcs))
        todo = deque([self._number((0, self.doings.homes))])
        while todo:
            node = todo.popleft()
            more()
            before = len(self.nodes)
            self.successors[node] = list(self._after(node))
            if len(self.nodes) > most:
                self.why = self.why or "situations"
                return
            todo += range(before, len(self.nodes))
        self.why = self.why or self.doings.why

    def _after(self, node: int) -> list[Arc]:
        state, stands = self.nodes[node]
        out: list[Arc] = []
        told = [
            e for e in self._in(state) if self._kinds[e] is Kind.TOLD and self.graph.commands(e)
        ]
        for element, target in self.graph.arcs[state]:
            kind = self._kinds[element]
            if kind is Kind.ENDS or target in self._stopped:
                self.halts |= kind is not Kind.ENDS
                continue
            if told and not self._are_kept(told, element, target):
                self.why = self.why or "overtaken"
            after, ns = stands, 0
            if kind is Kind.TOLD:
                arm = self.doings.arm_of.get(self.graph.elements[element].owner)
                stand = None if arm is None else stands[arm]
                doing = self.doings.of(element, stand)
                if doing is not None:
                    self.met.setdefault((element, -1 if stand is None else stand.number), stand)
                    if doing.ns >= FOREVER:
                        key = (element, -1 if stand is None else stand.number)
                        self.faults.setdefault(key, doing.fault)
                        continue
                    ns = doing.ns
                    if doing.least < ns:
                        self._shorter[element] = min(
                            doing.least, self._shorter.get(element, doing.least)
                        )
                    if arm is not None and doing.end is not None:
                        after = (*stands[:arm], doing.end, *stands[arm + 1 :])
            out.append((self._number((target, after)), ns, element))
        return out

    def _in(self, state: int) -> frozenset[int]:
        if state not in self._enabled:
            self._enabled[state] = frozenset(element for element, _ in self.graph.arcs[state])
        return self._enabled[state]

    def _are_kept(self, told: list[int], element: int, target: int) -> bool:
        """Whether what is under way stays so, whatever others do; else a robot does what is not followed here."""
        elements = self.graph.elements
        owner = elements[element].owner
        there = self._in(target)
        return all(e in there for e in told if elements[e].owner != owner)

    def _number(self, node: Node) -> int:
        state, stands = node
        key = (state, *(s.number for s in stands))
        if key not in self._numbers:
            self._numbers[key] = len(self.nodes)
            self.nodes.append(node)
            self.successors.append([])
        return self._numbers[key]

    def ends(self) -> frozenset[int]:
        """The states in which the supervisor has come to a final place."""
        over = self.graph.over
        return frozenset(i for i, (state, _) in enumerate(self.nodes) if state in over)

    def shortest(self, ns: int, mark: int) -> int:
        """ns: what an arc of so many takes at least; a belt may be at its stop."""
        return min(ns, self._shorter.get(mark, ns))

    def least(self) -> int | None:
        """The least that a cycle can take; None: there is no way to an end."""
        ends = self.ends()
        elements = self.graph.elements
        totals: list[int] = []
        for owner in range(1, len(self.graph.partition.owners)):

            def own(ns: int, mark: int, owner: int = owner) -> int:
                return self.shortest(ns, mark) if elements[mark].owner == owner else 0

            found = shortest(self.successors, ends, own)
            if found is None:
                return None
            totals.append(found.ns)
        return max(totals, default=0)

    def is_sure(self) -> bool:
        """Whether each run comes to an end, whatever anything takes, if no fault stops it."""
        ends = self.ends()
        if not all(arcs or i in ends for i, arcs in enumerate(self.successors)):
            return False
        return not TimedPaths(self.successors, ends).never_end()

    def inside(self, place: int) -> int | None:
        """ns: for how long a place of the cell's model can be marked at most, if no command takes more than its time.

        At each instant of that somebody is at work with what ends while the place is marked: whatever lets time end
        there has begun with the end of something else. None: as long as one likes, or until nothing more happens.
        """
        nodes = [i for i, (state, _) in enumerate(self.nodes) if place in self.graph.marked[state]]
        if not all(self.successors[i] for i in nodes):
            return None
        return longest_inside(self.successors, nodes)

    def never_stops(self, latest: int) -> bool:
        """Whether nothing stops a run, in whatever order things end: no fault, no script, no answer that is later than
        `latest` (ns)."""
        owed = map(self.inside, self.graph.running.owing.values())
        return not (self.faults or self.halts) and all(
            ns is not None and ns <= latest for ns in owed
        )

    def most(self) -> tuple[TimedPath | None, list[int]]:
        """The way on which most is done, and, where there is none, the elements of a repetition that takes time."""
        paths = TimedPaths(self.successors, self.ends())
        return paths.longest(), [self._arc(a, b) for a, b in _pairs(paths.cycle)]

    def _arc(self, node: int, target: int) -> int:
        arcs = [(ns, mark) for to, ns, mark in self.successors[node] if to == target]
        return max(arcs)[1]


def _pairs(cycle: list[int]) -> list[tuple[int, int]]:
    return list(zip(cycle, [*cycle[1:], *cycle[:1]], strict=True))
