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

from helpers.compiled import agrees
from helpers.explored import Explored, Explorers, element_key, multiset, node_key, wide
from helpers.graph_facts import Facts
from helpers.netbuilder import flat as flattened
from helpers.quotient import aged
from helpers.random_unions import Union, page_of
from helpers.table_nets import orbits
from pn2code.net.flat import FlatNet
from pn2code.semantics.files import Files
from pn2code.semantics.game import Game, GameError
from pn2code.semantics.graph import StateSpace, state_space
from pn2code.semantics.marking import Marking, PlaceMarking, binding_to_json, place_to_json
from pn2code.verify.elements import Elements, NotPossibleError, elements
from pn2code.verify.programs import Sizes
from pn2code.verify.time_reduction import obstacle
from tests.reduction_sweep import all_markings, dead_markings, generators

NODES = 100
ARCS = 400
"""Graphs of one net that are larger are left out."""
WIDTHS = (8, 0, 4, 8, 0)
"""Of the counters of packed places, union by union; 0: no place is packed."""
WALKS = ((1, 25), (2, 25))
"""Seeds and steps of the walks through a union; and one more for each net that is left out."""


@dataclass(slots=True)
class Part:
    """What the token game says of one net: its graph from the marking after `Start` on."""

    number: int
    space: StateSpace
    nodes: list[str] = field(default_factory=list)
    arcs: Counter[tuple[str, str, str]] = field(default_factory=Counter)


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


class Differs(AssertionError):
    """Some of the nets differ.

    Args:
        numbers: which of the union; () if that is not known.
        why: how.
    """

    def __init__(self, numbers: Iterable[int], why: str) -> None:
        self.numbers = tuple(sorted(numbers))
        self.why = why
        super().__init__(why)


class Reference:
    """The token game's side of a union."""

    def __init__(self, flat: FlatNet) -> None:
        self.flat = flat
        self.game = Game(flat, {}, files=Files(None))
        self.root = self.game.marking
        self.elements = self.game.enabled()
        self._known: dict[tuple[int, object], Any] = {}

    def parts(self) -> tuple[list[Part], list[int], list[int]]:
        """Those that are small, the numbers of those that are not, and of those that raise an exception."""
        parts, large, exceptions = [], [], []
        for element in self.elements:
            number = page_of(self.flat.transitions[element.transition].name)
            try:
                self.game.marking, _ = self.game.occur(self.root, element)
                space = state_space(self.game, max_nodes=NODES, max_arcs=ARCS)
            except GameError:
                exceptions.append(number)
                continue
            if space.complete:
                parts.append(Part(number, space))
            else:
                large.append(number)
        return parts, large, exceptions

    def rows(self, place: int, tokens: PlaceMarking) -> Any:
        """What a place holds as JSON."""
        known = self._known.get((place, tokens))
        if known is None:
            known = place_to_json(self.game.colours, self.flat.places[place].colset, tokens)
            self._known[place, tokens] = known
        return known

    def key(self, marking: Marking) -> str:
        """A marking as `node_key` gives it, without the empty places."""
        held = zip(self.flat.places, marking.places, strict=True)
        return node_key(
            marking.time, {p.name: self.rows(p.index, tokens) for p, tokens in held if tokens}
        )

    def describe(self, part: Part) -> None:
        """Fill in the keys of its nodes and arcs."""
        space = part.space
        part.nodes = [self.key(marking) for marking in space.nodes]
        times = {a.source: self.game.settle(space.nodes[a.source]).time for a in space.arcs}
        part.arcs = Counter(
            (
                part.nodes[a.source],
                part.nodes[a.target],
                element_key(
                    times[a.source],
                    self.flat.transitions[a.element.transition].name,
                    binding_to_json(a.element),
                ),
            )
            for a in space.arcs
        )


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
            replace(
                t, index=i, arcs=tuple(replace(a, place=moved[a.place]) for a in t.arcs)
            )
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
    named = failure.numbers if isinstance(failure, Differs) else ()
    found = culprits(explorers, union, named or range(len(union.pages)))
    command = f"./dev fuzz --graphs {len(union.pages)} --seed {union.number}"
    if not found:
        return f"union {union.number} ({union.style}), nets {named or 'unknown'} differ, but none alone: {why}\n{command}"
    number, own = found[0]
    return (
        f"union {union.number} ({union.style}), net {number}: {own}\n{union.text(number)}\n"
        f"in the union: {why}\n{command} --only {number}"
    )


