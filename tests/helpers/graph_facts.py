"""What follows from a small graph, by its definitions: slow, and without any of the explorer's algorithms.

Sets of nodes are integers, a bit for each node.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

Arc = tuple[int, int, int]
"""(source, target, transition)"""


@dataclass(slots=True)
class Facts:
    """Of the graph with nodes 0 .. nodes - 1, of which 0 is the initial one."""

    nodes: int
    transitions: int
    arcs: Sequence[Arc]
    reached: list[int] = field(init=False)

    def __post_init__(self) -> None:
        self.reached = [own | 1 << n for n, own in enumerate(self.after(self.arcs))]

    def after(self, arcs: Sequence[Arc]) -> list[int]:
        """For each node those that can be reached from it by at least one of these arcs."""
        found = [0] * self.nodes
        for source, target, _ in arcs:
            found[source] |= 1 << target
        changed = True
        while changed:
            changed = False
            for node in range(self.nodes - 1, -1, -1):
                more, rest = found[node], found[node]
                while rest:
                    last = rest.bit_length() - 1
                    more |= found[last]
                    rest ^= 1 << last
                changed |= more != found[node]
                found[node] = more
        return found

    def fired(self) -> list[int]:
        """Arcs of each transition."""
        return [sum(t == own for _, _, t in self.arcs) for own in range(self.transitions)]

    def depth(self) -> int:
        """The length of the shortest way to the node that is farthest from the initial one."""
        level, seen, depth = {0}, {0}, 0
        while level := {b for a, b, _ in self.arcs if a in level} - seen:
            seen |= level
            depth += 1
        return depth

    def components(self) -> tuple[int, int]:
        """Strongly connected components, and arcs between different ones."""
        own = [
            sum(
                1 << other
                for other in range(self.nodes)
                if self.reached[node] >> other & 1 and self.reached[other] >> node & 1
            )
            for node in range(self.nodes)
        ]
        return len(set(own)), sum(own[a] != own[b] for a, b, _ in self.arcs)

    def home(self) -> set[int]:
        """Nodes that can be reached from all."""
        common = (1 << self.nodes) - 1
        for own in self.reached:
            common &= own
        return {n for n in range(self.nodes) if common >> n & 1}

    def enabled(self, transition: int) -> int:
        """The nodes in which it occurs."""
        found = 0
        for source, _, t in self.arcs:
            if t == transition:
                found |= 1 << source
        return found

    def live(self) -> list[bool]:
        """Transitions that can occur again, whatever has happened."""
        return [all(own & self.enabled(t) for own in self.reached) for t in range(self.transitions)]

    def fairness(self) -> list[str] | None:
        """None without cycles."""
        if not any(own >> n & 1 for n, own in enumerate(self.after(self.arcs))):
            return None
        return [self._fairness(t) for t in range(self.transitions)]

    def _fairness(self, t: int) -> str:
        enabled = self.enabled(t)
        others = [arc for arc in self.arcs if arc[2] != t]
        cyclic = self._cyclic(others)
        if not cyclic:
            return "impartial"
        if not cyclic & enabled:
            return "fair"
        inside = [arc for arc in others if enabled >> arc[0] & 1 and enabled >> arc[1] & 1]
        return "none" if self._cyclic(inside) else "just"

    def _cyclic(self, arcs: Sequence[Arc]) -> int:
        """Nodes that come back to themselves by these arcs."""
        return sum(1 << n for n, own in enumerate(self.after(arcs)) if own >> n & 1)
