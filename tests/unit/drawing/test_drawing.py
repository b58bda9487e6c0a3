"""Drawing: positions, well-formed XML, everything drawn once, hostile texts, automatic layout, links."""

from __future__ import annotations

import html.parser
import itertools
import re
from pathlib import Path

import pytest
from lxml import etree

from helpers import netbuilder
from helpers.thorough import amount
from pn2code.diagnostics import Diagnostics
from pn2code.drawing import geometry, text
from pn2code.drawing.arrange import arrange
from pn2code.drawing.files import file_stem, file_stems
from pn2code.drawing.html import Facts, draw_net
from pn2code.drawing.scene import build
from pn2code.drawing.style import colour, dash
from pn2code.drawing.svg import Links, Overlay, Problem, Tokens, draw_page, draw_pages
from pn2code.drawing.units import in_points
from pn2code.reading.cpn import read_data
from pn2code.reading.document import Document, RawPage

SVG = "{http://www.w3.org/2000/svg}"

SMALL = """
net Small
  standard
  colset PAIR = product INT * STRING;
  var n : INT;
  page Top
    place Buffer : INT = 1`1 ++ 2`5
    place Shared fusion Common : INT
    trans Take guard [n > 1] delay @+3 priority P_LOW
      in Buffer : n
      out Shared : n + 1
      both Shared : n
      inhibit Buffer
      reset Shared
    subst Deep = Sub (Inp -> Buffer)
  page Sub
    place Inp port in : INT
    trans Eat
      in Inp : n
"""


def document(net: str) -> Document:
    found = read_data(netbuilder.cpn(net), "test.cpn", Diagnostics())
    assert found is not None
    return found


def parse(svg: str) -> etree._Element:
    return etree.fromstring(svg.encode("utf-8"))


def groups(root: etree._Element, kind: str) -> list[etree._Element]:
    return [g for g in root.iter(f"{SVG}g") if kind in g.get("class", "").split()]


def ids(root: etree._Element, kind: str) -> list[str | None]:
    return [g.get("data-id") for g in groups(root, kind)]


def layout(**places: str) -> bytes:
    """A net with one place and one transition, whose XML can be replaced piece by piece."""
    net = """<workspaceElements><generator tool="CPN Tools" version="4" format="6"/><cpnet><globbox/>
    <page id="P1"><pageattr name="Page"/>
    <place id="A"><posattr x="-100,000000" y="50,000000"/><lineattr colour="Fucia" thick="2" type="Dashed"/>
      <textattr colour="Navy" bold="true"/><text>Here</text><ellipse w="60" h="40"/>PLACE</place>
    <trans id="T"><posattr x="100" y="50"/><text>There</text><box w="60" h="40"/></trans>
    ARCS
    </page></cpnet></workspaceElements>"""
    for name, piece in {"PLACE": "", "ARCS": "", **places}.items():
        net = net.replace(name, piece)
    return net.encode()


def drawn(data: bytes, **options: object) -> etree._Element:
    found = read_data(data, "test.cpn", Diagnostics())
    assert found is not None
    return parse(draw_page(found, found.pages[0], **options))  # type: ignore[arg-type]


ARC = (
    '<arc id="R" orientation="{0}" order="0"><transend idref="T"/><placeend idref="A"/>'
    '<annot id="N"><posattr x="7" y="60"/><text>n</text></annot>{1}</arc>'
)


# --- positions -----------------------------------------------------------------------------------


def test_positions_colours_and_dashes_are_those_of_the_file() -> None:
    root = drawn(layout())
    (place,) = groups(root, "place")
    ellipse = place.find(f"{SVG}ellipse")
    assert ellipse is not None
    assert (ellipse.get("cx"), ellipse.get("cy")) == ("-100", "-50")  # y grows downwards
    assert (ellipse.get("rx"), ellipse.get("ry")) == ("30", "20")
    assert ellipse.get("stroke") == "#ff00ff" and ellipse.get("stroke-width") == "2"
    assert ellipse.get("stroke-dasharray")
    name = place.find(f"{SVG}text")
    assert name is not None
    assert name.get("fill") == "#000080" and name.get("font-weight") == "bold"
    assert "".join(name.itertext()) == "Here"


