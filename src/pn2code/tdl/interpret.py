"""Running a script: a coroutine by hand that never sleeps and never reads the wall clock.

    interpreter = Interpreter(checked, files, on_event)
    request = interpreter.resume()
    Execute(command, line)  -> the driver runs the command, then resume(result of Measure, else None)
    Sense(sensor, line)     -> resume(what the sensor says)
    AwaitFile(names, line)  -> resume() when one of the files holds a message
    Finished(), Fault(...)  -> that was all

Scripts have mm and degrees; commands leave in SI, measurements come back in SI.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import astuple
from pathlib import PurePath
from typing import Any, Final, assert_never, cast

import pn2code.robot.commands as commands
from pn2code.base.frozen import frozen
from pn2code.base.real_json import real_to_json
from pn2code.tdl import flow, paths
from pn2code.tdl import tree as t
from pn2code.tdl.check import CheckedProgram
from pn2code.tdl.evaluate import (
    Element,
    ScriptError,
    ScriptPose,
    ScriptValue,
    evaluate,
    show,
)
from pn2code.tdl.messages import (
    along_to_si,
    axes_to_si,
    from_si,
    items_of_columns,
    message_of,
    scalar_of,
    stored_value,
    to_si,
    typed_values,
)
from pn2code.tdl.requests import (
    AwaitFile,
    Event,
    Execute,
    Fault,
    FileError,
    Files,
    Finished,
    Marked,
    MessageConsumed,
    MessageRead,
    MessageWritten,
    Request,
    Scalar,
    Sense,
)
from pn2code.tdl.types import POSE_FIELDS

DEFAULT_STEP_LIMIT: Final = 100_000
MOST_OCCURRENCES: Final = 100_000
"""Transitions in a row for which a script neither waits, nor acts, nor takes a message."""
MOST_AT_ONCE: Final = 10_000
"""Commands of a cell in lock-step without time passing, or messages; more are taken for an endless repetition."""


def _ignore(event: Event) -> None:
    return None


@frozen
class Saved:
    """The state of a run between two requests; equal states go on alike."""

    values: tuple[tuple[str, ScriptValue], ...]
    at: tuple[tuple[str, int], ...]
    speed: tuple[tuple[t.Motion, float | None], ...]
    measuring: tuple[t.Measure, ScriptPose, commands.Pose] | None
    sensing: t.Sense | None
    end: Finished | Fault | None
    started: bool


class Interpreter:
    """One run of a script.

    Args:
        program: checked.
        files: the shared files.
        on_event: hears of marks and messages, in order.
        step_limit: most instructions between two requests, marks, or messages taken; more is an endless loop. Those of
            loops along lists, which come to their end, do not count.
        occurrences: most marks between two requests or messages taken; the same.
    """

    def __init__(
        self,
        program: CheckedProgram,
        files: Files,
        on_event: Callable[[Event], None] = _ignore,
        *,
        step_limit: int = DEFAULT_STEP_LIMIT,
        occurrences: int = MOST_OCCURRENCES,
    ) -> None:
        self._program = program
        self._files = files
        self._channel = {f.name: PurePath(f.path).stem for f in program.files.values()}
        self._on_event = on_event
        self._limit = step_limit
        self._occurrences = occurrences
        self._statements = self._marks = 0
        self._values: dict[str, ScriptValue] = {}
        self._at: list[tuple[str, int]] = [("", 0)]
        self._speed: dict[t.Motion, float | None] = dict.fromkeys(t.Motion)
        self._measuring: tuple[t.Measure, ScriptPose, commands.Pose] | None = None
        self._sensing: t.Sense | None = None
        self._end: Finished | Fault | None = None
        self._line = 0
        self._started = False

    @property
    def line(self) -> int:
        """The line of the statement that runs now, or ran last."""
        return self._line

    @property
    def variables(self) -> dict[str, ScriptValue]:
        """A copy of the variables that have a value (for reports and tests)."""
        return dict(self._values)

    def resume(self, result: commands.Pose | Scalar | None = None) -> Request:
        """Run until something is needed.

        `result` answers a `Measure` (the pose seen, in SI) or a `Sense` (a scalar).
        """
        if self._end is not None:
            return self._end
        try:
            if not self._started:
                self._started = True
                self._initialise()
            if self._measuring is not None:
                self._finish_measure(result)
            if self._sensing is not None:
                self._finish_sense(result)
            self._statements = self._marks = 0
            while self._statements < self._limit and self._marks <= self._occurrences:
                request = self._step()
                if request is not None:
                    if isinstance(request, Finished):
                        self._end = request
                    return request
            raise ScriptError(f"endless loop: {self._rounds()} without a command or a wait")
        except (ScriptError, FileError) as problem:
            self._end = Fault(str(problem), self._line)
            return self._end

    def _rounds(self) -> str:
        if self._marks > self._occurrences:
            return f"more than {self._occurrences} transitions"
        return f"{self._limit} statements"

    def save(self) -> Saved:
        """The state, to come back to."""
        return Saved(
            tuple(sorted(self._values.items())),
            tuple(self._at),
            tuple(self._speed.items()),
            self._measuring,
            self._sensing,
            self._end,
            self._started,
        )

    def restore(self, saved: Saved) -> None:
        """Back to a state."""
        self._values = dict(saved.values)
        self._at = list(saved.at)
        self._speed = dict(saved.speed)
        self._measuring = saved.measuring
        self._sensing = saved.sensing
        self._end = saved.end
        self._started = saved.started

    def twin(self, files: Files) -> Interpreter:
        """Another run in the same state, with files of its own; nobody hears what happens in it."""
        other = Interpreter(
            self._program, files, step_limit=self._limit, occurrences=self._occurrences
        )
        other.restore(self.save())
        return other

    # Environment of expressions

    def value(self, name: str) -> ScriptValue:
        """The value of a variable or constant."""
        if name in self._program.constants:
            return self._program.constants[name]
        if name not in self._values:
            raise ScriptError(f"variable `{name}` has no value yet")
        return self._values[name]

    def filled(self, name: str) -> bool:
        """Whether a file holds a message."""
        return self._files.read(self._channel[name]) is not None

    # Running

    def _initialise(self) -> None:
        for v in self._program.variables.values():
            if v.initial is not None:
                self._line = v.span.line
                self._assign(v.name, evaluate(v.initial, self))

    def _step(self) -> Request | None:
        body, at = self._at[-1]
        code = self._program.bodies[body]
        instruction = code.instructions[at]
        self._statements += at not in code.along
        self._line = instruction.span.line or self._line
        following = at + 1
        match instruction:
            case flow.Jump(target):
                following = target
            case flow.BranchUnless(condition, target):
                if not evaluate(condition, self):
                    following = target
            case flow.BranchIf(condition, target):
                if evaluate(condition, self):
                    following = target
            case flow.CallProcedure(name):
                self._at[-1] = (body, following)
                self._at.append((name, 0))
                return None
            case flow.End():
                self._at.pop()
                return None if self._at else Finished()
            case flow.Do(statement):
                request = self._do(statement)
                if isinstance(request, AwaitFile):
                    return request  # the condition is looked at again
                self._at[-1] = (body, following)
                return request
            case _:
                assert_never(instruction)
        self._at[-1] = (body, following)
        return None

    def _do(self, s: t.Simple) -> Request | None:
        match s:
            case t.Assign(target, value):
                self._assign(target.name, evaluate(value, self))
            case t.Read():
                self._read(s)
            case t.Clear(file):
                channel = self._channel[file.name]
                message = self._files.read(channel)
                if message is None:
                    raise ScriptError(f"file `{file.name}` is empty, there is nothing to consume")
                self._files.clear(channel)
                self._statements = self._marks = 0  # what comes next depends on others, too
                self._on_event(MessageConsumed(channel, message, self._line))
            case t.Write(file, values):
                kinds = self._program.files[file.name].types
                stored = [
                    stored_value(evaluate(v, self), kind)
                    for kind, v in zip(kinds, values, strict=False)
                ]
                scalars = message_of(stored, kinds[: len(stored)]) or (1,)  # a signal
                channel = self._channel[file.name]
                self._files.write(channel, scalars)
                self._on_event(MessageWritten(channel, scalars, self._line))
            case t.Compute(parts):
                for part in parts:
                    evaluate(part, self)
            case t.WaitUntil(condition):
                return self._wait_until(condition)
            case t.Mark(transition, binding):
                data = {name: self._datum(x) for name, x in binding}
                self._on_event(Marked(transition, data, self._line))
                self._statements = 0
                self._marks += 1
            case t.Stop(message_parts):
                raise ScriptError(" ".join(show(evaluate(m, self)) for m in message_parts))
            case t.Speed(motion, speed):
                self._speed[motion] = None if speed is None else self._number(speed)
            case t.Move() | t.WaitTime() | t.Tool() | t.Measure():
                return Execute(self._command(s), self._line)
            case t.Sense(sensor, target):
                self._sensing = s
                kind = self._program.variables[target.name].type.type
                return Sense(sensor, kind, self._line)
            case t.Call() | t.Return() | t.Label() | t.Goto() | t.Exit():
                raise AssertionError("control flow is in the instructions")
            case _:
                assert_never(s)
        return None

    def _wait_until(self, condition: t.Expression) -> AwaitFile | None:
        # First the files, then the condition: what comes between the two (in real time) is seen by the condition, and
        # what comes after it fills one of these files.
        empty = tuple(
            self._channel[name] for name in paths.files_in(condition) if not self.filled(name)
        )
        if evaluate(condition, self):
            return None
        if not empty:
            raise ScriptError("this wait can never end: all its files hold messages")
        return AwaitFile(empty, self._line)

    def _read(self, s: t.Read) -> None:
        name = s.file.name
        channel = self._channel[name]
        message = self._files.read(channel)
        if message is None:
            raise ScriptError(f"file `{name}` is empty, there is nothing to read")
        kinds = self._program.files[name].types
        values = typed_values(name, message, kinds)
        for target, kind, value in zip(s.targets, kinds, values, strict=True):
            self._assign(target.name, stored_value(value, kind))
        self._on_event(MessageRead(channel, message, self._line))

    def _assign(self, name: str, value: ScriptValue) -> None:
        self._values[name] = stored_value(value, self._program.variables[name].type)

    def _datum(self, x: t.Datum) -> Any:
        match x:
            case t.RecordDatum(fields):
                return {name: self._datum(inner) for name, inner in fields}
            case t.TupleDatum(items):
                return [self._datum(inner) for inner in items]
            case t.EachDatum(item):
                columns = [cast("tuple[Element, ...]", evaluate(e, self)) for e in paths.data(item)]
                return [_filled(item, iter(parts)) for parts in items_of_columns(columns)]
            case t.NullDatum():
                return None
            case _:
                return _json(evaluate(x, self))

    # Commands

    def _command(self, s: t.Move | t.WaitTime | t.Tool | t.Measure) -> commands.Command:
        match s:
            case t.Move():
                return self._move(s)
            case t.WaitTime(duration):
                return commands.Wait(self._duration(duration))
            case t.Tool(action, duration, handling):
                return commands.ToolAction(action, self._duration(duration), handling)
            case t.Measure(nominal):
                pose = cast(ScriptPose, evaluate(nominal, self))
                self._measuring = (s, pose, self._pose(nominal))
                return commands.Measure(self._measuring[2])

    def _move(self, s: t.Move) -> commands.Move:
        frame = s.frame or "world"
        speed = self._move_speed(s)
        ramp = 1.0 if s.acceleration is None else self._number(s.acceleration)
        if not 0 < ramp <= 1:
            raise ScriptError(f"acceleration {ramp * 100:g} % is not above zero and at most 100 %")
        along = tuple(map(self._external, s.along))
        elbow = None if s.arm_angle is None else math.radians(self._number(s.arm_angle))
        if s.motion in (t.Motion.JOINT, t.Motion.EXTERNAL):
            joint = 1.0 if speed is None else speed
            if not 0 < joint <= 1:
                raise ScriptError(
                    f"joint speed {joint * 100:g} % is not above zero and at most 100 %"
                )
            if s.motion is t.Motion.EXTERNAL:
                return commands.MoveExternal(along, joint, ramp)
            match s.target:
                case None:
                    return commands.MoveHome(joint, ramp)
                case t.Axes(angles):
                    axes = axes_to_si(map(self._number, angles))
                    return commands.MoveAxes(axes, joint, ramp, along)
                case target:
                    return commands.MoveJoint(
                        self._pose(target), joint, frame, ramp, along, s.tcp, elbow
                    )
        if speed is not None and speed <= 0:
            raise ScriptError(f"linear speed {speed:g} mm/s is not above zero")
        metres = None if speed is None else speed / 1000.0
        assert s.target is not None and not isinstance(s.target, t.Axes), "it was checked"
        if s.motion is t.Motion.LINEAR:
            end = self._pose(s.target)
            through = tuple(map(self._pose, s.via))
            zone = 0.0 if s.blend is None else self._number(s.blend)
            if through and not zone > 0:
                raise ScriptError(f"a zone of {zone:g} mm for corners is not above zero")
            return commands.MoveLinear(
                end, frame, metres, ramp, along, s.tcp, elbow, through, zone / 1000.0
            )
        via = self._pose(s.via[0])
        end = self._pose(s.target)
        return commands.MoveCircular(via, end, frame, metres, ramp, along, s.tcp, elbow)

    def _external(self, a: t.Along) -> commands.Along:
        return along_to_si(a, self._number(a.position))

    def _move_speed(self, s: t.Move) -> float | None:
        if s.speed is not None:
            return self._number(s.speed)
        joint = s.motion in (t.Motion.JOINT, t.Motion.EXTERNAL)
        return self._speed[t.Motion.JOINT if joint else t.Motion.LINEAR]

    def _number(self, e: t.Expression) -> float:
        number = float(cast(float, evaluate(e, self)))
        if not math.isfinite(number):
            raise ScriptError(f"{number:g} is not a finite number")
        return number

    def _duration(self, e: t.Expression) -> float:
        seconds = self._number(e)
        if seconds < 0:
            raise ScriptError(f"the duration {seconds:g} s is negative")
        return seconds

    def _pose(self, e: t.Expression) -> commands.Pose:
        pose = cast(ScriptPose, evaluate(e, self))
        if not all(map(math.isfinite, astuple(pose))):
            raise ScriptError(f"{show(pose)} is no pose: not all of its numbers are finite")
        return to_si(pose)

    def _finish_sense(self, result: commands.Pose | Scalar | None) -> None:
        assert self._sensing is not None
        statement, self._sensing = self._sensing, None
        if result is None or isinstance(result, commands.Pose):
            raise ScriptError(f"sensor `{statement.sensor}` gave no value")
        kind = self._program.variables[statement.target.name].type.type
        try:
            self._assign(statement.target.name, scalar_of(result, kind))
        except ValueError:
            raise ScriptError(
                f"sensor `{statement.sensor}` says `{result}`, but the script expects `{kind}`"
            ) from None

    def _finish_measure(self, result: commands.Pose | Scalar | None) -> None:
        assert self._measuring is not None
        statement, nominal, asked = self._measuring
        self._measuring = None
        if not isinstance(result, commands.Pose):
            raise ScriptError("the measurement gave no pose")
        self._assign(statement.target.name, from_si(result, asked, nominal))


def _filled(x: t.Datum, parts: Iterator[Element]) -> Any:
    """An item of a list of records as traces write it: with its own parts in place of the columns."""
    match x:
        case t.RecordDatum(fields):
            return {name: _filled(inner, parts) for name, inner in fields}
        case t.TupleDatum(items):
            return [_filled(inner, parts) for inner in items]
        case t.NullDatum():
            return None
        case _:
            return _json(next(parts))


def _json(value: ScriptValue) -> Any:
    """A value as traces write it."""
    match value:
        case ScriptPose():
            numbers = map(real_to_json, astuple(value))
            return dict(zip(POSE_FIELDS, numbers, strict=True))
        case tuple():
            return [_json(item) for item in value]
        case float():
            return real_to_json(value)
        case _:
            return value
