"""Only who has the token stops the cell."""

from __future__ import annotations

import pytest

from pn2code.live.app import Stopping


@pytest.mark.parametrize("token", ["", "x", "secre", "secret ", None, 7, ["secret"], "\ud800"])
def test_another_token_stops_nothing(token: object) -> None:
    done: list[int] = []
    assert not Stopping("secret", lambda: done.append(1)).ask(token)
    assert not done


def test_the_token_stops_once() -> None:
    done: list[int] = []
    stopping = Stopping("secret", lambda: done.append(1))
    assert stopping.ask("secret") and stopping.ask("secret")
    assert done == [1]


def test_without_a_token_nobody_stops_it() -> None:
    assert not Stopping("", lambda: None).ask("")
