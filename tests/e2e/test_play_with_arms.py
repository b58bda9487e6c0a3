"""*Run it with arms* of `play`: a run of the cell that a person interferes with, and that ends with the game."""

from __future__ import annotations

import sys
import time
import urllib.error
import urllib.request
from pathlib import Path
from queue import Queue

import pytest

from helpers import netbuilder
from helpers.browser import launched, opened
from helpers.legible import complaints
from helpers.played import Talk, served
from helpers.shown import PAIR
from pn2code.play.trouble import Json, Trouble
from pn2code.play.with_arms import WithArms


def answers(address: str) -> bool:
    try:
        with urllib.request.urlopen(address.partition("#")[0], timeout=60) as found:
            return bool(found.status == 200)
    except urllib.error.URLError:
        return False


@pytest.mark.cc
def test_it_is_run_once_and_ends_with_the_game(root: Path) -> None:
    with served(root / "examples/minimal") as server, Talk(server) as talk:
        first = talk.ask("arms")
        assert first["ok"], first
        address = first["result"]["address"]
        assert address.startswith("http://127.0.0.1:") and "#act=" in address
        assert talk.ask("arms")["result"]["address"] == address
        assert answers(address)
    until = time.monotonic() + 60
    while answers(address) and time.monotonic() < until:
        time.sleep(0.1)
    assert not answers(address)


@pytest.mark.cc
def test_the_page_leads_to_it_and_says_what_of_a_cell_is_asked(root: Path) -> None:
    with (
        served(root / "examples/minimal") as server,
        launched() as chromium,
        opened(chromium) as browser,
    ):
        page = browser.page
        page.goto(server.url)
        page.wait_for_selector("body[data-ready=true]")
        page.get_by_role("tab", name="Ask", exact=True).click()
        page.get_by_text("All that the cell can do is explored, as its programs run").wait_for()
        page.get_by_role("button", name="Ask", exact=True).click()
        page.get_by_text("38 states of the cell as its programs run").wait_for()
        page.get_by_role("tab", name="Game", exact=True).click()
        assert complaints(browser) == []
        page.get_by_role("button", name="Run it with arms").click()
        link = page.get_by_role("link", name="Open its page")
        link.wait_for()
        assert "#act=" in link.get_attribute("href")
        assert complaints(browser) == [] and browser.errors == []


def test_a_net_has_none(tmp_path: Path) -> None:
    net = netbuilder.write(PAIR, tmp_path / "net.cpn")
    with served(net) as server, Talk(server) as talk:
        answer = talk.ask("arms")
        assert not answer["ok"]


def test_why_it_cannot_be_run_is_told(tmp_path: Path) -> None:
    """At once, or when its page has been there for some time."""
    ended: Queue[Json] = Queue()
    run = WithArms(tmp_path / "not there", {}, tmp_path / "out")
    try:
        run.address(ended.put)
        said = ended.get(timeout=60)
        assert said["arms"] == "ended" and "not there" in said["said"]
    finally:
        run.close()
    with pytest.raises(Trouble, match="this game is over"):
        run.address(ended.put)
    broken = WithArms(
        tmp_path, {}, tmp_path / "out", (sys.executable, "-c", "print('no such thing')")
    )
    with pytest.raises(Trouble, match="the cell cannot be run: no such thing"):
        broken.address(ended.put)
