"""Readable dumps of the stages."""

from __future__ import annotations

from pathlib import Path

from helpers.netbuilder import cpn, flat, write
from pn2code.cli.dump import Stage, stage_text
from pn2code.diagnostics import Diagnostics
from pn2code.net.dump import dump_document, dump_flat, dump_net
from pn2code.net.link import link
from pn2code.reading.cpn import read_data

NET = """
    net Cell
      colset INT = int;
      colset PAIR = product INT * INT timed;
      var n, m, k: INT;
      fun f x = x + 1
      page Top
        place A id=ID61 : INT = 1`1 ++ 1`5
        subst S = Sub (P -> A)
      page Sub
        place P id=ID62 port in : INT
        place Q id=ID63 : PAIR
        trans Pick id=ID64 guard [m = f n] delay @+ 3 priority 5
          in P : 1`n ++ 1`(f n)
          code input (n); output (k); action n * 2
          out Q : (m, k)
          reset A1
        place A1 id=ID65 fusion F : INT
"""


def test_document_and_net() -> None:
    data = cpn(NET.replace("reset A1", "").replace("          \n", ""))
    d = Diagnostics()
    document = read_data(data, "cell.cpn", d)
    assert document is not None, list(d)
    text = dump_document(document)
    assert text.startswith("document CPN Tools 4.0.1 format 6\n  colset INT = int\n")
    assert "  colset PAIR = product INT INT timed\n  var n, m, k : INT\n  fun f x = x + 1\n" in text
    assert "    place P port In : INT =    (ID62)\n" in text
    assert "    trans Pick   (ID64)\n      guard [m = f n]\n      delay @+ 3\n" in text
    net = link(document, d)
    assert net is not None
    text = dump_net(net)
    assert "  page Top prime\n    place A : INT\n    subst S = Sub (P -> A)\n" in text
    assert "      input P : 1`n ++ 1`(f n)\n" in text


def test_flat() -> None:
    text = dump_flat(flat(NET.replace("          reset A1\n", "")))
    assert text == (
        "flat net cell, integer time\n"
        "place 0 Top.A : INT = 1`1 ++ 1`5   (ID61 +1)\n"
        "place 1 Top.S.Q : PAIR   (ID63)\n"
        "place 2 Fusion.F : INT   (ID65)\n"
        "transition 0 Top.S.Pick   (ID64) priority 5\n"
        "  variables m, n, k\n"
        "  input Top.A : 1`n ++ 1`(f n)   multi-set, tests f n\n"
        "  output Top.S.Q : (m, k)   token\n"
        "  guard m = f n\n"
        "  bind  arc 0 term 0: n\n"
        "  bind  guard 0: m from f n\n"
        "  code  input (n) output (k) action n * 2\n"
        "  delay 3\n"
    )


def test_only() -> None:
    text = dump_flat(flat(NET.replace("          reset A1\n", "")), only="Pick")
    assert "place " not in text
    assert "transition 0 Top.S.Pick" in text


def test_the_programs_that_c_is_printed_from(tmp_path: Path) -> None:
    net = write(NET.replace("          reset A1\n", ""), tmp_path / "cell.cpn")
    d = Diagnostics()
    text = stage_text(net, Stage.IR, "Pick", {}, d)
    assert text is not None, list(d)
    assert text.startswith("transition 0 Top.S.Pick   (ID64) owner 0 priority 5\n")
    assert "    put Top.S.Q 1 ` " in text


def test_nothing_is_dumped_of_what_cannot_be_compiled(tmp_path: Path) -> None:
    net = write("net Cell\n  standard\n  place A : INT = foo\n", tmp_path / "cell.cpn")
    d = Diagnostics()
    assert stage_text(net, Stage.IR, "", {}, d) is None
    assert d.has_errors


def test_places_with_what_is_proven_of_them(tmp_path: Path) -> None:
    net = write(
        """
        net Cell
          standard
          var n: INT;
          place A : INT = 1`1
          place B : INT
          trans T
            in A : n
            out B : n
        """,
        tmp_path / "cell.cpn",
    )
    d = Diagnostics()
    text = stage_text(net, Stage.DEPLOYED, "", {}, d)
    assert text is not None, list(d)
    assert "place 0 Top.A : INT capacity 1 owner 0 slot\n" in text
    assert "  enumerate plain flat\n" in text
    assert "  fire direct\n" in text
    lowered = stage_text(net, Stage.IR, "", {}, d)
    assert lowered is not None and "slot" not in lowered
