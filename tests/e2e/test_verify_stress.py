"""`pn2code verify` killed, interrupted, without room or time: what is not known is not said, and nothing is left."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from helpers.explored import Explorers, wide
from helpers.netbuilder import flat, write
from helpers.processes import Command, pn2code
from helpers.thorough import amount
from pn2code.base.private_folder import private_folder
from pn2code.verify.exploring.programs import Sizes

pytestmark = [
    pytest.mark.cc,
    pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="looks at /proc"),
]

NET = """
    net Steps
      val last = 1000;
      colset C = int with 0..last;
      var n : C;
""" + "".join(
    f"""
      place P{i} : C = 1`0
      trans Up{i} guard [n < last]
        in P{i} : n
        out P{i} : n + 1
"""
    for i in range(4)
)
SMALL, NODES, STEPS = ("--set", "last=2"), 3**4, 8
ENDLESS = ("--most-traces", "0", "--max-seconds", "600")
FOUND_S = 600.0
HANGS = b"explore/search"


@pytest.fixture(scope="module")
def net(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Without an end for us; SMALL: with NODES, and STEPS to the dead one."""
    return write(NET, tmp_path_factory.mktemp("stress") / "steps.cpn")


@pytest.fixture
def room(tmp_path: Path) -> Path:
    """For temporary files: whatever is left there is wrong."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    return folder


def within(room: Path, **more: str) -> Callable[[], None]:
    def prepare() -> None:
        os.environ.update({"TMPDIR": str(room), **more})
        tempfile.tempdir = None  # what the tests' process found is forgotten

    return prepare


def children(pid: int) -> list[int]:
    """Direct ones, of all threads: the runtime is compiled by others than the net."""
    found: list[int] = []
    with suppress(OSError):
        for task in Path(f"/proc/{pid}/task").iterdir():
            with suppress(OSError):  # a thread that has ended
                found += map(int, (task / "children").read_text().split())
    return found


def waited_for(command: Command, word: bytes) -> int:
    """The child whose command line has the word, as soon as there is one."""
    until = time.monotonic() + FOUND_S
    while time.monotonic() < until and command.poll() is None:
        for child in children(command.pid):
            with suppress(OSError):
                if word in Path(f"/proc/{child}/cmdline").read_bytes():
                    return child
        time.sleep(0.005)
    raise TimeoutError(f"{word!r} was not started")


def is_over(pid: int) -> bool:
    """Whether a process ends."""
    until = time.monotonic() + FOUND_S
    while time.monotonic() < until:
        with suppress(OSError):
            if Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z":
                time.sleep(0.01)
                continue
        return True
    return False


def is_explored(pid: int) -> bool:
    """Whether the explorer listens to signals already."""
    caught = Path(f"/proc/{pid}/status").read_text().partition("SigCgt:")[2].split()[0]
    return bool(int(caught, 16) & (1 << (signal.SIGINT - 1)))


def explorer_of(command: Command) -> int:
    pid = waited_for(command, b"--progress-every")
    until = time.monotonic() + FOUND_S
    while not is_explored(pid) and time.monotonic() < until:
        time.sleep(0.005)
    return pid


def test_the_explorer_is_killed(net: Path, room: Path, tmp_path: Path) -> None:
    report, picture = tmp_path / "r.html", tmp_path / "g.svg"
    files = ("--report", report, "--draw", picture)
    command = Command("verify", net, "--json", *ENDLESS, *files, prepare=within(room))
    os.kill(explorer_of(command), signal.SIGKILL)
    done = command.done()
    assert (done.returncode, done.stdout) == (1, "")
    assert "error[explorer-failed]: the explorer was ended by signal 9" in done.stderr
    assert not report.exists()
    assert not list(room.iterdir())


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_while_it_explores(
    net: Path, room: Path, tmp_path: Path, number: signal.Signals
) -> None:
    report, plot = tmp_path / "r.html", tmp_path / "p.svg"
    files = ("--report", report, *(("--plot", plot) if number == signal.SIGINT else ()))
    command = Command("verify", net, "--json", *ENDLESS, *files, prepare=within(room))
    explorer = explorer_of(command)
    command.signal(number)
    done = command.done()
    said = json.loads(done.stdout)
    assert (done.returncode, said["complete"], said["why"]) == (3, False, "interrupted")
    assert "Partial: it was interrupted" in report.read_text()
    assert number != signal.SIGINT or "truncated (interrupted)" in plot.read_text()
    assert is_over(explorer)
    assert not list(room.iterdir())


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM][: amount(1, 2)])
def test_interrupted_while_it_compiles(
    net: Path, room: Path, tmp_path: Path, number: signal.Signals
) -> None:
    cache = tmp_path / "cache"
    prepare = within(room, XDG_CACHE_HOME=str(cache), CC=str(one_that_hangs(tmp_path)))
    command = Command("verify", net, "--json", *ENDLESS, prepare=prepare)
    compiler = waited_for(command, HANGS)
    command.signal(number)
    done = command.done()
    said = json.loads(done.stdout)
    assert (done.returncode, said["complete"], said["nodes"]) == (3, False, 0)
    assert "c-error" not in done.stderr
    assert is_over(compiler)
    assert not list(room.iterdir())
    # Nothing but objects of the runtime, for whoever compiles it next.
    left = [*(cache / "pn2code" / "programs").rglob("*")]
    assert all(
        (p if p.is_dir() else p.parent).name.startswith("build-explore-runtime-") for p in left
    ), left
    assert all(p.is_dir() or p.suffix == ".o" for p in left), left


def one_that_hangs(folder: Path) -> Path:
    """A C compiler that does not end with one of the runtime's sources."""
    fifo, compiler = folder / "never", folder / "compiler"
    os.mkfifo(fifo)
    compiler.write_text(
        f"""#!/bin/sh
case "$*" in *{HANGS.decode()}*) read x < '{fifo}';; esac
exec {shutil.which("cc")} "$@"
"""
    )
    compiler.chmod(0o755)
    return compiler


def test_killed_with_its_explorer(net: Path) -> None:
    """Nobody is left who could end it."""
    command = Command("verify", net, *ENDLESS)
    explorer = explorer_of(command)
    command.kill()
    assert is_over(explorer)


def test_two_at_once(net: Path, tmp_path: Path) -> None:
    """In one folder, with one cache: each finds what it would find alone."""
    cache = tmp_path / "cache" / "pn2code" / "programs"
    cache.mkdir(parents=True, mode=0o700)
    cache.parent.chmod(0o700)
    own = private_folder()
    for runtime in (
        own.glob("programs/explore-runtime-*.a*") if own else ()
    ):  # it takes long to compile
        shutil.copy(runtime, cache)
    before = sorted(cache.iterdir())
    prepare = within(tmp_path, XDG_CACHE_HOME=str(tmp_path / "cache"))
    folder = tmp_path / "traces"
    options = (*SMALL, "--traces", folder, "--report", folder / "report.txt", "--json")
    both = [Command("verify", net, *options, prepare=prepare) for _ in range(2)]
    for command in both:
        done = command.done()
        said = json.loads(done.stdout)
        assert (done.returncode, said["nodes"], said["dead_markings"]) == (0, NODES, 1)
        assert done.stderr == ""
    (trace, report) = sorted(folder.iterdir(), key=lambda path: path.suffix)
    assert len(trace.read_text().splitlines()) == 1 + STEPS + 1
    assert f"Nodes:  {NODES}\n" in report.read_text()
    (_,) = {p for p in cache.iterdir() if p.suffix != ".sum"} - set(before)


def test_little_of_everything(net: Path, tmp_path: Path) -> None:
    """Of time, of memory: partial, and everything says so."""
    for options, why in (
        (("--memory", "16", "--threads", "64", "--no-unfold", "--no-sweep"), "memory"),
    ):
        report = tmp_path / "r"
        done = pn2code("verify", net, "--json", *options, "--report", report, *ENDLESS[:2])
        said = json.loads(done.stdout)
        assert (done.returncode, said["complete"], said["why"]) == (3, False, why), options
        assert "PARTIAL: the limit of" in report.read_text()
        assert said["home_markings"] is said["live_transitions"] is None


def test_no_time_at_all(net: Path, tmp_path: Path) -> None:
    """Reading the net counts, too: then nothing is known, and that is what is said."""
    done = pn2code("verify", net, "--json", "--max-seconds", "0", "--report", tmp_path / "r")
    said = json.loads(done.stdout)
    assert (done.returncode, said["complete"], said["why"], said["nodes"]) == (
        3,
        False,
        "seconds",
        0,
    )
    assert "warning[time-over]" in done.stderr
    assert not (tmp_path / "r").exists()


def test_no_time_for_the_graph(explorers: Explorers) -> None:
    """Time that ends while components are sought is not memory."""
    steps = flat(NET, {"last": "6"})
    folder = explorers.build(steps, wide(Sizes.start(steps, {}), 4), "no_time")
    for phase in ("explore", "graph", "components"):
        assert explorers.said(folder, "--ends-in", phase).report["why"] == "seconds"
    assert explorers.said(folder).report["why"] == "complete"


@pytest.fixture(scope="module")
def small_disk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A file system that is soon full."""
    folder = tmp_path_factory.mktemp("disk")
    mount = ["mount", "-t", "tmpfs", "-o", "size=256k,nr_inodes=60", "tmpfs", str(folder)]
    if subprocess.run(mount, check=False, capture_output=True).returncode != 0:
        pytest.skip("only root can mount a small disk")
    yield folder
    subprocess.run(["umount", "-l", str(folder)], check=True)


def test_a_full_disk(net: Path, small_disk: Path, tmp_path: Path) -> None:
    # Tables: what was seen until then.
    spill = ("--spill", small_disk, "--no-graph", "--no-unfold")
    done = pn2code("verify", net, "--json", *ENDLESS, *spill)
    said = json.loads(done.stdout)
    assert (done.returncode, said["complete"], said["why"]) == (3, False, "memory")
    assert "warning[spill-full]" in done.stderr
    # Neither the cache nor the folder for temporary files has room for a compiled net.
    both = within(small_disk, XDG_CACHE_HOME=str(small_disk))
    done = pn2code("verify", net, "--set", "last=3", prepare=both)
    assert done.returncode == 1
    assert "warning[program-cache]" in done.stderr
    assert "error[build-failed]: there is no room" in done.stderr
    # Files: none of them is there by half, and the result is told.
    with suppress(OSError), (small_disk / "fill").open("wb", buffering=0) as file:
        while file.write(bytes(4096)):
            pass
    before = sorted(small_disk.rglob("*"))
    files = ("--report", small_disk / "r.txt", "--draw", small_disk / "g.svg")
    plot = ("--plot", small_disk / "p.svg", "--traces", small_disk)
    done = pn2code("verify", net, *SMALL, "--json", *files, *plot)
    said = json.loads(done.stdout)
    known = (done.returncode, said["complete"], said["nodes"], said["traces"])
    assert known == (2, True, NODES, [])
    assert done.stderr.count("error[report-unwritable]") == 3
    assert "warning[dead-trace-unwritable]" in done.stderr
    assert sorted(small_disk.rglob("*")) == before


def test_nobody_reads_it(net: Path) -> None:
    def prepare() -> None:
        sys.stdout = open("/dev/full", "w")  # noqa: SIM115, PTH123 - for as long as the process lives

    done = pn2code("verify", net, *SMALL, "--json", *ENDLESS[:2], prepare=prepare)
    assert done.returncode == 2
    assert done.stderr == "pn2code: cannot write: no space left on device\n"