def test_an_inscription_stands_around_its_position() -> None:
    root = drawn(layout(ARCS=ARC.format("PtoT", "")))
    (label,) = groups(root, "inscription")
    (span,) = label.iter(f"{SVG}tspan")
    left = float(str(span.get("x")))
    assert left == pytest.approx(7 - text.width("n") / 2, abs=0.1)
    assert -60 < float(str(span.get("y"))) < -53  # the base line, a little below the centre


def test_a_free_text_begins_at_its_position() -> None:
    aux = '<Aux id="X"><posattr x="10" y="20"/><label/><text>one\n  two</text></Aux>'
    root = drawn(layout(ARCS=aux))
    (label,) = groups(root, "aux")
    spans = list(label.iter(f"{SVG}tspan"))
    assert [s.text for s in spans] == ["one", "  two"]
    assert [s.get("x") for s in spans] == ["10", "10"]
    assert -21 <= float(str(spans[0].get("y"))) <= -19


def test_arcs_end_at_the_edges_and_point_the_right_way() -> None:
    to_transition = _heads(drawn(layout(ARCS=ARC.format("PtoT", ""))))
    to_place = _heads(drawn(layout(ARCS=ARC.format("TtoP", ""))))
    assert to_transition == [(70.0, -50.0)] and to_place == [(-70.0, -50.0)]
    assert _heads(drawn(layout(ARCS=ARC.format("BOTHDIR", "")))) == [*to_transition, *to_place]


def _heads(root: etree._Element) -> list[tuple[float, float]]:
    found = []
    for polygon in root.iter(f"{SVG}polygon"):
        x, _, y = str(polygon.get("points")).split()[0].partition(",")
        found.append((float(x), float(y)))
    return found


def test_inhibitor_has_a_circle_and_reset_two_heads_at_the_transition() -> None:
    root = drawn(layout(ARCS=ARC.format("Inhibitor", "")))
    (circle,) = root.iter(f"{SVG}circle")
    assert float(str(circle.get("cx"))) + float(str(circle.get("r"))) == pytest.approx(70)
    assert not _heads(root)
    heads = _heads(drawn(layout(ARCS=ARC.format("Reset", ""))))
    assert len(heads) == 2 and heads[0] == (70.0, -50.0) and heads[1][0] < 70


def test_an_undirected_arc_is_drawn_without_heads() -> None:
    root = drawn(layout(ARCS=ARC.format("NODIR", "")))
    assert ids(root, "arc") == ["R"]
    assert not _heads(root)


def test_bends_are_rounded_and_met_at_right_angles() -> None:
    bend = '<bendpoint id="B" serial="1"><posattr x="{0}" y="{1}"/></bendpoint>'
    root = drawn(layout(ARCS=ARC.format("TtoP", bend.format(-90, 200))))
    (arc,) = groups(root, "arc")
    path = [p.get("d", "") for p in arc.iter(f"{SVG}path")][-1]
    assert "Q-90 -200" in path
    ((x, y),) = _heads(root)
    assert x == -90 and -70 <= y <= -68  # straight down on the place, beside its middle


def test_a_bend_inside_the_node_is_passed_over() -> None:
    bend = '<bendpoint id="B" serial="1"><posattr x="-95" y="55"/></bendpoint>'
    assert _heads(drawn(layout(ARCS=ARC.format("TtoP", bend)))) == [(-70.0, -50.0)]


def test_arcs_between_the_same_nodes_run_side_by_side() -> None:
    second = ARC.format("TtoP", "").replace('"R"', '"R2"').replace('"N"', '"N2"')
    heads = _heads(drawn(layout(ARCS=ARC.format("PtoT", "") + second)))
    assert len({y for _, y in heads}) == 2
    assert abs(heads[0][1] - heads[1][1]) == pytest.approx(10)


