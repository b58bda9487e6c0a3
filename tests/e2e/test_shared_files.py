"""What the model of the medium assumes of the file system and of locks (docs/protocol.md), and the rules of a start.

Processes hammer files in a temporary folder; a test looks so often, and until enough has happened meanwhile.
"""

from __future__ import annotations

import fcntl
import itertools
import os
import signal
import subprocess
import sys
import textwrap
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from pn2code.cell.partition import ChannelKind
from pn2code.cell.scalars import Scalar, ScalarKind
from pn2code.channels import ChannelSpec, Message, PeerState, SharedDirectory
from pn2code.channels.message import compose, parse

INT = (Scalar(ScalarKind.INT, "n", "INT"),)
DATA = ChannelSpec("data", "data.txt", INT * 6, "supervisor", "robot1", ChannelKind.DATA)
FLAG = ChannelSpec("flag", "flag.txt", INT, "supervisor", "robot1", ChannelKind.FLAG)
SESSION = "0badcafe"
LOOKS = 10_000
STARTS = 500
WATCHDOG_S = 600.0


@contextmanager
def child(script: str, *arguments: object) -> Iterator[subprocess.Popen[str]]:
    """A process that has said that it works."""
    process = subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(script), *map(str, arguments)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == "up\n"
        yield process
    finally:
        process.kill()
        process.wait()
        assert process.stdin is not None and process.stdout is not None
        process.stdout.close()
        with suppress(BrokenPipeError):
            process.stdin.close()


def looks(happened: Callable[[], bool]) -> Iterator[int]:
    """So many, and more until something has happened."""
    until = time.monotonic() + WATCHDOG_S
    for number in itertools.count():
        if number >= LOOKS and happened():
            return
        assert time.monotonic() < until, "nothing happens"
        yield number


PUBLISHER = """
    import sys, zlib
    from pathlib import Path
    folder = Path(sys.argv[1])
    def put(name, payload, seq):
        crc = zlib.crc32(f"{payload} {seq} 0badcafe".encode())
        tmp = folder / f".{name}.supervisor.tmp"
        tmp.write_text(f"{payload}\\n# {seq} 0badcafe {crc:08x}\\n")
        tmp.replace(folder / name)
    k = 1
    while True:
        put("data.txt", " ".join([str(k)] * 6), k)
        put("flag.txt", str(k), k)
        if k == 1:
            print("up", flush=True)
        k += 1
"""


def number(spec: ChannelSpec, text: str) -> int:
    """The first scalar of a message that is whole."""
    seq = int(text.split("# ")[1].split()[0])
    found = parse(spec, text, session=SESSION, consumed=seq - 1)
    assert isinstance(found, Message), text
    assert len(set(found.scalars)) == 1
    return int(found.scalars[0])


def test_a_rename_never_shows_half_a_message(tmp_path: Path) -> None:
    seen = set()
    with child(PUBLISHER, tmp_path):
        for _ in looks(lambda: len(seen) > 10):
            seen.add(number(DATA, (tmp_path / "data.txt").read_text()))


def test_data_renamed_before_a_flag_are_there_once_the_flag_is_seen(tmp_path: Path) -> None:
    seen = set()
    with child(PUBLISHER, tmp_path):
        for _ in looks(lambda: len(seen) > 10):
            flag = number(FLAG, (tmp_path / "flag.txt").read_text())
            assert number(DATA, (tmp_path / "data.txt").read_text()) >= flag
            seen.add(flag)


def test_a_killed_writer_leaves_whole_messages_only(tmp_path: Path) -> None:
    for moment in range(4):  # whenever that is
        with child(PUBLISHER, tmp_path) as writer:
            time.sleep(0.013 * moment)
            writer.send_signal(signal.SIGKILL)
            writer.wait()
        flag = number(FLAG, (tmp_path / "flag.txt").read_text())
        assert number(DATA, (tmp_path / "data.txt").read_text()) in (flag, flag + 1)


def test_who_has_opened_a_file_reads_it_whole_although_it_is_replaced(tmp_path: Path) -> None:
    message = compose(DATA, (7,) * 6, seq=1, session=SESSION)
    assert message is not None
    (tmp_path / "data.txt").write_text(message)
    with (tmp_path / "data.txt").open() as old:
        (tmp_path / "new").write_text("0\n")
        (tmp_path / "new").replace(tmp_path / "data.txt")
        assert old.read() == message
    assert (tmp_path / "data.txt").read_text() == "0\n"


