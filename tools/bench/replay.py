"""How soon the replay page shows its first picture, how smoothly it plays, and whether its memory stays steady.

    ./dev bench --replay                    # runs the riveting cell before, in PyBullet
    ./dev bench --replay-of run             # of a run that is there

In headless Chromium, 1280 x 720, without a GPU, which draws the arms with SwiftShader and the page by itself, as
the tests do it; also with all of the page drawn by SwiftShader. The first picture is the beginning of the frame after
the one in which the arms were drawn first, from the start of the navigation, that is with reading the file. A frame
counts if arms were drawn in it. For memory the page plays for `--minutes` by its own clock, which is told how late it
is, ten pictures a second, over and over; garbage is collected before each look.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import Any

from helpers.browser import WHOLE, launched, opened

FIRST_S = 2.0
FRAMES = 15.0
"""Per second, in software."""
GROWTH = 1.05
"""Of the script's memory, from the first look to the last."""
_SIZE = {"width": 1280, "height": 720}
_PLAYED_S = 8.0
_FRAME_MS = 100
_SETTLED_S = 180
"""By then all of the run, and each page of its net, has been shown."""
_COUNTING = """
    globalThis.seen = { first: 0, frames: [], last: 0 };
    for (const kind of [globalThis.WebGLRenderingContext, globalThis.WebGL2RenderingContext]) {
      for (const name of ["drawElements", "drawArrays", "drawElementsInstanced", "drawArraysInstanced"]) {
        const draw = kind?.prototype[name];
        if (!draw) continue;
        kind.prototype[name] = function (...rest) {
          if (!seen.isDrawn) {
            seen.isDrawn = true;
            requestAnimationFrame((now) => {
              seen.isDrawn = false;
              if (!seen.first) seen.first = performance.now();
              seen.frames.push(now);
            });
          }
          return draw.apply(this, rest);
        };
      }
    }
"""
_PLAY = """async (ms) => {
    replay.seek(0);
    replay.page.clock.setSpeed(1);
    await new Promise((done) => setTimeout(done, 500));
    seen.frames.length = 0;
    replay.page.clock.play();
    const began = performance.now();
    await new Promise((done) => setTimeout(done, ms));
    replay.page.clock.pause();
    const gaps = seen.frames.map((t, i) => t - (i ? seen.frames[i - 1] : began)).sort((a, b) => a - b);
    return [1000 * seen.frames.length / (performance.now() - began), gaps[Math.floor(0.95 * gaps.length)]];
}"""
_STAGE = """() => {
    const { clock } = replay.page;
    globalThis.told = { now: performance.now(), waiting: [], rounds: 0 };
    performance.now = () => told.now;
    globalThis.requestAnimationFrame = (work) => told.waiting.push(work);
    clock.setSpeed(1);
    replay.seek(0);
}"""
_PLAYED = """async ([frames, ms]) => {
    const { clock } = replay.page;
    for (let i = 0; i < frames; i++) {
        if (!clock.isPlaying) { clock.play(); told.rounds++; }
        told.now += ms;
        for (const work of told.waiting.splice(0)) work(told.now);
        if (i % 10 === 0) await new Promise((done) => setTimeout(done, 0));
    }
    const { memory } = replay.page.cell.renderer.info;
    seen.frames.length = 0;
    return [told.rounds, memory.geometries, memory.textures, document.querySelectorAll("*").length];
}"""


