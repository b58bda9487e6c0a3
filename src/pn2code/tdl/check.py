"""Static checks: what is wrong with a script before it runs.

    check(program, d) -> CheckedProgram, or None when there is an error

Errors: names, types, units, files and their direction, frames, labels. Warnings: what can never be
reached, variables that may have no value, declarations that nothing uses.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Note, Span
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.tdl import codes, flow, paths
from pn2code.tdl import tree as t
from pn2code.tdl.check_commands import check_command
from pn2code.tdl.check_messages import check_message
from pn2code.tdl.context import ConstantsOnly, Context
from pn2code.tdl.evaluate import ScriptError, ScriptValue, evaluate
from pn2code.tdl.expressions import RESERVED, Scope, type_of
from pn2code.tdl.types import IN_SCRIPT, LISTS, Type


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
    paths.unassigned(program, bodies, checker.context.variables, d)
    checker.unused()
    found = checker.context
    return CheckedProgram(program, found.scope.files, found.variables, found.constants, bodies)


class _Checker:
    """Walks a program once."""

    def __init__(self, program: t.Program, d: Diagnostics, frames: Collection[str] | None) -> None:
        self.program = program
        self.d = d
        self.context = Context(d, frames, Scope({}, {}, d))
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
                    self.context.procedures[x.name] = x
        for procedure in self.program.procedures:
            self.calls[procedure.name] = [
                s.procedure for s in flow.walk(procedure.body) if isinstance(s, t.Call)
            ]

    def file(self, x: t.File) -> None:
        for other in self.context.scope.files.values():
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
        self.context.scope.files[x.name] = x

    def const(self, x: t.Const) -> None:
        before = len(self.d.errors)
        found = type_of(x.value, self.context.scope)
        if found is None:
            return
        self.context.scope.values[x.name] = found
        if len(self.d.errors) > before:  # a part of it is ill-typed, so that it has no value
            return
        try:
            self.context.constants[x.name] = evaluate(
                x.value, ConstantsOnly(self.context.constants)
            )
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
            self.context.expect(x.initial, x.type.type, f"the value of `{x.name}`")
            self.context.assigned.add(x.name)
        self.context.variables[x.name] = x
        self.context.scope.values[x.name] = x.type.type

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
                    self.context.condition(b.condition)
                    self.block(b.body)
                self.block(otherwise or ())
            case t.While(condition, body):
                self.context.condition(condition)
                self.loop(body)
            case t.Loop(body):
                self.loop(body)
            case t.Exit(condition):
                if condition is not None:
                    self.context.condition(condition)
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
                wanted = self.context.target(target)
                if wanted is None:
                    type_of(value, self.context.scope)
                else:
                    self.context.expect(value, wanted, f"`{target.name}`")
            case t.Mark(_, binding):
                self.mark(binding, s.span)
            case t.Stop(values) | t.Compute(values):
                for v in values:
                    type_of(v, self.context.scope)
            case t.Read() | t.Clear() | t.Write() | t.WaitUntil():
                check_message(self.context, s)
            case t.Move() | t.Speed() | t.WaitTime() | t.Tool() | t.Measure() | t.Sense():
                check_command(self.context, s)

    def loop(self, body: tuple[t.Statement, ...]) -> None:
        self.loops += 1
        self.block(body)
        self.loops -= 1

    def call(self, procedure: t.Target) -> None:
        if procedure.name in self.context.procedures:
            self.touched.add(procedure.name)
            return
        self.d.error(
            codes.UNKNOWN_NAME,
            f"there is no procedure `{procedure.name}`",
            procedure.span,
            hint=did_you_mean(procedure.name, self.context.procedures),
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
                type_of(datum, self.context.scope)

    def each(self, item: t.Datum) -> None:
        """A list of records: it is made of columns."""
        self.datum(item)
        before = len(self.d.errors)
        columns = tuple(paths.data(item))
        for column in columns:
            found = type_of(column, self.context.scope)
            if len(self.d.errors) == before and found is not None and found not in LISTS:
                self.d.error(
                    codes.TYPE,
                    f"`each` makes records of the items of lists, but this is `{found}`",
                    column.span,
                )
        if not columns:
            self.d.error(codes.TYPE, "`each` has no list", item.span)

    # the whole

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
        used = self.context.scope.used
        for x in self.program.declarations:
            if x.name in used:
                continue
            match x:
                case t.Variable():
                    what = (
                        "assigned but never read"
                        if x.name in self.context.assigned
                        else "never used"
                    )
                    self.d.warning(codes.UNUSED, f"variable `{x.name}` is {what}", x.span)
                case t.Const():
                    self.d.warning(codes.UNUSED, f"constant `{x.name}` is never used", x.span)
                case t.File():
                    self.d.warning(codes.UNUSED, f"file `{x.name}` is never used", x.span)
        for p in self.program.procedures:
            if p.name not in self.touched:
                self.d.warning(codes.UNUSED, f"procedure `{p.name}` is never called", p.span)
