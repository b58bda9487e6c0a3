"""One transition of a robot as script statements: wait, read, act, mark, consume, publish, remember.

    wait until filled(dadosrobo1)
    read dadosrobo1 into p
    move $joint p
    mark Top.Robot1.MoveJoint with k = k, p = p
    clear dadosrobo1

The transition occurs at the end of its action, at one instant: its mark, the emptying of the files it
takes from and the messages it puts follow each other without time passing. The mark comes first, so that
in a merged trace the cause stands before its effects.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from dataclasses import dataclass, field

from pn2code.base.frozen import frozen
from pn2code.cell.config import Primitive
from pn2code.cell.partition import OwnerKind
from pn2code.diagnostics import Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import ArcKind, BindAll, BindEquation, BindRandom
from pn2code.robot_scripts import codes as codes
from pn2code.robot_scripts import lists, membership, moves, unread
from pn2code.robot_scripts.assignments import one_after_the_other
from pn2code.robot_scripts.conditions import Asked, Order
from pn2code.robot_scripts.evaluate import Evaluator
from pn2code.robot_scripts.failing import Known
from pn2code.robot_scripts.illegal_tokens import stops
from pn2code.robot_scripts.ir import Chain, Comment, Element, Line, Node, Repeat, titled
from pn2code.robot_scripts.machine import Machine, Outcome, Step, delayed_tokens
from pn2code.robot_scripts.names import Names, identifier, of_stem
from pn2code.robot_scripts.not_a_number import may_be_nan
from pn2code.robot_scripts.operations import equal, item_of, others_of
from pn2code.robot_scripts.rounding import rounded
from pn2code.robot_scripts.situation import Situation
from pn2code.robot_scripts.strict import Owed, Path, open_of, statements, without_repetition
from pn2code.robot_scripts.values import (
    FALSE,
    Closure,
    Env,
    Fields,
    Rec,
    Rows,
    Scalar,
    ScalarShape,
    Shape,
    UnsupportedError,
    Value,
    as_quantity,
    as_real,
    choose,
    flatten,
    make,
    scalars_in,
    select,
    shape_of_colset,
    shape_of_list,
    shape_of_value,
)
from pn2code.robot_scripts.values import Primitive as PrimitiveValue
from pn2code.tdl import tree as t
from pn2code.tdl import types as tdl
from pn2code.tdl.evaluate import ScriptError, ScriptValue, evaluate
from pn2code.tdl.paths import all_names, expressions_of


@frozen
class _Constants:
    """What names mean where only the script's constants are known."""

    values: Mapping[str, ScriptValue]

    def value(self, name: str) -> ScriptValue:
        """The value of a constant; KeyError: it is none."""
        return self.values[name]

    def filled(self, name: str) -> bool:
        """No file is known."""
        raise KeyError(name)


