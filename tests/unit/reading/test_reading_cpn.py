"""Reading `.cpn` files: what each element becomes, and diagnostics for damaged nets."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics
from pn2code.ml.parsing.lexer import KEYWORDS
from pn2code.reading.cpn import read, read_data
from pn2code.reading.declarations import RESERVED
from pn2code.reading.document import Document, RawGlobref, RawMl, RawOther, RawUse

NET = """
    net Cell
      colset INT = int;
      var n: INT;
      place Buffer id=ID90 : INT = 1`1
      place Done : INT
      trans Pick id=ID80 guard [n < 3]
        in Buffer : n
        out Done : n
"""


def parse(data: bytes | str) -> tuple[Document | None, Diagnostics]:
    d = Diagnostics()
    raw = data.encode("iso-8859-1") if isinstance(data, str) else data
    return read_data(raw, "cell.cpn", d), d


def good(data: bytes | str) -> Document:
    document, d = parse(data)
    assert not list(d), list(d)
    assert document is not None
    return document


def change(old: str, new: str) -> str:
    text = cpn(NET).decode("iso-8859-1")
    assert old in text
    return text.replace(old, new)


def wrap(inside: str, box: str = "") -> str:
    return (
        '<workspaceElements><generator tool="CPN Tools" version="4.0.1" format="6"/><cpnet>'
        f"<globbox>{box}</globbox><page id='P1'><pageattr name='Top'/>{inside}</page>"
        "</cpnet></workspaceElements>"
    )


def test_file_facts(tmp_path: Path) -> None:
    path = tmp_path / "cell.cpn"
    path.write_bytes(cpn(NET))
    d = Diagnostics()
    document = read(path, d)
    assert document is not None
    assert document.file == str(path)
    assert len(document.sha256) == 64
    assert (document.tool, document.version, document.format) == ("CPN Tools", "4.0.1", "6")


def test_origins_name_the_element() -> None:
    document = good(cpn(NET))
    page = document.pages[0]
    origin = page.places[0].origin
    assert origin.describe() == "page `Top`, place `Buffer` (ID90)"
    arc = page.arcs[0]
    assert arc.origin.element == "arc `Buffer` -> `Pick`"
    assert page.arcs[1].origin.element == "arc `Pick` -> `Done`"
    guard = page.transitions[0].guard
    assert guard is not None
    assert guard.text.origin.part == "guard"
    line = cpn(NET).decode().split("\n")[guard.text.origin.line - 1]
    assert line[guard.text.origin.column - 1 :].startswith("[n &lt; 3]")
    at = guard.text.origin_at(guard.text.text.index("3"))
    assert line[at.column - 1] == "3"


def test_not_a_net() -> None:
    _, d = parse("<pnml><net/></pnml>")
    assert [x.code for x in d] == ["not-cpn"]
    assert d.items[0].message == "not a CPN Tools net: the root element is `pnml`"
    _, d = parse("<workspaceElements/>")
    assert d.items[0].message == "not a CPN Tools net: `workspaceElements` has no `cpnet`"


def test_net_without_pages() -> None:
    document, d = parse("<workspaceElements><cpnet><globbox/></cpnet></workspaceElements>")
    assert document is not None
    assert [(x.severity.value, x.message) for x in d] == [("warning", "the net has no page")]


def test_dangling_arc() -> None:
    document, d = parse(change('<placeend idref="ID90"/>', '<placeend idref="ID77"/>'))
    assert document is None
    (item,) = d
    assert item.code == "arc-dangling"
    assert "`ID77`, which is not on page `Top`" in item.message
    assert item.message.startswith("arc `ID")
    assert item.origin.line > 0
    assert item.hint


def test_arc_without_end() -> None:
    _, d = parse(change('<transend idref="ID80"/>', ""))
    assert {x.code for x in d} == {"arc-dangling"}
    assert "has no transition end" in d.items[0].message


def test_arc_between_two_transitions() -> None:
    _, d = parse(change('<placeend idref="ID90"/>', '<placeend idref="ID80"/>'))
    assert "but `ID80` is a transition" in d.items[0].message


