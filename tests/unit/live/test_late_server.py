"""A server that takes its time to read what will run is told everything once it has read it."""

from __future__ import annotations

import os
import threading
from types import SimpleNamespace
from typing import Any

import pytest

from pn2code.live import view
from pn2code.live.handing import Handing, taken
from pn2code.live.server import Cell
from pn2code.live.view import LiveView


def test_it_is_told_after_all(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(view, "_BUILDING_S", 0.01)
    monkeypatch.setattr(view, "read", lambda *_, **__: object())
    # More than a pipe holds.
    monkeypatch.setattr(view, "describe", lambda *_: {"text": "x" * 1_000_000})
    reading, writing = os.pipe()
    live = LiveView.__new__(LiveView)
    live._speed, live._tap, live._hand = 1.0, None, None
    live._handing = Handing(writing)
    robot_cell: Any = SimpleNamespace(robots=(), scene=SimpleNamespace(warning_clearance=0.02))
    partition: Any = SimpleNamespace(net=SimpleNamespace(file="a.cpn"))
    config: Any = SimpleNamespace(report=SimpleNamespace(count={}))
    generated: Any = SimpleNamespace(partition=partition)
    live.ready(
        SimpleNamespace(generated=generated, config=config, robot_cell=robot_cell)  # type: ignore[arg-type]
    )
    tap = live._tap
    assert tap is not None, "whatever happens is to be told"
    got: list[Any] = []
    with os.fdopen(reading, "rb") as stream:
        late = threading.Thread(target=lambda: got.extend([taken(stream), taken(stream)]))
        late.start()
        assert live._handing.finish(600.0)
        live._handing.give({"t": 1.0})
        assert live._handing.finish(600.0)
        late.join()
    os.close(writing)
    assert isinstance(got[0], Cell) and got[1] == {"t": 1.0}
