"""The runs of a search that nothing stops: no fault, no script, no answer that is later than the supervisor waits for.

    runs = Unstopped(search, timeout)
    runs.too_long(first, second, limit)         # Wait; None: no such run is known to wait longer
    runs.way_before(wait)                       # node and mark of each arc on the way to it
    runs.around()                               # the elements of a repetition that takes time; []: there is none

A node is a situation with how long each answer is owed that may be late. Times are those that surely go by, whatever
ends before what it is a tie with; answers are taken to be owed for longer, where that is not known. So each way
through these nodes is a run, but not each run is one of these ways.
"""

from __future__ import annotations

from collections.abc import Collection
from functools import cached_property

from pn2code.base.components import components
from pn2code.timing.doings import NS
from pn2code.timing.longest import Arc, TimedPath, TimedPaths, leading_to, longest_inside
from pn2code.timing.search import BEGINS, MOST, TIE, Search
from pn2code.timing.waits import Is, Wait, lost_wait, seen_wait, way_to

_NOBODY = -1
"""Instead of how long an answer is owed: it is not."""
_STOP = -1
"""Instead of a situation: a late answer has stopped the run."""


class Unstopped:
    """Asks what they can do.

    Args:
        search: has seen all situations, or some of them.
        timeout: ns, how long the supervisor waits for an answer.
        most: nodes that are looked at.

    Attributes:
        is_all: nothing ever stops a run, so that all are here.
    """

    def __init__(self, search: Search, timeout: int, most: int = MOST) -> None:
        self.search, self.most = search, most
        self.latest = timeout - TIE
        owing = search.graph.running.owing
        self.owed = {owner: longest_owed(search, place) for owner, place in owing.items()}
        """by owner: for how long it owes an answer at most"""
        self.late = tuple(
            owing[owner] for owner, ns in self.owed.items() if ns is None or ns + TIE > timeout
        )
        """the places that are marked while an answer is owed that may be late"""
        self.stopped = search.stopped()
        self.is_all = not (self.late or self.stopped)

    def too_long(self, first: Is, second: Is, limit: int) -> Wait | None:
        """How one of these runs waits for longer than `limit` (ns) before it ends or is stopped; None: none does."""
        ways = self._ways
        wait = seen_wait(ways.successors, first, second, ways.over)
        is_longer = wait.why == "repeats" or (wait.ns is not None and wait.ns - TIE > limit)
        return wait if is_longer else None

    def never(self, first: Is, second: Is, over: Collection[int]) -> Wait | None:
        """How one of them comes to where the second event is not possible any more, and is not stopped after that.

        Args:
            over: situations in which nobody waits for it.
        """
        ways, arcs = self._ways, self.search.successors
        before = {node for node, x in enumerate(arcs) if any(second(mark) for *_, mark in x)}
        possible = leading_to(arcs, before)
        lost = {i for i in ways.going_on() if not possible[s := ways.nodes[i]] and s not in over}
        return lost_wait(ways.successors, first, second, lost)

    def way_before(self, wait: Wait) -> list[tuple[int, int]]:
        """The way to where a wait of theirs begins: node and mark of each arc."""
        found = way_to(self._ways.successors, {wait.before})
        assert found is not None, "all of these nodes were reached"
        return found

    def around(self) -> list[int]:
        """The elements of a repetition that takes time, from which an end can be reached; []: there is none."""
        return self._paths.around()

    def longest(self, ends: Collection[int]) -> TimedPath | None:
        """The longest of them to one of these situations; None: there is none, or no longest one."""
        return self._paths.longest([i for i, s in enumerate(self._ways.nodes) if s in ends])

    @cached_property
    def _ways(self) -> _Ways:
        return _Ways(self)

    @cached_property
    def _paths(self) -> TimedPaths:
        return TimedPaths(self._ways.successors, self._ways.ends)


