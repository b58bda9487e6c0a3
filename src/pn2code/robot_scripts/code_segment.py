"""The code segment of a transition as statements: commands, and what is computed for them.

A call of a primitive becomes a command, `if` a statement where commands depend on it, a function along a list a loop.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from pn2code.base.frozen import frozen
from pn2code.cell.config import Primitive
from pn2code.cell.partition import OwnerKind
from pn2code.diagnostics import Span
from pn2code.robot_scripts import codes, lists, moves
from pn2code.robot_scripts.assignments import one_after_the_other
from pn2code.robot_scripts.evaluate import Evaluator
from pn2code.robot_scripts.failing import Known, known_where
from pn2code.robot_scripts.ir import Chain, Line, Node, Repeat, own_element
from pn2code.robot_scripts.machine import Machine
from pn2code.robot_scripts.names import Names, of_stem
from pn2code.robot_scripts.operations import item_of, others_of
from pn2code.robot_scripts.quantities import lasting, speed_of
from pn2code.robot_scripts.shapes import ScalarShape
from pn2code.robot_scripts.situation import Situation
from pn2code.robot_scripts.strict import Owed
from pn2code.robot_scripts.unsupported import UnsupportedError
from pn2code.robot_scripts.values import (
    Env,
    Rec,
    Rows,
    Scalar,
    Value,
    as_quantity,
    choose,
    flatten,
    make,
    scalars_in,
    select,
    shape_of_list,
    shape_of_value,
)
from pn2code.tdl import tree as t
from pn2code.tdl import types as tdl
from pn2code.tdl.paths import all_names


@frozen
class Acted:
    """What a code segment does.

    Args:
        nodes: its statements.
        env: the variables of the transition, with the outputs of the code segment.
        has_commands: whether it calls primitives.
    """

    nodes: list[Node]
    env: Env
    has_commands: bool


@dataclass(slots=True)
class CodeSegment:
    """Translates the code segment of a transition.

    Args:
        machine: the program.
        names: of the script.
        primitives: by the names of their functions.
        pure: computes values.
        situation: the transition.
        there: what is known where it has come to.
        taken: variables whose values it still needs.
    """

    machine: Machine
    names: Names
    primitives: Mapping[str, Primitive]
    pure: Evaluator
    situation: Situation
    nodes: list[Node] = field(default_factory=list)
    acts: bool = False
    there: Known = field(init=False)
    taken: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        """What is known where it begins."""
        self.there = known_where(self.names, self.situation.ordered)

    def act(self) -> Acted:
        """The commands, and the environment with the outputs."""
        situation = self.situation
        code = situation.step.transition.code
        asked: list[Node] = [
            Line(t.Sense(sensor, t.Target(name))) for _, sensor, name in situation.sensed
        ]
        if code is None:
            return Acted(asked, situation.env, False)
        output = code.outputs[0].name if len(code.outputs) == 1 else "measured"
        self.taken = all_names(x.exp for v in situation.env.values() for x in scalars_in(v))
        evaluator = Evaluator(
            self.pure.program,
            self.pure.primitives,
            self.names.constant,
            perform=lambda name, argument, span: self._perform(name, argument, span, output),
            branch=self._branch,
            owe=self._owe,
            each=self._each,
            fold=lambda of, start, act: self._fold(of, start, act, code.action.span),
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
            return Acted([*asked, *self.nodes], env, self.acts)
        return Acted([*self.nodes, *asked], env, self.acts)

    def _owe(self, owed: Owed) -> None:
        """A computation of the code segment."""
        if self.there.fails_itself(owed.exp):
            self.nodes.append(Line(t.Compute((owed.exp,))))

    def _branch(
        self, test: t.Expression, a: Callable[[], Value], b: Callable[[], Value], span: Span
    ) -> Value:
        """`if` in a code segment: a statement when commands depend on it, else an expression."""
        before = self.nodes
        then: list[Node] = []
        otherwise: list[Node] = []
        there, taken = self.there, self.taken
        self.nodes, self.there = then, there.with_condition(test)
        first = a()
        after_first, self.taken = self.taken, taken
        self.nodes, self.there = otherwise, there.with_condition(test, False)
        second = b()
        self.nodes, self.there = before, there
        self.taken = self.taken | after_first
        if then or otherwise:
            self.nodes.append(Chain(((test, tuple(then)),), tuple(otherwise) or None))
        return choose(test, first, second, span)

    def _fold(
        self,
        of: Scalar | Rows,
        start: Value,
        act: Callable[[Value, Value], Value],
        span: Span,
    ) -> Value:
        """What comes of a value and the items of a list: a loop that keeps it in variables."""
        shape = shape_of_value(start)
        if shape is None:
            raise UnsupportedError("such a value cannot be kept in a robot script", span)
        element = own_element(self.situation.step.transition)
        names = self.names.shared(of_stem("so_far", shape), shape, element, self.taken)
        self.taken = self.taken | set(names)
        so_far = make(shape, iter(names))
        for name, scalar in zip(names, flatten(start, shape, span), strict=True):
            self.nodes.append(Line(t.Assign(t.Target(name), scalar.exp)))

        def one(item: Value) -> Value:
            found = flatten(act(item, so_far), shape, span)
            new = list(zip(names, (x.exp for x in found), strict=True))
            self.nodes += one_after_the_other(new, self.names, self.situation.step)
            return Rec(())

        self._each(of, one)
        return so_far

    def _each(self, of: Scalar | Rows, act: Callable[[Value], Value]) -> None:
        """Commands for each item of a list: a loop along a copy of it."""
        element = own_element(self.situation.step.transition)
        shape = shape_of_list(of)
        names = self.names.shared(of_stem("todo", shape), shape, element, self.taken)
        self.taken = self.taken | set(names)
        todo = make(shape, iter(names))
        assert isinstance(todo, Scalar | Rows)
        for name, scalar in zip(names, scalars_in(of), strict=True):
            self.nodes.append(Line(t.Assign(t.Target(name), scalar.exp)))
        before, there, body = self.nodes, self.there, list[Node]()
        test = lists.has_items(scalars_in(todo)[0].exp)
        self.nodes, self.there = body, there.with_condition(test)
        act(item_of(todo))
        self.nodes, self.there = before, there
        for name, scalar in zip(names, scalars_in(others_of(todo)), strict=True):
            body.append(Line(t.Assign(t.Target(name), scalar.exp)))
        self.nodes.append(Repeat(test, tuple(body)))

    def _perform(self, name: str, argument: Value, span: Span, output: str) -> Value:
        primitive = self.primitives[name]
        self.acts = True
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
            self.nodes += [Line(m) for m in self._moves(primitive, argument, span)]
        elif command == "measure":
            nominal = moves.pose(argument, name, span)
            element = own_element(self.situation.step.transition)
            (target,) = self.names.shared([output], ScalarShape(tdl.Type.POSE), element, self.taken)
            self.taken = self.taken | {target}
            self.nodes.append(Line(t.Measure(nominal, t.Target(target))))
            return Scalar(t.Name(target), tdl.Type.POSE)
        elif command == "tool":
            duration = t.Quantity(primitive.duration_s, "s")
            self.nodes.append(Line(t.Tool(primitive.action, duration, handling)))
        else:
            if argument == Rec(()):
                duration_exp: t.Expression = t.Quantity(primitive.duration_s, "s")
            elif isinstance(argument, Scalar) and argument.type in tdl.NUMBERS:
                duration_exp = lasting(as_quantity(argument, tdl.Type.TIME).exp, span, self.names)
            else:
                raise UnsupportedError(f"`{name}` takes a number of seconds", span, codes.PRIMITIVE)
            self.nodes.append(Line(t.WaitTime(duration_exp)))
        return Rec(())

    def _moves(self, primitive: Primitive, argument: Value, span: Span) -> list[t.Move]:
        """What a call of a primitive that moves the arm makes it do."""
        at: t.Expression | None = None
        places, positions, speed = moves.parts_of(primitive, argument)
        if primitive.speed is not None:
            at = t.Quantity(primitive.speed, "mm/s" if primitive.is_linear else "%")
        elif speed is not None:
            at = speed_of(speed, span, self.names, is_linear=primitive.is_linear)
        return moves.of(primitive, places, positions, at, span)
