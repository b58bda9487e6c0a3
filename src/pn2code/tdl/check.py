"""Static checks: what is wrong with a script before it runs.

    check(program, d) -> CheckedProgram, or None when there is an error

Errors: names, types, units, files and their direction, frames, labels. Warnings: what can never be
reached, variables that may have no value, declarations that nothing uses.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Note, Span
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.tdl import codes, flow, paths
from pn2code.tdl import tree as t
from pn2code.tdl.evaluate import ScriptError, ScriptValue, evaluate
from pn2code.tdl.expressions import RESERVED, Scope, type_of
from pn2code.tdl.types import IN_SCRIPT, LISTS, NUMBERS, QUANTITIES, Type, fits

AXES = (4, 6, 7)
"""How many axes an arm may have."""


@frozen
class CheckedProgram:
    """A script without errors, ready to run.

    Args:
        tree: as parsed.
        files, variables: by name.
        constants: values by name.
        bodies: code by procedure name; the program's own under "".
    """

    tree: t.Program
    files: Mapping[str, t.File]
    variables: Mapping[str, t.Variable]
    constants: Mapping[str, ScriptValue]
    bodies: Mapping[str, flow.Body]

    @property
    def sensors(self) -> tuple[str, ...]:
        """The sensors that the script asks, each once."""
        found = {
            i.statement.sensor: None
            for body in self.bodies.values()
            for i in body.instructions
            if isinstance(i, flow.Do) and isinstance(i.statement, t.Sense)
        }
        return tuple(found)


def check(
    program: t.Program, d: Diagnostics, frames: Collection[str] | None = ()
) -> CheckedProgram | None:
    """Check a script; None when an error was reported (warnings do not count).

    Args:
        program: the script.
        d: gets what is wrong.
        frames: that the cell has, beside `world` and `tool`; None: it is not looked at.
    """
    before = len(d.errors)
    checker = _Checker(program, d, frames)
    checker.declarations()
    for procedure in program.procedures:
        checker.body(procedure.body)
    checker.body(program.body)
    checker.no_recursion()
    bodies = {p.name: flow.flatten(p.body, p.span) for p in program.procedures}
    bodies[""] = flow.flatten(program.body, program.span)
    if len(d.errors) != before:
        return None
    for body in bodies.values():
        paths.unreachable(body, d)
    paths.unassigned(program, bodies, checker.variables, d)
    checker.unused()
    return CheckedProgram(
        program, checker.scope.files, checker.variables, checker.constants, bodies
    )


class _ConstantsOnly:
    """The environment of a constant's value."""

    def __init__(self, values: Mapping[str, ScriptValue]) -> None:
        self._values = values

    def value(self, name: str) -> ScriptValue:
        if name in self._values:
            return self._values[name]
        raise ScriptError(f"`{name}` is not a constant declared before")

    def filled(self, name: str) -> bool:
        raise ScriptError(f"the file `{name}` is not known before the script runs")


