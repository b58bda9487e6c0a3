"""What is known of a script while it is checked, and what is said where an expression is of another type."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.tdl import codes
from pn2code.tdl import tree as t
from pn2code.tdl.evaluate import ScriptError, ScriptValue, evaluate
from pn2code.tdl.expressions import Scope, type_of
from pn2code.tdl.types import NUMBERS, QUANTITIES, Type, fits


class ConstantsOnly:
    """The environment of a constant's value: the constants that are declared before it."""

    def __init__(self, values: Mapping[str, ScriptValue]) -> None:
        self._values = values

    def value(self, name: str) -> ScriptValue:
        """The value of a constant."""
        if name in self._values:
            return self._values[name]
        raise ScriptError(f"`{name}` is not a constant declared before")

    def filled(self, name: str) -> bool:
        """Never known."""
        raise ScriptError(f"the file `{name}` is not known before the script runs")


@dataclass(slots=True)
class Context:
    """A script while it is checked.

    Args:
        d: gets what is wrong.
        frames: that the cell has, beside `world` and `tool`; None: it is not looked at.
        scope: what names in expressions mean.
        variables, procedures: by name; constants: values by name.
        assigned: the variables that get a value somewhere.
    """

    d: Diagnostics
    frames: Collection[str] | None
    scope: Scope
    variables: dict[str, t.Variable] = field(default_factory=dict)
    constants: dict[str, ScriptValue] = field(default_factory=dict)
    procedures: dict[str, t.Procedure] = field(default_factory=dict)
    assigned: set[str] = field(default_factory=set)

    def known(self, e: t.Expression) -> float | None:
        """The number a well-typed expression is, when constants alone decide it."""
        try:
            value = evaluate(e, ConstantsOnly(self.constants))
        except ScriptError:
            return None
        return float(value) if isinstance(value, int | float) else None

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
        """An expression that must be true or false."""
        self.expect(e, Type.BOOL, "the condition")

    def expect(self, e: t.Expression, wanted: Type, what: str) -> bool:
        """Whether an expression is well-typed and of a type; if not, that is said."""
        before = len(self.d.errors)
        found = type_of(e, self.scope)
        if found is None or fits(found, wanted):
            return len(self.d.errors) == before
        self.d.error(
            type_code(found, wanted),
            f"{what} must be of type `{wanted}`, but this is `{found}`",
            e.span,
            hint=_unit_hint(e, found, wanted),
        )
        return False


def type_code(found: Type, wanted: Type) -> str:
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
