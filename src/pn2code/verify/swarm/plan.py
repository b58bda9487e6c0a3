"""Which searches a swarm consists of: the number of a search decides everything about it.

arguments(7)      # ("--swarm", "8", "--walk", "--max-depth", "300")
"""

from __future__ import annotations

from pn2code.base.frozen import frozen

DEPTHS = (100, 1_000, 300, 3_000)
"""Steps of a run at most, in turn. The token game plays no longer ones again, so nothing is looked for beyond."""
STATES = 1_000_000
"""Markings that a search looks at, unless `--max-states` says how many."""
MEMORY = 256
"""MiB of a search, unless `--memory` says how much. It must not depend on the machine, as all else does on it."""
SKETCH = 1_024
"""Hashes by which the searches are compared."""
_REVERSED = 1
"""The order of successors that is the opposite of the usual one; greater numbers are by chance."""


@frozen
class Search:
    """One of them.

    Args:
        number: from 0 on.
        is_walk: at random from the initial marking on, again and again; else depth first with bit states.
        seed: of the hash, of the order of successors, of the walks.
        depth: most steps of a run.
    """

    number: int
    is_walk: bool
    seed: int
    depth: int

    @staticmethod
    def of(number: int) -> Search:
        """The one with that number: every second one walks, and then all depths come in turn."""
        return Search(number, number % 2 == 1, number + 1, DEPTHS[number // 2 % len(DEPTHS)])

    def arguments(self) -> tuple[str, ...]:
        """For the explorer."""
        how = ("--walk",) if self.is_walk else ("--shuffle", str(self.seed + _REVERSED))
        return ("--swarm", str(self.seed), *how, "--max-depth", str(self.depth))
