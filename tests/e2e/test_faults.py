"""What happens to the riveting cell when a side dies, or its files go wrong. I1..I10: docs/protocol.md.

The supervisor is the compiled one, in real time; each robot is a process that interprets its generated script, with
an arm that does everything at once. Who kills whom, and when, is decided by the robots: at their nth event (a net
transition has occurred, a message was read, consumed or written), so that each run dies at the same moment.
"""

from __future__ import annotations

import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from helpers.processes import Child, Command, obey_modes, pn2code
from helpers.thorough import amount
from pn2code.channels import ChannelSpec, Refused, SharedDirectory
from pn2code.channels.message import parse as parse_message
from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.run.progress import Progress
from pn2code.run.robot import RobotExit, RobotPlayer, script_specs
from pn2code.run.supervisor import Exit, SupervisorProcess
from pn2code.tdl.check import CheckedProgram, check
from pn2code.tdl.parse import parse
from pn2code.tdl.requests import Event

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build", "generated_once")]

ROBOTS = ("robot1", "robot2")
MOMENTS = (1, 2, 3, 4, 5, 18, 40, 75, 110, 150)
"""Events of a robot: from its first message on, every step of its first command, and later ones. A run has some 180."""
DEADLINE_S = 600.0  # ends what hangs


RIVETING = Path(__file__).parents[2] / "examples" / "riveting"
DONE = 1


def ignore(_number: int, _event: Event) -> None:
    return None


def all_well(_sensor: str) -> int:
    """What the cell's sensors say where no file says anything else: each tool has done its work."""
    return DONE


@dataclass(frozen=True)
class Cell:
    """The programs of the cell and one shared directory."""

    program: Path
    inputs: Path
    shared: Path
    scripts: dict[str, CheckedProgram]

    def supervisor(self, **options: object) -> SupervisorProcess:
        return SupervisorProcess(
            self.program / "supervisor.traced", self.shared, self.inputs, **options
        )  # type: ignore[arg-type]

    def specs(self, name: str) -> tuple[ChannelSpec, ...]:
        return script_specs(self.scripts[name], name)

    def robot(
        self,
        name: str,
        on_event: Callable[[int, Event], None] = ignore,
        kind: type = SharedDirectory,
    ) -> Child:
        """Starts a robot; `on_event` gets the number of each event, from 1, in the robot's process."""

        def body() -> int:
            heard = 0

            def hear(event: Event) -> None:
                nonlocal heard
                heard += 1
                on_event(heard, event)

            with kind(self.shared, name, self.specs(name)) as side:
                ended = RobotPlayer(
                    self.scripts[name], side, f"{name}.tdl", on_event=hear, sense=all_well
                ).run()
            print(f"{name}: {ended.reason}", file=sys.stderr)
            return int(ended.code)

        return Child(body)

    def both(
        self,
        children: list[Child],
        on_event: Callable[[int, Event], None],
        actor: str = "robot1",
        kind: type = SharedDirectory,
    ) -> None:
        """Starts both robots, first the one that only obeys; the one that acts on its events is the first child."""
        other = ROBOTS[1 - ROBOTS.index(actor)]
        children.append(self.robot(other))
        file = self.shared / f"{other}.status"
        until(lambda: file.exists() and file.read_text().startswith("running"), "the other robot")
        children.insert(0, self.robot(actor, on_event, kind))

    def status(self, side: str) -> tuple[str, str]:
        """State and reason."""
        lines = (self.shared / f"{side}.status").read_text().splitlines()
        return lines[0], lines[2] if len(lines) > 2 else ""

    def holds(self, channel: str) -> bool:
        """Whether a channel has a message of ours."""
        file = self.shared / f"{channel}.robcad"
        return file.exists() and "#" in file.read_text()

    def session(self) -> str:
        return (self.shared / "supervisor.status").read_text().split()[1]

    def leftovers(self, *sides: str) -> list[str]:
        """Temporary files of these sides."""
        return sorted(
            p.name
            for p in self.shared.iterdir()
            if p.name.endswith(tuple(f".{s}.tmp" for s in sides))
        )

    def assert_no_half_messages(self) -> None:
        """Each channel is empty or holds a message that is whole, of this session."""
        for name in ROBOTS:
            for spec in self.specs(name):
                text = (self.shared / spec.file).read_text()
                seq = int(text.split("# ")[1].split()[0]) if "# " in text else 1
                found = parse_message(spec, text, session=self.session(), consumed=seq - 1)
                assert not isinstance(found, Refused), found


