"""All that has been told, for pages that come when they like, and the pages that wait for more.

    hall = Hall()
    hall.tell({"t": 0.05, ...})                    # from any thread
    text, at = await hall.after(0)                  # for a page: all updates after the first 0

An update is written once, for all pages. A page gets what it does not have yet, however much that is: one that is slow
gets more at a time, and nobody waits for it. When all of it becomes too much to be kept, the run is told anew, from
where it is (an update that is `fresh`), and what came before is forgotten.
"""

from __future__ import annotations

import asyncio
import threading
from typing import Any

from pn2code.base.page_json import page_json

Json = dict[str, Any]

MOST_BYTES = 128 << 20
"""Of all updates together: a day or so, of some hundred bytes each."""
AT_ONCE = 4 << 20
"""Bytes of updates in a message, about."""


class Hall:
    """Keeps updates as texts.

    Attributes:
        is_over: there will be no more.
        pages: that are open now.
        has_failed: there will be no more, though the run goes on.
        is_leaving: the server ends, whatever the run does: who waits for its page is not kept waiting.
    """

    def __init__(self, most_bytes: int = MOST_BYTES) -> None:
        self._texts: list[str] = []
        self._forgotten = 0
        self._most = most_bytes
        self._bytes = 0
        self._lock = threading.Lock()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._more: asyncio.Event | None = None
        self.is_over = False
        self.has_failed = False
        self.is_leaving = False
        self.pages = 0

    def attach(self) -> None:
        """From the event loop: from now on pages can wait."""
        self._loop = asyncio.get_running_loop()
        self._more = asyncio.Event()

    def tell(self, update: Json) -> bool:
        """One more update; whether the run must be told anew with the next one."""
        text = page_json(update)
        with self._lock:
            if update.get("fresh"):
                self._forgotten += len(self._texts)
                self._texts, self._bytes = [], 0
            self._texts.append(text)
            self._bytes += len(text)
        self._wake()
        return self._bytes > self._most

    def end(self) -> None:
        """There is no more."""
        self.is_over = True
        self._wake()

    def fail(self) -> None:
        """There is no more, because of a mistake here: pages say so, and can still stop the run."""
        self.has_failed = True
        self._wake()

    def leave(self) -> None:
        """The server ends; pages that are open see that their connection does."""
        self.is_leaving = True

    async def ended(self) -> None:
        """Waits until it is over."""
        while not self.is_over:
            await self._news()

    def _wake(self) -> None:
        loop, more = self._loop, self._more
        if loop is not None and more is not None and not loop.is_closed():
            loop.call_soon_threadsafe(more.set)

    async def after(self, at: int) -> tuple[list[str], int]:
        """What comes after so many updates, as soon as there is something; nothing when there will be no more."""
        while not (found := self._rows(at))[0] and not (self.is_over or self.has_failed):
            await self._news()
        return found

    async def _news(self) -> None:
        more = self._more
        assert more is not None
        await more.wait()
        if more is self._more:
            self._more = asyncio.Event()

    def _rows(self, at: int) -> tuple[list[str], int]:
        rows, size = [], 0
        with self._lock:
            for text in self._texts[max(at - self._forgotten, 0) :]:
                if size > AT_ONCE:
                    break
                rows.append(text)
                size += len(text)
            return rows, max(at, self._forgotten) + len(rows)
