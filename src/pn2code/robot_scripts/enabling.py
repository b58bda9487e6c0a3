"""When a transition of a robot is enabled, in the words of a script: what its variables mean, and what is asked.

A variable that nothing in the net decides is one that a sensor decides.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set
from dataclasses import field

from pn2code.base.frozen import record
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import BindAll, BindEquation, BindRandom
from pn2code.robot_scripts import codes, membership
from pn2code.robot_scripts.conditions import Asked, Order
from pn2code.robot_scripts.evaluate import Evaluator
from pn2code.robot_scripts.failing import known_where
from pn2code.robot_scripts.ir import own_element
from pn2code.robot_scripts.machine import Machine, Step
from pn2code.robot_scripts.names import Names, identifier
from pn2code.robot_scripts.operations import equal
from pn2code.robot_scripts.shapes import ScalarShape, shape_of_colset
from pn2code.robot_scripts.situation import Situation
from pn2code.robot_scripts.unsupported import UnsupportedError
from pn2code.robot_scripts.values import FALSE, Env, Scalar, Value, scalars_in
from pn2code.tdl import tree as t
from pn2code.tdl import types as tdl
from pn2code.tdl.paths import all_names


@record
class Enabling:
    """Binds the variables of transitions.

    Args:
        machine: the program.
        names: of the script.
        pure: computes values.
        sensors: net variable -> the sensor that decides it.
        storage: how colour sets are stored.
    """

    machine: Machine
    names: Names
    pure: Evaluator
    sensors: Mapping[str, str] = field(default_factory=dict)
    storage: Mapping[str, str] = field(default_factory=dict)

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
                step.span,
                codes.UNSUPPORTED_PROGRAM,
            )
        ordered = [*control, *variables, *messages]
        sensed: list[tuple[Symbol, str, str]] = []
        avoid = {n for p, *_ in ordered for n in all_names(x.exp for x in scalars_in(values[p]))}
        order = Order(transition, self.pure.program)
        asked = Asked(known_where(self.names))
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
                    step.span,
                    codes.UNSUPPORTED_PROGRAM,
                )
        local, remote = split(conditions, received, self.names)
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

    def _sensor(self, symbol: Symbol, step: Step, avoid: set[str]) -> tuple[str, str, ScalarShape]:
        """The sensor that decides a free variable, the script's variable for it, and its type."""
        sensor = self.sensors.get(symbol.name)
        if sensor is None:
            raise UnsupportedError(
                f"nothing decides the value of `{symbol.name}`: a script cannot choose freely; if a sensor "
                f"decides it, add `[sensors.{symbol.name}]` to cell.toml",
                step.span,
                codes.UNSUPPORTED_PROGRAM,
            )
        assert symbol.colset is not None
        shape = shape_of_colset(symbol.colset, self.pure.program, self.storage)
        if not isinstance(shape, ScalarShape) or shape.type in {tdl.Type.POSE, *tdl.LISTS}:
            raise UnsupportedError(
                f"sensor `{sensor}` decides `{symbol.name}` of colour set `{symbol.colset.name}`, but a "
                "sensor gives one number, truth value or text",
                step.span,
                codes.UNSUPPORTED_COLSET,
            )
        element = own_element(step.transition)
        (name,) = self.names.shared([identifier(symbol.name)], shape, element, avoid)
        return sensor, name, shape


def split(
    conditions: Iterable[t.Expression], late: Set[str], names: Names
) -> tuple[tuple[t.Expression, ...], tuple[t.Expression, ...]]:
    """Conditions that can be asked before some variables have their values, and the others.

    One that may fail is asked only when all before it hold.
    """
    early: list[t.Expression] = []
    rest: list[t.Expression] = []
    known = known_where(names)
    for c in conditions:
        is_late = bool(all_names([c]) & late) or (bool(rest) and (known.fails(c) or c == FALSE))
        (rest if is_late else early).append(c)
        known = known.with_condition(c)
    return tuple(early), tuple(rest)
