"""Speeds and durations of commands: those that are known are possible."""

from __future__ import annotations

import math
from collections.abc import Mapping

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span
from pn2code.robot_scripts import codes
from pn2code.robot_scripts.names import Names
from pn2code.robot_scripts.unsupported import UnsupportedError
from pn2code.robot_scripts.values import Scalar, Value, as_quantity, as_real
from pn2code.tdl import tree as t
from pn2code.tdl import types as tdl
from pn2code.tdl.evaluate import ScriptError, ScriptValue, evaluate


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


def speed_of(given: Value, span: Span, names: Names, *, is_linear: bool) -> t.Expression:
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
        known = evaluate(at, _Constants(names.constant_values))
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


def lasting(duration: t.Expression, span: Span, names: Names) -> t.Expression:
    """A duration that is not known to be negative."""
    try:
        known = evaluate(duration, _Constants(names.constant_values))
    except (ScriptError, KeyError):
        return duration
    if isinstance(known, int | float) and known < 0:
        raise UnsupportedError(f"no robot can wait for {known:g} s", span, codes.UNSUPPORTED_TIME)
    return duration
