"""The Python side of the shared files. I1..I10: the invariants of docs/protocol.md."""

from __future__ import annotations

import errno
import math
import os
import socket
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pn2code.cell.partition import ChannelKind
from pn2code.cell.scalars import Scalar, ScalarKind, scalars_of
from pn2code.channels import (
    ChannelSpec,
    Message,
    NotWritten,
    PeerState,
    Reason,
    Refused,
    SharedDirectory,
    Status,
    Written,
)
from pn2code.channels.message import compose, parse
from pn2code.channels.scalars import Malformed, format_real, format_scalars, parse_scalars
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import INT, REAL

REALS = tuple(Scalar(ScalarKind.REAL, label, "COORD") for label in ("x", "y"))
FLAG = (Scalar(ScalarKind.INT, "flag", "FLAG"),)
SPECS = (
    ChannelSpec("pose1", "pose1.robcad", REALS, "supervisor", "robot1", ChannelKind.DATA),
    ChannelSpec("command", "command.robcad", FLAG, "supervisor", "robot1", ChannelKind.FLAG),
    ChannelSpec("answer", "answer.robcad", FLAG, "robot1", "supervisor", ChannelKind.FLAG),
)
SESSION = "0123abcd"


# --- scalars ---


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (5750.0, "5750.0000"),
        (0.0, "0.0000"),
        (-0.0, "-0.0000"),
        (5802.2072, "5802.2072"),
        (-1e-5, "-1e-05"),
        (0.1 + 0.2, "0.30000000000000004"),
        (1e300, f"{1e300:.4f}"),
        (5e-324, "5e-324"),
        (166.66667, "166.66667"),
    ],
)
def test_reals_have_four_decimals_where_that_is_exact(value: float, text: str) -> None:
    assert format_real(value) == text


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_every_real_reads_back(value: float) -> None:
    text = format_real(value)
    assert float(text) == value
    assert parse_scalars(REALS[:1], text) == (value,)
    assert math.copysign(1.0, float(text)) == math.copysign(1.0, value)


@pytest.mark.parametrize(
    "word",
    ["abc", "nan", "NaN", "inf", "1e400", "0x1p3", "1,5", "1.5.2", "--1", "1e", ".", "~1", "1_0"],
)
def test_what_is_no_real(word: str) -> None:
    found = parse_scalars(REALS[:1], word)
    assert isinstance(found, Malformed)
    assert not found.wrong_count


def test_scalars_of_each_kind() -> None:
    scalars = (
        Scalar(ScalarKind.BOOL, "b", "BOOL"),
        Scalar(ScalarKind.ENUM, "m", "MODE", names=("joint", "linear")),
        Scalar(ScalarKind.INDEX, "i", "PH", low=1, high=5),
        Scalar(ScalarKind.STRING, "s", "TEXT"),
        Scalar(ScalarKind.UNIT, "u", "UNIT"),
    )
    values = (True, "linear", 3, 'a "b" \\ \n é', 1)
    line = format_scalars(scalars, values)
    assert line == '1 linear 3 "a \\"b\\" \\\\ \\x0a \\xe9" 1'
    assert parse_scalars(scalars, line) == values
    out_of_range = parse_scalars(scalars, '1 linear 6 "" 1')
    assert isinstance(out_of_range, Malformed)
    assert "from 1 to 5" in out_of_range.text
    assert out_of_range.column == 10
    assert format_scalars(scalars, (True, "arc", 3, "", 1)) is None
    assert format_scalars(REALS, (1.0,)) is None
    assert format_scalars(REALS, (1.0, float("nan"))) is None


def test_scalars_of_a_colour_set() -> None:
    coord = Colset("COORD", Kind.REAL, REAL)
    count = Colset("COUNT", Kind.INT, INT, low=0, high=9)
    pose = Colset("POSE", Kind.RECORD, REAL, components=(coord, coord), labels=("x", "y"))
    pair = Colset("PAIR", Kind.PRODUCT, REAL, components=(count, pose))
    alias = Colset("ALIAS", Kind.ALIAS, REAL, components=(pair,))
    found = scalars_of(alias)
    assert found is not None
    assert [(s.label, s.colset) for s in found] == [
        ("#1", "COUNT"),
        ("#2.x", "COORD"),
        ("#2.y", "COORD"),
    ]
    assert (found[0].low, found[0].high) == (0, 9)
    assert scalars_of(Colset("LIST", Kind.LIST, INT, components=(count,))) is None


# --- messages: I6 ---


def test_a_message_and_its_seal() -> None:
    text = compose(SPECS[0], (1.5, -2.0), seq=7, session=SESSION)
    assert text is not None
    assert text.startswith("1.5000 -2.0000\n# 7 0123abcd ")
    assert parse(SPECS[0], text, session=SESSION, consumed=6) == Message("pose1", (1.5, -2.0), 7)


