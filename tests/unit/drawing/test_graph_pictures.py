"""Pictures of small state spaces, plots of explorations: what is in them, hostile texts, what is too large."""

from __future__ import annotations

import json
import re
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from helpers import netbuilder
from pn2code.diagnostics import Diagnostics
from pn2code.drawing.arrange import arrange
from pn2code.net.flat import FlatNet
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.result import Exploration
from pn2code.verify.report.graph import StateGraph, read
from pn2code.verify.report.graph_layout import lay_out
from pn2code.verify.report.graph_page import page
from pn2code.verify.report.graph_svg import picture
from pn2code.verify.report.pictures import Pictures
from pn2code.verify.report.plots import Record, plot

SVG = "{http://www.w3.org/2000/svg}"

NET = """
net Letters
  standard
  var s : STRING;
  page Top
    place Box : STRING = 1`"<b>&"
    place Bin : STRING
    trans Move
      in Box : s
      out Bin : s
    trans Back
      in Bin : s
      out Box : s
    trans Burn
      in Bin : s
    trans Look
      both Box : s
"""


@pytest.fixture(scope="module")
def net() -> FlatNet:
    return netbuilder.flat(NET)


def node(number: int, box: int, bin_: int) -> dict[str, Any]:
    held = {"Top.Box": [[box, "<b>&"]] * bool(box), "Top.Bin": [[bin_, "<b>&"]] * bool(bin_)}
    return {"node": number, "t": 0, "marking": held}


def arc(net: FlatNet, source: int, target: int, short: str) -> dict[str, Any]:
    t = next(t for t in net.transitions if t.short == short)
    found = {"from": source, "to": target, "t": 0, "transition": t.name, "index": t.index}
    return {**found, "binding": {"s": "<b>&"}}


def written(net: FlatNet, path: Path) -> StateGraph:
    rows = [
        node(1, 1, 0), arc(net, 1, 1, "Look"), arc(net, 1, 2, "Move"),
        node(2, 0, 1), arc(net, 2, 1, "Back"), arc(net, 2, 3, "Burn"), arc(net, 2, 3, "Burn"),
        node(3, 0, 0),
    ]  # fmt: skip
    path.write_text("\n".join(map(json.dumps, rows)), encoding="utf-8")
    return read(net, path)


@pytest.fixture
def graph(net: FlatNet, tmp_path: Path) -> StateGraph:
    return written(net, tmp_path / "graph.jsonl")


def test_what_the_graph_says(graph: StateGraph) -> None:
    assert [n.marks for n in graph.nodes] == [
        (("Box", '1`"<b>&"'),), (("Bin", '1`"<b>&"'),), (),
    ]  # fmt: skip
    assert [n.depth for n in graph.nodes] == [0, 1, 2]
    assert [n.component for n in graph.nodes] == [0, 0, 1]
    assert graph.components == 2 and graph.cyclic == {0}
    assert graph.dead == {3} and graph.home == {3}
    assert len(graph.arcs) == 4  # equal ones count once
    assert [graph.arcs[i].label for i in graph.path] == ['Move s="<b>&"', 'Burn s="<b>&"']


def test_the_picture_has_every_node_and_line_once(graph: StateGraph) -> None:
    svg = picture(graph, "a <net>")
    root = etree.fromstring(svg.encode())
    kinds = [g.get("class") for g in root.iter(f"{SVG}g")]
    assert sorted(kinds) == sorted(
        ["node", "node", "node home dead", "arc", "arc", "arc way", "arc way"] + ["label"] * 4
    )
    titles = [t.text or "" for t in root.iter(f"{SVG}title")]
    assert 'node 1 (initial marking)\nBox: 1`"<b>&"' in titles
    assert "node 3 (home marking, dead marking)\nempty" in titles
    assert '2 → 3\nBurn s="<b>&"' in titles
    assert picture(graph, "a <net>") == svg


def test_the_page_needs_nothing_else_and_links_both_ways(net: FlatNet, graph: StateGraph) -> None:
    html = page(net, graph)
    assert html.count("<script") == 1  # ours
    assert "<b>&" not in html and "http" not in html.replace("http://www.w3.org/2000/svg", "")
    targets = set(re.findall(r'id="([^"]+)"', html))
    links = set(re.findall(r'href="#([^"]+)"', html))
    assert links <= targets
    assert {"node-1", "node-2", "node-3", "row-1", "row-2", "row-3", "arc-0", "arc-3"} <= links


def ring(net: FlatNet, path: Path, size: int) -> StateGraph:
    """As many nodes with ways forth, back to the start, and inside a layer."""
    rows = []
    for n in range(1, size + 1):
        rows.append(node(n, n, 0))
        rows += [arc(net, n, m, "Move") for m in (2 * n, 2 * n + 1) if m <= size]
        rows.append(arc(net, n, n - 1 if n % 2 and n > 1 else 1, "Back"))
    path.write_text("\n".join(map(json.dumps, rows)), encoding="utf-8")
    return read(net, path)