def test_old_files_in_millimetres_become_points() -> None:
    old = layout().replace(b'format="6"', b'format="2"')
    assert ids(drawn(old), "place") == ["A"]
    (ellipse,) = groups(drawn(old), "place")[0].iter(f"{SVG}ellipse")
    assert ellipse.get("ry") == "20"  # format 2, but already in points
    small = old.replace(b'w="60" h="40"', b'w="20" h="10"')
    (ellipse,) = groups(drawn(small), "place")[0].iter(f"{SVG}ellipse")
    assert (ellipse.get("cx"), ellipse.get("ry")) == ("-283", "14.2")


def test_default_texts_are_hidden() -> None:
    net = """
    net Defaults
      standard
      place P : INT
      trans T
        guard []
        in P : 1
    """
    page = document(net)
    root = parse(draw_page(page, page.pages[0]))
    assert ids(root, "guard") == []


def test_labels_without_positions_stand_beside_their_node() -> None:
    found = document(SMALL)
    scene = build(found, found.pages[0])
    nodes = {s.id: s for s in scene.shapes}
    for label in scene.labels:
        if label.kind in ("colset", "initial", "guard", "delay", "priority"):
            node = nodes[label.owner].box
            assert label.box.overlaps(node.grown(12)), label
            inner = geometry.around(*nodes[label.owner].centre, 20, 20)
            assert not label.box.overlaps(inner), label


# --- what is on a page ---------------------------------------------------------------------------


def test_everything_is_drawn_once_and_inside() -> None:
    found = document(SMALL)
    for page in found.pages:
        check_page(found, page)
        assert draw_page(found, page) == draw_page(found, page)


def test_tags_of_ports_fusion_sets_and_subpages() -> None:
    found = document(SMALL)
    top, sub = (parse(draw_page(found, p)) for p in found.pages)
    words = {
        kind: ["".join(g.itertext()) for g in groups(root, kind)]
        for root in (top, sub)
        for kind in ("port", "fusion", "subpage")
        if groups(root, kind)
    }
    assert words["fusion"] == ["fusion set: CommonCommon"]
    assert words["subpage"] == ["stands for page SubSub"]
    assert words["port"] == ["port: InIn"]
    (substitution,) = groups(top, "substitution")
    assert len(substitution.findall(f"{SVG}rect")) == 2  # a double box


def test_tool_tips_say_what_the_element_is() -> None:
    found = document(SMALL)
    root = parse(draw_page(found, found.pages[0]))
    titles = [t.text or "" for t in root.iter(f"{SVG}title")]
    assert any(t.startswith("place Buffer : INT\ninitial marking: 1`1 ++ 2`5") for t in titles)
    assert any(t.startswith("transition Take\nguard: [n > 1]") for t in titles)
    assert "arc Take → Shared: n + 1" in titles


def check_page(found: Document, page: RawPage) -> None:
    root = parse(draw_page(found, page))
    assert sorted(map(str, ids(root, "place"))) == sorted(p.id for p in page.places)
    transitions = ids(root, "transition") + ids(root, "substitution")
    assert sorted(map(str, transitions)) == sorted(t.id for t in page.transitions)
    arcs = [a.id for a in (*page.arcs, *page.undirected)]
    assert sorted(map(str, ids(root, "arc"))) == sorted(arcs)
    left, top, width, height = map(float, str(root.get("viewBox")).split())
    view = geometry.Box(left, top, left + width, top + height)
    for shape in (*root.iter(f"{SVG}ellipse"), *root.iter(f"{SVG}rect")):
        if shape.getparent() is root:
            continue
        box = _box(shape)
        assert view.contains(box), etree.tostring(shape)
    for span in root.iter(f"{SVG}tspan"):
        assert view.holds((float(str(span.get("x"))), float(str(span.get("y")))))


def _box(shape: etree._Element) -> geometry.Box:
    def number(name: str) -> float:
        return float(str(shape.get(name)))

    if shape.tag == f"{SVG}ellipse":
        return geometry.around(number("cx"), number("cy"), 2 * number("rx"), 2 * number("ry"))
    x, y = number("x"), number("y")
    return geometry.Box(x, y, x + number("width"), y + number("height"))


