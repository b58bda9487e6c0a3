"""The time of a command: with a clock that the test turns, and tools that wait for it."""

from __future__ import annotations

import importlib
import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from helpers.netbuilder import flat
from pn2code.base import deadline as deadline_module
from pn2code.base.deadline import NEVER, CommandIsOverError, Deadline, TimeIsOverError
from pn2code.diagnostics import Diagnostics
from pn2code.toolchain.programs import Compiler, _Builder
from pn2code.verify.codes import TIME_OVER
from pn2code.verify.exploring import explore as explore_module
from pn2code.verify.exploring import programs
from pn2code.verify.exploring.explore import explore
from pn2code.verify.exploring.limits import Limits

NET = """
    net Tiny
      colset N = int;
      var n : N;
      place P : N = 1`0
      trans T
        in P : n
        out P : 1 - n
"""


class Clock:
    """It stands still until something has happened."""

    def __init__(self, event: Path | None = None) -> None:
        self.now = 100.0
        self._event = event

    def __call__(self) -> float:
        if self._event is not None and self._event.exists():
            return self.now + 1000.0
        return self.now


def test_a_deadline() -> None:
    clock = Clock()
    deadline = Deadline.after(10.0, clock)
    assert (deadline.left, deadline.is_over(), deadline.is_long_over()) == (10.0, False, False)
    clock.now += 10.0
    assert (deadline.left, deadline.is_over(), deadline.is_long_over()) == (0.0, True, False)
    clock.now += 0.3
    assert not deadline.is_long_over()
    clock.now += 0.1
    assert deadline.is_long_over()
    assert (NEVER.left, NEVER.is_over(), NEVER.is_long_over()) == (None, False, False)
    assert Deadline.after(None, clock).left is None


def test_a_part_of_the_time() -> None:
    """Each part is one of what is left then."""
    clock = Clock()
    deadline = Deadline.after(10.0, clock)
    first = deadline.share(0.4)
    assert first.left == pytest.approx(4.0)
    clock.now += 4.0
    assert first.is_over() and not deadline.is_over()
    assert deadline.share(0.5).left == pytest.approx(3.0)
    clock.now += 7.0
    assert deadline.share(0.5).is_over()
    assert NEVER.share(0.5) is NEVER


def test_the_time_of_a_command_begins_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Loading the modules counts, and nothing is forgotten when a verb makes its deadline late."""
    monkeypatch.setattr(deadline_module, "_started", time.monotonic() - 50.0)
    deadline = Deadline.of_command(40.0)
    assert deadline.is_over() and deadline.is_long_over()
    assert not Deadline.of_command(1000.0).is_over()
    assert Deadline.of_command(None).left is None
    monkeypatch.setattr(deadline_module, "_started", None)  # not started as a command
    assert not Deadline.of_command(1000.0).is_over()


def test_python_is_left_when_the_time_is_over() -> None:
    with pytest.raises(TimeIsOverError), Deadline.after(0.01).enforced():
        while True:  # nothing else ends it
            pass
    clock = Clock()
    with Deadline.after(
        0.0001, clock
    ).enforced():  # the alarm rings, but for this clock it is early
        sum(range(1_000_000))
    with pytest.raises(TimeIsOverError), Deadline.after(0.0, clock).enforced():
        raise AssertionError("it does not begin")


def test_a_module_is_loaded_to_its_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The alarm that rings in an import is not heard; it comes again after it."""
    (tmp_path / "rings_in_import.py").write_text(
        "import sys\nfrom pn2code.base.deadline import Deadline\n"
        "Deadline.after(0.0)._ring(14, sys._getframe())\nloaded = True\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    assert importlib.import_module("rings_in_import").loaded
    with pytest.raises(TimeIsOverError):
        Deadline.after(0.0)._ring(14, sys._getframe())


def test_what_is_tidied_up_is_not_broken_off() -> None:
    """The alarm that rings while the block is being left is one too many."""
    tidied = []
    with pytest.raises(TimeIsOverError):
        try:
            Deadline.after(0.0)._ring(14, sys._getframe())
        finally:
            try:
                raise ValueError
            except ValueError:
                Deadline.after(0.0)._ring(14, sys._getframe())
            Deadline.after(0.0)._ring(14, sys._getframe())
            tidied.append(True)
    assert tidied == [True]


def _wait(seconds: float = 600.0) -> None:
    """Until an alarm rings; the seconds only end what hangs."""
    ends = time.monotonic() + seconds
    while time.monotonic() < ends:
        pass
    pytest.fail("no alarm")


def test_the_end_of_a_command_passes_those_who_wait_for_other_ends() -> None:
    """Whoever goes on when its own time is over, or has no limit, does not take the end of the command for that."""
    with (
        pytest.raises(CommandIsOverError),
        Deadline.after(0.05).enforced(CommandIsOverError),
        suppress(TimeIsOverError),
        NEVER.enforced(),
    ):
        _wait()


def test_an_outer_deadline_counts_after_an_inner_one() -> None:
    with (
        pytest.raises(CommandIsOverError),
        Deadline.after(0.05).enforced(CommandIsOverError),
    ):
        with Deadline.after(1000.0).enforced():
            pass
        with suppress(TimeIsOverError), Deadline.after(0.001).enforced():
            _wait()
        _wait()


def test_nothing_rings_after_the_block() -> None:
    import signal

    before = signal.getsignal(signal.SIGALRM)
    with Deadline.after(100.0).enforced():
        assert signal.getitimer(signal.ITIMER_REAL)[0] > 0
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)
    assert signal.getsignal(signal.SIGALRM) == before


