"""Pages of drawings and reports on a phone: nothing is cut off, and buttons can be hit with a finger."""

from __future__ import annotations

from pathlib import Path

from helpers import netbuilder
from helpers.browser import launched, opened
from helpers.fingers import PHONE
from helpers.legible import complaints
from helpers.processes import pn2code
from helpers.shown import PAIR

SMALL = """() => [...document.querySelectorAll("button")].map((b) => b.getBoundingClientRect())
  .filter((r) => r.width && (r.width < 24 || r.height < 24)).length"""


def test_a_drawing_and_a_report(tmp_path: Path) -> None:
    net = netbuilder.write(PAIR, tmp_path / "net.cpn")
    drawing, report = tmp_path / "net.html", tmp_path / "report.html"
    assert pn2code("draw", net, "-o", drawing).returncode == 0
    options = ("--max-states", "20", "--report", report, "-q", "-o", tmp_path)
    assert pn2code("verify", net, *options).returncode in (0, 3)
    with launched() as chromium:
        for file in (drawing, report):
            with opened(chromium, **PHONE) as browser:
                browser.page.goto(file.as_uri())
                assert browser.ask("() => document.documentElement.scrollWidth") <= 390
                assert browser.ask(SMALL) == 0
                main = browser.page.locator("main").bounding_box()
                assert main["x"] < 30 and main["width"] > 340
                assert complaints(browser) == []
                browser.page.emulate_media(color_scheme="dark")
                filters = "() => [...document.querySelectorAll('main svg')].map((e) => getComputedStyle(e).filter)"
                assert all("invert" in each for each in browser.ask(filters)), "white in the dark"
                assert browser.errors == []
