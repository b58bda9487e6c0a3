"""Fingers on the pages: they turn and move the cell, move and enlarge the net, and take the cursor along."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from helpers import netbuilder
from helpers.browser import Page, launched, opened
from helpers.fingers import PHONE, Fingers, Point
from helpers.played import served
from helpers.shown import PAIR, described, with_arm
from pn2code.replay.page import page as replay_page


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    with launched() as found:
        yield found


@pytest.fixture(scope="module")
def browser(chromium: Any, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    folder = tmp_path_factory.mktemp("touch")
    file = folder / "page.html"
    file.write_text(replay_page(with_arm(described(folder, steps=12))), encoding="utf-8")
    with opened(chromium, **PHONE) as found:
        found.open(file, "#t=4")
        yield found
        assert found.errors == []


def pane(browser: Page, name: str) -> None:
    """Shows it; until what it shows has the size that it has there."""
    browser.ask("name => replay.page.frame.pane(name)", name)
    browser.settled()


def middle(browser: Page, selector: str) -> Point:
    box = browser.page.locator(selector).first.bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


class TestCell:
    """One finger turns, two move and come nearer."""

    LOOK = """() => { const { camera, controls } = replay.page.cell;
        const { position } = camera, { target } = controls;
        return [...position.toArray(), position.distanceTo(target), ...target.toArray()]; }"""

    def test_a_finger_turns_the_view(self, browser: Page) -> None:
        pane(browser, "cell")
        x, y = middle(browser, ".stage canvas")
        before = browser.ask(self.LOOK)
        Fingers(browser).move(((x, y), (x + 90, y + 20)))
        after = browser.ask(self.LOOK)
        assert after[3] == pytest.approx(before[3]) and after[4:] == pytest.approx(before[4:])
        assert abs(after[0] - before[0]) + abs(after[1] - before[1]) > 0.2
        assert browser.ask("() => replay.page.clock.t") == 4, "the arm was not clicked"

    def test_two_fingers_come_nearer_and_move(self, browser: Page) -> None:
        x, y = middle(browser, ".stage canvas")
        before = browser.ask(self.LOOK)
        Fingers(browser).move(((x - 30, y), (x - 90, y)), ((x + 30, y), (x + 90, y)))
        near = browser.ask(self.LOOK)
        assert near[3] < 0.6 * before[3]
        Fingers(browser).move(((x - 30, y), (x - 30, y + 80)), ((x + 30, y), (x + 30, y + 80)))
        moved = browser.ask(self.LOOK)
        assert moved[3] == pytest.approx(near[3], rel=0.1)
        assert sum(abs(a - b) for a, b in zip(moved[4:], near[4:], strict=True)) > 0.03 * near[3]


class TestNet:
    """One finger moves the page, two enlarge it; whoever taps a transition goes to its next occurrence."""

    VIEW = "() => replay.page.net.window.view"

    def test_fingers_move_and_enlarge_it(self, browser: Page) -> None:
        pane(browser, "net")
        x, y = middle(browser, "#net .sheet")
        at = "([x, y]) => { const p = replay.page.net.window.point({clientX: x, clientY: y}); return [p.x, p.y]; }"
        before, held = browser.ask(self.VIEW), browser.ask(at, [x, y])
        Fingers(browser).move(((x, y), (x + 60, y - 40)))
        view = browser.ask(self.VIEW)
        assert view[2:] == pytest.approx(before[2:])
        assert browser.ask(at, [x + 60, y - 40]) == pytest.approx(held, abs=0.5), (
            "it stays under the finger"
        )
        Fingers(browser).move(((x - 40, y), (x - 100, y + 30)), ((x + 40, y), (x + 100, y + 30)))
        near = browser.ask(self.VIEW)
        assert near[2] == pytest.approx(view[2] * 80 / 200, rel=0.12)
        browser.page.get_by_role("button", name="Fit").tap()
        browser.wait("replay.page.net.window.isFitted")

    def test_a_tap_is_a_click(self, browser: Page) -> None:
        browser.ask("() => (replay.seek(4), replay.page.net.pin(1))")
        node = browser.ask(
            "() => { const n = replay.page.net; return n.net.transitions.find((t) => t.instance === n.current).id; }"
        )
        browser.page.locator(f"#net [data-id='{node}']").first.tap()
        browser.wait("replay.page.net.net.transitions[replay.page.transition]?.instance === 1")
        chosen = "() => replay.page.net.net.transitions[replay.page.transition].id"
        assert browser.ask(chosen) == node


def test_keys_choose_after_a_finger_has_moved_the_page(browser: Page) -> None:
    pane(browser, "net")
    browser.ask("() => replay.page.net.pin(1)")
    x, y = middle(browser, "#net .sheet")
    Fingers(browser).move(((x, y), (x + 20, y)))
    browser.ask("() => void (replay.page.transition = -1)")
    t = browser.ask("""() => {
      const { net: { transitions }, current } = replay.page.net;
      const t = transitions.findIndex((t) => t.instance === current);
      document.querySelector(`#net [data-id='${transitions[t].id}']`).focus();
      return t;
    }""")
    browser.page.keyboard.press("Enter")
    assert browser.ask("() => replay.page.transition") == t


def test_a_finger_takes_the_cursor_along(browser: Page) -> None:
    pane(browser, "timeline")
    box = browser.page.locator("#timeline canvas").first.bounding_box()
    y = box["y"] + 60
    x = "t => replay.page.timeline.x(t)"
    [a, b] = [box["x"] + browser.ask(x, t) for t in (3.0, 9.0)]
    Fingers(browser).move(((a, y), (b, y)))
    assert browser.ask("() => replay.page.clock.t") == pytest.approx(9.0, abs=0.2)
    Fingers(browser).move(((a, y), (a - 40, y)), ((b, y), (b + 40, y)))
    window = browser.ask("() => [replay.page.timeline.from, replay.page.timeline.to]")
    assert 0 < window[0] < window[1] < 12
    assert browser.ask("() => replay.page.timeline.fingers.size") == 0
    browser.ask("() => replay.page.timeline.whole()")


def test_a_finger_that_rests_lists_the_bindings(chromium: Any, tmp_path: Path) -> None:
    net = netbuilder.write(PAIR, tmp_path / "net.cpn")
    with served(net) as server, opened(chromium, **PHONE) as browser:
        browser.page.goto(server.url)
        browser.page.wait_for_selector("body[data-ready=true]")
        browser.ask("() => play.page.net.pin(1)")
        at = middle(browser, ".sheet .enabled rect")
        rows = browser.page.get_by_role("list", name="Enabled bindings").locator("li")
        with Fingers(browser).resting(at):
            rows.first.wait_for()
        assert browser.ask("() => play.page.position.state.length") == 0, "it did not occur"
        rows.first.get_by_role("button").tap()
        browser.wait("play.page.position.state.length === 1")
        assert browser.errors == []
