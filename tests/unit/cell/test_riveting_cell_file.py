"""The file of the riveting cell: as CPN Tools 4 writes files, tidy to look at, and what cell.toml expects."""

from __future__ import annotations

import itertools
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from lxml import etree

from pn2code.diagnostics import Diagnostics
from pn2code.reading.cpn import read
from pn2code.reading.document import Document, Layout, RawBlock, RawColset, RawMl

Box = tuple[float, float, float, float]


@pytest.fixture(scope="module")
def cell(root: Path) -> Document:
    d = Diagnostics()
    document = read(root / "examples/riveting/cell.cpn", d)
    assert not d.items
    assert document is not None
    return document


@pytest.fixture(scope="module")
def config(root: Path) -> dict[str, object]:
    return tomllib.loads((root / "examples/riveting/cell.toml").read_text(encoding="utf-8"))


def declarations(block: RawBlock) -> Iterator[object]:
    for item in block.items:
        if isinstance(item, RawBlock):
            yield from declarations(item)
        else:
            yield item


def test_what_cell_toml_names_is_there(cell: Document, config: dict) -> None:
    top = cell.pages[0]
    assert top.name == "Cell"
    unused = {"referencia2", "medida2"}  # sockets of robot 2, which has no camera
    assert {c["place"] for c in config["channel"]} == {p.name for p in top.places} - unused
    wanted = {config["supervisor"]["instance"], *(r["instance"] for r in config["robots"].values())}
    assert wanted == {t.name for t in top.transitions if t.substitution}
    supervisor = next(p for p in cell.pages if p.name == "Supervisor")
    places = {p.name: p for p in supervisor.places}
    assert set(config["supervisor"]["final"]) <= set(places)
    assert all(i["place"] in places and places[i["place"]].initial for i in config["input"])
    found = list(declarations(cell.globbox))
    assert set(config["storage"]) <= {c.name for c in found if isinstance(c, RawColset)}
    text = "\n".join(m.text.text for m in found if isinstance(m, RawMl))
    for primitive in config["primitives"]:
        assert len(re.findall(rf"^fun {primitive} ", text, re.MULTILINE)) == 1


def test_channel_places_start_empty(cell: Document) -> None:
    assert all(p.initial is None for p in cell.pages[0].places)


def test_the_input_file_is_the_initial_marking(cell: Document, root: Path) -> None:
    places = itertools.chain.from_iterable(p.places for p in cell.pages)
    marking = next(p.initial for p in places if p.name == "coordenadas" and p.initial)
    in_net = [float(n.replace("~", "-")) for n in re.findall(r"~?\d+(?:\.\d+)?", marking.text.text)]
    file = (root / "examples/riveting/coordenadas.robcad").read_text(encoding="ascii")
    assert in_net == [float(n) for n in file.split()]


def test_pages_are_small_and_explained(cell: Document) -> None:
    for page in cell.pages:
        assert len(page.transitions) <= 12, page.name
        assert page.auxiliaries, page.name


def box(layout: Layout) -> Box:
    w, h = layout.width / 2, layout.height / 2
    return (layout.x - w, layout.y - h, layout.x + w, layout.y + h)


def overlap(a: Box, b: Box, gap: float = 0.0) -> bool:
    return a[0] < b[2] + gap and b[0] < a[2] + gap and a[1] < b[3] + gap and b[1] < a[3] + gap


def test_nodes_keep_their_distance(cell: Document) -> None:
    for page in cell.pages:
        nodes = [(n.name, box(n.layout)) for n in (*page.places, *page.transitions)]
        for (n, a), (m, b) in itertools.combinations(nodes, 2):
            assert not overlap(a, b, 8.0), (page.name, n, m)


def towards(node: Layout, x: float, y: float) -> tuple[float, float]:
    """The point inside a node that CPN Tools lets an arc from (x, y) point to."""
    left, low, right, high = box(node)
    inside_x, inside_y = left < x < right, low < y < high
    return (x if inside_x else node.x, y if inside_y else node.y)


def test_arcs_are_orthogonal_and_avoid_other_nodes(cell: Document) -> None:
    for page in cell.pages:
        nodes = {n.id: n for n in (*page.places, *page.transitions)}
        for arc in page.arcs:
            t, p = nodes[arc.transition].layout, nodes[arc.place].layout
            bends = arc.layout.bends
            first = towards(t, *bends[0]) if bends else (t.x, t.y)
            last = towards(p, *bends[-1]) if bends else (p.x, p.y)
            points = [first, *bends, last]
            for (ax, ay), (bx, by) in itertools.pairwise(points):
                assert min(abs(ax - bx), abs(ay - by)) < 0.5, (page.name, arc.id, points)
                line = (min(ax, bx), min(ay, by), max(ax, bx), max(ay, by))
                for node in nodes.values():
                    if node.id not in (arc.transition, arc.place):
                        assert not overlap(line, box(node.layout)), (page.name, arc.id, node.name)


def elements(data: bytes) -> Iterator[tuple[tuple[str, str], tuple[str, ...], tuple[str, ...]]]:
    """For every element: (parent, tag), its attributes, its children's tags without repetition."""
    parser = etree.XMLParser(load_dtd=False, no_network=True, resolve_entities=False)
    for e in etree.fromstring(data, parser).iter(etree.Element):
        parent = e.getparent()
        children = tuple(tag for tag, _ in itertools.groupby(c.tag for c in e))
        yield ("" if parent is None else parent.tag, e.tag), tuple(e.attrib), children


@pytest.mark.shared
def test_structure_is_that_of_files_saved_by_cpn_tools(shared: Path, root: Path) -> None:
    attributes: dict[tuple[str, str], set[tuple[str, ...]]] = {}
    before: dict[tuple[str, str], set[tuple[str, str]]] = {}
    for path in sorted((shared / "corpus/nets").rglob("*.cpn")):
        data = path.read_bytes()
        if b'version="4.0' not in data[:600]:
            continue
        for key, names, children in elements(data):
            attributes.setdefault(key, set()).add(names)
            before.setdefault(key, set()).update(itertools.combinations(children, 2))
    assert attributes
    for key, names, children in elements((root / "examples/riveting/cell.cpn").read_bytes()):
        assert names in attributes[key]
        if key[1] not in ("block", "globbox"):  # declarations come in any order
            assert set(itertools.combinations(children, 2)) <= before[key], (key, children)


def test_ids_are_unique_and_as_cpn_tools_parses_them(root: Path) -> None:
    tree = etree.parse(root / "examples/riveting/cell.cpn")
    ids = [e.get("id") for e in tree.iter() if e.get("id") is not None]
    assert len(ids) == len(set(ids))
    assert all(re.fullmatch(r"ID\d+", i) for i in ids)
    for e in tree.iter():
        for reference in ("idref", "page", "trans", "subpage", "instance"):
            assert e.get(reference) is None or e.get(reference) in ids
