"""What CPN Tools takes otherwise: values outside a colour set, and `Bind`. What it says was asked of its engine."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.net.guard_order import unsure
from pn2code.net.other_orders import asking
from pn2code.net.outside import RAISED
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.token_game import Game, GameError

NET = """
net N
  standard
  colset L = list INT;
  colset SMALL = int with 0..3;
  colset PAIR = product INT * SMALL;
  colset FEW = list INT with 0..1;
  colset NL = product INT * L;
  var n, m : INT;
  var s, t : SMALL;
  var few : FEW;
  var l : L;
  fun first xs = let val (x :: _) = xs in x end;
  page Q
    place A : INT = 1`1
    place B : INT = 1`6
    place S : SMALL = 1`1
    place R : PAIR = 1`(1, 1)
    place P : L = 1`[]
    place D : NL = 1`(2, [])
    place E : INT
    trans T%s
%s
"""


def asked(guard: str, arcs: str) -> list[tuple[str, str]]:
    """Kind and text of what happens in the initial marking, of all that only asks."""
    text = f" guard [{guard}]" if guard else ""
    net = flat(NET % (text, "\n".join(f"      in {arc}" for arc in arcs.split("|"))))
    made = asking(net)
    if made is None:
        return []
    game = Game(made.net, {}, files=Files(None))
    found = []
    for t in made.net.transitions[made.own :]:
        question = made.question(t.index)
        assert question is not None
        try:
            assert not list(game.enabling.enabled(t, game.marking))
        except GameError as raised:
            assert question.kind == "order" or RAISED in raised.message
            found.append((question.kind, question.raises.span.text))
    return found


@pytest.mark.parametrize(
    ("guard", "arcs", "is_bound"),
    [
        # In the first six the engine finds a binding, or raises the exception behind it.
        ("s = n + 5", "A : n", True),
        ("s = n + 5, s > 1", "A : n", True),
        ("s = n + 5, 6 div (s - 6) > 1", "A : n", True),
        ("(s, m) = (n + 9, n)", "A : n", True),
        ("s = n + 5", "A : n|B : s", True),
        ("few = [n, n]", "A : n", True),
        ("s = n + 5, s < 3", "A : n", False),
        ("s = n + 5, n > 1", "A : n", False),
        ("s = n + 1", "A : n", False),
        ("s = n + 5", "A : n|E : m", False),
        ("s = n + 5", "A : n|S : s", False),  # no token of it has such a value
        ("s = n + 5", "A : n|R : (m, s)", False),
        ("s = t", "S : t", False),
        ("m = n + 5", "A : n", False),
    ],
)
def test_a_value_outside_its_colour_set(guard: str, arcs: str, is_bound: bool) -> None:
    found = asked(guard, arcs)
    assert ("outside" in {kind for kind, _ in found}) == is_bound


@pytest.mark.parametrize(
    ("guard", "arcs", "is_raised"),
    [
        # The engine stops with Bind in the first five alone.
        ("first (if s > 0 then [] else [1]) > 0", "A : n", True),
        ("first [] > 0", "A : n", True),
        ("first [] > 0, n > 0", "A : n", True),
        ("n > 5, first [] > 0", "A : n", True),
        ("first l > 0", "D : (2, l)", True),  # it is found by a part that is known
        ("first l > 0", "P : l", False),
        ("m = first [], n > m", "A : n", False),
        ("n > 0, m = first l", "A : n|P : l", False),
        ("first l > 0, s > 5", "P : l", False),
    ],
)
def test_bind_before_any_token(guard: str, arcs: str, is_raised: bool) -> None:
    assert bool(asked(guard, arcs)) == is_raised


@pytest.mark.parametrize(
    ("arcs", "is_raised"),
    [
        ("P : l|D : (2, l)|A : first l", True),  # the engine stops: it finds the token of `D`
        ("P : l|A : first l", False),
        ("D : (m, l)|A : first l", False),
        ("P : l|A : 1`n ++ 1`(first l)", False),
    ],
)
def test_bind_of_what_an_arc_wants(arcs: str, is_raised: bool) -> None:
    assert bool(asked("", arcs)) == is_raised


def test_check_does_not_call_that_an_order() -> None:
    for guard in ("s = n + 5", "first [] > 0"):
        net = flat(NET % (f" guard [{guard}]", "      in A : n"))
        assert asking(net) is not None and not unsure(net)
