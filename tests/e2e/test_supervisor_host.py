"""The supervisor host in C, driven by the hand-made net of cnative/tests/hand_net.c and robots in Python.

Everything runs under the address and undefined-behaviour sanitizers. I1..I10: the invariants of docs/protocol.md.
"""

from __future__ import annotations

import json
import os
import random
import resource
import shutil
import signal
import struct
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from helpers.compiled import RUNTIME, SANITIZERS, WARNINGS, Workshop
from helpers.session import once
from helpers.thorough import amount
from pn2code.cell.partition import ChannelKind
from pn2code.cell.scalars import Scalar, ScalarKind
from pn2code.channels import (
    ChannelSpec,
    Message,
    PeerState,
    Refused,
    SharedDirectory,
    Status,
    Written,
)
from pn2code.channels.message import compose, parse
from pn2code.channels.scalars import Malformed, format_real, format_scalars, parse_scalars
from pn2code.emission import c_flags
from pn2code.run.supervisor import Exit, SupervisorProcess

pytestmark = pytest.mark.cc

REALS = tuple(Scalar(ScalarKind.REAL, label, "COORD") for label in ("x", "y"))
FLAG = (Scalar(ScalarKind.INT, "flag", "FLAG"),)
SPECS = (
    ChannelSpec("pose1", "pose1.robcad", REALS, "supervisor", "robot1", ChannelKind.DATA),
    ChannelSpec("command", "command.robcad", FLAG, "supervisor", "robot1", ChannelKind.FLAG),
    ChannelSpec("answer", "answer.robcad", FLAG, "robot1", "supervisor", ChannelKind.FLAG),
)
HAND_WRITTEN = ("hand_net.c", "hand_cell.c", "odd_net.c", "odd_cell.c", "codec_cell.c", "scalars.c")
DEADLINE_S = 600.0  # ends what hangs


# --- building and starting ---


def compile_c(root: Path, out: Path, sources: list[Path], *flags: str) -> Path:
    command = [
        "gcc",
        *WARNINGS,
        *flags,
        "-I",
        str(root / "cnative/include"),
        *map(str, sources),
        "-o",
        str(out),
        "-lm",
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stderr}"
    return out


def host_sources(root: Path) -> list[Path]:
    """The host, its channels and its port; the rest of the runtime is that of all compiled nets."""
    source = root / "cnative/src"
    patterns = ("supervisor*.c", "pn_channel*.c", "port_*.c")
    return [p for pattern in patterns for p in sorted(source.rglob(pattern))]


