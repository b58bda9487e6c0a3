"""Patience with a process is counted in what it computes, not in what others compute meanwhile."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from pn2code.base.processor_time import Patience, group_time, processor_time

has_table = pytest.mark.skipif(
    not Path("/proc/self/stat").exists(), reason="this system has no /proc"
)


class Machine:
    """A clock on the wall, and what a process has computed."""

    def __init__(self) -> None:
        self.now = 0.0
        self.used: float | None = 5.0
        self.patience = Patience(10.0, lambda: self.used, lambda: self.now)

    def is_over(self, now: float, used: float | None) -> bool:
        self.now, self.used = now, used
        return self.patience.is_over()


def test_who_computes_for_so_long_has_had_its_time() -> None:
    machine = Machine()
    assert not machine.is_over(1.0, 6.0)
    assert not machine.is_over(10.9, 15.9)
    assert machine.is_over(11.1, 16.1)
    machine.patience.renew()
    assert not machine.is_over(12.0, 17.0)


def test_who_waits_for_the_processor_has_more() -> None:
    machine = Machine()
    assert not machine.is_over(1.0, 5.1)
    assert not machine.is_over(100.0, 15.0)
    assert machine.is_over(102.0, 15.2)


def test_who_does_nothing_has_had_its_time_in_the_end() -> None:
    machine = Machine()
    assert not machine.is_over(199.0, 5.0)
    assert machine.is_over(201.0, 5.0)


def test_where_nobody_tells_the_clock_decides() -> None:
    machine = Machine()
    assert not machine.is_over(9.0, None)
    assert machine.is_over(10.1, None)


@has_table
def test_of_a_process() -> None:
    used = processor_time(os.getpid())
    assert used is not None and used > 0.0
    assert processor_time(2**22 + 1) is None  # more than Linux has


COMPUTING = """
import os, time
if os.fork() == 0:
    while time.process_time() < 0.2: pass
    print(flush=True)
input()
"""


@has_table
def test_of_a_group() -> None:
    """The one that computes is a child of the first."""
    command = [sys.executable, "-c", COMPUTING]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        used, alone = group_time(process.pid), processor_time(process.pid)
        assert used is not None and alone is not None and used >= alone + 0.15
        process.communicate(b"\n\n")
    assert group_time(2**22 + 1) is None
