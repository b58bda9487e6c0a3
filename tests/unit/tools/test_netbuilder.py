"""The short text form of nets gives what the reader expects."""

from __future__ import annotations

from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics
from pn2code.reading.cpn import read_data
from pn2code.reading.document import Document, RawColset, RawGlobref, RawMl, RawVar

NET = """
    net Cell
      colset UNIT = unit;
      colset INT = int;  var n, m: INT;
      colset PART = with screw | nut timed;
      colset PAIR = product INT * PART;
      colset REC = record a: INT * b: PART;
      colset L = list INT with 1..5;
      colset U = union Ack: INT + Nil;
      colset PH = index ph with 1..5;
      colset SMALL = int with 1..5;
      colset SUB = subset INT by even;
      colset S = string with "a".."z" and 1..4;
      colset B = bool with (no, yes);
      colset AL = PAIR timed;
      # a comment
      fun twice x =
        let val y = x; in 2 * y end
      globref count = 0;
      option realtimestamp true
      page Top
        place Buffer : INT = 1`1 ++ 1`5
        place "In Flight" fusion Shared : INT
        place Credits = 3
        trans Pick guard [n < m] delay @+3 priority P_HIGH code input (n); output (m); action n + 1
          in Buffer : n
          out "In Flight" : if n > 0 then 1`n
                            else empty
          inhibit Credits
          reset Credits
          both Credits : 1`()
        subst Left = Sub (Inp -> Buffer, Outp -> "In Flight")
      page Sub
        place Inp id=ID900 port in : INT
        place Outp port out : INT
        place Other fusion Shared : INT
        trans Move
          guard [true]
          in Inp : n
          out Outp : n
"""


def read(text: str) -> Document:
    d = Diagnostics()
    document = read_data(cpn(text), "Cell.cpn", d)
    assert not list(d)
    assert document is not None
    return document


def test_declarations() -> None:
    document = read(NET)
    items = document.globbox.items
    colsets = {c.name: c for c in items if isinstance(c, RawColset)}
    shapes = {name: (c.kind, c.ids, c.fields) for name, c in colsets.items()}
    assert shapes["PART"] == ("enum", ("screw", "nut"), ())
    assert shapes["PAIR"] == ("product", ("INT", "PART"), ())
    assert shapes["REC"] == ("record", (), (("a", "INT"), ("b", "PART")))
    assert shapes["U"] == ("union", (), (("Ack", "INT"), ("Nil", "")))
    assert shapes["L"] == ("list", ("INT",), ())
    assert shapes["PH"] == ("index", ("ph",), ())
    assert shapes["B"] == ("bool", ("no", "yes"), ())
    assert shapes["AL"] == ("alias", ("PAIR",), ())
    assert colsets["PART"].timed and colsets["AL"].timed and not colsets["PAIR"].timed
    assert colsets["SUB"].by_predicate
    texts = {name: [t.text for t in c.texts] for name, c in colsets.items()}
    assert texts["L"] == ["1", "5"]
    assert texts["SUB"] == ["even"]
    assert texts["S"] == ['"a"', '"z"', "1", "4"]
    assert [v.names for v in items if isinstance(v, RawVar)] == [("n", "m")]
    assert [m.text.text for m in items if isinstance(m, RawMl)] == [
        "fun twice x =\n  let val y = x; in 2 * y end"
    ]
    assert [(g.name, g.text.text) for g in items if isinstance(g, RawGlobref)] == [("count", "0")]
    assert document.options == {"realtimestamp": "true"}


def test_pages() -> None:
    document = read(NET)
    top, sub = document.pages
    assert [p.name for p in top.places] == ["Buffer", "In Flight", "Credits"]
    credits = top.places[2]
    assert credits.type is None and credits.initial is not None
    assert credits.initial.text.text == "3"
    pick, left = top.transitions
    assert pick.guard is not None and pick.guard.text.text == "[n < m]"
    assert pick.delay is not None and pick.delay.text.text == "@+3"
    assert pick.priority is not None and pick.priority.text.text == "P_HIGH"
    assert pick.code is not None
    assert pick.code.text.text == "input (n); output (m); action n + 1"
    kinds = [a.orientation for a in top.arcs if a.transition == pick.id]
    assert kinds == ["ptot", "ttop", "inhibitor", "reset", "bothdir"]
    out = next(a for a in top.arcs if a.orientation == "ttop")
    assert out.inscription is not None and "\n" in out.inscription.text.text
    assert left.substitution is not None
    assert left.substitution.subpage == sub.id
    assert left.substitution.portsock[0] == ("ID900", top.places[0].id)
    assert [p.port for p in sub.places] == ["In", "Out", ""]
    assert [f.name for f in document.fusions] == ["Shared"]
    assert len(document.fusions[0].members) == 2