def test_a_message_written_by_hand_needs_no_seal() -> None:
    for text in ("1.5 -2\n", "1.5 -2", "  1.5\t-2.0  \r\n"):
        assert parse(SPECS[0], text, session=SESSION, consumed=6) == Message(
            "pose1", (1.5, -2.0), None
        )


def test_zero_is_the_empty_channel() -> None:
    for text in ("0\n", "0", "0 \r\n"):
        assert parse(SPECS[1], text, session=SESSION, consumed=0) is None


def test_a_zero_with_line_2_is_a_message() -> None:
    text = compose(SPECS[1], (0,), seq=1, session=SESSION)
    assert text is not None and text.startswith("0\n# 1 ")
    assert parse(SPECS[1], text, session=SESSION, consumed=0) == Message("command", (0,), 1)
    again = parse(SPECS[1], text, session=SESSION, consumed=1)
    assert isinstance(again, Refused) and again.reason is Reason.REPEATED
    torn = parse(SPECS[1], text[:-4], session=SESSION, consumed=0)
    assert isinstance(torn, Refused) and torn.reason is Reason.TRAILER
    pair = parse(
        SPECS[0], compose(SPECS[1], (0,), seq=1, session=SESSION) or "", session=SESSION, consumed=0
    )
    assert (
        isinstance(pair, Refused) and pair.reason is Reason.COUNT
    )  # `0` with a line 2 is never an empty channel


GOOD = compose(SPECS[0], (1.5, -2.0), seq=7, session=SESSION) or ""


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", Reason.SHAPE),
        ("\n", Reason.SHAPE),
        ("1.5", Reason.COUNT),
        ("1.5 2 3", Reason.COUNT),
        ("1.5 abc", Reason.SCALAR),
        ("nan 1", Reason.SCALAR),
        ("1 1e400", Reason.SCALAR),
        ("\x00\xff\x80", Reason.SHAPE),
        ("1 2\n# 7 0123abcd", Reason.TRAILER),
        ("1 2\n# by hand\n", Reason.TRAILER),
        ("1 2\n\n\n", Reason.SHAPE),
        ("1 2\n3 4\n5 6\n", Reason.SHAPE),
        (GOOD[:-2] + "x\n", Reason.TRAILER),
        (GOOD.replace("1.5000", "1.6000"), Reason.CHECKSUM),
        (GOOD.replace("# 7", "# 8"), Reason.CHECKSUM),
        (compose(SPECS[0], (1.5, -2.0), seq=7, session="99999999"), Reason.SESSION),
        (compose(SPECS[0], (1.5, -2.0), seq=6, session=SESSION), Reason.REPEATED),
        (compose(SPECS[0], (1.5, -2.0), seq=9, session=SESSION), Reason.LOST),
        ("7" * 5000, Reason.SHAPE),
    ],
)
def test_what_is_refused(text: str, reason: Reason) -> None:
    found = parse(SPECS[0], text, session=SESSION, consumed=6)
    assert isinstance(found, Refused)
    assert found.reason is reason
    assert found.text


@given(st.integers(min_value=0, max_value=len(GOOD) - 1))
def test_a_torn_message_is_never_taken_for_another(cut: int) -> None:
    found = parse(SPECS[0], GOOD[:cut], session=SESSION, consumed=6)
    if isinstance(
        found, Message
    ):  # cut at the end of line 1: the whole payload, as if written by hand
        assert found.scalars == (1.5, -2.0) or cut < len("1.5000 -2.0000")
    if cut > len("1.5000 -2.0000\n") and cut < len(GOOD) - 1:
        assert isinstance(found, Refused)


# --- two parties ---


@pytest.fixture
def parties(tmp_path: Path) -> Iterator[tuple[SharedDirectory, SharedDirectory]]:
    with (
        SharedDirectory(tmp_path, "supervisor", SPECS) as a,
        SharedDirectory(tmp_path, "robot1", SPECS) as b,
    ):
        a.announce()
        assert b.await_supervisor(600.0)
        yield a, b


def test_a_conversation(parties: tuple[SharedDirectory, SharedDirectory]) -> None:
    a, b = parties
    for round_ in (1, 2, 3):
        assert b.read("command") is None
        assert a.write("pose1", (0.1, 0.2)) == Written(round_)
        assert a.write("command.robcad", (1,)) == Written(round_)  # by file name as well
        command = b.read("command")
        assert command == Message("command", (1,), round_)
        assert b.read("command") == command  # the same until it is cleared: not "repeated"
        assert b.read("pose1") == Message("pose1", (0.1, 0.2), round_)
        assert not a.is_taken("command")
        b.clear("command")
        b.clear("pose1")
        assert a.is_taken("command")
        assert b.write("answer", (1,)) == Written(round_)
        assert isinstance(a.read("answer"), Message)
        a.clear("answer")