@pytest.fixture(scope="module")
def scripts(riveting_program: Path) -> dict[str, CheckedProgram]:
    found = {}
    for name in ROBOTS:
        d = Diagnostics()
        text = (riveting_program / f"{name}.tdl").read_text(encoding="utf-8")
        tree = parse(SourceText(text, Origin(f"{name}.tdl", 1, 1)), d)
        assert tree is not None
        program = check(tree, d)
        assert program is not None
        found[name] = program
    return found


@pytest.fixture
def cell(
    root: Path, riveting_program: Path, scripts: dict[str, CheckedProgram], tmp_path: Path
) -> Cell:
    shared = tmp_path / "shared"
    shared.mkdir()
    return Cell(riveting_program, root / "examples" / "riveting", shared, scripts)


@pytest.fixture
def children() -> Iterator[list[Child]]:
    """Robots of a test; none outlives it."""
    started: list[Child] = []
    yield started
    for child in started:
        child.kill()


def until(condition: Callable[[], object], what: str) -> None:
    end = time.monotonic() + DEADLINE_S
    while not condition():
        assert time.monotonic() < end, f"in vain: {what}"
        time.sleep(0.002)


def ended(supervisor: SupervisorProcess, code: int, *words: str) -> Exit:
    exit_ = supervisor.wait(DEADLINE_S)
    assert exit_.code == code, exit_.stderr
    for word in words:
        assert word in exit_.stderr
    return exit_


def test_the_cell_runs_as_three_processes(cell: Cell, children: list[Child]) -> None:
    """Also the proof that a run has as many moments as the tests below want."""
    counts = cell.shared.parent / "events"

    def count(number: int, _event: Event) -> None:
        counts.write_text(str(number))

    with cell.supervisor() as supervisor:
        cell.both(children, count)
        assert [child.wait() for child in children] == [0, 0]
        ended(supervisor, 0)
    assert {cell.status(side)[0] for side in ("supervisor", *ROBOTS)} == {"finished"}
    assert cell.leftovers("supervisor", *ROBOTS) == []
    assert int(counts.read_text()) > MOMENTS[-1]


# --- somebody is killed (I8) ---


@pytest.mark.parametrize("moment", MOMENTS[:: amount(3, 1)])
def test_i8_supervisor_killed(cell: Cell, children: list[Child], moment: int) -> None:
    with cell.supervisor() as supervisor:
        pid = supervisor.pid

        def kill(number: int, _event: Event) -> None:
            if number == moment:
                os.kill(pid, signal.SIGKILL)

        cell.both(children, kill)
        assert [child.wait() for child in children] == [RobotExit.SUPERVISOR] * 2
        assert supervisor.wait(DEADLINE_S).meaning == "killed by SIGKILL"
    for name in ROBOTS:
        state, reason = cell.status(name)
        assert state == "stopped"
        assert (
            reason
            == f"the supervisor (pid {pid}) has died: nobody holds the lock of its status file"
        )
    assert cell.leftovers(*ROBOTS) == []
    cell.assert_no_half_messages()