def test_arc_to_another_page() -> None:
    text = """
        net N
          page A
            place P id=ID50 : INT
            trans T
              in ID51 : n
          page B
            place Q id=ID51 : INT
    """
    _, d = parse(cpn(text))
    assert [x.code for x in d] == ["arc-dangling"]
    assert "`ID51`, which is not on page `A`" in d.items[0].message


def test_duplicate_id() -> None:
    _, d = parse(change('id="ID80"', 'id="ID90"').replace('idref="ID80"', 'idref="ID90"'))
    codes = [x.code for x in d]
    assert codes[0] == "duplicate-id"
    assert "`ID90`, which is already used" in d.items[0].message
    assert d.items[0].notes[0].origin is not None


def test_missing_id() -> None:
    _, d = parse(wrap("<place><text>P</text></place>"))
    assert [x.code for x in d] == ["cpn-element"]


@pytest.mark.parametrize(
    ("written", "kind"),
    [("PtoT", "ptot"), ("ptot", "ptot"), ("PTOT", "ptot"), ("TtoP", "ttop"), ("BOTHDIR", "bothdir"),
     ("bothdir", "bothdir"), ("Inhibitor", "inhibitor"), ("inhibitor", "inhibitor"), ("Reset", "reset")],
)  # fmt: skip
def test_orientations(written: str, kind: str) -> None:
    document = good(change('orientation="PtoT"', f'orientation="{written}"'))
    assert document.pages[0].arcs[0].orientation == kind


def test_unknown_orientation() -> None:
    _, d = parse(change('orientation="PtoT"', 'orientation="sideways"'))
    assert [x.code for x in d] == ["arc-orientation"]
    assert "`sideways`" in d.items[0].message


def test_decimal_comma_and_nonsense_in_layout() -> None:
    document = good(change('x="0.000000" y="-100.000000"', 'x="-76,500000" y="wide"'))
    place = document.pages[0].places[0]
    assert (place.layout.x, place.layout.y) == (-76.5, 0.0)
    assert (place.layout.width, place.layout.shape) == (60.0, "ellipse")


def test_pretty_printed_single_quotes() -> None:
    # as CPN IDE writes
    document = good(
        wrap("""
            <place id='p1'>
                <text>
                    My
                    Place
                </text>
                <type id='t1'><text tool='CPN Tools'>
                    INT
                </text></type>
                <initmark id='i1'>
                    <text>
                    </text>
                </initmark>
            </place>
        """, """
            <color id='c1'><id>
                INT
              </id><int>
            </int></color>
            <ml id='m1'>
              val x = 1;
              <layout>
                val x = 1;
              </layout>
            </ml>
        """)
    )  # fmt: skip
    place = document.pages[0].places[0]
    assert place.name == "My Place"
    assert place.type is not None and place.type.text.text == "INT"
    assert place.initial is None
    ml = document.globbox.items[1]
    assert isinstance(ml, RawMl)
    assert ml.text.text == "val x = 1;"


def test_name_from_id_when_there_is_none() -> None:
    document = good(wrap("<place id='p1'/><trans id='t1'><text/></trans>"))
    assert document.pages[0].places[0].name == "p1"
    assert document.pages[0].transitions[0].name == "t1"


def test_other_declarations() -> None:
    document = good(
        wrap(
            "",
            """<block id='b'><id>Mine</id><block id='b2'><id>Inner</id>
            <use id='u'><ml>"a.sml"</ml></use></block>
            <globref id='g'><id>r</id><ml>5</ml></globref>
            <globref id='h'><id>broken</id></globref>
            <errordecl>color X = </errordecl></block>""",
        )
    )
    block = document.globbox.items[0]
    assert block.name == "Mine"  # type: ignore[union-attr]
    inner, reference, broken, error = block.items  # type: ignore[union-attr]
    assert isinstance(inner.items[0], RawUse)
    assert isinstance(reference, RawGlobref)
    assert isinstance(broken, RawOther)
    assert isinstance(error, RawOther)
    assert error.text.text == "color X ="


def test_unknown_elements_are_reported_once() -> None:
    inside = "<place id='a'><sparkle/></place><place id='b'><sparkle/><sparkle/></place>"
    document, d = parse(wrap(inside, "<mystery/>"))
    assert document is not None
    assert [x.code for x in d] == ["cpn-unknown-element"] * 2
    assert [x.message for x in d] == [
        "element `mystery` inside `globbox` is not known and is ignored",
        "element `sparkle` inside `place` is not known and is ignored",
    ]


