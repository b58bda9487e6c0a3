"""The front end goes on after errors: what is wrong independently is found in one run."""

from __future__ import annotations

from pathlib import Path

from helpers.netbuilder import write
from pn2code.diagnostics import Diagnostics
from pn2code.net.front import Examined, examine

NET = """
    net Several
      standard
      colset P = product INT * NOPE;
      var n: INT;
      page Top
        place A : INT = 1`1
        place B : STRING
        place C fusion F : INT = 1`2
        place D fusion F : INT
        trans T
          in A : n
          out B : n + 1
        subst S = Sub (I -> B)
      page Sub
        place I port in : INT
        trans U
          in I : n
"""


def examined(
    folder: Path, text: str, change: tuple[str, str] = ("", "")
) -> tuple[Examined, Diagnostics]:
    path = folder / "net.cpn"
    write(text, path)
    xml = path.read_text(encoding="iso-8859-1")
    assert change[0] in xml
    path.write_text(xml.replace(*change, 1) if change[0] else xml, encoding="iso-8859-1")
    d = Diagnostics()
    return examine(path, d), d


def codes(d: Diagnostics) -> set[str]:
    return {e.code for e in d.errors}


def test_declarations_inscriptions_and_hierarchy(tmp_path: Path) -> None:
    result, d = examined(tmp_path, NET)
    assert result.flat is None
    assert codes(d) == {
        "unknown-colour-set", "type-mismatch", "port-colset", "fusion-mismatch"
    }  # fmt: skip
    assert result.document is not None
    assert result.document.elements == {"pages": 2, "places": 5, "transitions": 3, "arcs": 4}


def test_broken_references_do_not_hide_the_rest(tmp_path: Path) -> None:
    result, d = examined(tmp_path, NET, ('subpage="', 'subpage="X'))
    assert codes(d) >= {"subpage-unknown", "unknown-colour-set", "type-mismatch"}
    _, d = examined(tmp_path, NET, ('<placeend idref="', '<placeend idref="X'))
    assert codes(d) >= {"arc-dangling", "unknown-colour-set", "type-mismatch"}
    assert result.document is not None
    assert result.document.elements["arcs"] == 4


def test_a_page_in_itself_does_not_hide_the_rest(tmp_path: Path) -> None:
    text = NET.replace("subst S = Sub (I -> B)", "subst S = Top ()")
    _, d = examined(tmp_path, text)
    assert codes(d) >= {"page-recursion", "unknown-colour-set", "type-mismatch"}


def test_what_is_no_net_has_no_document(tmp_path: Path) -> None:
    path = tmp_path / "net.cpn"
    path.write_text("<a/>")
    d = Diagnostics()
    assert examine(path, d) == Examined(None, None)
    assert codes(d) == {"not-cpn"}
