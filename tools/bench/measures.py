"""What is measured. Each function gives samples, one a repetition, warm caches, in seconds unless it says otherwise."""

from __future__ import annotations

import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from tests.helpers.netbuilder import cpn
from tools.bench.snakes_peer import firings_per_second

from pn2code import pipeline
from pn2code.diagnostics import Diagnostics, render
from pn2code.emission import c_flags
from pn2code.net import front
from pn2code.semantics.game.token_game import Game
from pn2code.simulate import programs

ROOT = Path(__file__).parents[2]
CELL = ROOT / "examples" / "riveting"
CELLS = ("riveting", "sorting", "timed")
CNATIVE = ROOT / "cnative"
LATENCY_ROUNDS = 900

RING = """
    net Ring
      colset INT = int;
      var n: INT;
      place A : INT = 1`0
      place B : INT
      place C : INT
      place D : INT
      trans One
        in A : n
        out B : n + 1
      trans Two
        in B : n
        out C : n
      trans Three
        in C : n
        out D : n
      trans Four
        in D : n
        out A : n mod 1000
"""
TABLE = """
    net Table
      colset SEAT = index seat with 0..9;
      var i: SEAT;
      fun next (seat k) = seat ((k + 1) mod 10)
      place Thinking : SEAT = SEAT.all()
      place Eating : SEAT
      place Forks : SEAT = SEAT.all()
      trans Take
        in Thinking : i
        in Forks : 1`i ++ 1`(next i)
        out Eating : i
      trans Put
        in Eating : i
        out Thinking : i
        out Forks : 1`i ++ 1`(next i)
"""
PROTOCOL = """
    net Protocol
      colset INT = int;
      colset DATA = string;
      colset PACKET = product INT * DATA;
      colset SLOT = int with 0..2;
      colset MESSAGE = product SLOT * PACKET;
      var p: PACKET;
      var c: SLOT;
      var n, k: INT;
      var d, s: DATA;
      fun packet n = (n, "packet " ^ INT.mkstr n)
      place Send : PACKET = [packet 1, packet 2, packet 3, packet 4, packet 5, packet 6, packet 7, packet 8]
      place Limit : SLOT = SLOT.all()
      place A : MESSAGE
      place B : MESSAGE
      place Received : PACKET = (1, "")
      trans Send
        in Send : p
        in Limit : c
        out Send : p
        out A : (c, p)
      trans Lose
        in A : (c, p)
        out Limit : c
      trans Pass
        in A : (c, p)
        out B : (c, p)
      trans Receive
        in B : (c, (n, d))
        in Received : (k, s)
        out Received : if n = k then (k mod 8 + 1, if k = 8 then d else s ^ d) else (k, s)
        out Limit : c
"""


class Times(NamedTuple):
    """Of commands, s: what the clock on the wall says, and what the cores worked, all child processes together."""

    wall: list[float]
    work: list[float]