def test_unknown_format() -> None:
    document, d = parse(change('format="6"', 'format="99"'))
    assert document is not None
    assert [x.code for x in d] == ["cpn-format"]


def test_colour_set_without_definition() -> None:
    document, d = parse(wrap("", "<color id='c'><id>X</id></color>"))
    assert document is None
    assert d.items[0].message == "colour set `X` has no definition that is known"


def test_bend_points_run_from_the_transition() -> None:
    bends = "".join(
        f'<bendpoint id="b{i}" serial="{i}"><posattr x="{x}" y="-100"/></bendpoint>'
        for i, x in ((1, 150), (2, 50))
    )
    text = cpn(NET).decode()
    at = text.index("<annot ")
    document = good(text[:at] + bends + text[at:])
    assert document.pages[0].arcs[0].layout.bends == ((150.0, -100.0), (50.0, -100.0))
    swapped = bends.replace('serial="1"', 'serial="9"')
    document = good(text[:at] + swapped + text[at:])
    assert document.pages[0].arcs[0].layout.bends == ((150.0, -100.0), (50.0, -100.0))


def test_constraints_are_not_supported() -> None:
    document = good(wrap("<constraints/>"))
    assert document.pages[0].name == "Top"
    _, d = parse(wrap("<constraints><constraint/></constraints>"))
    assert [(x.code, x.severity.value) for x in d] == [("unsupported-constraint", "warning")]


def test_monitors_are_kept() -> None:
    text = change(
        '<monitorblock name="Monitors"/>',
        '<monitorblock name="M"><monitorblock name="N"><monitor id="m" name="Stop" type="1" '
        'typedescription="Breakpoint" disabled="true"><node idref="ID80" pageinstanceidref="x"/>'
        '<declaration name="Predicate"><ml id="q">fun pred x = true<layout>z</layout></ml></declaration>'
        '<option name="Logging" value="true"/></monitor></monitorblock></monitorblock>',
    )
    (monitor,) = good(text).monitors
    assert (monitor.name, monitor.type, monitor.disabled) == ("Stop", "Breakpoint", True)
    assert monitor.nodes == (("ID80", "x"),)
    assert monitor.declarations[0][1].text == "fun pred x = true"


def test_broken_port_assignment() -> None:
    text = """
        net N
          page Top
            place P : INT
            subst S = Sub (Q -> P)
          page Sub
            place Q port in : INT
    """
    data = cpn(text).decode()
    _, d = parse(data.replace('portsock="(', 'portsock="junk('))
    assert [x.code for x in d] == ["cpn-element"]
    assert "junk" in d.items[0].message


def test_arcs_of_one_id_both_count() -> None:
    """Nothing refers to arcs, and the engine of CPN Tools takes such nets."""
    text = cpn(NET).decode("iso-8859-1")
    ids = re.findall(r'<arc id="(ID\d+)"', text)
    changed = text.replace(f'"{ids[1]}"', f'"{ids[0]}"')
    document, d = parse(changed)
    assert [(x.code, x.severity.value) for x in d] == [("duplicate-id", "warning")]
    assert document is not None
    arcs = document.pages[0].arcs
    assert len(arcs) == 2 and len({a.id for a in arcs}) == 2


def test_an_arc_may_have_the_id_of_a_node() -> None:
    text = cpn(NET).decode("iso-8859-1")
    document, d = parse(re.sub(r'<arc id="ID\d+"', '<arc id="ID90"', text, count=1))
    assert [x.severity.value for x in d] == ["warning"]
    assert document is not None and len(document.pages[0].arcs) == 2


def test_an_arc_of_a_transition_that_was_removed_is_left_out() -> None:
    left_over = (
        '<arc id="X1" orientation="PtoT"><transend idref="GONE"/><placeend idref="{}"/>'
        '<annot id="X2"><text>n</text></annot></arc></page>'
    )
    for place in ("ID90", "GONE2"):
        document, d = parse(change("</page>", left_over.format(place)))
        assert [(x.code, x.severity.value) for x in d] == [("arc-dangling", "warning")]
        assert "`GONE`, which is nowhere in the file" in d.items[0].message
        assert document is not None and len(document.pages[0].arcs) == 2