@pytest.mark.parametrize("size", [31, 200])
def test_nothing_covers_anything_else(net: FlatNet, tmp_path: Path, size: int) -> None:
    layout = lay_out(ring(net, tmp_path / "graph.jsonl", size))
    boxes = [p.box for p in layout.nodes]
    boxes += [e.box for e in layout.edges if e.box is not None]
    assert layout.is_labelled == (size == 31) and len(layout.nodes) == size
    assert not [1 for a, b in combinations(boxes, 2) if a.overlaps(b)]
    tops = {p.node.number: p.box.top for p in layout.nodes}
    assert all(tops[n] < tops[2 * n] for n in range(1, size // 2))


def test_arrange_takes_the_layers_of_the_caller() -> None:
    found = arrange(
        {"a": (20, 10), "b": (20, 10), "c": (20, 10)},
        {"ab": ("a", "b"), "bc": ("b", "c"), "ca": ("c", "a")},
        {"a": 0, "b": 2, "c": 2},
        (10.0, 30.0),
    )
    assert found.centres["a"][1] < found.centres["b"][1] == found.centres["c"][1]
    assert set(found.bends) == {"ab", "ca"}


def explored(**other: Any) -> Exploration:
    found = {
        "complete": True, "why": "complete", "error": None, "nodes": 3, "arcs": 4, "depth": 2, "seconds": 2.0,
        "bytes_per_state": 8.0, "peak_mib": 1.0, "threads": 1, "fired": [1, 1, 1, 1], "dead_count": 1, "dead": [3],
        **other,
    }  # fmt: skip
    return Exploration.of(netbuilder.flat(NET), found, 0.0)


@pytest.mark.parametrize(
    ("name", "found", "said"),
    [
        ("g.svg", {"nodes": 301}, "301 nodes and 4 arcs, at most 300 nodes"),
        ("g.html", {"nodes": 5001}, "at most 5,000 nodes"),
        ("g.html", {"arcs": 70000}, "3 nodes and 70,000 arcs"),
        ("g.html", {"complete": False, "why": "states"}, "the exploration is not complete"),
        ("g.html", {}, "`--no-graph`"),
    ],
)
def test_what_is_not_drawn(
    net: FlatNet, tmp_path: Path, name: str, found: dict[str, Any], said: str
) -> None:
    d = Diagnostics()
    with Pictures(tmp_path / name, None) as pictures:
        options = pictures.options(ExploreOptions())
        assert options.graph is not None and options.graph_limit == (300 if "svg" in name else 5000)
        pictures.write(net, explored(**found), d)
    (warning,) = d.sorted()
    assert warning.code == "graph-not-drawn" and said in warning.message
    assert not d.has_errors and not (tmp_path / name).exists()


def test_a_folder_that_is_missing_is_an_error(net: FlatNet, tmp_path: Path) -> None:
    d = Diagnostics()
    with Pictures(tmp_path / "no" / "g.svg", None) as pictures:
        graph = pictures.options(ExploreOptions()).graph
        assert graph is not None
        written(net, graph)
        pictures.write(net, explored(), d)
    assert [i.code for i in d.errors] == ["report-unwritable"]


def test_plots(tmp_path: Path) -> None:
    record = Record()
    said = [(0.5, 9, 0), (0.2, 10, 1), (0.4, 60, 1), (0.9, 80, 2), (1.9, 100, 2)]
    for seconds, states, depth in said:
        line = {"states": states, "arcs": 2 * states, "frontier": 5, "depth": depth, "mib": 0.5}
        record.add({**line, "seconds": seconds, "phase": "explore"})
    record.add({"states": 100, "seconds": 2.5, "phase": "graph"})
    found = explored(nodes=100, arcs=220)
    samples = record.samples(found)
    assert [(s.seconds, s.states) for s in samples] == [
        (0.0, 1), (0.2, 10), (0.4, 60), (0.9, 80), (1.9, 100), (2.0, 100),
    ]  # fmt: skip
    assert [round(s.rate) for s in samples] == [0, 45, 250, 40, 20, 0]
    assert samples[-1].waiting == 0
    for name in ("plot.svg", "plot.png"):
        plot(record, found, "net", tmp_path / name)
    svg = (tmp_path / "plot.svg").read_text(encoding="utf-8")
    assert "states per second" in svg and "time of exploration [s]" in svg and "100 states" in svg
    assert (tmp_path / "plot.png").read_bytes().startswith(b"\x89PNG")
    before = (tmp_path / "plot.svg").read_bytes()
    plot(record, found, "net", tmp_path / "plot.svg")
    assert (tmp_path / "plot.svg").read_bytes() == before
