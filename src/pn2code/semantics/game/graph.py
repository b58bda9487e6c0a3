"""Complete state spaces of small nets, for comparison with other engines. Breadth first, bounded.

A node is a marking together with its model time; from a node in which nothing is enabled the time moves on before
the next occurrence, as in CPN Tools. Markings that differ in the sign of a zero are two nodes: they are equal, but an
inscription may tell them apart (`Real.signBit`, `1.0 / x`).
"""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.ml.core.reals import may_hold_reals
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.marking import BindingElement, Marking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import zero_signs


@frozen
class StateArc:
    """An occurrence that leads from one node to another; nodes by index."""

    source: int
    element: BindingElement
    target: int


@frozen
class StateSpace:
    """Markings and occurrences between them.

    Args:
        nodes: node 0 is the initial marking.
        arcs: each (source, element, target) once.
        complete: whether all successors of all nodes are there. If not, `dead` says nothing of the nodes
            that were not expanded.
        dead: nodes without successor.
    """

    nodes: tuple[Marking, ...]
    arcs: tuple[StateArc, ...]
    complete: bool
    dead: tuple[int, ...]


def state_space(game: Game, *, max_nodes: int = 10_000, max_arcs: int | None = None) -> StateSpace:
    """All markings that can be reached from the game's current one, at most `max_nodes` of them.

    Args:
        game: is not changed.
        max_nodes: as many are expanded when there are more.
        max_arcs: ends at once, incomplete, when there are more of either.

    Raises:
        GameError: an inscription raises an exception somewhere on the way.
    """
    node = Nodes(game.net)
    index = {node.key(game.marking): 0}
    nodes = [game.marking]
    arcs: dict[StateArc, None] = {}
    dead: list[int] = []
    complete = True
    at = 0
    while at < len(nodes):
        marking = game.advance_time(nodes[at])
        elements = game.enabled_in(marking)
        if not elements:
            dead.append(at)
        for element in elements:
            successor, occurred = game.occur(marking, element)
            key = node.key(successor)
            if key not in index:
                if len(nodes) >= max_nodes:
                    if max_arcs is not None:
                        return StateSpace(tuple(nodes), tuple(arcs), False, ())
                    complete = False
                    continue
                index[key] = len(nodes)
                nodes.append(successor)
            arcs[StateArc(at, occurred, index[key])] = None
            if max_arcs is not None and len(arcs) > max_arcs:
                return StateSpace(tuple(nodes), tuple(arcs), False, ())
        at += 1
    return StateSpace(tuple(nodes), tuple(arcs), complete, tuple(dead))


_Key = tuple[Marking, frozenset[tuple[int, str]]]


class Nodes:
    """Tells the markings of a net apart: by what they hold, and by the signs of zeros in it."""

    def __init__(self, net: FlatNet) -> None:
        datatypes = net.program.datatypes
        self._places = [p.index for p in net.places if may_hold_reals(p.colset.type, datatypes)]

    def key(self, marking: Marking) -> _Key:
        """Equal for the markings that no inscription can tell apart."""
        return marking, self.signs(marking)

    def signs(self, marking: Marking) -> frozenset[tuple[int, str]]:
        """The tokens that have negative zeros."""
        return frozenset(
            (place, repr(token))
            for place in self._places
            for token in marking.places[place]
            if any(zero_signs(token))
        )
