"""What pages that watch a cell cost its supervisor: how long its answers take without a live view and with ten pages.

    ./dev bench --live examples/riveting --pages 10 --repeat 4 --speed 10
    ./dev bench --live examples/riveting --watchers 2         # `pn2code watch`, with a page each, instead

Runs without and with the live view take turns, so that both meet the same machine. An answer is the time from a robot's
message to the next one that it takes (`pn2code.run.punctuality`). A page is a WebSocket that reads all it is told; what
a browser draws is not measured.
"""

from __future__ import annotations

import os
import secrets
import shutil
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from urllib.parse import urlsplit

from pn2code.diagnostics import Diagnostics
from pn2code.live.view import LiveView
from pn2code.robot.transforms import Array
from pn2code.run.cell import run_cell
from pn2code.run.engine import Engine
from pn2code.run.prepare import RunOptions
from pn2code.run.realtime import RealtimeEngine

MOST = 1.05
"""Times that the slowest hundredth of the answers may take with pages."""
_LEAST = 10_000
"""Bytes that each page must have been told."""
_READERS = """
import socket, sys, threading
host, port, request, count = sys.argv[1], int(sys.argv[2]), sys.argv[3], int(sys.argv[4])
def read():
    with socket.create_connection((host, port)) as s:
        s.sendall(request.encode())
        n = 0
        while part := s.recv(1 << 16):
            n += len(part)
        sys.stdout.write(f"{n}\\n")
threads = [threading.Thread(target=read) for _ in range(count)]
[t.start() for t in threads]
[t.join() for t in threads]
"""


class _Answers:
    """An observer that keeps the answers."""

    def __init__(self) -> None:
        self.seconds: list[float] = []

    def begun(self, engine: Engine) -> None:
        """Nothing."""

    def advanced(self, engine: Engine) -> None:
        """Nothing."""

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None:
        """Nothing."""

    def ended(self, engine: Engine) -> None:
        """All answers are there."""
        assert isinstance(engine, RealtimeEngine)
        self.seconds = list(engine.punctuality.answers)


class _Watchers(_Answers):
    """An observer that also lets others watch: `pn2code watch`, with a page each."""

    def __init__(self, out: Path, count: int) -> None:
        super().__init__()
        self._out, self._count = out, count
        self._watching: list[subprocess.Popen[str]] = []
        self._reading: list[subprocess.Popen[str]] = []

    def begun(self, engine: Engine) -> None:
        """The folder says where the cell runs, and nothing has happened yet: the run waits for those who watch."""
        command = [sys.executable, "-m", "pn2code", "watch", str(self._out), "--no-browser"]
        for _ in range(self._count):
            self._watching.append(subprocess.Popen(command, stdout=subprocess.PIPE, text=True))
        for one in self._watching:
            assert one.stdout is not None
            if words := one.stdout.readline().split():
                self._reading.append(_open(words[-1], 1))

    def ended(self, engine: Engine) -> None:
        """The watchers end; they must have seen something."""
        super().ended(engine)
        for one in self._watching:
            one.send_signal(signal.SIGINT)
            one.wait()
        told = [int(line) for one in self._reading for line in one.communicate()[0].split()]
        if len(told) != self._count or min(told) < _LEAST:
            raise SystemExit(
                f"the watchers were told too little: {told} bytes; try a lower --speed"
            )


def answers(cell: Path, pages: int | None, speed: float, watchers: int = 0) -> list[float]:
    """The answers of one run; None: without a live view."""
    out = Path(tempfile.mkdtemp(prefix="pn2code-live-"))
    seen = _Watchers(out, watchers) if watchers else _Answers()
    options = RunOptions(
        out, backend="fake", looks=False, realtime=True, speed=speed, checked=False
    )
    try:
        with ExitStack() as stack:
            if pages is None:
                run_cell(cell, options, Diagnostics(), [seen])
            else:
                view = stack.enter_context(LiveView(0, speed))
                readers = _open(view.address, pages)
                run_cell(cell, options, Diagnostics(), [seen, view], ready=view.ready)
                view.close()
                _expect_told(readers, pages)
    finally:
        shutil.rmtree(out, ignore_errors=True)
    return seen.seconds


def _expect_told(readers: subprocess.Popen[str], pages: int) -> None:
    """A page that was told nothing has cost nothing: then the figures would say nothing."""
    told = [int(line) for line in readers.communicate()[0].split()]
    if len(told) != pages or min(told) < _LEAST:
        raise SystemExit(f"the pages were told too little: {told} bytes")


def _open(address: str, pages: int) -> subprocess.Popen[str]:
    at = urlsplit(address)
    assert at.hostname is not None and at.port is not None
    key = f"{secrets.token_hex(8)}{'A' * 6}=="
    request = (
        f"GET {at.path}ws?at=0 HTTP/1.1\r\nHost: {at.netloc}\r\nOrigin: http://{at.netloc}\r\nUpgrade: websocket\r\n"
        f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n"
    )
    _wait_for(at.hostname, at.port)
    return subprocess.Popen(
        [sys.executable, "-c", _READERS, at.hostname, str(at.port), request, str(pages)],
        stdout=subprocess.PIPE,
        text=True,
    )


def _wait_for(host: str, port: int) -> None:
    with socket.create_connection((host, port), timeout=30):
        pass


def figures(seconds: list[float]) -> list[float]:
    """10 %, median, 90 %, 99 %."""
    cuts = statistics.quantiles(seconds, n=100, method="inclusive")
    return [cuts[9], cuts[49], cuts[89], cuts[98]]


def measure(cell: Path, pages: int, runs: int, speed: float, watchers: int = 0) -> int:
    """Measures, and prints a table; 1 if the slowest answers are later with pages, on a machine that is not busy."""
    load = os.getloadavg()[0]
    without, watched, slowest = [], [], []
    for _ in range(runs):
        alone = answers(cell, None, speed)
        seen = answers(cell, None if watchers else pages, speed, watchers)
        slowest.append(figures(seen)[-1] / figures(alone)[-1])
        without += alone
        watched += seen
    print(
        f"{os.cpu_count()} cores; load at the start {load:.1f}; {len(without)} and {len(watched)} answers\n"
    )
    print("| answers | 10 % | median | 90 % | 99 % |\n|---|---|---|---|---|")
    what = f"{watchers} watchers" if watchers else f"{pages} pages"
    for name, rows in (("nobody looks", figures(without)), (what, figures(watched))):
        print(f"| {name} | " + " | ".join(f"{1000 * v:.2f} ms" for v in rows) + " |")
    ratios = [b / a for a, b in zip(figures(without), figures(watched), strict=True)]
    print("| ratio | " + " | ".join(f"{r:.3f}" for r in ratios) + " |")
    print(f"\n99 %, run by run: {min(slowest):.3f} .. {max(slowest):.3f} (aim: at most {MOST:g})")
    return int(ratios[-1] > MOST and min(slowest) > MOST and load <= (os.cpu_count() or 1) / 2)
