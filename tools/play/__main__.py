"""How long a click takes in the page of `pn2code play`: from the click to the new picture, in a real browser.

    ./dev bench --play             # or python -m tools.play [--clicks N]

The net has 60 pages: one with 59 substitution transitions, and an instance of a page of its own behind each, with 10
places and 10 transitions. A click on a transition that is enabled is measured from the event to the frame in which the
new marking is drawn.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does: the tests' helpers

from tools.bench.replay import work

from helpers import netbuilder
from helpers.browser import launched, opened
from helpers.played import served

DRIVER = "node"
"""Of Playwright, which measures."""
PAGES = 59
RING = 10
CLICKS = 300

_LISTEN = """() => {
  const link = play.page.link, hear = link.hear.bind(link);
  link.hear = said => {
    play.heard = performance.now();
    hear(said);
    play.done = performance.now();
    play.answered?.();
  };
}"""
_CLICK = """async () => {
  const answered = new Promise(done => (play.answered = done));
  const start = performance.now();
  document.querySelector(".sheet .enabled").dispatchEvent(new MouseEvent("click", { bubbles: true }));
  await answered;
  await new Promise(drawn => requestAnimationFrame(() => setTimeout(drawn, 0)));
  const end = performance.now();
  return [end - start, play.heard - start, play.done - play.heard, end - play.done];
}"""
WARM = 20
"""Clicks before those that are measured."""
PAUSE_S = 0.3
"""Until the last dot has arrived: it belongs to the click, too."""
PARTS = ("in all", "answer of the server", "script of the page", "drawing by the browser")


def net() -> str:
    """The net in the short text form."""
    rows = ["net Sixty", "  standard", "  var n : INT;", "  page Top"]
    for i in range(PAGES):
        rows += [f"    place B{i} : INT = 1`{i}", f"    place D{i} : INT"]
        rows.append(f"    subst S{i} = P{i} (In -> B{i}, Out -> D{i})")
    for i in range(PAGES):
        rows += [f"  page P{i}", "    place In port in : INT", "    place Out port out : INT"]
        rows += [f"    place Q{k} : INT = 1`{k}" for k in range(RING - 2)]
        for k in range(RING - 2):
            rows += [f"    trans T{k}", f"      in Q{k} : n"]
            rows.append(f"      out Q{(k + 1) % (RING - 2)} : (n + 1) mod 1000")
        rows += ["    trans Enter", "      in In : n", "      out Q0 : n"]
        rows += ["    trans Leave", "      in Q1 : n", "      out Out : n"]
    return "\n".join([*rows, ""])


def main() -> int:
    """Prints a line of the table."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--clicks", type=int, default=CLICKS)
    return measure(options.parse_args().clicks)


def measure(clicks: int = CLICKS) -> int:
    """So many clicks."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "sixty.cpn"
        netbuilder.write(net(), file)
        with served(file) as server, launched() as browser, opened(browser) as page:
            page.page.goto(server.url)
            page.page.wait_for_selector("body[data-ready=true]")
            page.ask("() => play.page.net.pin(1)")
            page.ask(_LISTEN)
            for _ in range(WARM):
                page.ask(_CLICK)
            time.sleep(PAUSE_S)
            before = work(DRIVER)
            times = []
            for _ in range(clicks):
                times.append(page.ask(_CLICK))
                time.sleep(PAUSE_S)
            took = work(DRIVER) - before
            size = page.ask("() => play.page.position.net.transitions.length")
    print(f"{PAGES + 1} pages, {size} transitions, {clicks} clicks, load {os.getloadavg()[0]:.1f}")
    for part, name in enumerate(PARTS):
        own = sorted(float(row[part]) for row in times)
        print(f"{name}: p50 {median(own):.1f} ms, p95 {own[int(0.95 * len(own))]:.1f} ms")
    print(f"processor time for a click, server and browser: {1000 * took / clicks:.1f} ms")
    return 0


if __name__ == "__main__":
    sys.exit(main())