@pytest.mark.shared
def test_every_page_of_the_collection(shared: Path) -> None:
    pages = 0
    for path in sorted((shared / "corpus" / "nets").rglob("*.cpn"))[:: amount(6, 1)]:
        found = read_data(path.read_bytes(), path.name, Diagnostics())
        if found is None:
            continue
        for page in found.pages:
            check_page(found, page)
            pages += 1
            check_positions(found, page)
    assert pages > amount(60, 400)


def check_positions(found: Document, page: RawPage) -> None:
    """Nodes keep the distances that the file gives them."""
    scene = build(found, page)
    centres = {s.id: s.centre for s in scene.shapes}
    assert not scene.arranged
    for node in in_points(found, page).nodes:
        x, y = centres[node.id]
        assert abs(x - node.layout.x) <= 0.5 and abs(y + node.layout.y) <= 0.5


def test_a_golden_page(root: Path) -> None:
    """The whole SVG of a small net; after a change on purpose, look at the new picture and replace the file."""
    found = document(SMALL)
    golden = root / "tests" / "golden" / "drawing" / "small.svg"
    svg = draw_page(
        found,
        found.pages[0],
        marking={found.pages[0].places[0].id: Tokens(3, "1`1++\n2`5")},
        enabled={found.pages[0].transitions[0].id},
    )
    assert svg == golden.read_text(encoding="utf-8")


# --- overlays ------------------------------------------------------------------------------------


def test_tokens_stand_where_cpn_tools_puts_them() -> None:
    """Half a bubble and 5 beside the place, moved by the file's offset."""
    piece = '<token x="-10" y="20"/><marking x="3" y="-7" hidden="false"/>'
    root = drawn(layout(PLACE=piece), marking={"A": Tokens(2, "2`7")})
    (tokens,) = groups(root, "tokens")
    (circle,) = tokens.iter(f"{SVG}circle")
    radius = float(str(circle.get("r")))
    assert float(str(circle.get("cx"))) == pytest.approx(-70 + 5 - 10 + radius)
    assert circle.get("cy") == "-70"
    (frame,) = tokens.iter(f"{SVG}rect")
    assert float(str(frame.get("x"))) == pytest.approx(-70 + 5 - 10 + 2 * radius + 5 + 3)
    assert [s.text for s in tokens.iter(f"{SVG}tspan")] == ["2`7", "2"]


def test_a_hidden_marking_shows_the_number_only() -> None:
    piece = '<token x="-10" y="0"/><marking x="0" y="0" hidden="true"/>'
    root = drawn(layout(PLACE=piece), marking={"A": Tokens(2, "2`7")})
    (tokens,) = groups(root, "tokens")
    assert [s.text for s in tokens.iter(f"{SVG}tspan")] == ["2"]


def test_an_empty_place_has_no_bubble() -> None:
    assert not groups(drawn(layout(), marking={"A": Tokens(0, "empty")}), "tokens")


def test_a_long_marking_is_cut_and_stays_in_view() -> None:
    marking = "++\n".join(f"1`{n}" for n in range(500))
    root = drawn(layout(), marking={"A": Tokens(500, marking)})
    (tokens,) = groups(root, "tokens")
    shown = [s.text or "" for s in tokens.iter(f"{SVG}tspan")]
    assert len(shown) == 21 and shown[-2] == "… 481 more"
    (frame,) = tokens.iter(f"{SVG}rect")
    left, top, width, height = map(float, str(root.get("viewBox")).split())
    assert geometry.Box(left, top, left + width, top + height).contains(_box(frame))


def test_only_the_wrong_inscription_is_red() -> None:
    found = document(SMALL)
    take = found.pages[0].transitions[0].id
    root = parse(
        draw_page(found, found.pages[0], problems={take: [Problem("`x` is not bound", "guard")]})
    )
    (problem,) = groups(root, "problem")
    assert problem.get("data-id") == take
    red = {
        kind
        for kind in ("guard", "delay", "priority")
        for g in groups(root, kind)
        for t in g.iter(f"{SVG}text")
        if t.get("fill") == "#e00000"
    }
    assert red == {"guard"}
    assert any("error: `x` is not bound" in (t.text or "") for t in problem.iter(f"{SVG}title"))


