"""Pictures of the live page for the documents, from a real browser: `./dev pictures --live`.

    python -m tools.live_pictures                # docs/pictures/live.png and intervene.png
    python -m tools.live_pictures -o /tmp        # elsewhere

`live.png` is the riveting cell some time after it has begun, in PyBullet; `intervene.png` the sorting cell while its
belt asks a person what the camera sees. Needs Chromium and Playwright (`./dev extras`).
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from helpers.browser import launched, opened

ROOT = Path(__file__).parents[1]
OUT = ROOT / "docs/pictures"
_AFTER_S = 36.0
"""The moment of the run: the arms have set two rivets, and one of them drills."""
_SETTLING_MS = 1_500
"""Where the page draws slowly: its camera and its curves are there then."""


@contextmanager
def _running(cell: str, *options: str) -> Iterator[str]:
    """A cell that runs with a live page; the last address that the terminal has printed."""
    lines = 4 if "--intervene" in options else 3
    with tempfile.TemporaryDirectory(prefix="pn2code-pictures-") as folder:
        command = [sys.executable, "-m", "pn2code", "run", cell, "--realtime", "--live", *options]
        process = subprocess.Popen(
            [*command, "--no-pictures", "-o", folder], cwd=ROOT, stdout=subprocess.PIPE, text=True
        )
        assert process.stdout is not None
        try:
            said = [process.stdout.readline() for _ in range(lines)]
            if not all(said):
                raise SystemExit(f"{cell} does not run: `{' '.join(command)}` says why")
            yield (said[-1] if "--intervene" in options else said[0]).split()[-1]
        finally:
            process.terminate()
            process.communicate()


def _taken(page: Any, file: Path) -> None:
    page.page.wait_for_timeout(_SETTLING_MS)
    page.page.screenshot(path=file)
    print(file)


def running_cell(browser: Any, file: Path) -> None:
    """The riveting cell while it runs."""
    size = {"width": 1280, "height": 720}
    with _running("examples/riveting") as url, opened(browser, viewport=size) as page:
        page.page.goto(url)
        page.page.wait_for_selector("body[data-ready=true]")
        page.wait(f"live.page.clock.t > {_AFTER_S} && live.page.clock.isLive")
        _taken(page, file)


def question(browser: Any, file: Path) -> None:
    """The belt of the sorting cell asks."""
    size = {"width": 1280, "height": 800}
    cell = ("examples/sorting", "--intervene", "--patience", "60")
    with _running(*cell) as url, opened(browser, viewport=size) as page:
        page.page.goto(url)
        page.page.wait_for_selector("body[data-ready=true]")
        page.page.get_by_role("group", name="Question of belt").wait_for()
        page.page.get_by_role("tab", name="Intervene").click()
        _taken(page, file)


def take(out: Path) -> None:
    """Both, into a folder."""
    with launched() as browser:
        running_cell(browser, out / "live.png")
        question(browser, out / "intervene.png")


def main() -> None:
    """Makes the pictures."""
    parser = argparse.ArgumentParser(prog="python -m tools.live_pictures", description=__doc__)
    parser.add_argument("-o", "--output", type=Path, default=OUT, metavar="DIR")
    take(parser.parse_args().output)


if __name__ == "__main__":
    main()
