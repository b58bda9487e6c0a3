"""Messages that are torn, wrong, early, changed or gone, and files that cannot be written at that moment (I2..I6)."""

from __future__ import annotations

import os
import signal
import time
from contextlib import AbstractContextManager, suppress
from pathlib import Path

from helpers.counted import DEADLINE_S, Done, Lab
from pn2code.cell.partition import ChannelKind
from pn2code.cell.scalars import Scalar, ScalarKind
from pn2code.channels import ChannelSpec, SharedDirectory, Written
from pn2code.run.supervisor import SupervisorProcess
from situations import situation

FLAG = (Scalar(ScalarKind.INT, "flag", "FLAG", low=1, high=100),)
TOLD = (Scalar(ScalarKind.STRING, "text", "TOLD"),)
SPECS = (
    ChannelSpec("told", "told.robcad", TOLD, "robot1", "supervisor", ChannelKind.DATA),
    ChannelSpec("command", "command.robcad", FLAG, "supervisor", "robot1", ChannelKind.FLAG),
    ChannelSpec("answer", "answer.robcad", FLAG, "robot1", "supervisor", ChannelKind.FLAG),
)
"""Of `cnative/tests/odd_cell.c`."""


def await_command(supervisor: SupervisorProcess, shared: Path) -> None:
    """Until it has sent its command."""
    file = shared / "command.robcad"
    end = time.monotonic() + DEADLINE_S
    while not (file.exists() and file.read_text().startswith("1\n# ")):
        assert supervisor.running and time.monotonic() < end, supervisor.stderr
        time.sleep(0.001)


def rests(supervisor: SupervisorProcess) -> int:
    """How often it has waited for something so far, as it does at the end of each round."""
    status = Path(f"/proc/{supervisor.pid}/status").read_text()
    return int(status.split("\nvoluntary_ctxt_switches:")[1].split()[0])


def await_rests(supervisor: SupervisorProcess, count: int) -> None:
    """Until it has waited so often, however long that takes on a busy machine."""
    end = time.monotonic() + DEADLINE_S
    while rests(supervisor) < count:
        assert supervisor.running and time.monotonic() < end, supervisor.stderr
        time.sleep(0.001)


def ended(supervisor: SupervisorProcess, shared: Path) -> Done:
    """How it ended."""
    end = supervisor.wait(DEADLINE_S)
    return Done(end.code, "", end.stderr, shared)


def refused(
    lab: Lab,
    content: bytes | None,
    *words: str,
    file: str = "answer",
    program: str = "odd.deployed",
) -> None:
    """In lock-step nobody else can still be writing: the message is refused at once, the file is left as it is."""
    folder = lab.fresh()
    (folder / "orders.txt").write_text("2\n")
    path = folder / "shared" / f"{file}.robcad"
    with lab.started(program, folder, lockstep=True) as supervisor:
        assert supervisor.step(0.0).stopped is None
        path.unlink() if content is None else path.write_bytes(content)
        result = supervisor.step(0.1)
        assert result.stopped is not None, (content, result)
        done = ended(supervisor, folder / "shared")
        assert done.code == 4 and done.error == result.stopped
        for word in (f"{file}.robcad: message of robot1 refused: ", *words):
            assert word in done.error, (word, done)
        assert (path.read_bytes() if path.exists() else None) == content, (
            "it is there for who looks into it"
        )


@situation
def messages_that_are_refused(lab: Lab) -> None:
    for content, words in (
        (b"", "found an empty line where a message, or `0` for none, is expected"),
        (b"\r\n", "found an empty line"),
        (b"done\n", "`done` is not a number; `flag` of colour set `FLAG` should be an integer"),
        (b"1.5\n", "found `1.5` where `flag` of colour set `FLAG` should be an integer"),
        (b"101\n", "101 is outside `flag` of colour set `FLAG`, which goes from 1 to 100"),
        (b"1 1\n", "found `1` after the 1 value that belong here"),
        (b"9" * 30, "is too large for an integer"),
        (b"9" * 600, "is too long for a number"),
        (b"1" * 5000, "longer than any message"),
        (b"\xff\x00", "found `\\xff\\x00`, with a zero byte in it"),
        (b"1\n2\n3\n", "found more than two lines, or a blank second one: `1\\n2\\n3\\n`"),
        (b"1\n# 1 0123", "line 2 is `# 1 0123` where `# seq session checksum` is expected"),
        (b"1\n# 1 0123abcd 00000000\n", "checksum 00000000 where "),
        (b"\xfe" * 90, "`\\xfe\\xfe\\xfe"),
        (b"1\n# 1 " + b"\x81" * 100 + b"\n", "`... where `# seq session"),
        (None, "the file is missing; an empty channel is a file that holds `0`"),
    ):
        refused(lab, content, words)