def test_enabled_and_highlighted_elements_have_borders() -> None:
    root = drawn(
        layout(ARCS=ARC.format("PtoT", "")), enabled={"T"}, highlight={"A": "#123456", "R": "Red"}
    )
    assert ids(root, "enabled") == ["T"]
    strokes = {e.get("stroke") for g in groups(root, "place") for e in g.iter()}
    assert "#123456" in strokes
    assert "#ff0000" in {e.get("stroke") for g in groups(root, "arc") for e in g.iter()}


# --- hostile texts -------------------------------------------------------------------------------

HOSTILE = """
net Hostile
  standard
  var s : STRING;
  page "Top <script>alert(1)</script>"
    place "</title><script>alert(2)</script>" fusion "'><b>" : STRING = "]]>&amp;</style>"
    trans "T' onload='x" guard [s <> "</svg><img src=x onerror=alert(3)>"]
      in "</title><script>alert(2)</script>" : s
    subst Deep = "../../etc:*?" ()
  page "../../etc:*?"
    place Q : INT
"""


class _Tags(html.parser.HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))


def test_hostile_texts_stay_texts() -> None:
    found = document(HOSTILE)
    for page in found.pages:
        root = parse(draw_page(found, page))
        assert {etree.QName(e).localname for e in root.iter()} <= {
            "svg", "title", "rect", "g", "ellipse", "text", "tspan", "path", "polygon", "circle", "a",
        }  # fmt: skip
    parser = _Tags()
    parser.feed(draw_net(found, Facts("</title><script>alert(4)</script>", "<b>")))
    names = [tag for tag, _ in parser.tags]
    assert names.count("script") == 1 and names.count("title") >= 1
    assert "img" not in names and "b" not in names
    for _, attributes in parser.tags:
        assert not any(name.startswith("on") for name in attributes)


def test_control_characters_do_not_spoil_the_xml() -> None:
    root = drawn(layout(), marking={"A": Tokens(1, '1`"\x00\x07\x1b\ud800\u202eabc"')})
    (tokens,) = groups(root, "tokens")
    shown = next(tokens.iter(f"{SVG}tspan")).text or ""
    assert shown == '1`"\ufffd\ufffd\ufffd\ufffd\ufffdabc"'


def test_colours_of_the_file_are_colours_only() -> None:
    assert colour('red" onclick="x') == "#000000"
    assert colour("Fucia") == "#ff00ff" and colour("#A0b1C2") == "#a0b1c2"
    assert dash("solid") == "" and dash("dotted") and dash('"><script>') == ""


@pytest.mark.parametrize(
    ("name", "stem"),
    [
        ("Sender", "Sender"),
        ("../../etc/passwd", "_.._etc_passwd"),
        ("a b/c:d*?", "a_b_c_d__"),
        ("", "page"),
        ("...", "page"),
        ("CON", "_CON"),
        ("-rf", "_-rf"),
        ("Übergang", "Übergang"),
        ("x" * 500, "x" * 100),
    ],
)
def test_names_of_pages_become_names_of_files(name: str, stem: str) -> None:
    assert file_stem(name) == stem


def test_names_of_files_differ_without_capitals() -> None:
    assert file_stems(["Page", "page", "Page/", "PAGE"]) == ["Page", "page_2", "Page_", "PAGE_3"]


# --- automatic layout ----------------------------------------------------------------------------


def test_nodes_in_one_point_are_arranged() -> None:
    moved = re.sub(rb'<posattr x="[^"]*" y="[^"]*"', b'<posattr x="0" y="0"', netbuilder.cpn(SMALL))
    found = read_data(moved, "test.cpn", Diagnostics())
    assert found is not None
    scene = build(found, found.pages[0])
    assert scene.arranged
    nodes = [s for s in scene.shapes if s.kind != "aux"]
    for i, a in enumerate(nodes):
        for b in nodes[i + 1 :]:
            assert not a.box.overlaps(b.box)
    check_page(found, found.pages[0])


