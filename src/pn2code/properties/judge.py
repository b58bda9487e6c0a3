"""An independent judge of properties: slow, obvious, by the definitions.

    graph = Graph.of(net, storage, properties, most=2000)
    graph.says(properties.properties[0].asked)        # True or False

It plays the reference token game, evaluates conditions with the reference evaluator, computes CTL as fixpoints of sets,
LTL with a tableau of its own (`judge_ltl`), responses by walking all paths. It shares the meaning of the properties
(`meaning`) with the explorer, and nothing else: no item, no automaton, no line of C.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from pn2code.net.flat import FlatNet
from pn2code.net.predicate import Predicate
from pn2code.properties import judge_ltl
from pn2code.properties import meaning as m
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.graph import state_space
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import Value
from pn2code.semantics.values.multiset import MultiSet

Nodes = frozenset[int]


def look(game: Game, predicate: Predicate, marking: Marking) -> bool:
    """Whether a condition holds in a marking.

    Raises:
        MlException, MlLimit: evaluating it does.
    """
    game.enter(marking)
    found = {symbol: tokens(game, marking, place) for symbol, place in predicate.places}
    return game.evaluator.value(predicate.exp, found) is True


def tokens(game: Game, marking: Marking, place: int) -> tuple[Value, ...]:
    """What a place holds as a list: in the order of the colour set, then of the stamps."""
    colset = game.net.places[place].colset
    held = marking.places[place]
    if isinstance(held, MultiSet):
        values = game.colours.sorted(colset, held.counts)
        return tuple(v for v in values for _ in range(held.counts[v]))
    values = game.colours.sorted(colset, held.stamps)
    return tuple(token for v in values for token in held.tokens(v))


class TooManyNodesError(Exception):
    """The state space is larger than what the judge looks at."""


@dataclass
class Graph:
    """A complete state space with conditions on its nodes.

    Args:
        times: of each node; node 0 is the initial one.
        arcs: (source, transition, target), each once.
        holds: for each predicate the nodes where it holds.
    """

    times: tuple[float, ...]
    arcs: tuple[tuple[int, int, int], ...]
    holds: tuple[Nodes, ...] = ()
    markings: tuple[Marking, ...] = ()
    _known: dict[m.Formula, Nodes] = field(default_factory=dict)

    @staticmethod
    def of(
        net: FlatNet, storage: Mapping[str, str], properties: m.Properties, *, most: int = 10_000
    ) -> Graph:
        """That of a net.

        Raises:
            TooManyNodesError: it has more nodes.
            GameError: an inscription raises an exception.
            MlException, MlLimit: a condition does.
        """
        game = Game(net, storage, files=Files(None))
        space = state_space(game, max_nodes=most)
        if not space.complete:
            raise TooManyNodesError
        arcs = dict.fromkeys((a.source, a.element.transition, a.target) for a in space.arcs)
        holds = tuple(
            frozenset(n for n, marking in enumerate(space.nodes) if look(game, p, marking))
            for p in properties.predicates
        )
        return Graph(
            tuple(float(marking.time) for marking in space.nodes), tuple(arcs), holds, space.nodes
        )

    @cached_property
    def everything(self) -> Nodes:
        """All nodes."""
        return frozenset(range(len(self.times)))

    @cached_property
    def next(self) -> tuple[frozenset[int], ...]:
        """The successors of each node."""
        found: list[set[int]] = [set() for _ in self.times]
        for source, _, target in self.arcs:
            found[source].add(target)
        return tuple(map(frozenset, found))

    @cached_property
    def dead(self) -> Nodes:
        """Nodes without successor."""
        return frozenset(n for n in self.everything if not self.next[n])

    def enabled(self, t: int) -> Nodes:
        """Where a transition can occur."""
        return frozenset(source for source, other, _ in self.arcs if other == t)

    def says(self, asked: m.Asked) -> bool:
        """Whether a property is true."""
        match asked:
            case m.Invariant(condition, wanted):
                return (self.nodes(condition) == self.everything) == wanted
            case m.Bound(place, low, high):
                sizes = [len(marking.places[place]) for marking in self.markings]
                return min(sizes) >= (low or 0) and (high is None or max(sizes) <= high)
            case m.Branching(formula):
                return 0 in self.nodes(formula)
            case m.Linear(formula, fair):
                return not judge_ltl.some_path(self, m.negation(formula), fair)
            case m.Response():
                return self._responds(asked)

    # --- CTL ---------------------------------------------------------------------------------------

    def nodes(self, f: m.Formula) -> Nodes:
        """Where a formula of CTL holds."""
        if f not in self._known:
            self._known[f] = self._atom(f) if isinstance(f, m.Atom) else self._operator(f)
        return self._known[f]

    def _atom(self, f: m.Atom) -> Nodes:
        match f.kind:
            case "true":
                return self.everything
            case "dead":
                return self.dead
            case "initial":
                return frozenset({0})
            case "pred":
                return self.holds[f.number]
            case "enabled":
                return self.enabled(f.number)
            case other:
                raise AssertionError(other)

    def _operator(self, f: m.Op) -> Nodes:
        parts = [self.nodes(x) for x in f.parts]
        a, b = parts[0], parts[-1]
        no_a = self.everything - a
        match f.operator:
            case "not":
                return no_a
            case "and":
                return a & b
            case "or":
                return a | b
            case "implies":
                return no_a | b
            case "iff":
                return (a & b) | (no_a - b)
            case "EX":
                return self._some(a, f.step)
            case "AX":
                return self.everything - self._some(no_a, f.step)
            case "EF":
                return self._least(lambda z: a | self._some(z))
            case "AF":
                return self._least(lambda z: a | (self._all(z) - self.dead))
            case "EG":
                return self._greatest(lambda z: a & (self._some(z) | self.dead))
            case "AG":
                return self._greatest(lambda z: a & self._all(z))
            case "EU":
                return self._least(lambda z: b | (a & self._some(z)))
            case "AU":
                return self._least(lambda z: b | (a & (self._all(z) - self.dead)))
            case "EW":
                return self._greatest(lambda z: b | (a & (self._some(z) | self.dead)))
            case "AW":
                return self._greatest(lambda z: b | (a & self._all(z)))
            case "ER":
                return self._greatest(lambda z: b & (a | self._some(z) | self.dead))
            case "AR":
                return self._greatest(lambda z: b & (a | self._all(z)))
            case other:
                raise AssertionError(other)

    def _some(self, z: Nodes, step: int = -1) -> Nodes:
        """Where some arc (of a transition) leads into a set."""
        return frozenset(s for s, t, to in self.arcs if to in z and step in (-1, t))

    def _all(self, z: Nodes) -> Nodes:
        """Where all arcs lead into a set; dead nodes, too."""
        return frozenset(n for n in self.everything if self.next[n] <= z)

    def _least(self, step: Callable[[Nodes], Nodes]) -> Nodes:
        z: Nodes = frozenset()
        while (more := step(z)) != z:
            z = more
        return z

    def _greatest(self, step: Callable[[Nodes], Nodes]) -> Nodes:
        z = self.everything
        while (less := step(z)) != z:
            z = less
        return z

    # --- bounded responses -------------------------------------------------------------------------

    def _responds(self, asked: m.Response) -> bool:
        """From each node after a first event: whether no path goes on too long without the second."""
        first = asked.first
        if m.looks_at_steps(first):
            begin = {a.number for a in m.atoms(first)}
            starts = {to for _, t, to in self.arcs if t in begin}
        else:
            starts = set(self.nodes(first))
        second = asked.second
        if m.looks_at_steps(second):
            good: Nodes = frozenset()
            end = {a.number for a in m.atoms(second)}
            arcs = [(s, to) for s, t, to in self.arcs if t not in end]
        else:
            good = self.nodes(second)
            arcs = [(s, to) for s, _, to in self.arcs]
        # Waiting: nodes that can be reached without the second event.
        onward: dict[int, set[int]] = {}
        for s, to in arcs:
            if s not in good and to not in good:
                onward.setdefault(s, set()).add(to)
        for start in starts - good:
            if asked.firings is not None:
                late = self._waits_firings(start, onward, asked.firings)
            else:
                late = self._waits_time(start, onward, float(asked.time or 0))
            if late:
                return False
        return True

    def _waits_firings(self, start: int, onward: Mapping[int, set[int]], most: int) -> bool:
        now = {start}
        for _ in range(min(most, len(self.times) + 1)):
            if now & self.dead:
                return True
            now = {to for n in now for to in onward.get(n, ())}
        return bool(now)

    def _waits_time(self, start: int, onward: Mapping[int, set[int]], most: float) -> bool:
        seen: set[int] = set()
        todo = [start]
        while todo:
            n = todo.pop()
            if n in self.dead:
                return True
            # Whatever comes next comes too late: the second event, too, if it is that.
            if any(self.times[to] - self.times[start] > most for to in self.next[n]):
                return True
            if n not in seen:
                seen.add(n)
                todo.extend(onward.get(n, ()))
        # Nobody is late, and nobody goes on for ever: without a cycle the paths end in the second event.
        left = set(seen)
        while ending := {n for n in left if not onward.get(n, set()) & left}:
            left -= ending
        return bool(left)
