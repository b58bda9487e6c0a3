"""Where nothing is said of the unfolded net: it would be another one, or contradicts what was explored."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from helpers import netbuilder
from helpers.unfoldable_nets import nothing_seen
from pn2code.diagnostics import Diagnostics
from pn2code.verdict.asked import gather
from pn2code.verdict.opened import read
from pn2code.verdict.unfolded.askable import why_not
from pn2code.verdict.unfolded.look import unfolded, without_overflows
from pn2code.verdict.unfolded.questions import Questions
from pn2code.verify.answers.properties import answers, from_unfolded
from pn2code.verify.exploring.unfolded import Told, Unfolded

COUNTER = """
    net Counter
      standard
      colset N = int with 0..9;
      var n : N;
      var x : INT;
      fun f n = if n < 5 then n else raise Fail "far";
      place P : N = 1`0
      place D : INT = 1`1
      trans Next guard [n < 9]
        in P : n
        out P : n + 1
      trans Look{guard}
        in P : n
        in D : {arc}
"""
ZEROS = """
    net Zeros
      standard
      var r : REAL;
      place P : REAL = 2`0.0
      trans T
        in P : r
        out P : {put}
"""


@pytest.mark.parametrize(
    ("guard", "arc"),
    [
        (" guard [x = f n]", "x"),
        (" guard [f n < 3]", "x"),
        ("", "(f n)"),
        ("", "(1000000000 + f n)"),
    ],
)
def test_a_search_for_bindings_that_raises_later(guard: str, arc: str) -> None:
    why = unfolded(netbuilder.flat(COUNTER.format(guard=guard, arc=arc)))
    assert isinstance(why, str) and "Fail (far)" in why


REASONS = """
    net Reasons
      standard
      colset LIST = list INT;
      colset SMALL = int with 0..9;
      colset TIMED = unit timed;
      var n, m : INT;
      var l : LIST;
      var s, v : SMALL;
      globref limit = 3;
      globref last = 0;
      fun half 0 = 0 | half 2 = 1;
      fun first l = hd l;
      fun least l = first l;
      place P : INT = 1`0
      place Q : LIST = 1`[1]
      place R : SMALL = 1`1
      place X : {x}
      trans T guard [{guard}]
        in P : n
        in Q : l
        in R : s
        out R : s
{more}
"""


@pytest.mark.parametrize(
    ("guard", "x", "more", "words"),
    [
        (
            "length l > 0, hd l > n",
            "INT",
            "",
            ("guard of transition `Top.T` (page `Top`)", "`hd`", "before `length l > 0`", "andalso"),
        ),
        ("length l > 0, least l > n", "INT", "", ("function `first` uses `hd`", "`least l > n`")),
        ("n > 1, s = 2, half s > n", "INT", "", ("`half` has patterns that do not match all",)),
        ("n < 9, l = [n * n]", "INT", "        out P : n + 1", ("`n * n` may be too large (`Overflow`)", "0..9`")),
        ("v = n", "INT", "        out R : v", ("value outside its colour set", "give the variable a larger one")),
        ("n > 0", "TIMED", "", ("place `Top.X` is timed", "leave `timed` out")),
        ("n > 0", "INT", "        inhibit X : 1`1", ("`Top.T` has an inhibitor arc from place `Top.X`",)),
        (
            "n > 0",
            "INT",
            "      trans U\n        priority 5\n        in P : n\n        out P : n",
            ("`Top.T` and `Top.U` have different priorities (1000 and 5)", "the same one"),
        ),
        ("n > !last", "INT", "        out P : (last := 1; n)", ("`Ref.", "variable or a constant")),
        ("n > !limit", "INT", "        out X : discrete (0, 1)", ("arc `T` -> `X`", "page `Top`")),
    ],
)  # fmt: skip
def test_a_reason_names_the_element_and_what_to_change(
    guard: str, x: str, more: str, words: tuple[str, ...]
) -> None:
    why = why_not(netbuilder.flat(REASONS.format(guard=guard, x=x, more=more)))
    assert all(word in why for word in words), why


@pytest.mark.parametrize(
    ("guard", "other", "is_constant"),
    [
        ("n < !limit", "0", True),
        ("small n", "0", True),
        ("n < !other", "!limit", True),
        ("n < !(!other)", "limit", False),  # it has another name
        ("n < (fn r => !r) limit", "0", False),
        ("n < !limit andalso (other := n; true)", "0", False),
    ],
)
def test_references_that_nothing_assigns_are_constants(
    guard: str, other: str, is_constant: bool
) -> None:
    net = netbuilder.flat(f"""
        net Constants
          standard
          colset N = int with 0..9;
          var n : N;
          globref limit = 3;
          globref other = {other};
          fun small n = n < !limit;
          place P : N = 1`0
          trans T guard [{guard}]
            in P : n
            out P : n + 1
    """)
    assert (why_not(net) == "") is is_constant


def test_a_number_of_tokens_that_may_be_too_large(tmp_path: Path) -> None:
    """`size` raises Overflow then: an answer that no run shows is not believed where that is not known."""
    net = netbuilder.write(COUNTER.format(guard="", arc="x"), tmp_path / "net.cpn")
    opened = read(net, {}, Diagnostics())
    assert opened is not None
    unfolding = unfolded(opened.flat)
    assert not isinstance(unfolding, str)
    text = "always { size (Mark.Top'P 1) + 2 * 3 <= 9 }"
    properties = gather(opened, [text], None, Diagnostics(), found=False).plain
    questions = Questions.of(opened.game(seed=1, files=None), unfolding, properties)
    (name,) = questions.counted
    shown = Told(False, ("RANDOM_WALK",), (tmp_path / "run", 1))
    for bounds, told, is_kept in (
        ({0: 1}, Told(True, ()), True),
        ({}, Told(True, ()), False),
        ({}, shown, True),
        ({0: (1 << 30) - 6}, Told(True, ()), False),
    ):
        made = Unfolded(told={name: told}, bounds=bounds)
        left = without_overflows(opened.flat, made, questions.counted, {})
        assert (name in (left.told or {})) is is_kept
        assert ("place `Top.P`" in (left.refused or {}).get(name, "")) is not is_kept


def test_negative_zeros() -> None:
    # The two are equal: unfolded, one place would stand for both, though inscriptions can tell them apart.
    why = unfolded(netbuilder.flat(ZEROS.format(put="~ r")))
    assert isinstance(why, str) and "a negative zero may come into place `Top.P`" in why
    assert not isinstance(unfolded(netbuilder.flat(ZEROS.format(put="~ r + 0.0"))), str)


def test_what_was_explored_must_agree(tmp_path: Path) -> None:
    net = netbuilder.write(ZEROS.format(put="r"), tmp_path / "net.cpn")
    opened = read(net, {}, Diagnostics())
    assert opened is not None
    properties = gather(opened, ["deadlock free"], None, Diagnostics(), found=False).plain
    (name,) = (p.name for p in properties.properties)
    told = Unfolded(told={name: Told(False, ("STATE_EQUATION",))})
    found = replace(nothing_seen(opened), unfolded=told)
    (open_,) = answers(properties, (), found)
    assert from_unfolded(open_, found).answer == "no"
    (explored,) = answers(properties, [{"answer": "yes"}], found)
    with pytest.raises(RuntimeError, match="is another one"):
        from_unfolded(explored, found)
