"""Nets as text: what is read, that a net survives being written and read, and what is said of mistakes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from helpers.net_facts import facts
from helpers.netbuilder import cpn as drawn
from helpers.pnml_nets import graph
from helpers.thorough import THOROUGH
from pn2code.convert import cpn
from pn2code.diagnostics import Diagnostics
from pn2code.drawing.positions import positions
from pn2code.net.front import load
from pn2code.net.source import read
from pn2code.reading.cpn import read_data as read_cpn
from pn2code.reading.document import Document
from pn2code.semantics.evaluation.constants import compute
from pn2code.text_form.read import read_data
from pn2code.text_form.write import emit

ROOT = Path(__file__).resolve().parents[3]

ALL = """
# All that a text can have.
option realtimestamp true
standard
colset E = unit with e;  colset YES = bool with (no, yes);  (* two of them *)
colset N = int with 1..4;
colset WORD = string with "a".."z" and 1..3 timed;
colset C = with red | green | blue;
colset I = index i with 0..2;
colset PAIR = product C * N timed;
colset POSE = record x : REAL * y : REAL;
colset LIST = list N with 0..4;
colset U = union number : N + nothing;
colset ODD = subset N by odd;
colset SOME = subset N with [1, 3];
colset M = N declare ms, size;
var n, m : N;  var c : C;
globref seen = [0, 1];
exception Never of int;
fun odd x = x mod 2 = 1
fun width (p : POSE) =
  #x p +
  #y p;
fun pick 0 = red
| pick _ = blue;
(* A note of the net,
over two lines *)
block Inner
  val last = 4;
  block More
    val first = 1;
ml infix 6 plus
fun a plus b = a + b;

page Top
  place A : N = 1`first ++
    2`last
  place "In Flight": PAIR   # not a note: this is an error
  place Held fusion Held : LIST = []
  subst Left = Sub (Inp -> A, Outp -> "In Flight")
