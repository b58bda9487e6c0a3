"""State spaces by peers that are written in Python: SNAKES, and pm4py where it is installed (`pip install pm4py`).

They are given small sizes of the models that the others have, and their counts are checked.
"""

from __future__ import annotations

import importlib.util
import sys
import time
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from snakes.nets import (  # type: ignore[import-untyped]
    Expression,
    MultiArc,
    PetriNet,
    Place,
    StateGraph,
    Transition,
    Value,
    Variable,
    dot,
)

_PNML = "{http://www.pnml.org/version-2009/grammar/pnml}"


def all_of_them(shared: Path) -> Iterator[tuple[str, str, int, float]]:
    """Peer, model, states, seconds; a message for what is left out.

    Args:
        shared: the folder with the models.
    """
    yield "SNAKES", "philosophers 5", *snakes(philosophers(5), 3**5)
    yield "SNAKES", "database 5", *snakes(database(5), 1 + 5 * 3**4)
    file = shared / "bench/kanban5.pnml"
    if not file.exists():
        print("bench: kanban5.pnml is not there: left out", file=sys.stderr)
        return
    if importlib.util.find_spec("pm4py") is None:
        print("bench: pm4py is not installed: left out", file=sys.stderr)
        return
    yield "pm4py", "Kanban 2", *pm4py(Plain.read(file, cards=2), 4_600)


def snakes(net: PetriNet, expected: int) -> tuple[int, float]:
    """States and seconds of a state graph."""
    began = time.perf_counter()
    graph = StateGraph(net)
    graph.build()
    return _checked("SNAKES", len(graph), expected), time.perf_counter() - began


def _checked(peer: str, states: int, expected: int) -> int:
    if states != expected:
        raise SystemExit(f"bench: {peer} finds {states} states, not {expected}")
    return states


@dataclass(frozen=True, slots=True)
class Plain:
    """A place/transition net with weights of 1.

    Args:
        places: name -> tokens at first.
        transitions: names.
        arcs: from, to.
    """

    places: dict[str, int]
    transitions: tuple[str, ...]
    arcs: tuple[tuple[str, str], ...]

    @staticmethod
    def read(file: Path, cards: int) -> Plain:
        """A PNML file, with so many tokens in each place that is marked at first."""
        root = ET.parse(file).getroot()
        marked = f"{_PNML}initialMarking"
        return Plain(
            {
                p.attrib["id"]: cards * (p.find(marked) is not None)
                for p in root.iter(f"{_PNML}place")
            },
            tuple(t.attrib["id"] for t in root.iter(f"{_PNML}transition")),
            tuple((a.attrib["source"], a.attrib["target"]) for a in root.iter(f"{_PNML}arc")),
        )


def pm4py(plain: Plain, expected: int) -> tuple[int, float]:
    """States and seconds of a reachability graph."""
    from pm4py.objects.petri_net.obj import Marking  # type: ignore[import-not-found]
    from pm4py.objects.petri_net.obj import PetriNet as Net
    from pm4py.objects.petri_net.utils import petri_utils, reachability_graph

    net = Net("plain")
    nodes = {name: Net.Place(name) for name in plain.places}
    nodes |= {name: Net.Transition(name, name) for name in plain.transitions}
    net.places.update(nodes[name] for name in plain.places)
    net.transitions.update(nodes[name] for name in plain.transitions)
    for source, target in plain.arcs:
        petri_utils.add_arc_from_to(nodes[source], nodes[target], net)
    marking = Marking({nodes[name]: tokens for name, tokens in plain.places.items() if tokens})
    began = time.perf_counter()
    graph = reachability_graph.construct_reachability_graph(net, marking)
    seconds = time.perf_counter() - began
    return _checked("pm4py", len(graph.states), expected), seconds


def philosophers(size: int) -> PetriNet:
    """Who take one fork after the other, in any order."""
    net = PetriNet("philosophers")
    net.globals["n"] = size
    for name in ("think", "fork", "c1", "c2", "eat"):
        net.add_place(Place(name, list(range(size)) if name in ("think", "fork") else []))
    p, after = Variable("p"), Expression("(p + 1) % n")
    for name, source, fork, target in (
        ("a1", "think", "q == p", "c1"),
        ("b1", "think", "q == (p + 1) % n", "c2"),
        ("a2", "c1", "q == (p + 1) % n", "eat"),
        ("b2", "c2", "q == p", "eat"),
    ):
        net.add_transition(Transition(name, Expression(fork)))
        net.add_input(source, name, p)
        net.add_input("fork", name, Variable("q"))
        net.add_output(target, name, p)
    net.add_transition(Transition("fin"))
    net.add_input("eat", "fin", p)
    net.add_output("think", "fin", p)
    net.add_output("fork", "fin", MultiArc([p, after]))
    return net


def database(size: int) -> PetriNet:
    """The distributed database; who sends is unfolded, as arcs cannot compute what they take."""
    net = PetriNet("database")
    managers = list(range(size))
    messages = [(s, r) for s in managers for r in managers if s != r]
    first = {"inactive": managers, "unused": messages, "passive": [dot]}
    rest = ("waiting", "performing", "sent", "received", "acknowledged", "active")
    for name in (*first, *rest):
        net.add_place(Place(name, first.get(name, [])))
    for s in managers:
        of_s = MultiArc([Value(message) for message in messages if message[0] == s])
        for name, takes, puts in (
            (f"send {s}", ("inactive", "passive", "unused"), ("waiting", "active", "sent")),
            (f"done {s}", ("waiting", "active", "acknowledged"), ("inactive", "passive", "unused")),
        ):
            net.add_transition(Transition(name))
            for arc, take, put in zip((Value(s), Value(dot), of_s), takes, puts, strict=True):
                net.add_input(take, name, arc)
                net.add_output(put, name, arc)
    message, r = Variable("m"), Variable("r")
    for name, takes, puts in (
        ("receive", ("inactive", "sent"), ("performing", "received")),
        ("answer", ("performing", "received"), ("inactive", "acknowledged")),
    ):
        net.add_transition(Transition(name, Expression("m[1] == r")))
        for arc, take, put in zip((r, message), takes, puts, strict=True):
            net.add_input(take, name, arc)
            net.add_output(put, name, arc)
    return net