def test_i2_no_temporary_file_stays(parties: tuple[SharedDirectory, SharedDirectory]) -> None:
    a, _ = parties
    a.write("command", (1,))
    assert not [p for p in a.path.iterdir() if p.name.endswith(".tmp")]


def test_i3_no_overwriting(parties: tuple[SharedDirectory, SharedDirectory]) -> None:
    a, b = parties
    a.write("command", (1,))
    second = a.write("command", (2,))
    assert isinstance(second, NotWritten)
    assert second.code == "channel-overrun"
    assert b.read("command") == Message("command", (1,), 1)


def test_what_does_not_fit_is_not_written(parties: tuple[SharedDirectory, SharedDirectory]) -> None:
    a, b = parties
    for values in ((1.0,), (float("inf"), 1.0), ("a", 1.0)):
        result = a.write("pose1", values)
        assert isinstance(result, NotWritten)
        assert result.code == "channel-value"
    refused = a.write("pose1", (float("inf"),))
    assert isinstance(refused, NotWritten)
    assert "(inf" not in refused.text and "inf" in refused.text  # no tuple of Python
    assert b.read("pose1") is None


def test_i6_repeated_message_is_refused_once(
    parties: tuple[SharedDirectory, SharedDirectory],
) -> None:
    a, b = parties
    a.write("command", (1,))
    text = (a.path / "command.robcad").read_text()
    assert isinstance(b.read("command"), Message)
    b.clear("command")
    (a.path / "command.robcad").write_text(text)
    again = b.read("command")
    assert isinstance(again, Refused)
    assert again.reason is Reason.REPEATED
    assert again.first
    more = b.read("command")
    assert isinstance(more, Refused)
    assert not more.first


def test_overwritten_before_it_was_consumed(
    parties: tuple[SharedDirectory, SharedDirectory],
) -> None:
    a, b = parties
    a.write("command", (1,))
    assert isinstance(b.read("command"), Message)
    (a.path / "command.robcad").write_text("2\n")
    found = b.read("command")
    assert isinstance(found, Refused)
    assert found.reason is Reason.OVERWRITTEN


def test_missing_file(parties: tuple[SharedDirectory, SharedDirectory]) -> None:
    a, b = parties
    (a.path / "command.robcad").unlink()
    found = b.read("command")
    assert isinstance(found, Refused)
    assert found.reason is Reason.MISSING
    assert isinstance(a.write("command", (1,)), NotWritten)


STRANGE = ("pipe", "link to a pipe", "link", "folder", "socket")


def put_strange(kind: str, path: Path) -> None:
    """Something in the place of a file that none of the parties has put there."""
    path.unlink(missing_ok=True)
    beside = path.with_name(f"{path.name}.beside")
    match kind:
        case "pipe":
            os.mkfifo(path)
        case "link to a pipe":
            os.mkfifo(beside)
            path.symlink_to(beside)
        case "link":
            beside.write_text("0\n")
            path.symlink_to(beside)
        case "folder":
            path.mkdir()
        case _:
            with socket.socket(socket.AF_UNIX) as server:
                server.bind(
                    os.path.relpath(path)
                )  # a longer name than 100 characters has no socket


