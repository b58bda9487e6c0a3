"""A longest wait by what programs do themselves: nobody has to know when others come to what they do.

    found = by_own_work(anyhow, first, second)      # Wait; None: at some time between the events nobody is at work
    found.ns                                        # no wait is longer

The time between two events is that of the commands of one program, if that program is at work whenever time goes by in
between: in each state of the cell in which the second event is waited for, either something happens that takes no
time, or the program has a command. Then a wait takes at most what it does on the way on which that is most, if no
command takes more than its time, in whatever order others come to their ends, however far belts run, and whatever time
stamps lie ahead. The same is so of all programs together.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

from pn2code.timing.anyhow import Anyhow
from pn2code.timing.doings import FOREVER
from pn2code.timing.longest import Arc
from pn2code.timing.steps import Kind, kinds
from pn2code.timing.waits import Is, Wait, longest_wait, waiting


def by_own_work(anyhow: Anyhow, first: Is, second: Is) -> Wait | None:
    """The least such bound of single programs and of all together, or why there is none; None: all are idle at some
    time in between, or not all states are known."""
    if anyhow.why:
        return None
    inside = waiting(anyhow.successors, first, second)
    if not inside:
        return Wait(0)
    work = _Work(anyhow)
    groups = dict.fromkeys([*(frozenset((x,)) for x in work.owners), frozenset(work.owners)])
    found = [
        longest_wait(work.own(group, second), first, second, anyhow.ends())
        for group in groups
        if all(map(work.always(group), inside))
    ]
    return min(found, key=lambda x: FOREVER if x.ns is None else x.ns, default=None)


class _Work:
    """Who has a command in which states."""

    def __init__(self, anyhow: Anyhow) -> None:
        self.anyhow, self.graph = anyhow, anyhow.graph
        self.kinds = kinds(self.graph)
        told = [i for i, kind in enumerate(self.kinds) if kind is Kind.TOLD]
        # A script that waits for a time is not at work, and does not show what it will do.
        self.waits = {self.graph.elements[i].owner for i in told if anyhow.doings.waits(i)}
        self.owners = sorted({self.graph.elements[i].owner for i in told} - self.waits)
        self._busy: dict[int, dict[int, int]] = {}

    def busy(self, node: int) -> dict[int, int]:
        """Who has a command there, and how long it takes at most (ns)."""
        if node not in self._busy:
            state, stands = self.anyhow.nodes[node]
            found: dict[int, int] = {}
            for element, _ in self.graph.arcs[state]:
                if self.kinds[element] is not Kind.TOLD:
                    continue
                owner = self.graph.elements[element].owner
                arm = self.anyhow.doings.arm_of.get(owner)
                doing = self.anyhow.doings.of(element, None if arm is None else stands[arm])
                if doing is not None:
                    found[owner] = max(doing.ns, found.get(owner, 0))
            self._busy[node] = found
        return self._busy[node]

    def always(self, owners: frozenset[int]) -> Is:
        """Whether in a node no time goes by, or one of these owners is at work."""

        def is_so(node: int) -> bool:
            busy = self.busy(node)
            at_work = any(busy.get(owner, FOREVER) < FOREVER for owner in owners)
            return at_work or self._is_at_once(node, busy)

        return is_so

    def _is_at_once(self, node: int, busy: Collection[int]) -> bool:
        for _, _, mark in self.anyhow.successors[node]:
            kind = self.kinds[mark]
            if kind in (Kind.STEP, Kind.FIRING):
                return True
            owner = self.graph.elements[mark].owner
            if kind is Kind.TOLD and owner not in busy and owner not in self.waits:
                return True
        return False

    def own(self, owners: frozenset[int], second: Is) -> Sequence[Sequence[Arc]]:
        """The arcs with what these owners do alone; what they are about when another one's event comes is done by
        then at most."""
        elements = self.graph.elements

        def ns_of(node: int, ns: int, mark: int) -> int:
            mine = elements[mark].owner
            done = ns if mine in owners else 0
            if second(mark):
                done += sum(most for x, most in self.busy(node).items() if x in owners - {mine})
            return done

        return [
            [(to, ns_of(node, ns, mark), mark) for to, ns, mark in arcs]
            for node, arcs in enumerate(self.anyhow.successors)
        ]
