"""Nets that are too large, too deep or endless: a clear message or success, with bounded memory."""

from __future__ import annotations

import resource
import signal
import subprocess
import time
from contextlib import nullcontext
from pathlib import Path

import pytest

from helpers import processes
from helpers.netbuilder import cpn
from helpers.processes import Command
from helpers.thorough import THOROUGH, amount
from pn2code.semantics.evaluation.evaluate import Limits
from pn2code.semantics.game import token_game
from pn2code.simulate import compiled, programs

GIGABYTE = 1 << 30


def bounded() -> None:
    """At most 1 GB more than the process has, which is a copy of one that has run many tests before."""
    status = Path("/proc/self/status").read_text()
    (has_kb,) = (int(x.split()[1]) for x in status.splitlines() if x.startswith("VmData:"))
    most = GIGABYTE + has_kb * 1024
    resource.setrlimit(resource.RLIMIT_DATA, (most, most))


def impatient() -> None:
    """The same, and an initial marking is given up after fewer steps."""
    bounded()
    assert token_game.AT_START.steps is not None
    token_game.AT_START = Limits(steps=token_game.AT_START.steps // 40)


def pn2code(*arguments: object) -> subprocess.CompletedProcess[str]:
    """The command with 1 GB."""
    return processes.pn2code(*map(str, arguments), prepare=bounded)


def check(folder: Path, data: bytes) -> subprocess.CompletedProcess[str]:
    path = folder / "net.cpn"
    path.write_bytes(data)
    return pn2code("check", path, "--format", "concise")


def test_a_file_beyond_the_limit_is_refused_unread(tmp_path: Path) -> None:
    path = tmp_path / "net.cpn"
    with path.open("wb") as file:
        file.write(b"<?xml version='1.0'?><workspaceElements>")
        file.truncate(101 * 1024 * 1024)
    done = pn2code("check", path)
    assert done.returncode == 1
    assert "file-too-large" in done.stdout + done.stderr


def test_a_hundred_megabytes_of_elements_are_refused(tmp_path: Path) -> None:
    """They are too many after the first sixteen."""
    one = b"<place id='ID1'><text>A</text></place>\n"
    head, tail = b"<workspaceElements><cpnet><page id='P'>", b"</page></cpnet></workspaceElements>"
    size = amount(17, 100) * 1024 * 1024 - len(head) - len(tail)
    done = check(tmp_path, head + one * (size // len(one)) + tail)
    assert done.returncode == 1
    assert "xml-limit" in done.stdout + done.stderr


def test_ten_thousand_places(tmp_path: Path) -> None:
    count = amount(3_000, 10_000)
    places = "\n".join(f"  place P{i} : INT = 1`{i}" for i in range(count))
    done = check(tmp_path, cpn(f"net Many\n  standard\n{places}\n"))
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"{count} places" in done.stdout


def test_a_thousand_pages(tmp_path: Path) -> None:
    text = "net Pages\n  standard\n  var n: INT;\n"
    count = amount(300, 1_000)
    for i in range(count):
        text += f"  page Page{i}\n    place P : INT = 1`1\n    trans T\n      in P : n\n"
    done = check(tmp_path, cpn(text))
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"{count} pages" in done.stdout


def test_ten_thousand_constructors(tmp_path: Path) -> None:
    constructors = " | ".join(f"c{i}" for i in range(10_000))
    text = f"net Constructors\n  standard\n  colset C = with {constructors};\n  place P : C = C.all()\n"
    done = check(tmp_path, cpn(text))
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    "term", ["1`1 ++ ", "n" * 1_000 + " + ", "(", "[", "1 :: ", "~", "fn x => ", '"' + "a" * 1_000]
)
def test_a_megabyte_of_inscription(tmp_path: Path, term: str) -> None:
    text = term * (1_000_000 // len(term)) + "1`1"
    net = cpn("net Long\n  standard\n  place P : INT = XXX\n").replace(b"XXX", text.encode())
    done = check(tmp_path, net.replace(b"&&", b"&amp;&amp;"))
    said = done.stdout + done.stderr
    assert done.returncode in (0, 1), said[-2000:]
    assert "internal error" not in said
    assert done.returncode == 0 or "error" in said


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("let fun f x = f (x + 1) handle Overflow => f 0 in f 0 end", "given up"),
        ("let fun f x = 1 + f x in f 0 end", "given up"),
        ('let fun f x = f (x ^ x) in f "ab" end', "Size"),
        ("let fun f x = f (x ++ x) in f (1`1) end", "5,000,000"),
        ("1000000000`1", "5,000,000"),
        ("List.tabulate (1000000000, fn i => i)", "5,000,000"),
        ("IntInf.toInt (IntInf.pow (IntInf.fromInt 3, 1000000000))", "bits"),
    ],
)
def test_an_endless_or_huge_initial_marking_is_given_up(
    tmp_path: Path, text: str, said: str
) -> None:
    """After fewer steps than for users, but in `make thorough`."""
    path = tmp_path / "net.cpn"
    path.write_bytes(cpn(f"net Endless\n  standard\n  place P : INT = {text}\n"))
    done = processes.pn2code("marking", path, prepare=bounded if THOROUGH else impatient)
    assert done.returncode == 1
    assert said in done.stdout + done.stderr
    assert "initial marking" in done.stdout + done.stderr


def test_an_endless_loop_in_an_initial_marking_is_given_up(tmp_path: Path) -> None:
    """It needs no more memory for more steps, so it is given up after fewer than for users."""
    path = tmp_path / "net.cpn"
    path.write_bytes(cpn("net Endless\n  standard\n  place P : INT = (while true do (); 1)\n"))
    done = processes.pn2code("marking", path, prepare=impatient)
    assert done.returncode == 1
    assert "no end after 250000 steps" in done.stdout + done.stderr
    assert "initial marking" in done.stdout + done.stderr


@pytest.mark.cc
@pytest.mark.parametrize(
    ("guard", "said"),
    [("let fun f x = 1 + f x in f n > 0 end", ("recurs", "deep", "stack"))],
)
def test_deep_recursion_in_a_compiled_guard_is_an_error(
    tmp_path: Path, guard: str, said: tuple[str, ...]
) -> None:
    path = tmp_path / "net.cpn"
    net = f"net Deep\n  standard\n  var n: INT;\n  place P : INT = 1`1\n  trans T guard [{guard}]\n    in P : n\n"
    path.write_bytes(cpn(net))
    done = pn2code("simulate", path, "--steps", 5, "--engine", "compiled")
    text = done.stdout + done.stderr
    assert done.returncode not in (0, 70, -11), text
    assert any(word in text for word in said), text


ENDLESS = """
    net Endless
      standard
      var n: INT;
      place P : INT = 1`1
      trans T guard [(while true do (); n > 0)]
        in P : n
"""


@pytest.mark.cc
def test_an_endless_guard_in_a_compiled_net_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "net.cpn"
    path.write_bytes(cpn(ENDLESS))
    done = pn2code("simulate", path, "--engine", "compiled")
    assert done.returncode == 1
    assert "an evaluation without end" in done.stderr


SILENT = """#!/bin/sh
trap '' INT
touch "$(dirname "$0")/has-begun"
exec sleep 1000
"""


@pytest.mark.cc
@pytest.mark.parametrize("is_told", [True, False])
def test_a_compiled_net_that_says_nothing_is_given_up(tmp_path: Path, is_told: bool) -> None:
    """Ctrl-C ends it, and so does time. A program that hears nothing and says nothing stands for the net's."""
    path = tmp_path / "net.cpn"
    path.write_bytes(cpn(ENDLESS))
    silent = tmp_path / "silent"
    silent.write_text(SILENT)
    silent.chmod(0o755)

    def prepare() -> None:
        programs.program = lambda *_, **__: nullcontext(silent)
        compiled.ENDLESS_S = 1000.0 if is_told else 0.0
        compiled.GRACE_S = 0.0

    command = Command("simulate", path, "--engine", "compiled", prepare=prepare)
    if is_told:
        while not (tmp_path / "has-begun").exists():
            assert command.poll() is None
            time.sleep(0.01)
        command.signal(signal.SIGINT)
    done = command.done()
    if is_told:
        assert (done.returncode, done.stderr) == (130, "pn2code: interrupted\n")
    else:
        assert done.returncode == 1
        assert "error[simulator-failed]: the run was stopped" in done.stderr
        assert "does not end" in done.stderr