def test_texts_of_an_arranged_page_lie_on_nothing() -> None:
    net = """
    net Codes
      standard
      var n, m, r : INT;
      page Top
        place A : INT = 1`1
        place B : INT
        place C : INT
        place D : INT
        trans Work guard [n > 0, n < 99] code input (n); output (m, r); action (n + discrete (1, 10), n * 200 + 1)
          in A : n
          out B : m
          out D : r
        trans Other code input (n); action ignore (INT.mkstr n)
          in B : n
          out C : if n > 3 then 1`n else empty
          out A : n
        trans Third
          in C : n
          in D : m
          out A : n + m
    """
    moved = re.sub(rb'<posattr x="[^"]*" y="[^"]*"', b'<posattr x="0" y="0"', netbuilder.cpn(net))
    found = read_data(moved, "test.cpn", Diagnostics())
    assert found is not None
    scene = build(found, found.pages[0])
    boxes = [label.box for label in scene.labels] + [shape.box for shape in scene.shapes]
    assert len(scene.labels) == 17
    assert not [(a, b) for a, b in itertools.combinations(boxes, 2) if a.overlaps(b)]
    for code in (label.box for label in scene.labels if label.kind in ("code", "guard")):
        points = [geometry.along(line.points, k / 50) for line in scene.lines for k in range(51)]
        assert not any(code.holds(p) for p in points)


def test_the_layout_is_in_layers() -> None:
    size = (60.0, 40.0)
    nodes = dict.fromkeys("abcd", size)
    found = arrange(nodes, {"1": ("a", "b"), "2": ("b", "c"), "3": ("a", "c"), "4": ("c", "a")})
    y = {n: found.centres[n][1] for n in nodes}
    assert y["a"] < y["b"] < y["c"]
    assert len(found.bends["3"]) == 1 and len(found.bends["4"]) == 1  # past the layer of b
    assert "1" not in found.bends


def test_layouts_of_large_and_odd_graphs() -> None:
    size = (60.0, 40.0)
    nodes = {str(i): size for i in range(1400)}
    edges = {str(i): (str(i), str((i * 7 + 1) % 1400)) for i in range(1400)}
    found = arrange(nodes, {**edges, "loop": ("3", "3")})
    assert set(found.centres) == set(nodes)
    assert len(set(found.centres.values())) == len(nodes)
    assert arrange({}, {}).centres == {}
    long = {str(i): (str(i), str(i + 1)) for i in range(1399)}
    assert len(set(arrange(nodes, long).centres.values())) == 1400


# --- several pages -------------------------------------------------------------------------------


def test_pages_below_each_other_with_links() -> None:
    found = document(SMALL)
    root = parse(draw_pages(found, [(p, Overlay()) for p in found.pages]))
    assert [g.get("id") for g in groups(root, "page")] == ["page-1", "page-2"]
    links = [a.get("href") for a in root.iter(f"{SVG}a")]
    assert links == ["#page-2", "#page-2"]  # the substitution transition and its tag


def test_a_page_alone_has_no_dead_links() -> None:
    found = document(SMALL)
    assert not list(parse(draw_page(found, found.pages[0])).iter(f"{SVG}a"))
    links = Links(lambda identity: "Sub.svg")
    root = parse(draw_page(found, found.pages[0], links=links))
    assert {a.get("href") for a in root.iter(f"{SVG}a")} == {"Sub.svg"}


def test_html_links_lead_somewhere_and_nothing_is_fetched() -> None:
    found = document(SMALL)
    written = draw_net(found, Facts("small.cpn"))
    parser = _Tags()
    parser.feed(written)
    anchors = [a["id"] for _, a in parser.tags if "id" in a]
    assert len(anchors) == len(set(anchors))
    targets = [str(a["href"]) for tag, a in parser.tags if tag == "a"]
    assert targets and all(t.startswith("#") and t[1:] in anchors for t in targets)
    assert not [tag for tag, a in parser.tags if "src" in a or tag in ("link", "iframe", "img")]
    assert "http" not in re.sub(r'xmlns="[^"]*"', "", written)
    assert written == draw_net(found, Facts("small.cpn"))
    assert "unicode-bidi: isolate" in written  # of names, whose marks turn nothing beside them