class Bench:
    """A temporary folder, the compiled-Python cache in it, and the environment of all commands.

    Args:
        folder: everything is written below it.
        repeat: repetitions of short measures; long ones have a third of that, at least three.
    """

    def __init__(self, folder: Path, repeat: int) -> None:
        self.folder = folder
        self.few = max(3, repeat // 3)
        self.many = repeat
        self._number = 0
        self._env = {**os.environ, "PYTHONPYCACHEPREFIX": str(folder / "pycache")}
        # As for any user: compiled Python files are kept.
        self._env.pop("PYTHONDONTWRITEBYTECODE", None)

    def fresh(self) -> Path:
        """A path where nothing is yet."""
        self._number += 1
        return self.folder / f"out{self._number}"

    def timed(self, *command: object, cwd: Path | None = None) -> float:
        """Wall time of a command, s."""
        start = time.perf_counter()
        done = subprocess.run(
            [str(c) for c in command],
            cwd=cwd or ROOT,
            env=self._env,
            capture_output=True,
            text=True,
            check=False,
        )
        wall = time.perf_counter() - start
        if done.returncode != 0:
            raise SystemExit(f"bench: {command} failed:\n{done.stdout}{done.stderr}")
        return wall

    def pn2code(self, *arguments: object) -> float:
        """Wall time of `pn2code`, s."""
        return self.timed(sys.executable, "-m", "pn2code", *arguments)

    def repeated(self, number: int, measure: Callable[[], float]) -> list[float]:
        """Once to warm up, then so many samples."""
        measure()
        return [measure() for _ in range(number)]

    def times(self, number: int, measure: Callable[[], float]) -> Times:
        """The same of a command, with its work."""
        measure()
        out = Times([], [])
        for _ in range(number):
            before = _work()
            out.wall.append(measure())
            out.work.append(_work() - before)
        return out


def _work() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


# --- the command -------------------------------------------------------------------------------


def python_alone(bench: Bench) -> Times:
    """The interpreter that does nothing: what start-up stands beside."""
    return bench.times(bench.many, lambda: bench.timed(sys.executable, "-c", "pass"))


def start_up(bench: Bench) -> Times:
    """`pn2code --version`."""
    return bench.times(bench.many, lambda: bench.pn2code("--version"))


def check_net(bench: Bench) -> Times:
    """`pn2code check` of the riveting net alone."""
    net = bench.folder / "net" / "cell.cpn"
    net.parent.mkdir(exist_ok=True)
    shutil.copy(CELL / "cell.cpn", net)
    return bench.times(bench.many, lambda: bench.pn2code("check", net))


def large_net(pages: int = 60, places: int = 12, transitions: int = 10) -> str:
    """A net with so many places and transitions on each page, in the short form."""
    lines = [
        "net Large", "  standard", "  colset PART = with screw | nut | bolt;",
        "  colset PACKET = product INT * STRING;",
        "  colset ITEM = record id: INT * kind: PART;", "  colset ITEMS = list ITEM;",
        "  var n, m: INT; var s: STRING; var p: PART; var i: ITEM; var l: ITEMS;", "  fun twice x = 2 * x",
        "  fun put (x : ITEM, nil) = [x]",
        "    | put (x : ITEM, y :: r) = if #id x < #id y then x :: y :: r else y :: put (x, r)",
    ]  # fmt: skip
    kinds = ("INT = 1`1 ++ 2`5", 'PACKET = 1`(1, "a")', "ITEM", "ITEMS = 1`[]")
    for page in range(pages):
        lines.append(f"  page Page{page}")
        lines += [f"    place P{k} : {kinds[k % 4]}" for k in range(places)]
        for t in range(transitions):
            k = 4 * (t % (places // 4))
            lines += [
                f'    trans T{t} guard [n < 10, s <> "x"]', f"      in P{k} : n", f"      in P{k + 1} : (m, s)",
                f"      both P{k + 3} : l", f"      out P{k} : if n > 3 then 1`(twice n) else empty",
                f'      out P{k + 1} : (m + 1, s ^ "b")', f"      out P{k + 2} : {{id = n, kind = nut}}",
            ]  # fmt: skip
    return "\n".join(lines)


def check_large(bench: Bench) -> Times:
    """`pn2code check` of a net of 60 pages, 720 places, 600 transitions and 3,600 arcs."""
    net = bench.folder / "large.cpn"
    net.write_bytes(cpn(large_net()))
    return bench.times(bench.few, lambda: bench.pn2code("check", net))


def largest_of_corpus() -> Path | None:
    """The largest net of the collection beside the repository that can be compiled; None without the collection."""
    shared = Path(os.environ.get("PN2CODE_SHARED", ROOT.parent / "shared")) / "corpus" / "nets"
    found = sorted(shared.rglob("*.cpn"), key=lambda p: (-p.stat().st_size, p))
    return next((p for p in found if pipeline.generate(p, Diagnostics()) is not None), None)


def generate_and_build(bench: Bench, net: Path) -> Times:
    """`pn2code generate` into a new folder, and `make` there with two jobs."""

    def once() -> float:
        folder = bench.fresh()
        return bench.pn2code("generate", net, "-o", folder) + bench.timed(
            "make", "-s", "-j2", cwd=folder
        )

    return bench.times(bench.few, once)


def check_cell(bench: Bench) -> Times:
    """`pn2code check` of the riveting cell, with its robots' geometry in all layouts."""
    return bench.times(bench.many, lambda: bench.pn2code("check", CELL))


def generate(bench: Bench) -> Times:
    """`pn2code generate` of the riveting cell into a new folder."""
    return bench.times(
        bench.many, lambda: bench.pn2code("generate", CELL / "cell.cpn", "-o", bench.fresh())
    )


def build(bench: Bench, jobs: int) -> Times:
    """`make` of the generated riveting cell, supervisor and simulate, from nothing."""
    folder = bench.fresh()
    bench.pn2code("generate", CELL / "cell.cpn", "-o", folder)

    def once() -> float:
        bench.timed("make", "-s", "clean", cwd=folder)
        return bench.timed("make", "-s", f"-j{jobs}", cwd=folder)

    return bench.times(bench.few, once)


def run_cell(bench: Bench, *options: str) -> Times:
    """`pn2code run` of the riveting cell from nothing: generate, build, run, report."""
    return bench.times(
        bench.few, lambda: bench.pn2code("run", CELL, "--out", bench.fresh(), *options)
    )


# --- the supervisor ----------------------------------------------------------------------------


@contextmanager
def _memory_folder() -> Iterator[Path]:
    """A folder on tmpfs where there is one."""
    base = "/dev/shm" if Path("/dev/shm").is_dir() else None
    with tempfile.TemporaryDirectory(prefix="pn2code-bench-", dir=base) as name:
        yield Path(name)


def latency(bench: Bench) -> dict[str, list[float]]:
    """Microseconds: `bare p50`, `published p50`, `woken p50` and the same with p99; see cnative/tests/latency.c."""
    program, supervisor = bench.folder / "latency", bench.folder / "quick"
    sources = ["supervisor*.c", "pn_*.c", "port_*.c"]
    host = [f for pattern in sources for f in sorted((CNATIVE / "src").rglob(pattern))]
    tests = CNATIVE / "tests"
    compiler = ("cc", c_flags.STANDARD, *c_flags.FLOATS, "-O2", "-I", CNATIVE / "include")
    bench.timed(*compiler, tests / "latency.c", "-o", program)
    hand = (tests / "hand_net.c", tests / "hand_cell.c")
    bench.timed(*compiler, "-DHAND_DELAY=0", *host, *hand, "-lm", "-o", supervisor)
    inputs = bench.folder / "orders"
    inputs.mkdir()
    (inputs / "orders.txt").write_text(f"{LATENCY_ROUNDS + 100}\n0.5 7\n")
    found: dict[str, list[float]] = {}
    for _ in range(bench.many):
        with _memory_folder() as shared:
            done = subprocess.run(
                [program, shared, supervisor, str(LATENCY_ROUNDS), inputs],
                capture_output=True,
                text=True,
                check=True,
            )
        for line in done.stdout.splitlines():
            kind = re.search(r"^(bare)|(published)|(woken)", line)
            for name, value in re.findall(r"(p50|p99) +([0-9.]+)", line):
                assert kind is not None
                found.setdefault(f"{kind[0]} {name}", []).append(float(value))
    return found


# --- firings -----------------------------------------------------------------------------------


class Firings(NamedTuple):
    """Of one net with random choices, a second: the compiled simulator, the reference token game, SNAKES."""

    compiled: list[float]
    game: list[float]
    snakes: list[float]


def firings(
    bench: Bench, text: str, steps: int, slow_steps: int, peer: Callable[[], object]
) -> Firings:
    """All three in turn, so that what else the machine does falls on all alike."""
    folder = bench.fresh()
    folder.mkdir()
    net = folder / "net.cpn"
    net.write_bytes(cpn(text))
    d = Diagnostics()
    flat = front.load(net, d)
    if flat is None:
        raise SystemExit(f"bench: {render.report(d.sorted())}")
    with programs.program(flat, {}, d) as simulate:
        if simulate is None:
            raise SystemExit(f"bench: {render.report(d.sorted())}")
        program = simulate
        # The start of the process does not count.
        empty = min(bench.repeated(bench.few, lambda: bench.timed(program, "--steps", 0)))
        walls = bench.repeated(bench.few, lambda: bench.timed(program, "--steps", steps))
    compiled = [steps / (wall - empty) for wall in walls]

    def play() -> float:
        game = Game(flat)
        start = time.perf_counter()
        for _ in game.run(lambda elements: elements[-1], slow_steps):
            pass
        return slow_steps / (time.perf_counter() - start)

    def play_peer() -> float:
        return firings_per_second(peer, slow_steps)

    return Firings(compiled, bench.repeated(bench.few, play), bench.repeated(bench.few, play_peer))
