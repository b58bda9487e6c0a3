"""Functions as values of the C program, for those that cannot be followed to the place where they are applied.

A function that is put into a list, a reference or a data type, chosen by `if`, or returned by a recursive function
becomes a value of a union with one constructor for each function of the net that is used so at that type; the
constructor's argument is what the function captured. A call of such a value is a call of the one function for its
type that looks at the constructor:

    val fs = [fn x => x + k, Int.abs]

    union int_to_int = fn of int | Int.abs
    apply int_to_int (f, x):   if f is fn: return x + f#fn;   if f is Int.abs: return abs x

All is known once everything else has been lowered: see `finish`.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import TYPE_CHECKING

from pn2code.base.frozen import frozen
from pn2code.diagnostics import SourceText, Span
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, IrType, Local, Rep, Stmt
from pn2code.lowering.expressions.values import (
    Binding,
    BuiltinFunction,
    Captured,
    Closure,
    ConstructorFunction,
    FunctionVal,
    NamedFunction,
    Partial,
    Polymorphic,
    Rebuild,
    Val,
    capture,
    free_variables,
    function_type,
    is_static,
)
from pn2code.ml.core.types import TFun, Type

if TYPE_CHECKING:
    from pn2code.lowering.expressions.block import Block
    from pn2code.lowering.expressions.body import Body
    from pn2code.lowering.expressions.functions import Program


@frozen
class _Case:
    """A function that may be the value: its tag, and how it is made from what was captured."""

    tag: int
    captured: tuple[IrType, ...]
    argument: IrType | None
    rebuild: Rebuild
    at: Span


class FunctionValues:
    """The functions of one net that are values, and the functions that apply them."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self._tags: dict[tuple[str, Hashable], int] = {}
        self._cases: dict[str, list[_Case]] = {}
        self._ways: dict[str, list[tuple[int, tuple[Stmt, ...]]]] = {}
        self._bodies: dict[str, Body] = {}

    def make(self, body: Block, value: FunctionVal, at: Span | None) -> Ir:
        """A function as a value."""
        t = self._program.types.lower(function_type(value), at or self._program.position)
        taken = capture(self._flattened(body, value, at))
        code = tuple(body.addressable(c, "captured") for c in taken.code)
        identity = (t.name, taken.key)
        if identity not in self._tags:
            where = (
                _span(value) or at or Span(SourceText(_hint(value), self._program.position), 0, 0)
            )
            self._enter(t, identity, taken, _hint(value), where)
        tag = self._tags[identity]
        argument = self._cases[t.name][tag].argument
        if argument is None:
            return ir.MakeUnion(tag, None, t)
        if len(code) == 1:
            return ir.MakeUnion(tag, code[0], t)
        definition = self._program.types.definition(argument)
        assert isinstance(definition, ir.StructDef)
        labels = [label for label, _ in definition.fields]
        fields = tuple(zip(labels, code, strict=True))
        return ir.MakeUnion(tag, ir.MakeStruct(argument, fields), t)

    @staticmethod
    def _flattened(body: Block, value: FunctionVal, at: Span | None) -> FunctionVal:
        """The function, with values for the functions that it captured, if these captured anything themselves."""

        def inner(part: Binding) -> Binding:
            is_function = isinstance(
                part, Closure | NamedFunction | BuiltinFunction | ConstructorFunction | Partial
            )
            # Only a function that captures something has code.
            return body.code(part, at) if is_function and capture(part).code else part  # type: ignore[arg-type]

        match value:
            case Closure(function=function, env=env, types=types):
                wanted = free_variables(function)
                return Closure(
                    function, {u: inner(v) for u, v in env.items() if u in wanted}, types
                )
            case NamedFunction(symbol=symbol, group=group, env=env, types=types):
                wanted = frozenset[int]().union(*(free_variables(f) for _, f in group.bindings))
                kept = {u: inner(v) for u, v in env.items() if u in wanted}
                return NamedFunction(symbol, group, kept, types)
            case Partial(function=applied, arguments=arguments):
                made = tuple(inner(a) for a in arguments)
                return Partial(applied, made)  # type: ignore[arg-type]  # inner functions stay functions
        return value

    def _enter(
        self,
        t: IrType,
        identity: tuple[str, Hashable],
        taken: Captured,
        hint: str,
        at: Span,
    ) -> None:
        types = self._program.types
        parts = tuple(c.type for c in taken.code)
        argument: IrType | None = None
        if len(parts) == 1:
            argument = parts[0]
        elif parts:
            labels: list[str] = []
            for c in taken.code:
                base = _name(c)
                label, n = base, 2
                while label in labels:
                    label, n = f"{base}_{n}", n + 1
                labels.append(label)
            argument = types.struct(f"{t.name}_{hint}", tuple(zip(labels, parts, strict=True)))
        tag = types.add_constructor(t, hint, argument)
        self._tags[identity] = tag
        cases = self._cases.setdefault(t.name, [])
        assert tag == len(cases)
        cases.append(_Case(tag, parts, argument, taken.rebuild, at))

    def apply(self, body: Body, function: Ir, argument: Val, at: Span) -> Ir:
        """Apply a function that is a value; computed now, since nobody knows what it does."""
        t = function.type
        signature = self._program.types.functions[t.name]
        self._bodies.setdefault(t.name, self._program.body())
        argument = body.code(argument, at)
        arguments = (function,) if argument.type == ir.UNIT else (function, argument)
        result = self._program.types.lower(signature.result, at)
        return body.spill(ir.FunCall(_key(t.name), arguments, result), "applied")

    # --- the functions that apply --------------------------------------------------------------

    def work(self) -> bool:
        """Lower a function that may be applied as a value and is not lowered yet; False if there is none."""
        for name, body in self._bodies.items():
            done = self._ways.setdefault(name, [])
            cases = self._cases.get(name, [])
            if len(done) < len(cases):
                case = cases[len(done)]
                # Noted before, so that what the function itself asks for comes after it.
                done.append((case.tag, ()))
                done[case.tag] = (case.tag, self._way(name, body, case))
                return True
        return False

    def _way(self, name: str, body: Body, case: _Case) -> tuple[Stmt, ...]:
        signature = self._program.types.functions[name]
        function, argument = self._parameters(name)
        parts: list[Ir] = []
        if case.argument is not None:
            whole = ir.Argument(ir.Use(function), case.tag, case.argument)
            parts = [whole]
            if len(case.captured) > 1:
                definition = self._program.types.definition(case.argument)
                assert isinstance(definition, ir.StructDef)
                parts = [ir.Member(whole, label, t) for label, t in definition.fields]
        value = case.rebuild(parts)
        assert not isinstance(value, Polymorphic)
        given: Ir = ir.Const(None, ir.UNIT) if argument is None else ir.Use(argument)
        with body.block() as statements:
            body.emit(ir.Note(" ".join(case.at.text.split())))
            if isinstance(value, Closure):
                outer, body.types = body.types, value.types
                try:
                    body.tail_rules(value.function.rules, given, value.env)
                finally:
                    body.types = outer
            else:
                body.finish(body.apply(value, given, signature.result, case.at))
        return tuple(statements)

    def _parameters(self, name: str) -> tuple[Local, Local | None]:
        t = self._program.types.functions[name]
        function = Local(-1, "f", IrType(Rep.UNION, name))
        lowered = self._program.types.lower(t.argument)
        return function, None if lowered == ir.UNIT else Local(-2, "x", lowered)

    def finish(self) -> dict[str, ir.Function]:
        """The functions that apply, once all functions are lowered."""
        return {_key(name): self._function(name) for name in self._bodies}

    def _function(self, name: str) -> ir.Function:
        types = self._program.types
        t: TFun = types.functions[name]
        result = types.lower(t.result)
        function, argument = self._parameters(name)
        zero: Ir = ir.Op("zero", (), result)
        body: tuple[Stmt, ...] = (ir.Return(None if result == ir.UNIT else zero),)
        for tag, way in reversed(self._ways.get(name, [])):
            body = (ir.If(ir.IsTag(ir.Use(function), tag), way, body),)
        parameters = (function,) if argument is None else (function, argument)
        return ir.Function(
            _key(name), f"apply {name}", parameters, result, body, False, False,
            f"functions of type {t} that are values", self._program.position,
        )  # fmt: skip


