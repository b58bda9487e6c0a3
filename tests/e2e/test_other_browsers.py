"""The pages in Firefox and in WebKit, where they are installed: they open, move, connect, and complain of nothing."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from helpers import netbuilder
from helpers.other_browsers import Other, firefox, webkit
from helpers.played import served
from helpers.processes import pn2code
from helpers.shown import PAIR, described, opened, with_arm
from helpers.thorough import THOROUGH
from pn2code.replay.page import page
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.report import places
from pn2code.semantics.game.token_game import Game
from pn2code.trace.replay import replay_lines

READY = "document.body.dataset.ready === 'true'"
SPACE, RIGHT, LEFT, ENTER = " ", "\ue014", "\ue012", "\ue007"
STEPS = 20
MOMENTS = 10
CENTRE = """(selector) => {
  const box = document.querySelector(selector).getBoundingClientRect();
  return [box.x + box.width / 2, box.y + box.height / 2];
}"""


@pytest.fixture(scope="module", params=[firefox, webkit], ids=["firefox", "webkit"])
def browser(request: pytest.FixtureRequest) -> Iterator[Other]:
    """One of them, for the tests of this file."""
    with request.param() as found:
        yield found


def shown(folder: Path, run: dict[str, Any], other: dict[str, Any] | None = None) -> str:
    file = folder / "replay.html"
    file.write_text(page(run, other), encoding="utf-8")
    return file.as_uri()


def used(browser: Other) -> None:
    """A replay page that is open: keys, the axis, the step under the mouse, play."""
    browser.press(RIGHT, RIGHT, RIGHT)
    assert browser.ask("() => replay.page.clock.k") == 3
    browser.press(LEFT)
    assert browser.ask("() => replay.page.clock.k") == 2
    x, y = browser.ask(CENTRE, "#timeline canvas")
    browser.drag(x - 100, y, x + 50, y)
    browser.wait("replay.page.clock.k > 8")
    at = browser.ask("() => replay.page.clock.t")
    browser.press(SPACE)
    browser.wait(f"replay.page.clock.t > {at + 0.2}")
    browser.press(SPACE)
    browser.wait("!replay.page.clock.isPlaying")
    browser.press("/", *"Move", ENTER)
    browser.wait("document.querySelector('#net .status').textContent.includes('Move')")
    browser.ask("() => document.activeElement.blur()")


def markings_of(folder: Path) -> list[dict[str, str]]:
    """What the token game says, after each step."""
    _, flat = opened(folder / "net.cpn")
    found: list[dict[str, str]] = []

    def watch(game: Game, occurred: BindingElement | None, line: Mapping[str, Any]) -> None:
        rows = {(r["id"], r["instance"]): str(r["marking"]) for r in places(flat, game.marking)}
        found.append({p.name: rows[p.id, p.instance_number] for p in flat.places})

    lines = (folder / "net.trace.jsonl").read_text(encoding="utf-8").splitlines()
    assert replay_lines(lines, flat, watch=watch).ok
    return found


def test_a_run_with_an_arm(browser: Other, tmp_path: Path) -> None:
    run = with_arm(described(tmp_path, steps=STEPS))
    address = shown(tmp_path, run)
    browser.open(address)
    browser.wait(READY)
    used(browser)
    assert browser.ask("() => Boolean(replay.page.cell.renderer)")
    x, y = browser.ask(CENTRE, ".stage canvas")
    eye = "() => replay.page.cell.camera.position.toArray()"
    before = browser.ask(eye)
    browser.drag(x, y, x + 80, y + 20)
    assert browser.ask(eye) != before
    markings = markings_of(tmp_path)
    for k in random.Random(1).sample(range(STEPS + 1), MOMENTS):
        browser.ask("(k) => { replay.page.clock.step(k); }", k)
        assert dict(browser.ask("() => replay.marking()")) == markings[k]
    browser.open("about:blank")
    browser.open(f"{address}#t=7.25")
    browser.wait(READY)
    assert browser.ask("() => replay.page.clock.t") == 7.25
    assert browser.errors() == []


def test_two_runs(browser: Other, tmp_path: Path) -> None:
    run = described(tmp_path, steps=STEPS)
    browser.open(shown(tmp_path, with_arm(run), with_arm(run, 2.0)))
    browser.wait(READY)
    used(browser)
    assert browser.errors() == []


def test_a_game(browser: Other, root: Path) -> None:
    with served(root / "examples/philosophers/philosophers.cpn") as server:
        browser.open(server.url)
        browser.wait(READY)
        browser.wait("document.querySelector('.sheet .enabled')")
        browser.click(*browser.ask(CENTRE, ".sheet .enabled"))
        browser.wait("play.page.position.state.position === 1")
        browser.press(" ", " ")
        browser.wait("play.page.position.state.position === 3")
        browser.press(LEFT)
        browser.wait("play.page.position.state.position === 2")
        assert browser.errors() == []
        browser.open("about:blank")  # the game is left


@pytest.mark.cc
def test_a_graph(browser: Other, root: Path, tmp_path: Path) -> None:
    net, file = root / "examples/philosophers/philosophers.cpn", tmp_path / "graph.html"
    done = pn2code(
        "verify", net, "--set", "n=5", "--no-found", "--draw", file, "-q", "-o", tmp_path
    )
    assert done.returncode == 0, done.stderr
    browser.open(file.as_uri())
    browser.press("/", *"7", ENTER)
    browser.wait("document.querySelector('.sheet[data-node=\"7\"]')")
    assert browser.errors() == []


@pytest.fixture(scope="module")
def still(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """A drawing and a report, for both browsers."""
    folder = tmp_path_factory.mktemp("still")
    net = netbuilder.write(PAIR, folder / "net.cpn")
    drawing, report = folder / "drawing.html", folder / "report.html"
    assert pn2code("draw", net, "-o", drawing).returncode == 0
    options = ("--max-states", "20", "--report", report, "-q", "-o", folder)
    assert pn2code("verify", net, *options).returncode in (0, 3)
    return [drawing, report]


@pytest.mark.cc
def test_a_drawing_and_a_report(browser: Other, still: list[Path]) -> None:
    for file, words in zip(still, ("Sub", "Bounds"), strict=True):
        browser.open(file.as_uri())
        browser.wait("document.readyState === 'complete'")
        assert words in browser.ask("() => document.querySelector('main').textContent")
        width, styled = browser.ask(
            "() => [document.documentElement.scrollWidth - innerWidth,"
            " getComputedStyle(document.body).fontFamily.includes('sans')]"
        )
        assert width <= 0 and styled
        if words == "Sub":
            browser.press("/", *"Move", ENTER)
            browser.wait("location.hash.length > 1")
        assert browser.errors() == []


@pytest.mark.skipif(not THOROUGH, reason="Chromium does it in each run (test_replay_page)")
def test_without_webgl(tmp_path: Path) -> None:
    run = with_arm(described(tmp_path, steps=STEPS))
    with firefox(with_webgl=False) as browser:
        browser.open(shown(tmp_path, run))
        browser.wait(READY)
        assert "this browser has no WebGL" in browser.ask(
            "() => document.querySelector('.missing').textContent"
        )
        used(browser)
        assert browser.errors() == []
