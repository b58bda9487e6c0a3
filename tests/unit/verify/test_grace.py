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
        """Of a process with a limit of 10 s, hence a grace of 1.1 s."""
        return Grace(Deadline.after(10.0, lambda: self.now), lambda: self.used)


def at(machine: Machine, grace: Grace, now: float, used: float | None) -> bool:
    machine.now, machine.used = now, used
    return grace.is_over()


def test_a_process_that_computes_on_is_ended() -> None:
    machine = Machine()
    grace = machine.grace()
    assert not at(machine, grace, 9.9, 9.0)
    assert not at(machine, grace, 10.0, 9.0)
    assert not at(machine, grace, 11.0, 10.0)
    assert at(machine, grace, 11.2, 10.2)


def test_a_process_that_waits_for_the_processor_has_more_time() -> None:
    machine = Machine()
    grace = machine.grace()
    assert not at(machine, grace, 10.0, 4.0)
    assert not at(machine, grace, 12.0, 5.0)
    assert at(machine, grace, 12.1, 5.2)


def test_a_process_that_does_nothing_is_ended_in_the_end() -> None:
    machine = Machine()
    grace = machine.grace()
    assert not at(machine, grace, 10.0, 4.0)
    assert not at(machine, grace, 10.0 + MOST * 1.1 - 0.1, 4.0)
    assert at(machine, grace, 10.0 + MOST * 1.1 + 0.1, 4.0)


def test_where_the_processor_time_is_not_known_the_clock_decides() -> None:
    machine = Machine()
    grace = machine.grace()
    assert not at(machine, grace, 11.0, None)
    assert at(machine, grace, 11.2, None)
    assert not Grace(NEVER, lambda: None).is_over()
