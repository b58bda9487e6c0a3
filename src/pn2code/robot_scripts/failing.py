"""Which computations may fail: whole numbers divided by zero or out of range, reals without a whole part, items that a
list does not have.

hd l            may be of an empty list; not where `l <> []` is known
n + 1           may be too large; not where `n < 3` is known
10 div n        may be a division by zero; not where `n <> 0` is known
w + 1.0         reals do not fail
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set

from pn2code.base.frozen import frozen
from pn2code.ml.core.colsets import Kind
from pn2code.ml.core.terms import Symbol
from pn2code.robot_scripts import lists
from pn2code.robot_scripts.guards import Constant, fact, ways
from pn2code.robot_scripts.names import Names
from pn2code.robot_scripts.not_a_number import MayBeNan, may_be_nan
from pn2code.robot_scripts.values import Env, Rows, Scalar, scalars_in
from pn2code.tdl import tree as t
from pn2code.tdl.paths import children
from pn2code.tdl.pretty import expression
from pn2code.tdl.types import MAX_INT, MIN_INT

PARTIAL = frozenset(
    {"Int.+", "Int.-", "Int.*", "Int.div", "Int.mod", "Int.~", "Int.abs",
     "Real.floor", "Real.ceil", "Real.round", "Real.trunc", "List.hd", "List.tl", "List.nth"}
)  # fmt: skip
"""Functions of CPN ML that scripts have, and that may raise an exception."""


_PARTS = ("first_of", "rest_of", "item_of")


@frozen
class Range:
    """Whole numbers from `low` to `high` without some of them."""

    low: int = MIN_INT
    high: int = MAX_INT
    without: frozenset[int] = frozenset()

    def both(self, other: Range) -> Range:
        """The numbers that are in both."""
        low, high = max(self.low, other.low), min(self.high, other.high)
        return Range(low, high, self.without | other.without)

    def __contains__(self, number: int) -> bool:
        return self.low <= number <= self.high and number not in self.without


ALL = Range()


@frozen
class Known:
    """What is known of numbers at some point of a script.

    Args:
        constants: values of the script's named constants.
        may_be_nan: whether an expression may be NaN.
        ranges: of expressions, by their texts.
    """

    constants: Mapping[str, Constant]
    may_be_nan: MayBeNan
    ranges: Mapping[str, Range]

    def with_condition(self, e: t.Expression, holds: bool = True) -> Known:
        """What is known where a condition holds, or does not."""
        found = ways(e, holds)
        if len(found) != 1:  # several ways: nothing is certain
            return self
        ranges = dict(self.ranges)
        for part in found[0]:
            f = fact(part, self.constants, self.may_be_nan)
            if type(f.value) is int:
                known = _range(f.operator, f.value)
                ranges[f.subject] = ranges.get(f.subject, ALL).both(known)
        return Known(self.constants, self.may_be_nan, ranges)

    def with_colours(self, variables: Iterable[Symbol], of: Set[int], env: Env) -> Known:
        """What is known where some variables of the net (by their uid) have values of their colour sets."""
        ranges = dict(self.ranges)
        for v in variables:
            value, c = env.get(v.uid), v.colset.resolved if v.colset is not None else None
            if v.uid in of and c is not None and c.kind is Kind.INT and isinstance(value, Scalar):
                low = c.low if isinstance(c.low, int) else MIN_INT
                high = c.high if isinstance(c.high, int) else MAX_INT
                subject = expression(value.exp)
                ranges[subject] = ranges.get(subject, ALL).both(Range(low, high))
            is_list = c is not None and c.kind is Kind.LIST
            if v.uid in of and c is not None and is_list and isinstance(value, Scalar | Rows):
                low = c.low if isinstance(c.low, int) else 0
                high = c.high if isinstance(c.high, int) else MAX_INT
                for column in scalars_in(value):
                    subject = expression(lists.count(column.exp))
                    ranges[subject] = ranges.get(subject, ALL).both(Range(low, high))
        return Known(self.constants, self.may_be_nan, ranges)

    def range_of(self, e: t.Expression) -> Range:
        """Among which numbers the value of a whole-number expression is, if it has one."""
        return self._computed(e).both(self.ranges.get(expression(e), ALL)).both(ALL)

    def _computed(self, e: t.Expression) -> Range:
        match e:
            case t.Value(int() as number) if not isinstance(number, bool):
                return Range(number, number)
            case t.Name(name) if type(constant := self.constants.get(name)) is int:
                return Range(constant, constant)
            case t.Conditional(condition, then, otherwise):
                a = self.with_condition(condition).range_of(then)
                b = self.with_condition(condition, False).range_of(otherwise)
                return Range(min(a.low, b.low), max(a.high, b.high), a.without & b.without)
            case t.Unary("-", operand):
                a = self.range_of(operand)
                return Range(-a.high, -a.low)
            case t.Binary("+" | "-" | "*" | "div" | "mod" as operator, left, right):
                return _combined(operator, self.range_of(left), self.range_of(right))
            case t.CallExpression("count_of"):
                return Range(low=0)
            case t.CallExpression("abs", (operand,)):
                a = self.range_of(operand)
                return Range(0 if a.low <= 0 <= a.high else min(abs(a.low), abs(a.high)),
                             max(abs(a.low), abs(a.high)))  # fmt: skip
            case _:
                return ALL

    def fails_itself(self, e: t.Expression) -> bool:
        """Whether a whole-number expression, or a part of a list, may have no value although its parts have one."""
        match e:
            case t.CallExpression("first_of" | "rest_of", (of,)):
                return 0 in self.range_of(lists.count(of))
            case t.CallExpression("item_of", (of, number)):
                asked, there = self.range_of(number), self.range_of(lists.count(of))
                return asked.low < 0 or asked.high >= there.low
            case t.Binary("div" | "mod", _, right) if 0 in self.range_of(right):
                return True
            case t.CallExpression("floor" | "ceil" | "round" | "trunc" | "single"):
                return True
            case t.Binary("+" | "-" | "*" | "div") | t.Unary("-") | t.CallExpression("abs"):
                found = self._computed(e)
                return found.low < MIN_INT or found.high > MAX_INT
            case _:
                return False

    def fails(self, e: t.Expression) -> bool:
        """Whether an expression may have no value."""
        match e:
            case t.Binary("and" | "or" as operator, left, right):
                return self.fails(left) or self.with_condition(left, operator == "and").fails(right)
            case t.Conditional(condition, then, otherwise):
                if self.fails(condition) or self.with_condition(condition).fails(then):
                    return True
                return self.with_condition(condition, False).fails(otherwise)
            case _:
                # What may be NaN is a real, whose arithmetic does not fail; but it may not be there.
                is_part = isinstance(e, t.CallExpression) and e.function in _PARTS
                fails = self.fails_itself(e) and (is_part or not self.may_be_nan(e))
                return fails or any(map(self.fails, children(e)))


def known_where(names: Names, conditions: Iterable[t.Expression] = ()) -> Known:
    """What is known of numbers where some conditions hold."""
    found = Known(names.constant_values, lambda e: may_be_nan(e, names), {})
    for c in conditions:
        found = found.with_condition(c)
    return found


def _range(operator: str, value: int) -> Range:
    match operator:
        case "=":
            return Range(value, value)
        case "<":
            return Range(high=value - 1)
        case "<=":
            return Range(high=value)
        case ">":
            return Range(low=value + 1)
        case ">=":
            return Range(low=value)
        case _:
            return Range(without=frozenset({value}))


def _combined(operator: str, a: Range, b: Range) -> Range:
    """The results, as if no number were too large."""
    if a.low > a.high or b.low > b.high:
        return Range(0, 0)  # there is no such number: it never comes to this
    if operator == "mod":
        most = max(abs(b.low), abs(b.high)) - 1
        return Range(0 if b.low >= 0 else -most, 0 if b.high <= 0 else most)
    by = [b.low, b.high]
    if operator == "div":
        # Numbers between the ends that are left out (`without`) do not matter: more results are no harm.
        by = [x for x in (b.low, b.high, -1, 1) if x != 0 and b.low <= x <= b.high]
    results = [_OPERATIONS[operator](x, y) for x in (a.low, a.high) for y in by]
    return Range(min(results), max(results)) if results else ALL


_OPERATIONS = {
    "+": lambda x, y: x + y,
    "-": lambda x, y: x - y,
    "*": lambda x, y: x * y,
    "div": lambda x, y: x // y,
}
