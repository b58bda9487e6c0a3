"""What is told is kept for pages that come later, and each page gets what it does not have."""

from __future__ import annotations

import asyncio
import json

from pn2code.live.hall import Hall


def told(hall: Hall, at: int) -> tuple[list[int], int]:
    async def ask() -> tuple[list[str], int]:
        hall.attach()
        return await hall.after(at)

    rows, now = asyncio.run(ask())
    return [json.loads(row)["n"] for row in rows], now


def test_a_page_gets_what_it_lacks() -> None:
    hall = Hall()
    for n in range(5):
        hall.tell({"n": n})
    assert told(hall, 0) == ([0, 1, 2, 3, 4], 5)
    assert told(hall, 3) == ([3, 4], 5)
    hall.end()
    assert told(hall, 5) == ([], 5)


def test_a_page_waits_for_more() -> None:
    async def both() -> list[str]:
        hall = Hall()
        hall.attach()
        waiting = [asyncio.create_task(hall.after(0)) for _ in range(10)]
        await asyncio.sleep(0)
        await asyncio.to_thread(hall.tell, {"n": 7})
        return [(await w)[0][0] for w in waiting]

    assert [json.loads(text)["n"] for text in asyncio.run(both())] == [7] * 10


def test_too_much_is_told_anew() -> None:
    hall = Hall(most_bytes=100)
    assert not hall.tell({"n": 0, "fresh": True})
    assert hall.tell({"n": 1, "text": "x" * 100})
    assert not hall.tell({"n": 2, "fresh": True})
    assert told(hall, 0) == ([2], 3)
    assert told(hall, 2) == ([2], 3)
    assert not hall.tell({"n": 3})
    assert told(hall, 3) == ([3], 4)


def test_texts_that_cannot_be_written_do_no_harm() -> None:
    hall = Hall()
    hall.tell({"n": 1, "text": "\ud800 <script>"})
    assert told(hall, 0) == ([1], 1)