def _key(name: str) -> str:
    return f"apply {name}"


def is_intricate(key: Hashable) -> bool:
    """Whether a captured function has itself among what it captured, or functions in functions in functions: copies
    for such functions would go on for ever, or for long."""
    return _is_intricate(key, ())


def _is_intricate(key: Hashable, around: tuple[Hashable, ...]) -> bool:
    if not isinstance(key, tuple) or len(key) != 2 or not isinstance(key[1], tuple):
        return False
    head, parts = key
    if head == "partial" and parts:
        # The function that waits for more is around its arguments.
        applied, *parts = parts
        head = applied[0] if isinstance(applied, tuple) and applied else None
        parts = [*parts, *(applied[1] if isinstance(applied, tuple) and len(applied) == 2 else ())]
    if isinstance(head, tuple) and head and head[0] in ("fn", "fun"):
        if head[:2] in around or len(around) >= _MOST_AROUND:
            return True
        around = (*around, head[:2])
    return any(_is_intricate(part, around) for part in parts)


_MOST_AROUND = 4


def _hint(value: FunctionVal) -> str:
    match value:
        case Closure():
            return "fn"
        case NamedFunction(symbol=symbol):
            return symbol.name
        case BuiltinFunction(node=node):
            return node.name
        case ConstructorFunction(constructor=constructor):
            return constructor.name
        case Partial(function=function):
            return _hint(function)


def _span(value: FunctionVal) -> Span | None:
    match value:
        case Closure(function=function):
            return function.span
        case BuiltinFunction(node=node):
            return node.span
        case Partial(function=function):
            return _span(function)
        case NamedFunction(group=group):
            return group.span
        case ConstructorFunction():
            return None


def _name(code: Ir) -> str:
    match code:
        case ir.Use(local=local):
            return local.hint
        case ir.Bound(name=name) | ir.GlobalUse(name=name):
            return name
        case ir.Member(label=label):
            return label
    return "captured"


def argument_type(program: Program, value: Val) -> Type:
    """The type of what a function takes."""
    if isinstance(value, Closure | NamedFunction | BuiltinFunction | ConstructorFunction | Partial):
        return function_type(value).argument
    code = value
    assert not is_static(code)
    return program.types.functions[code.type.name].argument  # type: ignore[union-attr]  # only function values are here
