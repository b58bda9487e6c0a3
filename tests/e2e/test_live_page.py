"""The live page in a browser: it shows what happens, and that it no longer does; names are only texts."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from helpers.browser import launched, opened
from helpers.legible import complaints
from helpers.lively import HOSTILE, endless, hostile, running

LINES = """(selector) => {
    const range = document.createRange();
    range.selectNodeContents(document.querySelector(selector));
    const tops = [...range.getClientRects()].map((r) => r.top);
    return 1 + Math.round((Math.max(...tops) - Math.min(...tops)) / 16);
}"""
"""In how many lines the text of the first such element stands."""


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """The browser of this file."""
    with launched() as found:
        yield found


def test_a_run_is_seen_and_stopped(root: Path, chromium: Any, tmp_path: Path) -> None:
    cell = hostile(endless(root / "examples/minimal", tmp_path / "endless"), tmp_path / "cell")
    with running(cell, tmp_path / "run", "--speed", "0.15") as run, opened(chromium) as browser:
        page = browser.page
        page.goto(run.url)
        page.wait_for_selector("body[data-ready=true]")
        # It moves with the run: time, arms, steps, states.
        browser.wait("live.page.clock.t > 0.3 && live.page.clock.isLive")
        before = browser.ask("() => live.tcp(0, live.page.clock.t)")
        browser.wait(
            f"JSON.stringify(live.tcp(0, live.page.clock.t)) !== {json.dumps(json.dumps(before))}"
        )
        browser.wait("live.page.clock.k >= 2 && live.page.clock.isLive")
        at_two = browser.ask("() => (live.step(2), live.marking())")
        assert dict(at_two)["Cell.Robot.Told"] == "1`1"
        page.get_by_role("row", name="robot works joint").wait_for()
        assert HOSTILE in page.locator(".sheet").text_content() + browser.ask(
            "() => JSON.stringify(live.page.run.net.transitions.map(t => t.name))"
        )
        assert page.locator("img").count() == 0
        # On a phone as well: no word is cut in two.
        page.set_viewport_size({"width": 340, "height": 700})
        page.get_by_role("button", name="More", exact=True).click()
        page.get_by_role("tab", name="State", exact=True).click()
        lines = [browser.ask(LINES, words) for words in ("#live", ".state .sides th")]
        assert lines == [1, 1]
        ends = browser.ask(
            "() => [...document.querySelectorAll('#top > *')].map((n) => n.getBoundingClientRect().right)"
        )
        assert max(ends) <= 340, "nothing of the head is cut off"
        page.set_viewport_size({"width": 1280, "height": 720})
        # Back in time, and to what happens now.
        browser.ask("() => live.seek(0.1)")
        assert page.get_by_role("button", name="Live").get_attribute("aria-pressed") == "false"
        page.get_by_role("button", name="Live").click()
        browser.wait("live.page.clock.isLive && live.page.clock.t > 0.3")
        # The connection goes and comes.
        browser.listen("#said")
        steps = browser.ask("() => (live.link.socket.close(), live.page.course.steps)")
        browser.hear("The connection is lost")
        page.get_by_text("The connection is lost").wait_for(state="hidden")
        assert browser.ask("() => live.page.course.steps") >= steps
        # Only with the token of the terminal the cell stops.
        for token, said in (
            ("wrong", "this is not the token"),
            (run.stop_token, "The run has ended"),
        ):
            page.get_by_role("button", name="Stop", exact=True).click()
            page.get_by_label("Token").fill(token)
            page.get_by_role("button", name="Stop the cell").click()
            page.get_by_text(said).wait_for()
            browser.ask("() => (document.documentElement.dataset.theme = 'dark')")
            assert [c for c in complaints(browser) if "said" in c] == []
        page.locator("#verdict .chip", has_text="stopped").wait_for()
        assert (
            page.get_by_role("list", name="Alarms").get_by_text("stopped by the live page").count()
            == 1
        )
        # What it showed is what the trace says.
        assert run.wait()[0] == 1
        lines = (run.out / "cell.trace.jsonl").read_text(encoding="utf-8").splitlines()
        assert browser.ask("() => live.page.course.steps") == sum(
            '"transition"' in x for x in lines
        )
        assert browser.errors == [] and browser.dialogues == []


def test_the_address_with_the_token_stops_at_once(
    root: Path, chromium: Any, tmp_path: Path
) -> None:
    cell = endless(root / "examples/minimal", tmp_path / "cell")
    with (
        running(cell, tmp_path / "run", "--speed", "0.1") as run,
        opened(chromium) as browser,
    ):
        page = browser.page
        page.goto(f"{run.url}#stop={run.stop_token}")
        page.wait_for_selector("body[data-ready=true]")
        assert run.stop_token not in browser.ask("() => location.href")
        assert all(run.stop_token not in asked for asked in browser.asked)
        page.get_by_role("button", name="Stop", exact=True).click()
        page.get_by_text("The run has ended: stopped").wait_for()
        assert run.wait()[0] == 1
        assert browser.errors == []
