"""A net with transitions that ask what CPN Tools may ask in another order of conditions."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.net.guard_order import unsure
from pn2code.net.other_orders import MOST_WAYS, asking
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.token_game import Game, GameError

NET = """
net N
  standard
  colset L = list INT;
  colset NL = product INT * L;
  colset LATER = list INT timed;
  var l, r : L;
  var n, m, k : INT;
  page Q
    place P : L = 1`[]
    place A : INT = 1`1
    place B : INT = 1`2
    place E : INT
    place R : NL = 1`(1, [])
    place S : NL = 1`(2, [])
    place W : LATER = 1`[]@+5
    place O : INT
    trans T%s
%s
      out O : 1
"""


def net(guard: str, arcs: str) -> str:
    inputs = [x if x.startswith("inhibit") else f"in {x}" for x in arcs.split("|")]
    return NET % (f" guard [{guard}]" if guard else "", "\n".join(f"      {x}" for x in inputs))


def raised(guard: str, arcs: str) -> list[str]:
    """What raises an exception in the initial marking, of all that only ask."""
    made = asking(flat(net(guard, arcs)))
    if made is None:
        return []
    game = Game(made.net, {}, files=Files(None))
    found = []
    for t in made.net.transitions[made.own :]:
        try:
            assert not list(game.enabling.enabled(t, game.marking))
        except GameError:
            question = made.question(t.index)
            assert question is not None and question.transition == 0
            found.append(question.raises.span.text)
    return found


@pytest.mark.parametrize(
    ("guard", "arcs", "expected"),
    [
        ("length l > 0, hd l > 0", "P : l", ["hd l > 0"]),
        ("length l > 0, m = hd l", "P : l", ["hd l"]),
        ("m = hd l, length l > 0", "P : l", ["hd l"]),
        ("n > 1, k = n, 3 div (n - 1) > 0", "A : n", ["3 div (n - 1) > 0"]),
        ("hd l > 0", "A : n|B : n|P : l", ["hd l > 0"]),  # the first two have nothing in common
        ("hd r > 0", "R : (n, l)|S : (n, r)", ["hd r > 0"]),
        ("", "A : n|B : n|P : l|B : hd l", ["hd l"]),
        ("length l > 0, hd l > 0", "P : l|A : 2", []),  # what needs no variable is asked first
        ("length l > 0, hd l > 0", "P : l|A : 1", ["hd l > 0"]),
        (
            "length l > 0, hd l > 0",
            "P : l|B : n|B : 1",
            ["hd l > 0"],
        ),  # with another one: it is not
        ("m > 5, k = m + 1, hd l > k", "P : l|A : m", ["hd l > k"]),
        ("length l > 0, hd l > 0", "P : l|E : n", []),  # it is empty: nothing is asked
        ("length l > 0, hd l > 0", "P : l|E : 0`3", ["hd l > 0"]),
        ("length l > 0, hd l > 0", "P : l|inhibit A", []),
        ("length l > 0, hd l > 0", "W : l", []),  # not available yet
        ("length l > 0, hd l > hd r", "P : 1`l ++ 1`r", ["hd l > hd r"]),
    ],
)
def test_what_may_be_raised_in_another_order(guard: str, arcs: str, expected: list[str]) -> None:
    assert raised(guard, arcs) == expected


@pytest.mark.parametrize(
    ("guard", "arcs"),
    [
        ("hd l > 0", "P : l"),
        ("hd l > 0", "A : n|P : l"),  # any token does
        ("m = hd l, m > 0", "P : l"),
        ("length l > 0 andalso hd l > 0", "P : l"),
        ("n > 1, n mod 2 = 0", "A : n"),
    ],
)
def test_what_is_asked_anyway_is_not_asked_again(guard: str, arcs: str) -> None:
    assert asking(flat(net(guard, arcs))) is None


def test_a_variable_may_come_from_either_of_two_arcs() -> None:
    made = asking(flat(net("hd l > n", "A : n|B : n|P : l")))
    assert made is not None
    taken = [{made.net.places[a.place].short for a in t.arcs} for t in made.net.transitions[1:]]
    assert len(taken) == 2 and all(x == {"A", "B", "P"} for x in taken)


def test_too_many_ways_are_said() -> None:
    names = [f"x{i}" for i in range(12)]
    text = net(
        " + ".join(names) + " > hd l", "P : l|" + "|".join(f"A : {x}|B : {x}" for x in names)
    )
    made = asking(flat(text.replace("var n, m", f"var {', '.join(names)}, n, m")))
    assert (
        made is not None
        and [q.transition for q in made.left] == [0]
        and len(made.questions) < MOST_WAYS
    )


def test_all_that_is_warned_of_is_asked() -> None:
    for guard, arcs in (("n > 1, m = hd l", "P : l|A : n"), ("n > 1", "R : (n, l)|P : l|B : hd l")):
        n = flat(net(guard, arcs))
        assert unsure(n) and asking(n) is not None
