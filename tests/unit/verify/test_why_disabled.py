"""Why nothing can occur: one net for each thing that a transition can lack."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.semantics.game.token_game import Game
from pn2code.verify.answers.why_disabled import MOST_REASONS, reasons

HEAD = """
    net Stuck
      standard
      colset TIMED = int timed;
      colset PAIR = product INT * INT;
      var n, m : INT;
      place A : INT = 1`1
      place B : INT
      place C : INT
      place Clock : TIMED = 1`7
      place D : UNIT = 3`()
      place E : INT = 1`2 ++ 1`3
      place F : PAIR = 1`(4, 5)
"""


@pytest.mark.parametrize(
    ("transition", "why"),
    [
        ("trans T\n  in A : n\n  in B : m", "place `B` is empty"),
        ("trans T\n  in A : n\n  in B : m\n  in C : m", "places `B` and `C` are empty"),
        (
            "trans T guard [n > 3, m = n + 1]\n  in A : n\n  out B : m",
            "its guard `n > 3` is false with n = 1",
        ),
        (
            "trans T guard [n > 3]\n  in E : n",
            "its guard `n > 3` is false for the tokens that are there",
        ),
        (
            "trans T guard [n > 3, 1 div (n - 1) > 0]\n  in A : n",
            "its guard `n > 3` is false with n = 1",
        ),
        ("trans T\n  in A : 2", "place `A` holds 1`1, its arc takes 1`2"),
        ("trans T\n  in A : 2`n", "with n = 1 place `A` holds 1`1, its arc takes 2`1"),
        ("trans T\n  in A : 1\n  in D : 4`()", "place `D` holds 3`(), its arc takes 4`()"),
        (
            "trans T\n  in A : n\n  in D : n`()\n  in D : 3`()",
            "with n = 1 place `D` holds 3`(), its arcs take 4`()",
        ),
        (
            "trans T\n  in E : n\n  in D : (n+2)`()",
            "the tokens in `E` and `D` are not those that its arcs take together",
        ),
        (
            "trans T\n  in A : n\n  in F : (n, 7)\n  in D : ()",
            "with n = 1 place `F` holds 1`(4,5), its arc takes 1`(1,7)",
        ),
        (
            "trans T\n  in A : n\n  in F : (n, m)\n  in D : ()",
            "the tokens in `A` and `F` are not those that its arcs take together",
        ),
        (
            "trans T\n  in A : 2\n  in D : 4`()\n  in E : n",
            "the tokens in `A` and `D` are not those that its arcs take together",
        ),
        (
            "trans T guard [n > 0]\n  in A : n\n  in Clock : n",
            "the tokens in `A` and `Clock` are not those that its arcs take together",
        ),
        ("trans T\n  in A : n\n  inhibit Clock", "place `Clock` inhibits it"),
    ],
)
def test_what_a_transition_lacks(transition: str, why: str) -> None:
    lines = "".join(f"      {line}\n" for line in transition.split("\n"))
    assert reasons(Game(flat(HEAD + lines))) == [f"`T` cannot occur: {why}."]


def test_nothing_is_said_where_something_can_occur() -> None:
    assert reasons(Game(flat(HEAD + "      trans T\n        in A : n\n"))) == []


def test_a_transition_without_any_token_is_not_named() -> None:
    assert reasons(Game(flat(HEAD + "      trans T\n        in B : n\n"))) == []


def test_those_that_lack_least_come_first() -> None:
    text = HEAD + "      trans Far\n        in A : n\n        in B : n\n        in C : n\n"
    text += "".join(f"      trans N{i}\n        in A : n\n        in B : n\n" for i in range(5))
    found = reasons(Game(flat(text)))
    assert len(found) == MOST_REASONS
    assert [line.split()[0] for line in found] == ["`N0`", "`N1`", "`N2`"]


def test_tokens_that_never_leave_their_places_bring_no_transition_near() -> None:
    """`Start` and `Go` lack one token each; of `Go` one has come, of `Start` there is only the counter."""
    start = "      trans Start\n        in A : n\n        out A : n + 1\n        in B : m\n"
    go = start.replace("Start", "Go").replace("in B : m", "in Ready\n        in C : m")
    go = "      place Ready = 1\n" + go
    assert reasons(Game(flat(HEAD + start))) == ["`Start` cannot occur: place `B` is empty."]
    assert reasons(Game(flat(HEAD + start + go))) == ["`Go` cannot occur: place `C` is empty."]


def test_of_those_that_lack_equally_many_the_one_that_has_most_comes_first() -> None:
    one = "      trans One\n        in A : n\n        in B : m\n"
    two = "      trans Two\n        in A : n\n        in Clock : n\n        in C : m\n"
    found = reasons(Game(flat(HEAD.replace("1`7", "1`1") + one + two)))
    assert [line.split()[0] for line in found] == ["`Two`", "`One`"]


def test_what_was_not_given_back_comes_first() -> None:
    """`Feed` has a counter only, and lacks what `Take` has taken for good; `Clear` has more, and lacks as much."""
    text = (
        HEAD
        + """
      place Free = 1
      place Ready = 1
      trans Take
        in Free
        out Clock : 9
      trans Feed
        in A : n
        out A : n + 1
        both Free
        both Ready
      trans Clear
        in Ready
        in Clock : 1
        in B : n
    """
    )
    game = Game(flat(text))
    (take,) = (e for e in game.enabled() if game.net.transitions[e.transition].short == "Take")
    game.fire(take)
    first, *_ = reasons(game)
    assert first == "`Feed` cannot occur: place `Free` is empty, which it was not at the start."


JUDGED = (
    HEAD
    + """
      place Judge : INT
      place Go = 1
      trans Ask
        in Go
        in A : n
        out A : n + 1
        out Judge : n
      trans Form guard [n > 5]
        in E : n
        in D
      trans Fill
        in A : 5
        in D
        in E : n
      trans Free
        in C : n
        in D
      trans Pass guard [n = 0]
        in Judge : n
      trans Doubt guard [n > 1]
        in Judge : n
    """
)


def test_what_has_come_and_lacks_a_guard_alone_is_nearest() -> None:
    """`Form` and `Fill` have more tokens, but these rest where they were at the start."""
    game = Game(flat(JUDGED))
    (ask,) = game.enabled()
    game.fire(ask)
    assert reasons(game, most=6) == [
        "`Pass` cannot occur: its guard `n = 0` is false with n = 1.",
        "`Doubt` cannot occur: its guard `n > 1` is false with n = 1.",
        "`Ask` cannot occur: place `Go` is empty, which it was not at the start.",
        "`Form` cannot occur: its guard `n > 5` is false for the tokens that are there.",
        "`Fill` cannot occur: place `A` holds 1`2, its arc takes 1`5.",
        "`Free` cannot occur: place `C` is empty.",
    ]
    assert reasons(game) == reasons(game, most=6)[:MOST_REASONS]


def test_what_a_guard_keeps_from_an_exception_is_no_way() -> None:
    """Without its guard `T` would divide by zero where it takes tokens."""
    text = "      trans T guard [n > 3]\n        in A : n\n        in E : 6 div (n - 1)\n"
    (found,) = reasons(Game(flat(HEAD + text)))
    assert found.startswith("`T` cannot occur: ")
