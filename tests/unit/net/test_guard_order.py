"""Conditions that CPN Tools may look at before others that keep them from being looked at here."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose, flat
from pn2code.net.guard_order import doubtful, not_there, rows, unsure
from pn2code.verify.answers import outcome
from pn2code.verify.answers.outcome import Counts
from pn2code.verify.exploring.explorer_process import nothing
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import Exploration

NET = """
net N
  standard
  colset L = list INT;
  colset NL = product INT * L;
  colset SMALL = int with 0..3;
  var l : L;
  var n, m, k, x0, x1, x2, x3, x4, x5, x6, x7, x8 : INT;
  var s : SMALL;
  val base = 4;
  fun first (x :: _) = x | first [] = 0;
  fun partial (x :: _) = x;
  fun sum [] = 0 | sum (x :: r) = x + sum r;
  fun even 0 = true | even n = odd (n - 1) and odd 0 = false | odd n = even (n - 1);
  fun quotient (a, b) = a div b;
  fun careful x = let val part = 9 div x in part end;
  page Q
    place P : L = 1`[]
    place A : INT = 1`1
    place C : INT = 1`3
    place R : NL = 1`(1, [])
    place O : INT
    trans T guard [%s]
%s
      out O : 1
"""


MANY = "P : l|" + "|".join(f"A : x{i}|C : x{i}" for i in range(9))
"""In more ways than are looked at."""


def net(guard: str, arcs: str = "P : l|A : n") -> str:
    return NET % (guard, "\n".join(f"      in {arc}" for arc in arcs.split("|")))


@pytest.mark.parametrize(
    ("guard", "arcs"),
    [
        ("length l > 0, hd l > 0", "P : l"),
        ("length l > 0, m = hd l", "P : l"),
        ("m = hd l, length l > 0", "P : l"),
        ("n > 1, m = hd l", "P : l|A : n"),
        ("n > 1, m = n + hd l", "A : n|P : l"),
        ("n > 1, partial l > 0", "A : n|P : l"),
        ("n > 1, List.map hd [l] = [1]", "A : n|P : l"),
        ("n > 1, quotient (4, n) > 0", "A : n"),
        ("n > 1, careful n > 0", "A : n"),
        ("n > 1, (case l of x :: _ => x) > 0", "A : n|P : l"),
        ("n > 1, (fn [x] => x) l > 0", "A : n|P : l"),
        ("n > 1, let val [x] = l in x end > 0", "A : n|P : l"),
        ("s = n, m = hd l", "A : n|P : l"),
        ("m > 5, m = hd l", "P : l|C : m"),
        ("m = hd l", "A : m|P : l|C : m"),
        ("n > 1", "R : (n, l)|P : l|C : hd l"),
        ("hd l > 0", "A : n|R : (n, l)"),
        ("hd l > 0", "A : n|C : n|P : l"),  # the places may have nothing in common
        ("true", "A : n|C : n|P : l|C : hd l"),
        (" + ".join(f"x{i}" for i in range(9)) + " > hd l", MANY),
    ],
)
def test_what_may_raise_an_exception_elsewhere(guard: str, arcs: str) -> None:
    assert unsure(flat(net(guard, arcs)))
    assert [x.code for x in diagnose(net(guard, arcs)).items].count("guard-order") == 1


@pytest.mark.parametrize(
    ("guard", "arcs"),
    [
        ("hd l > 0", "P : l"),
        ("hd l > 0, length l > 0", "P : l"),
        ("m = hd l", "P : l"),
        ("hd l > 0", "P : l|C : 3"),  # what is wanted without variables is looked at before
        ("k = n + 1, m = hd l", "A : n|P : l"),
        ("m = hd l, m > 0", "P : l"),
        ("k = hd l, m = k + 1", "P : l"),
        ("length l > 0 andalso hd l > 0", "P : l"),
        ("n > 1, m = (if n > 1 then n else 0)", "A : n"),
        ("n > 1, n mod 2 = 0", "A : n"),
        ("n > 1, first l > 0, sum l > base", "P : l|A : n"),
        ("n > 1, even n, length (List.map (fn x => x + 1) l) > 0", "P : l|A : n"),
    ],
)
def test_what_may_not(guard: str, arcs: str) -> None:
    assert not unsure(flat(net(guard, arcs)))
    assert "guard-order" not in {x.code for x in diagnose(net(guard, arcs)).items}


def test_the_verdict_says_so() -> None:
    for guard, warned in (("length l > 0, m = hd l", True), ("m = hd l", False)):
        n = flat(net(guard, "P : l"))
        found = Exploration.of(n, {**nothing(n, Limits(), "complete"), "complete": True}, 0.0)
        for counts, word in ((Counts(), "COMPLETE"), (Counts(good=1, asked=True), "YES")):
            said = outcome.closing(n, found, counts)
            assert said.startswith(f"Verdict: {word}.")
            assert ("`T` in another" in said.replace("Q.T", "T")) == warned
            assert ("guard-order" in said) == warned


def test_not_every_transition_gets_a_warning() -> None:
    text = net("length l > 0, m = hd l", "P : l")
    trans = text[text.index("    trans T") :]
    many = text + "".join(trans.replace("trans T", f"trans T{i}") for i in range(7))
    said = [x for x in diagnose(many).items if x.code == "guard-order"]
    assert len(said) == 5 and said[-1].message.endswith("and so in 3 more transitions")


@pytest.mark.parametrize(
    ("guard", "arcs", "is_doubtful"),
    [
        ("hd l > 0, n > 1", "P : l|A : n", True),
        ("hd l > 0, length l > 0", "P : l", True),
        ("hd l > 0", "P : l|A : n", True),
        ("hd l > 0", "P : l", False),
        ("m = hd l, m > 1", "P : l", False),
        ("m = hd l, length l > 0", "P : l", False),
        ("length l > 0, hd l > 0", "P : l", False),
        ("length l > 0 andalso hd l > 0", "P : l|A : n", True),
    ],
)
def test_what_may_be_raised_here_alone(guard: str, arcs: str, is_doubtful: bool) -> None:
    n = flat(net(guard, arcs))
    assert bool(doubtful(n)) == is_doubtful
    assert (not_there(n, 0) is not None) == is_doubtful
    assert [r["where"] for r in rows(n)].count("here") == is_doubtful


def test_both_directions_as_data() -> None:
    (row,) = rows(flat(net("length l > 0, m = hd l", "P : l")))
    assert row["transition"].endswith("T") and row["raises"] == "m = hd l"
    assert (row["beside"], row["where"]) == ("length l > 0", "CPN Tools")
