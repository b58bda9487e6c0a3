"""What the replay page shows is what it says: moments that are typed as they are shown, the name of each curve."""

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


def test_a_moment_typed_as_it_is_shown_has_what_is_shown_there(
    tmp_path: Path, chromium: Any
) -> None:
    """Steps have more digits than the page shows: whoever types 0.33 means the step at 0.3333, not before it."""
    run = with_arm(described(tmp_path), 1 / 3)
    run["verdict"] = {
        "word": "finished",
        "reason": "",
        "final": ["Top.Jammed"],
        "failed": ["Top.Jammed"],
    }
    run["happenings"]["events"] = [{"t": 7.1239, "kind": "warning", "party": 1, "text": "near"}]
    file = tmp_path / "replay.html"
    file.write_text(page(run), encoding="utf-8")
    steps = {f"{k / 3:.2f}": k for k in range(1, 31)}
    moments = {
        "3.333": 10 * (1 / 3),
        "3.3330": 3.333,
        "0:07.12": 7.1239,
        "7.12": 7.1239,
        "3,5 s": 3.5,
    }
    nothing = ["abc", "", "1:05:", ":05", "Infinity", "3,5,1"]
    addresses = {"#t=6,5": 19, "#t=4.67": 14, "#t=": 14, "#t=x": 14, "#step=": 14, "#step=x": 14}
    with opened(chromium) as browser:
        browser.open(file)
        found = browser.ask(
            """([steps, moments, nothing, addresses]) => {
              const { page } = replay, { clock, written } = page, { time } = page.transport;
              const typed = (text) => (time.value = text, time.dispatchEvent(new Event("change")), clock);
              const named = (to) => (history.replaceState(null, "", to), page.fromAddress(), clock.k);
              const back = (t) => {
                clock.seek(t);
                const again = written.read(written.write(t));
                return clock.course.stepAt(again) === clock.k && Math.abs(again - t) < 6e-4;
              };
              const slider = page.transport.speed;
              const set = (s) => (slider.value = s, slider.dispatchEvent(new Event("input")), clock.speed);
              const speeds = ["-9", "9"].map(set);
              return {
                speeds,
                steps: steps.map((text) => typed(text).k),
                moments: moments.map((text) => typed(text).t),
                nothing: nothing.map((text) => [typed(text).t, time.value]),
                addresses: addresses.map(named),
                back: [1, 2, 29, 30].flatMap((k) => [0, 1e-3, 1e-4].map((less) => back(k / 3 - less))),
              };
            }""",
            [list(steps), list(moments), nothing, list(addresses)],
        )
        chip = browser.page.locator("#verdict .chip.bad")
        assert chip.inner_text() == "failure: Jammed"
        assert browser.errors == []
    assert found.pop("speeds") == pytest.approx([0.1, 50])
    assert found == {
        "steps": list(steps.values()),
        "moments": list(moments.values()),
        "nothing": [[3.5, "3.50"]] * len(nothing),
        "addresses": list(addresses.values()),
        "back": [True] * 12,
    }


def test_the_end_of_a_trace_is_neither_good_nor_bad_and_a_lasso_goes_on(
    tmp_path: Path, chromium: Any
) -> None:
    run = described(tmp_path)
    run["course"]["loop"] = 12
    file = tmp_path / "replay.html"
    file.write_text(page(run), encoding="utf-8")
    with opened(chromium) as browser:
        browser.open(file)
        found = browser.ask(
            """() => {
              const { page } = replay, { clock, run } = page;
              const chips = () => [...document.querySelectorAll("#verdict .chip")];
              const chip = () => chips().map((c) => `${c.className}: ${c.innerText}`);
              const told = [...chip(), document.querySelector(".panel.run").textContent];
              const request = window.requestAnimationFrame;
              window.requestAnimationFrame = () => 0;
              clock.seek(29.9), clock.play();
              const at = [1000, 1050, 1200, 2300].map((t) => (clock.frame(t), [clock.k, clock.isPlaying]));
              clock.pause();
              run.course.loop = null;
              clock.seek(29.9), clock.play(), clock.frame(1000), clock.frame(1200);
              window.requestAnimationFrame = request;
              const words = ["finished", "steps", "until", "error"].flatMap((word) => {
                run.verdict.word = word;
                page.head();
                return chip();
              });
              return { told, at, ended: [clock.k, clock.isPlaying], words };
            }"""
        )
        assert browser.errors == []
    assert found["told"][0] == "chip plain: repeated for ever from step 13 on"
    assert "the steps from step 13 on are repeated for ever" in found["told"][1]
    assert found["at"] == [[29, True], [29, True], [12, True], [13, True]]
    assert found["ended"] == [30, False]
    assert found["words"] == [
        "chip plain: nothing is enabled any more",
        "chip plain: the number of steps was reached",
        "chip plain: the next step would be after the given time",
        "chip bad: an inscription of the net raised an error",
    ]


