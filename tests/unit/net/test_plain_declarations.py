"""Declarations of CPN Tools as plain text in an ML declaration: one error, and none that only follow from it."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics
from pn2code.ml.parsing.plain_text import guessed_names, plain_names
from pn2code.net.front import examine

NET = """
    net Plain
      standard
      colset OTHER = int;
      colset ITEM = record id : BOX * weight : INT;
      colset ITEMS = list ITEM;
      var n : BOX;
      var i : ITEM;
      fun heavy (i : ITEM) = #weight i > 10
      fun double x = 2 * x
      page Top
        place Stock : BOX
        place Items : ITEMS
        trans Pack guard [heavy i]
          in Stock : n
          in Items : [i]
          out Items : [{id = n, weight = 3}]
          out Stock : double n
"""


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("colset BOX = int with 1..3;", "a `colset` declaration as plain text is not supported"),
        ("colset BOX = int wiht 1;", "a `colset` declaration as plain text is not supported"),
        ("val a = 1; colset BOX = unit; var x, y : BOX;", "a `colset` declaration as plain text"),
        ("(* boxes *) colset BOX = int with 1..3;", "a `colset` declaration as plain text"),
    ],
)
def test_what_follows_is_not_reported(text: str, says: str, tmp_path: Path) -> None:
    file = tmp_path / "net.cpn"
    whole = cpn(NET).decode()
    at = whole.index("<color", whole.index("OTHER") - 60)
    file.write_text(f"{whole[:at]}<ml id='ID999'>{text}</ml>{whole[at:]}", encoding="utf-8")
    d = Diagnostics()
    examine(file, d)
    assert len(d.errors) == 1 and says in d.errors[0].message, [x.message for x in d.errors]


def test_a_function_in_a_text_without_words(tmp_path: Path) -> None:
    """A text with a character that CPN ML does not know declares its functions all the same."""
    file = tmp_path / "net.cpn"
    text = NET.replace("BOX", "INT").replace("2 * x", "2 $ x")
    file.write_bytes(cpn(text))
    d = Diagnostics()
    examine(file, d)
    assert len(d.errors) == 1, [x.message for x in d.errors]


def test_what_a_comment_says_is_no_declaration(tmp_path: Path) -> None:
    """A colour set that is not there is an error, whatever texts without errors say."""
    file = tmp_path / "net.cpn"
    text = NET.replace("fun double", "(*\\n; colset BOX = int *) fun double")
    file.write_bytes(cpn(text))
    d = Diagnostics()
    examine(file, d)
    assert any("`BOX`" in x.message for x in d.errors)


def test_names() -> None:
    assert plain_names("colset A = int; var x, y' : A; globref r = 0;") == (
        ("A",),
        ("x", "y'", "r"),
    )
    assert plain_names("val a = 1; (* note *) color B = unit") == (("B",), ())
    assert guessed_names("fun f x = 0..1 and g y = 2; val rec h = f") == ("f", "g", "h")
