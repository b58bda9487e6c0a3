"""One robot by itself: its script against the shared files of a cell, on the wall clock, as its own process.

    with SharedDirectory(path, "robot1", script_specs(program, "robot1")) as shared:
        ended = RobotPlayer(program, shared, "robot1.tdl").run()       # Ended(RobotExit.FINISHED, "")

The counterpart of the compiled supervisor in real time: it waits for it, obeys, looks after it (I8), and stops safely,
saying why in its status file (I9, I10). The invariants are those of docs/protocol.md.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from enum import IntEnum
from itertools import groupby
from pathlib import PurePath
from typing import NoReturn, Protocol

from pn2code.base.frozen import frozen
from pn2code.cell.partition import ChannelKind
from pn2code.cell.scalars import MOST_ROOM, Scalar, ScalarKind
from pn2code.channels import GRACE_S, LOOK_S, ChannelSpec, PeerState, SharedDirectory
from pn2code.robot.commands import Command, Measure, Pose
from pn2code.run.files import DirectoryError, RobotFiles, directory_error
from pn2code.tdl import tree as t
from pn2code.tdl.check import CheckedProgram
from pn2code.tdl.interpret import Interpreter
from pn2code.tdl.requests import AwaitFile, Event, Execute, Fault, FileError, Finished, Sense
from pn2code.tdl.requests import Scalar as SensedValue
from pn2code.tdl.types import ELEMENT, POSE_FIELDS, Type

PAUSE_S = 0.001
"""Between two looks at the files: the cycle time of a robot controller's background task."""

JOIN_S = 0.1
"""How long to wait for the supervisor at a stretch, between looks at whether somebody wants us to stop."""


class RobotExit(IntEnum):
    """Exit codes of a robot: those of the supervisor (docs/protocol.md), seen from the other side."""

    FINISHED = 0
    SCRIPT = 1
    """the script said `stop`, made a mistake, or asked for a motion that cannot be done"""
    USAGE = 2
    SUPERVISOR = 3
    """it stopped, died, or never came"""
    CHANNEL = 4
    """a message was refused (I6), or would have been overwritten (I3)"""
    SYSTEM = 5
    """the shared directory is missing, removed, read-only or full, or another process is this robot"""
    INTERRUPTED = 130


@frozen
class Ended:
    """How a robot ended; `reason` is empty when it finished."""

    code: RobotExit
    reason: str = ""


class ArmError(Exception):
    """A command cannot be carried out; the message says which and why."""


class Arm(Protocol):
    """What carries out the commands."""

    def begin(self, command: Command) -> tuple[float, Pose | None]:
        """Begins: seconds until the end, and the pose seen if it measures. May raise `ArmError`."""

    def finish(self) -> None:
        """The command has ended."""

    def stop(self) -> str:
        """Comes to rest on the path; says where, "" when there is nothing to say."""


class InstantArm:
    """Everything is done at once; whoever measures sees what was expected."""

    def begin(self, command: Command) -> tuple[float, Pose | None]:
        """No time."""
        return 0.0, command.nominal if isinstance(command, Measure) else None

    def finish(self) -> None:
        """Nothing."""

    def stop(self) -> str:
        """Was not moving."""
        return ""


def script_specs(program: CheckedProgram, robot: str) -> tuple[ChannelSpec, ...]:
    """The channels that a script declares. Ranges, colour sets and their constructors are known from the cell only."""
    specs = []
    for file in program.files.values():
        out = file.direction is t.Direction.OUTPUT
        specs.append(
            ChannelSpec(
                name=PurePath(file.path).stem,
                file=file.path,
                scalars=tuple(_held(file.types)),
                writer=robot if out else "supervisor",
                reader="supervisor" if out else robot,
                kind=ChannelKind.FLAG if out else ChannelKind.DATA,
                room=MOST_ROOM,
            )
        )
    return tuple(specs)


