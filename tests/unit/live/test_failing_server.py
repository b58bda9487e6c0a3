"""A mistake in the live view does not look like the end of the run, and does not take its Stop button away."""

from __future__ import annotations

import asyncio
import os
import pickle
import threading
from collections.abc import Iterator
from typing import Any

import pytest

from pn2code.live.handing import Handing
from pn2code.live.server import Server, Start


def broken() -> Iterator[Any]:
    raise pickle.UnpicklingError("what has come is not whole")
    yield


def test_it_stays_until_the_run_has_ended(capfd: pytest.CaptureFixture[str]) -> None:
    run_has_ended, over = threading.Event(), threading.Event()
    server = Server(Start(1, "t", "s"), broken(), lambda: None, lambda: run_has_ended.wait(600.0))

    async def page() -> list[bool]:
        server.begin(over.set)
        rows, _ = await server.hall.after(0)
        told = [rows == [], server.hall.has_failed, not server.hall.is_over, not over.is_set()]
        run_has_ended.set()
        await server.hall.ended()
        return told

    assert asyncio.run(page()) == [True] * 4
    assert server.hall.is_over
    assert "what has come is not whole" in capfd.readouterr().err


def test_what_is_on_its_way_is_not_cut_off() -> None:
    reading, writing = os.pipe()
    with os.fdopen(reading, "rb"), os.fdopen(writing, "wb", buffering=0) as into:
        handing = Handing(into.fileno())
        handing.give(bytes(3_000_000))
        with pytest.raises(RuntimeError, match="not free"):
            handing.give("the next")
