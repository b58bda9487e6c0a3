"""The types of expressions, with everything that can be wrong about them."""

from __future__ import annotations

from dataclasses import field
from typing import Final, assert_never

from pn2code.base.frozen import record
from pn2code.diagnostics import Diagnostics, Span
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.tdl import codes
from pn2code.tdl import tree as t
from pn2code.tdl.types import (
    BASE_UNIT,
    ELEMENT,
    LISTS,
    NUMBERS,
    POSE_FIELDS,
    QUANTITIES,
    TYPES_BY_NAME,
    UNITS,
    Type,
    fits,
    product,
    quotient,
)

FUNCTIONS: Final[dict[str, int]] = {
    "abs": 1, "min": 2, "max": 2, "floor": 1, "ceil": 1, "round": 1, "trunc": 1, "sqrt": 1,
    "real": 1, "sin": 1, "cos": 1, "tan": 1, "text": 1, "single": 1, "filled": 1, "pose": 6, "before": 2,
    "computed": 1, "count_of": 1, "first_of": 1, "rest_of": 1, "item_of": 2, "with_first": 2, "joined": 2,
    "reversed": 1,
}  # fmt: skip
"""Built-in functions and their numbers of arguments; those that make lists, which have any number, are not among them.
"""

MAKES: Final[dict[str, Type]] = {of.value: of for of in LISTS - {Type.WORDS}}
"""Functions that make lists: `ints(1, 2, 3)`."""

RESERVED: Final = frozenset(FUNCTIONS) | frozenset(TYPES_BY_NAME) | {"world"}


@record
class Scope:
    """What is declared.

    Args:
        values: types of variables and constants.
        files: files by name.
        used: names whose value or file something uses.
    """

    values: dict[str, Type]
    files: dict[str, t.File]
    d: Diagnostics
    used: set[str] = field(default_factory=set)

    def file(self, name: str, span: Span, direction: t.Direction, verb: str) -> t.File | None:
        """A declared file of the right direction; reports what is wrong."""
        found = self.files.get(name)
        if found is None:
            self.d.error(
                codes.UNKNOWN_FILE,
                f"file `{name}` is not declared",
                span,
                hint=did_you_mean(
                    name,
                    self.files,
                    f'declare it: `{direction.value} {name} "{name}.robcad" : int`',
                ),
            )
            return None
        self.used.add(name)
        if found.direction is not direction:
            role = "writes" if found.direction is t.Direction.OUTPUT else "reads"
            self.d.error(
                codes.FILE_DIRECTION,
                f"file `{name}` cannot be {verb}: it is an `{found.direction.value}` file, which this script {role}",
                span,
                hint="a file has one writer and one reader",
            )
            return None
        return found


def type_of(e: t.Expression, scope: Scope) -> Type | None:
    """The type of an expression; None (after a report) when it has none."""
    match e:
        case t.Value(value):
            if isinstance(value, bool):
                return Type.BOOL
            if isinstance(value, int):
                return Type.INT
            return Type.REAL if isinstance(value, float) else Type.STRING
        case t.Quantity(_, unit):
            return UNITS[unit].type
        case t.Name(name):
            return _name(name, e.span, scope)
        case t.Field():
            return _field(e, scope)
        case t.Unary(operator, operand):
            found = type_of(operand, scope)
            if found is None:
                return None
            good = found is Type.BOOL if operator == "not" else found in NUMBERS | QUANTITIES
            if not good:
                wanted = "`bool`" if operator == "not" else "a number or quantity"
                scope.d.error(
                    codes.TYPE, f"`{operator}` needs {wanted}, but this is `{found}`", operand.span
                )
                return None
            return found
        case t.Binary():
            return _binary(e, scope)
        case t.CallExpression():
            return _call(e, scope)
        case t.Conditional(condition, then, otherwise):
            test = type_of(condition, scope)
            if test not in (None, Type.BOOL):
                scope.d.error(
                    codes.TYPE,
                    f"the condition must be of type `bool`, but this is `{test}`",
                    condition.span,
                )
            a, b = type_of(then, scope), type_of(otherwise, scope)
            if a is None or b is None:
                return None
            if fits(a, b) or fits(b, a):
                return b if fits(a, b) else a
            _mismatch("`then` and `else` give different types", a, b, e.span, scope)
            return None
        case _:
            assert_never(e)


