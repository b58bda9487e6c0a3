"""Handing things over never waits, and whoever is given them gets whole ones."""

from __future__ import annotations

import os
import threading
from typing import Any

import pytest

from pn2code.live.handing import Handing, taken


@pytest.fixture
def pipe() -> Any:
    reading, writing = os.pipe()
    with os.fdopen(reading, "rb") as stream, os.fdopen(writing, "wb", buffering=0) as into:
        yield stream, into


def test_things_arrive_as_they_were(pipe: Any) -> None:
    stream, into = pipe
    handing = Handing(into.fileno())
    handing.give({"t": 1.5})
    assert handing.is_free()
    assert taken(stream) == {"t": 1.5}


def test_a_reader_that_does_not_read_delays_nobody(pipe: Any) -> None:
    stream, into = pipe
    handing = Handing(into.fileno())
    large = bytes(3_000_000)
    handing.give(large)  # much more than a pipe holds: comes back at once
    assert not handing.is_free()
    assert not handing.finish(0.05)
    found: list[Any] = []
    reader = threading.Thread(target=lambda: found.append(taken(stream)))
    reader.start()
    assert handing.finish(600.0)
    reader.join()
    assert found == [large]
    assert handing.is_free()


def test_a_reader_that_has_gone_is_noticed(pipe: Any) -> None:
    stream, into = pipe
    handing = Handing(into.fileno())
    stream.close()
    handing.give("nobody hears this")
    assert handing.is_broken and not handing.is_free()
    assert not handing.finish(600.0)


def test_what_is_cut_off_is_nothing(pipe: Any) -> None:
    stream, into = pipe
    Handing(into.fileno()).give("whole")
    os.write(into.fileno(), b"\x09\0\0\0\0\0\0\0half")
    into.close()
    assert taken(stream) == "whole"
    assert taken(stream) is None
