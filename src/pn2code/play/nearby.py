"""The state space around the current marking, as far as somebody wants to see it; a way to a dead marking.

space = around(session, depth=3, most=60)
space.nodes, space.arcs
path(space, 7)                              # the elements that lead to node 7

Breadth first, by the reference token game, so each way is as short as it can be.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from pn2code.base.frozen import frozen
from pn2code.play.session import Session
from pn2code.play.trouble import Trouble
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.graph import Nodes
from pn2code.semantics.game.marking import BindingElement, Marking

MOST_NODES = 400
MOST_DEPTH = 50
MOST_ARCS = 4_000
MOST_SEARCHED = 200_000
"""Markings that a search for a dead one looks at."""
_TELL_S = 0.2

Tell = Callable[[int, float], None]


@frozen
class Node:
    """A marking.

    Args:
        marking: the marking.
        depth: occurrences from the current one.
        parent: the node before it on the way to it, and what occurs between them; None: it is the current marking.
        is_dead: nothing is ever enabled in it. is_open: it has successors that are not there.
        failure: what the net does wrong there, such as raising an exception, in words; "": nothing. What would follow
            is not known then.
    """

    marking: Marking
    depth: int
    parent: tuple[int, BindingElement] | None
    is_dead: bool = False
    is_open: bool = False
    failure: str = ""


@frozen
class Arc:
    """An occurrence between two nodes."""

    source: int
    element: BindingElement
    target: int


@frozen
class Space:
    """What is around a marking; node 0 is the marking itself.

    Args:
        nodes, arcs: what was found.
        why: what keeps it from being all: "depth", "nodes", "stopped"; "" for nothing: it is the whole space.
    """

    nodes: tuple[Node, ...]
    arcs: tuple[Arc, ...]
    why: str


def around(session: Session, depth: int, most: int) -> Space:
    """The markings within so many occurrences, at most so many of them."""
    session.stop.clear()
    game = session.game
    key = Nodes(session.net).key
    known = {key(game.marking): 0}
    found = [Node(game.marking, 0, None)]
    arcs: list[Arc] = []
    why = ""
    at = 0
    while at < len(found):
        node = found[at]
        elements, marking, failure = _successors(session, node.marking)
        if session.stop.is_set():
            why = "stopped"
            break
        is_open = False
        for element in elements:
            if node.depth >= depth or len(arcs) >= MOST_ARCS:
                is_open, why = True, why or "depth"
                break
            try:
                after, occurred = game.occur(marking, element)
            except GameError as error:
                failure = failure or _words(error)
                continue
            k = key(after)
            if k not in known:
                if len(found) >= most:
                    is_open, why = True, "nodes"
                    continue
                known[k] = len(found)
                found.append(Node(after, node.depth + 1, (at, element)))
            arcs.append(Arc(at, occurred, known[k]))
        is_dead = not elements and not failure
        found[at] = Node(node.marking, node.depth, node.parent, is_dead, is_open, failure)
        at += 1
    open_ = [Node(n.marking, n.depth, n.parent, False, True) for n in found[at:]]
    return Space((*found[:at], *open_), tuple(arcs), why)


def _successors(session: Session, marking: Marking) -> tuple[list[BindingElement], Marking, str]:
    """What is enabled next, the marking at the time when it is, and what the net does wrong when it is asked."""
    game = session.game
    try:
        later = game.advance_time(marking)
        elements = game.enabled_in(later)
    except GameError as error:
        return [], marking, _words(error)
    return elements, later if elements else marking, ""


def _words(error: GameError) -> str:
    """What is wrong, and where."""
    return f"{error.origin.describe()}: {error.message}"


def path(space: Space, node: int) -> list[BindingElement]:
    """The elements that lead from the current marking to a node."""
    elements: list[BindingElement] = []
    parent = space.nodes[node].parent
    while parent is not None:
        elements.append(parent[1])
        parent = space.nodes[parent[0]].parent
    return elements[::-1]


def to_dead(session: Session, most: int, tell: Tell) -> list[BindingElement]:
    """The shortest way to a dead marking.

    Args:
        session: where it begins.
        most: markings that are looked at.
        tell: how many have been looked at.

    Raises:
        Trouble: there is none, or none was found; what follows where the net raises an exception is not known.
    """
    session.stop.clear()
    game = session.game
    key = Nodes(session.net).key
    known = {key(game.marking)}
    queue: list[tuple[Marking, int, BindingElement | None]] = [(game.marking, -1, None)]
    at, told = 0, time.monotonic()
    failed, failure = 0, ""
    while at < len(queue):
        elements, marking, wrong = _successors(session, queue[at][0])
        if not elements and not wrong:
            return _way(queue, at)
        if session.stop.is_set():
            raise Trouble(f"stopped: no dead marking is among the {at:,} that were looked at")
        if time.monotonic() - told > _TELL_S:
            told = time.monotonic()
            tell(at, 0.0)
        for element in elements:
            try:
                after, _ = game.occur(marking, element)
            except GameError as error:
                wrong = _words(error)
                continue
            k = key(after)
            if k not in known:
                if len(queue) >= most:
                    raise Trouble(
                        f"no dead marking is among the nearest {at:,}; ask for `deadlock free` to look at all"
                    )
                known.add(k)
                queue.append((after, at, element))
        failed, failure = failed + bool(wrong), failure or wrong
        at += 1
    if failed:
        raise Trouble(
            f"no dead marking was found in all {len(queue):,} markings, but in {failed:,} of them the net cannot go on "
            f"somewhere: {failure}"
        )
    raise Trouble(f"no dead marking can be reached: all {len(queue):,} markings were looked at")


def _way(queue: list[tuple[Marking, int, BindingElement | None]], at: int) -> list[BindingElement]:
    elements: list[BindingElement] = []
    while at >= 0:
        _, parent, element = queue[at]
        if element is not None:
            elements.append(element)
        at = parent
    return elements[::-1]


def follow(session: Session, elements: list[BindingElement]) -> None:
    """Lets these elements occur, the time moving on where nothing is enabled.

    Raises:
        Trouble: one of them is not possible.
    """
    for element in elements:
        session.fire_later(element)
