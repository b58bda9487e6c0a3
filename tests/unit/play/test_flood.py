"""A page that asks without reading the answers is parted from; it does not fill the memory."""

from __future__ import annotations

import asyncio
import json
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace
from typing import Any

import pytest

from helpers.played import PATIENCE_S
from pn2code.play import app, letters
from pn2code.trace.json_text import is_deep


class Deaf:
    """A page that says nonsense for ever, and hears its first message only."""

    seat: Any

    def __init__(self) -> None:
        self.said = self.heard = 0
        self.closed = 0

    async def send_text(self, text: str) -> None:
        self.heard += 1
        if self.heard > 1:
            await asyncio.Event().wait()

    async def receive_text(self) -> str:
        self.said += 1
        assert self.said < 1000, "it goes on"
        await asyncio.sleep(0)
        return "nonsense"

    async def close(self, code: int) -> None:
        self.closed = code


def meet(page: Deaf) -> None:
    """The page comes, and is there until it is parted from."""
    with ThreadPoolExecutor(1) as worker:
        player = SimpleNamespace(again=dict)
        page.seat = SimpleNamespace(player=player, worker=worker, name="seat")
        hall = app._Hall(SimpleNamespace(), None)  # type: ignore[arg-type]
        there = hall._at(page, page.seat, True)  # type: ignore[arg-type]
        asyncio.run(asyncio.wait_for(there, PATIENCE_S))


@pytest.mark.parametrize(("name", "most"), [("MOST_LETTERS", 50), ("MOST_CHARACTERS", 3000)])
def test_a_page_that_does_not_read_is_parted_from(
    monkeypatch: pytest.MonkeyPatch, name: str, most: int
) -> None:
    monkeypatch.setattr(letters, name, most)
    page = Deaf()
    meet(page)
    assert page.closed == 1008 and page.said < 100


def test_what_was_read_does_not_count() -> None:
    async def spoken() -> int:
        page = letters.Letters(asyncio.get_running_loop())
        for _ in range(40):
            page.put({"text": "x" * (letters.MOST_CHARACTERS // 20)})
            await page.next()
        assert not page.over.is_set()
        for _ in range(40):
            page.put({"text": "x" * (letters.MOST_CHARACTERS // 20)})
        await asyncio.wait_for(page.over.wait(), PATIENCE_S)
        return page._waiting.qsize()

    assert asyncio.run(spoken()) < 20


def test_a_page_that_only_waits_is_parted_from_as_well(monkeypatch: pytest.MonkeyPatch) -> None:
    class Silent(Deaf):
        async def receive_text(self) -> str:
            self.said += 1
            if self.said > 1:
                self.seat.tell({"text": "x" * 5000})  # alone it may be long
                self.seat.tell({"text": "x"})
                await asyncio.Event().wait()
            return "nonsense"

    monkeypatch.setattr(letters, "MOST_CHARACTERS", 3000)
    page = Silent()
    meet(page)
    assert page.closed == 1008


def test_deep_messages_are_told_from_long_ones() -> None:
    assert is_deep('{"do": ' + "[" * 60_000)
    long = json.dumps({"do": "edit", "text": '["{' * 60_000})
    assert not is_deep(long)
