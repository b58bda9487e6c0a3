"""Calls of functions of the prelude."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pn2code.diagnostics import Span
from pn2code.lowering import prelude
from pn2code.lowering.expressions.values import Polymorphic, Val
from pn2code.ml.core.types import Type

if TYPE_CHECKING:
    from pn2code.lowering.expressions.body import Body


def call(body: Body, name: str, t: Type, steps: list[tuple[Val, Type]], at: Span) -> Val:
    """A function of the prelude at a type, applied to its curried arguments (each with the type of the result)."""
    found = body.program.prelude_function(name)
    assert found is not None, name
    _, symbol = found
    value = body.program.global_value(body, symbol, prelude.instance(symbol, t), at)
    assert not isinstance(value, Polymorphic)
    for argument, result in steps:
        value = body.apply(value, argument, prelude.representation(result), at)
    return value
