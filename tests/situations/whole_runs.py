"""The riveting cell from its start to its end, with robots that obey at once: in lock-step, woken by files, polling."""

from __future__ import annotations

import time
from pathlib import Path

from helpers.counted import DEADLINE_S, Done, Lab
from helpers.rivet_rows import rows
from pn2code.cell.partition import ChannelKind
from pn2code.cell.scalars import Scalar, ScalarKind
from pn2code.channels import ChannelSpec, Message, SharedDirectory, Status, Written
from situations import situation

POSE = tuple(Scalar(ScalarKind.REAL, label, "REAL") for label in ("x", "y", "z", "rx", "ry", "rz"))
COMMAND = (Scalar(ScalarKind.INT, "COMMAND", "COMMAND", low=1, high=8),)
REPLY = (Scalar(ScalarKind.INT, "REPLY", "REPLY", low=1, high=2),)
DATA, FLAG = ChannelKind.DATA, ChannelKind.FLAG
FIRST = (5750.0, 5898.8, 2135.05, -105.0, 0.0, 0.0)
LAST = (6750.0, 5898.8, 2135.05, -105.0, 0.0, 0.0)


def spec(
    name: str, scalars: tuple[Scalar, ...], writer: str, reader: str, kind: ChannelKind
) -> ChannelSpec:
    return ChannelSpec(name, f"{name}.robcad", scalars, writer, reader, kind)


SPECS = tuple(
    one
    for n in (1, 2)
    for one in (
        spec(f"dadosrobo{n}", POSE, "supervisor", f"robot{n}", DATA),
        *((spec("referencia1", POSE, "supervisor", "robot1", DATA), spec("medida1", POSE, "robot1", "supervisor", DATA))
          if n == 1 else ()),
        spec(f"flag{n}_interno", COMMAND, "supervisor", f"robot{n}", FLAG),
        spec(f"flag{n}_externo", REPLY, f"robot{n}", "supervisor", FLAG),
    )
)  # fmt: skip


class Robot:
    """Does at once what it is told; remembers the poses."""

    def __init__(self, shared: Path, number: int) -> None:
        self.files = SharedDirectory(shared, f"robot{number}", SPECS)
        self.number = number
        self.rows: list[tuple[float, ...]] = []

    def turn(self) -> bool:
        """Obeys one command, if there is one."""
        n = self.number
        if not isinstance(self.files.read(f"flag{n}_interno"), Message):
            return False
        pose = self.files.read(f"dadosrobo{n}")
        if isinstance(pose, Message):
            self.rows.append(tuple(float(v) for v in pose.scalars))
            self.files.clear(f"dadosrobo{n}")
        reference = self.files.read("referencia1") if n == 1 else None
        self.files.clear(f"flag{n}_interno")
        if isinstance(reference, Message):
            self.files.clear("referencia1")
            assert isinstance(self.files.write("medida1", reference.scalars), Written)
        assert isinstance(self.files.write(f"flag{n}_externo", (1,)), Written)
        return True


def assert_rows(robots: list[Robot]) -> None:
    """What they were told is what an independent computation gives."""
    for robot, expected in zip(robots, rows(5, FIRST, LAST), strict=True):
        assert len(robot.rows) == len(expected)
        for got, wanted in zip(robot.rows, expected, strict=True):
            assert all(abs(a - b) < 1e-8 for a, b in zip(got, wanted, strict=True))


@situation
def in_lockstep(lab: Lab) -> None:
    folder = lab.fresh()
    with lab.started("rivet", folder, lockstep=True) as supervisor:
        robots = [Robot(folder / "shared", n) for n in (1, 2)]
        assert all(r.files.await_supervisor(600.0) for r in robots)
        t = 0.0
        while not (result := supervisor.step(t)).finished:
            assert result.stopped is None
            moved = [r.turn() for r in robots]
            assert any(moved) or result.fired
            t += 1.0
        end = supervisor.wait(DEADLINE_S)
    Done(end.code, "", end.stderr, folder / "shared").finished()
    assert_rows(robots)
    for robot in robots:
        robot.files.close()


@situation
def in_real_time(lab: Lab) -> None:
    for poll_ms in (None, 0.2):
        folder = lab.fresh()
        with lab.started("rivet", folder, poll_ms=poll_ms) as supervisor:
            robots = [Robot(folder / "shared", n) for n in (1, 2)]
            assert all(r.files.await_supervisor(600.0) for r in robots)
            limit = time.monotonic() + DEADLINE_S
            while supervisor.running:
                moved = [r.turn() for r in robots]
                if not any(moved):
                    time.sleep(0.0002)
                assert time.monotonic() < limit
            end = supervisor.wait(DEADLINE_S)
        Done(end.code, "", end.stderr, folder / "shared").finished()
        assert_rows(robots)
        for robot in robots:
            robot.files.set_status(Status.FINISHED)
            robot.files.close()
