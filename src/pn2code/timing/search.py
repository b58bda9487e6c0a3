"""All runs of a cell in which each command takes its planned time, and everything else none.

    search = Search(doings)
    search.explore()
    search.endings["Top.Supervisor.Finished",].best     # TimedPath; ...worst: None: there is no longest one
    search.why                          # why not all runs are known; "": they are

A situation is a state of the cell, where its arms stand, and what is under way with the time that it still takes. At
an instant everything happens that can, in each order that the net permits; then what can be under way begins; then
time goes by until the first of it ends. A sensor says anything. A cycle ends when the supervisor has finished and the
arms rest, as a run does: a command that is under way then is done to its end, and none is begun after it.

In a timed net the clock is under way as well: each second it goes on by one unit, and time stamps come nearer, in
whatever state the cell is then. A script waits exactly as long as its control token has a delay.

What ends within `TIE` of what ends first may as well end first: how long a move takes is known to some microseconds.
"""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import field

from pn2code.base.frozen import record
from pn2code.geometry.graph import CLOCK
from pn2code.geometry.legs import Stand
from pn2code.timing.doings import FOREVER, NS, Doing, Doings
from pn2code.timing.longest import Arc, TimedPath, TimedPaths
from pn2code.timing.steps import Kind, kinds, raises, stops

TIE = 1_000_000
"""ns: what ends within this time may end in either order. Results are as accurate as that."""
MOST = 250_000
"""Situations that are looked at."""
BEGINS = -1
"""The mark of an arc on which something begins."""
TICKS = -2
"""What the clock has under way: the rest of a second."""
WAITS = -3
"""What a script has under way that waits."""
LAST = -4
"""What somebody has under way that does no more after it, though its transition has more commands."""
UnderWay = tuple[tuple[int, int, int], ...]
"""By owner in order, the clock first: (owner, element, `TICKS`, `WAITS` or `LAST`, ns that it still takes)."""
Situation = tuple[int, tuple[Stand, ...], UnderWay]


@record
class Ending:
    """One way for a cycle to end: in these final places.

    Args:
        nodes: the situations; best, worst: paths to them. None: not known, or there is no worst.
    """

    nodes: list[int] = field(default_factory=list)
    best: TimedPath | None = None
    worst: TimedPath | None = None