@pytest.mark.parametrize("moment", MOMENTS[:: amount(3, 1)])
def test_i8_robot_killed(cell: Cell, children: list[Child], moment: int) -> None:
    victim, other = ROBOTS if moment % 2 else ROBOTS[::-1]

    def die(number: int, _event: Event) -> None:
        if number == moment:
            os.kill(os.getpid(), signal.SIGKILL)

    with cell.supervisor() as supervisor:
        cell.both(children, die, victim)
        assert children[0].wait() == -signal.SIGKILL
        words = f"{victim} (pid {children[0].pid}) has died"
        ended(supervisor, 3, f"error: {words}")
        assert children[1].wait() == RobotExit.SUPERVISOR
    assert cell.status("supervisor") == ("stopped", words)
    state, reason = cell.status(other)
    assert state == "stopped"
    assert reason.endswith(f"has stopped: {words}")
    assert cell.leftovers("supervisor", *ROBOTS) == []
    cell.assert_no_half_messages()


class DiesWhilePublishing(SharedDirectory):
    """Dies when its ninth message is written beside its place, before it is moved there (I2)."""

    publications = 0

    def _publish(self, file: str, text: str) -> None:
        self.publications += 1
        if self.publications == 9:
            (self.path / f".{file}.{self.side}.tmp").write_text(text[:3])
            os.kill(os.getpid(), signal.SIGKILL)
        super()._publish(file, text)


def test_i2_i7_robot_killed_while_publishing_then_a_clean_start(
    cell: Cell, children: list[Child]
) -> None:
    with cell.supervisor() as supervisor:
        cell.both(children, ignore, kind=DiesWhilePublishing)
        ended(supervisor, 3, "robot1 (pid", "has died")
        assert children[1].wait() == RobotExit.SUPERVISOR
    assert len(cell.leftovers("robot1")) == 1
    cell.assert_no_half_messages()
    with cell.supervisor() as again:
        children += [cell.robot(name) for name in ROBOTS]
        assert [child.wait() for child in children[2:]] == [0, 0]
        ended(again, 0)
    assert cell.leftovers("supervisor", *ROBOTS) == []


def test_i7_after_a_killed_supervisor_the_next_run_is_clean(
    cell: Cell, children: list[Child]
) -> None:
    """What the dead one had sent is reported and discarded; robots of its session stop at once."""
    with cell.supervisor() as supervisor:
        until(lambda: cell.holds("flag1_interno"), "a command")
        supervisor.kill()
    with cell.supervisor() as again:
        children += [cell.robot(name) for name in ROBOTS]
        assert [child.wait() for child in children] == [0, 0]
        exit_ = ended(again, 0)
    assert "warning: flag1_interno.robcad held " in exit_.stderr
    assert "left by an earlier run: discarded" in exit_.stderr


# --- somebody is asked to stop (I9, I10) ---


def test_i10_a_signal_to_the_supervisor_stops_the_cell(cell: Cell, children: list[Child]) -> None:
    with cell.supervisor() as supervisor:

        def ask(number: int, _event: Event) -> None:
            if number == 30:
                os.kill(supervisor.pid, signal.SIGTERM)

        cell.both(children, ask)
        ended(supervisor, 130, "error: interrupted by signal 15")
        assert [child.wait() for child in children] == [RobotExit.SUPERVISOR] * 2
    for name in ROBOTS:
        assert cell.status(name)[1].endswith("has stopped: interrupted by signal 15")
    assert cell.leftovers("supervisor", *ROBOTS) == []


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT][: amount(1, 2)])
def test_i10_a_signal_to_a_robot_stops_the_cell(
    cell: Cell, children: list[Child], number: int
) -> None:
    with cell.supervisor() as supervisor:
        until(lambda: cell.holds("flag1_interno"), "the first command")
        command = Command(
            "robot", cell.program / "robot1.tdl", "--dir", cell.shared, "--cell", cell.inputs, "--speed", "1000"
        )  # fmt: skip
        children.append(command)
        until(lambda: not cell.holds("dadosrobo1"), "robot 1 has moved and waits for robot 2")
        command.signal(number)
        done = command.done()
        assert done.returncode == 130
        assert done.stderr == "pn2code: robot1 stopped: interrupted\n"
        ended(supervisor, 3, "error: robot1 stopped: interrupted")
    assert cell.status("robot1") == ("stopped", "interrupted")
    assert cell.status("supervisor") == ("stopped", "robot1 stopped: interrupted")


