"""Robots that stop, die, end too early, say nothing, or say what nobody understands (I8, I9)."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from helpers.counted import Done, Lab
from pn2code.channels import SharedDirectory, Status
from pn2code.run.supervisor import SupervisorProcess
from situations import situation
from situations.channels import SPECS
from situations.starting import held


@contextmanager
def cell(
    lab: Lab, order: int, program: str = "odd.deployed", **options: object
) -> Iterator[tuple[SupervisorProcess, Path, list[SharedDirectory]]]:
    """A supervisor in lock-step after its first cycle, and its two robots, which have joined."""
    folder = lab.fresh()
    (folder / "orders.txt").write_text(f"{order}\n")
    with lab.started(program, folder, lockstep=True, **options) as supervisor:
        shared = folder / "shared"
        sides = [SharedDirectory(shared, name, SPECS) for name in ("robot1", "robot2")]
        assert supervisor.step(0.0).stopped is None
        try:
            for side in sides:
                assert side.await_supervisor(600.0)
            yield supervisor, shared, sides
        finally:
            for side in sides:
                side.close()


def stopped(supervisor: SupervisorProcess, shared: Path, code: int, *words: str) -> None:
    """The next step stops it."""
    result = supervisor.step(1.0)
    assert result.stopped is not None, result
    end = supervisor.wait(600.0)
    Done(end.code, "", end.stderr, shared).stopped(code, *words)


@situation
def a_robot_that_stops(lab: Lab) -> None:
    for reason, said in (("a singularity", "a singularity"), ("", "it gave no reason")):
        with cell(lab, 2) as (supervisor, shared, (_, second)):
            second.set_status(Status.STOPPED, reason)
            stopped(supervisor, shared, 3, f"robot2 stopped: {said}")


@situation
def a_robot_that_dies(lab: Lab) -> None:
    with cell(lab, 2) as (supervisor, shared, (first, _)):
        status = (shared / "robot1.status").read_text()
        pid = status.split()[2]
        first.close()
        (shared / "robot1.status").write_text(status)
        stopped(supervisor, shared, 3, f"robot1 (pid {pid}) has died")


@situation
def a_robot_that_ends_and_owes_an_answer(lab: Lab) -> None:
    with cell(lab, 2) as (supervisor, shared, (first, _)):
        first.set_status(Status.FINISHED)
        assert supervisor.step(0.5).stopped is None, "its last message may still be on its way"
        stopped(
            supervisor, shared, 3, "robot1 has finished, but it owes an answer to command.robcad"
        )
    with cell(lab, 2) as (supervisor, shared, (first, _)):
        first.set_status(Status.FINISHED)
        assert supervisor.step(0.5).stopped is None
        (shared / "answer.robcad").write_text("1\n")
        assert supervisor.step(1.0).stopped is not None, "it is looked at before the messages are"


@situation
def a_last_message_on_its_way(lab: Lab) -> None:
    with cell(lab, 2) as (supervisor, shared, (first, _)):
        first.set_status(Status.FINISHED)
        (shared / "answer.robcad").write_text("1\n")
        assert supervisor.step(0.5).finished
        assert supervisor.wait(600.0).code == 0


@situation
def all_have_ended_and_nothing_can_happen(lab: Lab) -> None:
    for order, flags, more in ((3, (), "`Odd.Done`, ..."), (3, ("-DODD_FINALS=1U",), "`Odd.Done`")):
        program = lab.program("odd.deployed", *flags)
        with cell(lab, order, program) as (supervisor, shared, sides):  # type: ignore[arg-type]
            sides[0].set_status(Status.FINISHED)
            sides[0].close()
            assert supervisor.step(0.5).stopped is None and supervisor.step(0.5).stopped is None, (
                "one is still there"
            )
            sides[1].set_status(Status.FINISHED)
            assert supervisor.step(0.5).stopped is None, "seen once"
            said = f"deadlock: all robots have finished, nothing is enabled, and no final place ({more}) holds a token"
            stopped(supervisor, shared, 1, said)
    none = lab.program("odd.deployed", "-DODD_FINALS=0U")
    for program, order in ((none, 3), (lab.program("odd.deployed"), 15)):
        with cell(lab, order, program) as (supervisor, shared, sides):  # type: ignore[arg-type]
            for side in sides:
                side.set_status(Status.FINISHED)
            for _ in range(3):
                assert supervisor.step(0.5).stopped is None, (
                    "it may rest there, or something comes with time"
                )


@situation
def statuses_that_nobody_understands(lab: Lab) -> None:
    """Whose status is not of this session has not announced itself, whatever it says."""
    with cell(lab, 2, reply_timeout_s=5.0) as (supervisor, shared, sides):
        session = sides[0].session
        sides[0].close()
        lock = held(shared / "robot1.status")
        for text in ("", "dead\n", f"running\n{session}\n\n", "running\n\n\n", "stopped\n99999999 1\nold\n",
                     f"asleep\n{session} 7\n\n", "x" * 2000, "running\n" + "y" * 600, "\x00\x01\n\n",
                     f"stopped\n{session}x 7\nmine\n", f"stopped\n{session} seven\nmine\n"):  # fmt: skip
            (shared / "robot1.status").write_text(text)
            assert supervisor.step(1.0).stopped is None, text
        (shared / "robot1.status").unlink()
        (shared / "robot1.status").symlink_to("/dev/null")
        assert supervisor.step(1.0).stopped is None
        (shared / "robot1.status").unlink()
        assert supervisor.step(6.0).stopped is None
        stopped(
            supervisor,
            shared,
            3,
            "robot1 has not answered command.robcad for 5 s; it has not announced itself",
        )
        del lock
    with cell(lab, 2) as (supervisor, shared, sides):
        sides[0].close()
        lock = held(shared / "robot1.status")
        (shared / "robot1.status").write_text(f"stopped\n{sides[1].session} 7\n{'why ' * 200}\n")
        stopped(supervisor, shared, 3, "robot1 stopped: why why why")
        del lock


@situation
def a_status_file_that_goes(lab: Lab) -> None:
    """Once a robot has come: nobody would notice any more that it dies. In real time it may come back for a while."""
    said = "the status file of robot2 has gone or cannot be understood"
    with cell(lab, 2) as (supervisor, shared, _):
        assert supervisor.step(0.5).stopped is None, "now both have been seen"
        (shared / "robot2.status").unlink()
        stopped(supervisor, shared, 3, said)
    folder = lab.fresh()
    (folder / "orders.txt").write_text("2\n")
    with lab.started("odd.deployed", folder, reply_timeout_s=6000.0) as supervisor:
        shared = folder / "shared"
        with SharedDirectory(shared, "robot2", SPECS) as side:
            assert side.await_supervisor(600.0)
            while supervisor.running:  # it may not have looked before
                (shared / "robot2.status").rename(shared / "elsewhere")
                for _ in range(20):
                    time.sleep(0.1 if supervisor.running else 0.0)
                (shared / "elsewhere").rename(shared / "robot2.status")
                time.sleep(0.3)
        end = supervisor.wait(600.0)
        Done(end.code, "", end.stderr, shared).stopped(3, said)


@situation
def a_lock_that_cannot_be_tried(lab: Lab) -> None:
    """Nothing is known of the robot then, so it is not taken for dead; that it does not answer, shows."""
    rule = "flock@robot1.status:1-:37"
    with cell(lab, 2, failing=rule, reply_timeout_s=5.0) as (supervisor, shared, (first, _)):
        first.close()
        assert supervisor.step(3.0).stopped is None and supervisor.step(6.0).stopped is None
        stopped(
            supervisor,
            shared,
            3,
            "robot1 has not answered command.robcad for 5 s; it has not announced itself",
        )


@situation
def a_robot_that_is_too_slow(lab: Lab) -> None:
    """A second command does not give it more time for the first."""
    with cell(lab, 17, reply_timeout_s=1001.0) as (supervisor, shared, (first, _)):
        first.clear("command")
        result = supervisor.step(1000.0)
        assert (result.fired, result.due) == (1, 1001.0) and first.read("command") is not None
        assert supervisor.step(1001.5).stopped is None
        stopped(supervisor, shared, 3, "robot1 has not answered command.robcad for 1001 s")


@situation
def silence(lab: Lab) -> None:
    """In real time."""
    done = lab.run("odd.deployed", "--reply-timeout", "0.02", order=2)
    done.stopped(
        3, "robot1 has not answered command.robcad for 0.02 s; it has not announced itself at all"
    )
    assert (done.shared / "command.robcad").read_text().startswith("1\n"), (
        "the command is there for who looks into it"
    )


@situation
def a_clock_that_jumps(lab: Lab) -> None:
    """Forwards it is late; a clock that goes back, or cannot be read, stands still."""
    rules = "clock_gettime:9-:+3600"
    lab.run("odd.deployed", "--reply-timeout", "60", order=2, failing=rules).stopped(
        3, "has not answered"
    )
    for number in range(6, 16):  # a second at any moment of the cycle, in which a time stamp comes
        lab.run(
            "odd.deployed", "--time-scale", "2000", order=15, failing=f"clock_gettime:{number}-:+1"
        ).finished()
    for rule in (
        "clock_gettime:9-:-20",
        "clock_gettime:9-:5",
    ):  # few seconds: a machine has just started
        rules = f"{rule},ppoll:5:!15"
        done = lab.run("odd.deployed", "--reply-timeout", "60", order=2, failing=rules)
        done.stopped(130, "interrupted by signal 15")