def _name(name: str, span: Span, scope: Scope) -> Type | None:
    if name in scope.values:
        scope.used.add(name)
        return scope.values[name]
    if name in scope.files:
        scope.d.error(
            codes.NOT_A_VARIABLE,
            f"`{name}` is a file and has no value here",
            span,
            hint=f"read it into a variable: `read {name} into x`; "
            f"to ask whether it holds a message: `filled({name})`",
        )
        return None
    scope.d.error(
        codes.UNKNOWN_NAME,
        f"variable `{name}` is not declared",
        span,
        hint=did_you_mean(name, scope.values, f"declare it: `var {name} : int`"),
    )
    return None


def _field(e: t.Field, scope: Scope) -> Type | None:
    found = type_of(e.record, scope)
    if found is None:
        return None
    if found is Type.POSE and e.label in POSE_FIELDS:
        return POSE_FIELDS[e.label]
    scope.d.error(
        codes.UNKNOWN_FIELD,
        f"`{found}` has no field `{e.label}`",
        e.span,
        hint=f"a pose has {', '.join(POSE_FIELDS)}"
        if found is Type.POSE
        else "only poses have fields",
    )
    return None


def _mismatch(message: str, a: Type, b: Type, span: Span, scope: Scope) -> None:
    physical = {a, b} <= NUMBERS | QUANTITIES and bool({a, b} & QUANTITIES)
    hint = ""
    if physical and {a, b} & NUMBERS:
        unit = BASE_UNIT[next(iter({a, b} & QUANTITIES))]
        hint = f"give the plain number a unit: `1 {unit}`"
    scope.d.error(
        codes.UNIT if physical else codes.TYPE, f"{message}: `{a}` and `{b}`", span, hint=hint
    )


def _binary(e: t.Binary, scope: Scope) -> Type | None:
    a, b = type_of(e.left, scope), type_of(e.right, scope)
    if a is None or b is None:
        return None
    op = e.operator
    result: Type | None = None
    match op:
        case "and" | "or":
            result = Type.BOOL if a is b is Type.BOOL else None
        case "=" | "<>":
            result = Type.BOOL if fits(a, b) or fits(b, a) else None
        case "<" | "<=" | ">" | ">=":
            ordered = a not in {Type.BOOL, Type.POSE, *LISTS}
            result = Type.BOOL if ordered and (fits(a, b) or fits(b, a)) else None
        case "&":
            result = Type.STRING if a is b is Type.STRING else None
        case "+" | "-":
            if a in NUMBERS and b in NUMBERS:
                result = Type.INT if a is b is Type.INT else Type.REAL
            elif a is b and a in QUANTITIES:
                result = a
        case "*":
            result = product(a, b)
        case "/":
            result = quotient(a, b)
        case "div" | "mod":
            result = Type.INT if a is b is Type.INT else None
    if result is None:
        _mismatch(f"`{op}` cannot be applied", a, b, e.span, scope)
    return result


def _call(e: t.CallExpression, scope: Scope) -> Type | None:
    name = e.function
    if name in MAKES:
        return _made(e, MAKES[name], scope)
    if name not in FUNCTIONS:
        scope.d.error(
            codes.UNKNOWN_FUNCTION,
            f"there is no function `{name}`",
            e.span,
            hint=did_you_mean(name, FUNCTIONS, f"functions are {', '.join(FUNCTIONS)}"),
        )
        return None
    if len(e.arguments) != FUNCTIONS[name]:
        scope.d.error(
            codes.ARGUMENTS,
            f"`{name}` takes {FUNCTIONS[name]} arguments, but {len(e.arguments)} are given",
            e.span,
        )
        return None
    if name == "filled":
        argument = e.arguments[0]
        if not isinstance(argument, t.Name):
            scope.d.error(codes.UNKNOWN_FILE, "`filled` takes the name of a file", argument.span)
            return None
        file = scope.file(argument.name, argument.span, t.Direction.INPUT, "waited for")
        return None if file is None else Type.BOOL
    types = [type_of(a, scope) for a in e.arguments]
    if any(x is None for x in types):
        return None
    return _result(e, name, [x for x in types if x is not None], scope)


