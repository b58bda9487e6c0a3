"""The generated supervisor of the riveting cell against robots that obey at once. I1..I10: docs/protocol.md."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from helpers.rivet_rows import printed, rows
from pn2code.channels import (
    ChannelSpec,
    Message,
    PeerState,
    SharedDirectory,
    Status,
    Written,
    specs_of,
)
from pn2code.diagnostics import Diagnostics, render
from pn2code.pipeline import Generated
from pn2code.run.supervisor import SupervisorProcess
from pn2code.toolchain import build

pytestmark = pytest.mark.cc

FIRST = (5750.0, 5898.8, 2135.05, -105.0, 0.0, 0.0)
LAST = (6750.0, 5898.8, 2135.05, -105.0, 0.0, 0.0)
ROBOTS = ("robot1", "robot2")
MOMENTS = (0, 1, 2, 3, 8, 15, 30, 45, 60, 75)
"""Commands that the robots have obeyed when somebody is killed; there are 76 in a run."""
DEADLINE_S = 600.0  # ends what hangs

pytest.importorskip("jinja2")


@pytest.fixture(scope="module")
def specs(of_example: Callable[[str], Generated]) -> tuple[ChannelSpec, ...]:
    return specs_of(of_example("riveting").partition)


@pytest.fixture(scope="module")
def built(riveting_program: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Also with sanitizers."""
    folder = tmp_path_factory.mktemp("riveting") / "cell"
    shutil.copytree(riveting_program, folder)
    sanitizers = "-fsanitize=address,undefined -fno-sanitize-recover=all"
    assert re.search(
        rf"^SANITIZE \?= .*{sanitizers}", (folder / "Makefile").read_text(), re.MULTILINE
    )
    # As it is, but not optimized: that would take five times as long.
    d = Diagnostics()
    with pytest.MonkeyPatch.context() as changed:
        changed.setenv("SANITIZE", f"-g1 -O0 {sanitizers}")
        made = build.build(folder, (), d, target="supervisor.sanitize")
    assert made is not None, render.report(d)
    return folder


@pytest.fixture
def shared(tmp_path: Path) -> Path:
    folder = tmp_path / "shared"
    folder.mkdir()
    return folder


class Robot:
    """Does at once whatever it is told; remembers the poses."""

    def __init__(self, shared: SharedDirectory, number: str) -> None:
        self.shared = shared
        self.number = number
        self.rows: list[tuple[float, ...]] = []
        self.obeyed = 0

    def turn(self) -> bool:
        command = self.shared.read(f"flag{self.number}_interno")
        if not isinstance(command, Message):
            assert command is None, command
            return False
        pose = self.shared.read(f"dadosrobo{self.number}")
        assert not hasattr(pose, "reason"), pose
        if isinstance(pose, Message):
            self.rows.append(tuple(float(v) for v in pose.scalars))
            self.shared.clear(f"dadosrobo{self.number}")
        reference = self.shared.read(f"referencia{self.number}") if self.number == "1" else None
        self.shared.clear(f"flag{self.number}_interno")
        if isinstance(reference, Message):
            self.shared.clear(f"referencia{self.number}")
            assert isinstance(self.shared.write(f"medida{self.number}", reference.scalars), Written)
        assert isinstance(self.shared.write(f"flag{self.number}_externo", (1,)), Written)
        self.obeyed += 1
        return True


@pytest.fixture
def robots(shared: Path, specs: tuple[ChannelSpec, ...]) -> Iterator[list[Robot]]:
    sides = [SharedDirectory(shared, name, specs) for name in ROBOTS]
    yield [Robot(side, side.side.removeprefix("robot")) for side in sides]
    for side in sides:
        side.close()


def join(robots: list[Robot]) -> None:
    for robot in robots:
        assert robot.shared.await_supervisor(DEADLINE_S)


def obey(robots: list[Robot], commands: int) -> None:
    """Lets the robots obey this many commands in all."""
    end = time.monotonic() + DEADLINE_S
    while sum(r.obeyed for r in robots) < commands:
        for robot in robots:
            if sum(r.obeyed for r in robots) < commands:
                robot.turn()
        assert time.monotonic() < end


def expected() -> tuple[list[str], list[str]]:
    first, second = rows(5, FIRST, LAST)
    return [printed(row) for row in first], [printed(row) for row in second]