def test_i10_a_moving_robot_comes_to_rest_on_its_path(cell: Cell, children: list[Child]) -> None:
    """With the cell's kinematics, a hundred times as slow, a move takes minutes; the supervisor dies meanwhile."""
    with cell.supervisor() as supervisor:
        until(lambda: cell.holds("flag1_interno"), "the first command")
        command = Command(
            "robot", cell.program / "robot1.tdl", "--dir", cell.shared, "--cell", cell.inputs, "-v", "--speed", "0.01"
        )  # fmt: skip
        children.append(command)
        until(
            lambda: not cell.holds("flag1_interno"),
            "the beginning of a move",
        )
        supervisor.kill()
        done = command.done()
    assert done.returncode == RobotExit.SUPERVISOR
    assert "has died" in done.stderr
    assert "; `ptp` was broken off after " in done.stderr
    assert "at TCP pose (" in done.stderr
    assert (cell.shared / "dadosrobo1.robcad").read_text() != "0\n", (
        "a message is consumed when its move is done"
    )
    state, reason = cell.status("robot1")
    assert state == "stopped"
    assert "was broken off after" in reason


# --- files torn, stale, or with garbage in them (I6) ---

CHECKED = "5750.0000 5802.2072 2160.9319 -105.0000 0.0000 0.0000\n# 1 {session} 00000000\n"
GARBAGE: dict[str, tuple[str, str]] = {
    "binary": ("\x7fELF\x01\x02\xff\xfe\x01", "is not a number"),
    "words": ("go to the panel\n", "`go` is not a number"),
    "wrong count": ("5750 5802 2160 -105 0\n", "found 5 values where 6 are expected"),
    "NaN": ("5750 5802 nan -105 0 0\n", "`nan` is not a number"),
    "too large": ("5750 5802 1e400 -105 0 0\n", "`1e400` is too large"),
    "bad checksum": (CHECKED, "torn or altered"),
    "torn in line 2": (CHECKED[:60], "where `# seq session checksum` is expected"),
    "empty": ("", "empty line"),
}


def spoil(path: Path, text: str | None) -> None:
    """In place, as a program would that knows nothing of the protocol; None: the file is missing."""
    if text is None:
        path.unlink()
    else:
        path.write_bytes(text.encode("latin-1"))


@pytest.mark.parametrize(
    ("text", "words"), [*GARBAGE.values(), (None, "the file is missing")], ids=[*GARBAGE, "missing"]
)
def test_i6_a_robot_refuses_what_it_cannot_validate(
    cell: Cell, children: list[Child], text: str | None, words: str
) -> None:
    with cell.supervisor() as supervisor:
        until(lambda: cell.holds("flag2_interno"), "the first commands")
        file = cell.shared / "dadosrobo1.robcad"
        spoil(file, None if text is None else text.replace("{session}", cell.session()))
        children += [cell.robot(name) for name in ROBOTS]
        assert [child.wait() for child in children] == [RobotExit.CHANNEL, RobotExit.SUPERVISOR]
        ended(
            supervisor,
            3,
            "error: robot1 stopped: robot1.tdl:",
            "dadosrobo1.robcad: message refused: ",
            words,
        )
    assert words in cell.status("robot1")[1]
    assert cell.leftovers("supervisor", *ROBOTS) == []


