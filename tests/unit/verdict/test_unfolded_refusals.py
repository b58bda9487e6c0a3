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
from pn2code.verdict.unfolded.look import unfolded
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
