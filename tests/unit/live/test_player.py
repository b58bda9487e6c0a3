"""A function that pulls lines is given them one by one."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from pn2code.live.player import Player


def test_a_line_has_been_dealt_with_when_it_was_given() -> None:
    seen: list[str] = []

    def work(lines: Iterator[str]) -> str:
        for line in lines:
            seen.append(line)
            if line == "end":
                return "ended"
        return "no more"

    with Player(work) as player:
        assert player.play("a") is None and seen == ["a"]
        assert player.play("end") == "ended" and player.play("b") == "ended"
        assert seen == ["a", "end"]


def test_what_goes_wrong_is_raised() -> None:
    def work(lines: Iterator[str]) -> None:
        raise ValueError(next(lines))

    with Player(work) as player, pytest.raises(ValueError, match="this"):
        player.play("this")
