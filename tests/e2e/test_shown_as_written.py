"""What the replay page shows is what it says: the end that is typed as it is shown, the name of each curve."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from helpers.browser import launched, opened
from helpers.shown import described, with_arm
from pn2code.replay.page import page


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """The browser of this file."""
    with launched() as found:
        yield found


@pytest.mark.parametrize(("tempo", "typed"), [(1.00013, "30.00"), (1.00013, "30"), (0.9999, "30")])
def test_the_end_typed_as_it_is_shown_is_the_end(
    tempo: float, typed: str, tmp_path: Path, chromium: Any
) -> None:
    """At 30.0039 s (shown: 30.00) the last of 30 steps occurs: 30.00 s is just before it."""
    file = tmp_path / "replay.html"
    file.write_text(page(with_arm(described(tmp_path), tempo)), encoding="utf-8")
    with opened(chromium) as browser:
        browser.open(file)
        field = browser.page.get_by_label("Moment in seconds")
        assert browser.page.locator(".clock").inner_text().strip().endswith("/ 30.00 s")
        field.fill(typed)
        field.press("Enter")
        assert browser.ask("() => [replay.page.clock.t, replay.page.clock.k]") == [
            pytest.approx(30 * tempo),
            30,
        ]
        field.fill("29.99")
        field.press("Enter")
        assert browser.ask("() => replay.page.clock.t") == 29.99


@pytest.mark.parametrize("count", [4, 5, 11])
def test_every_curve_is_named_within_its_chart(count: int, tmp_path: Path, chromium: Any) -> None:
    shown = with_arm(described(tmp_path))
    names = [f"scene.arm{i}" for i in range(count)]
    shown["happenings"]["curves"] = [
        {"kind": kind, "of": name, "limit": 0.02, "t": [0.0, 30.0], "v": [0.1 + 0.01 * i, 0.2]}
        for kind in ("clearance", "condition")
        for i, name in enumerate(names)
    ]
    file = tmp_path / "replay.html"
    file.write_text(page(shown), encoding="utf-8")
    with opened(chromium) as browser:
        browser.open(file)
        written = browser.ask(
            """() => {
              const [own, told] = [CanvasRenderingContext2D.prototype.fillText, []];
              CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
                told.push([text, y, this.fillStyle]);
                own.call(this, text, x, y);
              };
              const { timeline } = replay.page;
              timeline.drawn = "";
              timeline.draw();
              CanvasRenderingContext2D.prototype.fillText = own;
              return told;
            }"""
        )
        high = browser.ask("() => replay.page.timeline.canvas.clientHeight")
        assert browser.errors == []
    lines = [row for row in written if "scene arm" in row[0]]
    assert len(lines) == 2 * count
    for chart in (lines[:count], lines[count:]):
        assert [text.removeprefix("- ") for text, _, _ in chart] == [
            f"scene arm{i}" for i in range(count)
        ]
        assert len({(text.startswith("- "), colour) for text, _, colour in chart}) == count
    title = next(y for text, y, _ in written if text == "conditioning")
    assert lines[count - 1][1] < title < lines[count][1]
    assert max(y for _, y, _ in lines) < high
