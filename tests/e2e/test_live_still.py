"""The live page for whoever wants nothing to move by itself."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from helpers.browser import launched, opened
from helpers.lively import running

PARTS = "live.page.run.cell.parts.length > 0 && live.page.clock.isLive && live.page.clock.t === live.page.clock.end"


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """The browser of this file."""
    with launched() as found:
        yield found


def test_parts_come_into_the_cell(root: Path, chromium: Any, tmp_path: Path) -> None:
    """A part has its object in the picture before anybody looks where it is."""
    with (
        running(root / "examples/machining", tmp_path / "run", "--speed", "0.4") as run,
        opened(chromium) as browser,
    ):
        page = browser.page
        page.emulate_media(reduced_motion="reduce")
        page.goto(run.url)
        page.wait_for_selector("body[data-ready=true]")
        browser.wait(PARTS)
        steps = browser.ask("() => live.page.course.steps")
        browser.wait(f"live.page.course.steps > {steps} && live.page.clock.k > {steps}")
        browser.ask(f"() => live.link.stop({json.dumps(run.stop_token)})")
        assert run.wait()[0] == 1
        assert browser.errors == []
