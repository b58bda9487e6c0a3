"""The graph of a cell as it runs: who can do what in which state.

    graph = explore_cell(partition, storage, limits, d)
    graph.arcs[0]                   # ((element, target), ...) of the state at the start
    graph.elements[3]               # Element(transition=7, owner=1, binding={...})
    graph.commands(3)               # what its arm or device is told, in order

States are those of `verify.controller.running`. A transition of a robot occurs when all of its commands are done, and
its messages stay where they are until then: so it is under way exactly in states in which it can occur.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.base.how_far import Say, silent
from pn2code.cell.partition import OwnerKind, Partition
from pn2code.diagnostics import Diagnostics
from pn2code.ml.core.terms import Exp
from pn2code.net.flat import ArcKind, FlatNet
from pn2code.primitive_calls import Calls, Listener, Unknown
from pn2code.robot.commands import Command
from pn2code.semantics.evaluation.effects import Effect, effects_of
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.errors import running as evaluating
from pn2code.semantics.game.marking import Binding
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.colour_json import from_json
from pn2code.semantics.values.data import Timed, Value
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet
from pn2code.verify.answers.outcome import error_text, has_raised
from pn2code.verify.controller.control_types import MOST_WRITTEN, CellProgram
from pn2code.verify.controller.forgetting import forgetful
from pn2code.verify.controller.running import Running
from pn2code.verify.controller.stops import machine
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits, Reduction, default_memory
from pn2code.verify.exploring.nondeterminism import undetermined
from pn2code.verify.exploring.programs import Generated, Sizes
from pn2code.verify.exploring.telling import telling

MOST_STATES = MOST_WRITTEN
"""States of a cell that are looked at before it is tried otherwise, see `most_held` ..."""
MOST_HELD = 3_000_000
"""... and never more than these ..."""
_KIB = 2
"""... of which each takes about half of that."""
CLOCK = -1
"""The owner of steps of the clock."""
_OUTSIDE = frozenset({Effect.DRAW, Effect.LOOK, Effect.READ, Effect.COUNT})


@frozen(eq=False)
class Element:
    """A transition with values of its variables.

    Args:
        transition: its index in the net of the running cell; the first ones are those of the cell's net.
        owner: who lets it occur.
        binding: as JSON.
        is_step: it is a step of a program or of the clock, which the net does not have.
        is_end: it is the last step of a run, after which robots do nothing more.
    """

    number: int
    transition: int
    owner: int
    binding: Mapping[str, Any]
    is_step: bool
    is_end: bool


class CellGraph:
    """The graph.

    Args:
        partition: the cell.
        running: its programs.
        elements: what occurs in it.
        arcs: of each state the elements that can occur, with the states that they lead to.
        marked: of each state the places of the cell's net that hold tokens, and how many.
        over: the states in which the supervisor has come to a final place.
        why: it is not whole, and why; "": it is.
        raised: if that is "error": what raises the exception; "" where it is not known.
        cut: of a part of the graph, the states of which not all arcs are there.
        wider: it is that of a net that does more (`verify.controller.forgetting`): what can be under way need not be.
    """

    def __init__(
        self,
        partition: Partition,
        storage: Mapping[str, str],
        running: Running,
        elements: Sequence[Element],
        arcs: Sequence[Sequence[tuple[int, int]]],
        marked: Sequence[Mapping[int, int]],
        why: str,
        cut: frozenset[int] = frozenset(),
        *,
        wider: bool = False,
    ) -> None:
        self.partition, self.storage, self.running = partition, storage, running
        self.cut, self.wider = cut, wider
        self.elements, self.arcs, self.marked = elements, arcs, marked
        self.why = why or undetermined(partition.net)
        self.raised = ""
        self.over = frozenset(i for i, m in enumerate(marked) if running.over in m)
        self._game = Game(partition.net, storage, files=Files(None))
        self._listener = Listener(
            self._game, partition.config.primitives if partition.config else {}
        )
        self._commands: dict[int, tuple[Command, ...]] = {}
        self._control: dict[int, frozenset[int]] = {}
        effects = effects_of(partition.net.program)
        self.outside: dict[int, str] = {}
        for t in partition.net.transitions:
            if t.code is not None and partition.transition_owner[t.index] > 0:
                taken = [a.inscription.value for a in t.arcs if a.inscription is not None]
                found = effects.of(t.code.action, *t.guards, *taken) & _OUTSIDE
                self.outside[t.index] = min((e.value for e in found), default="")

    def commands(self, number: int) -> tuple[Command, ...]:
        """What an element tells its arm or device, in order."""
        if number not in self._commands:
            self._commands[number] = self._told(self.elements[number])
        return self._commands[number]

    def binding(self, element: Element) -> Binding:
        """The values of the variables, without those that the code segment gives."""
        t = self.partition.net.transitions[element.transition]
        outputs = t.code.outputs if t.code is not None else ()
        return {
            s: from_json(s.colset, element.binding[s.name])
            for s in t.variables
            if s.colset is not None and s not in outputs and s.name in element.binding
        }

    def begins_with(self, place: int) -> Iterator[Value]:
        """The tokens of an untimed place at the start, as the net has them."""
        tokens = self._game.own_initial_marking.places[place]
        assert isinstance(tokens, MultiSet)
        yield from tokens

    def value(self, element: Element, exp: Exp) -> Value:
        """What an expression of its transition is; of what a code segment gives as well.

        Raises GameError: that cannot be computed.
        """
        t = self.partition.net.transitions[element.transition]
        values = element.binding
        binding = {
            s: from_json(s.colset, values[s.name])
            for s in t.variables
            if s.colset is not None and s.name in values
        }
        with evaluating(t.origin, f"an inscription of `{t.name}`"):
            return self._game.evaluator.value(exp, binding)

    def delay(self, element: Element) -> float:
        """After how many units of model time the control token that a robot or device passes on is available.

        Other tokens that it puts, into places from which nobody reads, keep its script from nothing.

        Raises GameError: that cannot be computed.
        """
        t = self.partition.net.transitions[element.transition]
        control = self._control_of(element.owner)
        values = element.binding
        binding = {
            s: from_json(s.colset, values[s.name])
            for s in t.variables
            if s.colset is not None and s.name in values
        }
        self._game.evaluator.now = 0
        delay, most = self._game.delay(t, binding), 0.0
        for arc in t.arcs:
            is_put = arc.kind in (ArcKind.OUTPUT, ArcKind.BOTH)
            is_timed = self.partition.net.places[arc.place].colset.timed
            if is_put and is_timed and arc.place in control:
                put = self._game.put(TimedMultiSet(), arc, binding, delay, 0)
                most = max([most, *(float(x.stamp) for x in put if isinstance(x, Timed))])
        return most

    def _control_of(self, owner: int) -> frozenset[int]:
        """The places at which the program of a robot or device can be."""
        if owner not in self._control:
            self._control[owner] = frozenset(machine(self.partition, owner).control)
        return self._control[owner]

    def _told(self, element: Element) -> tuple[Command, ...]:
        if element.is_step:
            return ()
        t = self.partition.net.transitions[element.transition]
        owner = self.partition.owners[element.owner]
        if t.code is None or owner.kind is OwnerKind.SUPERVISOR:
            return ()
        calls = Calls()
        self._game.evaluator.now = self._game.start
        with suppress(GameError), self._listener.noting(calls):
            self._game.action(t, self.binding(element))
        return tuple(c for c in calls if not isinstance(c, Unknown))


def explore_cell(
    partition: Partition, storage: Mapping[str, str], limits: Limits, d: Diagnostics,
    initial: str | None = None, program: CellProgram | None = None, *, part: bool = False,
    most: int | None = None, shuffle: int = 0, say: Say = silent,
) -> CellGraph | None:  # fmt: skip
    """Explores the cell as it runs; None after an error that was reported.

    `program` is what somebody has compiled of the same cell. `part`: of a cell that was not seen to its end a part is
    wanted; else nothing is, but why; `shuffle`: in which order of successors, depth first. `most`: states, where
    `limits` do not say it; else `MOST_STATES`. `say` hears how far it is.

    Raises:
        NotModelledError: it cannot be said what its programs do.
    """
    if program is None:
        program = CellProgram(Running.of(partition), (), Generated())
    running, made = program.running, program.generated
    written = program.graph
    most = min(limits.max_states or most or MOST_STATES, MOST_HELD)
    if written is not None and written.nodes <= most:
        graph = _read(partition, storage, running, _rows(written.file), "")
        if (len(graph.arcs), sum(map(len, graph.arcs))) == (written.nodes, written.arcs):
            return graph
    limits = replace(
        limits,
        max_states=most,
        graph=True,
        approximation=None,
        traces=0,
        reductions=(Reduction.TIME,) if partition.net.timed else (),
    )
    with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
        file = Path(folder) / "graph.jsonl"
        options = ExploreOptions(
            initial=initial,
            sizes=made.sizes or Sizes.start(running.net, storage),
            generated=made,
            predicates=program.predicates,
            graph=file,
            part=part,
            shuffle=shuffle,
            questions="".join(f"{line}\n" for line in running.lines(first=True)),
            evidence=Path(folder),
            quick=True,
            progress=telling(say, "exploring"),
        )
        found = explore(running.net, storage, limits, d, options)
        if found is None:
            return None
        why = "" if found.complete else found.why
        if not file.exists() or (why and not part):
            graph = _read(partition, storage, running, (), why or "states")
            if has_raised(found):
                graph.raised = error_text(running.net, found)
            return graph
        graph = _read(partition, storage, running, _rows(file), why)
        seen = len(graph.arcs), sum(map(len, graph.arcs))
        if not why and seen != (found.nodes, found.arcs):
            graph.why = "file"
        return graph


def most_held() -> int:
    """States of a cell for which there is memory."""
    return max(MOST_STATES, min(MOST_HELD, default_memory() * 1024 // _KIB))


def explore_wider(
    partition: Partition, storage: Mapping[str, str], limits: Limits, d: Diagnostics
) -> CellGraph | None:
    """Explores a net that does all that the cell does, and more, but has fewer states; None: there is none.

    Raises:
        NotModelledError: it cannot be said what the programs of the cell do.
    """
    running = Running.of(partition)
    less = forgetful(partition, storage)
    if less is None:
        return None
    limits = replace(
        limits,
        max_states=min(limits.max_states or MOST_STATES, MOST_HELD),
        graph=True,
        approximation=None,
        traces=0,
        reductions=(),
    )
    graph = None
    # Of places that are forgotten others may depend, so that with all of them there are fewer states.
    for net in (less.net, less.whole) if less.places else (less.net,):
        graph = _explored_wider(running, net, storage, limits, d)
        if graph is None or graph.arcs:
            break
    return graph


def _explored_wider(
    running: Running, net: FlatNet, storage: Mapping[str, str], limits: Limits, d: Diagnostics
) -> CellGraph | None:
    with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
        file = Path(folder) / "graph.jsonl"
        sizes = Sizes.start(net, storage)
        options = ExploreOptions(sizes=sizes, generated=Generated(), graph=file, quick=True)
        found = explore(net, storage, limits, d, options)
        if found is None:
            return None
        is_there = found.complete and file.exists()
        rows = _rows(file) if is_there else ()
        why = "" if is_there else ("file" if found.complete else found.why)
        graph = _read(running.partition, storage, running, rows, why)
        if is_there and (len(graph.arcs), sum(map(len, graph.arcs))) != (found.nodes, found.arcs):
            graph.why = "file"
        graph.wider = True
        return graph


def _rows(file: Path) -> Iterator[Mapping[str, Any]]:
    with file.open(encoding="utf-8", errors="surrogateescape") as lines:
        for line in lines:
            yield json.loads(line)


def _read(
    partition: Partition,
    storage: Mapping[str, str],
    running: Running,
    rows: Iterable[Mapping[str, Any]],
    why: str,
) -> CellGraph:
    count = len(partition.net.transitions)
    places = {p.name: p.index for p in running.net.places}
    owners = [*partition.transition_owner, *running.steps]
    clock = set(running.clock)
    ends = {running.over, running.stopped}
    final = {
        t.index
        for t in running.net.transitions[count:]
        if any(a.place in ends and a.kind is ArcKind.OUTPUT for a in t.arcs)
        or t.index == running.ending
    }
    known: dict[tuple[int, str], int] = {}
    elements: list[Element] = []
    arcs: list[list[tuple[int, int]]] = []
    marked: list[Mapping[int, int]] = []
    markings: dict[tuple[tuple[int, int], ...], Mapping[int, int]] = {}
    cut: set[int] = set()

    def grow(size: int) -> None:
        while len(arcs) < size:
            arcs.append([])
            marked.append({})

    for row in rows:
        if "node" in row:
            grow(row["node"])
            held = {
                places[name]: sum(entry[0] for entry in tokens)
                for name, tokens in row["marking"].items()
                if tokens
            }
            marked[row["node"] - 1] = markings.setdefault(tuple(held.items()), held)
            if row.get("cut"):
                cut.add(row["node"] - 1)
            continue
        index = row["index"]
        key = (index, json.dumps(row["binding"]))
        if key not in known:
            known[key] = len(elements)
            elements.append(
                Element(
                    len(elements),
                    index,
                    CLOCK if index in clock else owners[index],
                    row["binding"],
                    index >= count,
                    index in final,
                )
            )
        grow(max(row["from"], row["to"]))
        arcs[row["from"] - 1].append((known[key], row["to"] - 1))
    return CellGraph(partition, storage, running, elements, arcs, marked, why, frozenset(cut))