def test_curves_are_told_apart_whatever_colours_are_seen(tmp_path: Path, chromium: Any) -> None:
    """An arm has one colour in both charts; what it keeps from itself is dashed, as are all lines of a fourth."""
    shown = with_arm(described(tmp_path))
    arms = [f"robot{i}" for i in range(1, 5)]
    kinds = {
        "clearance": ["robots", *(f"{of}.{arm}" for of in ("scene", "self") for arm in arms)],
        "condition": arms,
    }
    shown["happenings"]["curves"] = [
        {"kind": kind, "of": name, "limit": 0.02, "t": [0.0, 30.0], "v": [0.1, 0.2]}
        for kind, names in kinds.items()
        for name in names
    ]
    file = tmp_path / "replay.html"
    file.write_text(page(shown), encoding="utf-8")
    with opened(chromium) as browser:
        browser.open(file)
        looks = browser.ask("() => replay.page.timeline.curves.map((chart) => chart.looks)")
        assert browser.errors == []
    (robots, *clearance), condition = ([(x["colour"], tuple(x["dash"])) for x in c] for c in looks)
    scene, own = clearance[:4], clearance[4:]
    assert robots == (None, ()) and scene == condition
    assert [colour for colour, _ in scene] == [colour for colour, _ in own]
    assert len({dash for _, dash in (scene[0], own[0], scene[3], own[3])}) == 4
    assert len(set(clearance)) == 8


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
              const kind = CanvasRenderingContext2D.prototype;
              const [own, stroke, told] = [kind.fillText, kind.stroke, []];
              let line = "";
              kind.stroke = function () {
                line = [this.strokeStyle, ...this.getLineDash()].join(" ");
                stroke.call(this);
              };
              kind.fillText = function (text, x, y) {
                told.push([text, y, line]);
                own.call(this, text, x, y);
              };
              const { timeline } = replay.page;
              timeline.drawn = "";
              timeline.draw();
              Object.assign(kind, { fillText: own, stroke });
              return told;
            }"""
        )
        high = browser.ask("() => replay.page.timeline.canvas.clientHeight")
        assert browser.errors == []
    lines = [row for row in written if "scene arm" in row[0]]
    assert len(lines) == 2 * count
    for chart in (lines[:count], lines[count:]):
        assert [text for text, _, _ in chart] == [f"scene arm{i}" for i in range(count)]
        assert len({line for _, _, line in chart}) == count
    title = next(y for text, y, _ in written if text == "conditioning")
    assert lines[count - 1][1] < title < lines[count][1]
    assert max(y for _, y, _ in lines) < high


def test_a_short_name_is_whole_beside_a_long_reason(tmp_path: Path, chromium: Any) -> None:
    """The ellipsis of a name that lacked a hundredth of a pixel took three of its four letters."""
    run = with_arm(described(tmp_path), 1.0)
    run["title"] = "cell"
    reason = "robot `one`: `one/driver` and `lift/column` collide (2.5 mm deep), " * 6
    run["verdict"] = {"word": "failed", "reason": reason, "final": [], "failed": []}
    file = tmp_path / "replay.html"
    file.write_text(page(run), encoding="utf-8")
    with opened(chromium) as browser:
        browser.open(file)
        name, lacking = browser.ask(
            """() => {
              const h1 = document.querySelector("#top h1"), text = document.createRange();
              text.selectNodeContents(h1);
              return [h1.innerText, text.getBoundingClientRect().width - h1.getBoundingClientRect().width];
            }"""
        )
    assert name == "cell" and lacking <= 0.001