@situation
def texts_that_are_refused(lab: Lab) -> None:
    for content, words in (
        (b'"a', '`"a` is not a string in double quotes (`text` of colour set `TOLD`)'),
        (b'"a"b"\n', "is not a string in double quotes"),
        (b'"!no"\n', '`"!no"` is not in the colour set `ODD`'),
        (b'"!' + b"\xff" * 2000 + b'"\n', "`` is not in the colour set `ODD`"),
    ):
        refused(lab, content, words, file="told")


@situation
def no_memory_for_a_message(lab: Lab) -> None:
    program = lab.program("odd.deployed", "-DODD_ARENA=256U")
    folder = lab.fresh()
    (folder / "orders.txt").write_text("2\n")
    with lab.started(program, folder, lockstep=True) as supervisor:
        supervisor.step(0.0)
        (folder / "shared" / "told.robcad").write_text('"' + "a" * 300 + '"\n')
        assert supervisor.step(0.1).stopped is not None
        done = ended(supervisor, folder / "shared")
    assert (
        done.code == 1
        and "page `Odd`, place `told`: the memory for lists and strings is used up" in done.error
    )
    assert done.error.endswith("while putting the token of a message")


@situation
def a_message_that_waits_for_its_transition(lab: Lab) -> None:
    """It stays in its file; who changes it before it is consumed is told so."""
    for second, words in (
        (b'"more"\n', 'changed to `"more"\\n` before'),
        (b"0\n", "changed to `0\\n` before"),
    ):
        folder = lab.fresh()
        (folder / "orders.txt").write_text("2\n")
        file = folder / "shared" / "told.robcad"
        with lab.started("odd.deployed", folder, lockstep=True, verbosity=2) as supervisor:
            supervisor.step(0.0)
            file.write_text('"hello"\n')
            for _ in range(3):
                assert supervisor.step(0.1).stopped is None
            assert file.read_text() == '"hello"\n'
            file.write_bytes(second)
            assert supervisor.step(0.2).stopped is not None
            done = ended(supervisor, folder / "shared")
        assert done.code == 4 and "told.robcad: " in done.error and words in done.error
        assert done.err.count('told.robcad: "hello"') == 1 and file.read_bytes() == second


@situation
def a_directory_that_is_gone(lab: Lab) -> None:
    folder = lab.fresh()
    (folder / "orders.txt").write_text("2\n")
    shared = folder / "shared"
    with lab.started("odd.deployed", folder, lockstep=True) as supervisor:
        supervisor.step(0.0)
        for file in shared.iterdir():
            file.unlink()
        shared.rmdir()
        assert supervisor.step(0.1).stopped == f"the shared directory {shared} has been removed"
        assert ended(supervisor, shared).code == 5
    with lab.started(
        "odd.deployed", lab.fresh(), lockstep=True, failing="openat@answer:3-:2,fstat:1-:5"
    ) as supervisor:
        assert "has been removed" in (supervisor.step(0.0).stopped or ""), (
            "nothing is known of it any more"
        )
    with lab.started(
        "odd.deployed", lab.fresh(), lockstep=True, failing="openat@answer:3-:5"
    ) as supervisor:
        assert "answer.robcad: Input/output error" in (supervisor.step(0.0).stopped or "")


@situation
def a_directory_that_goes_in_real_time(lab: Lab) -> None:
    started, shared = playing(lab)
    with started as supervisor:
        await_command(supervisor, shared)
        shared.rename(shared.with_name("elsewhere"))
        for file in shared.with_name("elsewhere").iterdir():
            file.unlink(missing_ok=True)
        while shared.with_name("elsewhere").exists():
            for file in shared.with_name("elsewhere").iterdir():
                file.unlink(missing_ok=True)
            with suppress(OSError):
                shared.with_name("elsewhere").rmdir()
        end = supervisor.wait(DEADLINE_S)
    assert end.code == 5 and f"the shared directory {shared} has been removed" in end.stderr