def test_html_has_paths_a_tree_and_fusion_sets() -> None:
    written = draw_net(document(SMALL), Facts("small.cpn"))
    assert '<p class="path"><a href="#page-1">Top</a> › Sub</p>' in written
    assert written.index('href="#page-1">Top') < written.index('href="#page-2">Sub')
    assert '<dt id="fusion-1">Common</dt>' in written


def test_html_has_the_declarations_with_their_errors() -> None:
    found = document(SMALL)
    written = draw_net(found, Facts("small.cpn", problems={"": [Problem("<odd>")]}))
    assert "<pre>colset PAIR = product INT * STRING;</pre>" in written
    assert "<pre>var n : INT;</pre>" in written
    assert '<p class="errors">&lt;odd&gt;</p>' in written


def test_headings_leave_out_no_level() -> None:
    blocks = b"<block><id>Outer</id><block><block><id>Inner</id></block></block></block></globbox>"
    found = read_data(
        netbuilder.cpn(SMALL).replace(b"</globbox>", blocks), "test.cpn", Diagnostics()
    )
    assert found is not None
    written = draw_net(found, Facts("small.cpn"))
    levels = [int(n) for n in re.findall(r"<h([1-6])>", written)]
    assert levels[0] == 1 and max(levels) == 4
    assert all(b <= a + 1 for a, b in zip(levels, levels[1:], strict=False))


def test_many_uses_of_pages_end() -> None:
    """A hierarchy with millions of ways down is listed in part."""
    rows = ["net Many", "  standard"]
    for i in range(24):
        rows += [f"  page P{i}", "    place A : INT"]
        rows += [f"    subst S{k} = P{i + 1} ()" for k in range(2) if i < 23]
        rows += [f"    subst T{k} = P{i + 2} ()" for k in range(2) if i < 22]
    written = draw_net(document("\n".join(rows)), Facts("many.cpn"))
    assert written.count("<section id=") == 25
    assert len(written) < 2_000_000


def test_pages_that_contain_themselves_are_drawn() -> None:
    net = netbuilder.cpn(SMALL).replace(b"</trans>\n</page>", b"</trans></page>")
    found = read_data(net, "test.cpn", Diagnostics())
    assert found is not None
    top, sub = found.pages
    again = re.sub(
        f'subpage="{sub.id}"'.encode(), f'subpage="{top.id}"'.encode(), netbuilder.cpn(SMALL)
    )
    looped = read_data(again, "test.cpn", Diagnostics())
    assert looped is not None
    written = draw_net(looped, Facts("loop.cpn"))
    assert written.count("<section id=") == 4


# --- texts ---------------------------------------------------------------------------------------


def test_widths_are_those_of_arial() -> None:
    assert text.width("") == 0
    assert text.width("Hierarchical Protocol") == pytest.approx(9.23 * 13, abs=1)
    assert text.width("W") > text.width("i") and text.width("漢") == 13
    assert text.width("abc", bold=True) > text.width("abc")


def test_lines_of_texts() -> None:
    assert text.lines("a\r\nb\rc\td  ") == ("a", "b", "c   d")
    assert text.shorten("abcdef\n2\n3\n4", 3, 4) == "abc…\n2\n… 2 more"
    assert text.attribute('a"\n<') == "a&quot;&#10;&lt;"


def test_where_lines_meet_shapes() -> None:
    box = geometry.around(0, 0, 60, 40)
    assert geometry.enter((100, 0), (0, 0), box, False) == (30, 0)
    assert geometry.enter((100, 0), (0, 0), box, True) == pytest.approx((30, 0))
    assert geometry.enter((0, 90), (0, 10), box, True) == pytest.approx((0, 20))
    assert geometry.enter((5, 5), (0, 0), box, False) == (0, 0)  # begins inside
    assert geometry.enter((100, 90), (100, 80), box, False) == (100, 80)  # passes by
    assert geometry.along(((0, 0), (10, 0), (10, 30)), 0.5) == (10, 10)
