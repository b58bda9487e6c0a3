"""What a run of the token game must not decide: what it has not seen, and what raises an exception."""

from __future__ import annotations

import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import pytest

from helpers import pnml_nets as pnml
from pn2code.base.deadline import Deadline
from pn2code.contest import asking
from pn2code.contest.asking import Asking
from pn2code.contest.engine import Said
from pn2code.contest.formulas import AtMost, Constant, Fireable, Formula, Op, Tokens
from pn2code.contest.paths import Followed, path_of
from pn2code.contest.playing import Play, Sought, follow
from pn2code.contest.tables import Tables
from pn2code.contest.uncoloured import uncoloured
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.token_game import Game
from pn2code.unfold.plain import TooLargeError

LONG_S = 600.0


def test_a_run_of_which_a_marking_was_not_seen_decides_nothing() -> None:
    path = path_of(Op("E", (Op("U", (Fireable(("p",)), Fireable(("q",)))),)))
    assert path is not None
    followed = Followed(path, lambda sight: sight == "p", lambda sight: sight == "q")
    assert followed.on(1, 0, "p", is_last=False) is None
    assert followed.on(1, 2, "q", is_last=False) is None
    assert followed.on(2, 0, "p", is_last=False) is None
    assert followed.on(3, 1, "q", is_last=False) is None
    assert followed.on(4, 0, "p", is_last=False) is None
    assert followed.on(4, 1, "q", is_last=False) is True


def numbers(folder: Path, taken: tuple[int, ...] = (0, 1)) -> FlatNet:
    """Numbers that leave a place; what is put is 4 divided by them."""

    def integer(n: int) -> str:
        return f'<numberconstant value="{n}"><integer/></numberconstant>'

    all_ = pnml.op("add", *(pnml.number(1, integer(n)) for n in taken))
    text = pnml.net(
        pnml.place("P", "N", all_),
        pnml.place("Q", "N"),
        pnml.transition("t"),
        pnml.arc("P", "t", pnml.number(1, pnml.var("n"))),
        pnml.arc("t", "Q", pnml.number(1, pnml.op("div", integer(4), pnml.var("n")))),
        declarations=pnml.named("N", "<integer/>") + pnml.variable("n", "N"),
    )
    return pnml.flat(text, folder)


def test_what_raises_an_exception_is_not_taken_for_a_marking_that_is_not_there(
    tmp_path: Path,
) -> None:
    some, none = AtMost(Constant(1), Tokens(("Q",))), AtMost(Tokens(("Q",)), Constant(0))

    def said_of(taken: tuple[int, ...], condition: Formula) -> list[bool | int]:
        game = Game(numbers(tmp_path, taken))
        tables = uncoloured(game.net, game)
        assert tables is not None
        said: Said = SimpleQueue()
        found: list[Sought] = []
        for of in "AE":
            f = Op(of, (Op("X", (condition,)),))
            found.append(Sought(len(found), lambda sight: False, followed=follow(tables, f)))
        Play(game, partial(list, found), said, time.monotonic() + LONG_S).play(1, is_even=False)
        return [said.get().value for _ in range(said.qsize())]  # type: ignore[union-attr]

    assert said_of((1, 2), some) == [True, True]
    assert said_of((0, 1), some) == [True]  # E X; of A X nothing is known
    assert said_of((0, 1), none) == [False]  # A X


def test_a_game_in_which_a_step_may_still_be_searched_for_is_not_used_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    games: list[Game] = []

    def answers(*_: Any, game: Game, **__: Any) -> Iterator[Any]:
        games.append(game)
        return iter(())

    def unfolded(net: FlatNet) -> Tables | None:
        raise TooLargeError("more than 3 places")

    monkeypatch.setattr(asking, "answers", answers)
    made = Asking(
        tmp_path, "ReachabilityDeadlock", tmp_path, Deadline.after(LONG_S), mebibytes=64, only="", say=print
    )  # fmt: skip
    lines = list(made.of_net(numbers(tmp_path), unfolded))
    assert lines == ["FORMULA ReachabilityDeadlock CANNOT_COMPUTE"]
    first, second = games
    assert first is not second
