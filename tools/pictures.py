"""Pictures of the replay page for the documents, from a real browser: `./dev pictures`.

    ./dev pictures                       # runs the riveting cell before, in PyBullet
    ./dev pictures --run run             # of a run that is there
    ./dev pictures --still replay.png    # a picture of one moment as well

`docs/pictures/replay.webp` moves: the page at moments that follow each other, as it is on a screen of 1280 x 720, made
smaller. Needs Chromium and Playwright (`./dev extras`), and Pillow, which comes with the charts.
"""

from __future__ import annotations

import argparse
import io
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from PIL import Image

from helpers.browser import launched, opened

ROOT = Path(__file__).parents[1]
OUT = ROOT / "docs/pictures"
MOST_BYTES = 1_500_000
_SCREEN = {"width": 1280, "height": 720}
_SMALL = (960, 540)
_FRAMES = 66
_FROM_S, _STEP_S = 12.0, 0.4
"""The moments of the run: two rivets."""
_SHOWN_MS = 110
_FINE = 2
_PREPARE = """() => {
    const { page } = replay;
    page.net.setFollowing(true);
    page.cell?.shadows(true);
    page.timeline.from = %(first)g - 6;
    page.timeline.to = %(last)g + 12;
}"""
_MOMENT = """async ([t, fine]) => {
    const { page } = replay;
    page.clock.seek(t);
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    page.cell?.draw(fine);
}"""


def run_of(cell: str, out: Path) -> Path:
    """Runs a cell; its page."""
    command = [sys.executable, "-m", "pn2code", "run", cell, "--no-pictures", "-o", str(out)]
    subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    return out / "replay.html"


def moments(page: Any, times: list[float]) -> Iterator[Image.Image]:
    """The page at these moments."""
    page.ask(_PREPARE % {"first": times[0], "last": times[-1]})
    for t in times:
        page.ask(_MOMENT, [t, _FINE])
        yield Image.open(io.BytesIO(page.page.screenshot())).convert("RGB")


def moving(frames: list[Image.Image], out: Path) -> int:
    """Writes frames as an animation; its size in bytes."""
    small = [frame.resize(_SMALL, Image.Resampling.LANCZOS) for frame in frames]
    for quality in (70, 55, 40, 25):
        small[0].save(
            out, save_all=True, append_images=small[1:], duration=_SHOWN_MS, loop=0, quality=quality, method=4,
            minimize_size=True,
        )  # fmt: skip
        if out.stat().st_size <= MOST_BYTES:
            break
    return out.stat().st_size


def main() -> None:
    """Makes the pictures."""
    parser = argparse.ArgumentParser(prog="./dev pictures", description=__doc__)
    parser.add_argument("--run", type=Path, metavar="DIR", help="the folder of a run")
    parser.add_argument("--still", type=Path, metavar="FILE", help="a picture of one moment")
    parser.add_argument("--moment", type=float, default=33.4, metavar="S", help="which one")
    parser.add_argument("-o", "--output", type=Path, default=OUT / "replay.webp", metavar="FILE")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="pn2code-pictures-") as name:
        file = asked.run / "replay.html" if asked.run else run_of("examples/riveting", Path(name))
        with launched() as browser, opened(browser, viewport=_SCREEN) as page:
            page.open(file)
            if asked.still:
                next(moments(page, [asked.moment])).save(asked.still, optimize=True)
            times = [_FROM_S + i * _STEP_S for i in range(_FRAMES)]
            size = moving(list(moments(page, times)), asked.output)
    print(f"{asked.output}: {_FRAMES} moments, {size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
