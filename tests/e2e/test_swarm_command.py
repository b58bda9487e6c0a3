"""`pn2code verify --swarm` on real workers of `dask.distributed`: the same answers whoever carries out the searches."""

from __future__ import annotations

import importlib.util
import json
import os
import signal
import time
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from helpers.netbuilder import flat, write
from helpers.processes import DEADLINE_S, Command, pn2code
from helpers.swarms import Inline
from pn2code.diagnostics import Diagnostics
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.swarm.pool import Swarm

pytestmark = pytest.mark.cc

NET = """
    net Crowd
      colset INT = int;
      var n, k : INT;
      place P : INT = 1`1 ++ 1`2 ++ 1`3 ++ 1`4 ++ 1`5 ++ 1`6 ++ 1`7
      place Q : INT
      place R : INT
      trans Go
        in P : n
        out Q : n
      trans Back
        in Q : n
        out P : n
      trans Meet guard [n < k]
        in Q : n
        in Q : k
        out R : n
        out R : k
"""
ENDLESS = """
    net Endless
      colset INT = int;
      var n : INT;
      place P : INT = 1`0
      place Q : INT = 1`0
      trans Up
        in P : n
        out P : n + 1
      trans Side
        in Q : n
        out Q : n + 1
"""
ASKED = (
    *("--property", "never { size (Mark.Top'R 1) > 5 }"),
    *("--property", "reachable { size (Mark.Top'R 1) = 2 }"),
    *("--property", "bound Top'P <= 7"),
)


def row(text: str) -> dict[str, Any]:
    """What is said, without times and the number of workers."""
    said: dict[str, Any] = json.loads(text)
    for key in ("seconds", "states_per_second", "compile_seconds", "peak_mib"):
        del said[key]
    del said["swarm"]["workers"]
    return said


def test_it_is_there() -> None:
    """What tests here need is installed with the rest: without it they fail, and are not passed over."""
    assert importlib.util.find_spec("distributed") is not None


def processes_of(parent: int, word: str) -> list[int]:
    """Processes below one that have a word in what they were started with."""
    below = {parent}
    found = []
    for status in sorted(Path("/proc").glob("[0-9]*"), key=lambda p: int(p.name)):
        with suppress(OSError):
            own = (status / "stat").read_text().rpartition(")")[2].split()
            if int(own[1]) in below and own[0] != "Z":
                below.add(int(status.name))
                if word in (status / "cmdline").read_text():
                    found.append(int(status.name))
    return found


def first_of(command: Command, word: str) -> int:
    """The first such process, as soon as there is one."""
    until = time.monotonic() + DEADLINE_S
    while not (found := processes_of(command.pid, word)):
        assert command.poll() is None and time.monotonic() < until
        time.sleep(0.02)
    return found[0]


def gone(pid: int) -> bool:
    """Whether a process has ended."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


def test_one_worker_or_two(tmp_path: Path) -> None:
    """A violation ends the swarm; what it says, and its runs, are the same."""
    net = write(NET, tmp_path / "crowd.cpn")
    asked = ("verify", net, "--swarm", "6", *ASKED, "--traces", tmp_path / "t", "--json")
    one = pn2code(*map(str, asked), "--workers", "1")
    assert one.returncode == 1, one.stderr
    said = row(one.stdout)
    assert (said["complete"], said["why"], said["approximation"]["kind"]) == (
        False,
        "swarm",
        "swarm",
    )
    never, reachable, bound = said["properties"]
    assert (never["answer"], reachable["answer"], bound["answer"]) == ("no", "yes", "inconclusive")
    assert never["evidence"]["confirmed"] and reachable["evidence"]["confirmed"]
    assert Path(never["evidence"]["trace"]).is_file()
    runs = {p.name: p.read_bytes() for p in (tmp_path / "t").iterdir()}
    two = pn2code(*map(str, asked), "--workers", "2")
    assert row(two.stdout) == said
    assert {p.name: p.read_bytes() for p in (tmp_path / "t").iterdir()} == runs


def test_a_worker_elsewhere_compiles_the_net_itself(tmp_path: Path) -> None:
    """And finds the same."""
    net, found = flat(NET), []
    for is_here in (True, False):
        swarm = Swarm(4, Inline(is_here=is_here))
        limits = Limits(max_states=1_000, memory=32, swarm=swarm)
        d = Diagnostics()
        own = explore(net, {}, limits, d, ExploreOptions(traces=tmp_path))
        assert own is not None and not list(d)
        found.append(replace(own, seconds=0.0, compile_seconds=0.0, peak_mib=0.0))
    assert found[0] == found[1]
    assert found[0].swarm is not None and found[0].swarm["counted"] == 4


def test_a_killed_worker_is_replaced(tmp_path: Path) -> None:
    """Its explorer ends with it, and another one does its search again. After Ctrl-C nothing is left."""
    net = write(ENDLESS, tmp_path / "endless.cpn")
    command = Command(
        *("verify", net, "--swarm", "2", "--workers", "1", "--max-states", "900000000000"),
        *("--memory", "1000", "--most-traces", "0", "--json"),
    )
    explorer = first_of(command, "--swarm\0")
    worker = int(Path(f"/proc/{explorer}/stat").read_text().rpartition(")")[2].split()[1])
    os.kill(worker, signal.SIGKILL)
    while not gone(explorer):
        time.sleep(0.01)
    again = first_of(command, "--swarm\0")
    workers = processes_of(command.pid, "spawn_main")
    assert again != explorer and workers and worker not in workers
    command.signal(signal.SIGINT)
    done = command.done()
    said = json.loads(done.stdout)
    assert (done.returncode, said["why"]) == (3, "interrupted")
    assert all(gone(pid) for pid in (again, *workers))
