"""An explorer that is late because others compute is not ended; one that computes on is."""

from __future__ import annotations

from pn2code.base.deadline import NEVER, Deadline
from pn2code.verify.exploring.grace import MOST, Grace


class Machine:
    """A clock on the wall, and what a process has computed."""

    def __init__(self) -> None:
        self.now = 0.0
        self.used: float | None = 5.0

    def grace(self) -> Grace:
        """Of a process with a limit of 10 s, hence a grace of 0.33 s."""
        return Grace(Deadline.after(10.0, lambda: self.now), lambda: self.used)


def at(machine: Machine, grace: Grace, now: float, used: float | None) -> bool:
    machine.now, machine.used = now, used
    return grace.is_over()


def test_a_process_that_computes_on_is_ended() -> None:
    machine = Machine()
    grace = machine.grace()
    assert not at(machine, grace, 9.9, 9.0)
    assert not at(machine, grace, 10.0, 9.0)
    assert not at(machine, grace, 10.3, 9.3)
    assert at(machine, grace, 10.4, 9.4)


def test_a_process_that_waits_for_the_processor_has_more_time() -> None:
    machine = Machine()
    grace = machine.grace()
    assert not at(machine, grace, 10.0, 4.0)
    assert not at(machine, grace, 10.6, 4.2)
    assert at(machine, grace, 10.65, 4.4)


def test_a_process_that_does_nothing_is_ended_in_the_end() -> None:
    machine = Machine()
    grace = machine.grace()
    assert not at(machine, grace, 10.0, 4.0)
    assert not at(machine, grace, 10.0 + MOST * 0.33 - 0.05, 4.0)
    assert at(machine, grace, 10.0 + MOST * 0.33 + 0.05, 4.0)


def test_no_limit_is_overrun_by_a_fifth() -> None:
    """Whatever the process does, and with time left for the report."""
    for seconds in (1.0, 3.0, 60.0):
        machine = Machine()
        grace = Grace(Deadline.after(seconds, lambda machine=machine: machine.now), lambda: None)  # type: ignore[misc]
        assert at(machine, grace, 1.13 * seconds, None)


def test_where_the_processor_time_is_not_known_the_clock_decides() -> None:
    machine = Machine()
    grace = machine.grace()
    assert not at(machine, grace, 10.3, None)
    assert at(machine, grace, 10.4, None)
    assert not Grace(NEVER, lambda: None).is_over()