def _held(types: Iterable[t.TypeName]) -> Iterator[Scalar]:
    for row, group in groupby(types, lambda x: x.row):
        found = [s for kind in group for s in _scalars(kind.type)]
        if not row:
            yield from found
            continue
        yield replace(found[0], elements=tuple(x for s in found for x in s.elements))


def _scalars(kind: Type) -> tuple[Scalar, ...]:
    match kind:
        case _ if kind in ELEMENT:
            elements = _scalars(ELEMENT[kind])
            return (Scalar(ScalarKind.LIST, str(kind), str(kind), (), 0, None, elements),)
        case Type.POSE:
            return tuple(Scalar(ScalarKind.REAL, name, "pose") for name in POSE_FIELDS)
        case Type.INT:
            of = ScalarKind.INT
        case Type.BOOL:
            of = ScalarKind.BOOL
        case Type.STRING:
            of = ScalarKind.STRING
        case Type.WORD:
            of = ScalarKind.ENUM
        case Type.SIGNAL:
            of = ScalarKind.UNIT
        case _:
            of = ScalarKind.REAL
    return (Scalar(of, str(kind), str(kind)),)


class _StopError(Exception):
    """The robot must stop."""

    def __init__(self, ended: Ended) -> None:
        super().__init__(ended.reason)
        self.ended = ended


def _ignore(event: Event) -> None:
    return None


def _never() -> bool:
    return False


def _nothing(_sensor: str) -> None:
    return None


def _alone(_session: str, _began: float) -> None:
    return None