@pytest.mark.parametrize(
    "definition",
    [
        "<enum><id>a-b</id><id>c</id></enum>",
        "<enum><id>1a</id></enum>",
        "<enum><id>a b</id></enum>",
        "<enum><id>open</id><id>shut</id></enum>",
        "<index><ml>1</ml><ml>3</ml><id>a.b</id></index>",
        "<bool><with><id>no-</id><id>yes</id></with></bool>",
        "<record><recordfield><id>type</id><id>INT</id></recordfield></record>",
        "<record><recordfield><id>a-b</id><id>INT</id></recordfield></record>",
        "<union><unionfield><id>a b</id><type><id>INT</id></type></unionfield></union>",
    ],
)
def test_constants_and_labels_are_names_of_cpn_ml(definition: str) -> None:
    """The engine of CPN Tools refuses them all."""
    colset = f'<color id="X1"><id>K</id>{definition}</color></globbox>'
    _, d = parse(change("</globbox>", colset))
    assert [(x.code, x.severity.value) for x in d] == [("cpn-element", "error")]
    assert "cannot be declared" in d.items[0].message


@pytest.mark.parametrize("word", ["eqtype", "include", "sharing", "sig", "where"])
def test_keywords_of_signatures_are_keywords(word: str) -> None:
    """Nothing of that name can be declared, whether it is used or not."""
    variable = f"<var id='X1'><type><id>INT</id></type><id>{word}</id></var>"
    reference = f"<globref id='X2'><id>{word}</id><ml>0</ml></globref>"
    _, d = parse(change("</globbox>", f"{variable}{reference}</globbox>"))
    assert [x.message for x in d] == [f"`{word}` cannot be declared: it is a keyword"] * 2


def test_names_may_not_be_any_keyword_of_cpn_ml() -> None:
    assert RESERVED == KEYWORDS


def test_labels_of_a_record_may_be_numbers() -> None:
    fields = "".join(f"<recordfield><id>{n}</id><id>INT</id></recordfield>" for n in (1, 2))
    colset = f'<color id="X1"><id>K</id><record>{fields}</record></color></globbox>'
    good(change("</globbox>", colset))


def test_text_directly_in_an_element_is_not_read_and_not_passed_over() -> None:
    """Programs write `<initmark>3</initmark>`: the place is empty, which somebody has to say."""
    places = (
        "<place id='a'><initmark>1`3</initmark></place><place id='b'><initmark>2</initmark></place>"
    )
    document, d = parse(wrap(places + "<trans id='t'>Go<cond>\n[n > 0]\n</cond></trans>"))
    assert document is not None
    assert all(p.initial is None for p in document.pages[0].places)
    assert [x.code for x in d] == ["cpn-stray-text"] * 3
    assert [x.message.split(" stands")[0] for x in d] == [
        "the text `1`3`", "the text `Go`", "the text `[n > 0]`",
    ]  # fmt: skip
    assert (d.items[0].hint or "").endswith("<initmark><text>1`3</text></initmark>")


@pytest.mark.parametrize(("written", "meant"), [("condition", "cond"), ("delay", "time")])
def test_an_element_of_another_name_is_told_what_it_is_called(written: str, meant: str) -> None:
    _, d = parse(wrap(f"<trans id='t'><{written}><text>[false]</text></{written}></trans>"))
    assert [x.code for x in d] == ["cpn-unknown-element"]
    assert f"write it as an element `{meant}`" in (d.items[0].hint or "")


@pytest.mark.parametrize(
    "text", ["1`2<b/> ++ 1`3", "1`2<b> ++ 1`7</b>", "<b>1`2 ++</b> 1`3", "<b/>"]
)
def test_an_element_inside_a_text(text: str) -> None:
    """It is not known what such a text is: what stands in the element would be left out."""
    place = f"<place id='a'><initmark><text>{text}</text></initmark></place>"
    _, d = parse(wrap(place))
    assert [x.code for x in d.errors] == ["cpn-element"]
    assert "initial marking" in d.errors[0].message and "`b`" in d.errors[0].message
