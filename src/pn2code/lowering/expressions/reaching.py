"""What an expression leads to, with all that it uses of the declarations: effects, and patterns that may not fit."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from pn2code.lowering.expressions.declared_names import DeclaredNames
from pn2code.lowering.expressions.matching import is_irrefutable
from pn2code.lowering.expressions.purity import is_impure_builtin
from pn2code.lowering.expressions.type_terms import has_function as type_has_function
from pn2code.lowering.expressions.values import (
    Binding,
    BuiltinFunction,
    Closure,
    NamedFunction,
    Partial,
    RecordVal,
    children,
)
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import TCon, TRecord

if TYPE_CHECKING:
    from pn2code.lowering.expressions.builtins import Builtins


class Reaching(DeclaredNames):
    """Asks whether something holds for what an expression leads to: its parts, and the functions that it uses."""

    def __init__(self, program: core.Program, builtins: Builtins, real_time: bool) -> None:
        super().__init__(program, builtins, real_time)
        self._impure: dict[int, bool] = {}
        self._binding: dict[int, bool] = {}

    def is_impure(self, e: core.Exp) -> bool:
        """Whether the order of evaluation matters for it."""
        return self._reaches(e, _is_impure_node, self._impure)

    def reaches(self, e: core.Exp, has: Callable[[core.Exp], bool]) -> bool:
        """Whether something holds for a part of an expression, or of what it uses of the declarations."""
        return self._reaches(e, has, {})

    def _reaches(
        self, e: core.Exp, has: Callable[[core.Exp], bool], known: dict[int, bool]
    ) -> bool:
        """Whether a property holds for a part of an expression, or of a top-level function that it uses.

        Functions may call each other: nothing is noted of one before all that it uses has been looked at.
        """
        if id(e) in known:
            return known[id(e)]
        seen, todo = {id(e)}, [e]
        while todo:
            for node in nodes(todo.pop()):
                used = self._used(node)
                if has(node) or any(known.get(id(f), False) for f in used):
                    known[id(e)] = True
                    return True
                todo += [f for f in used if id(f) not in known and id(f) not in seen]
                seen.update(map(id, used))
        known.update(dict.fromkeys(seen, False))
        return False

    def may_raise_bind(self, e: core.Exp) -> bool:
        """Whether a `val` pattern that may not fit is evaluated in an expression, directly or in a function."""
        return self._reaches(e, has_refutable_binding, self._binding)

    def _is_impure_value(self, value: Binding) -> bool:
        match value:
            case Closure(function=f):
                return self.is_impure(f)
            case NamedFunction():
                return self.is_impure(value.function)
            case BuiltinFunction(node=node):
                return is_impure_builtin(node.name)
            case Partial(function=f, arguments=arguments):
                return self._is_impure_value(f) or any(map(self._is_impure_value, arguments))
            case RecordVal(fields=fields):
                return any(map(self._is_impure_value, fields.values()))
        return False


def _is_impure_node(e: core.Exp) -> bool:
    match e:
        case core.Builtin(name=name):
            return is_impure_builtin(name)
        case core.Var(symbol=symbol):
            # A function that is a value may do anything.
            return (
                symbol.is_global
                and isinstance(symbol.type, TCon | TRecord)
                and (type_has_function(symbol.type))
            )
    return False


def has_refutable_binding(e: core.Exp) -> bool:
    """Whether it is a `let` with a pattern that may not fit, or the exception `Bind` itself."""
    if isinstance(e, core.Con):
        return e.constructor.data_type == "exn" and e.constructor.name == "Bind"
    return isinstance(e, core.Let) and any(
        isinstance(d, core.ValBind) and not is_irrefutable(d.pattern) for d in e.declarations
    )


def nodes(e: core.Exp) -> Iterator[core.Exp]:
    """An expression and all of its parts."""
    todo = [e]
    while todo:
        node = todo.pop()
        yield node
        todo += children(node)