def measure(folder: Path | None, repeat: int, minutes: int) -> int:
    """Measures, and prints; 1 when a limit is missed on a machine that is not busy."""
    cores, load = os.cpu_count() or 1, os.getloadavg()[0]
    with tempfile.TemporaryDirectory(prefix="pn2code-replay-") as name:
        page = folder / "replay.html" if folder is not None else _run(Path(name))
        with launched() as browser:
            begun = [_first(browser, page) for _ in range(repeat)]
            smooth = [_smooth(browser, page) for _ in range(max(repeat // 3, 1))]
            looks = _memory(browser, page, minutes)
        with launched(WHOLE) as browser:
            whole = [_smooth(browser, page) for _ in range(max(repeat // 3, 1))]
        size = page.stat().st_size
    firsts, works = [s for s, _ in begun], [w for _, w in begun]
    first, frames = median(firsts), median(rate for rate, _, _ in smooth)
    settled = looks[min(_SETTLED_S // 60, len(looks) - 1)]
    growth = looks[-1]["JSHeapUsedSize"] / settled["JSHeapUsedSize"]
    print(f"{cores} cores; load at the start {load:.1f}; {size / 1e6:.2f} MB\n")
    print("| what | median | spread | aim |\n|---|---|---|---|")
    print(f"| first picture | {first:.2f} s | {_spread(firsts)} | below {FIRST_S:g} s |")
    print(f"| processor time until then | {median(works):.2f} s | {_spread(works)} | |")
    rates = [rate for rate, _, _ in smooth]
    print(
        f"| frames a second, at the speed of the run | {frames:.0f} | {_spread(rates)} | {FRAMES:g} |"
    )
    late = [gap for _, gap, _ in smooth]
    print(f"| between two frames, 95 % | {median(late):.0f} ms | {_spread(late)} | |")
    for what, rows in (("", smooth), (", SwiftShader draws all of the page", whole)):
        took = [each for _, _, each in rows]
        print(f"| processor time for a frame{what} | {median(took):.0f} ms | {_spread(took)} | |")
    others = [rate for rate, _, _ in whole]
    print(f"| frames a second, the same | {median(others):.0f} | {_spread(others)} | |")
    print(
        f"| memory of the script, from minute {settled['minute']:.0f} of playing to minute {minutes} "
        f"({looks[-1]['rounds']:.0f} times through the run) | {growth:.3f} times | | {GROWTH:g} |"
    )
    for what in ("elements", "geometries", "textures"):
        print(f"| {what} | {settled[what]:.0f}, then {looks[-1][what]:.0f} | | |")
    is_missed = min(firsts) > FIRST_S or max(rates) < FRAMES or growth > GROWTH
    return int(is_missed and load <= cores / 2)


def _spread(values: list[float]) -> str:
    return f"{min(values):.2f} .. {max(values):.2f}"


def _run(out: Path) -> Path:
    print("bench: running the cell", file=sys.stderr)
    root = Path(__file__).parents[2]
    command = [sys.executable, "-m", "pn2code", "run", "examples/riveting", "--no-pictures", "-o"]
    subprocess.run([*command, str(out)], cwd=root, check=True, stdout=subprocess.DEVNULL)
    return out / "replay.html"


def _first(browser: Any, file: Path) -> tuple[float, float]:
    """Seconds to the first picture, and processor time of all processes of the browser until then (s)."""
    with opened(browser, viewport=_SIZE) as found:
        found.page.add_init_script(_COUNTING)
        before = work()
        found.open(file)
        found.wait("seen.first > 0")
        took = work() - before
        return float(found.ask("() => seen.first")) / 1000, took


def _smooth(browser: Any, file: Path) -> tuple[float, float, float]:
    """Frames a second, the time between two frames that 95 % do not exceed, and processor time for one (ms)."""
    with opened(browser, viewport=_SIZE) as found:
        found.page.add_init_script(_COUNTING)
        found.open(file)
        found.wait("seen.first > 0")
        time.sleep(1.0)
        before = work()
        rate, gap = found.ask(_PLAY, 1000 * _PLAYED_S)
        return float(rate), float(gap), 1000 * (work() - before) / max(rate * _PLAYED_S, 1.0)


def work(but: str = "") -> float:
    """Processor time of all processes that this one has started, and of those that they have (s).

    Args:
        but: a program that does not count, by its file's name: the driver of the browser, which only measures.
    """
    children: dict[int, list[int]] = {}
    seconds: dict[int, float] = {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "stat").read_text().rpartition(")")[2].split()
            program = (folder / "cmdline").read_bytes().split(b"\0")[0].decode(errors="replace")
        except OSError:
            continue  # it has just ended
        children.setdefault(int(words[1]), []).append(int(folder.name))
        if not but or Path(program).name != but:
            took = int(words[11]) + int(words[12])
            seconds[int(folder.name)] = took / os.sysconf("SC_CLK_TCK")
    left, total = list(children.get(os.getpid(), ())), 0.0
    while left:
        one = left.pop()
        total += seconds.get(one, 0.0)
        left += children.get(one, ())
    return total


def _memory(browser: Any, file: Path, minutes: int) -> list[dict[str, float]]:
    """How much there is at the beginning, and after each minute of playing."""
    looks = []
    with opened(browser, viewport=_SIZE) as found:
        found.page.add_init_script(_COUNTING)
        found.open(file)
        found.wait("seen.first > 0")
        asking = found.page.context.new_cdp_session(found.page)
        asking.send("Performance.enable")
        found.ask(_STAGE)
        for minute in range(minutes + 1):
            frames = 60_000 // _FRAME_MS if minute else 0
            rounds, geometries, textures, elements = found.ask(_PLAYED, [frames, _FRAME_MS])
            asking.send("HeapProfiler.collectGarbage")
            rows = {r["name"]: r["value"] for r in asking.send("Performance.getMetrics")["metrics"]}
            rows.update(
                minute=minute,
                rounds=rounds,
                geometries=geometries,
                textures=textures,
                elements=elements,
            )
            looks.append(rows)
    return looks
