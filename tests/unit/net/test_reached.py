"""A function that nothing uses may use what cannot run here."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.netbuilder import write
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate

NET = """
net Reached
  standard
  fun far x = SMLofNJ.Cont.callcc x;
  fun near x = if x > 5 then far x else x;
  val kept = fn x => SMLofNJ.Cont.callcc x;
  fun open_it () = TextIO.openIn "a.txt";
  var n: INT;
  place P : INT = 1`1
  place Q : INT
  trans T {guard}
    in P : n
    out Q : {out}
"""


def codes(tmp_path: Path, guard: str, out: str, more: str = "") -> list[str]:
    d = Diagnostics()
    text = NET.format(guard=guard, out=out).replace("  var n", f"{more}  var n")
    made = generate(write(text, tmp_path / "Reached.cpn"), d)
    assert (made is None) == bool(d.errors)
    return sorted({e.code for e in d.errors})


def test_what_nothing_uses_is_no_obstacle(tmp_path: Path) -> None:
    assert codes(tmp_path, "", "n") == []


@pytest.mark.parametrize(
    ("guard", "out", "more"),
    [
        ("", "near n", ""),
        ("guard [kept n = n]", "n", ""),
        ("code output (); action (ignore (far 3))", "n", ""),
        ("", "n", "  val early = near 3;\n"),
        ("", "(SMLofNJ.Cont.callcc n : int)", ""),
    ],
)
def test_what_a_run_comes_to_is_refused(tmp_path: Path, guard: str, out: str, more: str) -> None:
    assert codes(tmp_path, guard, out, more) == ["unsupported-function"]