@situation
def a_command_that_cannot_be_written(lab: Lab) -> None:
    """The data before it are there; the flag, without which no robot does anything, is not."""
    for rule in ("renameat@command:2-:28", "write@command:2-:28"):
        for options in ((), ("--poll", "1")):
            done = lab.run("odd.deployed", *options, order=2, failing=rule)
            done.stopped(
                5,
                f"cannot write {done.shared}/command.robcad: No space left on device; make room there",
            )
            assert (done.shared / "command.robcad").read_text() == "0\n"


@situation
def our_own_file_is_gone(lab: Lab) -> None:
    folder = lab.fresh()
    (folder / "orders.txt").write_text("17\n")
    with lab.started("odd.deployed", folder, lockstep=True) as supervisor:
        supervisor.step(0.0)
        (folder / "shared" / "command.robcad").unlink()
        said = f"cannot read {folder}/shared/command.robcad: No such file or directory"
        assert supervisor.step(1000.0).stopped == said
        assert ended(supervisor, folder / "shared").code == 5
    started, shared = playing(lab)
    with started as supervisor:  # in real time it is noticed when there is something to write
        await_command(supervisor, shared)
        (shared / "command.robcad").unlink()
        (shared / "answer.robcad").write_text("1\n")
        assert ended(supervisor, shared).code == 0


def await_preparations(shared: Path) -> None:
    """Until the temporary files of the next messages are there."""
    end = time.monotonic() + DEADLINE_S
    while not (shared / ".answer.robcad.supervisor.tmp").exists():
        assert time.monotonic() < end
        time.sleep(0.001)


@situation
def files_that_cannot_be_made_beforehand(lab: Lab) -> None:
    """It is tried again when there is something to write."""
    started, shared = playing(
        lab, lab.program("odd.deployed", "-DODD_TWICE"), failing="openat@.say.robcad:2-9:24"
    )
    with started as supervisor:
        await_command(supervisor, shared)
        await_preparations(shared)
        assert not (shared / ".say.robcad.supervisor.tmp").exists()
        (shared / "answer.robcad").write_text("1\n")
        done = ended(supervisor, shared)
    assert done.code == 5 and f"cannot write {shared}/say.robcad: Too many open files" in done.error


@situation
def a_prepared_file_that_cannot_be_written(lab: Lab) -> None:
    started, shared = playing(
        lab, lab.program("odd.deployed", "-DODD_TWICE"), failing="write@.say.robcad:2:28"
    )
    with started as supervisor:
        await_command(supervisor, shared)
        await_preparations(shared)
        (shared / "answer.robcad").write_text("1\n")
        done = ended(supervisor, shared)
    done.stopped(5, f"cannot write {shared}/say.robcad: No space left on device; make room there")
    assert (shared / "say.robcad").read_text() == "0\n" and (
        shared / "answer.robcad"
    ).read_text() == "0\n"


@situation
def longer_than_can_be_shown(lab: Lab) -> None:
    folder = lab.fresh()
    (folder / "orders.txt").write_text("2\n")
    with lab.started("odd.deployed", folder, lockstep=True, verbosity=2) as supervisor:
        supervisor.step(0.0)
        (folder / "shared" / "told.robcad").write_bytes(b'"' + b"\xff" * 2000 + b'"\n')
        assert supervisor.step(0.1).stopped is None
        (folder / "shared" / "answer.robcad").write_text("1\n")
        assert supervisor.step(0.2).finished
        assert "told.robcad: ?\n" in supervisor.wait(DEADLINE_S).stderr


def playing(
    lab: Lab, program: str | Path = "odd.deployed", failing: str = "", poll_ms: float | None = None
) -> tuple[AbstractContextManager[SupervisorProcess], Path]:
    """A supervisor in real time that has sent its command, or will; and its directory."""
    folder = lab.fresh()
    (folder / "orders.txt").write_text("2\n")
    options = {"poll_ms": poll_ms, "verbosity": 1, "reply_timeout_s": 3600.0}
    return lab.started(program, folder, failing=failing, **options), folder / "shared"


