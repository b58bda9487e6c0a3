"""The process that watches `pn2code contest`: all is said at the limit, and no process is left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from helpers.played import PATIENCE_S
from helpers.pnml_nets import arc, net, place, transition

STUCK = """
import os, sys, time
from pn2code.contest import asking, engine, examinations, lines, watchdog
from pn2code.start import main

class Watchdog(watchdog._Watchdog):
    ends = property(lambda self: 0.0 if os.path.exists({flag!r}) else 1e9, lambda self, ends: None)

def is_over():
    open({flag!r}, "w").close()

def stuck(*_, **__):
    print(os.getpid(), file=sys.stderr, flush=True)
    {how}

watchdog._Watchdog = Watchdog
{where} = stuck
main()
"""
"""The time is over when the work has come so far, however long that takes."""
HANGS = "is_over(); sum(range(10 ** 13))"
"""One operation of C, during which no other thread of Python runs and no signal is heard."""
FILE = """<?xml version="1.0"?>
<property-set xmlns="http://mcc.lip6.fr/">
<property><id>Net-a</id><formula>{}</formula></property>
<property><id>Net-b</id><formula>{}</formula></property>
</property-set>
"""
IN_Q = (
    "<exists-path><globally><integer-le><integer-constant>1</integer-constant>"
    "<tokens-count><place>q</place></tokens-count></integer-le></globally></exists-path>"
)


def _folder(path: Path) -> Path:
    text = net(
        place("p", "", "1"),
        place("q"),
        *(transition(t) for t in ("t", "back")),
        *(arc("p", "t"), arc("t", "q"), arc("q", "back"), arc("back", "p")),
        kind="ptnet",
    )
    (path / "model.pnml").write_text(text)
    (path / "CTLCardinality.xml").write_text(FILE.format(IN_Q, IN_Q))
    return path


@contextmanager
def _stuck(folder: Path, examination: str, where: str, how: str) -> Iterator[subprocess.Popen[str]]:
    """The command with a function of its own replaced."""
    flag = folder / "over"
    flag.unlink(missing_ok=True)
    program = STUCK.format(where=where, how=how, flag=str(flag))
    command = [sys.executable, "-c", program, "contest", str(folder), examination]
    process = subprocess.Popen(
        [*command, "--max-seconds", "6000"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        yield process
    finally:
        process.kill()


def _ticks(pid: int) -> int:
    """The processor time of a process."""
    return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[11])


def _has_ended(pid: int) -> bool:
    """Whether a process ends within reasonable time; a zombie has ended."""
    until = time.monotonic() + PATIENCE_S
    while time.monotonic() < until:
        try:
            if Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z":
                return True
        except OSError:
            return True
        time.sleep(0.02)
    return False


def test_what_hangs_in_c_does_not_keep_the_command(tmp_path: Path) -> None:
    """Before the names are known from the questions, they are those of the file."""
    folder = _folder(tmp_path)
    for examination, names in (
        ("CTLCardinality", ["FORMULA Net-a ", "FORMULA Net-b "]),
        ("OneSafe", ["FORMULA OneSafe "]),
        ("StateSpace", [""]),
    ):
        where = "asking.space" if examination == "StateSpace" else "asking.asked"
        with _stuck(folder, examination, where, HANGS) as process:
            said, errors = process.communicate(timeout=PATIENCE_S)
        assert said.splitlines() == [f"{name}CANNOT_COMPUTE" for name in names], errors
        assert process.returncode == 0
        assert _has_ended(int(errors.split()[0]))


def test_what_was_said_is_not_said_again(tmp_path: Path) -> None:
    """The second answer never comes."""
    how = f"yield lines.Result('Net-b', False, 'X')\n    time.sleep(0.1)\n    {HANGS}"
    with _stuck(_folder(tmp_path), "CTLCardinality", "asking.answers", how) as process:
        said, errors = process.communicate(timeout=PATIENCE_S)
    expected = ["FORMULA Net-b FALSE TECHNIQUES X", "FORMULA Net-a CANNOT_COMPUTE"]
    assert said.splitlines() == expected, errors
    assert process.returncode == 0


def test_a_process_that_is_killed_has_said_what_is_open(tmp_path: Path) -> None:
    """As where there is no memory left."""
    how = "os.kill(os.getpid(), 9)"
    with _stuck(_folder(tmp_path), "CTLCardinality", "asking.answers", how) as process:
        said, errors = process.communicate(timeout=PATIENCE_S)
    assert said.splitlines() == [f"FORMULA Net-{x} CANNOT_COMPUTE" for x in "ab"]
    assert "ended by signal 9" in errors and process.returncode == 128 + signal.SIGKILL


def test_signals_end_both(tmp_path: Path) -> None:
    """However the command is ended, nobody works on."""
    folder = _folder(tmp_path)
    for number, code in ((signal.SIGTERM, 130), (signal.SIGINT, 130), (signal.SIGKILL, -9)):
        how = "time.sleep(600)"
        with _stuck(folder, "CTLCardinality", "asking.answers", how) as process:
            assert process.stderr is not None
            worker = int(process.stderr.readline())
            assert worker != process.pid
            os.kill(process.pid, number)
            said, _ = process.communicate(timeout=PATIENCE_S)
        assert not said and process.returncode == code
        assert _has_ended(worker)


def test_an_engine_ends_with_who_has_started_it(tmp_path: Path) -> None:
    """A walk towards what is not reachable has no end of its own."""
    program = f"""
import os, signal
from pathlib import Path
from pn2code.contest import engine
from pn2code.contest.tables import Tables
from pn2code.diagnostics import Diagnostics

tables = Tables((1,), ({{0: 1}},), ({{0: 1}},), {{"p": (0,)}}, {{"t": (0,)}})
with engine.engine(Diagnostics()) as made:
    path = Path({str(tmp_path / "net")!r})
    path.write_text(tables.text(["0 reach not sum 1 0 1 1"]))
    started = engine._started(made, path, engine.Task("walk", "", 3000.0, 100))
    print(started.pid, flush=True)
    input()
    os.kill(os.getpid(), signal.SIGKILL)
"""
    command = [sys.executable, "-c", program]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    pid = int(process.stdout.readline())
    until = time.monotonic() + PATIENCE_S
    while _ticks(pid) < 5:  # it says at its start that it wants to end so
        assert time.monotonic() < until
        time.sleep(0.02)
    process.communicate("\n", timeout=PATIENCE_S)
    assert _has_ended(pid)


def test_a_command_that_is_loaded_too_late_says_what_is_open(tmp_path: Path) -> None:
    """The time is over before the work begins."""
    program = """
import time
from pn2code.base import deadline
from pn2code.contest import watchdog

deadline.note_start()
late = deadline.Deadline(6.0, 0.0)
watchdog.watched(late, ["Net-a", "Net-b"])
time.sleep(600)
"""
    done = subprocess.run(
        [sys.executable, "-c", program],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    assert done.stdout.splitlines() == [f"FORMULA Net-{x} CANNOT_COMPUTE" for x in "ab"]
    assert done.returncode == 0, done.stderr
