"""What takes long and says nothing by itself is told once a second."""

from __future__ import annotations

import threading

import pytest

from pn2code.base.ticking import Ticking


def test_it_tells_while_the_block_lasts() -> None:
    said: list[str] = []
    enough = threading.Event()

    def say(text: str) -> None:
        said.append(text)
        if len(said) == 3:
            enough.set()

    with Ticking(say, "verification", 0.001):
        assert enough.wait(600)
    count = len(said)
    assert set(said) == {"verification: 0 s"}
    assert len(said) == count and threading.active_count() == 1


def test_what_ends_at_once_says_nothing_and_errors_end_it() -> None:
    said: list[str] = []
    with pytest.raises(KeyError), Ticking(said.append, "run", 10.0):
        raise KeyError
    assert said == []


def test_it_turns_to_something_else() -> None:
    said: list[str] = []
    enough = threading.Event()

    def say(text: str) -> None:
        said.append(text)
        if text.startswith("siphons"):
            enough.set()

    with Ticking(say, "reading the net", 0.001) as ticking:
        ticking.turn_to("siphons (5 of 7)")
        assert enough.wait(20)
    assert said[-1] == "siphons (5 of 7): 0 s"
