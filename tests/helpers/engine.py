"""Comparison of the token game with what the real CPN Tools engine recorded (state spaces, markings, runs)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from pn2code.net.flat import FlatNet, FlatPlace, FlatTransition
from pn2code.semantics.game import Game, GameError
from pn2code.semantics.graph import StateSpace
from pn2code.semantics.marking import BindingElement, Marking, place_text, variable_text
from pn2code.semantics.values import real_text

Node = tuple[str, tuple[tuple[str, str], ...]]
Arc = tuple[Node, str, str, Node]

RANDOM = re.compile(
    r"\b(discrete|uniform|exponential|normal|poisson|erlang|bernoulli|binomial|weibull|student|random|ran)\b"
)
"""The random functions of CPN ML: nets that use them cannot be repeated exactly."""


def engine_name(name: str) -> str:
    """A name of the net as the engine writes it."""
    cut = re.match(r"[A-Za-z'_0-9 \n\t.\-]*", name.strip())
    assert cut is not None
    return re.sub(r"[^A-Za-z'_0-9]", "_", cut[0].strip())


def squeezed(name: str) -> str:
    """A transition's name without what the engine adds to it: `_u1` for a second one of the name, `N` before digits."""
    name = re.sub(r"_u[0-9]+$", "", name)
    name = re.sub(r"^N(?=[0-9]|id)", "", name)
    return re.sub("_+", "_", name).strip("_")


# --- state spaces --------------------------------------------------------------------------------


def place_key(p: FlatPlace) -> str:
    return f"{engine_name(p.page)}'{engine_name(p.short)} {p.instance_number}"


def our_nodes(game: Game, space: StateSpace) -> list[Node]:
    """Each node as (time, marking texts), in the engine's notation."""
    nodes = []
    for marking in space.nodes:
        texts = (
            (
                place_key(p),
                place_text(game.colours, p.colset, marking.places[p.index], earlier_first=True),
            )
            for p in game.net.places
        )
        nodes.append((str(marking.time) if game.net.timed else "", tuple(sorted(texts))))
    return nodes


def our_arcs(game: Game, space: StateSpace) -> set[Arc]:
    nodes = our_nodes(game, space)
    found = set()
    for arc in space.arcs:
        t = game.net.transitions[arc.element.transition]
        name = f"{engine_name(t.page)}'{engine_name(t.short)} {t.instance_number}"
        found.add((nodes[arc.source], name, binding_text(game, arc.element), nodes[arc.target]))
    return found


def binding_text(game: Game, element: BindingElement) -> str:
    values = sorted((s.name, variable_text(game.colours, s, x)) for s, x in element.values)
    return ",".join(f"{name}={text}" for name, text in values)


def engine_nodes(net: FlatNet, graph: dict[str, Any]) -> dict[int, Node]:
    """The engine's nodes by number, with the places that the flat net has."""
    ours = {place_key(p) for p in net.places}
    found = {}
    for node in graph["nodes"]:
        texts = {name: text for name, text in node["marking"].items() if name in ours}
        time = str(node.get("time", "")) if net.timed else ""
        found[node["node"]] = (time, tuple(sorted(texts.items())))
    return found


def engine_arcs(net: FlatNet, graph: dict[str, Any]) -> set[Arc]:
    nodes = engine_nodes(net, graph)
    return {
        (nodes[a["from"]], a["transition"], _sorted_binding(a["binding"]), nodes[a["to"]])
        for a in graph["arcs"]
    }


def _sorted_binding(text: str) -> str:
    """Bindings by name of variable. (No value in the recorded graphs has a `name=` in it, but a lone record.)"""
    parts = re.split(r",(?=[A-Za-z_][A-Za-z0-9_']*=)", text) if "{" not in text else [text]
    return ",".join(sorted(parts))


# --- initial markings ----------------------------------------------------------------------------


def initial_differences(game: Game, recorded: list[dict[str, Any]], xml: str) -> list[str]:
    """Where the initial marking differs from the engine's, which lists fusion sets by their own ids as well."""
    numbers = {p.instance: p.instance_number for p in game.net.places}
    numbers |= {t.instance: t.instance_number for t in game.net.transitions}
    where: dict[tuple[str, int], FlatPlace] = {}
    for p in game.net.places:
        for identity, path in p.member_ids:
            where[identity, numbers.get(path, 1)] = p
    by_name = {p.name: p for p in game.net.places}
    for identity, name in re.findall(r'<fusion id="([^"]*)"\s*name="([^"]*)"', xml):
        if f"Fusion.{name}" in by_name:
            where[identity, 1] = by_name[f"Fusion.{name}"]
    found = []
    for entry in recorded:
        place = where.get((entry["id"], entry["instance"]))
        ours = game.marking_text(place.name) if place else "no such place"
        if ours != entry["marking"]:
            found.append(f"{entry['id']}: {ours!r} instead of {entry['marking']!r}")
    return found


# --- runs ----------------------------------------------------------------------------------------


def run_difference(game: Game, run: dict[str, Any]) -> str:
    """Repeats a recorded run; "" or what went otherwise.

    Names of transitions are not unique in the record, so all elements that look right are followed.
    """
    by_name: dict[tuple[str, str], list[FlatTransition]] = {}
    for t in game.net.transitions:
        by_name.setdefault((engine_name(t.page), squeezed(engine_name(t.short))), []).append(t)
    markings: dict[Marking, None] = {game.marking: None}
    for step in run["steps"]:
        candidates = by_name.get((step["page"], squeezed(step["transition"])), [])
        successors: dict[Marking, None] = {}
        times = set()
        for before in markings:
            marking = game.settle(before)
            times.add(_time_text(marking))
            if _time_text(marking) == step["time"]:
                for t in candidates:
                    successors |= dict.fromkeys(_successors(game, t, marking, step["binding"]))
        if not successors:
            where = "" if step["time"] in times else f", which is at {step['time']}, not at {times}"
            return f"step {step['step']}, {step['transition']} {step['binding']}{where}"
        markings = successors
    if run["stopped_by_error"]:
        return ""
    differences = [_final_difference(game, m, run["final_marking"]) for m in markings]
    return "" if "" in differences else differences[0]


def _time_text(marking: Marking) -> str:
    return real_text(marking.time) if isinstance(marking.time, float) else str(marking.time)


def _successors(
    game: Game, t: FlatTransition, marking: Marking, wanted: dict[str, str]
) -> Iterator[Marking]:
    for binding in game.enabling.enabled(t, marking):
        element = BindingElement.make(t, binding)
        if game.obstacle(marking, element) is not None:
            continue
        try:
            successor, occurred = game.occur(marking, element)
        except GameError:
            continue
        if all(
            _squashed(variable_text(game.colours, s, x)) == _squashed(wanted.get(s.name, ""))
            for s, x in occurred.values
        ):
            yield successor


def _squashed(text: str) -> str:
    return text.replace("\\n", "").replace(" ", "").replace("\n", "")


def _final_difference(game: Game, marking: Marking, recorded: list[dict[str, Any]]) -> str:
    places: dict[str, list[FlatPlace]] = {}
    for p in game.net.places:
        for identity in {i for i, _ in p.member_ids}:
            places.setdefault(identity, []).append(p)
    for entry in recorded:
        found = places.get(entry["id"], [])
        texts = {place_text(game.colours, p.colset, marking.places[p.index]) for p in found}
        if texts and entry["marking"] not in texts:
            return f"in the end {found[0].name} holds {texts}, not {entry['marking']!r}"
    return ""
