"""Unions of random nets (`helpers.random_unions`): the compiled explorer next to the reference token game.

`check(explorers, union)` compares all markings and binding elements, what is said of the graph, the same with two
threads and depth first, and with the reductions that the union permits. A failure names the net in which the two
differ, with its text alone and the command that shows it again.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from tools.reduction_sweep import all_markings, dead_markings, generators

from helpers.compiled import agrees
from helpers.explored import Explored, Explorers, element_key, multiset, node_key, wide
from helpers.graph_facts import Facts
from helpers.netbuilder import flat as flattened
from helpers.quotient import aged
from helpers.random_unions import Union, page_of
from helpers.table_nets import orbits
from helpers.thorough import amount
from pn2code.diagnostics import NOWHERE
from pn2code.lowering.nets.packing import choose
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.evaluation.references import searching
from pn2code.semantics.game.graph import StateSpace, state_space
from pn2code.semantics.game.marking import Marking, PlaceMarking, binding_to_json, place_to_json
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.verify.exploring.elements import Elements, NotPossibleError, elements
from pn2code.verify.exploring.programs import Sizes
from pn2code.verify.exploring.time_reduction import why_not_reducible

PER_UNION = 50
"""Nets in a union; about forty of them have graphs that are compared."""
NODES = amount(60, 100)
ARCS = amount(240, 400)
"""Graphs of one net that are larger are left out."""
WIDTHS = (8, 0, 4, 8, 0)
"""Of the counters of packed places, union by union; 0: no place is packed."""
WALKS = ((1, 25), (2, 25))
"""Seeds and steps of the walks through a union; and one more for each net that is left out."""


class Part:
    """What the token game says of one net alone: its graph from the marking after `Start` on.

    Attributes:
        number: of the net.
        space: the graph; None if an inscription raises an exception, or a guard may assign a reference.
    """

    def __init__(self, flat: FlatNet, number: int, size: int = 1) -> None:
        self.number = number
        self.net = only(flat, [number])
        self.game = Game(self.net, {}, files=Files(None))
        self.root = self.game.marking
        self.nodes: list[str] = []
        self.arcs: Counter[tuple[str, str, str]] = Counter()
        self._known: dict[tuple[int, object], Any] = {}
        (start,) = self.game.enabled()
        assert self.net.transitions[start.transition].name == f"N{number}.Start"
        self.space: StateSpace | None
        try:
            self.game.marking, _ = self.game.occur(self.root, start)
            if searching(self.net):  # no state space: `verify` refuses it
                raise GameError("a guard may assign a reference", NOWHERE)
            self.space = state_space(self.game, max_nodes=size * NODES, max_arcs=size * ARCS)
        except GameError:
            self.space = None

    @property
    def graph(self) -> StateSpace:
        """The graph, of which it is known that there is one."""
        assert self.space is not None
        return self.space

    def rows(self, place: int, tokens: PlaceMarking) -> Any:
        """What a place holds as JSON."""
        known = self._known.get((place, tokens))
        if known is None:
            known = place_to_json(self.game.colours, self.net.places[place].colset, tokens)
            self._known[place, tokens] = known
        return known

    def marked(self, marking: Marking) -> dict[str, Any]:
        """The places that are not empty."""
        held = zip(self.net.places, marking.places, strict=True)
        return {p.name: self.rows(p.index, tokens) for p, tokens in held if tokens}

    def describe(self, outside: Mapping[str, Any]) -> None:
        """Fill in the keys of nodes and arcs.

        Args:
            outside: what the places of other nets hold.
        """
        space = self.graph
        self.nodes = [node_key(m.time, {**outside, **self.marked(m)}) for m in space.nodes]
        times = {a.source: self.game.advance_time(space.nodes[a.source]).time for a in space.arcs}
        self.arcs = Counter(
            (
                self.nodes[a.source],
                self.nodes[a.target],
                element_key(
                    times[a.source],
                    self.net.transitions[a.element.transition].name,
                    binding_to_json(a.element),
                ),
            )
            for a in space.arcs
        )


@dataclass(slots=True)
class Outcome:
    """How many nets were compared, and how large they were."""

    nets: int = 0
    nodes: int = 0
    arcs: int = 0
    five: int = 0
    """nets with at least five nodes"""
    large: int = 0
    exceptions: int = 0
    reduced: Counter[str] = field(default_factory=Counter)

    def add(self, other: Outcome) -> None:
        for name in ("nets", "nodes", "arcs", "five", "large", "exceptions"):
            setattr(self, name, getattr(self, name) + getattr(other, name))
        self.reduced += other.reduced


class DiffersError(AssertionError):
    """Some of the nets differ.

    Args:
        numbers: which of the union; () if that is not known.
        why: how.
    """

    def __init__(self, numbers: Iterable[int], why: str) -> None:
        self.numbers = tuple(sorted(numbers))
        self.why = why
        super().__init__(why)


def numbers_of(flat: FlatNet) -> list[int]:
    """The nets that a flat net has."""
    return sorted({page_of(t.name) for t in flat.transitions})


def only(flat: FlatNet, numbers: Iterable[int]) -> FlatNet:
    """The net with these of its pages."""
    wanted = set(numbers)
    transitions = [t for t in flat.transitions if page_of(t.name) in wanted]
    used = {arc.place for t in transitions for arc in t.arcs}
    places = [p for p in flat.places if p.index in used or page_of(p.name) in wanted]
    moved = {p.index: i for i, p in enumerate(places)}
    return replace(
        flat,
        places=tuple(replace(p, index=i) for i, p in enumerate(places)),
        transitions=tuple(
            replace(t, index=i, arcs=tuple(replace(a, place=moved[a.place]) for a in t.arcs))
            for i, t in enumerate(transitions)
        ),
        place_instances=tuple(
            replace(p, place=moved[p.place]) for p in flat.place_instances if p.place in moved
        ),
        fusions=tuple(replace(f, place=moved[f.place]) for f in flat.fusions if f.place in moved),
    )


def check(explorers: Explorers, union: Union) -> Outcome:
    """Compare all of a union.

    Raises:
        AssertionError: something differs; the message has the net.
    """
    try:
        return _check(explorers, union, flattened(union.text()))
    except Exception as failure:
        raise AssertionError(_explained(explorers, union, failure)) from failure


def alone(explorers: Explorers, union: Union, number: int) -> str:
    """How a net of the union fails when there is no other; "" if it does not."""
    try:
        _check(explorers, union, flattened(union.text(number)))
    except Exception as failure:  # whatever it is, it is to be shown with its net
        return f"{type(failure).__name__}: {failure}"
    return ""


def culprits(explorers: Explorers, union: Union, suspects: Iterable[int]) -> list[tuple[int, str]]:
    """The first net that fails alone, and how."""
    for number in suspects:
        why = alone(explorers, union, number)
        if why:
            return [(number, why)]
    return []


def _explained(explorers: Explorers, union: Union, failure: Exception) -> str:
    why = f"{type(failure).__name__}: {failure}"
    named = failure.numbers if isinstance(failure, DiffersError) else ()
    found = culprits(explorers, union, named or range(len(union.pages)))
    command = f"./dev fuzz --graphs {len(union.pages)} --seed {union.number}"
    if not found:
        which = f"nets {named}" if named else "some nets"
        return f"union {union.number} ({union.style}), {which} differ, but none alone: {why}\n{command}"
    number, own = found[0]
    return (
        f"union {union.number} ({union.style}), net {number}: {own}\n{union.text(number)}\n"
        f"in the union: {why}\n{command} --only {number}"
    )


def _check(explorers: Explorers, union: Union, flat: FlatNet) -> Outcome:
    size = 2 if union.style == "symmetric" else 1  # to have some at all
    everything = [Part(flat, number, size) for number in numbers_of(flat)]
    exceptions = [p.number for p in everything if p.space is None]
    large = [p.number for p in everything if p.space is not None and not p.space.complete]
    parts = [p for p in everything if p.space is not None and p.space.complete]
    outcome = Outcome(large=len(large), exceptions=len(exceptions))
    if union.style in ("small", "symmetric"):
        parts = [p for p in parts if _table(p.net, wants_symmetry=False) is not None]
    if parts:
        _compare(explorers, union, flat, parts, outcome)
    rest = [*large, *exceptions]
    if rest and union.number % 2 == 0:
        net = only(flat, rest)
        folder = explorers.build(net, _sizes(net, 0), "rest")
        for seed in range(len(rest)):
            _walk(explorers, net, folder, seed, 12)
    return outcome


def _compare(
    explorers: Explorers, union: Union, flat: FlatNet, parts: list[Part], outcome: Outcome
) -> None:
    net = only(flat, [p.number for p in parts])
    root = {name: rows for p in parts for name, rows in p.marked(p.root).items()}
    for part in parts:
        own = {p.name for p in part.net.places}
        part.describe({name: rows for name, rows in root.items() if name not in own})
    is_reduced = union.style in ("small", "symmetric")  # which needs packed places
    width = 8 if is_reduced else WIDTHS[union.number % len(WIDTHS)]
    sizes = _sizes(net, width) if union.number % 10 else None
    nodes = 1 + sum(len(p.graph.nodes) for p in parts)
    found = explorers.explore(
        net, "--max-states", 2 * nodes, name="union", width=width, sizes=sizes, reads=False
    )
    assert found.report["complete"], (found.report["why"], found.report["error"])
    compare_graphs(root, parts, found)
    compare_facts(net, parts, found.report)
    folder = explorers.folder / "union"
    if union.number % 4 < 2:  # so that each style has both
        threads = explorers.said(folder, "--threads", 2)
        assert sorted(threads.lines) == sorted(found.lines), "with two threads the graph is another"
    else:
        compare_graphs(root, parts, explorers.said(folder, "--order", "dfs"))
    for seed, steps in WALKS:
        _walk(explorers, net, folder, seed, steps)
    outcome.nets += len(parts)
    outcome.nodes += nodes - 1
    outcome.arcs += sum(len(p.graph.arcs) for p in parts)
    outcome.five += sum(len(p.graph.nodes) >= 5 for p in parts)
    if union.style in ("timed", "untimed") and why_not_reducible(net) is None:
        compare_time(explorers, parts, net)
        outcome.reduced["time"] += 1
    if is_reduced:
        compare_reductions(explorers, net, parts, outcome)


def _sizes(net: FlatNet, width: int) -> Sizes:
    """Without what structural analysis proves, which takes longer than all the rest."""
    marking = Game(net, {}, files=Files(None)).marking
    counts = [Counter(tokens).values() for tokens in marking.places]
    return wide(Sizes(choose(net, counts, {})), width)


def _walk(explorers: Explorers, net: FlatNet, folder: Any, seed: int, steps: int) -> None:
    agrees(
        net,
        explorers.host / "walk",
        seed=seed,
        steps=steps,
        environment={"LD_LIBRARY_PATH": str(folder)},
    )


# --- graphs --------------------------------------------------------------------------------------


def compare_graphs(root: Mapping[str, Any], parts: list[Part], found: Explored) -> None:
    """Markings and binding elements, net by net."""
    nodes: dict[int, str] = {}
    arcs: list[tuple[int, int, str, str]] = []
    for line in found.lines:
        entry = json.loads(line)
        if "node" in entry:
            marked = {name: rows for name, rows in entry["marking"].items() if rows}
            assert entry["node"] not in nodes
            nodes[entry["node"]] = node_key(entry["t"], marked)
        else:
            element = element_key(entry["t"], entry["transition"], entry["binding"])
            arcs.append((entry["from"], entry["to"], entry["transition"], element))
    theirs: dict[int, Counter[object]] = {p.number: Counter() for p in parts}
    owner: dict[int, int] = {}
    first = node_key(0, root)
    starts = 0
    for source, target, transition, element in arcs:
        number = page_of(transition)
        owner[target] = number
        if nodes[source] == first:
            assert transition == f"N{number}.Start", f"{transition} occurs first"
            starts += 1
            theirs[number]["first", nodes[target]] += 1
        else:
            theirs[number][nodes[source], nodes[target], element] += 1
    for node, text in nodes.items():
        if node in owner:
            theirs[owner[node]][text] += 1
        else:
            assert text == first, f"a marking that nothing leads to: {text}"
    bad = {}
    for part in parts:
        mine: Counter[object] = Counter(part.arcs)
        mine.update(part.nodes)
        mine["first", part.nodes[0]] += 1
        if mine != theirs[part.number]:
            more, less = theirs[part.number] - mine, mine - theirs[part.number]
            bad[part.number] = (
                f"only compiled: {_some(more)}; only in the token game: {_some(less)}"
            )
    if bad:
        raise DiffersError(bad, "\n".join(f"net {n}: {why}" for n, why in bad.items()))
    assert starts == len(parts)


def _some(items: Counter[object]) -> str:
    return f"{sum(items.values())}: {[str(item) for item in items][:3]}"


def compare_facts(net: FlatNet, parts: list[Part], report: Mapping[str, Any]) -> None:
    """What is said of the graph."""
    index = {t.name: t.index for t in net.transitions}
    fired = [0] * len(net.transitions)
    fair: list[str | None] = ["impartial"] * len(net.transitions)
    cyclic: set[int] = set()
    facts: dict[int, Facts] = {}
    scc_nodes, scc_arcs, depth, dead = 1, len(parts), 0, 0
    for part in parts:
        space = part.graph
        own = [index[t.name] for t in part.net.transitions]
        arcs = [(a.source, a.target, a.element.transition) for a in space.arcs]
        fact = facts[part.number] = Facts(len(space.nodes), len(own), arcs)
        for t, count in zip(own, fact.fired(), strict=True):
            fired[t] = count + (net.transitions[t].short == "Start")
        components = fact.components()
        scc_nodes, scc_arcs = scc_nodes + components[0], scc_arcs + components[1]
        depth = max(depth, 1 + fact.depth())
        dead += len(space.dead)
        fairness = fact.fairness()
        if fairness is not None:
            cyclic.add(part.number)
            for t, said in zip(own, fairness, strict=True):
                fair[t] = said
    graph = report["graph"]
    assert report["fired"] == fired
    assert (graph["scc_nodes"], graph["scc_arcs"]) == (scc_nodes, scc_arcs)
    assert report["depth"] == depth
    assert report["dead_count"] == dead
    for t in net.transitions:
        if fair[t.index] == "impartial" and cyclic - {page_of(t.name)}:
            fair[t.index] = "fair"  # another net has a cycle without it
    _same(net, graph["fairness"], fair if cyclic else None, "fairness")
    if len(parts) > 1:
        assert graph["home_count"] == 0
        assert not any(graph["live"])
    else:
        home = facts[parts[0].number].home()
        assert graph["home_count"] == len(home)
        _same(net, graph["live"], facts[parts[0].number].live(), "liveness")
    compare_bounds(net, parts, report)


def _same(net: FlatNet, theirs: Any, mine: Any, what: str) -> None:
    if theirs == mine:
        return
    if theirs is None or mine is None:
        raise DiffersError((), f"{what}: {theirs} compiled, {mine} by definition")
    bad = [t for t, a, b in zip(net.transitions, theirs, mine, strict=True) if a != b]
    raise DiffersError(
        {page_of(t.name) for t in bad},
        f"{what}: {[(t.name, theirs[t.index], mine[t.index]) for t in bad[:5]]}",
    )


def compare_bounds(net: FlatNet, parts: list[Part], report: Mapping[str, Any]) -> None:
    """Numbers of tokens, and of each colour."""
    owners: dict[str, list[tuple[Part, int]]] = {}
    for part in parts:
        for p in part.net.places:
            owners.setdefault(p.name, []).append((part, p.index))
    for place, said in zip(net.places, report["bounds"], strict=True):
        found = owners[place.name]
        counted: list[Counter[str]] = []
        for part, index in found:
            # In the markings of other nets it holds what it holds at first.
            for tokens in {m.places[index] for m in (part.root, *part.graph.nodes)}:
                own: Counter[str] = Counter()
                for row in part.rows(index, tokens):
                    own[json.dumps(row[1])] += row[0]
                counted.append(own)
        totals = [own.total() for own in counted]
        most = {v: max(own[v] for own in counted) for own in counted for v in own}
        least = {v: n for v in most if (n := min(own[v] for own in counted))}
        mine = (min(totals), max(totals), least, most)
        theirs = (
            said["lower"],
            said["upper"],
            multiset(said["lower_multiset"]),
            multiset(said["upper_multiset"]),
        )
        if mine != theirs:
            why = f"bounds of {place.name}: {theirs} compiled, {mine} by definition"
            raise DiffersError([p.number for p, _ in found], why)


# --- reductions ----------------------------------------------------------------------------------


def compare_time(explorers: Explorers, parts: list[Part], net: FlatNet) -> None:
    """`--reduce time`: as many classes of markings as there are, the same transitions and bounds."""
    report = explorers.said(explorers.folder / "union", "--reduce", "time").report
    assert report["complete"], report
    classes = [{aged(m) for m in p.graph.nodes} for p in parts]
    dead = [{aged(p.graph.nodes[i]) for i in p.graph.dead} for p in parts]
    assert report["nodes"] == 1 + sum(map(len, classes)), "classes"
    assert report["dead_count"] == sum(map(len, dead)), "dead classes"
    names = {
        p.net.transitions[t].name
        for p in parts
        for t in {a.element.transition for a in p.graph.arcs}
    }
    names |= {f"N{p.number}.Start" for p in parts}
    assert {t.name for t, n in zip(net.transitions, report["fired"], strict=True) if n} == names
    compare_bounds(net, parts, report)


def _table(net: FlatNet, *, wants_symmetry: bool) -> Elements | None:
    try:
        return elements(net, wants_symmetry=wants_symmetry)
    except (NotPossibleError, GameError):
        return None


def compare_reductions(
    explorers: Explorers, net: FlatNet, parts: list[Part], outcome: Outcome
) -> None:
    """Partial order: the same dead markings. Symmetry: as many orbits as there are."""
    table = _table(net, wants_symmetry=True)
    assert table is not None, "possible for each net, but not for all"
    file = explorers.folder / "union.elements"
    file.write_text(table.text())
    folder = explorers.folder / "union"
    dead = sum(len(p.graph.dead) for p in parts)
    nodes = 1 + sum(len(p.graph.nodes) for p in parts)
    u = table.unfolding
    if not u.has_priorities:
        report = explorers.said(folder, "--reduce", "partial-order", "--elements", file).report
        assert report["complete"], report
        assert report["dead_count"] == dead, (
            f"partial order: {report['dead_count']} dead, {dead} are"
        )
        assert report["nodes"] <= nodes
        outcome.reduced["partial-order"] += 1
    if table.symmetries is None or not table.symmetries.names():
        return
    report = explorers.said(folder, "--reduce", "symmetry", "--elements", file).report
    assert report["complete"], report
    space = all_markings(u)
    assert len(space) == nodes
    group = generators(table.symmetries)
    mine = (orbits(space, group), orbits(dead_markings(u, space), group))
    assert (report["nodes"], report["dead_count"]) == mine, "orbits"
    outcome.reduced["symmetry"] += 1
