"""The checks of a supervisor by definition, on small graphs: by going over all nodes again and again.

An independent judge of cnative/src/explore/query/explore_control.c: it shares nothing with it but the words of
docs/execution.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from helpers.questions import Lts


@dataclass(frozen=True, slots=True)
class Scheme:
    """A graph, whose the transitions are (0: the supervisor's), at which nodes the time goes on first."""

    lts: Lts
    owner: Sequence[int]
    late: frozenset[int]

    def steps(self, node: int) -> list[tuple[int, int]]:
        """What the supervisor may do at once."""
        if node in self.late:
            return []
        return [(label, target) for label, target in self.lts.arcs[node] if self.owner[label] == 0]

    def endless(self) -> set[int]:
        """Where a run of steps begins that does not end: what is left when ends are taken away."""
        left = set(range(len(self.lts.arcs)))
        while ends := {n for n in left if not any(t in left for _, t in self.steps(n))}:
            left -= ends
        return left

    def longest(self, node: int) -> int:
        """The longest run of steps; there is one."""
        return max((1 + self.longest(target) for _, target in self.steps(node)), default=0)

    def rests(self, node: int) -> set[int]:
        """Where runs of steps end."""
        found, todo = {node}, [node]
        while todo:
            for _, target in self.steps(todo.pop()):
                if target not in found:
                    found.add(target)
                    todo.append(target)
        return {n for n in found if not self.steps(n)}

    def controlled(self, node: int, final: set[int]) -> list[tuple[int, int]]:
        """The arcs that the scheme leaves: of the supervisor's the first one."""
        if node in final and not self.steps(node):
            return []
        found = []
        has_own = False
        for label, target in self.lts.arcs[node]:
            if self.owner[label] != 0:
                found.append((label, target))
            elif not has_own:
                has_own = True
                found.append((label, target))
        return found

    def reached(self, final: set[int], start: int = 0) -> set[int]:
        """What can be reached so."""
        found, todo = {start}, [start]
        while todo:
            for _, target in self.controlled(todo.pop(), final):
                if target not in found:
                    found.add(target)
                    todo.append(target)
        return found

    def blocked(self, final: set[int]) -> set[int]:
        """Of these the ones from which no end can be reached."""
        ends = {n for n in final if not self.steps(n)}
        return {n for n in self.reached(final) if not self.reached(final, n) & ends}
