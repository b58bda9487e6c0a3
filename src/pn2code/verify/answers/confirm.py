"""Runs that the explorer gives as evidence, looked at again: played by the token game, judged by definition.

What is confirmed here does not depend on any line of C, nor on the translation of a formula into an automaton: the
marking that violates an invariant does so by the reference evaluator; on the lasso the formula is false, position by
position; fairness is kept; the cycle is one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from pn2code.net.flat import FlatNet
from pn2code.properties import judge_ltl
from pn2code.properties import meaning as m
from pn2code.properties.judge import Graph, look
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game
from pn2code.verify.answers.path import play
from pn2code.verify.answers.properties import Answer

MOST_STEPS = 3_000
"""Longer runs take the token game too long; they are not looked at again."""


def problem(
    net: FlatNet,
    storage: Mapping[str, str],
    predicates: m.Properties,
    answer: Answer,
    *,
    exact_times: bool = True,
    as_net: bool = True,
) -> str | None:
    """What is wrong with the evidence of an answer; None: nothing, or it cannot be looked at.

    Args:
        net, storage: as for `Game`.
        predicates: all that was asked: the conditions.
        answer: the answer.
        exact_times: whether nodes differ by their times; else a cycle may end later than it began.
        as_net: whether the run is one of the closed net; else it is one of a cell, in which programs and not the net
            decide what is enabled and when a run ends.

    Raises:
        TraceRefusedError, GameError, OSError: it cannot be played.
        MlException, MlLimit: a condition cannot be evaluated.
    """
    evidence = answer.evidence
    if evidence is None or evidence.steps > MOST_STEPS:
        return None
    game, markings, steps = _played(net, storage, evidence.trace)
    if len(steps) != evidence.steps:
        return f"the trace has {len(steps)} steps, not {evidence.steps}"
    asked = answer.about.asked
    if not as_net and (isinstance(asked, m.Response) or _looks_at_enabled(asked)):
        return None  # that it is a run is all that the net can say
    if answer.answer == "no":
        asked = _of_paths(asked)
    match asked:
        case m.Invariant(condition):
            graph, nodes = _graph(game, [markings[0], markings[-1]], predicates, {condition})
            if nodes[-1] in graph.nodes(condition):
                return "the last marking of the trace decides nothing"
        case m.Bound(place, low, high):
            size = len(markings[-1].places[place])
            if size >= (low or 0) and (high is None or size <= high):
                return f"the last marking of the trace has {size} tokens"
        case m.Linear(formula, fair):
            fair = fair if as_net else ()  # of a cell that is not seen in the net
            looks = {formula, *(m.Atom("enabled", x.transition) for x in fair)}
            graph, nodes = _graph(game, markings, predicates, looks)
            path = _lasso(graph, nodes, steps, evidence.loop, exact_times, as_net)
            if isinstance(path, str):
                return path
            if judge_ltl.holds_on(graph, formula, path):
                return "the formula is true on the run"
            if not judge_ltl.is_fair(graph, fair, path):
                return "the run is not fair"
        case m.Response(first, second):
            graph, nodes = _graph(game, markings, predicates, {first, second})
            path = _lasso(graph, nodes, steps, evidence.loop, exact_times, as_net)
            if isinstance(path, str) and evidence.loop is not None:
                return path
            goes_on = None if isinstance(path, str) else path.after(len(path.positions) - 1)
            times = [float(marking.time) for marking in markings]
            if not _Waits(graph, nodes, steps, times, asked, goes_on).is_too_long():
                return "no wait in the run is too long"
        case m.Branching():
            pass  # what one run shows of a formula that branches is no proof of it
    return None


def _of_paths(asked: m.Asked) -> m.Asked:
    """What a formula that branches, and that one run can violate, says of each path; all else as it is."""
    match asked:
        case m.Branching(m.Op("AF", (p,))) if m.is_of_nodes(p):
            return m.Linear(m.Op("F", (p,)))
        case m.Branching(m.Op("AG", (m.Op("AF", (p,)),))) if m.is_of_nodes(p):
            return m.Linear(m.Op("G", (m.Op("F", (p,)),)))
        case m.Branching(m.Op("AG", (m.Op("implies", (q, m.Op("AF", (p,)))),))) if m.is_of_nodes(
            p
        ) and m.is_of_nodes(q):
            return m.Linear(m.Op("G", (m.Op("implies", (q, m.Op("F", (p,)))),)))
        case _:
            return asked


class _Waits:
    """The waits in a run for a bounded response.

    Args:
        graph: of its markings.
        nodes: markings of the run.
        steps: the transitions between them.
        times: of the markings.
        asked: the property.
        goes_on: the step with which the run goes on for ever; as many as there are steps: it stands still; None: it may
            go on anyhow.
    """

    def __init__(
        self,
        graph: Graph,
        nodes: Sequence[int],
        steps: Sequence[int],
        times: Sequence[float],
        asked: m.Response,
        goes_on: int | None,
    ) -> None:
        self._graph = graph
        self._nodes = nodes
        self._steps = steps
        self._times = times
        self._asked = asked
        self._goes_on = goes_on

    def is_too_long(self) -> bool:
        """Whether one is."""
        first, second = self._asked.first, self._asked.second
        starts = [i for i in range(len(self._nodes)) if self._happens(first, i)]
        return any(self._is_late(i) for i in starts if not self._is_at(second, i))

    def _is_at(self, f: m.Formula, i: int) -> bool:
        return not m.looks_at_steps(f) and self._nodes[i] in self._graph.nodes(f)

    def _happens(self, f: m.Formula, i: int) -> bool:
        """Whether marking i, or the step to it, is an event."""
        if not m.looks_at_steps(f):
            return self._is_at(f, i)
        return i > 0 and self._steps[i - 1] in {a.number for a in m.atoms(f)}

    def _is_late(self, start: int) -> bool:
        for i in range(start + 1, len(self._nodes)):
            if self._asked.firings is not None:
                is_over = i - start > self._asked.firings
            else:
                is_over = self._times[i] - self._times[start] > float(self._asked.time or 0)
            if is_over or self._happens(self._asked.second, i):
                return is_over
        if self._goes_on is None:
            return False
        again = range(self._goes_on + 1, len(self._nodes))
        return not any(self._happens(self._asked.second, i) for i in again)


def _played(
    net: FlatNet, storage: Mapping[str, str], trace: Path
) -> tuple[Game, list[Marking], list[int]]:
    game, played = play(net, storage, trace)
    markings, steps = [game.marking], []
    for _, transition in played:
        markings.append(game.marking)
        steps.append(transition.index)
    return game, markings, steps


def _graph(
    game: Game, markings: Sequence[Marking], properties: m.Properties, formulas: Iterable[m.Formula]
) -> tuple[Graph, list[int]]:
    """The nodes of a run with what the formulas look at, the last one with all; and the nodes in order."""
    atoms = set(_atoms(formulas))
    wanted = {x.number for x in atoms if x.kind == "pred"}
    needs_enabled = any(x.kind in ("dead", "enabled") for x in atoms)
    index: dict[Marking, int] = {}
    nodes = [index.setdefault(marking, len(index)) for marking in markings]
    arcs: list[tuple[int, int, int]] = []
    for marking, n in index.items():
        if not needs_enabled and n != nodes[-1]:
            continue
        # Where they lead does not matter: nothing is asked that looks farther than the run.
        arcs += ((n, t.index, n) for t in game.enabled_transitions(game.advance_time(marking)))
    holds = tuple(
        frozenset(n for marking, n in index.items() if i in wanted and look(game, p, marking))
        for i, p in enumerate(properties.predicates)
    )
    return Graph(tuple(float(x.time) for x in index), tuple(arcs), holds, tuple(index)), nodes


def _atoms(formulas: Iterable[m.Formula]) -> Iterator[m.Atom]:
    for f in formulas:
        if isinstance(f, m.Atom):
            yield f
        else:
            yield from _atoms(f.parts)


def _looks_at_enabled(asked: m.Asked) -> bool:
    return any(x.kind in ("dead", "enabled") for x in _atoms(m.formulas(asked)))


def _lasso(
    graph: Graph,
    nodes: list[int],
    steps: list[int],
    loop: int | None,
    exact_times: bool,
    as_net: bool,
) -> judge_ltl.Lasso | str:
    """The run as a lasso; a text if it is none."""
    positions = [judge_ltl.Position(nodes[i], step, nodes[i + 1]) for i, step in enumerate(steps)]
    last = nodes[-1]
    if loop is None or loop >= len(steps):
        if as_net and last not in graph.dead:
            return "the run ends where something is enabled"
        end = judge_ltl.Position(last, judge_ltl.NO_STEP, last)
        return judge_ltl.Lasso((*positions, end), len(positions))
    if as_net and exact_times and nodes[loop] != last:
        return "the cycle of the run does not come back to where it begins"
    return judge_ltl.Lasso(tuple(positions), loop)
