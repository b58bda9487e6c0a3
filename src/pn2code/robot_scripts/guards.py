"""What can be proved about conditions: that two exclude each other, that several cover everything.

k = 1        and  k = 2        exclude each other
n < 3        and  n >= 3       exclude each other and cover everything
k = 1        and  k = 2 or k = 3      exclude each other: each way of the one contradicts each way of the other
x < 3.0      and  x >= 3.0     exclude each other: of a real that is no number (NaN) both are false
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from pn2code.base.frozen import frozen
from pn2code.robot_scripts.not_a_number import MayBeNan
from pn2code.robot_scripts.values import FALSE, TRUE
from pn2code.tdl import tree as t
from pn2code.tdl.pretty import expression

MOST_WAYS = 64
"""In which a condition can hold; one with more is not taken to pieces."""

Constant = int | float | str | bool


@frozen
class Fact:
    """`subject operator value`; the value is a constant, or the text of another expression.

    Args:
        of_nan: whether it also holds if one of the two is NaN; None: neither can be.
    """

    subject: str
    operator: str
    value: Constant | t.Expression
    of_nan: bool | None = None

    def opposite(self) -> Fact:
        """What holds exactly when this does not."""
        of_nan = None if self.of_nan is None else not self.of_nan
        return Fact(self.subject, _OPPOSITE[self.operator], self.value, of_nan)


_MIRROR = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "=": "=", "<>": "<>"}
_OPPOSITE = {"<": ">=", ">=": "<", ">": "<=", "<=": ">", "=": "<>", "<>": "="}


def conjuncts(e: t.Expression) -> list[t.Expression]:
    """The parts of a conjunction."""
    match e:
        case t.Binary("and", left, right):
            return [*conjuncts(left), *conjuncts(right)]
        case t.Value(True):
            return []
        case _:
            return [e]


def ways(e: t.Expression, wanted: bool = True) -> list[list[t.Expression]]:
    """The ways in which a condition holds (or does not, if not `wanted`): of each the parts that hold together."""
    match e:
        case t.Value(bool(value)):
            return [[]] if value == wanted else []
        case t.Unary("not", operand):
            return ways(operand, not wanted)
        case t.Binary("and" | "or" as operator, left, right):
            a, b = ways(left, wanted), ways(right, wanted)
            is_either = (operator == "or") == wanted
            if (len(a) + len(b) if is_either else len(a) * len(b)) <= MOST_WAYS:
                return [*a, *b] if is_either else [[*x, *y] for x in a for y in b]
    return [[e if wanted else t.Unary("not", e)]]


def fact(e: t.Expression, constants: Mapping[str, Constant], may_be_nan: MayBeNan) -> Fact:
    """What an expression of type bool says. `constants`: values of the script's named constants."""
    match e:
        case t.Unary("not", operand):
            return fact(operand, constants, may_be_nan).opposite()
        case t.Binary(operator, left, right) if operator in _MIRROR:
            of_nan = operator == "<>" if may_be_nan(left) or may_be_nan(right) else None
            a, b = _value(left, constants), _value(right, constants)
            if a is not None and b is None:
                return Fact(expression(right), _MIRROR[operator], a, of_nan)
            if b is not None:
                return Fact(expression(left), operator, b, of_nan)
            x, y = expression(left), expression(right)
            # One order for both `a < b` and `b > a`.
            if x <= y:
                return Fact(x, operator, right, of_nan)
            return Fact(y, _MIRROR[operator], left, of_nan)
        case _:
            return Fact(expression(e), "=", True)


def _value(e: t.Expression, constants: Mapping[str, Constant]) -> Constant | None:
    match e:
        case t.Value(value):
            return value
        case t.Quantity(number, "mm" | "deg" | "s" | "mm/s"):
            return number
        case t.Unary("-", t.Value(int() | float() as number)):
            return -number
        case t.Name(name):
            return constants.get(name)
        case _:
            return None


def exclusive(
    a: t.Expression,
    b: t.Expression,
    constants: Mapping[str, Constant],
    may_be_nan: MayBeNan,
) -> bool:
    """Whether it is certain that not both hold."""
    if FALSE in (a, b):
        return True

    def facts(e: t.Expression) -> list[list[Fact]]:
        return [[fact(part, constants, may_be_nan) for part in way] for way in ways(e)]

    first, second = facts(a), facts(b)
    return all(any(_contradict(x, y) for x in f for y in g) for f in first for g in second)


def _contradict(x: Fact, y: Fact) -> bool:
    if x.subject != y.subject or (x.of_nan and y.of_nan):
        return False
    if isinstance(x.value, Constant) and isinstance(y.value, Constant):
        return _no_common_value(x, y)
    if x.value != y.value:
        return False
    return (
        y.operator
        in {
            "=": ("<>", "<", ">"),
            "<>": ("=",),
            "<": ("=", ">", ">="),
            "<=": (">",),
            ">": ("=", "<", "<="),
            ">=": ("<",),
        }[x.operator]
    )


def _no_common_value(x: Fact, y: Fact) -> bool:
    a, b = x.value, y.value
    if isinstance(a, bool) or isinstance(b, bool) or isinstance(a, str) or isinstance(b, str):
        if x.operator == y.operator == "=":
            return a != b
        if {x.operator, y.operator} == {"=", "<>"}:
            return a == b
        return isinstance(a, bool) and x.operator == y.operator == "<>" and a != b
    assert isinstance(a, int | float) and isinstance(b, int | float)
    if x.operator == "=":
        return not _holds(a, y.operator, b)
    if y.operator == "=":
        return not _holds(b, x.operator, a)
    if "<>" in (x.operator, y.operator):
        return False
    if x.operator[0] == y.operator[0]:
        return False  # both from above or both from below
    upper, lower = (x, y) if x.operator[0] == "<" else (y, x)
    top, bottom = upper.value, lower.value
    assert isinstance(top, int | float) and isinstance(bottom, int | float)
    if top != bottom:
        return top < bottom
    return not (upper.operator == "<=" and lower.operator == ">=")


def _holds(a: float, operator: str, b: float) -> bool:
    return {
        "=": a == b, "<>": a != b, "<": a < b, "<=": a <= b, ">": a > b, ">=": a >= b,
    }[operator]  # fmt: skip


def covering(
    conditions: Iterable[t.Expression],
    constants: Mapping[str, Constant],
    may_be_nan: MayBeNan,
) -> bool:
    """Whether it is certain that one of the conditions holds.

    Only complements count (`n < 3` and `n >= 3`; of reals, `x < 3.0` and `not (x < 3.0)`). That a colour set has no
    other value is not used: what comes from a file is worth a last `else` that stops.
    """
    alone = []
    for c in conditions:
        if c == TRUE:
            return True
        parts = conjuncts(c)
        if len(parts) == 1:
            alone.append(fact(parts[0], constants, may_be_nan))
    for i, x in enumerate(alone):
        for y in alone[i + 1 :]:
            if _are_opposite(x, y) or (
                isinstance(x.value, bool) and isinstance(y.value, bool) and x.subject == y.subject
                and (x.operator == y.operator) == (x.value != y.value)
            ):  # fmt: skip
                return True
    return False


def _are_opposite(x: Fact, y: Fact) -> bool:
    """Whether one of the two holds in any case."""
    same = (x.subject, _OPPOSITE[x.operator], x.value) == (y.subject, y.operator, y.value)
    return same and (x.of_nan is None or x.of_nan or y.of_nan is True)
