"""Exceptions as values: a union of all that the net may raise.

An exception without argument is raised and handled by name, as the runtime raises its own. One with an argument is
raised with a value of the union, which the context carries; a handler that looks at the exception gets that value, or
the constructor for the name.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING

from pn2code.diagnostics import Span
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, IrType, Stmt
from pn2code.lowering.expressions.shapes import nodes
from pn2code.lowering.expressions.values import Val
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import EXN, Type
from pn2code.ml.library.exceptions import EXCEPTIONS

if TYPE_CHECKING:
    from pn2code.lowering.expressions.body import Body
    from pn2code.lowering.expressions.functions import Program

_RAISED = "raised exception"


class Exceptions:
    """The exceptions of one net."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self._tags: dict[tuple[int, str], int] = {}
        self._plain: dict[str, core.Constructor] = {}
        self._is_caught = False
        names = {c for c, _ in EXCEPTIONS.items()}
        self._count = Counter(names)
        for dec in _declared(program.core.declarations):
            self._count[dec.constructor.name] += 1

    def type(self) -> IrType:
        """The representation of `exn`."""
        return self._program.types.lower(EXN)

    def table(self) -> str:
        """The table of `exn`."""
        return self._program.types.plain(self.type())

    def tag(self, constructor: core.Constructor, argument: IrType | None) -> int:
        """The tag of an exception; one with an argument of a type variable is one for each type."""
        key = (constructor.tag, str(argument) if argument is not None else "")
        if key not in self._tags:
            self._tags[key] = self._program.types.add_constructor(
                self.type(), constructor.name, argument
            )
        return self._tags[key]

    def is_alone(self, constructor: core.Constructor) -> bool:
        """Whether no other exception has this name."""
        return self._count[constructor.name] <= 1

    def is_plain(self, constructor: core.Constructor) -> bool:
        """Whether its name says it all."""
        return not constructor.has_argument and self.is_alone(constructor)

    def note_raised(self, constructor: core.Constructor) -> None:
        """It is raised by name somewhere."""
        self._plain[constructor.name] = constructor

    def raised(self) -> Ir:
        """The exception that was raised, as a value."""
        self._is_caught = True
        return ir.FunCall(_RAISED, (), self.type())

    def finish(self) -> dict[str, ir.Function]:
        """The function that makes a value of the exception that was raised, if any is looked at."""
        if not self._is_caught:
            return {}
        t = self.type()
        by_name = {c.name: c for c, argument in EXCEPTIONS.values() if argument is None}
        by_name.update(self._plain)
        statements: list[Stmt] = [ir.If(ir.HasPacket(), (ir.Return(ir.Packet(t)),), ())]
        for name, constructor in by_name.items():
            made = ir.MakeUnion(self.tag(constructor, None), None, t)
            statements.append(ir.If(ir.HasError(name), (ir.Return(made),), ()))
        for number, (constructor, argument) in enumerate(EXCEPTIONS.values(), 1):
            part = self._program.types.lower(argument) if argument is not None else None
            if part is None or (constructor.tag, str(part)) not in self._tags and part != ir.STRING:
                continue
            # The runtime raises it without a value.
            empty = ir.Local(number, "empty", part)
            made = ir.MakeUnion(self.tag(constructor, part), ir.Use(empty), t)
            way = (ir.Let(empty, ir.Op("zero", (), part)), ir.Return(made))
            statements.append(ir.If(ir.HasError(constructor.name), way, ()))
        statements.append(ir.Return(ir.Op("zero", (), t)))
        return {
            _RAISED: ir.Function(
                _RAISED, "raised exception", (), t, tuple(statements), False, False,
                "the exception that was raised, as a value", self._program.position,
            )
        }  # fmt: skip


def _declared(declarations: tuple[core.Dec, ...]) -> Iterator[core.ExceptionDec]:
    for dec in declarations:
        if isinstance(dec, core.ExceptionDec):
            yield dec
        inner: tuple[core.Exp, ...] = ()
        if isinstance(dec, core.ValBind):
            inner = (dec.value,)
        elif isinstance(dec, core.RecBind):
            inner = tuple(f for _, f in dec.bindings)
        for e in inner:
            for node in nodes(e):
                if isinstance(node, core.Let):
                    yield from (d for d in node.declarations if isinstance(d, core.ExceptionDec))


def _name(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    value = body.addressable(body.code(arguments[0], at), "exception")
    return ir.Op("exn.name", (value,), ir.STRING, body.program.exceptions.table())


FUNCTIONS = {"General.exnName": _name}
"""Full name -> how it is lowered."""