@pytest.mark.parametrize(
    ("text", "words"),
    [("1 1\n", "found `1` after the 1 value"), ("3\n", "3 is outside colour set `REPLY`, which"),
     ("1\n# 1 0badcafe 2f02fbb9\n", "0badcafe"), ("\0\0\0\0", "zero byte"), (None, "the file is missing")],
    ids=["two values", "no reply", "foreign", "zeros", "missing"],
)  # fmt: skip
def test_i6_the_supervisor_refuses_what_it_cannot_validate(
    cell: Cell, children: list[Child], text: str | None, words: str
) -> None:
    with cell.supervisor() as supervisor:
        children.append(cell.robot("robot2"))
        until(lambda: cell.holds("flag1_interno"), "the first command")
        spoil(cell.shared / "flag1_externo.robcad", text)
        ended(supervisor, 4, "error: flag1_externo.robcad: message of robot1 refused: ", words)
        assert children[0].wait() == RobotExit.SUPERVISOR
    assert words in cell.status("supervisor")[1]
    assert words in cell.status("robot2")[1]


@pytest.mark.parametrize("cut", [7, 30, -12], ids=["a number", "some numbers", "line 2"])
def test_i6_a_file_that_grows_slowly_is_taken_when_it_is_whole(
    cell: Cell, children: list[Child], cut: int
) -> None:
    """Somebody else writes the message in place, in two parts, and the robot looks in between.

    Cut within line 1, a message of six numbers has fewer; cut within line 2, it has a seal that does not fit.
    """
    with cell.supervisor() as supervisor:
        until(lambda: cell.holds("flag2_interno"), "the first commands")
        file = cell.shared / "dadosrobo1.robcad"
        message = file.read_text()
        file.write_text(message[:cut])
        children.append(cell.robot("robot1"))
        until(lambda: not cell.holds("flag1_interno"), "robot 1 looks at the pose")
        with file.open("a") as stream:
            stream.write(message[cut:])
        children.append(cell.robot("robot2"))
        assert [child.wait() for child in children] == [0, 0]
        ended(supervisor, 0)


def test_a_folder_in_place_of_a_file(cell: Cell, children: list[Child]) -> None:
    with cell.supervisor() as supervisor:
        until(lambda: cell.holds("flag2_interno"), "the first commands")
        file = cell.shared / "dadosrobo1.robcad"
        file.unlink()
        file.mkdir()
        children += [cell.robot(name) for name in ROBOTS]
        assert [child.wait() for child in children] == [RobotExit.SYSTEM, RobotExit.SUPERVISOR]
        words = "it is a link, a pipe, a folder or the like, not a file"
        ended(supervisor, 3, f"the shared directory fails at `{file}`: {words}")


# --- the shared directory: removed, full, missing, read-only ---


@pytest.mark.parametrize("moment", [2, 33])
def test_directory_removed_in_the_middle(cell: Cell, children: list[Child], moment: int) -> None:
    def remove(number: int, _event: Event) -> None:
        if number == moment:
            cell.shared.rename(cell.shared.with_name("gone"))  # at once, unlike rmtree
            while cell.shared.with_name(
                "gone"
            ).exists():  # the supervisor may still be making files
                shutil.rmtree(cell.shared.with_name("gone"), ignore_errors=True)

    with cell.supervisor() as supervisor:
        cell.both(children, remove)
        assert [child.wait() for child in children] == [RobotExit.SYSTEM] * 2
        exit_ = supervisor.wait(DEADLINE_S)
    # Whoever comes there first finds it missing; a robot that was first says so on its free lock, which is still open.
    own = (5, f"error: the shared directory {cell.shared} has been removed")
    told = (3, f"the shared directory `{cell.shared}` is gone")
    assert any(exit_.code == code and words in exit_.stderr for code, words in (own, told)), exit_
    assert not cell.shared.exists(), "nobody makes it anew"


def full() -> tuple[int, tuple[int, int]]:
    """No file can grow: what a full disk is to a process."""
    return resource.RLIMIT_FSIZE, (0, resource.getrlimit(resource.RLIMIT_FSIZE)[1])


