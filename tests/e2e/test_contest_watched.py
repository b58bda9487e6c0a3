"""The process that watches `pn2code contest`: all is said at the limit, and nobody works on but compilers."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from helpers.played import PATIENCE_S
from helpers.pnml_nets import arc, net, place, transition
from helpers.thorough import amount
from pn2code.cli.main import _command
from pn2code.cli.options import Exit
from pn2code.contest import watchdog

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
    with _running([*command, "--max-seconds", "6000"]) as process:
        yield process


@contextmanager
def _running(
    command: list[str], own: dict[str, str] | None = None
) -> Iterator[subprocess.Popen[str]]:
    """A command, perhaps with variables of its own."""
    process = subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, **(own or {})},
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


LATE = """
import os, sys
from pn2code.contest import watchdog
from pn2code.start import main

class Watchdog(watchdog._Watchdog):
    ends = property(lambda self: 0.0 if os.path.exists({flag!r}) else 1e9, lambda self, ends: None)

class Late:
    def find_spec(self, name, path=None, target=None):
        if name == "pn2code.cli":
            print(os.getpid(), file=sys.stderr, flush=True)
            open({flag!r}, "w").close()
            sum(range(10 ** 13))

watchdog._Watchdog = Watchdog
sys.meta_path.insert(0, Late())
main()
"""
"""The time is over while the command is loaded."""


def test_a_command_is_watched_before_it_is_loaded(tmp_path: Path) -> None:
    folder = _folder(tmp_path)
    program = LATE.format(flag=str(tmp_path / "over"))
    for words in (["--max-seconds", "6000"], ["--max-seconds=6000", "--memory", "100"], []):
        (tmp_path / "over").unlink(missing_ok=True)
        command = [sys.executable, "-c", program, "contest", *words, str(folder), "CTLCardinality"]
        with _running(command) as process:
            said, errors = process.communicate(timeout=PATIENCE_S)
        assert said.splitlines() == [f"FORMULA Net-{x} CANNOT_COMPUTE" for x in "ab"], errors
        assert process.returncode == 0
        assert _has_ended(int(errors.split()[0]))


def test_wrong_arguments_are_told_by_the_command(tmp_path: Path) -> None:
    """Whoever watches knows the options, and leaves what is wrong to the one that works."""
    options = {name for p in _command("contest").params for name in p.opts if name.startswith("-")}
    assert options == {*watchdog.OPTIONS}
    folder = str(_folder(tmp_path))
    for words in (
        [folder],
        [folder, "Nothing"],
        [folder, "OneSafe", "--max-seconds", "soon"],
        [folder, "OneSafe", "--max-seconds", "nan"],
        [folder, "OneSafe", "--max-seconds", "-1"],
        [folder, "OneSafe", "--max-seconds"],
        [folder, "OneSafe", "--other", "1"],
        [folder, "OneSafe", "--memory", "much"],
    )[:: amount(3, 1)]:
        done = subprocess.run(
            [sys.executable, "-m", "pn2code", "contest", *words],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=PATIENCE_S,
            check=False,
        )
        assert (done.returncode, done.stdout) == (Exit.USAGE, ""), words
        assert "Traceback" not in done.stderr, done.stderr


COMPILER = """#!/bin/sh
case "$*" in *--version*) echo fake 1.0; exit;; esac
for made; do :; done
case " $* " in
*" -c "*) made=${made##*/}; made=${made%.c}.o;;
*) made=program;;
esac
echo "$made" >> "$SAID"
while [ ! -e "$GO" ]; do sleep 0.05; done
: > "$made"; chmod +x "$made"
"""
"""It says what it is to make, and makes nothing of it once it may."""


def test_an_engine_is_compiled_although_the_time_is_over(tmp_path: Path) -> None:
    """Two commands have no time for it; it is compiled once, and kept."""
    folder = _folder(tmp_path)
    compiler, said, go, cache = (tmp_path / name for name in ("cc", "said", "go", "cache"))
    compiler.write_text(COMPILER)
    compiler.chmod(0o755)
    own = {"CC": str(compiler), "SAID": str(said), "GO": str(go), "XDG_CACHE_HOME": str(cache)}
    flag = tmp_path / "over"
    program = STUCK.format(where="asking.asked", how="pass", flag=str(flag))
    command = [sys.executable, "-c", program, "contest", str(folder), "OneSafe"]
    try:
        for _ in range(2):
            flag.unlink(missing_ok=True)
            with _running(command, own) as process:
                _await(said.exists)
                flag.touch()
                text, errors = process.communicate(timeout=PATIENCE_S)
            assert text == "FORMULA OneSafe CANNOT_COMPUTE\n", errors
            assert process.returncode == 0
        assert not _programs(cache)
    finally:
        go.touch()
    _await(lambda: bool(_programs(cache)))
    made = said.read_text().split()
    assert "tables.o" in made and len(made) == len(set(made))


def _programs(cache: Path) -> list[Path]:
    """What is kept."""
    return [p for p in cache.glob("pn2code/programs/tables-*") if not p.suffix]


def _await(is_so: Callable[[], bool]) -> None:
    until = time.monotonic() + PATIENCE_S
    while not is_so():
        assert time.monotonic() < until
        time.sleep(0.02)


def test_an_interrupted_command_has_nothing_compiled(tmp_path: Path) -> None:
    """Its compilers end with it."""
    folder = _folder(tmp_path)
    compiler, said, go, cache = (tmp_path / name for name in ("cc", "said", "go", "cache"))
    compiler.write_text(COMPILER.replace('echo "$made"', "echo $$"))
    compiler.chmod(0o755)
    own = {"CC": str(compiler), "SAID": str(said), "GO": str(go), "XDG_CACHE_HOME": str(cache)}
    command = [sys.executable, "-m", "pn2code", "contest", str(folder), "OneSafe"]
    try:
        with _running([*command, "--max-seconds", "6000"], own) as process:
            _await(said.exists)
            process.terminate()
            process.communicate(timeout=PATIENCE_S)
        assert process.returncode == 130
        assert all(_has_ended(int(pid)) for pid in said.read_text().split())
    finally:
        go.touch()


def test_a_net_that_is_not_read_in_time_leaves_all_formulas_open(tmp_path: Path) -> None:
    folder = _folder(tmp_path)
    command = [sys.executable, "-m", "pn2code", "contest", str(folder), "CTLCardinality"]
    with _running([*command, "--max-seconds", "0"]) as process:
        said, errors = process.communicate(timeout=PATIENCE_S)
    assert said.splitlines() == [f"FORMULA Net-{x} CANNOT_COMPUTE" for x in "ab"], errors
