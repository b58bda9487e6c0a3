"""Questions to explorers in tests, and their answers by definition on small graphs.

A `Lts` is what `--write-graph` says, as plain lists. `Items` works sets out as the definitions of CTL have it: by going
over all nodes again and again until nothing changes. `accepts` looks for a run of an automaton, `is_run` at a run;
`longest_wait` tries all waits.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from helpers import netbuilder
from helpers.explored import Explored, Explorers, wide
from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.emission.output import OutputFile
from pn2code.ml.core.terms import Symbol
from pn2code.ml.core.types import BOOL
from pn2code.ml.elaborate import Elaborator
from pn2code.net.flat import FlatNet
from pn2code.net.front import examine
from pn2code.net.predicate import Predicate, marking_type
from pn2code.verify.exploring.programs import Sizes, generated

FIRST_UID = 50_000_000


@dataclass(frozen=True, slots=True)
class Asked:
    """A net with conditions, compiled; places are known by their own names in them."""

    explorers: Explorers
    folder: Path
    flat: FlatNet

    def say(self, lines: Sequence[str], *options: object) -> tuple[Explored, list[dict[str, Any]]]:
        """What the explorer says, and its answers."""
        questions = self.folder / "questions.txt"
        questions.write_text("\n".join(lines) + "\n")
        more = ["--queries", questions, "--query-trace-to", self.folder / "answer-"]
        found = self.explorers.said(self.folder, *more, *options)
        return found, found.report["queries"]


def ask(
    explorers: Explorers, text: str, conditions: Sequence[str], name: str = "asked", width: int = 1
) -> Asked:
    """Compile a net with conditions."""
    flat, files = sources(text, conditions, width)
    folder = explorers.folder / name
    folder.mkdir(exist_ok=True)
    for file in files:
        (folder / file.path).write_text(file.text)
    explorers.compile_net(folder)
    return Asked(explorers, folder, flat)


def sources(
    text: str, conditions: Sequence[str], width: int = 1
) -> tuple[FlatNet, tuple[OutputFile, ...]]:
    """A net, and what is generated for it with conditions."""
    flat, elaborator = net_and_elaborator(text)
    predicates = [predicate(flat, elaborator, f"p{i}", c) for i, c in enumerate(conditions)]
    d = Diagnostics()
    files = generated(flat, {}, wide(Sizes.start(flat, {}), width), d, predicates)
    assert files is not None, [e.message for e in d.errors]
    return flat, files


def net_and_elaborator(text: str) -> tuple[FlatNet, Elaborator]:
    """The flat net, and what conditions over it are typed by."""
    d = Diagnostics()
    with tempfile.TemporaryDirectory() as folder:
        found = examine(netbuilder.write(text, Path(folder) / "net.cpn"), d)
    assert found.flat is not None, [e.message for e in d.errors]
    assert found.typed is not None and found.typed.elaborator is not None
    return found.flat, found.typed.elaborator


def predicate(flat: FlatNet, elaborator: Elaborator, name: str, text: str) -> Predicate:
    """A condition in which places are variables."""
    symbols = {p.short: Symbol(FIRST_UID + p.index, p.short, marking_type(p)) for p in flat.places}
    d = Diagnostics()
    with elaborator.aside(d):
        found = elaborator.expression(
            SourceText(text, Origin("conditions")), (BOOL,), expected_name="bool", declared=symbols
        )
    assert found is not None, [e.message for e in d.errors]
    return Predicate(name, text, found[1], tuple((symbols[p.short], p.index) for p in flat.places))


# --- graphs ----------------------------------------------------------------------------------------


@dataclass(slots=True)
class Lts:
    """A graph: for each node its arcs (transition, node), and what holds in it."""

    arcs: list[list[tuple[int, int]]] = field(default_factory=list)
    markings: list[dict[str, Any]] = field(default_factory=list)
    times: list[float] = field(default_factory=list)
    elements: list[list[tuple[str, int]]] = field(default_factory=list)

    @staticmethod
    def of(found: Explored) -> Lts:
        """From the lines of `--write-graph`."""
        made = Lts()
        entries = [json.loads(line) for line in found.lines]
        for e in entries:
            if "node" in e:
                made.markings.append(e["marking"])
                made.times.append(float(e["t"]))
                made.arcs.append([])
                made.elements.append([])
        for e in entries:
            if "from" in e:
                made.arcs[e["from"] - 1].append((e["index"], e["to"] - 1))
                key = json.dumps([e["transition"], e["binding"]], sort_keys=True)
                made.elements[e["from"] - 1].append((key, e["index"]))
        return made

    def follow(self, trace: str) -> tuple[list[int], list[int]]:
        """The nodes of a trace, and the transitions between them; every step must be possible."""
        nodes, labels = [0], []
        for line in Path(trace).read_text().splitlines()[1:]:
            e = json.loads(line)
            if "transition" not in e:
                continue
            key = json.dumps([e["transition"], e["binding"]], sort_keys=True)
            here = nodes[-1]
            at = [k for k, _ in self.elements[here]].index(key)
            labels.append(self.arcs[here][at][0])
            nodes.append(self.arcs[here][at][1])
        return nodes, labels


class Items:
    """The sets of nodes of items, by definition; `leaves` are those of the predicates."""

    def __init__(self, lts: Lts, leaves: Sequence[set[int]]) -> None:
        self.lts = lts
        self.all = set(range(len(lts.arcs)))
        self.leaves = leaves
        self.sets: list[set[int]] = []

    def add(self, line: str) -> set[int]:
        """One more item."""
        word, *rest = line.split()
        numbers = [int(x) for x in rest]
        self.sets.append(self._of(word, numbers))
        return self.sets[-1]

    def _of(self, word: str, n: list[int]) -> set[int]:
        arcs, every = self.lts.arcs, self.all
        if word == "exa":
            return {v for v in every if any(t == n[0] and w in self.sets[n[1]] for t, w in arcs[v])}
        match word:
            case "true":
                return set(every)
            case "dead":
                return {v for v in every if not arcs[v]}
            case "initial":
                return {0}
            case "pred":
                return set(self.leaves[n[0]])
            case "enabled":
                return {v for v in every if any(t == n[0] for t, _ in arcs[v])}
        a = self.sets[n[0]]
        b = self.sets[n[-1]]
        match word:
            case "not":
                return every - a
            case "and":
                return a & b
            case "or":
                return a | b
            case "ex":
                return {v for v in every if any(w in a for _, w in arcs[v])}
            case "ax":
                return {v for v in every if all(w in a for _, w in arcs[v])}
            case "ef":
                return self._least(a, every, some=True)
            case "af":
                return self._least(a, every, some=False)
            case "eu":
                return self._least(b, a, some=True)
            case "au":
                return self._least(b, a, some=False)
            case "eg":
                return every - self._least(every - a, every, some=False)
            case "ag":
                return every - self._least(every - a, every, some=True)
        raise AssertionError(word)

    def _least(self, goal: set[int], through: set[int], *, some: bool) -> set[int]:
        found = set(goal)
        while True:
            more = set()
            for v in through - found:
                targets = [w in found for _, w in self.lts.arcs[v]]
                if targets and (any(targets) if some else all(targets)):
                    more.add(v)
            if not more:
                return found
            found |= more


# --- automata --------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Automaton:
    """As the lines of a question have it."""

    states: int
    accepting: frozenset[int]
    edges: tuple[tuple[int, int, tuple[str, ...]], ...]
    strong: tuple[int, ...] = ()
    weak: tuple[int, ...] = ()

    def lines(self) -> list[str]:
        """For the explorer."""
        found = ["? lasso", f"automaton {self.states} 0"]
        found += [f"accepting {s}" for s in sorted(self.accepting)]
        found += [" ".join(["arc", str(a), str(b), *literals]) for a, b, literals in self.edges]
        found += [f"strong {t}" for t in self.strong] + [f"weak {t}" for t in self.weak]
        return [*found, "end"]

    def reads(self, literals: tuple[str, ...], items: Items, node: int, label: int | None) -> bool:
        """Whether an arc can be taken."""
        for x in literals:
            by_node = x[1] != "f" and node in items.sets[int(x[1:])]
            holds = label == int(x[2:]) if x[1] == "f" else by_node
            if holds != (x[0] == "+"):
                return False
        return True


State = tuple[int, int]


def _steps(lts: Lts, node: int) -> list[tuple[int | None, int]]:
    return [(t, w) for t, w in lts.arcs[node]] or [(None, node)]


def accepts(lts: Lts, items: Items, a: Automaton) -> bool:
    """Whether there is a run from the initial node that is accepted and fair."""
    next_of: dict[State, list[tuple[int | None, State]]] = {}
    waiting: list[State] = [(0, 0)]
    while waiting:
        v, s = waiting.pop()
        if (v, s) in next_of:
            continue
        next_of[v, s] = [
            (label, (w, to))
            for label, w in _steps(lts, v)
            for start, to, literals in a.edges
            if start == s and a.reads(literals, items, v, label)
        ]
        waiting += [x for _, x in next_of[v, s]]
    return _good(set(next_of), next_of, lts, a)


def _reach(start: State, inside: set[State], arcs: Mapping[State, list[Any]]) -> set[State]:
    found: set[State] = set()
    waiting = [start]
    while waiting:
        for _, x in arcs[waiting.pop()]:
            if x in inside and x not in found:
                found.add(x)
                waiting.append(x)
    return found


def _good(inside: set[State], arcs: Mapping[State, list[Any]], lts: Lts, a: Automaton) -> bool:
    """Whether there is a set of states that a fair accepted run can visit for ever."""
    reach = {x: _reach(x, inside, arcs) for x in inside}
    done: set[State] = set()
    for x in inside:
        if x in done or x not in reach[x]:
            continue
        part = {y for y in reach[x] if x in reach[y]}
        done |= part
        labels = {t for y in part for t, z in arcs[y] if z in part}

        def enabled(t: int, node: int) -> bool:
            return any(u == t for u, _ in lts.arcs[node])

        if not any(s in a.accepting for _, s in part):
            continue
        if any(t not in labels and all(enabled(t, v) for v, _ in part) for t in a.weak):
            continue
        unfair = [t for t in a.strong if t not in labels and any(enabled(t, v) for v, _ in part)]
        if not unfair:
            return True
        if _good({y for y in part if not enabled(unfair[0], y[0])}, arcs, lts, a):
            return True
    return False


def is_run(
    lts: Lts, items: Items, a: Automaton, nodes: list[int], labels: list[int], loop: int | None
) -> bool:
    """Whether the run that repeats its steps from `loop` on (None: it ends at a dead node) is accepted and fair."""
    if loop is None:
        assert not lts.arcs[nodes[-1]]
        letters: list[tuple[int, int | None]] = [
            *zip(nodes, labels, strict=False),
            (nodes[-1], None),
        ]
        loop = len(nodes) - 1
    else:
        assert nodes[loop] == nodes[-1] and loop < len(labels)
        letters = list(zip(nodes, labels, strict=False))
    cycle = letters[loop:]
    occurring = {t for _, t in cycle}

    def enabled(t: int, node: int) -> bool:
        return any(u == t for u, _ in lts.arcs[node])

    if any(t not in occurring and any(enabled(t, v) for v, _ in cycle) for t in a.strong):
        return False
    if any(t not in occurring and all(enabled(t, v) for v, _ in cycle) for t in a.weak):
        return False
    arcs: dict[State, list[tuple[None, State]]] = {
        (i, s): [
            (None, (i + 1 if i + 1 < len(letters) else loop, to))
            for start, to, literals in a.edges
            if start == s and a.reads(literals, items, *letters[i])
        ]
        for i in range(len(letters))
        for s in range(a.states)
    }
    seen = _reach((0, 0), set(arcs), arcs) | {(0, 0)}
    return any(
        s in a.accepting and i >= loop and (i, s) in _reach((i, s), set(arcs), arcs)
        for i, s in seen
    )


# --- waits -----------------------------------------------------------------------------------------


def longest_wait(
    lts: Lts, items: Items, first: str, second: str, *, time: bool
) -> tuple[bool, float | None]:
    """Whether each wait ends, and the longest one (None: there is none)."""

    def at_node(event: str, node: int) -> bool:
        return event[0] == "s" and node in items.sets[int(event[1:])]

    def at_arc(event: str, label: int) -> bool:
        return event[0] == "f" and label == int(event[1:])

    starts: set[int] = set()
    longest: float | None = None
    for v in range(len(lts.arcs)):
        makers = [t for u in range(len(lts.arcs)) for t, w in lts.arcs[u] if w == v]
        if at_node(first, v) or any(at_arc(first, t) for t in makers):
            if at_node(second, v):
                longest = max(longest or 0.0, 0.0)
            else:
                starts.add(v)
    for start in starts:
        waiting = {(start, 0.0)}
        for _ in range(len(lts.arcs) + 1):
            ahead: set[tuple[int, float]] = set()
            for v, wait in waiting:
                if not lts.arcs[v]:
                    return False, None
                for t, w in lts.arcs[v]:
                    longer = wait + (lts.times[w] - lts.times[v] if time else 1.0)
                    if at_arc(second, t) or at_node(second, w):
                        longest = max(longest or 0.0, longer)
                    else:
                        ahead.add((w, longer))
            waiting = ahead
        if waiting:
            return False, None
    return True, longest