def test_full_for_the_robot(cell: Cell, children: list[Child]) -> None:
    """It cannot even say so in its status: the free lock says it."""

    def fill(number: int, _event: Event) -> None:
        if number == 20:
            resource.setrlimit(*full())

    with cell.supervisor() as supervisor:
        cell.both(children, fill)
        assert children[0].wait() == RobotExit.SYSTEM
        ended(supervisor, 3, "error: robot1 ")
        assert children[1].wait() == RobotExit.SUPERVISOR
    assert cell.leftovers("supervisor", *ROBOTS) == []
    cell.assert_no_half_messages()


def test_full_for_the_supervisor(cell: Cell, children: list[Child]) -> None:
    with cell.supervisor() as supervisor:

        def fill(number: int, _event: Event) -> None:
            if number == 20:
                resource.prlimit(supervisor.pid, *full())

        cell.both(children, fill)
        ended(supervisor, 5, "error: cannot write ", "File too large; make room there")
        assert [child.wait() for child in children] == [RobotExit.SUPERVISOR] * 2
    assert cell.leftovers("supervisor", *ROBOTS) == []


def robot_fails(
    cell: Cell, directory: Path, code: int, *words: str, prepare: Callable[[], None] = lambda: None
) -> None:
    done = pn2code(
        "robot", cell.program / "robot1.tdl", "--dir", directory, "--cell", RIVETING, "--wait", "0.05",
        prepare=prepare,
    )  # fmt: skip
    assert done.returncode == code, done.stderr
    assert done.stderr.startswith("pn2code: robot1 stopped: ")
    for word in words:
        assert word in done.stderr


def test_directory_missing_or_below_a_file(cell: Cell) -> None:
    file = cell.shared / "file"
    file.write_text("mine")
    for directory, system in (
        (cell.shared / "none" / "x", "cannot be made"),
        (file, "Not a directory"),
        (file / "x", "Not a directory"),
    ):
        with SupervisorProcess(cell.program / "supervisor", directory, cell.inputs) as supervisor:
            ended(supervisor, 5, "error: ", str(directory), system)
        robot_fails(
            cell,
            directory,
            2,
            f"`{directory}`",
            "is not a directory" if directory == file else "does not exist",
        )
    assert [p.name for p in cell.shared.iterdir()] == ["file"]
    assert file.read_text() == "mine"


def test_no_supervisor_and_two_robots_of_one_name(cell: Cell, children: list[Child]) -> None:
    robot_fails(
        cell, cell.shared, 3, f"no supervisor has announced itself in `{cell.shared}` within 0.05 s"
    )
    assert list(cell.shared.iterdir()) == [], "I7: a robot touches nothing before"
    with cell.supervisor() as supervisor:
        until(lambda: cell.holds("flag1_interno"), "the first command")
        children.append(cell.robot("robot1"))
        until(lambda: not cell.holds("dadosrobo1"), "robot 1 has moved and waits for robot 2")
        robot_fails(cell, cell.shared, 2, "another process is `robot1`")
        assert children[0].poll() is None
        assert supervisor.running


def test_read_only_directory(cell: Cell) -> None:
    """As an ordinary user: for root nothing is read-only."""
    nobody = 65534
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        folder.chmod(0o755)
        for file in ("supervisor", "robot1.tdl"):
            shutil.copy(cell.program / file, folder)
        shutil.copy(cell.inputs / "coordenadas.robcad", folder)
        shared = folder / "shared"
        shared.mkdir()
        (shared / "supervisor.status").write_text("running\n0123abcd 1\n\n")
        shared.chmod(0o555)

        def become_user() -> None:
            if os.getuid() == 0:
                os.setgid(nobody)
                os.setuid(nobody)

        def supervise() -> int:
            become_user()
            os.execv(
                folder / "supervisor", ["supervisor", "--dir", str(shared), "--input", str(folder)]
            )

        with (folder / "said").open("w+") as said:
            assert Child(supervise, stderr=said.fileno()).wait() == 5
            said.seek(0)
            text = said.read()
        assert "error: cannot " in text
        assert "Permission denied; choose a directory that can be written with --dir" in text
        local = Cell(folder, folder, shared, cell.scripts)
        # Somebody holds the supervisor's lock and says `running`: a robot would join, if it could write.
        with SharedDirectory(shared, "supervisor", ()) as other:
            shared.chmod(0o755)
            other.announce()
            shared.chmod(0o555)
            robot_fails(
                local,
                shared,
                2,
                "the shared directory fails",
                "ermission denied",
                prepare=obey_modes,
            )
        assert [p.name for p in shared.iterdir()] == ["supervisor.status"]
        shared.chmod(0o755)


