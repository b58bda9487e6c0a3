"""What a name that is not declared may mean."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose

NET = """
net cell
  standard
  val {declared} = 3;
  var n: INT;
  page Top
    place A : INT = 1`1
    trans T guard [n > {written}]
      in A : n
"""


@pytest.mark.parametrize(
    ("declared", "written", "hint"),
    [
        ("left", "lft", "did you mean `left`?"),
        # Not `lt` of the library, which is like most names of three letters.
        ("leftovers", "lft", "declare it: `var lft : C;` for a variable of colour set C, or `val lft = ..`"),
        ("other", "lenght", "did you mean `length`?"),
    ],
)  # fmt: skip
def test_suggestion(declared: str, written: str, hint: str) -> None:
    (error,) = diagnose(NET.format(declared=declared, written=written)).errors
    assert error.message == f"`{written}` is not declared" and error.hint == hint