@pytest.fixture(scope="session")
def built(root: Path, workshop: Workshop, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Supervisors: `supervisor` (delay 2), `quick` (delay 0), `patient` (time for what is refused), `alone` (no cell).

    And `scalars`.
    """
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    runtime = [workshop.runtime / f"pn_{name}.o" for name in RUNTIME]
    return once(
        tmp_path_factory, "supervisors", lambda folder: build_supervisors(root, folder, runtime)
    )


def build_supervisors(root: Path, folder: Path, runtime: list[Path]) -> None:
    """Each object once."""
    folder.mkdir()
    own = [
        compile_c(root, folder / f"{source.stem}.o", [source], *SANITIZERS, "-DPN_TRACE", "-c")
        for source in host_sources(root)
    ]
    objects = [*own, *runtime]
    main = [o for o in own if o.name.startswith("supervisor")]
    common = [o for o in objects if o not in main]
    tests = root / "cnative/tests"
    hand = [tests / "hand_net.c", tests / "hand_cell.c"]
    compile_c(root, folder / "supervisor", [*objects, *hand], *SANITIZERS)
    compile_c(root, folder / "quick", [*objects, *hand], *SANITIZERS, "-DHAND_DELAY=0")
    cell = root / "cnative/src/supervisor/supervisor_cell.c"
    others = [o for o in objects if o.name != "supervisor_cell.o"]
    patient = (
        "-DPN_TRACE",
        "-DHAND_DELAY=0",
        "-DSUP_GRACE_S=600.0",
        f"-I{root / 'cnative/src/supervisor'}",
    )
    compile_c(root, folder / "patient", [*others, cell, *hand], *SANITIZERS, *patient)
    compile_c(root, folder / "alone", [*objects, *hand], *SANITIZERS, "-DHAND_ALONE")
    compile_c(root, folder / "scalars", [*common, tests / "scalars.c"], *SANITIZERS)


@pytest.fixture
def inputs(tmp_path: Path) -> Path:
    folder = tmp_path / "input"
    folder.mkdir()
    (folder / "orders.txt").write_text("# how many; x y\n3\n0.5 7\n")
    return folder


@pytest.fixture
def shared(tmp_path: Path) -> Path:
    folder = tmp_path / "shared"
    folder.mkdir()
    return folder


@pytest.fixture
def start(built: Path, shared: Path, inputs: Path) -> Iterator[Callable[..., SupervisorProcess]]:
    """Starts supervisors; ends them all at the end of the test."""
    started: list[SupervisorProcess] = []

    def begin(program: str = "quick", **options: object) -> SupervisorProcess:
        process = SupervisorProcess(built / program, shared, inputs, **options)  # type: ignore[arg-type]
        started.append(process)
        return process

    yield begin
    for process in started:
        process.close()


@pytest.fixture
def robot(shared: Path) -> Iterator[SharedDirectory]:
    with SharedDirectory(shared, "robot1", SPECS) as side:
        yield side


def until(condition: Callable[[], object], what: str) -> None:
    end = time.monotonic() + DEADLINE_S
    while not condition():
        assert time.monotonic() < end, f"in vain: {what}"
        time.sleep(0.002)


def await_message(robot: SharedDirectory, channel: str) -> Message:
    found: list[Message] = []

    def look() -> bool:
        message = robot.read(channel)
        if isinstance(message, Message):
            found.append(message)
        return bool(found)

    until(look, f"a message in {channel}")
    return found[0]


def obey(robot: SharedDirectory) -> tuple[float, ...]:
    """Plays the robot for one command; gives the pose."""
    await_message(robot, "command")
    pose = robot.read("pose1")
    assert isinstance(pose, Message), f"I5: the data were not there before the flag: {pose}"
    robot.clear("command")
    robot.clear("pose1")
    assert isinstance(robot.write("answer", (1,)), Written)
    return tuple(float(v) for v in pose.scalars)


def ended(process: SupervisorProcess, code: int, *words: str) -> Exit:
    end = process.wait(DEADLINE_S)
    assert end.code == code, end.stderr
    for word in words:
        assert word in end.stderr
    return end


def status_of(shared: Path) -> list[str]:
    return (shared / "supervisor.status").read_text().splitlines()


def leftovers(shared: Path) -> list[str]:
    return sorted(p.name for p in shared.iterdir() if p.name.endswith(".tmp"))


# --- the text form is the same on both sides ---


def test_both_sides_write_reals_alike(built: Path) -> None:
    values = [
        0.0,
        -0.0,
        0.1,
        -1e-5,
        5e-324,
        1.7976931348623157e308,
        166.66666666666666,
        5802.2072,
        2.0**-44,
    ]
    values += [struct.unpack("<f", struct.pack("<f", v))[0] for v in (1000 / 6, 0.1, 5802.2072)]
    state = 12345
    while len(values) < 3000:  # doubles of any size, by a small generator: the same in every run
        state = (state * 6364136223846793005 + 1442695040888963407) % 2**64
        value = struct.unpack("<d", struct.pack("<Q", state))[0]
        if value == value and abs(value) != float("inf"):
            values += [value, state / 2**40, round(state / 2**44, state % 9)]
    lines = "".join(f"format {v.hex()}\n" for v in values)
    done = subprocess.run(
        [built / "scalars"], input=lines, capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines() == [format_real(v) for v in values]


def test_both_sides_read_alike(built: Path) -> None:
    commands = "real 1.5\nreal 1e400\nreal nan\nreal 0x1p3\nreal 1 2\nreal \ncrc 1 4 9f3ac01d\n"
    commands += 'string "a \\"b\\" \\\\ \\x0a"\nstring abc\nstring "a\nreal \xff\x01\n'
    done = subprocess.run(
        [built / "scalars"], input=commands.encode("latin-1"), capture_output=True, check=True
    )
    lines = done.stdout.decode().splitlines()
    assert float.fromhex(lines[0]) == 1.5
    assert "refused 1 `1e400` is too large" in lines[1]
    assert all("is not a number" in line for line in lines[2:4])
    assert "refused 3 found `2` after the 1 value" in lines[4]
    text = compose(SPECS[1], (1,), seq=4, session="9f3ac01d")
    assert text is not None
    assert lines[6] == text.split()[-1]
    assert lines[7] == '612022622220 5c200a "a \\"b\\" \\\\ \\x0a"'.replace(
        "612022622220 5c200a", "6120226222205c200a"
    )
    assert all("is not a string" in line for line in lines[8:10])
    assert "\\xff\\x01" in lines[10]


SCALARS = (
    Scalar(ScalarKind.UNIT, "", "UNIT"),
    Scalar(ScalarKind.BOOL, "", "BOOL"),
    Scalar(ScalarKind.ENUM, "c", "COLOUR", ("red", "green")),
    Scalar(ScalarKind.INDEX, "", "INDEX", low=1, high=3),
    Scalar(ScalarKind.INT, "n", "RANGE", low=-2, high=8),
    Scalar(ScalarKind.INT, "", "INT"),
    Scalar(ScalarKind.REAL, "", "SPAN", low=-1.5, high=2.5),
)
"""Those of `cnative/tests/scalars.c`."""


def test_both_sides_read_scalars_of_all_kinds_alike(built: Path) -> None:
    words = (
        "1 0 -1 +1 -2 -3 8 9 3 4 2 red green re greens true false 1.5 -1.5 -1.6 2.5 2.6 1e0 1e+0"
    )
    words += " 1E-1 1e 1e+ - + . .5 9223372036854775807 9223372036854775808 -9223372036854775809 ()"
    words += " nan inf 0x1 1_0 `x` " + "7" * 70
    cases = [
        (n, word) for n in range(len(SCALARS)) for word in ["", *words.split(), "1 1", "z" * 90]
    ]
    lines = "".join(f"scalar {n} {word}\n" for n, word in cases)
    done = subprocess.run(
        [built / "scalars"], input=lines, capture_output=True, text=True, check=True
    )
    expected = []
    for n, word in cases:
        found = parse_scalars(SCALARS[n : n + 1], word)
        again = None if isinstance(found, Malformed) else format_scalars(SCALARS[n : n + 1], found)
        expected.append(f"refused {found.column}" if isinstance(found, Malformed) else again)
    assert dict(zip(cases, done.stdout.splitlines(), strict=True)) == dict(
        zip(cases, expected, strict=True)
    )
    assert len({line for line in expected if line and "refused" not in line}) > 10


def test_both_sides_judge_files_alike(built: Path) -> None:
    """Thousands of files, damaged in small ways: both sides take the same, and refuse the rest for the same reason."""
    chance = random.Random(7)
    files = [b"", b"0", b"0\n", b"0 \r\n", b"1 2", b"\n\n", b"1 2\n\n", b" 1\t2 \r\n", b"9" * 4096]
    while len(files) < 4000:
        values = (chance.choice([0.0, 1.5, -2.25, 1 / 3]), chance.uniform(-1e4, 1e4))
        session = chance.choice(["0123abcd"] * 5 + ["99999999"])
        text = compose(SPECS[0], values, seq=chance.choice([6, 7, 7, 7, 8]), session=session)
        assert text is not None
        data = bytearray(text.encode())
        for _ in range(chance.choice([0, 0, 1, 1, 2])):
            at = chance.randrange(len(data)) if data else 0
            match chance.randrange(4):
                case 0:
                    del data[at:]
                case 1:
                    data[at : at + 1] = bytes([chance.choice(b"0 1\n#.-e\x00\xff\t\rx")])
                case 2:
                    data[at:at] = bytes([chance.choice(b"0 1\n#.-e+")])
                case _:
                    del data[at : at + 1]
        files.append(bytes(data))
    lines = "".join(f"file 6 {data.hex()}\n" for data in files)
    done = subprocess.run(
        [built / "scalars"], input=lines, capture_output=True, text=True, check=True
    )
    kinds = set()
    for data, line in zip(files, done.stdout.splitlines(), strict=True):
        found = parse(SPECS[0], data.decode("latin-1"), session="0123abcd", consumed=6)
        if found is None:
            expected = "empty"
        elif isinstance(found, Refused):
            expected = f"refused {found.reason.value}"
        else:
            expected = "message"
            x, y, seq = line.split()[1:]
            assert (float.fromhex(x), float.fromhex(y)) == found.scalars, data
            assert int(seq) == (-1 if found.seq is None else found.seq), data
        assert line.split(" 0x")[0].split(" -0x")[0] == expected, data
        kinds.add(expected)
    assert kinds >= {
        "empty",
        "message",
        *(f"refused {w}" for w in ("shape", "count", "scalar", "trailer", "checksum")),
    }
    assert kinds >= {"refused session", "refused repeated", "refused lost"}


# --- a whole run ---


@pytest.mark.parametrize("options", [{}, {"poll_ms": 5.0}], ids=["inotify", "polling"])
def test_a_run(
    start: Callable[..., SupervisorProcess],
    robot: SharedDirectory,
    shared: Path,
    tmp_path: Path,
    options: dict[str, float],
) -> None:
    trace = tmp_path / "supervisor.trace.jsonl"
    supervisor = start(trace=trace, verbosity=1, **options)
    assert robot.await_supervisor(DEADLINE_S)
    poses = [obey(robot) for _ in range(3)]
    assert poses == [(0.5, 7.0), (0.6, 7.0), (0.7, 7.0)]
    ended(supervisor, 0)
    assert "finished after" in supervisor.stdout
    assert str(shared) in supervisor.stdout
    assert status_of(shared)[0] == "finished"
    assert robot.peer().state is PeerState.FINISHED
    assert (shared / "answer.robcad").read_text() == "0\n"  # I4
    assert leftovers(shared) == []
    lines = [json.loads(line) for line in trace.read_text().splitlines()]
    assert lines[0]["by"] == "supervisor"
    assert lines[0]["initial"] == {"Top.Orders": [[1, [3, [0.5, 7.0]]]]}
    names = [line["transition"] for line in lines if "transition" in line]
    assert names == ["Top.Send", "Top.Next"] * 3 + ["Top.Finish"]
    assert lines[-1]["event"] == "end"
    assert lines[-1]["why"] == "finished"


def test_lockstep(start: Callable[..., SupervisorProcess], robot: SharedDirectory) -> None:
    supervisor = start("supervisor", lockstep=True)
    assert robot.await_supervisor(DEADLINE_S)
    first = supervisor.step(0.0)
    assert (first.fired, first.next_time, first.finished, first.stopped) == (1, None, False, None)
    assert supervisor.step(0.5).fired == 0
    for number in range(3):
        at = 1.0 + 4 * number
        obey(robot)
        result = supervisor.step(at)
        assert (result.fired, result.next_time) == (1, at + 2.0)  # Idle is there two units later
        assert supervisor.step(at + 1.0).fired == 0
        last = supervisor.step(at + 2.0)
        assert last.fired == 1
    assert last.finished
    assert supervisor.step(99.0) == last
    ended(supervisor, 0)


def test_two_lockstep_runs_give_the_same_bytes(
    start: Callable[..., SupervisorProcess], shared: Path, tmp_path: Path
) -> None:
    traces = []
    for run in range(2):
        trace = tmp_path / f"{run}.trace.jsonl"
        supervisor = start(lockstep=True, trace=trace)
        with SharedDirectory(shared, "robot1", SPECS) as robot:
            assert robot.await_supervisor(DEADLINE_S)
            t = 0.0
            while not supervisor.step(t).finished:
                obey(robot)
                t += 0.125
            robot.set_status(Status.FINISHED)
        ended(supervisor, 0)
        traces.append(trace.read_bytes())
    assert traces[0] == traces[1]


def test_time_scale(start: Callable[..., SupervisorProcess], robot: SharedDirectory) -> None:
    supervisor = start("supervisor", lockstep=True, time_scale=10.0)
    assert robot.await_supervisor(DEADLINE_S)
    supervisor.step(0.0)
    obey(robot)
    assert supervisor.step(0.3).next_time == 0.5  # model time 3 + 2, at ten units a second


def test_lockstep_stop_and_end_of_input(
    start: Callable[..., SupervisorProcess], shared: Path
) -> None:
    supervisor = start(lockstep=True)
    supervisor.step(0.0)
    assert supervisor.stop("robot2 would collide").stopped == "robot2 would collide"
    ended(supervisor, 3, "robot2 would collide")
    assert status_of(shared)[0::2] == ["stopped", "robot2 would collide"]
    other = start(lockstep=True)
    other.step(0.0)
    assert other.close().code == 130
    assert status_of(shared)[0] == "stopped"


# --- I3 .. I5 ---


def test_i3_a_command_that_was_not_taken_is_never_overwritten(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory, shared: Path
) -> None:
    supervisor = start()
    assert robot.await_supervisor(DEADLINE_S)
    first = await_message(robot, "command")
    robot.write("answer", (3,))  # the net sends again at once, but `command` has not been emptied
    ended(supervisor, 4, "channel-overrun", "command.robcad")
    assert robot.read("command") == first


def test_i4_the_answer_is_emptied_before_the_next_command_is_there(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory, shared: Path
) -> None:
    start()
    assert robot.await_supervisor(DEADLINE_S)
    for _ in range(2):
        obey(robot)
        await_message(robot, "command")
        assert (shared / "answer.robcad").read_text() == "0\n"


def test_i4_i5_order_of_publication(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory, shared: Path
) -> None:
    """The last data were not taken, so the next cannot be written: the answer is emptied by then, no flag is there."""
    supervisor = start(lockstep=True)
    assert robot.await_supervisor(DEADLINE_S)
    supervisor.step(0.0)
    robot.read("command")
    robot.clear("command")
    robot.write("answer", (1,))
    stopped = supervisor.step(1.0).stopped
    assert stopped is not None
    assert "pose1.robcad still holds" in stopped
    assert (shared / "answer.robcad").read_text() == "0\n"
    assert (shared / "command.robcad").read_text() == "0\n"
    ended(supervisor, 4)


# --- I6 ---

BAD = {
    "garbage": (b"\xff\xfe\x00garbage", "zero byte"),
    "word": (b"done\n", "not a number"),
    "real": (b"1.5\n", "should be an integer"),
    "short": (b"", "empty line"),
    "long": (b"1 1\n", "after the 1 value"),
    "huge": (b"9" * 100 + b"\n", "too large"),
    "endless": (b"1" * 10000, "longer than any message"),
    "colour": (b"10\n", "not in the colour set"),
    "torn trailer": (b"1\n# 1 0123", "line 2"),
    "checksum": (b"1\n# 1 0123abcd 00000000\n", "checksum"),
    "lines": (b"1\n# 1 0123abcd 00000000\n1\n", "more than two lines"),
}


@pytest.mark.parametrize("name", BAD)
def test_i6_bad_content_stops_safely(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory, shared: Path, name: str
) -> None:
    content, words = BAD[name]
    supervisor = start(lockstep=True)
    assert robot.await_supervisor(DEADLINE_S)
    supervisor.step(0.0)
    (shared / "answer.robcad").write_bytes(content)
    stopped = supervisor.step(0.1).stopped
    assert stopped is not None
    assert "answer.robcad" in stopped
    assert words in stopped
    ended(supervisor, 4, words)
    assert status_of(shared)[0] == "stopped"


def sealed(robot: SharedDirectory, value: int, seq: int, session: str | None = None) -> str:
    text = compose(SPECS[2], (value,), seq=seq, session=session or robot.session or "")
    assert text is not None
    return text


@pytest.mark.parametrize(
    ("seq", "session", "words"),
    [(1, None, "consumed"), (3, None, "lost"), (2, "99999999", "session")],
    ids=["repeated", "lost", "foreign"],
)
def test_i6_repeated_lost_and_foreign(
    start: Callable[..., SupervisorProcess],
    robot: SharedDirectory,
    shared: Path,
    seq: int,
    session: str | None,
    words: str,
) -> None:
    supervisor = start(lockstep=True)
    assert robot.await_supervisor(DEADLINE_S)
    supervisor.step(0.0)
    obey(robot)
    assert supervisor.step(1.0).fired == 2
    (shared / "answer.robcad").write_text(sealed(robot, 1, seq, session))
    stopped = supervisor.step(2.0).stopped
    assert stopped is not None
    assert words in stopped
    ended(supervisor, 4)


def test_i6_a_repeated_answer_fires_nothing(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory, shared: Path, tmp_path: Path
) -> None:
    trace = tmp_path / "t.jsonl"
    supervisor = start(trace=trace)
    assert robot.await_supervisor(DEADLINE_S)
    obey(robot)
    await_message(robot, "command")
    robot.clear("command")
    robot.clear("pose1")
    (shared / "answer.robcad").write_text(sealed(robot, 1, 1))
    ended(supervisor, 4, "again")
    assert trace.read_text().count('"Top.Next"') == 1


def test_i6_what_is_put_right_within_the_grace_is_taken(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory, shared: Path
) -> None:
    supervisor = start("patient")
    assert robot.await_supervisor(DEADLINE_S)
    await_message(robot, "command")
    robot.clear("command")
    robot.clear("pose1")
    (shared / "answer.robcad").write_text("")  # somebody writes in place ...
    until(lambda: "refused" in supervisor.stderr, "the report")
    (shared / "answer.robcad").write_text("1\n")  # ... and has finished
    await_message(robot, "command")
    assert supervisor.stderr.count("refused") == 1
    assert supervisor.running


def test_i6_a_missing_file_stops_safely(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory, shared: Path
) -> None:
    supervisor = start()
    assert robot.await_supervisor(DEADLINE_S)
    (shared / "answer.robcad").unlink()
    ended(supervisor, 4, "answer.robcad", "missing")


def put_strange(kind: str, path: Path) -> None:
    """Something that is no file."""
    path.unlink(missing_ok=True)
    match kind:
        case "pipe":
            os.mkfifo(path)
        case "folder":
            path.mkdir()
        case _:
            path.symlink_to(path.with_name("supervisor.status"))


NO_FILE = "it is a link, a pipe, a folder or the like, not a file"


@pytest.mark.parametrize("kind", ["pipe", "folder", "link"])
def test_i6_what_is_no_file_stops_safely(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory, shared: Path, kind: str
) -> None:
    supervisor = start()
    assert robot.await_supervisor(DEADLINE_S)
    put_strange(kind, shared / "answer.robcad")
    if kind == "pipe":  # which is empty, as no message is
        ended(supervisor, 4, "answer.robcad", "an empty line")
    else:
        ended(supervisor, 5, "answer.robcad", NO_FILE)


@pytest.mark.parametrize("kind", ["pipe", "folder", "link"])
@pytest.mark.parametrize("name", [".command.robcad.supervisor.tmp", "supervisor.status"])
def test_i7_what_is_no_file_is_said_at_the_start(
    start: Callable[..., SupervisorProcess], shared: Path, kind: str, name: str
) -> None:
    """A pipe would hold up who opens it to write, until somebody reads."""
    if kind == "link":
        (shared / "other").touch()
        (shared / name).symlink_to("other")
    else:
        put_strange(kind, shared / name)
    ended(start(), 5, "supervisor.status" if "status" in name else "command.robcad", NO_FILE)


# --- I7 ---


def test_i7_what_an_earlier_run_left_is_reported_and_discarded(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory, shared: Path
) -> None:
    (shared / "answer.robcad").write_text("1\n# 1 99999999 00000000\n")
    (shared / ".answer.robcad.robot1.tmp").write_text("1")
    (shared / ".command.robcad.supervisor.tmp").write_text("half")
    (shared / "supervisor.status").write_text("running\n99999999 1\n\n")
    supervisor = start()
    assert robot.await_supervisor(DEADLINE_S)
    assert robot.session != "99999999"
    assert not (shared / ".answer.robcad.robot1.tmp").exists()
    assert [obey(robot) for _ in range(3)][0] == (0.5, 7.0)
    end = ended(supervisor, 0, "answer.robcad held", "discarded")
    assert end.stderr.count("discarded") == 1
    assert leftovers(shared) == []


def test_i7_one_supervisor_a_directory(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory
) -> None:
    first = start()
    assert robot.await_supervisor(DEADLINE_S)
    second = start()
    ended(second, 5, f"another supervisor (pid {first.pid})")
    assert robot.peer_alive()


def test_i7_a_robot_of_an_earlier_run_has_to_go_first(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory
) -> None:
    first = start()
    assert robot.await_supervisor(DEADLINE_S)
    first.kill()
    ended(start(), 5, f"robot1 (pid {os.getpid()}) of an earlier run is still alive")


# --- I8, I9 ---

ROBOT = """
import sys, time
from pathlib import Path
from pn2code.channels import SharedDirectory
s = SharedDirectory(Path(sys.argv[1]), "robot1", ())
print(s.await_supervisor(600.0), flush=True)
time.sleep(600)
"""


def test_i8_a_killed_robot_stops_the_supervisor(
    start: Callable[..., SupervisorProcess], shared: Path
) -> None:
    supervisor = start()
    with subprocess.Popen(
        [sys.executable, "-c", ROBOT, str(shared)], stdout=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"True\n"
        process.kill()
    ended(supervisor, 3, f"robot1 (pid {process.pid}) has died")
    assert status_of(shared)[0] == "stopped"


@pytest.mark.parametrize("commands", range(4))
@pytest.mark.parametrize("taken", [False, True])
def test_i8_a_killed_supervisor_is_noticed_and_the_next_run_is_clean(
    start: Callable[..., SupervisorProcess],
    robot: SharedDirectory,
    shared: Path,
    commands: int,
    taken: bool,
) -> None:
    supervisor = start("supervisor" if commands == 3 else "quick")
    assert robot.await_supervisor(DEADLINE_S)
    for _ in range(min(commands, 2)):
        obey(robot)
    await_message(robot, "command") if commands < 3 else None
    if taken and commands < 3:
        robot.clear("command")
    assert supervisor.kill().meaning == "killed by SIGKILL"
    assert robot.peer().state is PeerState.DEAD
    robot.set_status(Status.STOPPED, "the supervisor has died")
    robot.close()
    again = start()
    with SharedDirectory(shared, "robot1", SPECS) as other:
        assert other.await_supervisor(DEADLINE_S)
        assert [obey(other) for _ in range(3)] == [(0.5, 7.0), (0.6, 7.0), (0.7, 7.0)]
    ended(again, 0)
    assert leftovers(shared) == []


def test_i8_silence_is_not_endured(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory
) -> None:
    supervisor = start(reply_timeout_s=0.2)
    assert robot.await_supervisor(DEADLINE_S)
    ended(supervisor, 3, "robot1 has not answered command.robcad for 0.2 s")


def test_i8_a_robot_that_never_came(start: Callable[..., SupervisorProcess]) -> None:
    ended(start(reply_timeout_s=0.2), 3, "has not announced itself")


def test_i9_a_stopped_robot_stops_the_supervisor(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory
) -> None:
    supervisor = start()
    assert robot.await_supervisor(DEADLINE_S)
    robot.set_status(Status.STOPPED, "singularity near row 7")
    ended(supervisor, 3, "robot1 stopped: singularity near row 7")


def test_a_robot_that_ends_without_answering(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory
) -> None:
    supervisor = start()
    assert robot.await_supervisor(DEADLINE_S)
    await_message(robot, "command")
    robot.set_status(Status.FINISHED)
    ended(supervisor, 3, "robot1 has finished, but it owes an answer")


# --- I10 ---


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("lockstep", [False, True])
def test_i10_signals_stop_safely(
    start: Callable[..., SupervisorProcess],
    robot: SharedDirectory,
    shared: Path,
    tmp_path: Path,
    number: int,
    lockstep: bool,
) -> None:
    trace = tmp_path / "t.jsonl"
    supervisor = start(lockstep=lockstep, trace=trace)
    assert robot.await_supervisor(DEADLINE_S)
    os.kill(supervisor.pid, number)
    ended(supervisor, 130, "interrupted")
    assert status_of(shared)[0] == "stopped"
    assert robot.peer().state is PeerState.STOPPED
    assert json.loads(trace.read_text().splitlines()[-1])["why"].startswith("interrupted")
    assert leftovers(shared) == []


# --- errors of the model ---


def test_an_exception_of_the_net(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory, shared: Path
) -> None:
    supervisor = start()
    assert robot.await_supervisor(DEADLINE_S)
    await_message(robot, "command")
    robot.clear("command")
    robot.write("answer", (2,))
    ended(supervisor, 1, "transition `Trouble` (ID77)", "Overflow")
    assert (shared / "command.robcad").read_text() == "0\n"  # no further command


def test_no_end_of_firing(start: Callable[..., SupervisorProcess], robot: SharedDirectory) -> None:
    supervisor = start()
    assert robot.await_supervisor(DEADLINE_S)
    await_message(robot, "command")
    robot.write("answer", (4,))
    ended(supervisor, 1, "no end of firing", "Top.Spin")


# --- input files ---

INPUT_ERRORS = [
    ("", "orders.txt:1:1: the file ends where line 1 of 2 is expected: 1 value (`n`)"),
    ("3\n", "orders.txt:2:1: the file ends where line 2 of 2 is expected: 2 values (`x` `y`)"),
    ("3\n0.5\n", "orders.txt:2:4: found 1 value where 2 are expected"),
    ("3\n0.5 7 8\n", "orders.txt:2:7: found `8` after the 2 values that belong here"),
    ("3\n0.5 seven\n", "orders.txt:2:5: `seven` is not a number"),
    ("# c\n\n3\n  0.5 NaN\n", "orders.txt:4:7: `NaN` is not a number"),
    ("3\n0.5 1e400\n", "orders.txt:2:5: `1e400` is too large for a real number"),
    (
        "3.5\n0.5 7\n",
        "orders.txt:1:1: found `3.5` where `n` of colour set `COUNT` should be an integer",
    ),
    (
        "-1\n0.5 7\n",
        "orders.txt:1:1: -1 is outside `n` of colour set `COUNT`, which goes from 0 to 1000000000",
    ),
    ("13\n0.5 7\n", "not in the colour set"),
    ("3\n0.5 7\n1 2\n", "orders.txt:3:1: found `1 2` after the 2 lines that belong here"),
    ("\x00\x01\n", "is not a number"),
]


@pytest.mark.parametrize(("text", "message"), INPUT_ERRORS)
def test_input_errors_name_file_line_and_column(
    start: Callable[..., SupervisorProcess], inputs: Path, shared: Path, text: str, message: str
) -> None:
    (inputs / "orders.txt").write_text(text)
    ended(start(), 2, message)
    assert list(shared.iterdir()) == []  # nothing has been touched


def test_input_file_missing(start: Callable[..., SupervisorProcess], inputs: Path) -> None:
    (inputs / "orders.txt").unlink()
    ended(start(), 2, "orders.txt", "No such file", "--input")
    (inputs / "orders.txt").mkdir()
    ended(start(), 2, "orders.txt", "directory")


def test_blank_lines_comments_and_crlf_are_passed_over(
    start: Callable[..., SupervisorProcess], inputs: Path, robot: SharedDirectory
) -> None:
    (inputs / "orders.txt").write_bytes(b"# orders\r\n\r\n1\r\n\r\n0.5 7\r\n\r\n# end\n\n")
    supervisor = start()
    assert robot.await_supervisor(DEADLINE_S)
    assert obey(robot) == (0.5, 7.0)
    ended(supervisor, 0)


# --- the directory fails ---


def run(
    built: Path, inputs: Path, *arguments: str, program: str = "quick", **options: object
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(  # type: ignore[call-overload, no-any-return]
        [built / program, "--input", inputs, *arguments],
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
        **options,
    )


def test_directory_missing_or_no_directory(built: Path, inputs: Path, tmp_path: Path) -> None:
    done = run(built, inputs, "--dir", str(tmp_path / "nowhere" / "shared"))
    assert done.returncode == 5
    assert "cannot be made: the folder that should hold it does not exist" in done.stderr
    done = run(
        built, inputs, "--dir", str(inputs / "orders.txt")
    )  # also for root, who may write everywhere
    assert done.returncode == 5
    assert "Not a directory" in done.stderr


def test_a_directory_is_made(start: Callable[..., SupervisorProcess], shared: Path) -> None:
    shared.rmdir()
    supervisor = start()
    with SharedDirectory(shared, "robot1", SPECS) as robot:
        assert robot.await_supervisor(DEADLINE_S)
        assert shared.stat().st_mode & 0o777 == 0o700
        assert [obey(robot) for _ in range(3)]
        ended(supervisor, 0)


@pytest.mark.skipif(not Path("/sys/kernel").is_dir(), reason="no /sys")
def test_directory_that_cannot_be_written(built: Path, inputs: Path) -> None:
    done = run(
        built, inputs, "--dir", "/sys/kernel"
    )  # a file system where nobody, not even root, makes files
    assert done.returncode == 5
    assert "cannot write /sys/kernel/supervisor.status" in done.stderr


def test_full_from_the_beginning(built: Path, inputs: Path, shared: Path) -> None:
    done = run(
        built,
        inputs,
        "--dir",
        str(shared),
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0)),
    )
    assert done.returncode == 5
    assert "cannot write" in done.stderr
    assert leftovers(shared) == []


@pytest.mark.parametrize("lockstep", [False, True])
def test_full_in_the_middle(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory, shared: Path, lockstep: bool
) -> None:
    supervisor = start(lockstep=lockstep)
    assert robot.await_supervisor(DEADLINE_S)
    if lockstep:
        supervisor.step(0.0)
    await_message(robot, "command")
    robot.clear("command")
    robot.clear("pose1")
    resource.prlimit(
        supervisor.pid, resource.RLIMIT_FSIZE, (10, 10)
    )  # `0` still fits, a message does not
    robot.write("answer", (1,))
    if lockstep:
        assert "pose1.robcad" in (supervisor.step(1.0).stopped or "")
    ended(supervisor, 5, "cannot write", "pose1.robcad", "make room")
    assert (shared / "pose1.robcad").read_text() == "0\n"
    assert (shared / "command.robcad").read_text() == "0\n"
    assert leftovers(shared) == []
    assert not robot.peer_alive()


def test_a_full_file_system(built: Path, inputs: Path, tmp_path: Path) -> None:
    small = tmp_path / "small"
    small.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=4k", "tmpfs", str(small)]
    if (
        shutil.which("mount") is None
        or subprocess.run(mount, capture_output=True, check=False).returncode != 0
    ):
        pytest.skip("no file system can be mounted here")
    try:
        (small / "ballast").write_bytes(b"x" * 4096)
        done = run(built, inputs, "--dir", str(small))
        assert done.returncode == 5
        assert "No space left on device" in done.stderr
        assert leftovers(small) == []
    finally:
        subprocess.run(["umount", str(small)], check=True)


def test_directory_removed_in_the_middle(
    start: Callable[..., SupervisorProcess], robot: SharedDirectory, shared: Path
) -> None:
    supervisor = start()
    assert robot.await_supervisor(DEADLINE_S)
    await_message(robot, "command")
    aside = shared.with_name("aside")
    shared.rename(aside)  # at once, so that no single missing file is found first
    while aside.exists():  # the supervisor may be writing a file into it just now
        shutil.rmtree(aside, ignore_errors=True)
    ended(supervisor, 5, "has been removed")


def test_trace_that_cannot_be_written(
    start: Callable[..., SupervisorProcess], tmp_path: Path
) -> None:
    ended(start(trace=tmp_path / "no" / "t.jsonl"), 5, "cannot write the trace")
    if Path("/dev/full").exists():
        ended(start(trace=Path("/dev/full")), 5, "cannot write the trace /dev/full")


# --- without a robot ---


def test_dry_run_prints_each_message_and_touches_nothing(
    built: Path, inputs: Path, tmp_path: Path
) -> None:
    trace = tmp_path / "t.jsonl"
    done = run(
        built, inputs, "--dry-run", "--trace", str(trace), program="supervisor", cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("supervisor -> robot1  command.robcad: 1") == 3
    assert done.stdout.count("robot1 -> supervisor  answer.robcad: 1") == 3
    assert "4.000 s  supervisor -> robot1  pose1.robcad: 0.7000 7.0000" in done.stdout
    assert '"Top.Robot.Do"' in trace.read_text()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["input", "t.jsonl"]


def test_a_net_without_a_cell_runs_by_itself(built: Path, tmp_path: Path) -> None:
    done = run(built, tmp_path, program="alone")
    assert done.returncode == 0, done.stderr
    assert "Top.Done" in done.stdout
    assert "Top.Robot.Do  2" in done.stdout  # the net's own initial marking: two orders


def test_a_net_without_a_cell_that_is_cut_has_not_finished(built: Path, tmp_path: Path) -> None:
    """Neither on the screen nor in the trace; with as many firings as there are it has, and nothing is enabled."""
    whole = run(built, tmp_path, program="alone").stdout
    count = int(whole.removeprefix("fired ").partition(" ")[0])
    trace = tmp_path / "t.jsonl"
    for most, why in ((2, "no end after 2 firings"), (count, "finished")):
        done = run(built, tmp_path, f"--max-firings={most}", f"--trace={trace}", program="alone")
        assert done.returncode == 0
        assert ("transitions are still enabled" in done.stdout) == (most == 2)
        assert json.loads(trace.read_text().splitlines()[-1])["why"] == why
    assert done.stdout == whole


# --- the command line ---


def test_help_lists_options_and_exit_codes(built: Path, inputs: Path) -> None:
    done = run(built, inputs, "--help")
    assert done.returncode == 0
    for word in (
        "--dir",
        "--input",
        "--trace",
        "--dry-run",
        "--time-scale",
        "--lockstep",
        "--poll",
        "--reply-timeout",
    ):
        assert word in done.stdout
    for code in ("0  finished", "1  ", "2  ", "3  ", "4  ", "5  ", "70  ", "130  "):
        assert f" {code}" in done.stdout
    assert "hand" in run(built, inputs, "--version").stdout


@pytest.mark.parametrize(
    "arguments",
    [
        ["--frobnicate"],
        ["--poll"],
        ["--poll", "often"],
        ["--time-scale", "0"],
        ["--max-firings=-1"],
        ["--dirt"],
    ],
)
def test_wrong_usage(built: Path, inputs: Path, arguments: list[str]) -> None:
    done = run(built, inputs, *arguments)
    assert done.returncode == 2
    assert "--help" in done.stderr


# --- the code ---


def test_static_analysis_is_silent(root: Path, tmp_path: Path) -> None:
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    written = [root / "cnative/tests" / f for f in HAND_WRITTEN]
    for source in [*host_sources(root), *written][:: amount(2, 1)]:
        compile_c(root, tmp_path / "x.o", [source], "-O2", "-fanalyzer", "-c")


def test_the_latency_program_measures(
    root: Path, built: Path, inputs: Path, shared: Path, tmp_path: Path
) -> None:
    """That it works; how fast is not a test's business (docs/benchmarks.md)."""
    (inputs / "orders.txt").write_text("1000\n0.5 7\n")
    program = tmp_path / "latency"
    source = str(root / "cnative/tests/latency.c")
    subprocess.run(
        ["gcc", c_flags.STANDARD, "-O2", "-Wall", "-Wextra", "-Werror", source, "-o", str(program)],
        check=True,
    )
    done = subprocess.run(
        [program, shared, built / "quick", "20", inputs],
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("p99") == 3