page Sub
  place Inp port in : N
  place Outp port out : PAIR
  place Held fusion Held : LIST
  trans "Move On"
    guard [n < last,
           odd n]
    in Inp : n
  # a note, less deep than what follows
    out Outp : (pick n, n)
    both Held : [] (* (* a nested *) note *)
    delay @+2.5
    priority P_HIGH
    code
      input (n);
      action
        print ("(* no comment \\" " ^ INT.mkstr n)
"""
GOOD = ALL.replace("   # not a note: this is an error", "")


def text(source: str) -> Document:
    d = Diagnostics()
    document = read_data(source.encode(), "net.cpnt", d)
    assert document is not None, [(e.message, e.origin.line) for e in d.errors]
    return document


def errors(source: str | bytes) -> list[tuple[int, str, str]]:
    """Line, message and hint of what is wrong."""
    d = Diagnostics()
    data = source if isinstance(source, bytes) else source.encode()
    assert read_data(data, "net.cpnt", d) is None
    assert d.errors
    return [(e.origin.line, e.message, e.hint) for e in d.errors]


def written(document: Document) -> str:
    d = Diagnostics()
    made = emit(document, d)
    assert not d.has_errors, [e.message for e in d.errors]
    return made


def test_everything_is_read() -> None:
    document = text(GOOD)
    colsets, pages, real = facts(document)
    assert real == "true"
    by_name = {item[1]: item for item in colsets if item[0] == "colset"}
    assert by_name["WORD"][2:] == ("string", (), (), ('"a"', '"z"', "1", "3"), True, (), False)
    assert by_name["YES"][3] == ("no", "yes") and by_name["E"][3] == ("e",)
    assert by_name["U"][4] == (("number", "N"), ("nothing", ""))
    assert by_name["ODD"][5:] == (("odd",), False, (), True)
    assert by_name["M"][2:4] == ("alias", ("N",)) and by_name["M"][7] == ("ms", "size")
    assert by_name["I"][3] == ("i",) and by_name["I"][5] == ("0", "2")
    texts = [item[1] for item in colsets if item[0] == "ml"]
    assert "fun pick 0 = red\n| pick _ = blue;" in texts
    assert "fun width (p : POSE) =\n#x p +\n#y p;" in texts
    assert "(* A note of the net,\nover two lines *)" in texts
    assert "infix 6 plus" in texts and "fun a plus b = a + b;" in texts
    blocks = [item for item in colsets if item[0] == "block"]
    assert blocks == [
        (
            "block",
            "Inner",
            (("ml", "val last = 4;"), ("block", "More", (("ml", "val first = 1;"),))),
        )
    ]
    top, sub = pages
    assert top[1][0] == ("A", "N", "1`first ++\n2`last", "", None)
    assert top[2] == (("Left", "Sub", (("Inp", "A"), ("Outp", "In Flight"))),)
    assert [p[3:] for p in sub[1]] == [("In", None), ("Out", None), ("", "Held")]
    [(name, clauses, arcs)] = sub[2]
    assert name == "Move On"
    assert clauses[:3] == ("[n < last,\nodd n]", "@+2.5", "P_HIGH")
    assert clauses[3].endswith('print ("(* no comment \\" " ^ INT.mkstr n)')
    assert [a[:2] for a in arcs] == [("ptot", "Inp"), ("ttop", "Outp"), ("bothdir", "Held")]
    # Arcs at a substitution transition follow from the ports.
    subst = document.pages[0].transitions[0]
    assert [(a.orientation, a.transition) for a in document.pages[0].arcs] == [
        ("ptot", subst.id),
        ("ttop", subst.id),
    ]
    assert document.elements == {"pages": 2, "places": 6, "transitions": 2, "arcs": 5}


def test_written_and_read_it_is_the_same() -> None:
    document = text(GOOD)
    assert facts(text(written(document))) == facts(document)
    once = written(document)
    assert written(text(once)) == once, "a text that was written is written in the same way again"


def test_the_standard_declarations_are_written_as_one_word() -> None:
    source = "val a = 1;\nstandard\nblock B\n  standard\n\npage Top\n"
    assert written(text(source)) == source
    d = Diagnostics()
    document = text(source)
    drawn_one = read_cpn(cpn.emit(document, positions(document)).encode(), "net.cpn", d)
    assert drawn_one is not None and written(drawn_one) == source


def test_as_a_file_of_cpn_tools_it_is_the_same() -> None:
    """With the same ids, so that a trace of the one is a trace of the other."""
    document = text(GOOD)
    d = Diagnostics()
    made = read_cpn(cpn.emit(document, positions(document)).encode(), "net.cpn", d)
    assert made is not None and not d.items, [e.message for e in d.items]
    assert facts(made) == facts(document)
    for p, q in zip(document.pages, made.pages, strict=True):
        assert [n.id for n in p.nodes] == [n.id for n in q.nodes]
    assert [i.page for i in made.instances] == [made.pages[0].id]
    assert [i.transition for i in made.instances[0].below] == [document.pages[0].transitions[0].id]


def nets(folder: Path) -> list[Path]:
    return sorted(folder.rglob("*.cpn"))


def same(files: list[Path]) -> tuple[int, list[str]]:
    """How many files come back as they were, from a text and from a drawn net made of it; which cannot be written."""
    count, refused = 0, []
    for file in files:
        document = read(file, Diagnostics(), drawn=False)
        if document is None:
            continue
        d = Diagnostics()
        made = emit(document, d)
        if d.has_errors:
            refused.append(file.name)
            continue
        back = text(made)
        assert facts(back) == facts(document), file
        d = Diagnostics()
        drawn_again = read_cpn(cpn.emit(back, {}).encode(), "net.cpn", d)
        assert drawn_again is not None, file
        assert facts(drawn_again) == facts(document), file
        count += 1
    return count, refused


def test_the_examples_come_back_as_they_were() -> None:
    count, refused = same(nets(ROOT / "examples"))
    assert count >= 10 and not refused


def test_collected_nets_come_back_as_they_were(shared: Path) -> None:
    """Only nets in which two places of a page have one name, or with declarations that are none, cannot be written."""
    step = 1 if THOROUGH else 6
    count, refused = same(nets(shared / "corpus")[::step])
    assert len(refused) <= 0.1 * count
    assert same(nets(shared / "semantics-suite")[::step])[1] == []


def test_a_text_behaves_as_the_drawn_net(tmp_path: Path) -> None:
    net = """
    net Net
      standard
      colset N = int with 0..3;
      var n : N;
      page Top
        place A : N = 1`0 ++ 1`3
        place B : N
        trans T
          guard [n < 3]
          in A : n
          out A : n + 1
        trans Out
          in A : n
          out B : n
          inhibit B
        subst S = Sub (X -> A, Y -> B)
      page Sub
        place X port out : N
        place Y port in : N
        trans Back
          in Y : n
          out X : 0
    """
    (tmp_path / "net.cpn").write_bytes(drawn(net))
    document = read(tmp_path / "net.cpn", Diagnostics())
    assert document is not None
    (tmp_path / "net.cpnt").write_text(written(document), encoding="utf-8")
    spaces = []
    for name in ("net.cpn", "net.cpnt"):
        d = Diagnostics()
        flat = load(tmp_path / name, d, {}, compute=compute)
        assert flat is not None and not d.has_errors
        spaces.append(graph(flat))
    first, second = spaces
    assert len(first.nodes) == len(second.nodes) > 5
    assert sorted((a.source, a.target) for a in first.arcs) == sorted(
        (a.source, a.target) for a in second.arcs
    )


def test_a_message_points_into_the_text(tmp_path: Path) -> None:
    source = "standard\nvar n : INT;\npage Top\n\tplace A : INT = 1`1 ++\n\t\t\t1`tow\n\ttrans T\n\t\tin A : n\n"
    (tmp_path / "net.cpnt").write_text(source)
    d = Diagnostics()
    load(tmp_path / "net.cpnt", d, {}, compute=compute)
    [error] = d.errors
    assert "`tow`" in error.message
    assert (error.origin.line, error.origin.column) == (5, 6)
    assert error.origin.describe() == "page `Top`, place `A` (ID13), initial marking"


PAGE = "standard\npage Top\n  place A : INT\n"
MISTAKES = {
    "a misspelt head": ("pgae Top\n", 1, "begins with `pgae`", "did you mean `page`?"),
    "a place without a page": (
        "standard\nplace A : INT\n",
        2,
        "begins with `place`",
        "deeper than their",
    ),
    "no page": ("standard\n", 0, "the net has no page", "page Top"),
    "a page without a name": ("page\n", 1, "a page has a name", "page Top"),
    "two pages of one name": ("page A\npage A\n", 2, "page `A` is there twice", "another name"),
    "two places of one name": (
        PAGE + "  place A : INT\n",
        4,
        "place `A` is there twice",
        "another",
    ),
    "a misspelt element": (PAGE + "  tarns T\n", 4, "begins with `tarns`", "did you mean `trans`?"),
    "a misspelt clause": (
        PAGE + "  trans T\n    gaurd [n]\n",
        5,
        "`gaurd`",
        "did you mean `guard`?",
    ),
    "two guards": (
        PAGE + "  trans T\n    guard [n]\n    guard [m]\n",
        6,
        "two of `guard`",
        "one of",
    ),
    "an arc to nothing": (
        PAGE + "  trans T\n    in AA : 1\n",
        5,
        "no place `AA`",
        "did you mean `A`?",
    ),
    "an arc without a colon": (
        PAGE + "  trans T\n    in A 1\n",
        5,
        "an arc names a place",
        "in A : n",
    ),
    "text after a name": (
        PAGE + "  trans T now\n",
        4,
        "nothing more on its line",
        "below `trans T`",
    ),
    "a port of no kind": ("page T\n  place A port into\n", 2, "`into` is no kind of port", "did"),
    "a word after a place": (
        "page T\n  place A timed : INT\n",
        2,
        "`timed` is not",
        "place A : INT",
    ),
    "no page of that name": (PAGE + "  subst S = Sbu\npage Sub\n", 4, "no page `Sbu`", "`Sub`"),
    "no port of that name": (
        PAGE + "  subst S = Sub (X -> A)\npage Sub\n  place Y port in : INT\n",
        4,
        "page `Sub` has no place `X`",
        "",
    ),
    "no arrow": (PAGE + "  subst S = Sub (X = A)\npage Sub\n  place X\n", 4, "no assignment", "->"),
    "a comment without an end": (PAGE + "(* and\nso on\n", 4, "never ends", "*)"),
    "a note in a text": (
        PAGE + "  trans T\n    guard [1 = 1,\n      # why\n      2 = 2]\n",
        6,
        "stands inside a text",
        "(* ... *)",
    ),
    "no colour set": (
        "var x, y;\npage T\n",
        1,
        "the colour set of the variables",
        "var x, y : PART;",
    ),
    "bounds": ("colset A = int with 1;\npage T\n", 1, "bounds are written", "1..4"),
    "a record": ("colset A = record x * y;\npage T\n", 1, "`x` has no colour set", "record x"),
    "a name that is none": (
        "colset A B = int;\npage T\n",
        1,
        "a name is expected, not `A B`",
        "colset",
    ),
    "a set of nothing": ("colset A;\npage T\n", 1, "the definition", "colset"),
    "an end of nothing": (
        "val x = 1\ncolset A = int;\n| f _ = 2\npage T\n",
        3,
        "begins with `|`",
        "deeper",
    ),
    "an option": ("option real true\npage T\n", 1, "no option", "realtimestamp"),
    "a reference": ("globref x;\npage T\n", 1, "a first value", "globref count = 0;"),
    "declarations below `standard`": (
        "val n = 3;\nstandard\n  val n = 4;\npage T\n",
        2,
        "nothing deeper below it",
        "as deep as it",
    ),
    "a note beside `standard`": ("standard # all\npage T\n", 1, "line of its own", "as deep as it"),
    "two words of `declare`": (
        "colset A = int declare ms timed;\npage T\n",
        1,
        "a name is expected, not `ms timed`",
        "colset",
    ),
    "bounds twice": ("colset A = int with 1..3 and 5..7;\npage T\n", 1, "more bounds", "1..4"),
    "three bounds of a string": (
        'colset A = string with "a".."z" and 1..3 and 5..7;\npage T\n',
        1,
        "more bounds",
        "1..4",
    ),
    "a selector that looks like a note": (
        "standard\ncolset P = record x : INT * y : INT;\nfun sum (p : P) =\n# x p +\n  #y p;\npage T\n",
        4,
        "stands inside a text",
        "a selector without a blank",
    ),
    "a note less deep inside a marking": (
        PAGE + "  place B : INT = 1`1 ++\n  # not 2\n    1`3\n",
        5,
        "stands inside a text",
        "(* ... *)",
    ),
    "a selector below a whole text": (
        PAGE + "  trans T\n    in A : n\n      # x p\n",
        6,
        "stands inside a text",
        "a selector without a blank",
    ),
    "a fusion set without a name": ('page T\n  place A fusion "" : INT\n', 2, "`fusion` needs", ""),
    "two ports of one place": ("page T\n  place A port in port out\n", 2, "`port` twice", "one"),
    "places that differ in blanks": (
        'page T\n  place "A  1"\n  place " A 1"\n',
        3,
        "place `A 1` is there twice",
        "another",
    ),
    "a character that is not printed": ("page T\n  place A\x01\n", 2, "U+0001", "remove it"),
    "a comment in the name of a block": (
        "block A (* b\n  val x = 1;\nblock C *) d\n  val x = 2;\npage T\n",
        1,
        "a block has a name",
        "a note",
    ),
    "a semicolon after a transition": ("page T\n  trans T;\n", 2, "nothing more", "below `trans"),
    "a semicolon after a place": ("page T\n  place A : INT;\n", 2, "does not end with `;`", ""),
    "a comment of CPN ML on a page": ("page T\n  (* x *)\n", 2, "begins with `(*`", "`# `"),
    "a note without a blank": ("#x\npage T\n", 1, "begins with `#x`", "a blank after it"),
    "not in UTF-8": (b"page Top\n  place \xff\n", 2, "UTF-8", "UTF-8"),
    "XML": ("<?xml version='1.0'?><workspaceElements/>", 1, "XML", ".cpn"),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_what_is_said_of_a_mistake(name: str) -> None:
    source, line, message, hint = MISTAKES[name]
    found = errors(source)
    assert any(
        at == line and message in said and hint in (help or "") for at, said, help in found
    ), found


def test_a_note_at_the_end_of_a_line_is_an_error() -> None:
    [(line, message, _)] = errors(ALL)
    assert ALL.split("\n")[line - 1].strip().startswith('place "In Flight"')
    assert "a line of its own" in message


READ = {
    "comments beside colour sets and variables": (
        "colset A = (* of *) int (* small *);\nvar n : A (* one *);  (* more *)\n",
        [("colset", "A", "int", (), (), (), False, (), False), ("var", ("n",), "A")],
    ),
    "a colour set over lines that are not deeper": (
        "colset C = with red\n| green;\n",
        [("colset", "C", "enum", ("red", "green"), (), (), False, (), False)],
    ),
    "semicolons inside a declaration": (
        "var n : A; fun f x = let val y = 1; val z = 2 in y + z end; var m : A;\n",
        [
            ("var", ("n",), "A"),
            ("ml", "fun f x = let val y = 1; val z = 2 in y + z end"),
            ("var", ("m",), "A"),
        ],
    ),
    "a string over lines": (
        'val s = "abc \\\n  \\ (* d";\nval t = "*)";\n',
        [("ml", 'val s = "abc \\\n\\ (* d";'), ("ml", 'val t = "*)";')],
    ),
    "words inside strings": (
        'colset A = string with " and "..";";\ncolset B = subset A with [" by ", " timed"];\n',
        [
            ("colset", "A", "string", (), (), ('" and "', '";"'), False, (), False),
            ("colset", "B", "subset", ("A",), (), ('[" by ", " timed"]',), False, (), False),
        ],
    ),
    "several blanks in a string": (
        'colset B = subset A with ["x  y"];\n',
        [("colset", "B", "subset", ("A",), (), ('["x  y"]',), False, (), False)],
    ),
    "a semicolon after `use`": ('use "a.sml";\n', [("use", '"a.sml"')]),
}


@pytest.mark.parametrize("name", READ)
def test_declarations_are_read_and_written_as_they_are(name: str) -> None:
    source, expected = READ[name]
    document = text(source + "page Top\n")
    assert list(facts(document)[0]) == expected
    assert facts(text(written(document))) == facts(document)


def test_a_note_below_what_has_no_text_belongs_to_nothing() -> None:
    source = "page T\n  place A : INT\n    # of parts\n  trans T\n    in A\n      # any\n"
    assert facts(text(source)) == facts(text("page T\n  place A : INT\n  trans T\n    in A\n"))


def test_an_arrow_needs_no_blanks() -> None:
    source = 'page T\n  place "a->[b" : INT\n  subst S = Sub (P->"a->[b")\npage Sub\n  place P port in : INT\n'
    document = text(source)
    assert facts(document)[1][0][2] == (("S", "Sub", (("P", "a->[b"),)),)
    assert facts(text(written(document))) == facts(document)


def test_a_selector_is_not_written_as_a_note() -> None:
    document = text(
        "page T\n  place A : INT\n  trans T\n    in A\n    out A : #\n      x p +\n      #y p\n"
    )
    [*_, arc] = text(written(document)).pages[0].arcs
    assert arc.inscription is not None and arc.inscription.text.text == "#x p +\n#y p"


def test_a_string_behind_a_selector_is_written_as_it_is() -> None:
    document = text(
        'fun shown p =\n  #name p ^ "# 1"\nfun other p =\n  f\n  #\tname p ^ "# 2";\npage T\n'
    )
    once = written(document)
    assert '#name p ^ "# 1"' in once and '#name p ^ "# 2"' in once
    assert facts(text(once)) == facts(document)


def test_a_backslash_in_a_name_is_one() -> None:
    document = text('page T\n  place "a\\b \\"c\\" \\\\d" : INT\n')
    assert document.pages[0].places[0].name == 'a\\b "c" \\d'
    assert facts(text(written(document))) == facts(document)


def test_a_deeply_indented_text_is_read_again() -> None:
    net = f"net Net\n  standard\n  page Top\n    place A : INT = 1`1 ++{chr(10)}{' ' * 600}1`2"
    document = read_cpn(drawn(net), "net.cpn", Diagnostics())
    assert document is not None
    [place] = document.pages[0].places
    assert place.initial is not None and " " * 300 in place.initial.text.text
    assert facts(text(written(document))) == facts(document)


def test_fusion_sets_of_one_name_cannot_be_written() -> None:
    """They would be one in the text."""
    document = text("page T\n  place A fusion F : INT\n  place B fusion G : INT\n")
    same_name = tuple(replace(f, name="F") for f in document.fusions)
    d = Diagnostics()
    emit(replace(document, fusions=same_name), d)
    assert [e.message for e in d.errors] == ["2 things have the name of fusion set `F`"]


def test_what_cannot_be_written_is_named() -> None:
    d = Diagnostics()
    document = read_cpn(
        drawn("net Net\n  standard\n  page Top\n    place A : INT\n    place A : INT"),
        "net.cpn",
        Diagnostics(),
    )
    assert document is not None
    emit(document, d)
    assert [e.message for e in d.errors] == ["2 things have the name of place `A`"]


@pytest.mark.parametrize(
    "source",
    [
        b"\x00" * 1000,
        b"page " * 50_000,
        b"\n".join(b" " * k + b"block b" for k in range(3000)),
        b"(*" * 20_000,
        b'page "' + b"a" * 100_000,
        b"\xef\xbb\xbfpage Top\r\n  place A : INT\r\n" * 2,
    ],
)
def test_odd_files_end_in_messages(source: bytes) -> None:
    d = Diagnostics()
    assert read_data(source, "net.cpnt", d) is None
    assert d.errors
