"""Patterns -> a condition and the values of the variables.

Example: matching `(x, 3)` against the struct `p` gives the condition `p.2 = 3` and x = `p.1`. The conditions
are in an order in which each is safe once those before it hold, and so are the values once all hold.
"""

from __future__ import annotations

from dataclasses import field

from pn2code.base.frozen import record
from pn2code.diagnostics import Span
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, IrType, Rep
from pn2code.lowering.expressions.clock import timed_part
from pn2code.lowering.expressions.values import RecordVal, Val
from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol
from pn2code.ml.core.types import Type


@record
class Match:
    """The result: `conditions` in order, `bindings` from left to right (a variable may occur more than once), and
    parts that must be `equals` to the values of expressions; the latter only in patterns of a net's inscriptions."""

    conditions: list[Ir] = field(default_factory=list)
    bindings: list[tuple[Symbol, Val]] = field(default_factory=list)
    equals: list[tuple[core.Exp, Val]] = field(default_factory=list)


def conjunction(conditions: list[Ir]) -> Ir | None:
    """All of them, None for none."""
    result: Ir | None = None
    for c in conditions:
        result = c if result is None else ir.Op("andalso", (result, c), ir.BOOL)
    return result


def negation(condition: Ir) -> Ir:
    """Not."""
    match condition:
        case ir.Op(name="Bool.not", arguments=(inner,)):
            return inner
        case ir.Const(value=bool(value)):
            return ir.Const(not value, ir.BOOL)
    return ir.Op("Bool.not", (condition,), ir.BOOL)


class Matcher:
    """Matches with the types of one function instance; `lower` gives the representation of an ML type."""

    def __init__(self, owner: TypeSource) -> None:
        self._owner = owner

    def match(self, pattern: core.Pat, value: Val) -> Match:
        """Match a value, whose C parts are atomic, against a pattern."""
        result = Match()
        self._match(pattern, value, result)
        return result

    def _match(self, pattern: core.Pat, value: Val, out: Match) -> None:
        match pattern:
            case core.PWild():
                return
            case core.PVar(symbol=symbol):
                out.bindings.append((symbol, value))
            case core.PAs(symbol=symbol, pattern=inner):
                out.bindings.append((symbol, value))
                self._match(inner, value, out)
            case core.PLit(value=int() as number, type=t) if abs(number) >= 2**63 and (
                self._owner.representation(t) == ir.INT
            ):
                out.conditions.append(ir.Const(False, ir.BOOL))
            case core.PEqual(value=named):
                out.equals.append((named, value))
            case core.PLit():
                code = self._owner.code(value)
                literal = self._owner.literal(pattern.value, pattern.type, pattern.span)
                out.conditions.append(ir.Op("=", (code, literal), ir.BOOL))
            case core.PRecord(fields=fields):
                for label, inner in fields:
                    self._match(inner, self._owner.select(value, label, inner.type), out)
            case core.PCon():
                self._constructor(pattern, self._owner.code(value), out)

    def _constructor(self, pattern: core.PCon, value: Ir, out: Match) -> None:
        constructor = pattern.constructor
        t: IrType = value.type
        if t.rep is Rep.BOOL:
            out.conditions.append(value if constructor.tag == 1 else negation(value))
        elif t.rep is Rep.LIST:
            self._list(pattern, value, out)
        elif t.rep in (Rep.ENUM, Rep.UNION):
            argument: IrType | None = None
            if pattern.argument is not None:
                argument = self._owner.representation(pattern.argument.type)
            tag = self._owner.tag_of(constructor, argument)
            if constructor.siblings != 1:
                out.conditions.append(ir.IsTag(value, tag))
            if pattern.argument is not None:
                assert argument is not None
                is_tested = constructor.siblings != 1
                inside = ir.Argument(value, tag, argument, is_tested)
                self._match(pattern.argument, inside, out)
        elif constructor.data_type == "timed" and isinstance(pattern.argument, core.PRecord):
            # A timed token: its value and its stamp.
            for (_, inner), label in zip(pattern.argument.fields, ("value", "stamp"), strict=True):
                part = timed_part(value, label, self._owner.representation(inner.type))
                self._match(inner, part, out)
        elif t.rep is Rep.REF and pattern.argument is not None:
            contents = ir.Contents(value, self._owner.representation(pattern.argument.type))
            self._match(pattern.argument, contents, out)
        elif pattern.argument is not None:
            # An index: its number is its representation.
            self._match(pattern.argument, value, out)

    def _list(self, pattern: core.PCon, value: Ir, out: Match) -> None:
        if pattern.argument is None:
            out.conditions.append(ir.IsNil(value))
            return
        out.conditions.append(negation(ir.IsNil(value)))
        element = self._owner.element(value.type)
        if isinstance(value, ir.Op) and value.name == "list.nil":
            # Nothing is in it: nobody comes to where its parts are used, but they are written.
            parts = {"1": self._owner.zero(element), "2": value}
        else:
            parts = {"1": ir.Head(value, element), "2": ir.Tail(value)}
        pair = RecordVal(parts, pattern.argument.type)
        self._match(pattern.argument, pair, out)


class TypeSource:
    """What a matcher asks of the function body that it works for."""

    def representation(self, t: Type) -> IrType:
        """The representation of an ML type of this body."""
        raise NotImplementedError

    def element(self, t: IrType) -> IrType:
        """The element type of a list type."""
        raise NotImplementedError

    def zero(self, t: IrType) -> Ir:
        """Some value of a type, for what is never used."""
        raise NotImplementedError

    def code(self, value: Val) -> Ir:
        """The value as C code."""
        raise NotImplementedError

    def literal(self, value: int | float | str, t: Type, span: Span) -> ir.Const:
        """A literal as a constant."""
        raise NotImplementedError

    def tag_of(self, constructor: core.Constructor, argument: IrType | None) -> int:
        """The tag of a constructor in its union."""
        raise NotImplementedError

    def select(self, value: Val, label: str, t: Type) -> Val:
        """A field of a record."""
        raise NotImplementedError


def is_irrefutable(pattern: core.Pat) -> bool:
    """Whether every value of the type fits."""
    match pattern:
        case core.PWild() | core.PVar():
            return True
        case core.PAs(pattern=inner):
            return is_irrefutable(inner)
        case core.PRecord(fields=fields):
            return all(is_irrefutable(p) for _, p in fields)
        case core.PCon(constructor=c, argument=argument):
            return c.siblings == 1 and (argument is None or is_irrefutable(argument))
    return False


__all__ = ["Match", "Matcher", "TypeSource", "conjunction", "is_irrefutable", "negation"]