def test_dry_run_plays_the_whole_cell(built: Path, root: Path) -> None:
    command = [built / "supervisor.sanitize", "--dry-run", "--input", root / "examples/riveting"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("-> robot1  dadosrobo1.robcad") == 22
    assert done.stdout.count("-> robot2  dadosrobo2.robcad") == 22


def test_a_run_in_lockstep_sends_the_rows(
    built: Path, root: Path, shared: Path, robots: list[Robot]
) -> None:
    with SupervisorProcess(
        built / "supervisor.sanitize", shared, root / "examples/riveting", lockstep=True
    ) as supervisor:
        join(robots)
        t = 0.0
        result = supervisor.step(t)
        while not result.finished:
            assert result.stopped is None
            moved = [robot.turn() for robot in robots]
            assert any(moved) or result.fired
            t += 1.0
            result = supervisor.step(t)
        assert supervisor.wait(DEADLINE_S).code == 0
    assert tuple([printed(row) for row in r.rows] for r in robots) == expected()


def test_i5_flags_are_read_before_data(
    built: Path, root: Path, shared: Path, robots: list[Robot]
) -> None:
    """What is published before a flag is there once the flag has been seen; the other way round it may not be."""
    with SupervisorProcess(
        built / "supervisor.sanitize",
        shared,
        root / "examples/riveting",
        lockstep=True,
        verbosity=2,
    ) as supervisor:
        join(robots)
        t = 0.0
        while sum(robot.obeyed for robot in robots) < 4:
            supervisor.step(t)
            for robot in robots:
                robot.turn()
            t += 1.0
        supervisor.step(t)
        supervisor.stop("enough")
        said = supervisor.close().stderr
    received: dict[str, list[str]] = {}
    for when, name in re.findall(r"([0-9.]+) s  (flag1_externo|medida1)\.robcad: ", said):
        received.setdefault(when, []).append(name)
    together = [names for names in received.values() if "medida1" in names]
    assert together and all(names == ["flag1_externo", "medida1"] for names in together), said


@pytest.fixture(scope="module")
def no_heap(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What stops a program that asks for memory, where it is preloaded; in a program that does, it works."""
    if os.environ.get("PN2CODE_COUNTING"):
        pytest.skip("what counts branches takes memory")
    library = tmp_path_factory.mktemp("no_heap") / "no_heap.so"
    source = root / "cnative" / "tests" / "no_heap.c"
    command = ["gcc", "-shared", "-fPIC", "-fno-builtin", "-Wall", "-Werror", source, "-o", library]
    subprocess.run(command, check=True)
    done = subprocess.run(
        ["ls"], env={"LD_PRELOAD": str(library)}, capture_output=True, text=True, check=False
    )
    if done.returncode != 99 or "is called" not in done.stderr:
        pytest.skip("this system does not preload libraries")
    return library


def test_a_run_in_real_time_sends_the_rows_and_takes_no_heap(
    built: Path,
    root: Path,
    shared: Path,
    robots: list[Robot],
    no_heap: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with monkeypatch.context() as preloaded:
        preloaded.setenv("LD_PRELOAD", str(no_heap))
        supervisor = SupervisorProcess(built / "supervisor", shared, root / "examples/riveting")
    with supervisor:
        join(robots)
        end = threading.Event()

        def play(robot: Robot) -> None:
            while not end.is_set():
                if not robot.turn():
                    time.sleep(0.001)

        threads = [threading.Thread(target=play, args=(robot,)) for robot in robots]
        for thread in threads:
            thread.start()
        try:
            exit_ = supervisor.wait(DEADLINE_S)
        finally:
            end.set()
            for thread in threads:
                thread.join()
        assert exit_.code == 0, exit_.stderr
    assert tuple([printed(row) for row in r.rows] for r in robots) == expected()


@pytest.mark.parametrize("moment", MOMENTS)
def test_i8_supervisor_killed_at_ten_moments(
    built: Path, root: Path, shared: Path, robots: list[Robot], moment: int
) -> None:
    with SupervisorProcess(built / "supervisor", shared, root / "examples/riveting") as supervisor:
        join(robots)
        obey(robots, moment)
        assert supervisor.kill().meaning == "killed by SIGKILL"
    sent = [len(robot.rows) for robot in robots]
    for robot in robots:
        assert robot.shared.peer().state is PeerState.DEAD
        robot.turn()  # what had been sent may still be done, once ...
        assert not robot.turn()  # ... and no more follows
        assert len(robot.rows) <= sent[0] + 1
        robot.shared.set_status(Status.STOPPED, "the supervisor has died")
        robot.shared.close()
    with SupervisorProcess(
        built / "supervisor", shared, root / "examples/riveting", lockstep=True
    ) as again:
        assert again.step(0.0).stopped is None
        assert all(robot.shared.peer().state is PeerState.REPLACED for robot in robots)


@pytest.mark.parametrize("moment", MOMENTS)
def test_i8_robot_killed_at_ten_moments(
    built: Path, root: Path, shared: Path, robots: list[Robot], moment: int
) -> None:
    with SupervisorProcess(built / "supervisor", shared, root / "examples/riveting") as supervisor:
        join(robots)
        obey(robots, moment)
        victim = robots[moment % 2]
        victim.shared.close()  # the lock goes with the process, the status stays `running`
        exit_ = supervisor.wait(DEADLINE_S)
    assert exit_.code == 3
    assert f"robot{victim.number} (pid " in exit_.stderr
    assert "has died" in exit_.stderr
    other = robots[(moment + 1) % 2]
    assert other.shared.peer().state is PeerState.STOPPED
    assert "has died" in other.shared.peer().reason