# --- `pn2code run`: the supervisor dies, the run dies, the user interrupts ---


def run_command(
    cell: Cell, out: Path, hook: Callable[[int, Progress, object], None], *options: str
) -> Command:
    """Starts `pn2code run`; the hook hears of each step in that process (step 0: the run has begun)."""
    shutil.copytree(cell.program, out / "program")  # built: make has nothing to do

    def prepare() -> None:
        steps = 0

        def begun(self: Progress, engine: object) -> None:
            hook(0, self, engine)

        def advanced(self: Progress, engine: object) -> None:
            nonlocal steps
            steps += 1
            hook(steps, self, engine)

        Progress.begun = begun  # type: ignore[method-assign,assignment]
        Progress.advanced = advanced  # type: ignore[method-assign,assignment]

    return Command(
        "run", cell.inputs, "--out", out, "--backend", "fake", "--no-pictures", *options, prepare=prepare
    )  # fmt: skip


def assert_results(out: Path, verdict: str) -> dict[str, object]:
    """All results are there and whole."""
    assert [p.name for p in out.iterdir() if p.name.startswith(".")] == []
    for line in (out / "cell.trace.jsonl").read_text().splitlines():
        json.loads(line)
    assert (out / "rows.tsv").exists()
    summary: dict[str, object] = json.loads((out / "summary.json").read_text())
    assert summary["verdict"] == verdict
    return summary


@pytest.mark.parametrize("step", [12, 0, 1][: amount(1, 3)])
def test_run_supervisor_killed(
    cell: Cell, children: list[Child], tmp_path: Path, step: int
) -> None:
    def kill(number: int, _progress: Progress, engine: object) -> None:
        if number == step:
            os.kill(engine.supervisor.pid, signal.SIGKILL)  # type: ignore[attr-defined]

    command = run_command(cell, tmp_path / "out", kill)
    children.append(command)
    done = command.done()
    assert done.returncode == 1, done.stderr
    assert "killed by SIGKILL" in done.stdout
    summary = assert_results(tmp_path / "out", "failed")
    assert "the supervisor has ended: killed by SIGKILL" in str(summary["reason"])


def test_run_results_that_cannot_be_written(
    cell: Cell, children: list[Child], tmp_path: Path
) -> None:
    def kill(_number: int, _progress: Progress, engine: object) -> None:
        os.kill(engine.supervisor.pid, signal.SIGKILL)  # type: ignore[attr-defined]

    out = tmp_path / "out"
    (out / "cell.trace.jsonl").mkdir(parents=True)
    command = run_command(cell, out, kill)
    children.append(command)
    done = command.done()
    assert done.returncode == 2, done.stderr
    assert done.stderr.endswith(f"pn2code: cannot write the results in `{out}`: is a directory\n")
    assert sorted(p.name for p in out.iterdir()) == [
        "cell.trace.jsonl",
        "program",
        "supervisor.trace.jsonl",
    ]


