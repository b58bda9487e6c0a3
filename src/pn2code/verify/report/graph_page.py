"""A small state space as one HTML file: the picture, and tables of nodes and arcs that it is linked with.

It can be read without a network; with scripts it can be zoomed, moved and searched.
"""

from __future__ import annotations

from collections.abc import Sequence

from markupsafe import Markup

import pn2code
from pn2code.drawing.svg import MARGIN, svg_attributes
from pn2code.net.flat import FlatNet
from pn2code.verify.report import html
from pn2code.verify.report.graph import Node, StateGraph
from pn2code.verify.report.graph_layout import lay_out
from pn2code.verify.report.graph_svg import Links, facts, figure, is_large, legend, sample

_WINDOW = 1300.0
"""Pixels: a wider picture is shown as a whole first."""


def page(net: FlatNet, graph: StateGraph, remarks: Sequence[str] = ()) -> str:
    """The whole page.

    Args:
        net: the net.
        graph: its state space.
        remarks: what must be known of it: that it is reduced, ...
    """
    body, box = figure(
        lay_out(graph),
        graph,
        Links(lambda n: f"#row-{n}", lambda i: f"#arc-{i}", lambda n: f"node-{n}"),
    )
    picture = "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" {svg_attributes(box.grown(MARGIN))} '
            'role="group" aria-label="state space">',
            *body,
            "</svg>",
        ]
    )
    first: dict[int, list[tuple[int, int]]] = {n.number: [] for n in graph.nodes}
    for (source, target), arcs in graph.edges().items():
        first[source].append((target, arcs[0]))
    # Names and values are strangers' texts: all of them are escaped, there or (the picture) where they are drawn.
    return html.page(
        "graph.html.j2",
        ("report.css", "graph.css"),
        title=net.name,
        facts=facts(graph),
        is_wide=box.width > _WINDOW,
        version=pn2code.__version__,
        sha256=net.sha256,
        remarks=remarks,
        legend=[{"sample": Markup(sample(item)), "text": item.text} for item in legend(graph)],
        picture=Markup(picture),
        path=[graph.arcs[i] for i in graph.path],
        timed=net.timed,
        nodes=[
            {
                "node": n,
                "is_dead": n.number in graph.dead,
                "kinds": _kinds(n, graph),
                "marking": "\n".join(f"{place}: {tokens}" for place, tokens in n.marks) or "empty",
                "successors": sorted(first[n.number]),
            }
            for n in graph.nodes
        ],
        arcs=graph.arcs,
        is_large=is_large(graph),
        canvas=html.script("graph_canvas.js"),
        script=html.script("graph.js"),
    )


def _kinds(node: Node, graph: StateGraph) -> str:
    """`initial, home`."""
    found = ["initial"] if node.number == 1 else []
    found += ["home"] if node.number in graph.home else []
    found += ["dead"] if node.number in graph.dead else []
    return ", ".join(found)
