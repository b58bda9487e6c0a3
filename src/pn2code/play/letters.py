"""What a page is to be told and has not read yet.

letters = Letters(asyncio.get_running_loop())
letters.put({"id": 3, "ok": True})      # from any thread
text = await letters.next()
await letters.over.wait()                # the page asks, and does not read: it is to be parted from
"""

from __future__ import annotations

import asyncio
import threading

from pn2code.base.page_json import page_json
from pn2code.play.trouble import Json

MOST_LETTERS = 10_000
MOST_CHARACTERS = 64 << 20
"""Of all together; one answer has up to two millions, and a single one may be of any length."""


class Letters:
    """They are texts already, so that one knows how large they are.

    Args:
        loop: in which they are sent.

    Attributes:
        over: set when there are too many; further ones are dropped.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._waiting: asyncio.Queue[str] = asyncio.Queue()
        self._lock = threading.Lock()
        self._count = self._characters = 0
        self._is_over = False
        self.over = asyncio.Event()

    def put(self, said: Json) -> None:
        """One more."""
        text = page_json(said)
        with self._lock:
            if self._is_over:
                return
            self._count += 1
            self._characters += len(text)
            is_long = self._characters > MOST_CHARACTERS and self._count > 1
            self._is_over = is_long or self._count > MOST_LETTERS
            if self._is_over:
                self._loop.call_soon_threadsafe(self.over.set)
            else:
                self._loop.call_soon_threadsafe(self._waiting.put_nowait, text)

    async def next(self) -> str:
        """The oldest one, which is no longer there then."""
        text = await self._waiting.get()
        with self._lock:
            self._count -= 1
            self._characters -= len(text)
        return text
