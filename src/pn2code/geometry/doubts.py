"""Why not all situations of a cell are known."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.geometry.graph import CellGraph
from pn2code.geometry.situation import Met

MOST_DOUBTS = 12
"""That are told; of two transitions one."""
APART = (
    "let the net command one of them only when the other one has answered: with a place of the supervisor with one "
    "token, which is taken before each of these commands and given back on its answer"
)


@frozen(eq=False)
class Doubt:
    """Why not all situations are known, and where that is so first; or something that surely cannot be done.

    Args:
        why: as in `words.reason`; says: what of it is known, as a clause.
        do: what the user can do.
        is_sure: two programs cannot do what they do at once: the second moves a plate, the first handles a part on it.
    """

    why: str
    says: str
    do: str
    met: Met
    is_sure: bool = False


class Doubts:
    """Those that were noted, each where it was met first.

    Args:
        graph: of the cell; what keeps it from being known is the first reason here.
    """

    def __init__(self, graph: CellGraph) -> None:
        self._graph = graph
        self.why = graph.why
        self.told: dict[tuple[object, ...], Doubt] = {}
        """by why, and the transitions"""

    def note(self, why: str, number: int, elements: tuple[int, ...], says: str, do: str) -> None:
        """Notes why not all is known, and the first situation in which that is so."""
        self.because(why)
        key = (why, *(self._graph.elements[e].transition for e in elements))
        self.tell(key, Doubt(why, says, do, Met(number, elements)))

    def because(self, why: str) -> None:
        """Not all is known, which somebody else tells of; the first reason is the one that is said."""
        self.why = self.why or why

    def tell(self, key: tuple[object, ...], doubt: Doubt) -> None:
        """Keeps one of each kind and of not too many; what surely cannot be done, in any case."""
        known = self.told.get(key)
        if known is not None and doubt.is_sure and not known.is_sure:
            del self.told[key]
            known = None
        if known is None and (doubt.is_sure or len(self.told) < MOST_DOUBTS):
            self.told[key] = doubt

    def name(self, element: int) -> str:
        """Of its transition."""
        t = self._graph.elements[element].transition
        return f"`{self._graph.partition.net.transitions[t].name}`"