def _made(e: t.CallExpression, of: Type, scope: Scope) -> Type:
    for a in e.arguments:
        found = type_of(a, scope)
        if found is not None and not fits(found, ELEMENT[of]):
            _argument(f"an item of `{of}`", ELEMENT[of], found, a, scope)
    return of


_OF_LISTS = ("count_of", "first_of", "rest_of", "item_of", "with_first", "joined", "reversed")


def _of_list(e: t.CallExpression, name: str, types: list[Type], scope: Scope) -> Type | None:
    first = types[0]
    if first not in LISTS:
        lists = ", ".join(f"`{x}`" for x in MAKES)
        scope.d.error(
            codes.TYPE,
            f"the argument of `{name}` must be a list, but this is `{first}`",
            e.arguments[0].span,
            hint=f"lists are {lists}",
        )
        return None
    wanted = {"item_of": Type.INT, "with_first": ELEMENT[first], "joined": first}.get(name)
    if wanted is not None and types[1] is not wanted:
        what = "the number of an item" if name == "item_of" else f"the second argument of `{name}`"
        _argument(what, wanted, types[1], e.arguments[1], scope)
    match name:
        case "count_of":
            return Type.INT
        case "first_of" | "item_of":
            return ELEMENT[first]
        case _:
            return first


def _result(e: t.CallExpression, name: str, types: list[Type], scope: Scope) -> Type | None:
    first = types[0]
    if name in _OF_LISTS:
        return _of_list(e, name, types, scope)
    match name:
        case "pose":
            for (label, wanted), found, a in zip(
                POSE_FIELDS.items(), types, e.arguments, strict=True
            ):
                if found is not wanted:
                    _argument(f"`{label}` of a pose", wanted, found, a, scope)
            return Type.POSE
        case "before":
            for i, (what, wanted) in enumerate((("pose", Type.POSE), ("distance", Type.LENGTH))):
                if types[i] is not wanted:
                    _argument(f"the {what} of `before`", wanted, types[i], e.arguments[i], scope)
            return Type.POSE
        case "text":
            return Type.STRING
        case "computed":
            return Type.BOOL
        case "single" if first in QUANTITIES or first in _ROUNDED:
            return first
        case "abs" if first in NUMBERS | QUANTITIES:
            return first
        case "min" | "max" if set(types) <= NUMBERS:
            return Type.INT if set(types) == {Type.INT} else Type.REAL
        case "min" | "max" if first is types[1] and first in QUANTITIES:
            return first
        case "floor" | "ceil" | "round" | "trunc" if first in NUMBERS:
            return Type.INT
        case "sqrt" | "real" if first in NUMBERS:
            return Type.REAL
        case "sin" | "cos" | "tan" if first is Type.ANGLE:
            return Type.REAL
    if name in ("min", "max"):
        _mismatch(f"`{name}` cannot be applied", types[0], types[1], e.span, scope)
    else:
        wanted = Type.ANGLE if name in ("sin", "cos", "tan") else Type.REAL
        _argument(f"the argument of `{name}`", wanted, first, e.arguments[0], scope)
    return None


_ROUNDED = (Type.REAL, Type.POSE, Type.REALS, Type.POSES)


def _argument(what: str, wanted: Type, found: Type, a: t.Expression, scope: Scope) -> None:
    physical = found in NUMBERS | QUANTITIES and wanted in NUMBERS | QUANTITIES
    hint = ""
    if found in NUMBERS and wanted in QUANTITIES:
        hint = f"give it a unit, e.g. `{a.span.text} {BASE_UNIT[wanted]}`"
    scope.d.error(
        codes.UNIT if physical else codes.TYPE,
        f"{what} must be of type `{wanted}`, but this is `{found}`",
        a.span,
        hint=hint,
    )
