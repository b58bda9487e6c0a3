"""State spaces in the notation of the real engine, ours and its own, for comparison as sets."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from typing import Any

from pn2code.base.readable import readable
from pn2code.net.engine_names import EngineNames
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.graph import StateSpace
from pn2code.semantics.game.marking import (
    BindingElement,
    place_from_json,
    place_text,
    variable_text,
)
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.colour_json import from_json
from pn2code.semantics.values.colours import TEXTS

Node = tuple[str, tuple[tuple[str, str], ...]]
"""(time, ((place, marking), ...))"""
Arc = tuple[Node, str, str, Node]
"""(source, transition, binding, target)"""
_NEXT = re.compile(r"[A-Za-z_][A-Za-z0-9_']*=")
"""How the next variable of a binding begins."""


def our_nodes(game: Game, space: StateSpace) -> list[Node]:
    """Each node as (time, marking texts), in the engine's notation."""
    nodes = []
    names = EngineNames(game.net)
    for marking in space.nodes:
        texts = (
            (
                names.place(p.index),
                place_text(game.colours, p.colset, marking.places[p.index], earlier_first=True),
            )
            for p in game.net.places
        )
        nodes.append((str(marking.time) if game.net.timed else "", tuple(sorted(texts))))
    return nodes


def our_arcs(game: Game, space: StateSpace) -> set[Arc]:
    """Our arcs, in the engine's notation."""
    nodes = our_nodes(game, space)
    names = EngineNames(game.net)
    found = set()
    for arc in space.arcs:
        name = names.transition(arc.element.transition)
        found.add((nodes[arc.source], name, binding_text(game, arc.element), nodes[arc.target]))
    return found


def binding_text(game: Game, element: BindingElement) -> str:
    """`n=1,p="a"`, by name of variable."""
    values = sorted((s.name, variable_text(game.colours, s, x)) for s, x in element.values)
    return ",".join(f"{name}={text}" for name, text in values)


def written(net: FlatNet, lines: Iterable[str]) -> tuple[list[Node], set[Arc]]:
    """What the compiled explorer writes of a graph (`--write-graph`), in the engine's notation."""
    nodes: list[Node] = []
    names = EngineNames(net)
    rows = []
    for line in lines:
        entry = json.loads(line)
        if "node" in entry:
            nodes.append(_written_node(net, names, entry))
        else:
            rows.append(entry)
    arcs = set()
    for row in rows:
        symbols = {s.name: s for s in net.transitions[row["index"]].variables}
        values = sorted(
            (name, readable(TEXTS.text(colset, from_json(colset, value))))
            for name, value in row["binding"].items()
            if (colset := symbols[name].colset) is not None
        )
        binding = ",".join(f"{name}={text}" for name, text in values)
        transition = names.transition(row["index"])
        arcs.add((nodes[row["from"] - 1], transition, binding, nodes[row["to"] - 1]))
    return nodes, arcs


def _written_node(net: FlatNet, names: EngineNames, entry: dict[str, Any]) -> Node:
    texts = []
    for p in net.places:
        tokens = place_from_json(p.colset, entry["marking"][p.name])
        text = place_text(TEXTS, p.colset, tokens, earlier_first=True)
        texts.append((names.place(p.index), text))
    return (str(entry["t"]) if net.timed else "", tuple(sorted(texts)))


def engine_nodes(net: FlatNet, graph: dict[str, Any]) -> dict[int, Node]:
    """The engine's nodes by number, with the places that the flat net has."""
    names = EngineNames(net)
    ours = {names.place(p.index) for p in net.places}
    found = {}
    for node in graph["nodes"]:
        texts = {name: text for name, text in node["marking"].items() if name in ours}
        time = str(node.get("time", "")) if net.timed else ""
        found[node["node"]] = (time, tuple(sorted(texts.items())))
    return found


def engine_arcs(net: FlatNet, graph: dict[str, Any]) -> set[Arc]:
    """The engine's arcs."""
    nodes = engine_nodes(net, graph)
    return {
        (nodes[a["from"]], a["transition"], _sorted_binding(a["binding"]), nodes[a["to"]])
        for a in graph["arcs"]
    }


def _sorted_binding(text: str) -> str:
    """Bindings by name of variable: `b2=3,b=2,a={x=1,y=2}` becomes `a={x=1,y=2},b=2,b2=3`."""
    parts, depth, in_string = [""], 0, False
    for at, sign in enumerate(text):
        in_string ^= sign == '"'
        if not in_string:
            depth += (sign in "([{") - (sign in ")]}")
        if sign == "," and not depth and not in_string and _NEXT.match(text, at + 1):
            parts.append("")
        else:
            parts[-1] += sign
    return ",".join(sorted(parts, key=lambda part: part.partition("=")[0]))
