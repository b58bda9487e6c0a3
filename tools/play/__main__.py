"""How long a click takes in the page of `pn2code play`: from the click to the new picture, in a real browser.

    python -m tools.play [--clicks N]

The net has 60 pages: one with 59 substitution transitions, and an instance of a page of its own behind each, with 10
places and 10 transitions. A click on a transition that is enabled is measured from the event to the frame in which the
new marking is drawn.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path
from statistics import median

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does: the tests' helpers

from helpers import netbuilder
from helpers.browser import launched, opened
from helpers.played import served

PAGES = 59
RING = 10

_CLICK = """() => new Promise(done => {
  const node = document.querySelector(".sheet .enabled");
  const before = play.page.position.state.position;
  const start = performance.now();
  node.dispatchEvent(new MouseEvent("click", { bubbles: true }));
  (function look() {
    if (play.page.position.state.position === before) { setTimeout(look, 0); return; }
    requestAnimationFrame(() => setTimeout(() => done(performance.now() - start), 0));
  })();
})"""


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
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    options.add_argument("--clicks", type=int, default=300)
    clicks = options.parse_args().clicks
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "sixty.cpn"
        netbuilder.write(net(), file)
        with served(file) as server, launched() as browser, opened(browser) as page:
            page.page.goto(server.url)
            page.page.wait_for_selector("body[data-ready=true]")
            page.ask("() => play.page.net.pin(1)")
            times = sorted(float(page.ask(_CLICK)) for _ in range(clicks))
            size = len(page.ask("() => play.page.position.net.transitions"))
    print(
        f"{PAGES + 1} pages, {size} transitions, {clicks} clicks: "
        f"p50 {median(times):.1f} ms, p95 {times[int(0.95 * len(times))]:.1f} ms, most {times[-1]:.1f} ms"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
