"""`pn2code verify` as a command: exit codes, what it says when it is stopped, and its JSON."""

from __future__ import annotations

import json
import signal
import time
from contextlib import suppress
from pathlib import Path

import pytest

from helpers.netbuilder import write
from helpers.processes import Command, pn2code

pytestmark = pytest.mark.cc

NET = """
    net Steps
      colset INT = int;
      var n, k : INT;
      val last = 1000000000;
      place P : INT = 1`0
      place Q : INT = 1`3
      trans Up guard [n < last]
        in P : n
        out P : n + 1
      trans Down guard [k > 0]
        in Q : k
        out Q : k - 1
"""
RAISES = """
    net Raises
      colset INT = int;
      var n : INT;
      place P : INT = 1`2
      trans T
        in P : n
        out P : n - 1 + 0 * (6 div n)
"""
MEMBERS = {
    "complete", "nodes", "arcs", "scc_nodes", "scc_arcs", "dead_markings", "home_markings", "dead_transitions",
    "live_transitions", "fairness", "bounds", "seconds", "states_per_second", "bytes_per_state", "peak_mib",
    "compile_seconds", "reductions",
}  # fmt: skip


@pytest.fixture(scope="module")
def net(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(NET, tmp_path_factory.mktemp("steps") / "steps.cpn")


@pytest.mark.usefixtures("as_delivered")
def test_complete(net: Path, tmp_path: Path) -> None:
    done = pn2code(
        "verify", net, "--set", "last=4", "--json", "--traces", tmp_path, "--report", tmp_path / "r"
    )
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    assert set(said) >= MEMBERS
    assert set(said["fairness"]) == {"impartial", "fair", "just", "none"}
    assert set(said["bounds"][0]) >= {"page", "instance", "name", "lower", "upper"}
    assert (said["nodes"], said["arcs"], said["dead_markings"]) == (20, 31, 1)
    assert (said["home_markings"], said["scc_nodes"], said["reductions"]) == (1, 20, [])
    assert "     Nodes:  20\n     Arcs:   31\n" in (tmp_path / "r").read_text()
    (trace,) = tmp_path.glob("*.trace.jsonl")
    assert said["traces"][0]["steps"] == 7
    replayed = pn2code(
        "simulate", net, "--set", "last=4", "--replay", trace, "--engine", "reference"
    )
    assert replayed.returncode == 0, replayed.stderr


def test_truncated(net: Path, tmp_path: Path) -> None:
    """Of a space without end: so many states, so many seconds, so much memory."""
    for option, value, why in (
        ("--max-states", "100", "states"),
        ("--max-seconds", "2", "seconds"),  # with what comes before the exploration
        ("--memory", "16", "memory"),
    ):
        alone = ("--no-unfold", "--json", "--most-traces", "0")
        done = pn2code("verify", net, option, value, *alone)
        said = json.loads(done.stdout)
        assert (done.returncode, said["complete"], said["why"]) == (3, False, why), option
        assert said["nodes"] >= 100 or why == "seconds"
        assert said["home_markings"] is None
        assert said["live_transitions"] is None
    options = ("--max-states", "100", "--no-unfold", "--quiet")
    done = pn2code("verify", net, *options, "--report", tmp_path / "r")
    assert done.returncode == 3
    text = (tmp_path / "r").read_text()
    assert "PARTIAL: the limit of states was reached" in text
    assert "Status: Partial" in text


@pytest.mark.parametrize(
    "arguments",
    [("verify", "--max-seconds"), ("run", "--realtime", "--speed"), ("robot", "--wait")],
    ids=" ".join,
)
def test_no_number(net: Path, arguments: tuple[str, ...]) -> None:
    verb, *options = arguments
    done = pn2code(verb, net, *options, "nan")
    assert done.returncode == 2
    assert "nan is not a finite number" in " ".join(done.stderr.split())


@pytest.mark.usefixtures("here")
def test_an_exception_in_a_marking(tmp_path: Path) -> None:
    done = pn2code("verify", write(RAISES, tmp_path / "raises.cpn"), "--json")
    said = json.loads(done.stdout)
    assert (done.returncode, said["complete"], said["why"]) == (1, False, "error")
    assert "Div" in done.stderr
    assert "`T`" in done.stderr
    assert said["nodes"] == 3


def test_what_cannot_be_written(net: Path) -> None:
    """A trace is a warning: the verdict stands. A report that was asked for is refused before anything is done."""
    done = pn2code("verify", net, "--set", "last=4", "--quiet", "--traces", "/proc/self")
    assert done.returncode == 0
    assert "warning[dead-trace-unwritable]" in done.stderr
    done = pn2code(
        "verify", net, "--set", "last=4", "-q", "--most-traces", "0", "--report", "/no/r"
    )
    assert done.returncode == 2
    assert "cannot write `/no/r`" in done.stderr and "nodes" not in done.stdout


def test_approximation(net: Path, tmp_path: Path) -> None:
    for kind in ("hash", "bitstate"):
        said = pn2code(
            "verify", net, "--set", "last=4", "--approximate", kind, "--report", tmp_path / kind
        )
        assert said.returncode == 3
        text = (tmp_path / kind).read_text()
        assert f"APPROXIMATE ({kind})" in text
        assert "the probability" in text
        assert "Dead Markings\n     1\n" in text


def explorer_of(command: Command) -> bool:
    """Whether the explorer runs."""
    children = Path(f"/proc/{command.pid}/task/{command.pid}/children").read_text().split()
    for child in children:
        with suppress(OSError):
            if b"--max-seconds" in Path(f"/proc/{child}/cmdline").read_bytes():
                return True
    return False


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="looks at /proc")
def test_interrupted(net: Path) -> None:
    command = Command("verify", net, "--json", "--most-traces", "0", "--max-seconds", "600")
    try:
        until = time.monotonic() + 600.0
        while not explorer_of(command) and time.monotonic() < until:
            time.sleep(0.02)
        command.signal(signal.SIGINT)
        done = command.done()
    finally:
        command.kill()
    said = json.loads(done.stdout)
    assert (done.returncode, said["complete"], said["why"]) == (3, False, "interrupted")
