"""The live page for whoever comes too early, and for whoever wants nothing to move by itself."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import uvicorn

from helpers.browser import launched, opened
from helpers.lively import running
from pn2code.live.app import Stopping, application
from pn2code.live.hall import Hall
from pn2code.replay.served import Served
from pn2code.web.serving import listening

PARTS = "live.page.run.cell.parts.length > 0 && live.page.clock.isLive && live.page.clock.t === live.page.clock.end"


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """The browser of this file."""
    with launched() as found:
        yield found


def test_who_comes_too_early_keeps_the_token(chromium: Any) -> None:
    """The page that says that the cell is being built comes again by itself, also where a token stands behind `#`."""
    made: list[Served] = []
    inner = application(lambda: made[0] if made else None, Hall(), Stopping("", lambda: None))
    with listening(0) as (on, port):
        server = uvicorn.Server(uvicorn.Config(inner, lifespan="off", log_config=None))
        serving = threading.Thread(
            target=lambda: asyncio.run(server.serve(sockets=[on])), daemon=True
        )
        serving.start()
        with opened(chromium) as browser:
            page = browser.page
            page.goto(f"http://127.0.0.1:{port}/#act=token")
            page.get_by_text("The cell is being built.").wait_for()
            made.append(Served("<!DOCTYPE html><p>Here it is.</p>", "default-src 'none'"))
            page.get_by_text("Here it is.").wait_for()
            assert browser.ask("() => location.hash") == "#act=token"
        server.should_exit = True
        serving.join()


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