@pytest.mark.parametrize("kind", STRANGE)
def test_what_is_no_file_holds_nobody_up(
    parties: tuple[SharedDirectory, SharedDirectory],
    kind: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each is said, with the name of the file; a thread that never comes back would be a robot that does not stop."""
    monkeypatch.chdir(tmp_path)
    a, b = parties
    names = ("command.robcad", ".answer.robcad.robot1.tmp", "supervisor.status")
    calls: tuple[Callable[[], object], ...] = (
        lambda: b.read("command"),
        lambda: b.write("answer", (1,)),
        b.peer,
    )
    for name, call in zip(names, calls, strict=True):
        with tempfile.TemporaryDirectory(dir=tmp_path) as kept:
            if (a.path / name).exists():
                (a.path / name).rename(Path(kept) / name)
            put_strange(kind, a.path / name)
            found: list[object] = []

            def carry_out(call: Callable[[], object] = call, found: list[object] = found) -> None:
                try:
                    found.append(call())
                except OSError as problem:
                    found.append(problem)

            thread = threading.Thread(target=carry_out, daemon=True)
            thread.start()
            thread.join(20.0)
            assert found, f"{name} as a {kind}: nothing for 20 s"
            assert isinstance(found[0], OSError), found
            assert not isinstance(found[0], BlockingIOError), "that says: another process is robot1"
            assert str(found[0].filename).endswith(name)
            assert "not a file" in str(found[0])


def test_a_full_disk_is_said_with_the_name_of_the_file(
    parties: tuple[SharedDirectory, SharedDirectory], monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is found by a write, of which the system tells no name."""
    _, b = parties

    def full(_path: Path, _data: bytes) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("pn2code.channels.directory._write_new", full)
    with pytest.raises(OSError, match="No space left") as raised:
        b.write("answer", (1,))
    assert str(raised.value.filename).endswith("answer.robcad")


def test_a_status_is_read_no_further_than_it_can_be_long(
    parties: tuple[SharedDirectory, SharedDirectory],
) -> None:
    a, b = parties
    path = a.path / "supervisor.status"
    path.write_text(f"running\n{a.session} {'1' * 5000}\n\n")
    assert b.peer().pid is None
    with path.open("r+b") as stream:
        stream.truncate(1 << 40)  # a hole; nobody has memory for all of it
    assert b.peer().pid is None
    with (a.path / "command.robcad").open("r+b") as stream:
        stream.truncate(1 << 40)
    found = b.read("command")
    assert isinstance(found, Refused) and found.reason is Reason.SHAPE


def test_i7_nobody_is_awaited_in_vain(tmp_path: Path) -> None:
    with SharedDirectory(tmp_path, "robot1", SPECS) as robot:
        assert not robot.await_supervisor(0.05)
        assert (
            list(tmp_path.iterdir()) == []
        )  # nothing touched before the supervisor announced itself
    (tmp_path / "supervisor.status").write_text("running\n0123abcd 1\n\n")  # a dead one's
    with SharedDirectory(tmp_path, "robot1", SPECS) as robot:
        assert not robot.await_supervisor(0.05)


def test_i7_stale_message_of_an_earlier_session(tmp_path: Path) -> None:
    with SharedDirectory(tmp_path, "supervisor", SPECS) as first:
        first.announce()
        first.write("command", (1,))
    with (
        SharedDirectory(tmp_path, "supervisor", SPECS) as second,
        SharedDirectory(tmp_path, "robot1", SPECS) as robot,
    ):
        second.announce()
        assert robot.await_supervisor(600.0)
        assert robot.read("command") is None


def test_i8_one_process_a_side(parties: tuple[SharedDirectory, SharedDirectory]) -> None:
    a, _ = parties
    other = SharedDirectory(a.path, "supervisor", SPECS)
    with pytest.raises(BlockingIOError):
        other.announce()
    assert a.peer("robot1").state is PeerState.RUNNING


def test_i8_a_killed_supervisor_is_noticed(tmp_path: Path) -> None:
    code = (
        "import sys, time; from pathlib import Path; from pn2code.channels import SharedDirectory\n"
        "s = SharedDirectory(Path(sys.argv[1]), 'supervisor', ())\n"
        "s.announce(); print('up', flush=True); time.sleep(600)"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path)], stdout=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        with SharedDirectory(tmp_path, "robot1", SPECS) as robot:
            assert robot.await_supervisor(600.0)
            assert robot.peer_alive()
            process.kill()
            process.wait()
            assert robot.peer().state is PeerState.DEAD
            assert robot.peer().pid == process.pid


def test_i9_status_passes_on_the_reason(parties: tuple[SharedDirectory, SharedDirectory]) -> None:
    a, b = parties
    a.set_status(Status.STOPPED, "robot2 collided\nwith the panel")
    assert b.peer().state is PeerState.STOPPED
    assert b.peer().reason == "robot2 collided with the panel"
    assert not b.peer_alive()
    status = b.path / "supervisor.status"
    status.write_text(status.read_text().replace("with the", "with\u2028the"))
    assert b.peer().reason == "robot2 collided with\u2028the panel"
    b.set_status(Status.FINISHED)
    assert a.peer("robot1").state is PeerState.FINISHED
    b.close()
    assert (
        a.peer("robot1").state is PeerState.FINISHED
    )  # said before the lock was given up: not dead


def test_i8_a_new_supervisor_is_not_mistaken_for_the_old(tmp_path: Path) -> None:
    with SharedDirectory(tmp_path, "robot1", SPECS) as robot:
        with SharedDirectory(tmp_path, "supervisor", SPECS) as first:
            first.announce()
            assert robot.await_supervisor(600.0)
        with SharedDirectory(tmp_path, "supervisor", SPECS) as second:
            second.announce()
            assert robot.peer().state is PeerState.REPLACED
            assert not robot.peer_alive()


def test_removed_directory_is_an_error_with_nothing_left(tmp_path: Path) -> None:
    path = tmp_path / "shared"
    path.mkdir()
    with SharedDirectory(path, "supervisor", SPECS) as a:
        a.announce()
        for file in path.iterdir():
            file.unlink()
        path.rmdir()
        with pytest.raises(FileNotFoundError):
            a.read("answer")
        with pytest.raises(FileNotFoundError):
            a.clear("answer")
