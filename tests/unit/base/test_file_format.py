"""The `.cpn` format as files of many years have it: each statement of it on a net of its own."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import ArcKind, FlatNet
from pn2code.net.front import examine
from pn2code.reading.document import Document

NET = """
net Net
  standard
  colset LIST = list INT;
  var n, m: INT;
  val limit = 3
  place A : INT = 1`1 ++ 1`2
  place B : INT
  trans T guard [n < limit]
    in A : n
    out B : n
"""


@dataclass
class Loaded:
    """What came of a file."""

    document: Document | None
    flat: FlatNet | None
    d: Diagnostics


def load(data: bytes, tmp_path: Path) -> Loaded:
    path = tmp_path / "net.cpn"
    path.write_bytes(data)
    d = Diagnostics()
    found = examine(path, d)
    return Loaded(found.document, found.flat, d)


def accepted(data: bytes, tmp_path: Path) -> FlatNet:
    found = load(data, tmp_path)
    assert found.flat is not None, [f"{x.code}: {x.message}" for x in found.d]
    return found.flat


def changed(*pairs: tuple[str, str], net: str = NET) -> bytes:
    text = cpn(net).decode("iso-8859-1")
    for old, new in pairs:
        assert old in text, old
        text = text.replace(old, new)
    return text.encode("iso-8859-1")


def minimal(box: str, page: str, rest: str = "") -> bytes:
    """A file with nothing but what matters, as programs write it."""
    return (
        "<?xml version='1.0' encoding='iso-8859-1'?><workspaceElements>"
        f"<generator tool='x' version='1' format='6'/><cpnet><globbox>{box}</globbox>"
        f"<page id='p1'><pageattr name='Top'/>{page}</page>{rest}</cpnet></workspaceElements>"
    ).encode("iso-8859-1")


INT = "<color id='c1'><id>INT</id><int/></color><var id='v1'><type><id>INT</id></type><id>n</id></var>"
UNIT = "<color id='c0'><id>UNIT</id><unit/></color>"


def place(identity: str, colset: str, initial: str = "", more: str = "") -> str:
    return (
        f"<place id='{identity}'><text>{identity}</text>{more}<type id='{identity}t'><text>{colset}</text></type>"
        f"<initmark id='{identity}i'><text>{initial}</text></initmark></place>"
    )


def trans(identity: str, more: str = "") -> str:
    return f"<trans id='{identity}' explicit='false'><text>{identity}</text>{more}</trans>"


def arc(identity: str, orientation: str, t: str, p: str, text: str) -> str:
    return (
        f"<arc id='{identity}' orientation='{orientation}' order='1'><transend idref='{t}'/>"
        f"<placeend idref='{p}'/><annot id='{identity}a'><text>{text}</text></annot></arc>"
    )


# --- generator, document type, encoding -------------------------------------------------------


@pytest.mark.parametrize("number", ["2", "3", "4", "5", "6"])
@pytest.mark.parametrize("version", ["1.2.0", "2.3.5", "4.0.1", "-1", "Version 1.1.0 - March 2004"])
def test_versions(number: str, version: str, tmp_path: Path) -> None:
    data = changed(
        ('format="6"', f'format="{number}"'), ('version="4.0.1" f', f'version="{version}" f')
    )
    found = load(data, tmp_path)
    assert found.flat is not None and not list(found.d)
    assert found.document is not None
    assert (found.document.format, found.document.version) == (number, version)


def test_file_without_generator(tmp_path: Path) -> None:
    accepted(changed(('<generator tool="CPN Tools" version="4.0.1" format="6"/>', "")), tmp_path)


@pytest.mark.parametrize(
    "doctype",
    [
        "",
        '<!DOCTYPE workspaceElements PUBLIC "-//CPN//DTD CPNXML 1.0//EN" '
        '"http://www.daimi.au.dk/~cpntools/bin/DTD/2/cpn.dtd">',
        '<!DOCTYPE workspaceElements SYSTEM "cpn.dtd">',
        "<!DOCTYPE workspaceElements>",
    ],
)
def test_document_types(doctype: str, tmp_path: Path) -> None:
    text = cpn(NET).decode("iso-8859-1")
    accepted(re.sub("<!DOCTYPE[^>]*>", doctype, text).encode("iso-8859-1"), tmp_path)


@pytest.mark.parametrize("encoding", ["iso-8859-1", "us-ascii", "utf-8", "utf-16", "windows-1252"])
def test_encodings(encoding: str, tmp_path: Path) -> None:
    text = cpn(NET).decode("iso-8859-1").replace("iso-8859-1", encoding, 1)
    accepted(text.encode(encoding), tmp_path)


def test_umlauts_in_names_and_strings(tmp_path: Path) -> None:
    net = 'net N\n  standard\n  place "Größe" : STRING = 1`"Maß"\n'
    flat = accepted(cpn(net), tmp_path)
    assert flat.places[0].short == "Größe"
    utf8 = cpn(net).decode("iso-8859-1").replace("iso-8859-1", "utf-8", 1).encode("utf-8")
    assert accepted(utf8, tmp_path).places[0].short == "Größe"


def test_no_xml_declaration_is_utf_8(tmp_path: Path) -> None:
    text = cpn(NET).decode("iso-8859-1").partition("?>")[2].lstrip()
    accepted(text.replace(">A<", ">Ä<").encode("utf-8"), tmp_path)


def test_byte_order_mark(tmp_path: Path) -> None:
    text = cpn(NET).decode("iso-8859-1").replace("iso-8859-1", "utf-8", 1)
    accepted(b"\xef\xbb\xbf" + text.encode("utf-8"), tmp_path)


def test_windows_line_ends(tmp_path: Path) -> None:
    accepted(cpn(NET).replace(b"\n", b"\r\n"), tmp_path)


def test_character_references(tmp_path: Path) -> None:
    flat = accepted(changed((">1`1 ++ 1`2<", ">&#49;&#x60;1 &#43;+ 1`2<")), tmp_path)
    assert flat.places[0].initial is not None


def test_character_data_sections(tmp_path: Path) -> None:
    accepted(changed((">[n &lt; limit]<", "><![CDATA[[n < limit]]]><")), tmp_path)


def test_comments_and_instructions_inside_texts(tmp_path: Path) -> None:
    accepted(changed((">1`1 ++ 1`2<", ">1`1 <!-- a -->++<?b c?> 1`2<")), tmp_path)


def test_root_may_be_the_net_itself(tmp_path: Path) -> None:
    text = cpn(NET).decode("iso-8859-1")
    inner = text[text.index("<cpnet>") : text.index("</workspaceElements>")]
    accepted(inner.encode("iso-8859-1"), tmp_path)


# --- small and strange files ---------------------------------------------------------------------


def test_net_without_anything(tmp_path: Path) -> None:
    flat = accepted(minimal("", ""), tmp_path)
    assert (flat.places, flat.transitions) == ((), ())


def test_net_without_pages_and_declarations(tmp_path: Path) -> None:
    found = load(b"<workspaceElements><cpnet/></workspaceElements>", tmp_path)
    assert found.flat is not None and found.flat.places == ()
    assert [(x.severity.value, x.message) for x in found.d] == [("warning", "the net has no page")]


def test_no_layout_at_all(tmp_path: Path) -> None:
    """As Access/CPN and other programs write it: no positions, no `instances`, no `options`."""
    page = place("P", "INT", "1`1") + trans("T") + arc("a1", "PtoT", "T", "P", "n")
    flat = accepted(minimal(INT, page), tmp_path)
    assert [a.kind for a in flat.transitions[0].arcs] == [ArcKind.INPUT]


def test_places_transitions_and_arcs_in_any_order(tmp_path: Path) -> None:
    page = arc("a1", "PtoT", "T", "P", "n") + trans("T") + place("P", "INT", "1`1")
    assert len(accepted(minimal(INT, page), tmp_path).transitions[0].arcs) == 1


def test_elements_without_names(tmp_path: Path) -> None:
    page = "<place id='P'><type><text>INT</text></type></place><trans id='T'/>"
    flat = accepted(minimal(INT, page), tmp_path)
    assert (flat.places[0].short, flat.transitions[0].short) == ("P", "T")


def test_pretty_printed_texts(tmp_path: Path) -> None:
    """CPN IDE indents texts; white space around them means nothing."""
    spaced = place("P", "\n      INT\n    ", "\n      1`1 ++\n      1`2\n    ")
    flat = accepted(minimal(INT, spaced), tmp_path)
    assert flat.places[0].colset.name == "INT"


def test_nothing_but_white_space_is_no_inscription(tmp_path: Path) -> None:
    page = place("P", "INT", " \n ") + trans(
        "T", "<cond id='g'><text> \n</text></cond><time id='d'><text>\t</text></time>"
    )
    flat = accepted(minimal(INT, page), tmp_path)
    assert flat.places[0].initial is None
    assert (flat.transitions[0].guards, flat.transitions[0].delay) == ((), None)


def test_default_texts_of_the_editor_are_no_inscriptions(tmp_path: Path) -> None:
    more = (
        "<cond id='g'><text>[]</text></cond><time id='d'><text>@+</text></time>"
        "<code id='k'><text>input ();\noutput ();\naction\n();</text></code>"
        "<priority id='q'><text></text></priority>"
    )
    t = accepted(minimal(INT, trans("T", more)), tmp_path).transitions[0]
    assert (t.guards, t.delay, t.priority) == ((), None, 1000)


def test_names_on_several_lines(tmp_path: Path) -> None:
    page = trans("T").replace("<text>T</text>", "<text>Send\n Packet</text>")
    assert accepted(minimal(INT, page), tmp_path).transitions[0].short == "Send Packet"


def test_names_with_everything(tmp_path: Path) -> None:
    for name in (
        "int",
        "a/b",
        "*/ /*",
        "a.b",
        "'",
        "&lt;x&gt;",
        "1st",
        "λ".encode().decode("latin-1"),
    ):
        page = place("P", "INT").replace("<text>P</text>", f"<text>{name}</text>")
        accepted(minimal(INT, page), tmp_path)


# --- arcs -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("written", "kind"),
    [
        ("PtoT", ArcKind.INPUT), ("ptot", ArcKind.INPUT), ("PTOT", ArcKind.INPUT), ("TtoP", ArcKind.OUTPUT),
        ("ttop", ArcKind.OUTPUT), ("BOTHDIR", ArcKind.BOTH), ("bothdir", ArcKind.BOTH),
    ],
)  # fmt: skip
def test_orientations(written: str, kind: ArcKind, tmp_path: Path) -> None:
    page = place("P", "INT", "1`1") + place("Q", "INT") + trans("T")
    page += arc("a0", "PtoT", "T", "Q", "n") + arc("a1", written, "T", "P", "n")
    assert accepted(minimal(INT, page), tmp_path).transitions[0].arcs[1].kind is kind


@pytest.mark.parametrize(
    ("written", "kind"), [("Inhibitor", ArcKind.INHIBITOR), ("reset", ArcKind.RESET)]
)
def test_inhibitor_and_reset(written: str, kind: ArcKind, tmp_path: Path) -> None:
    page = place("P", "INT", "1`1") + trans("T") + arc("a1", written, "T", "P", "")
    found = accepted(minimal(INT, page), tmp_path).transitions[0].arcs[0]
    assert (found.kind, found.inscription) == (kind, None)


def test_arcs_without_direction_move_nothing(tmp_path: Path) -> None:
    page = place("P", "INT", "1`1") + trans("T") + arc("a1", "NODIR", "T", "P", "")
    assert accepted(minimal(INT, page), tmp_path).transitions[0].arcs == ()


def test_auxiliaries_and_their_connections_are_no_part_of_the_net(tmp_path: Path) -> None:
    page = (
        "<Aux id='x1'><text>a note</text></Aux><Aux id='x2'/><aux-conn id='x3' orientation='1to2'/>"
    )
    found = load(minimal("", page), tmp_path)
    assert found.flat is not None and not list(found.d)


# --- colour set UNIT and texts that the editor completes ---------------------------------------------


def test_place_without_colour_set_is_unit(tmp_path: Path) -> None:
    page = place("P", "", "3") + trans("T") + arc("a1", "PtoT", "T", "P", "")
    page += arc("a2", "TtoP", "T", "P", " 2 ")
    flat = accepted(minimal(UNIT, page), tmp_path)
    assert flat.places[0].colset.name == "UNIT"


def test_numbers_are_completed_at_unit_places_only(tmp_path: Path) -> None:
    box = UNIT + "<color id='c2'><id>DOT</id><unit/></color>"
    found = load(minimal(box, place("P", "DOT", "3")), tmp_path)
    assert [x.code for x in found.d.errors] == ["type-mismatch"]
    page = place("P", "DOT", "1`()") + trans("T") + arc("a1", "PtoT", "T", "P", "")
    assert [x.code for x in load(minimal(box, page), tmp_path).d.errors] == ["arc-empty"]


# --- pages, ports, fusion -------------------------------------------------------------------------------


def subpage(port: str, extra: str = "") -> str:
    inside = place("I", "INT", "", f"<port id='Ip' type='{port}'/>") + trans("U")
    return f"<page id='p2'><pageattr name='Sub'/>{inside}{arc('a9', 'PtoT', 'U', 'I', 'n')}{extra}</page>"


def uses(portsock: str, identity: str = "S") -> str:
    return f"<trans id='{identity}'><text>{identity}</text><subst subpage='p2' portsock='{portsock}'/></trans>"


@pytest.mark.parametrize("port", ["In", "in", "I/O", "i/o", "inout", "in/out", "INOUT"])
def test_port_types_of_all_ages(port: str, tmp_path: Path) -> None:
    page = place("A", "INT", "1`1") + uses("(I,A)")
    found = load(minimal(INT, page, subpage(port)), tmp_path)
    assert found.flat is not None
    assert {x.code for x in found.d} <= {"socket-arcs"}  # there are no arcs beside the substitution
    assert len(found.flat.places) == 1


def test_port_assignments_with_blanks_between(tmp_path: Path) -> None:
    page = place("A", "INT", "1`1") + uses(" ( I , A ) ")
    assert len(accepted(minimal(INT, page, subpage("In")), tmp_path).places) == 1


def test_page_used_often_has_instances_with_their_own_places(tmp_path: Path) -> None:
    page = place("A", "INT", "1`1") + place("B", "INT", "1`2") + uses("(I,A)") + uses("(I,B)", "S2")
    flat = accepted(minimal(INT, page, subpage("In", place("Own", "INT"))), tmp_path)
    assert [(p.short, p.instance_number) for p in flat.places] == [
        ("A", 1), ("B", 1), ("Own", 1), ("Own", 2),
    ]  # fmt: skip
    assert [t.instance_number for t in flat.transitions] == [1, 2]


def test_ports_may_be_sockets_again(tmp_path: Path) -> None:
    top = place("A", "INT", "1`1") + uses("(I,A)")
    deep = "<page id='p3'><pageattr name='Deep'/>" + place(
        "J", "INT", "", "<port id='Jp' type='In'/>"
    )
    deep += trans("V") + arc("a8", "PtoT", "V", "J", "n") + "</page>"
    middle = "<trans id='S3'><text>S3</text><subst subpage='p3' portsock='(J,I)'/></trans>"
    flat = accepted(minimal(INT, top, subpage("In", middle) + deep), tmp_path)
    assert len(flat.places) == 1
    assert len(flat.places[0].origins) == 3


def test_prime_pages_are_those_that_nobody_uses(tmp_path: Path) -> None:
    other = "<page id='p7'><pageattr name='Other'/>" + place("Z", "INT", "1`1") + "</page>"
    page = place("A", "INT", "1`1") + uses("(I,A)")
    flat = accepted(minimal(INT, page, subpage("In") + other), tmp_path)
    assert [p.instance for p in flat.places] == ["Top", "Other"]


def test_fusion_sets_join_places_of_all_pages(tmp_path: Path) -> None:
    member = "<fusioninfo id='{0}f' name='F'/>"
    other = "<page id='p7'><pageattr name='Other'/>"
    other += place("Z", "INT", "1`1", member.format("Z")) + "</page>"
    fusion = "<fusion id='f1' name='F'><fusion_elm idref='A'/><fusion_elm idref='Z'/></fusion>"
    flat = accepted(
        minimal(INT, place("A", "INT", "1`1", member.format("A")), other + fusion), tmp_path
    )
    assert [p.name for p in flat.places] == ["Fusion.F"]


def test_fused_ports(tmp_path: Path) -> None:
    """A port in a fusion set: its socket, the port and the other members are one place."""
    member = "<fusioninfo id='{0}f' name='F'/>"
    page = place("A", "INT", "1`1", member.format("A")) + place("B", "INT", "1`1") + uses("(I,B)")
    sub = subpage("In").replace("<port id='Ip'", member.format("I") + "<port id='Ip'")
    fusion = "<fusion id='f1' name='F'><fusion_elm idref='A'/><fusion_elm idref='I'/></fusion>"
    assert len(accepted(minimal(INT, page, sub + fusion), tmp_path).places) == 1


def test_instances_of_the_file_are_not_needed_and_may_be_wrong(tmp_path: Path) -> None:
    page = place("A", "INT", "1`1") + uses("(I,A)")
    rest = subpage("In") + "<instances><instance id='x' page='nowhere'/></instances>"
    assert len(accepted(minimal(INT, page, rest), tmp_path).transitions) == 1


# --- declarations --------------------------------------------------------------------------------------------


def test_blocks_nest_and_count_in_order(tmp_path: Path) -> None:
    box = (
        f"<block id='b1'><id>Outer</id>{INT}<block id='b2'><id>Inner</id>"
        "<ml id='m1'>val a = 1</ml></block><ml id='m2'>val b = a + 1</ml></block>"
    )
    accepted(minimal(box, place("P", "INT", "b")), tmp_path)
    wrong = box.replace("val a = 1", "val a = b")
    assert [x.origin.element_id for x in load(minimal(wrong, ""), tmp_path).d.errors] == ["m1"]


def test_code_of_a_declaration_is_its_own_text_not_what_is_shown(tmp_path: Path) -> None:
    box = INT + "<ml id='m1'>val a = 1<layout>val a = true</layout></ml>"
    accepted(minimal(box, place("P", "INT", "a")), tmp_path)


def test_code_of_a_declaration_after_what_is_shown(tmp_path: Path) -> None:
    box = INT + "<ml id='m1'><layout>shown</layout>val a = 1</ml>"
    accepted(minimal(box, place("P", "INT", "a")), tmp_path)


def test_reference_declarations(tmp_path: Path) -> None:
    box = (
        INT
        + "<globref id='r1'><id>count</id><ml>0<layout>x</layout></ml><layout>y</layout></globref>"
    )
    accepted(minimal(box, place("P", "INT", "!count")), tmp_path)


def test_colour_sets_of_every_kind(tmp_path: Path) -> None:
    box = (
        "<color id='1'><id>U</id><unit/></color><color id='2'><id>UW</id><unit><with><id>e</id></with></unit></color>"
        "<color id='3'><id>B</id><bool/></color>"
        "<color id='4'><id>BW</id><bool><with><id>no</id><id>yes</id></with></bool></color>"
        "<color id='5'><id>I</id><int/></color>"
        "<color id='6'><id>IW</id><timed/><int><with><ml>1</ml><ml>limit</ml></with></int></color>"
        "<color id='7'><id>II</id><intinf/></color><color id='8'><id>R</id><real/></color>"
        "<color id='9'><id>RW</id><real><with><ml>0.0</ml><ml>1.0</ml></with></real></color>"
        "<color id='10'><id>S</id><string/></color>"
        "<color id='11'><id>SW</id><string><with><ml>&quot;a&quot;</ml><ml>&quot;z&quot;</ml>"
        "<and><ml>1</ml><ml>3</ml></and></with></string></color>"
        "<color id='12'><id>E</id><enum><id>red</id><id>green</id></enum></color>"
        "<color id='13'><id>X</id><index><ml>1</ml><ml>3</ml><id>x</id></index></color>"
        "<color id='14'><id>P</id><product><id>I</id><id>S</id></product></color>"
        "<color id='15'><id>Q</id><record><recordfield><id>a</id><id>I</id></recordfield>"
        "<recordfield><id>b</id><id>E</id></recordfield></record></color>"
        "<color id='16'><id>L</id><list><id>I</id></list></color>"
        "<color id='17'><id>LW</id><list><with><ml>0</ml><ml>2</ml></with><id>E</id></list></color>"
        "<color id='18'><id>N</id><union><unionfield><id>A</id><type><id>I</id></type></unionfield>"
        "<unionfield><id>Z</id></unionfield></union></color>"
        "<color id='19'><id>AL</id><alias><id>P</id></alias><declare><id>all</id></declare></color>"
        "<color id='20'><id>SB</id><subset><id>I</id><by><ml>small</ml></by></subset></color>"
        "<color id='21'><id>SL</id><subset><id>I</id><with><ml>[1,2]</ml></with></subset></color>"
        "<color id='22'><id>T</id><time/></color>"
    )
    limit = "<ml id='l'>val limit = 5; fun small (n : int) = n &lt; 3</ml>"
    page = "".join(
        place(f"p_{name}", name) for name in re.findall(r"<color id='\d+'><id>(\w+)</id>", box)
    )
    found = load(minimal(limit + box, page), tmp_path)
    assert found.flat is not None, [x.message for x in found.d]
    assert {"IW", "LW", "SL", "N", "X"} <= {p.colset.name for p in found.flat.places}


@pytest.mark.parametrize(
    ("written", "real"),
    [
        ("<boolean>true</boolean>", True),
        ("<boolean>false</boolean>", False),
        ("<text>true</text>", True),
        ("", False),
    ],
)
def test_clock(written: str, real: bool, tmp_path: Path) -> None:
    option = f"<option name='realtimestamp'><value>{written}</value></option>" if written else ""
    assert accepted(minimal(INT, "", f"<options>{option}</options>"), tmp_path).real_time is real


def test_numbers_of_the_layout_are_read_leniently(tmp_path: Path) -> None:
    data = changed(('x="0.000000" y="-100.000000"', 'x="-76,000000" y="1e99999"'))
    found = load(data, tmp_path)
    assert found.flat is not None and not list(found.d)


# --- lines and columns -------------------------------------------------------------------------------------------


PLACES = {
    "initial": (">1`1 ++ 1`2<", ">1`1 ++ {}<"),
    "arc": ('"4.0.1">n<', '"4.0.1">{}<'),
    "guard": (">[n &lt; limit]<", ">[n &lt; {}]<"),
    "declaration": (">val limit = 3<", ">val limit = {}<"),
}
AROUND = {
    "plain": "wrong",
    "after an entity": "(2 &gt; 1; wrong)",
    "after a character reference": "(&#50;; wrong)",
    "on a further line": "(2;\n   3;\n\twrong)",
    "after a comment": "<!-- two\nlines --> wrong",
    "in a section": "<![CDATA[ (2 < 3; wrong) ]]>",
    "after an umlaut in a string": '("ü"; wrong)',
}


@pytest.mark.parametrize("where", PLACES)
@pytest.mark.parametrize("around", AROUND)
@pytest.mark.parametrize("ends", ["\n", "\r\n"])
@pytest.mark.parametrize("encoding", ["iso-8859-1", "utf-8"])
def test_line_and_column_of_an_error(
    where: str, around: str, ends: str, encoding: str, tmp_path: Path
) -> None:
    old, new = PLACES[where]
    text = cpn(NET).decode("iso-8859-1").replace("iso-8859-1", encoding, 1)
    assert old in text
    text = text.replace(old, new.format(AROUND[around]), 1)
    found = load(text.replace("\n", ends).encode(encoding), tmp_path)
    lines = text.split("\n")
    line = next(i for i, x in enumerate(lines) if "wrong" in x)
    error = next(x for x in found.d.errors if "`wrong` is not declared" in x.message)
    assert (error.origin.line, error.origin.column) == (line + 1, lines[line].index("wrong") + 1)


def test_thousands_of_errors_come_to_an_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pn2code.diagnostics.diagnostic.MAX_ITEMS", 20)
    for page in (place("P", "INT") * 100, "".join(place(f"P{i}", "NONE") for i in range(100))):
        found = load(minimal(INT, page), tmp_path)
        assert found.flat is None
        assert len(found.d) == 21
        assert found.d.items[-1].code == "too-many-messages"
        assert found.d.items[-1].message == "more than 20 messages: the rest is not examined"