class _Checker:
    """Walks a program once."""

    def __init__(self, program: t.Program, d: Diagnostics, frames: Collection[str] | None) -> None:
        self.program = program
        self.frames = frames
        self.d = d
        self.variables: dict[str, t.Variable] = {}
        self.constants: dict[str, ScriptValue] = {}
        self.procedures: dict[str, t.Procedure] = {}
        self.scope = Scope({}, {}, d)
        self.assigned: set[str] = set()
        self.touched: set[str] = set()
        self.loops = 0
        self.labels: dict[str, t.Label] = {}
        self.calls: dict[str, list[t.Target]] = {}

    # declarations

    def declarations(self) -> None:
        seen: dict[str, Span] = {}
        for x in (*self.program.declarations, *self.program.procedures):
            if x.name in seen:
                self.d.error(
                    codes.DUPLICATE,
                    f"`{x.name}` is declared twice",
                    x.span,
                    notes=[Note("first declared here", seen[x.name].origin)],
                )
                continue
            seen[x.name] = x.span
            if x.name in RESERVED:
                self.d.error(
                    codes.RESERVED,
                    f"`{x.name}` is a name of the language",
                    x.span,
                    hint="choose another name",
                )
                continue
            match x:
                case t.File():
                    self.file(x)
                case t.Const():
                    self.const(x)
                case t.Variable():
                    self.variable(x)
                case t.Procedure():
                    self.procedures[x.name] = x
        for procedure in self.program.procedures:
            self.calls[procedure.name] = [
                s.procedure for s in flow.walk(procedure.body) if isinstance(s, t.Call)
            ]

    def file(self, x: t.File) -> None:
        for other in self.scope.files.values():
            if other.path == x.path:
                self.d.error(
                    codes.DUPLICATE,
                    f"the file `{x.path}` is declared twice",
                    x.span,
                    notes=[Note(f"first declared as `{other.name}`", other.span.origin)],
                )
        if any(k.type is Type.SIGNAL for k in x.types) and len(x.types) > 1:
            self.d.error(
                codes.TYPE, "`signal` cannot be combined with other types", x.types[0].span
            )
        self.scope.files[x.name] = x

    def const(self, x: t.Const) -> None:
        found = type_of(x.value, self.scope)
        if found is None:
            return
        self.scope.values[x.name] = found
        try:
            self.constants[x.name] = evaluate(x.value, _ConstantsOnly(self.constants))
        except ScriptError as problem:
            self.d.error(
                codes.CONSTANT,
                f"the value of constant `{x.name}` is not known: {problem}",
                x.value.span,
            )

    def variable(self, x: t.Variable) -> None:
        if x.type.type is Type.SIGNAL or x.type.type in IN_SCRIPT:
            self.d.error(
                codes.TYPE,
                f"only files can be of type `{x.type.type}`",
                x.type.span,
                hint=f"use `{IN_SCRIPT.get(x.type.type, Type.BOOL)}`",
            )
            return
        if x.initial is not None:
            self.expect(x.initial, x.type.type, f"the value of `{x.name}`")
            self.assigned.add(x.name)
        self.variables[x.name] = x
        self.scope.values[x.name] = x.type.type

    # bodies

    def body(self, body: tuple[t.Statement, ...]) -> None:
        self.labels = {}
        for s in flow.walk(body):
            if isinstance(s, t.Label):
                if s.name in self.labels:
                    self.d.error(
                        codes.DUPLICATE,
                        f"label `{s.name}` is set twice",
                        s.span,
                        notes=[Note("first set here", self.labels[s.name].span.origin)],
                    )
                else:
                    self.labels[s.name] = s
        used = {s.label.name for s in flow.walk(body) if isinstance(s, t.Goto)}
        self.loops = 0
        self.block(body)
        for name, label in self.labels.items():
            if name not in used:
                self.d.warning(
                    codes.UNUSED_LABEL,
                    f"no `goto` leads to label `{name}`",
                    label.span,
                    hint="remove it",
                )

    def block(self, body: Iterable[t.Statement]) -> None:
        for s in body:
            self.statement(s)

    def statement(self, s: t.Statement) -> None:
        match s:
            case t.If(branches, otherwise):
                for b in branches:
                    self.condition(b.condition)
                    self.block(b.body)
                self.block(otherwise or ())
            case t.While(condition, body):
                self.condition(condition)
                self.loop(body)
            case t.Loop(body):
                self.loop(body)
            case t.Exit(condition):
                if condition is not None:
                    self.condition(condition)
                if not self.loops:
                    self.d.error(
                        codes.EXIT,
                        "`exit` stands outside a loop",
                        s.span,
                        hint="use `return` to leave the procedure or end the program",
                    )
            case t.Goto(label):
                if label.name not in self.labels:
                    self.d.error(
                        codes.UNKNOWN_LABEL,
                        f"there is no label `{label.name}` in this body",
                        label.span,
                        hint=did_you_mean(label.name, self.labels),
                    )
            case t.Call(procedure):
                self.call(procedure)
            case t.Label() | t.Return():
                pass
            case t.Assign(target, value):
                wanted = self.target(target)
                if wanted is None:
                    type_of(value, self.scope)
                else:
                    self.expect(value, wanted, f"`{target.name}`")
            case t.Mark(_, binding):
                self.mark(binding, s.span)
            case t.Stop(values) | t.Compute(values):
                for v in values:
                    type_of(v, self.scope)
            case t.Read() | t.Clear() | t.Write() | t.WaitUntil():
                self.message(s)
            case t.Move() | t.Speed() | t.WaitTime() | t.Tool() | t.Measure() | t.Sense():
                self.command(s)

    def loop(self, body: tuple[t.Statement, ...]) -> None:
        self.loops += 1
        self.block(body)
        self.loops -= 1

    def call(self, procedure: t.Target) -> None:
        if procedure.name in self.procedures:
            self.touched.add(procedure.name)
            return
        self.d.error(
            codes.UNKNOWN_NAME,
            f"there is no procedure `{procedure.name}`",
            procedure.span,
            hint=did_you_mean(procedure.name, self.procedures),
        )

    def mark(self, binding: tuple[tuple[str, t.Datum], ...], span: Span) -> None:
        seen: set[str] = set()
        for name, datum in binding:
            if name in seen:
                self.d.error(codes.DUPLICATE, f"`{name}` is bound twice", span)
            seen.add(name)
            self.datum(datum)

    def datum(self, datum: t.Datum) -> None:
        match datum:
            case t.RecordDatum(fields):
                self.mark(fields, datum.span)
            case t.TupleDatum(items):
                for i in items:
                    self.datum(i)
            case t.EachDatum(item):
                self.each(item)
            case t.NullDatum():
                pass
            case _:
                type_of(datum, self.scope)

    def each(self, item: t.Datum) -> None:
        """A list of records: it is made of columns."""
        self.datum(item)
        before = len(self.d.errors)
        columns = tuple(paths.data(item))
        for column in columns:
            found = type_of(column, self.scope)
            if len(self.d.errors) == before and found is not None and found not in LISTS:
                self.d.error(
                    codes.TYPE,
                    f"`each` makes records of the items of lists, but this is `{found}`",
                    column.span,
                )
        if not columns:
            self.d.error(codes.TYPE, "`each` has no list", item.span)

    # files

    def message(self, s: t.Read | t.Clear | t.Write | t.WaitUntil) -> None:
        match s:
            case t.Read(name, targets):
                file = self.scope.file(name.name, name.span, t.Direction.INPUT, "read")
                types = [self.target(x) for x in targets]
                if file is None:
                    return
                kinds = _values(file)
                if len(kinds) != len(targets):
                    self.count(file, len(targets), s.span, "variable")
                    return
                for x, kind, wanted in zip(targets, kinds, types, strict=True):
                    if wanted is not None and not fits(kind.type, wanted):
                        self.d.error(
                            _code(kind.type, wanted),
                            f"`{x.name}` is of type `{wanted}`, but file `{file.name}` holds `{kind.type}`",
                            x.span,
                        )
            case t.Clear(name):
                self.scope.file(name.name, name.span, t.Direction.INPUT, "cleared")
            case t.Write(name, values):
                file = self.scope.file(name.name, name.span, t.Direction.OUTPUT, "written")
                if file is None:
                    for v in values:
                        type_of(v, self.scope)
                    return
                kinds = _values(file)
                if len(kinds) != len(values):
                    self.count(file, len(values), s.span, "value")
                    return
                for v, kind in zip(values, kinds, strict=True):
                    self.expect(v, kind.type, f"file `{file.name}`")
            case t.WaitUntil(condition):
                before = len(self.d.errors)
                self.condition(condition)
                if len(self.d.errors) == before and not paths.files_in(condition):
                    self.d.error(
                        codes.WAIT_NOTHING,
                        "this wait can never end: while the script waits only files change",
                        condition.span,
                        hint="ask for a message: `wait until filled(F)`; for a time: `wait 2 s`",
                    )

    def count(self, file: t.File, found: int, span: Span, what: str) -> None:
        kinds = _values(file)
        wanted = f"{len(kinds)} {what}{'s' * (len(kinds) != 1)}" if kinds else "`signal`"
        self.d.error(
            codes.FILE_VALUES,
            f"file `{file.name}` takes {wanted}, but {found} {'is' if found == 1 else 'are'} given",
            span,
            notes=[Note("declared here", file.span.origin)],
            hint="" if kinds else f"`write {file.name} signal`; to consume it: `clear {file.name}`",
        )

    # commands

    def command(self, s: t.Move | t.Speed | t.WaitTime | t.Tool | t.Measure | t.Sense) -> None:
        match s:
            case t.Move():
                self.move(s)
            case t.Speed(motion, value):
                if motion in (t.Motion.CIRCULAR, t.Motion.EXTERNAL):
                    self.d.error(
                        codes.SPEED,
                        "circular moves have the speed of linear moves",
                        s.span,
                        hint="write `speed $linear`",
                    )
                elif value is not None:
                    self.speed(motion, value)
            case t.WaitTime(duration) | t.Tool(_, duration):
                self.expect(duration, Type.TIME, "the duration")
                known = self.known(duration)
                if known is not None and known < 0:
                    self.d.error(codes.SPEED, "the duration is negative", duration.span)
            case t.Sense(_, target):
                found = self.target(target)
                if found not in (None, Type.INT, Type.REAL, Type.BOOL, Type.STRING):
                    self.d.error(
                        codes.TYPE,
                        f"`{target.name}` is of type `{found}`, but a sensor gives a number, a truth "
                        "value or a text",
                        target.span,
                    )
            case t.Measure(nominal, target):
                self.expect(nominal, Type.POSE, "the nominal pose")
                wanted = self.target(target)
                if wanted not in (None, Type.POSE):
                    self.d.error(
                        codes.TYPE,
                        f"`{target.name}` is of type `{wanted}`, but a measurement gives `pose`",
                        target.span,
                    )

    def move(self, s: t.Move) -> None:
        self.goal(s)
        if s.speed is not None:
            self.speed(s.motion, s.speed)
        if s.acceleration is not None:
            self.fraction(s.acceleration, "acceleration")
        self.along(s)
        if s.motion is t.Motion.EXTERNAL:
            return
        is_position = s.target is None or isinstance(s.target, t.Axes)
        what = "`home`" if s.target is None else "`axes(...)`"
        if s.frame is None:
            if s.motion is not t.Motion.JOINT and is_position:
                self.d.error(
                    codes.FRAME,
                    f"{what} is a joint position",
                    s.span,
                    hint="write `move $joint " + ("home`" if s.target is None else "axes(...)`"),
                )
            return
        span = s.frame_span or s.span
        known = ("world", "tool", *(self.frames or ()))
        if s.frame not in known and self.frames is not None:
            self.d.error(
                codes.UNKNOWN_FRAME,
                f"there is no frame `{s.frame}`",
                span,
                hint=did_you_mean(s.frame, known)
                or "frames are `world`, `tool`, and those of [frames] in the cell's cell.toml",
            )
        elif is_position:
            self.d.error(codes.FRAME, f"{what} is a joint position and has no frame", span)
        elif s.motion is t.Motion.JOINT and s.frame == "tool":
            self.d.error(
                codes.FRAME,
                "a joint move goes to an absolute pose, it cannot be made in the tool frame",
                span,
                hint="write `move $linear ... in tool`, or leave the frame out",
            )

    def along(self, s: t.Move) -> None:
        """What comes along: external axes, each once and in its unit, and the arm angle."""
        if s.arm_angle is not None:
            self.expect(s.arm_angle, Type.ANGLE, "the arm angle")
        names: set[str] = set()
        for a in s.along:
            kind, what = (Type.LENGTH, "track") if a.is_track else (Type.ANGLE, "turntable")
            self.expect(a.position, kind, f"the position of {what} `{a.axis}`")
            if a.axis in names:
                self.d.error(codes.EXTERNAL, f"`{a.axis}` is told twice where to go", a.span)
            names.add(a.axis)
        if s.along and s.target is None and s.motion is not t.Motion.EXTERNAL:
            self.d.error(
                codes.EXTERNAL,
                "on the way home external axes stand still",
                s.along[0].span,
                hint="move them with `move $external with ...`, before or after",
            )

    def goal(self, s: t.Move) -> None:
        """Where a move goes: an arc by way of somewhere, nothing else so."""
        if isinstance(s.target, t.Axes):
            if len(s.target.angles) not in AXES:
                self.d.error(
                    codes.ARGUMENTS,
                    "`axes` takes 4, 6 or 7 numbers, one for each axis of the arm, but "
                    f"{len(s.target.angles)} are given",
                    s.target.span,
                )
            for number, angle in enumerate(s.target.angles, 1):
                self.expect(angle, Type.ANGLE, f"the angle of axis {number}")
        elif s.target is not None:
            self.expect(s.target, Type.POSE, "the target")
        for pose in s.via:
            self.expect(pose, Type.POSE, "the pose on the way")
        self.corners(s)
        if s.motion is t.Motion.LINEAR:
            return
        if (len(s.via) == 1) != (s.motion is t.Motion.CIRCULAR) or len(s.via) > 1:
            is_arc = s.motion is t.Motion.CIRCULAR
            self.d.error(
                codes.VIA,
                f"a circular move needs {'a' if not s.via else 'one'} pose on the way"
                if is_arc
                else "only circular and linear moves go by way of a pose",
                s.span if not s.via else s.via[-1].span,
                hint="write `move $circular END via POSE`, or `move $linear END via POSE with $blend = 20 mm`",
            )

    def corners(self, s: t.Move) -> None:
        """A line goes by way of poses with rounded corners, and nothing else has a zone for them."""
        is_line = s.motion is t.Motion.LINEAR
        if s.blend is None:
            if is_line and s.via:
                self.d.error(
                    codes.VIA,
                    "a linear move by way of poses needs a zone in which its corners are rounded",
                    s.via[0].span,
                    hint="write `move $linear END via POSE with $blend = 20 mm`",
                )
            return
        if not is_line or not s.via:
            self.d.error(
                codes.VIA,
                "only a linear move by way of poses has a zone for its corners",
                s.blend.span,
                hint="write `move $linear END via POSE with $blend = 20 mm`",
            )
        if self.expect(s.blend, Type.LENGTH, "the zone of the corners"):
            known = self.known(s.blend)
            if known is not None and not known > 0:
                self.d.error(codes.VIA, "the zone of the corners must be above zero", s.blend.span)
        if s.along:
            self.d.error(
                codes.EXTERNAL,
                "external axes stand still on a linear move by way of poses",
                s.along[0].span,
                hint="move them with `move $external with ...`, before or after",
            )

    def speed(self, motion: t.Motion, value: t.Expression) -> None:
        if motion in (t.Motion.JOINT, t.Motion.EXTERNAL):
            self.fraction(value, "joint speed")
            return
        if not self.expect(value, Type.SPEED, "linear speed"):
            return
        known = self.known(value)
        if known is not None and not known > 0:
            self.d.error(codes.SPEED, "the linear speed must be above zero", value.span)

    def fraction(self, value: t.Expression, what: str) -> None:
        if not self.expect(value, Type.REAL, what):
            return
        known = self.known(value)
        if known is not None and not 0 < known <= 1:
            self.d.error(
                codes.SPEED, f"the {what} must be above zero and at most 100 %", value.span
            )

    def known(self, e: t.Expression) -> float | None:
        """The number an expression is, when constants alone decide it."""
        try:
            value = evaluate(e, _ConstantsOnly(self.constants))
        except (ScriptError, AttributeError, TypeError, KeyError):  # ill-typed: reported already
            return None
        return float(value) if isinstance(value, int | float) else None

    # common

    def target(self, x: t.Target) -> Type | None:
        """The type of a variable that is assigned."""
        variable = self.variables.get(x.name)
        if variable is not None:
            self.assigned.add(x.name)
            return variable.type.type
        what = (
            "a constant" if x.name in self.scope.values
            else "a file" if x.name in self.scope.files
            else "a procedure" if x.name in self.procedures
            else ""
        )  # fmt: skip
        if what:
            self.d.error(
                codes.NOT_A_VARIABLE,
                f"`{x.name}` is {what} and cannot be assigned",
                x.span,
                hint=f"to send a message: `write {x.name} ...`" if what == "a file" else "",
            )
        else:
            self.d.error(
                codes.UNKNOWN_NAME,
                f"variable `{x.name}` is not declared",
                x.span,
                hint=did_you_mean(x.name, self.variables) or f"declare it: `var {x.name} : int`",
            )
        return None

    def condition(self, e: t.Expression) -> None:
        self.expect(e, Type.BOOL, "the condition")

    def expect(self, e: t.Expression, wanted: Type, what: str) -> bool:
        found = type_of(e, self.scope)
        if found is None or fits(found, wanted):
            return found is not None
        self.d.error(
            _code(found, wanted),
            f"{what} must be of type `{wanted}`, but this is `{found}`",
            e.span,
            hint=_unit_hint(e, found, wanted),
        )
        return False

    def no_recursion(self) -> None:
        for name in self.calls:
            seen: set[str] = set()
            todo = [name]
            while todo:
                for c in self.calls.get(todo.pop(), []):
                    if c.name == name:
                        self.d.error(
                            codes.RECURSION,
                            f"procedure `{name}` calls itself, directly or through others",
                            c.span,
                            hint="use a loop",
                        )
                    elif c.name not in seen:
                        seen.add(c.name)
                        todo.append(c.name)

    def unused(self) -> None:
        used = self.scope.used
        for x in self.program.declarations:
            if x.name in used:
                continue
            match x:
                case t.Variable():
                    what = "assigned but never read" if x.name in self.assigned else "never used"
                    self.d.warning(codes.UNUSED, f"variable `{x.name}` is {what}", x.span)
                case t.Const():
                    self.d.warning(codes.UNUSED, f"constant `{x.name}` is never used", x.span)
                case t.File():
                    self.d.warning(codes.UNUSED, f"file `{x.name}` is never used", x.span)
        for p in self.program.procedures:
            if p.name not in self.touched:
                self.d.warning(codes.UNUSED, f"procedure `{p.name}` is never called", p.span)


def _values(file: t.File) -> tuple[t.TypeName, ...]:
    """The types of a message's values inside the script: a word is a string, a signal has none."""
    inside = (replace(k, type=IN_SCRIPT.get(k.type, k.type)) for k in file.types)
    return tuple(k for k in inside if k.type is not Type.SIGNAL)


def _code(found: Type, wanted: Type) -> str:
    """Whether the mistake is one of units or of types."""
    physical = QUANTITIES | NUMBERS
    return (
        codes.UNIT if {found, wanted} <= physical and {found, wanted} & QUANTITIES else codes.TYPE
    )


def _unit_hint(e: t.Expression, found: Type, wanted: Type) -> str:
    examples = {Type.LENGTH: "mm", Type.ANGLE: "deg", Type.TIME: "s", Type.SPEED: "mm/s"}
    if found in NUMBERS and wanted in QUANTITIES:
        return f"give it a unit, e.g. `{e.span.text or '1'} {examples[wanted]}`"
    if found in QUANTITIES and wanted in NUMBERS:
        return f"divide it by its unit: `{e.span.text} / 1 {examples[found]}`"
    return ""
