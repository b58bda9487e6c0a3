"""A block of IR statements in the making: locals, temporaries, and the forms in which values are used."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

from pn2code.diagnostics import Span
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, IrType, Local, Rep, Stmt
from pn2code.lowering.expressions.effects import (
    code_may_raise,
    has_effect,
    may_raise,
    raises_only_overflow,
)
from pn2code.lowering.expressions.functions import Program
from pn2code.lowering.expressions.matching import TypeSource
from pn2code.lowering.expressions.type_terms import substitute
from pn2code.lowering.expressions.values import (
    BuiltinFunction,
    Closure,
    ConstructorFunction,
    LocalReference,
    NamedFunction,
    Partial,
    RecordVal,
    Reference,
    TypeEnv,
    Val,
    has_function,
    is_atomic,
    is_static,
)
from pn2code.ml.core.terms import Constructor, Symbol
from pn2code.ml.core.types import Type

UNIT_VALUE = ir.Const(None, ir.UNIT)


class Block(TypeSource):
    """Statements in the making, and the locals they declare."""

    def __init__(self, program: Program, types: TypeEnv | None = None, key: str = "") -> None:
        self.program = program
        self.types: TypeEnv = types or {}
        self.key = key
        self.statements: list[Stmt] = []
        self._locals = 0
        self._inlined: list[int] = []
        self._inlines = 0
        self.has_self_call = False

    # --- small services ------------------------------------------------------------------------

    def local(self, hint: str, t: IrType) -> Local:
        """A fresh local."""
        self._locals += 1
        return Local(self._locals, hint, t)

    def emit(self, statement: Stmt) -> None:
        """Append to the present block."""
        self.statements.append(statement)

    @contextmanager
    def block(self) -> Iterator[list[Stmt]]:
        """A fresh block of statements; the present one comes back afterwards."""
        outer, self.statements = self.statements, []
        try:
            yield self.statements
        finally:
            self.statements = outer

    def type_of(self, t: Type) -> Type:
        """The type with the variables of the surrounding schemes replaced."""
        return substitute(t, self.types)

    def representation(self, t: Type) -> IrType:
        """See `TypeSource`."""
        return self.program.types.lower(self.type_of(t))

    def element(self, t: IrType) -> IrType:
        """See `TypeSource`."""
        definition = self.program.types.definition(t)
        assert isinstance(definition, ir.ListDef)
        return definition.element

    def zero(self, t: IrType) -> Ir:
        """A harmless value, after an error."""
        return UNIT_VALUE if t == ir.UNIT else ir.Op("zero", (), t)

    def literal(self, value: int | float | str, t: Type, span: Span) -> ir.Const:
        """See `TypeSource`."""
        rep = self.representation(t)
        if rep.rep is Rep.CHAR:
            return ir.Const(ord(str(value)), rep)
        return ir.Const(value, rep)

    def code(self, value: Val, at: Span | None = None) -> Ir:
        """A value as C code; records are put together."""
        if isinstance(value, RecordVal):
            t = self.representation(value.type)
            if t.rep is Rep.UNIT:
                return UNIT_VALUE
            definition = self.program.types.definition(t)
            assert isinstance(definition, ir.StructDef)
            parts = {label: self.code(v, at) for label, v in value.fields.items()}
            return ir.MakeStruct(t, tuple((label, parts[label]) for label, _ in definition.fields))
        if isinstance(value, Reference):
            return ir.AddressOf(value.name, self.program.types.reference_to(value.type))
        if isinstance(
            value, Closure | NamedFunction | BuiltinFunction | ConstructorFunction | Partial
        ):
            return self.program.function_values.make(self, value, at)
        assert not isinstance(value, LocalReference)
        return value

    def components(self, value: Val, n: int) -> list[Val]:
        """The components of a tuple of n, which C code is taken apart for."""
        if isinstance(value, RecordVal):
            return [value.fields[str(i)] for i in range(1, n + 1)]
        if n == 0:
            return []
        code = self.atomic(self.code(value), "pair")
        definition = self.program.types.definition(code.type)
        assert isinstance(definition, ir.StructDef)
        types = dict(definition.fields)
        return [ir.Member(code, str(i), types[str(i)]) for i in range(1, n + 1)]

    def tag_of(self, constructor: Constructor, argument: IrType | None) -> int:
        """See `TypeSource`."""
        if constructor.data_type == "exn":
            return self.program.exceptions.tag(constructor, argument)
        return constructor.tag

    def atomic(self, value: Ir, hint: str) -> Ir:
        """The value in a form that may be used several times."""
        return value if is_atomic(value) else self.spill(value, hint)

    def addressable(self, value: Ir, hint: str) -> Ir:
        """The value in a form whose address can be taken in C: a struct that a function returns gets a name."""
        is_struct = value.type.rep in (Rep.STRUCT, Rep.UNION)
        if is_struct and not isinstance(value, ir.MakeStruct | ir.MakeUnion):
            return self.atomic(value, hint)
        return value

    def store_in_locals(self, value: Val, hint: str) -> Val:
        """The same for a value of any kind; records stay apart."""
        if isinstance(value, RecordVal):
            fields = {
                k: self.store_in_locals(v, f"{hint}_{k}" if k.isdigit() else k)
                for k, v in value.fields.items()
            }
            return RecordVal(fields, value.type)
        if isinstance(value, Partial):
            arguments = tuple(self.store_in_locals(a, hint) for a in value.arguments)
            return Partial(value.function, arguments)
        if is_static(value):
            return value
        return self.atomic(self.code(value), hint)

    def discard(self, value: Val) -> None:
        """Nobody looks at the value, but it may raise."""
        if isinstance(value, RecordVal):
            for part in value.fields.values():
                self.discard(part)
        elif isinstance(value, Partial):
            for part in value.arguments:
                self.discard(part)
        elif not is_static(value):
            code = self.code(value)
            if code_may_raise(code):
                self.emit(ir.Do(code))

    def in_order(self, parts: Iterable[Callable[[], Val]]) -> list[Val]:
        """The values of expressions that are evaluated one after the other: what may raise is computed before what
        comes after it changes or raises something."""
        values: list[Val] = []
        pending: list[int] = []  # those of them that may still raise
        for part in parts:
            block = self.statements
            mark = len(block)
            value = part()
            if pending:
                grown = tuple(block[mark:])
                clashes = self.program.handles and (
                    (may_raise(value) or code_may_raise(grown))
                    and not all(
                        map(raises_only_overflow, [*(values[i] for i in pending), value, grown])
                    )
                )
                if clashes or has_effect(block[mark:]):
                    with self.block() as before:
                        for i in pending:
                            values[i] = self.store_in_locals(values[i], "operand")
                    block[mark:mark] = before
                    pending = []
            if may_raise(value):
                pending.append(len(values))
            values.append(value)
        return values

    def select(self, value: Val, label: str, t: Type) -> Val:
        """See `TypeSource`."""
        if isinstance(value, RecordVal):
            return value.fields[label]
        code = self.code(value)
        return ir.Member(code, label, self.representation(t))

    def spill(self, value: Ir, hint: str) -> Ir:
        """The value computed now."""
        if value.type == ir.UNIT:
            self.emit(ir.Do(value))
            return UNIT_VALUE
        local = self.local(hint, value.type)
        self.emit(ir.Let(local, value))
        return ir.Use(local)

    def bind(self, symbol: Symbol, value: Val) -> Val:
        """The value of a variable that may be used any number of times, under its name."""
        if isinstance(value, RecordVal) and not has_function(value):
            value = self.code(value)
        if isinstance(value, ir.Member | ir.Head | ir.Tail | ir.Argument):
            # A part of something gets the name it has in the pattern.
            return self.spill(value, symbol.name)
        return self.store_in_locals(value, symbol.name)