def _check(explorers: Explorers, union: Union, flat: FlatNet) -> Outcome:
    reference = Reference(flat)
    parts, large, exceptions = reference.parts()
    outcome = Outcome(large=len(large), exceptions=len(exceptions))
    if union.style in ("small", "symmetric"):
        parts = [p for p in parts if _table(only(flat, [p.number])) is not None]
    if parts:
        _compare(explorers, union, reference, parts, outcome)
    rest = [*large, *exceptions]
    if rest and union.number % 2 == 0:
        net = only(flat, rest)
        folder = explorers.build(net, wide(_sizes(net), 0), "rest")
        for seed in range(len(rest)):
            _walk(explorers, net, folder, seed, 12)
    return outcome


def _compare(
    explorers: Explorers, union: Union, reference: Reference, parts: list[Part], outcome: Outcome
) -> None:
    net = only(reference.flat, [p.number for p in parts])
    width = WIDTHS[union.number % len(WIDTHS)]
    options = ("--max-states", 2 * sum(len(p.space.nodes) for p in parts) + 2)
    found = explorers.explore(net, *options, name="union", width=width, reads=False)
    assert found.report["complete"], (found.report["why"], found.report["error"])
    for part in parts:
        reference.describe(part)
    compare_graphs(reference, parts, found)
    compare_facts(net, reference, parts, found.report)
    folder = explorers.folder / "union"
    threads = explorers.said(folder, "--threads", 2)
    assert sorted(threads.lines) == sorted(found.lines), "with two threads the graph is another"
    depth = explorers.said(folder, "--order", "dfs")
    compare_graphs(reference, parts, depth)
    for seed, steps in WALKS:
        _walk(explorers, net, folder, seed, steps)
    outcome.nets += len(parts)
    outcome.nodes += sum(len(p.space.nodes) for p in parts)
    outcome.arcs += sum(len(p.space.arcs) for p in parts)
    outcome.five += sum(len(p.space.nodes) >= 5 for p in parts)
    if union.style in ("timed", "untimed") and obstacle(net) is None:
        compare_time(explorers, reference, parts, net)
        outcome.reduced["time"] += 1
    if union.style in ("small", "symmetric"):
        compare_reductions(explorers, union, net, parts, outcome)


def _sizes(net: FlatNet) -> Sizes:
    return Sizes.start(net, {})


def _walk(explorers: Explorers, net: FlatNet, folder: Any, seed: int, steps: int) -> None:
    agrees(net, explorers.host / "walk", seed=seed, steps=steps, environment={"LD_LIBRARY_PATH": str(folder)})


# --- graphs --------------------------------------------------------------------------------------


def compare_graphs(reference: Reference, parts: list[Part], found: Explored) -> None:
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
    root = reference.key(reference.root)
    starts = 0
    for source, target, transition, element in arcs:
        number = page_of(transition)
        owner[target] = number
        if nodes[source] == root:
            assert transition == f"N{number}.Start", f"{transition} occurs first"
            starts += 1
            theirs[number]["first", nodes[target]] += 1
        else:
            theirs[number][nodes[source], nodes[target], element] += 1
    for node, text in nodes.items():
        if node in owner:
            theirs[owner[node]][text] += 1
        else:
            assert text == root, f"a marking that nothing leads to: {text}"
    bad = {}
    for part in parts:
        mine: Counter[object] = Counter(part.arcs)
        mine.update(part.nodes)
        mine["first", part.nodes[0]] += 1
        if mine != theirs[part.number]:
            more, less = theirs[part.number] - mine, mine - theirs[part.number]
            bad[part.number] = f"only compiled: {_some(more)}; only in the token game: {_some(less)}"
    if bad:
        raise Differs(bad, "\n".join(f"net {n}: {why}" for n, why in bad.items()))
    assert starts == len(parts)


def _some(items: Counter[object]) -> str:
    return f"{sum(items.values())}: {[str(item) for item in items][:3]}"


def compare_facts(
    net: FlatNet, reference: Reference, parts: list[Part], report: Mapping[str, Any]
) -> None:
    """What is said of the graph."""
    known = {t.name: t.index for t in net.transitions}
    names = [t.name for t in reference.flat.transitions]
    fired = [0] * len(net.transitions)
    fair: list[str | None] = ["impartial"] * len(net.transitions)
    cyclic: set[int] = set()
    facts: dict[int, Facts] = {}
    scc_nodes, scc_arcs, depth, dead = 1, len(parts), 0, 0
    for part in parts:
        own = {t.index: i for i, t in enumerate(net.transitions) if page_of(t.name) == part.number}
        arcs = [
            (a.source, a.target, own[known[names[a.element.transition]]]) for a in part.space.arcs
        ]
        order = {old: new for new, old in enumerate(own.values())}
        arcs = [(a, b, order[t]) for a, b, t in arcs]
        fact = facts[part.number] = Facts(len(part.space.nodes), len(order), arcs)
        for t, count in zip(own.values(), fact.fired(), strict=True):
            fired[t] = count + (net.transitions[t].name == f"N{part.number}.Start")
        components = fact.components()
        scc_nodes, scc_arcs = scc_nodes + components[0], scc_arcs + components[1]
        depth = max(depth, 1 + fact.depth())
        dead += len(part.space.dead)
        fairness = fact.fairness()
        if fairness is not None:
            cyclic.add(part.number)
            for t, said in zip(own.values(), fairness, strict=True):
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
        live = facts[parts[0].number].live()
        _same(net, graph["live"], live, "liveness")
    compare_bounds(net, reference, parts, report)


