"""Values that have no room: all of the chosen message and step can be read, with a finger and with keys, too."""

from __future__ import annotations

from pathlib import Path

from helpers.browser import launched, opened
from helpers.fingers import PHONE
from helpers.legible import complaints
from helpers.shown import described, with_arm
from pn2code.replay.page import page

_ROUTE = """
net Route
  standard
  colset POSE = record x : INT * y : INT * z : INT;
  colset ROUTE = list POSE;
  var r : ROUTE;
  page Top
    place A : ROUTE = 1`List.tabulate (24, fn i => {x = 1000 + i, y = 2, z = 3})
    place B : ROUTE
    trans Move
      in A : r
      out B : r
"""
_LAST = "x=1023,y=2,z=3}"


def test_all_of_a_long_message_and_of_a_step_can_be_read(tmp_path: Path) -> None:
    run = with_arm(described(tmp_path, _ROUTE), texts=lambda k: f"24 {'1000.0000 ' * 71}{_LAST}")
    file = tmp_path / "replay.html"
    file.write_text(page(run), encoding="utf-8")
    with launched() as chromium:
        for options in ({}, PHONE):
            with opened(chromium, **options) as browser:
                browser.open(file, "#step=1")
                if options:
                    browser.page.get_by_role("button", name="More", exact=True).tap()
                for tab in ("Messages", "Steps"):
                    browser.page.get_by_role("tab", name=tab).click()
                    browser.settled()
                    full = browser.page.get_by_role("group", name=f"{tab}: all of this one")
                    assert full.is_visible() and _LAST in (full.text_content() or "")
                    box, pane = full.bounding_box(), browser.page.locator("#panels").bounding_box()
                    assert box["height"] < 0.5 * pane["height"]
                    assert full.evaluate("(e) => e.scrollWidth <= e.clientWidth")
                # Before the first one there is none.
                browser.page.evaluate("() => replay.seek(0)")
                browser.settled()
                assert full.is_hidden()
                assert complaints(browser) == []
                assert browser.errors == []