class Search:
    """Goes through the situations in the order of their times.

    Args:
        why: why not all are known: "situations", "overtaken", or what the graph says; "": they are.
        seen_until: ns: all situations before this time have been seen.
        stuck: situations in which nothing more happens, though the cell is not at its end, and no fault is why.
        faults: why the cell stops at some of them.
        halts: a script may find no transition that is possible, and stop the cell.
        halting: the situations in which it may do so now.
    """

    def __init__(self, doings: Doings, most: int = MOST) -> None:
        self.doings, self.graph, self.most = doings, doings.graph, most
        self.why = self.graph.why
        self.situations: list[Situation] = []
        self.successors: list[list[Arc]] = []
        self.ends: set[int] = set()
        self.stuck: list[int] = []
        self.faults: dict[str, int] = {}
        self.halts = False
        self.halting: set[int] = set()
        self.endings: dict[tuple[str, ...], Ending] = {}
        self.cycle: list[int] = []
        self.is_endless = False
        self.seen_until = 0
        self._numbers: dict[tuple[object, ...], int] = {}
        self._from: list[tuple[int, int]] = []
        self._kinds = kinds(self.graph)
        self._stopped = stops(self.graph)
        self._raises = raises(self.graph)
        self._full = frozenset(
            i
            for i, marked in enumerate(self.graph.marked)
            if any(marked.get(c.place, 0) > 1 for c in self.graph.partition.channels)
        )
        self._told: dict[int, frozenset[int]] = {}
        self._calm = self.graph.running.firing
        self._calm_seconds: set[int] = set()

    def explore(self, more: Callable[[], None] = lambda: None) -> None:
        """Goes through all of them, and finds the best and the worst; `more` hears of each."""
        clock = ((CLOCK, TICKS, NS),) if self.graph.partition.net.timed else ()
        self._number((0, self.doings.homes, clock))
        self._from.append((-1, BEGINS))
        times = [0]
        todo = [(0, 0)]
        done: set[int] = set()
        while todo:
            now, node = heapq.heappop(todo)
            if node in done:
                continue
            more()
            done.add(node)
            self.seen_until = now
            arcs = self._after(node)
            self.successors[node] = arcs
            if node in self.ends:
                self._note_end(node, now)
            for target, ns, mark in arcs:
                if target == len(times):
                    times.append(now + ns)
                    self._from.append((node, mark))
                elif now + ns < times[target]:
                    times[target] = now + ns
                    self._from[target] = (node, mark)
                else:
                    continue
                heapq.heappush(todo, (now + ns, target))
            if len(self.situations) > self.most:
                self.why = self.why or "situations"
                return
        self.why = self.why or self.doings.why or ("belt" if self.doings.stops else "")
        paths = TimedPaths(self.successors, self.ends)
        self.cycle = paths.cycle
        for ending in self.endings.values():
            ending.worst = paths.longest(ending.nodes)
        self.is_endless = paths.never_end()

    def _note_end(self, node: int, now: int) -> None:
        state = self.situations[node][0]
        marked = self.graph.marked[state]
        places = self.graph.partition.net.places
        finals = sorted(p for p in self.graph.partition.final_places if p in marked)
        ending = self.endings.setdefault(tuple(places[p].name for p in finals), Ending())
        ending.nodes.append(node)
        if ending.best is None:
            ending.best = TimedPath(now, tuple(self.path_to(node)))

    def path_to(self, node: int) -> list[tuple[int, int]]:
        """The first way to a situation: node and mark of each arc."""
        out = []
        while node > 0:
            parent, mark = self._from[node]
            out.append((node, mark))
            node = parent
        return out[::-1]

    def held_up(self, node: int, way: Iterable[tuple[int, int]]) -> int:
        """ns: how much later all of a way from a node is, as what should have ended before others ended after them.

        Each of these is within `TIE`; of many of them the sum is not.
        """
        out = 0
        for target, mark in way:
            arcs = [a for a in self.successors[node] if a[2] == mark and target in (a[0], -1)]
            out += max((self._late(node, ns) for _, ns, _ in arcs), default=0)
            node = target
        return out

    def surely(self) -> list[list[Arc]]:
        """All arcs without these times: a way takes no less than what is left of it."""
        return [
            [(to, ns - self._late(node, ns), mark) for to, ns, mark in arcs]
            for node, arcs in enumerate(self.successors)
        ]

    def stopped(self) -> set[int]:
        """The situations in which a run stops, whatever others could still do: somebody cannot do what he has begun, a
        script may find no transition or raise an exception, or a channel would hold two messages."""
        ends = self._full | self._raises
        return self.halting | {
            node
            for node, (state, _, under_way) in enumerate(self.situations)
            if state in ends or any(left >= FOREVER // 2 for *_, left in under_way)
        }

    def may_raise(self) -> bool:
        """Whether a condition of a script may raise an exception."""
        return any(state in self._raises for state, *_ in self.situations)

    def overfull(self) -> list[str]:
        """The channels that may come to hold two messages, which stops the cell."""
        marked = self.graph.marked
        channels = self.graph.partition.channels
        return [c.name for c in channels if any(m.get(c.place, 0) > 1 for m in marked)]

    def _late(self, node: int, ns: int) -> int:
        """ns: by how much what should have ended first there ends later, where so much time goes by."""
        # In whole seconds in which the clock only goes round nothing ends.
        if node in self._calm_seconds:
            return 0
        going = [left for *_, left in self.situations[node][2] if left < FOREVER // 2]
        return max(0, ns - min(going)) if going else 0

    def elements(self, path: TimedPath) -> list[int]:
        """What occurs on a path."""
        return [mark for _, mark in path.arcs if mark >= 0]

    # --- one situation ---------------------------------------------------------------------------

    def _after(self, node: int) -> list[Arc]:
        state, stands, under_way = self.situations[node]
        if state in self._full:
            return []  # whoever has written the second message has stopped the cell
        is_over = state in self.graph.over
        busy = {owner: element for owner, element, _ in under_way}
        at_once: list[tuple[int, int]] = []
        begins: dict[int, list[tuple[int, Doing]]] = {}
        ending: dict[int, list[int]] = {}
        mixed: set[int] = set()
        ticks: list[tuple[int, int]] = []
        for element, target in self.graph.arcs[state]:
            kind = self._kinds[element]
            if kind is Kind.ENDS:
                continue
            if kind is Kind.CLOCK:
                ticks.append((element, target))
                continue
            if target in self._stopped:
                self.halts = True
                self.halting.add(node)
                continue
            owner = self.graph.elements[element].owner
            if owner in busy and kind is Kind.TOLD:
                if busy[owner] == element:
                    ending.setdefault(owner, []).append(target)
                continue
            doing = None
            if kind is Kind.TOLD:
                arm = self.doings.arm_of.get(owner)
                doing = self.doings.of(element, None if arm is None else stands[arm])
            if doing is not None:
                if not is_over:  # who hears that the supervisor has finished begins nothing more
                    begins.setdefault(owner, []).append((element, doing))
                continue
            at_once.append((element, target))
            if kind is Kind.TOLD:
                mixed.add(owner)
        out = list(self._at_once(state, stands, under_way, at_once, begins))
        # What can be begun may be, before the supervisor has finished; and who has a choice may choose what takes time.
        is_last = not is_over and any(target in self.graph.over for _, target in at_once)
        for owner in begins if is_last else mixed & begins.keys():
            out += self._begun(node, {owner: begins[owner]})
        # What takes no time is among all that happens at this instant.
        for owner, choices in begins.items() if at_once and not is_last else ():
            timeless = [choice for choice in choices if choice[1].ns == 0]
            if timeless and owner not in mixed:
                out += self._begun(node, {owner: timeless})
        if not ticks and self._calm not in self.graph.marked[state]:
            ticks = [(BEGINS, state)]  # no time stamp lies ahead
        now = [u for u in under_way if u[2] == 0]
        if not at_once and self._rests(state, under_way, begins):
            self.ends.add(node)
        out += self._ended(state, stands, under_way, ending, now, ticks)
        if out or node in self.ends:
            return out
        if begins:
            return list(self._begun(node, begins))
        going = [u for u in under_way if u[2] < FOREVER // 2]
        is_waiting = any(element >= 0 for element, _ in ticks)
        if all(u[0] == CLOCK for u in going) and not is_waiting:
            self._stop(node, stands, under_way)
            return []
        first = min(u[2] for u in going if is_waiting or u[0] != CLOCK)
        if not is_waiting and (passed := _whole_seconds(under_way, first)):
            later = tuple((o, e, ns if o == CLOCK else ns - passed) for o, e, ns in under_way)
            self._calm_seconds.add(node)
            return [(self._number((state, stands, later)), passed, BEGINS)]
        first = min(u[2] for u in going)
        those = [u for u in going if u[2] <= first + TIE]
        return list(self._ended(state, stands, under_way, ending, those, ticks))

    def _rests(self, state: int, under_way: UnderWay, begins: Iterable[int]) -> bool:
        """Whether the cycle is over: the supervisor has finished, no arm does anything, and no device a thing that it
        cannot do, which stops the cell."""
        if state not in self.graph.over or any(ns >= FOREVER // 2 for *_, ns in under_way):
            return False
        owners = (*(owner for owner, *_ in under_way), *begins)
        return not any(owner in self.doings.arm_of for owner in owners)

    def _at_once(
        self,
        state: int,
        stands: tuple[Stand, ...],
        under_way: UnderWay,
        elements: Sequence[tuple[int, int]],
        begins: dict[int, list[tuple[int, Doing]]],
    ) -> Iterator[Arc]:
        for element, target in elements:
            owner = self.graph.elements[element].owner
            for other, choices in begins.items():
                if other != owner and not self._enabled(target).issuperset(e for e, _ in choices):
                    self.why = self.why or "overtaken"
            after = self._with_wait(under_way, owner, element, target)
            is_last = target in self.graph.over and state not in self.graph.over
            for rest in self._last(stands, after) if is_last else (after,):
                yield (self._number((target, stands, rest)), 0, element)

    def _last(self, stands: tuple[Stand, ...], under_way: UnderWay) -> Iterator[UnderWay]:
        """What is still done of what is under way when the supervisor finishes: of several commands the one that is."""
        choices = [[u] if u[1] < 0 else self._commands_now(stands, u) for u in under_way]
        return itertools.product(*choices)

    def _commands_now(
        self, stands: tuple[Stand, ...], entry: tuple[int, int, int]
    ) -> list[tuple[int, int, int]]:
        """The rest of the command that is under way; where one ends just now, of the next one, too."""
        owner, element, ns = entry
        arm = self.doings.arm_of.get(owner)
        doing = self.doings.of(element, None if arm is None else stands[arm])
        assert doing is not None
        if ns >= FOREVER // 2:
            return [entry]
        out = []
        now, begin = doing.ns - ns, 0
        for number, part in enumerate(doing.parts, 1):
            end = begin + part.ns
            if begin - TIE <= now <= end + TIE:
                is_all = number == len(doing.parts)
                out.append(entry if is_all else (owner, LAST, max(0, end - now)))
            begin = end
        return list(dict.fromkeys(out))

    def _with_wait(self, under_way: UnderWay, owner: int, element: int, target: int) -> UnderWay:
        """With the wait of a script after this element; it does not begin one after the supervisor's end."""
        is_begun = self._kinds[element] is Kind.TOLD and target not in self.graph.over
        ns = self.doings.waits(element) if is_begun else 0
        return tuple(sorted((*under_way, (owner, WAITS, ns)))) if ns else under_way

    def _enabled(self, state: int) -> frozenset[int]:
        if state not in self._told:
            self._told[state] = frozenset(element for element, _ in self.graph.arcs[state])
        return self._told[state]

    def _begun(self, node: int, begins: dict[int, list[tuple[int, Doing]]]) -> Iterator[Arc]:
        """Everybody who can begin something does; who has a choice begins any of it.

        What cannot be carried out stops a run there, whatever others could still do.
        """
        state, stands, under_way = self.situations[node]
        for choice in itertools.product(*begins.values()):
            for _, doing in choice:
                if doing.fault:
                    self.faults.setdefault(doing.fault, node)
            new = [(o, e, doing.ns) for o, (e, doing) in zip(begins, choice, strict=True)]
            together = tuple(sorted((*under_way, *new)))
            yield (self._number((state, stands, together)), 0, BEGINS)

    def _ended(
        self,
        state: int,
        stands: tuple[Stand, ...],
        under_way: UnderWay,
        ending: dict[int, list[int]],
        those: Sequence[tuple[int, int, int]],
        ticks: Sequence[tuple[int, int]],
    ) -> Iterator[Arc]:
        """One of those ends, when it does; what should have ended before ends then.

        Args:
            ticks: what a second of the clock does.
        """
        for owner, element, ns in those:
            left = tuple(
                (o, e, more if more >= FOREVER // 2 else max(0, more - ns))
                for o, e, more in under_way
                if o != owner
            )
            if owner == CLOCK:
                left = tuple(sorted(((CLOCK, TICKS, NS), *left)))
                for mark, target in ticks:
                    yield (self._number((target, stands, left)), ns, mark)
                continue
            if element in (WAITS, LAST):
                yield (self._number((state, stands, left)), ns, BEGINS)
                continue
            after = stands
            arm = self.doings.arm_of.get(owner)
            if arm is not None:
                doing = self.doings.of(element, stands[arm])
                assert doing is not None
                if doing.end is not None:
                    after = (*stands[:arm], doing.end, *stands[arm + 1 :])
            if owner not in ending:
                self.why = self.why or "overtaken"
            for target in ending.get(owner, ()):
                later = self._with_wait(left, owner, element, target)
                yield (self._number((target, after, later)), ns, element)

    def _stop(self, node: int, stands: tuple[Stand, ...], under_way: UnderWay) -> None:
        """Nothing more happens, and the cell is not at its end: what somebody cannot do has stopped it, or nothing."""
        why = ""
        for owner, element, _ in under_way:
            if element < 0:
                continue
            arm = self.doings.arm_of.get(owner)
            doing = self.doings.of(element, None if arm is None else stands[arm])
            if doing is not None and doing.fault:
                why = doing.fault
                self.faults.setdefault(why, node)
        if not why:
            self.stuck.append(node)

    def _number(self, s: Situation) -> int:
        state, stands, under_way = s
        key = (state, under_way, *(x.number for x in stands))
        found = self._numbers.get(key)
        if found is None:
            found = self._numbers[key] = len(self.situations)
            self.situations.append(s)
            self.successors.append([])
        return found


def _whole_seconds(under_way: UnderWay, first: int) -> int:
    """ns: whole seconds in which nothing comes near its end, when `first` is the time until that."""
    if not under_way or under_way[0][0] != CLOCK:
        return 0
    # The tick before the first end, with what may end as late as its tie, stays to be looked at.
    return max(0, (first - under_way[0][2] - 2 * TIE) // NS) * NS