def test_run_garbage_in_a_file(cell: Cell, children: list[Child], tmp_path: Path) -> None:
    """In lock-step nobody else can still be writing: the fault is at once."""

    def spoil_it(number: int, _progress: Progress, engine: object) -> None:
        if number == 3:
            shared = engine.robots[0].files.shared.path  # type: ignore[attr-defined]
            (shared / "flag1_externo.robcad").write_text("done\n")

    command = run_command(cell, tmp_path / "out", spoil_it)
    children.append(command)
    done = command.done()
    assert done.returncode == 1, done.stderr
    summary = assert_results(tmp_path / "out", "failed")
    assert "flag1_externo.robcad: " in str(summary["reason"])
    assert "`done`" in str(summary["reason"])


@dataclass(frozen=True)
class Seen:
    """What a run told of itself: the supervisor's pid, the shared directory."""

    pid: int
    shared: Path


def halted_run(
    cell: Cell, children: list[Child], tmp_path: Path, *options: str
) -> tuple[Command, Seen]:
    """A run that stands still at its third step."""
    told = tmp_path / "told"

    def halt(number: int, _progress: Progress, engine: object) -> None:
        if number == 3:
            pid, shared = engine.supervisor.pid, engine.robots[0].files.shared.path  # type: ignore[attr-defined]
            told.with_name("telling").write_text(f"{pid} {shared}")
            told.with_name("telling").rename(told)
            end = time.monotonic() + DEADLINE_S
            while time.monotonic() < end and not engine.interrupted():  # type: ignore[attr-defined]
                time.sleep(0.01)

    command = run_command(cell, tmp_path / "out", halt, *options)
    children.append(command)
    until(told.exists, "the third step of the run")
    pid, shared = told.read_text().split(" ", 1)
    return command, Seen(int(pid), Path(shared))


def has_ended(pid: int) -> bool:
    """Also true of a process that nobody has waited for yet."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except (FileNotFoundError, ProcessLookupError):
        return True


@pytest.mark.parametrize(
    "options", [(), ("--realtime", "--speed", "100")], ids=["lock-step", "real time"]
)
def test_run_killed_the_supervisor_ends_by_itself(
    cell: Cell, children: list[Child], tmp_path: Path, options: tuple[str, ...]
) -> None:
    command, seen = halted_run(cell, children, tmp_path, *options)
    try:
        command.kill()
        until(lambda: has_ended(seen.pid), "the end of the supervisor")
        lines = (seen.shared / "supervisor.status").read_text().splitlines()
        assert lines[0] == "stopped"
        assert (
            lines[2] == "the engine has gone (end of input)"
            if not options
            else "has died" in lines[2]
        )
        assert not [p for p in seen.shared.iterdir() if p.name.endswith(".tmp")]
    finally:
        shutil.rmtree(seen.shared)
    growing, whole = ["supervisor.trace.jsonl"], list[str]()
    if options:
        growing, whole = [*growing, "robots.trace.jsonl"], ["running.json"]
    found = sorted(p.name for p in (tmp_path / "out").iterdir())
    assert found == sorted(["program", *growing, *whole])
    for name in growing:
        for line in (tmp_path / "out" / name).read_text().splitlines():
            json.loads(line)
    for name in whole:
        json.loads((tmp_path / "out" / name).read_text())


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT][: amount(1, 2)])
def test_run_interrupted(cell: Cell, children: list[Child], tmp_path: Path, number: int) -> None:
    """In lock-step: the cell is stopped, and what it has done is there to be looked at."""
    command, seen = halted_run(cell, children, tmp_path)
    command.signal(number)
    done = command.done()
    assert done.returncode == 130
    assert "pn2code: interrupted; the run as far as it went is in" in done.stderr
    assert has_ended(seen.pid)
    assert not seen.shared.exists()
    out = tmp_path / "out"
    assert json.loads((out / "summary.json").read_text())["verdict"] == "stopped"
    (trace,) = [p for p in out.glob("*.trace.jsonl") if not p.name.startswith("supervisor")]
    assert str(trace) in done.stderr.replace("\n", "")
    steps = [json.loads(line) for line in trace.read_text().splitlines()]
    assert len(steps) > 1