def stand_in(path: Path, lines: str) -> Path:
    path.write_text(f"#!/bin/sh\n{lines}\n")
    path.chmod(0o755)
    return path


def ended(pid: int) -> bool:
    with suppress(OSError):
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    return True


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks at /proc")
def test_a_compiler_is_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It would work for ever; the time is over as soon as it has begun."""
    began = tmp_path / "began"
    compiler = stand_in(
        tmp_path / "compiler",
        f'[ "$1" = --version ] && {{ echo stand-in; exit 0; }}\n'
        f"echo $$ > {tmp_path}/pid.$$\n: > {began}\nexec sleep 100000",
    )
    monkeypatch.setenv("CC", str(compiler))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    d = Diagnostics()
    found = explore(flat(NET), {}, Limits(deadline=Deadline.after(5.0, Clock(began))), d)
    assert found is not None
    assert (found.complete, found.why, found.nodes, found.seen.markings) == (
        False,
        "seconds",
        0,
        False,
    )
    assert [i.code for i in d] == [TIME_OVER]
    pids = [int(file.read_text()) for file in tmp_path.glob("pid.*") if file.read_text()]
    assert pids and all(ended(pid) for pid in pids)


def test_no_tool_works_on_in_a_folder_that_is_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The time is over while the net is compiled: what is compiled beside it ends first."""
    ended_first: list[bool] = []

    def library(self: _Builder, room: Path, _: Diagnostics) -> bool:
        tries = 0
        while not self.interrupted() and tries < 60_000:
            time.sleep(0.01)
            tries += 1
        ended_first.append(self.interrupted() and room.is_dir())
        return False

    def net(*_: object) -> bool:
        raise TimeIsOverError

    monkeypatch.setattr(_Builder, "_library", library)
    monkeypatch.setattr(_Builder, "_net", net)
    compiler = Compiler(("cc",), "")
    d = Diagnostics()
    builder = _Builder(tmp_path, programs.HOST, compiler, (), lambda: False)
    with pytest.raises(TimeIsOverError):
        builder.kept(d)
    assert ended_first == [True]
    assert not list(tmp_path.iterdir()) and not list(d)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks at /proc")
def test_an_explorer_that_does_not_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An inscription that computes for ever does not look at the clock."""
    began = tmp_path / "began"
    explorer = stand_in(
        tmp_path / "explorer", f"echo $$ > {tmp_path}/pid\n: > {began}\nexec sleep 100000"
    )

    @contextmanager
    def program(*_: object, **__: object) -> Iterator[Path]:
        yield explorer

    monkeypatch.setattr(explore_module.programs, "program", program)
    d = Diagnostics()
    found = explore(flat(NET), {}, Limits(deadline=Deadline.after(5.0, Clock(began))), d)
    assert found is not None
    assert (found.complete, found.why, found.nodes) == (False, "seconds", 0)
    assert [i.code for i in d] == [TIME_OVER]
    assert ended(int((tmp_path / "pid").read_text()))


def test_the_time_is_over_before_anything(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: object, **__: object) -> None:
        raise AssertionError("nothing is compiled")

    monkeypatch.setattr(programs, "generated", never)
    d = Diagnostics()
    found = explore(flat(NET), {}, Limits(deadline=Deadline.after(0.0)), d)
    assert found is not None and (found.why, found.nodes) == ("seconds", 0)
    assert [i.code for i in d] == [TIME_OVER]
    assert os.environ  # the process lives on
