"""What the programs of a cell may do, by definition: an independent judge of `verify.controller.running` and of the
explorer.

    programs = Programs(running)
    programs.space(1000)              # nodes and arcs, by breadth first
    programs.follow(steps)            # how many of the recorded steps are a run of the cell

The net is played by the reference token game; which of the enabled binding elements a program takes is worked out here
in a few lines, and shares nothing with cnative/src/explore/search/explore_successors.c but the words of
docs/execution.md. Untimed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from pn2code.net.flat import FlatTransition
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.marking import BindingElement, Marking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.colour_json import to_json
from pn2code.verify.controller.running import Running

Step = tuple[str, dict[str, Any]]


@dataclass(frozen=True)
class Arc:
    """A step: which transition with which binding, and where it leads."""

    name: str
    element: BindingElement
    target: Marking


class Programs:
    """The programs of a cell.

    Args:
        running: the cell.
    """

    def __init__(self, running: Running) -> None:
        self.game = Game(running.net, {}, files=Files(None))
        self.names = running.names
        self._probes = frozenset(running.probes)
        self._meek = frozenset(running.meek)
        count = len(running.partition.net.transitions)
        whose = [*running.partition.transition_owner, *running.steps]
        order = sorted(running.net.transitions, key=lambda t: (t.priority, t.index))
        self._own = [
            [t for t in order if whose[t.index] == o and t.index < count]
            for o in range(len(running.partition.owners))
        ]
        self._steps = [
            [t for t in order if whose[t.index] == o and t.index >= count]
            for o in range(len(running.partition.owners))
        ]
        self._known: dict[Marking, list[Arc]] = {}

    def arcs(self, marking: Marking) -> list[Arc]:
        """All steps of all programs."""
        if marking not in self._known:
            found = [
                Arc(t.name, element, self.game.occur(marking, element)[0])
                for owner in range(len(self._own))
                for t, element in self._of(owner, marking)
            ]
            self._known[marking] = found
        return self._known[marking]

    def _of(self, owner: int, marking: Marking) -> Iterator[tuple[FlatTransition, BindingElement]]:
        is_busy = False
        for t in self._own[owner]:
            bindings = list(self.game.bindings(t, marking))
            if not bindings:
                continue
            is_busy = True
            # The supervisor takes the first binding; a robot's sensors decide among those of its transition.
            for binding in bindings[:1] if owner == 0 else bindings:
                yield t, BindingElement.make(t, binding)
            if t.index not in self._meek:
                return
        if is_busy:
            return
        urgency = None
        for t in self._steps[owner]:
            bindings = list(self.game.bindings(t, marking))
            if not bindings or (urgency is not None and t.priority > urgency):
                continue
            urgency = t.priority
            if t.index not in self._probes:
                for binding in bindings:
                    yield t, BindingElement.make(t, binding)

    def space(self, most: int) -> tuple[int, int, int] | None:
        """The numbers of nodes, of arcs, and of nodes without any; None: there are more nodes than `most`."""
        seen = {self.game.marking}
        todo = [self.game.marking]
        arcs = 0
        dead = 0
        while todo:
            marking = todo.pop()
            own = self.arcs(marking)
            arcs += len(own)
            dead += not own
            for arc in own:
                if arc.target not in seen:
                    if len(seen) == most:
                        return None
                    seen.add(arc.target)
                    todo.append(arc.target)
        return len(seen), arcs, dead

    def follow(self, steps: Sequence[Step]) -> int:
        """How many of these occurrences, one after the other, are those of a run of the cell."""
        now = self._silently({self.game.marking})
        for done, (name, binding) in enumerate(steps):
            following = {
                arc.target
                for marking in now
                for arc in self.arcs(marking)
                if arc.name == name and self._binding(arc.element) == binding
            }
            if not following:
                return done
            now = self._silently(following)
        return len(steps)

    def _silently(self, markings: set[Marking]) -> set[Marking]:
        """What can be reached by steps that are no occurrences."""
        seen = set(markings)
        todo = list(markings)
        while todo:
            for arc in self.arcs(todo.pop()):
                if arc.name not in self.names and arc.target not in seen:
                    seen.add(arc.target)
                    todo.append(arc.target)
        return seen

    def _binding(self, element: BindingElement) -> dict[str, Any]:
        t = self.game.net.transitions[element.transition]
        outputs = t.code.outputs if t.code else ()
        values = element.binding
        return {
            s.name: to_json(s.colset, values[s])
            for s in t.variables
            if s.colset is not None and s not in outputs
        }