@dataclass(slots=True)
class RobotPlayer:
    """Runs one robot from the supervisor's announcement to the end.

    Args:
        script: its file name, for messages.
        arm: what carries out the commands.
        on_event: hears of marks and messages.
        on_command: hears of each command and its line.
        sense: what a sensor says; None: nothing.
        interrupted: asked at every turn; True stops the robot safely.
        wait_s: how long to wait for the supervisor.
        joined: is told the session and when it began (s, as `time.time` counts), once there is one.
    """

    program: CheckedProgram
    shared: SharedDirectory
    script: str
    arm: Arm = field(default_factory=InstantArm)
    on_event: Callable[[Event], None] = _ignore
    on_command: Callable[[Command, int], None] = lambda _command, _line: None
    interrupted: Callable[[], bool] = _never
    sense: Callable[[str], SensedValue | None] = _nothing
    wait_s: float = 10.0
    joined: Callable[[str, float], None] = _alone
    _files: RobotFiles = field(init=False)
    _looked: float = 0.0
    _absent_since: float | None = None

    def run(self) -> Ended:
        """Until the supervisor has finished, the script has ended, or something stops the robot."""
        self._files = RobotFiles(self.shared, GRACE_S)
        try:
            self._join()
            self.joined(self.shared.session or "", self.shared.began)
            self._play()
            self._files.finished()
        except _StopError as stop:
            ended = stop.ended
        except FileError as problem:
            ended = Ended(self._fault_code(), str(problem))
        except OSError as problem:
            ended = Ended(RobotExit.SYSTEM, str(directory_error(self.shared.path, problem)))
        else:
            return Ended(RobotExit.FINISHED)
        where = self.arm.stop()
        reason = f"{ended.reason}; {where}" if where else ended.reason
        self._files.stopped(reason)
        return Ended(ended.code, reason)

    def _join(self) -> None:
        """I7: nothing is touched before the supervisor has announced itself."""
        path = self.shared.path
        end = time.monotonic() + self.wait_s
        while not path.is_dir():  # the supervisor may be about to make it
            if path.exists() or time.monotonic() >= end:
                what = "is not a directory" if path.exists() else "does not exist"
                raise _StopError(Ended(RobotExit.SYSTEM, f"the shared directory `{path}` {what}"))
            if self.interrupted():
                raise _StopError(Ended(RobotExit.INTERRUPTED, "interrupted"))
            time.sleep(PAUSE_S)
        try:
            while not self.shared.await_supervisor(min(JOIN_S, self.wait_s)):
                if self.interrupted():
                    raise _StopError(Ended(RobotExit.INTERRUPTED, "interrupted"))
                if time.monotonic() >= end and self.shared.was_here:
                    why = (
                        f"`{self.shared.side}` has been in the session of the supervisor in `{path}` before: "
                        "start the supervisor again"
                    )
                    raise _StopError(Ended(RobotExit.SUPERVISOR, why))
                if time.monotonic() >= end:
                    why = f"no supervisor has announced itself in `{path}` within {self.wait_s:g} s"
                    raise _StopError(Ended(RobotExit.SUPERVISOR, why))
        except BlockingIOError:
            why = f"another process is `{self.shared.side}` in `{path}`: end it first"
            raise _StopError(Ended(RobotExit.SYSTEM, why)) from None

    def _play(self) -> None:
        interpreter = Interpreter(self.program, self._files, self.on_event)
        result: Pose | SensedValue | None = None
        while True:
            if self._finished():
                return
            request = interpreter.resume(result)
            result = None
            match request:
                case AwaitFile(names=names, line=line):
                    if not self._await(names, line):
                        return
                case Execute(command=command, line=line):
                    result = self._execute(command, line)
                case Sense(sensor=sensor):
                    result = self.sense(sensor)
                case Finished():
                    return
                case Fault(message=message, line=line):
                    self._look()  # a supervisor that has gone is the better reason
                    self._fail(self._fault_code(), line, message)

    def _await(self, names: tuple[str, ...], line: int) -> bool:
        """Waits for a message; False when the supervisor has finished instead."""
        while True:
            try:
                if self._files.any_holds(names):
                    return True
            except FileError as problem:
                self._look()
                self._fail(self._fault_code(), line, str(problem))
            if self._finished():
                return False
            time.sleep(PAUSE_S)

    def _execute(self, command: Command, line: int) -> Pose | None:
        self.on_command(command, line)
        try:
            seconds, result = self.arm.begin(command)
        except ArmError as fault:
            self._fail(RobotExit.SCRIPT, line, str(fault))
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self._finished()  # a supervisor that has finished does not mind a motion that still ends
            time.sleep(min(left, LOOK_S / 4))
        self.arm.finish()
        return result

    def _finished(self) -> bool:
        """Whether the supervisor has finished; stops the robot when it has gone or somebody wants so."""
        if self.interrupted():
            raise _StopError(Ended(RobotExit.INTERRUPTED, "interrupted"))
        if time.monotonic() - self._looked < LOOK_S:
            return False
        return self._look()

    def _look(self) -> bool:
        self._looked = time.monotonic()
        peer = self.shared.peer()
        if peer.state is PeerState.ABSENT:
            # Perhaps just being written, or the directory is going: the files will say so soon.
            self._absent_since = self._absent_since or self._looked
            if self._looked - self._absent_since > GRACE_S:
                self._gone("the supervisor's status file has gone or cannot be understood")
            return False
        self._absent_since = None
        pid = f" (pid {peer.pid})" if peer.pid else ""
        match peer.state:
            case PeerState.STOPPED:
                self._gone(
                    f"the supervisor{pid} has stopped: {peer.reason or 'it did not say why'}"
                )
            case PeerState.DEAD:
                self._gone(
                    f"the supervisor{pid} has died: nobody holds the lock of its status file"
                )
            case PeerState.REPLACED:
                self._gone(
                    f"another supervisor{pid} has begun a new session: the one of this robot has ended"
                )
            case _:
                pass
        return peer.state is PeerState.FINISHED

    def _gone(self, why: str) -> NoReturn:
        raise _StopError(Ended(RobotExit.SUPERVISOR, why))

    def _fail(self, code: RobotExit, line: int, why: str) -> NoReturn:
        raise _StopError(Ended(code, f"{self.script}:{line}: {why}"))

    def _fault_code(self) -> RobotExit:
        match self._files.fault:
            case None:
                return RobotExit.SCRIPT
            case DirectoryError():
                return RobotExit.SYSTEM
            case _:
                return RobotExit.CHANNEL