@dataclass(slots=True)
class StepTranslator:
    """Translates transitions.

    Args:
        place_names: the variables of a local place, in order of its scalars.
        shapes: shapes of places.
        file_names: names of the files of channel places.
        sensors: net variable -> the sensor that decides it.
    """

    machine: Machine
    names: Names
    primitives: Mapping[str, Primitive]
    pure: Evaluator
    place_names: dict[int, list[str]]
    shapes: dict[int, Shape]
    file_names: dict[int, str]
    sensors: Mapping[str, str] = field(default_factory=dict)
    storage: Mapping[str, str] = field(default_factory=dict)
    _nodes: list[Node] = field(default_factory=list)
    _acts: bool = False
    """whether the transition at hand carries out commands"""
    _there: Known = field(init=False)
    """what is known where the code segment at hand has come to"""
    _taken: set[str] = field(default_factory=set)
    """variables whose values it still needs"""

    def __post_init__(self) -> None:
        self._there = self.known()

    # enabling

    def situation(self, step: Step, values: Mapping[int, Value]) -> Situation:
        """Bind the variables of a transition; `values`: the token of each place it takes from."""
        transition = step.transition
        env: Env = {}
        control = [x for x in step.takes if x[0] in self.machine.control]
        variables = [x for x in step.takes if x[0] in self.machine.variables]
        messages = [x for x in step.takes if x[0] in self.machine.channels]
        if len({p for p, *_ in messages}) < len(messages):
            raise UnsupportedError(
                f"transition `{transition.short}` takes two messages from one file at a time",
                _whole(step),
                codes.UNSUPPORTED_PROGRAM,
            )
        ordered = [*control, *variables, *messages]
        sensed: list[tuple[Symbol, str, str]] = []
        avoid = {n for p, *_ in ordered for n in all_names(x.exp for x in scalars_in(values[p]))}
        order = Order(transition, self.pure.program)
        asked = Asked(self.known())
        for place, term, arc, index in ordered:
            if term.pattern is not None:
                at = order.of_pattern(arc, index)
                colset = self.machine.net.places[place].colset
                asked.add(at, self._matched(term.pattern, values[place], env, colset))
        for i, bind in enumerate(transition.plan):
            if isinstance(bind, BindEquation):
                value, owed = self.pure.owing(bind.value, env)
                given = bind.value.symbol.colset if isinstance(bind.value, core.Var) else None
                asked.add(
                    order.of_equation(i), self._matched(bind.pattern, value, env, given), owed
                )
            elif isinstance(bind, BindAll | BindRandom) and bind.symbol.uid not in env:
                sensor, name, scalar = self._sensor(bind.symbol, step, avoid)
                avoid.add(name)
                sensed.append((bind.symbol, sensor, name))
                env[bind.symbol.uid] = Scalar(t.Name(name), scalar.type)
        for place, term, arc, _ in ordered:
            if term.pattern is None:
                value, owed = self.pure.owing(term.value, env)
                same = equal(value, values[place], term.value.span)
                asked.add(order.of_value(arc, term), [same], owed)
        for i, guard in enumerate(transition.guards):
            value, owed = self.pure.owing(guard, env)
            assert isinstance(value, Scalar)
            asked.add(order.of_guard(i), [value.exp], owed)
        received = {
            name for p, *_ in messages for name in all_names(x.exp for x in scalars_in(values[p]))
        }
        conditions = asked.conditions()
        for symbol, sensor, name in sensed:
            if name in all_names(conditions):
                raise UnsupportedError(
                    f"whether `{transition.short}` is enabled depends on `{symbol.name}`, which sensor "
                    f"`{sensor}` decides while it occurs: let one transition put `{symbol.name}` into a "
                    "place, and decide in the next",
                    _whole(step),
                    codes.UNSUPPORTED_PROGRAM,
                )
        local, remote = self.split(conditions, received)
        return Situation(
            step,
            env,
            tuple(p for p, *_ in messages),
            local,
            remote,
            conditions,
            tuple(sensed),
        )

    def _matched(
        self, pattern: core.Pat, value: Value, env: Env, colset: Colset | None
    ) -> list[t.Expression]:
        """Conditions of a match, which binds variables; `colset`: that of the value, None: it is not known."""
        before = set(env)
        found = self.pure.match(pattern, value, env)
        for symbol, source in membership.of_pattern(pattern, colset):
            if symbol.uid not in before:
                found += membership.conditions(symbol, env[symbol.uid], source, pattern.span)
        return found

    def known(self, conditions: Iterable[t.Expression] = ()) -> Known:
        """What is known of numbers where some conditions hold."""
        names = self.names  # who knows it may be kept by this object
        found = Known(names.constant_values, lambda e: may_be_nan(e, names), {})
        for c in conditions:
            found = found.with_condition(c)
        return found

    def split(
        self, conditions: Iterable[t.Expression], late: Set[str]
    ) -> tuple[tuple[t.Expression, ...], tuple[t.Expression, ...]]:
        """Conditions that can be asked before some variables have their values, and the others.

        One that may fail is asked only when all before it hold.
        """
        early: list[t.Expression] = []
        rest: list[t.Expression] = []
        known = self.known()
        for c in conditions:
            is_late = bool(all_names([c]) & late) or (bool(rest) and (known.fails(c) or c == FALSE))
            (rest if is_late else early).append(c)
            known = known.with_condition(c)
        return tuple(early), tuple(rest)

    def _sensor(self, symbol: Symbol, step: Step, avoid: set[str]) -> tuple[str, str, ScalarShape]:
        """The sensor that decides a free variable, the script's variable for it, and its type."""
        sensor = self.sensors.get(symbol.name)
        if sensor is None:
            raise UnsupportedError(
                f"nothing decides the value of `{symbol.name}`: a script cannot choose freely; if a sensor "
                f"decides it, add `[sensors.{symbol.name}]` to cell.toml",
                _whole(step),
                codes.UNSUPPORTED_PROGRAM,
            )
        assert symbol.colset is not None
        shape = shape_of_colset(symbol.colset, self.pure.program, self.storage)
        if not isinstance(shape, ScalarShape) or shape.type in {tdl.Type.POSE, *tdl.LISTS}:
            raise UnsupportedError(
                f"sensor `{sensor}` decides `{symbol.name}` of colour set `{symbol.colset.name}`, but a "
                "sensor gives one number, truth value or text",
                _whole(step),
                codes.UNSUPPORTED_COLSET,
            )
        transition = step.transition
        element = Element(
            transition.name,
            "transition",
            transition.origin,
            f"transition {titled(transition)}",
        )
        (name,) = self.names.shared([identifier(symbol.name)], shape, element, avoid)
        return sensor, name, shape

    # occurrence

    def act(self, situation: Situation) -> tuple[list[Node], Env]:
        """The commands of the code segment, and the environment with its outputs."""
        code = situation.step.transition.code
        asked: list[Node] = [
            Line(t.Sense(sensor, t.Target(name))) for _, sensor, name in situation.sensed
        ]
        self._acts = False
        if code is None:
            return asked, situation.env
        self._nodes = []
        self._there = self.known(situation.ordered)
        output = code.outputs[0].name if len(code.outputs) == 1 else "measured"
        self._taken = all_names(x.exp for v in situation.env.values() for x in scalars_in(v))
        evaluator = Evaluator(
            self.pure.program,
            self.pure.primitives,
            self.names.constant,
            perform=lambda name, argument, span: self._perform(
                name, argument, span, output, situation
            ),
            branch=self._branch,
            owe=self._owe,
            each=lambda of, act: self._each(of, act, situation),
            fold=lambda of, start, act: self._fold(of, start, act, situation, code.action.span),
        )
        result = evaluator.evaluate(code.action, situation.env)
        env = dict(situation.env)
        if len(code.outputs) == 1:
            env[code.outputs[0].uid] = result
        else:
            for i, symbol in enumerate(code.outputs, 1):
                env[symbol.uid] = select(result, str(i), code.action.span)
        # A sensor is asked as late as it can be: after what the robot does, unless that depends on it.
        if any(s in code.inputs for s, _, _ in situation.sensed):
            return [*asked, *self._nodes], env
        return [*self._nodes, *asked], env

    def _owe(self, owed: Owed) -> None:
        """A computation of the code segment."""
        if self._there.fails_itself(owed.exp):
            self._nodes.append(Line(t.Compute((owed.exp,))))

    def _branch(
        self, test: t.Expression, a: Callable[[], Value], b: Callable[[], Value], span: Span
    ) -> Value:
        """`if` in a code segment: a statement when commands depend on it, else an expression."""
        before = self._nodes
        then: list[Node] = []
        otherwise: list[Node] = []
        there, taken = self._there, self._taken
        self._nodes, self._there = then, there.with_condition(test)
        first = a()
        after_first, self._taken = self._taken, taken
        self._nodes, self._there = otherwise, there.with_condition(test, False)
        second = b()
        self._nodes, self._there = before, there
        self._taken = self._taken | after_first
        if then or otherwise:
            self._nodes.append(Chain(((test, tuple(then)),), tuple(otherwise) or None))
        return choose(test, first, second, span)

    def _fold(
        self,
        of: Scalar | Rows,
        start: Value,
        act: Callable[[Value, Value], Value],
        situation: Situation,
        span: Span,
    ) -> Value:
        """What comes of a value and the items of a list: a loop that keeps it in variables."""
        shape = shape_of_value(start)
        if shape is None:
            raise UnsupportedError("such a value cannot be kept in a robot script", span)
        element = _element(situation)
        names = self.names.shared(of_stem("so_far", shape), shape, element, self._taken)
        self._taken = self._taken | set(names)
        so_far = make(shape, iter(names))
        for name, scalar in zip(names, flatten(start, shape, span), strict=True):
            self._nodes.append(Line(t.Assign(t.Target(name), scalar.exp)))

        def one(item: Value) -> Value:
            found = flatten(act(item, so_far), shape, span)
            new = list(zip(names, (x.exp for x in found), strict=True))
            self._nodes += one_after_the_other(new, self.names, situation.step)
            return Rec(())

        self._each(of, one, situation)
        return so_far

    def _each(self, of: Scalar | Rows, act: Callable[[Value], Value], situation: Situation) -> None:
        """Commands for each item of a list: a loop along a copy of it."""
        element = _element(situation)
        shape = shape_of_list(of)
        names = self.names.shared(of_stem("todo", shape), shape, element, self._taken)
        self._taken = self._taken | set(names)
        todo = make(shape, iter(names))
        assert isinstance(todo, Scalar | Rows)
        for name, scalar in zip(names, scalars_in(of), strict=True):
            self._nodes.append(Line(t.Assign(t.Target(name), scalar.exp)))
        before, there, body = self._nodes, self._there, list[Node]()
        test = lists.has_items(scalars_in(todo)[0].exp)
        self._nodes, self._there = body, there.with_condition(test)
        act(item_of(todo))
        self._nodes, self._there = before, there
        for name, scalar in zip(names, scalars_in(others_of(todo)), strict=True):
            body.append(Line(t.Assign(t.Target(name), scalar.exp)))
        self._nodes.append(Repeat(test, tuple(body)))

    def _perform(self, name: str, argument: Value, span: Span, output: str, s: Situation) -> Value:
        primitive = self.primitives[name]
        self._acts = True
        command = primitive.command
        is_device = self.machine.owner.kind is OwnerKind.DEVICE
        if is_device and command not in ("tool", "wait", "move_external"):
            raise UnsupportedError(
                f"`{name}` is a `{command}`, but device `{self.machine.owner.name}` has no arm",
                span,
                codes.PRIMITIVE,
            )
        handling = primitive.handling
        if (
            self.machine.owner.kind is OwnerKind.DEVICE
            and handling
            and handling.effect not in ("creates", "removes")
        ):
            what = "a tool" if handling.is_of_tool else "a part"
            raise UnsupportedError(
                f"`{name}` {handling.effect} {what}, but device `{self.machine.owner.name}` has no arm",
                span,
                codes.PRIMITIVE,
            )
        if command.startswith("move_"):
            self._nodes += [Line(m) for m in self._moves(primitive, argument, span)]
        elif command == "measure":
            nominal = moves.pose(argument, name, span)
            transition = s.step.transition
            element = Element(
                transition.name,
                "transition",
                transition.origin,
                f"transition {titled(transition)}",
            )
            (target,) = self.names.shared(
                [output], ScalarShape(tdl.Type.POSE), element, self._taken
            )
            self._taken = self._taken | {target}
            self._nodes.append(Line(t.Measure(nominal, t.Target(target))))
            return Scalar(t.Name(target), tdl.Type.POSE)
        elif command == "tool":
            duration = t.Quantity(primitive.duration_s, "s")
            self._nodes.append(Line(t.Tool(primitive.action, duration, handling)))
        else:
            if argument == Rec(()):
                duration_exp: t.Expression = t.Quantity(primitive.duration_s, "s")
            elif isinstance(argument, Scalar) and argument.type in tdl.NUMBERS:
                duration_exp = self._lasting(as_quantity(argument, tdl.Type.TIME).exp, span)
            else:
                raise UnsupportedError(f"`{name}` takes a number of seconds", span, codes.PRIMITIVE)
            self._nodes.append(Line(t.WaitTime(duration_exp)))
        return Rec(())

    def _moves(self, primitive: Primitive, argument: Value, span: Span) -> list[t.Move]:
        """What a call of a primitive that moves the arm makes it do."""
        at: t.Expression | None = None
        places, positions, speed = moves.parts_of(primitive, argument)
        if primitive.speed is not None:
            at = t.Quantity(primitive.speed, "mm/s" if primitive.is_linear else "%")
        elif speed is not None:
            at = self._speed(speed, span, is_linear=primitive.is_linear)
        return moves.of(primitive, places, positions, at, span)

    def _speed(self, given: Value, span: Span, *, is_linear: bool) -> t.Expression:
        """The speed that a function takes beside the pose; one that is known is possible."""
        assert isinstance(given, Scalar), "the cell has been checked"
        if is_linear:
            at, most, unit = as_quantity(given, tdl.Type.SPEED).exp, math.inf, "mm/s"
        else:
            percent = as_real(given).exp
            at, most, unit = t.Binary("*", percent, t.Quantity(1.0, "%")), 1.0, ""
            if isinstance(percent, t.Value) and isinstance(percent.value, int | float):
                at = t.Quantity(float(percent.value), "%")
        try:
            known = evaluate(at, _Constants(self.names.constant_values))
        except (ScriptError, KeyError):
            return at
        if isinstance(known, int | float) and not 0 < known <= most:
            shown = f"{known:g} {unit}" if unit else f"{100 * known:g} %"
            raise UnsupportedError(
                f"no robot can move at {shown}: a speed is above zero"
                + (", and at most 100 %" if most == 1.0 else ""),
                span,
                codes.PRIMITIVE,
            )
        return at

    def _lasting(self, duration: t.Expression, span: Span) -> t.Expression:
        """A duration that is not known to be negative."""
        try:
            known = evaluate(duration, _Constants(self.names.constant_values))
        except (ScriptError, KeyError):
            return duration
        if isinstance(known, int | float) and known < 0:
            raise UnsupportedError(
                f"no robot can wait for {known:g} s", span, codes.UNSUPPORTED_TIME
            )
        return duration

    def occur(self, situation: Situation, acts: Sequence[Node], env: Env) -> list[Node]:
        """What the transition does, the mark, and the emptying of files.

        Args:
            situation: the transition.
            acts: the commands of its code segment.
            env: with the outputs of that.
        """
        transition = situation.step.transition
        binding = tuple(
            (v.name, self.datum(env[v.uid], v.colset, _whole(situation.step)))
            for v in transition.variables
        )
        mark = t.Mark(transition.name, binding)
        outputs = statements(
            open_of(self._outputs(situation, env), None, self.known(situation.ordered))
        )
        outputs += stops(self.machine, self.pure, situation, env, self.known, self._way)
        out = without_repetition([*acts, *outputs], situation.ordered, expressions_of(mark))
        out.append(Line(mark))
        out += [Line(t.Clear(t.Target(self.file_names[p]))) for p in situation.channels]
        return out

    def _outputs(self, situation: Situation, env: Env) -> list[Owed]:
        """What CPN ML computes for the tokens that are put: if it fails, the transition does not occur."""
        out: list[Owed] = []
        transition = situation.step.transition
        for arc in transition.arcs:
            if arc.kind not in (ArcKind.OUTPUT, ArcKind.BOTH) or arc.inscription is None:
                continue
            inscription, program = arc.inscription, self.machine.net.program
            found = delayed_tokens(inscription.value, inscription.form, program)
            is_seen = arc.place not in self.machine.sinks and self.shapes[arc.place] != Fields(())
            for conditions, values, delay in found:
                try:
                    place = self.shapes.get(arc.place)
                    out += self._of_alternative(conditions, [*(values or ()), delay], env, place)
                except UnsupportedError as problem:
                    computed = [
                        *(c for c, _ in conditions),
                        *(values or ()),
                        *([delay] if delay else ()),
                    ]
                    if is_seen or values is None:
                        raise
                    if not all(self._is_sure(e, situation, env) for e in computed):
                        raise unread.refused(self.machine.net.places[arc.place], problem) from None
        if transition.delay is not None:
            out += self.pure.owing(transition.delay, env)[1]
        return out

    def _is_sure(self, e: core.Exp, situation: Situation, env: Env) -> bool:
        """Whether the net surely has a value for what a script does not compute."""
        code = situation.step.transition.code
        results = {v.uid for v in code.outputs} if code else set()
        variables = situation.step.transition.variables
        taken = {v.uid for v in variables} - results
        known = self.known(situation.ordered).with_colours(variables, taken, env)

        def plain(part: core.Exp) -> bool:
            try:
                value, owed = self.pure.owing(part, env)
            except UnsupportedError:
                return False
            return not open_of(owed, None, known) and not any(
                known.fails(x.exp) for x in scalars_in(value)
            )

        return unread.is_sure(e, self.pure.functions, plain)

    def _of_alternative(
        self,
        conditions: Iterable[tuple[core.Exp, bool]],
        values: Iterable[core.Exp | None],
        env: Env,
        shape: Shape | None,
    ) -> list[Owed]:
        """What is computed for some of the ways in which an inscription turns out, for a place of that shape."""
        path, out = self._way(conditions, env)
        if path is not None:
            for e in values:
                if e is not None:
                    value, owed = self.pure.owing(e, env, path)
                    out += owed
                    if shape is not None:
                        out += [Owed(path, x) for x in rounded(value, shape, self.names)]
        return out

    def _way(
        self, conditions: Iterable[tuple[core.Exp, bool]], env: Env
    ) -> tuple[Path | None, list[Owed]]:
        """Where an inscription turns out in some way (None: never), and what is computed to ask that."""
        out: list[Owed] = []
        path: Path = ()
        for condition, holds in conditions:
            value, owed = self.pure.owing(condition, env, path)
            out += owed
            assert isinstance(value, Scalar)
            if isinstance(value.exp, t.Value):
                if value.exp.value is not holds:
                    return None, out
                continue
            path = (*path, (value.exp, holds))
        return path, out

    def datum(self, value: Value, colset: Colset | None, span: Span) -> t.Datum:
        """A value as traces write it: records with their fields in declared order."""
        c = colset.whole if colset is not None else None
        parts = dict(zip(c.labels, c.components, strict=True)) if c is not None and c.labels else {}
        match value:
            case Scalar(exp, tdl.Type.POSE):
                if not parts or tuple(parts) == tuple(tdl.POSE_FIELDS):
                    return exp
                return t.RecordDatum(
                    tuple((x, self.datum(select(value, x, span), None, span)) for x in parts)
                )
            case Scalar(exp):
                return exp
            case Rec(()):
                return t.NullDatum()
            case Rec(fields):
                if parts:
                    return t.RecordDatum(
                        tuple((x, self.datum(value.get(x), parts[x], span)) for x in parts)
                    )
                components = (
                    c.components
                    if c is not None and c.kind is Kind.PRODUCT
                    else (None,) * len(fields)
                )
                return t.TupleDatum(
                    tuple(
                        self.datum(v, part, span)
                        for (_, v), part in zip(fields, components, strict=True)
                    )
                )
            case Rows(columns):
                is_list = c is not None and c.kind is Kind.LIST
                return t.EachDatum(
                    self.datum(columns, c.components[0] if is_list and c else None, span)
                )
            case Closure() | PrimitiveValue():
                raise UnsupportedError("a function is no value of a net variable", span)

    def put(self, situation: Situation, outcome: Outcome, env: Env) -> list[Node]:
        """The messages written, data before flags, and the variables that remember the new tokens."""
        writes: list[tuple[int, Node]] = []
        assignments: list[tuple[str, t.Expression]] = []
        order = {c: i for i, c in enumerate(self.machine.channels)}
        for place, exp in outcome.puts:
            if place in self.machine.sinks:
                continue
            shape = self.shapes[place]
            value = self.pure.evaluate(exp, env) if shape != Fields(()) else Rec(())
            scalars = flatten(value, shape, exp.span)
            if place in self.machine.channels:
                target = t.Target(self.file_names[place])
                line = Line(t.Write(target, tuple(x.exp for x in scalars)))
                writes.append((order[place], line))
            else:
                names = self.place_names[place]
                assignments += zip(names, (x.exp for x in scalars), strict=True)
        writes.sort(key=lambda w: w[0])
        waits = self._wait(situation, outcome, env)
        return [
            *(w for _, w in writes),
            *waits,
            *one_after_the_other(assignments, self.names, situation.step),
        ]

    def _wait(self, situation: Situation, outcome: Outcome, env: Env) -> list[Node]:
        """The delay of the control token. Model time is in seconds."""
        place = self.machine.target(outcome)
        transition = situation.step.transition
        flat = self.machine.net.places[place]
        if not flat.colset.timed:
            if transition.delay is not None:
                raise UnsupportedError(
                    f"transition `{transition.short}` has a delay, but `{flat.short}`, where the program "
                    "goes, has no time stamps",
                    transition.delay.span,
                    codes.UNSUPPORTED_TIME,
                    f"give `{flat.short}` a timed colour set, such as "
                    f"`colset {flat.colset.name}_TIMED = {flat.colset.name} timed;`",
                )
            return []
        own = [] if transition.delay is None else [transition.delay]
        out: list[Node] = []
        for delay in [*own, *(e for p, e in outcome.delays if p == place)]:
            value = self.pure.evaluate(delay, env)
            if not (isinstance(value, Scalar) and value.type in tdl.NUMBERS | {tdl.Type.TIME}):
                raise UnsupportedError("this delay is not a number", delay.span)
            if value.exp in (t.Value(0), t.Value(0.0)):
                continue
            wait = self._lasting(as_quantity(value, tdl.Type.TIME).exp, delay.span)
            out.append(Line(t.WaitTime(wait)))
        if out and self._acts:
            raise UnsupportedError(
                f"transition `{transition.short}` has both commands and a delay",
                _whole(situation.step),
                codes.UNSUPPORTED_TIME,
            )
        return out


def _element(situation: Situation) -> Element:
    """For variables of a transition's own."""
    transition = situation.step.transition
    phrase = f"transition {titled(transition)}"
    return Element(transition.name, "transition", transition.origin, phrase)


def _whole(step: Step) -> Span:
    """A span for messages about the transition as a whole."""
    for _, term, _, _ in step.takes:
        return term.value.span
    raise AssertionError("a step takes at least the control token")


def header(step: Step, machine: Machine) -> Comment:
    """The comment before a transition's statements: its name, id, and where control goes."""
    places = machine.net.places
    source = next(p for p, *_ in step.takes if p in machine.control)
    targets = dict.fromkeys(places[machine.target(o)].short for o in step.outcomes)
    transition = step.transition
    return Comment(f"{titled(transition)}: {places[source].short} -> {' or '.join(targets)}")