@situation
def answers_in_real_time(lab: Lab) -> None:
    for poll_ms in (None, 1.0):
        started, shared = playing(lab, poll_ms=poll_ms)
        with started as supervisor, SharedDirectory(shared, "robot1", SPECS) as robot:
            assert robot.await_supervisor(600.0)
            await_command(supervisor, shared)
            robot.clear("command")
            assert isinstance(robot.write("answer", (1,)), Written)
            done = ended(supervisor, shared).finished()
        assert (shared / "answer.robcad").read_text() == "0\n" and done.err == ""


@situation
def a_message_that_stays_wrong(lab: Lab) -> None:
    started, shared = playing(lab)
    with started as supervisor:
        await_command(supervisor, shared)
        (shared / "answer.robcad").write_text("")
        done = ended(supervisor, shared)
    assert (
        done.code == 4
        and "answer.robcad: message of robot1 refused: found an empty line" in done.error
    )
    assert done.err.count("warning: ") == 1, "it is said once"


@situation
def many_changes_at_once(lab: Lab) -> None:
    """More than the system keeps notices of: everything is looked at then."""
    started, shared = playing(lab)
    with started as supervisor:
        await_command(supervisor, shared)
        os.kill(supervisor.pid, signal.SIGSTOP)
        (shared / "a").write_text("")
        for _ in range(8500):
            (shared / "a").rename(shared / "b")
            (shared / "b").rename(shared / "a")
        before = rests(supervisor)
        os.kill(supervisor.pid, signal.SIGCONT)
        # It looks at everything every 100 ms, takes the notices after that, and rests.
        await_rests(supervisor, before + 4)
        (shared / "answer.robcad").write_text("1\n")
        ended(supervisor, shared).finished()


@situation
def somebody_writes_into_an_empty_file_of_ours(lab: Lab) -> None:
    """Just before the next message, unseen until then: nothing is overwritten (I3)."""
    program = lab.program("odd.deployed", "-DODD_TWICE")
    started, shared = playing(lab, program)
    with started as supervisor:
        await_command(supervisor, shared)
        os.kill(supervisor.pid, signal.SIGSTOP)
        (shared / "say.robcad").write_text('"mine"\n')
        (shared / "answer.robcad").write_text("1\n")
        os.kill(supervisor.pid, signal.SIGCONT)
        done = ended(supervisor, shared)
    assert (
        done.code == 4
        and 'say.robcad still holds `"mine"\\n`, which robot1 has not taken' in done.error
    )
    assert (shared / "say.robcad").read_text() == '"mine"\n'


@situation
def an_answer_that_cannot_be_emptied(lab: Lab) -> None:
    """It is still there; the next start discards it, and says so."""
    for rule, words in (
        (
            "renameat@answer:2-:28",
            "No space left on device; make room there, or choose another directory with --dir",
        ),
        ("renameat@answer:2-:122", "Disk quota exceeded; make room there"),
        ("renameat@answer:2-:27", "File too large; make room there"),
        (
            "renameat@answer:2-:30",
            "Read-only file system; choose a directory that can be written with --dir",
        ),
        ("renameat@answer:2-:13", "Permission denied; choose a directory"),
        ("renameat@answer:2-:1", "Operation not permitted; choose a directory"),
        ("renameat@answer:2-:5", "Input/output error"),
        ("renameat@answer:2-:2", "No such file or directory"),
    ):
        folder = lab.fresh()
        (folder / "orders.txt").write_text("2\n")
        with lab.started("odd.deployed", folder, lockstep=True, failing=rule) as supervisor:
            supervisor.step(0.0)
            (folder / "shared" / "answer.robcad").write_text("1\n")
            assert supervisor.step(0.1).stopped is not None
            done = ended(supervisor, folder / "shared")
        assert done.code == 5 and f"cannot write {done.shared}/answer.robcad: {words}" in done.error
        assert (folder / "shared" / "answer.robcad").read_text() == "1\n"
        assert list(folder.glob("shared/.*")) == []
