"""The time axis of the replay page: rows that fold, its height, what it says of long, short and odd runs."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from helpers.browser import Page, launched, opened
from helpers.fingers import PHONE
from helpers.legible import complaints
from helpers.shown import PAIR, described, with_arm
from pn2code.replay.arrays import packed_reals
from pn2code.replay.page import page

_SEEN = """() => {
  const { host, lanes, curves, below } = replay.page.timeline;
  const { y, height } = curves[curves.length - 1];
  const lowest = host.scrollTop + host.clientHeight - y - height;
  return { lowest, below: below.hidden ? "" : below.textContent, hash: location.hash,
           lanes: lanes.map((lane) => lane.height), curves: curves.map((chart) => chart.height) };
}"""

_NOTING = """
  window.labels = [];
  window.places = [];
  const own = CanvasRenderingContext2D.prototype.fillText;
  CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) {
    labels.push(text);
    if (this.textAlign === "left") places.push([text, ...rest, this.measureText(text).width]);
    return own.call(this, text, ...rest);
  };
"""
"""Keeps what is written on canvases, and where."""


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """The browser of this file."""
    with launched() as found:
        yield found


def of_arms(folder: Path, arms: int) -> Path:
    """The page of a run of so many arms, with all curves."""
    run = with_arm(described(folder, PAIR))
    names = [f"robot{k}" for k in range(1, arms + 1)]
    run["happenings"]["parties"] += [{"name": name, "kind": "robot"} for name in names[1:]]
    of = {
        "clearance": [
            "robots",
            *(f"{what}.{name}" for what in ("scene", "self") for name in names),
        ],
        "condition": names,
    }
    run["happenings"]["curves"] = [
        {"kind": kind, "of": name, "limit": 0.02 if kind == "clearance" else 50.0}
        | {"t": packed_reals([0.0, 9.0], double=True), "v": packed_reals([1.0, 2.0])}
        for kind, names in of.items()
        for name in names
    ]
    return written(folder, run)


def written(folder: Path, run: dict[str, Any]) -> Path:
    file = folder / "replay.html"
    file.write_text(page(run), encoding="utf-8")
    return file


def seen(browser: Page) -> dict[str, Any]:
    browser.settled()
    found: dict[str, Any] = browser.ask(_SEEN)
    return found


def test_all_of_three_arms_is_seen_at_once(tmp_path: Path, chromium: Any) -> None:
    """Lanes, clearance and conditioning, at 1280 x 720, beside the messages."""
    with opened(chromium) as browser:
        browser.open(of_arms(tmp_path, 3))
        found = seen(browser)
        assert found["lowest"] >= 0 and not found["below"]


@pytest.mark.parametrize("arms", [2, 3])
def test_names_of_curves_keep_off_each_other(arms: int, tmp_path: Path, chromium: Any) -> None:
    """At 1280 x 720; a line of letters needs 13 pixels, and of two arms the lines were eleven apart."""
    with opened(chromium) as browser:
        browser.page.add_init_script(_NOTING)
        browser.open(of_arms(tmp_path, arms))
        browser.settled()
        browser.ask(
            "() => { places.length = 0; const { timeline } = replay.page; timeline.drawn = ''; timeline.paint(); }"
        )
        browser.wait("places.length > 0")
        left = browser.ask("() => replay.page.timeline.left")
        names = [place for place in browser.ask("() => places") if place[1] < left]
        assert {"robots", "conditioning", f"robot{arms}"} <= {text for text, *_ in names}
        for text, x, y, width in names:
            for other, x2, y2, width2 in names:
                if (text, x, y) != (other, x2, y2) and x < x2 + width2 and x2 < x + width:
                    assert abs(y - y2) >= 13, (text, other)


def test_rows_fold_by_keys_and_the_address_keeps_it(tmp_path: Path, chromium: Any) -> None:
    with opened(chromium) as browser:
        file = of_arms(tmp_path, 6)
        browser.open(file, "#t=2")
        before = seen(browser)
        assert before["lowest"] < 0 and before["below"].endswith("conditioning")
        # One stop of Tab behind the axis, up and down from row to row; the arrows of the page do not move meanwhile.
        keys = browser.page.keyboard
        browser.page.locator("#timeline canvas").first.focus()
        keys.press("Tab")
        focused = "() => document.activeElement.getAttribute('aria-label')"
        assert browser.ask(focused) == "all lanes"
        keys.press("Enter")
        folded = seen(browser)
        assert folded["lowest"] > before["lowest"]
        assert sum(folded["lanes"]) < 0.7 * sum(before["lanes"])
        row = browser.page.get_by_role("toolbar", name="Rows of the time axis")
        assert row.locator("[aria-expanded=false]").count() == 8
        for _ in range(8):
            keys.press("ArrowDown")
        assert browser.ask(focused) == "clearance [mm]"
        keys.press(" ")
        assert not browser.ask("() => replay.page.clock.isPlaying")
        found = seen(browser)
        assert found["lowest"] >= 0 and not found["below"]
        assert found["curves"][0] < 20 < found["curves"][1]
        keys.press("ArrowUp")
        assert browser.ask(focused) == "robot6"
        keys.press("Enter")
        browser.wait("location.hash === '#t=2&fold=0,1,2,3,4,5,clearance'")
        wanted = seen(browser)
        browser.open(file, wanted["hash"])
        assert seen(browser)["lanes"] == wanted["lanes"]
        browser.page.evaluate("() => { location.hash = '#t=3&fold=condition,nothing' }")
        browser.wait("replay.page.clock.t === 3")
        found = seen(browser)
        assert len(set(found["lanes"])) == 1 and found["curves"][1] < 20
        assert complaints(browser) == []
        assert browser.errors == []


def test_the_time_can_have_more_of_the_height(tmp_path: Path, chromium: Any) -> None:
    with opened(chromium) as browser:
        file = of_arms(tmp_path, 6)
        browser.open(file)
        divider = browser.page.get_by_role("separator", name="Height of the time axis")
        assert 35 <= int(divider.get_attribute("aria-valuenow") or "") <= 42
        divider.focus()
        for _ in range(4):
            browser.page.keyboard.press("ArrowUp")
        assert seen(browser)["lowest"] >= 0
        now = int(divider.get_attribute("aria-valuenow") or "")
        browser.wait("location.hash.includes('height=')")
        browser.open(file, seen(browser)["hash"])
        assert seen(browser)["lowest"] >= 0
        box = divider.bounding_box()
        mouse = browser.page.mouse
        mouse.move(box["x"] + 300, box["y"] + 4)
        mouse.down()
        mouse.move(box["x"] + 300, box["y"] + 104)
        mouse.up()
        browser.settled()
        assert 10 < now - int(divider.get_attribute("aria-valuenow") or "") < 20
        mouse.dblclick(box["x"] + 300, box["y"] + 104)
        browser.wait("!location.hash.includes('height')")
        assert seen(browser)["lowest"] < 0
        assert browser.errors == []


def test_rows_fold_under_a_finger(tmp_path: Path, chromium: Any) -> None:
    with opened(chromium, **PHONE) as browser:
        browser.open(of_arms(tmp_path, 6))
        browser.page.get_by_role("button", name="Time", exact=True).tap()
        browser.page.get_by_role("button", name="robot3").tap()
        browser.settled()
        high = browser.page.get_by_role("button", name="robot3").bounding_box()["height"]
        assert 20 <= high < min(h for i, h in enumerate(seen(browser)["lanes"]) if i != 3)
        assert complaints(browser) == []


@pytest.mark.parametrize("options", [{}, PHONE], ids=["desk", "phone"])
def test_a_day_has_hours_and_room_for_its_digits(
    tmp_path: Path, chromium: Any, options: dict[str, Any]
) -> None:
    with opened(chromium, **options) as browser:
        browser.page.add_init_script(_NOTING)
        browser.open(written(tmp_path, with_arm(described(tmp_path, PAIR), tempo=2880.0)))
        if options:
            browser.page.get_by_role("button", name="Time", exact=True).tap()
        browser.settled()
        labels = browser.ask("() => labels.filter((text) => / (s|h|min)$/.test(text))")
        assert "12 h" in labels and "0 s" in labels and not any(x.endswith("00 s") for x in labels)
        time = browser.page.get_by_role("textbox", name="Moment in seconds")
        time.fill("12:00:00")
        time.press("Enter")
        browser.wait("replay.page.clock.t === 43200")
        assert time.get_attribute("title") == "12:00:00"
        cut = "(e) => e.scrollWidth > e.clientWidth"
        assert time.input_value() == "43200.00" and not time.evaluate(cut)
        if options:
            browser.page.get_by_role("button", name="More", exact=True).tap()
        browser.settled()
        when = browser.page.locator("#panel-messages .rows .when").last
        assert len(when.text_content() or "") == 8 and not when.evaluate(cut)
        assert complaints(browser) == []


def test_runs_of_no_length_have_an_axis(tmp_path: Path, chromium: Any) -> None:
    with opened(chromium) as browser:
        for run in (
            with_arm(described(tmp_path, PAIR), tempo=0.0),
            with_arm(described(tmp_path, PAIR, steps=0)),
            described(tmp_path, PAIR, steps=0),
        ):
            browser.page.add_init_script(_NOTING)
            browser.open(written(tmp_path, run))
            browser.settled()
            labels = browser.ask("() => labels.filter((text) => /^[0-9.]+( s)?$/.test(text))")
            assert labels and {float(text.removesuffix(" s")) for text in labels} == {0.0}
            browser.page.keyboard.press("End")
            browser.settled()
            assert browser.errors == []


_PLAYED = """async (rounds) => {
  const { page } = replay;
  const drawn = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  for (let i = 0; i < rounds; i++) {
    page.clock.seek((i * 7.3) % page.clock.end);
    page.tab(["Messages", "Steps", "Watch", "Run"][i % 4]);
    if (i % 5 === 0) page.timeline.folds.foldAll();
    if (i % 7 === 0) page.frame.dark();
    await drawn();
  }
  page.clock.seek(0);
  page.tab("Run");
  await drawn();
  const { geometries, textures } = page.cell.renderer.info.memory;
  return [geometries, textures, document.querySelectorAll("*").length];
}"""


def test_nothing_is_left_behind_by_moving_about(tmp_path: Path, chromium: Any) -> None:
    """Elements, listeners and shapes after many moments, panels and folds are those of a few."""
    with opened(chromium) as browser:
        browser.open(of_arms(tmp_path, 3))
        devtools = browser.page.context.new_cdp_session(browser.page)
        devtools.send("Performance.enable")

        def kept(rounds: int) -> list[int]:
            seen: list[int] = browser.ask(_PLAYED, rounds)
            devtools.send("HeapProfiler.collectGarbage")
            rows = devtools.send("Performance.getMetrics")["metrics"]
            told = {row["name"]: int(row["value"]) for row in rows}
            return [*seen, told["Nodes"], told["JSEventListeners"]]

        before, after = kept(20), kept(80)
        assert after[:2] == before[:2]
        # Lists fill up a little later, so the numbers differ a little; what stays of each move would be 60 more.
        assert all(late <= early + 40 for early, late in zip(before[2:], after[2:], strict=True))
        assert browser.errors == []