class _Ways:
    """The graph.

    Attributes:
        nodes: of each the situation; `_STOP`: a late answer has stopped the run.
        successors: with the times that surely go by.
        over: the nodes in which the cycle may be over, or a run is stopped; ends: those in which it is over.
    """

    def __init__(self, runs: Unstopped) -> None:
        self.search, self.latest = runs.search, runs.latest
        self.places, self.stopped = runs.late, runs.stopped
        self.nodes: list[int] = []
        self.successors: list[list[Arc]] = []
        self._since: list[tuple[int, ...]] = []
        self._numbers: dict[tuple[int, tuple[int, ...]], int] = {}
        self._go(runs.most)
        search = self.search
        over = {i for i, (state, *_) in enumerate(search.situations) if state in search.graph.over}
        over |= search.ends | self.stopped | {_STOP}
        self.over = {i for i, s in enumerate(self.nodes) if s in over}
        self.ends = {i for i, s in enumerate(self.nodes) if s in search.ends}

    def going_on(self) -> set[int]:
        """The nodes from which a run comes to its end, or goes on for ever."""
        after = [[to for to, *_ in arcs] for arcs in self.successors]
        around = (
            node
            for members in components(range(len(after)), after.__getitem__)
            for node in members
            if len(members) > 1 or node in after[node]
        )
        leading = leading_to(self.successors, {*self.ends, *around})
        return {node for node, leads in enumerate(leading) if leads}

    def _go(self, most: int) -> None:
        search = self.search
        surely, stuck = search.surely(), set(search.stuck)
        self._number(0, self._owed(0, (_NOBODY,) * len(self.places), 0))
        node = -1
        while (node := node + 1) < len(self.nodes) <= most:
            situation, owed, arcs = self.nodes[node], self._since[node], self.successors[node]
            if situation == _STOP or situation in self.stopped:
                continue
            left = self._left(owed)
            if situation in stuck:
                # Nothing more happens: the supervisor waits until the answer is late, or for ever.
                arcs.append((node, NS, BEGINS) if left is None else (self._stop(), left, BEGINS))
            both = zip(search.successors[situation], surely[situation], strict=True)
            for (to, ns, mark), (_, sure, _) in both:
                if left is not None and ns > left:
                    arcs.append((self._stop(), min(sure, left), BEGINS))
                else:
                    arcs.append((self._number(to, self._owed(to, owed, ns)), sure, mark))

    def _left(self, owed: tuple[int, ...]) -> int | None:
        """ns: until the first answer may be late; None: nobody owes one."""
        longest = max(owed, default=_NOBODY)
        return None if longest == _NOBODY else max(0, self.latest - longest)

    def _stop(self) -> int:
        return self._number(_STOP, ())

    def _number(self, situation: int, owed: tuple[int, ...]) -> int:
        key = (situation, owed)
        if key not in self._numbers:
            self._numbers[key] = len(self.nodes)
            self.nodes.append(situation)
            self.successors.append([])
            self._since.append(owed)
        return self._numbers[key]

    def _owed(self, situation: int, before: tuple[int, ...], ns: int) -> tuple[int, ...]:
        """For how long each answer is owed there, where so much time has gone by since it was owed for `before`."""
        graph = self.search.graph
        state = self.search.situations[situation][0]
        marked = graph.marked[state]
        return tuple(
            _NOBODY if p not in marked or state in graph.over else 0 if old == _NOBODY else old + ns
            for p, old in zip(self.places, before, strict=True)
        )


def longest_owed(search: Search, place: int) -> int | None:
    """ns: for how long an answer is owed at most, while a place is marked; None: without a limit, or for ever.

    When the supervisor has finished it waits for none.
    """
    marked, over = search.graph.marked, search.graph.over
    # Where the time was over a situation may have been met of which nobody was to know what comes after it.
    known = zip(search.situations, search.successors, strict=False)
    owing = [
        i
        for i, ((state, *_), _) in enumerate(known)
        if place in marked[state] and state not in over
    ]
    # Where nothing more happens the supervisor still waits, and no answer comes.
    is_never_answered = not set(search.stuck).isdisjoint(owing)
    return None if is_never_answered else longest_inside(search.successors, owing)
