"""A page that asks without reading the answers is parted from; it does not fill the memory."""

from __future__ import annotations

import asyncio
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace
from typing import Any

import pytest

from pn2code.play import app


class Deaf:
    """A page that says nonsense for ever, and hears its first message only."""

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


def test_a_page_that_does_not_read_is_parted_from(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(app, "MOST_LETTERS", 50)
    page = Deaf()
    with ThreadPoolExecutor(1) as worker:
        view = SimpleNamespace(state=dict)
        player = SimpleNamespace(again=lambda: None, view=view)
        seat: Any = SimpleNamespace(player=player, worker=worker, name="seat")
        hall = app._Hall(SimpleNamespace())  # type: ignore[arg-type]
        asyncio.run(hall._at(page, seat, True))  # type: ignore[arg-type]
    assert page.closed == 1008 and page.said < 100