def test_the_lock_of_a_killed_process_is_free_and_its_status_stays(tmp_path: Path) -> None:
    script = """
        import sys, time
        from pathlib import Path
        from pn2code.channels import SharedDirectory
        SharedDirectory(Path(sys.argv[1]), "supervisor", []).announce()
        print("up", flush=True)
        time.sleep(600)
    """
    robot = SharedDirectory(tmp_path, "robot1", [])
    with robot, child(script, tmp_path) as supervisor:
        assert robot.await_supervisor(WATCHDOG_S)
        assert robot.peer().state is PeerState.RUNNING
        supervisor.send_signal(signal.SIGKILL)
        supervisor.wait()
        assert robot.peer().state is PeerState.DEAD
        assert (tmp_path / "supervisor.status").read_text().startswith("running\n")


# --- the rules of a start (I7) ---------------------------------------------------------------------


def test_an_old_status_is_never_seen_under_a_new_lock(tmp_path: Path) -> None:
    """The robot looks while a supervisor begins where there is an old status."""
    script = """
        import sys
        from pathlib import Path
        from pn2code.channels import SharedDirectory
        folder = Path(sys.argv[1])
        print("up", flush=True)
        while sys.stdin.readline():
            (folder / "supervisor.status").write_text("running\\n0ld00000 1\\n\\n")
            with SharedDirectory(folder, "supervisor", []) as side:
                side.announce()
                sys.stdin.readline()
            print("gone", flush=True)
    """
    robot = SharedDirectory(tmp_path, "robot1", [])
    with child(script, tmp_path) as supervisor:
        assert supervisor.stdin is not None and supervisor.stdout is not None
        for _ in range(STARTS):
            print("begin", file=supervisor.stdin, flush=True)
            while (session := robot._running_session()) is None:
                assert supervisor.poll() is None
            assert session != "0ld00000"
            print("end", file=supervisor.stdin, flush=True)
            assert supervisor.stdout.readline() == "gone\n"


def test_a_robot_looks_again_when_it_has_its_lock(tmp_path: Path) -> None:
    first = SharedDirectory(tmp_path, "supervisor", [FLAG])
    second = SharedDirectory(tmp_path, "supervisor", [FLAG])

    class Slow(SharedDirectory):
        """Another supervisor begins between the first look and the lock."""

        def _open_locked(self, *, empty: bool = False) -> int:
            if second.session is None:
                first.close()
                second.announce()
            return super()._open_locked(empty=empty)

    with first, second, Slow(tmp_path, "robot1", [FLAG]) as robot:
        old = first.announce()
        assert not robot.await_supervisor(0.0)
        assert robot.session is None
        assert not robot._is_locked("robot1")
        assert robot.await_supervisor(WATCHDOG_S)
        assert robot.session == second.session != old


def test_a_session_is_joined_once(tmp_path: Path) -> None:
    supervisor = SharedDirectory(tmp_path, "supervisor", [FLAG])
    dead, again = (SharedDirectory(tmp_path, "robot1", [FLAG]) for _ in range(2))
    with supervisor, again:
        supervisor.announce()
        assert dead.await_supervisor(WATCHDOG_S)
        supervisor.write("flag", (3,))
        dead.close()  # as a crash does: no last word
        assert not again.await_supervisor(0.05)
        assert again.was_here
        assert supervisor.peer("robot1").state is PeerState.DEAD
        assert (tmp_path / "flag.txt").read_text().startswith("3\n")
        supervisor.announce()  # a new session
        assert again.await_supervisor(WATCHDOG_S)
        assert not again.was_here


def test_a_held_lock_is_not_emptied(tmp_path: Path) -> None:
    with SharedDirectory(tmp_path, "supervisor", []) as first:
        first.announce()
        before = (tmp_path / "supervisor.status").read_text()
        with pytest.raises(BlockingIOError):
            SharedDirectory(tmp_path, "supervisor", []).announce()
        assert (tmp_path / "supervisor.status").read_text() == before
    fd = os.open(tmp_path / "supervisor.status", os.O_RDONLY)
    fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
    os.close(fd)