def _same(net: FlatNet, theirs: Any, mine: Any, what: str) -> None:
    if theirs == mine:
        return
    if theirs is None or mine is None:
        raise Differs((), f"{what}: {theirs} compiled, {mine} by definition")
    bad = [t for t, a, b in zip(net.transitions, theirs, mine, strict=True) if a != b]
    raise Differs(
        {page_of(t.name) for t in bad},
        f"{what}: {[(t.name, theirs[t.index], mine[t.index]) for t in bad[:5]]}",
    )


def compare_bounds(
    net: FlatNet, reference: Reference, parts: list[Part], report: Mapping[str, Any]
) -> None:
    """Numbers of tokens, and of each colour."""
    by_number = {p.number: p for p in parts}
    indices = {p.name: p.index for p in reference.flat.places}
    for place, said in zip(net.places, report["bounds"], strict=True):
        index = indices[place.name]
        # In the markings of other nets it holds what it holds at first.
        part = by_number.get(page_of(place.name))
        markings = [reference.root, *(part.space.nodes if part else ())]
        if part is None:
            markings += [m for p in parts for m in p.space.nodes]
        counted = []
        for tokens in {m.places[index] for m in markings}:
            own: Counter[str] = Counter()
            for row in reference.rows(index, tokens):
                own[json.dumps(row[1])] += row[0]
            counted.append(own)
        totals = [own.total() for own in counted]
        most = {v: max(own[v] for own in counted) for own in counted for v in own}
        least = {v: n for v in most if (n := min(own[v] for own in counted))}
        mine = (min(totals), max(totals), least, most)
        theirs = (said["lower"], said["upper"], multiset(said["lower_multiset"]), multiset(said["upper_multiset"]))
        if mine != theirs:
            raise Differs([page_of(place.name)] if part else (), f"bounds of {place.name}: {theirs} compiled, {mine} by definition")


# --- reductions ----------------------------------------------------------------------------------


def compare_time(explorers: Explorers, reference: Reference, parts: list[Part], net: FlatNet) -> None:
    """`--reduce time`: as many classes of markings as there are, the same transitions and bounds."""
    report = explorers.said(explorers.folder / "union", "--reduce", "time").report
    assert report["complete"], report
    classes = [{reference.key(aged(m)) for m in p.space.nodes} for p in parts]
    dead = [{reference.key(aged(p.space.nodes[i])) for i in p.space.dead} for p in parts]
    assert report["nodes"] == 1 + sum(map(len, classes)), "classes"
    assert report["dead_count"] == sum(map(len, dead)), "dead classes"
    fired = {page_of(t.name) for t, n in zip(net.transitions, report["fired"], strict=True) if n}
    assert fired == {p.number for p in parts}
    occurring = {a.element.transition for p in parts for a in p.space.arcs}
    names = {reference.flat.transitions[t].name for t in occurring}
    names |= {f"N{p.number}.Start" for p in parts}
    assert {t.name for t, n in zip(net.transitions, report["fired"], strict=True) if n} == names
    compare_bounds(net, reference, parts, report)


def _table(net: FlatNet) -> Elements | None:
    try:
        return elements(net, wants_symmetry=True)
    except (NotPossibleError, GameError):
        return None


def compare_reductions(
    explorers: Explorers, union: Union, net: FlatNet, parts: list[Part], outcome: Outcome
) -> None:
    """Partial order: the same dead markings. Symmetry: as many orbits as there are."""
    table = _table(net)
    assert table is not None, "possible for each net, but not for all"
    file = explorers.folder / "union.elements"
    file.write_text(table.text())
    folder = explorers.folder / "union"
    dead = sum(len(p.space.dead) for p in parts)
    nodes = 1 + sum(len(p.space.nodes) for p in parts)
    u = table.unfolding
    if not u.has_priorities:
        report = explorers.said(folder, "--reduce", "partial-order", "--elements", file).report
        assert report["complete"], report
        assert report["dead_count"] == dead, f"partial order: {report['dead_count']} dead, {dead} are"
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
