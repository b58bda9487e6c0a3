"""What the names that a net declares stand for, as far as it can be told without compiling anything."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pn2code.lowering import prelude
from pn2code.lowering.expressions.parameters import split_parameters
from pn2code.lowering.expressions.type_terms import has_function as type_has_function
from pn2code.lowering.expressions.values import BuiltinFunction, pattern_symbols
from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol
from pn2code.ml.core.types import BOOL

if TYPE_CHECKING:
    from pn2code.lowering.expressions.builtins import Builtins


class DeclaredNames:
    """What the names of a net's declarations, and of the prelude, stand for.

    Args:
        program: the declarations.
        builtins: the built-in functions.
        real_time: whether time is `real`, which the prelude depends on.
    """

    def __init__(self, program: core.Program, builtins: Builtins, real_time: bool) -> None:
        self.core = program
        self.builtins = builtins
        self.real_time = real_time
        self._groups: dict[int, core.RecBind] = {}
        self._primitives: dict[int, core.Builtin] = {}
        self._values: dict[int, tuple[int, core.ValBind]] = {}
        for position, dec in enumerate(program.declarations):
            if isinstance(dec, core.RecBind):
                for symbol, _ in dec.bindings:
                    self._groups[symbol.uid] = dec
            elif isinstance(dec, core.ValBind):
                for symbol in pattern_symbols(dec.pattern):
                    self._values[symbol.uid] = (position, dec)

    def adopt(self, file: prelude.File) -> None:
        """Makes the functions of a file of the prelude known."""
        self._primitives.update(file.primitives)
        for dec in file.declarations:
            if isinstance(dec, core.RecBind):
                for symbol, _ in dec.bindings:
                    self._groups[symbol.uid] = dec
            elif isinstance(dec, core.ValBind):
                for symbol in pattern_symbols(dec.pattern):
                    self._values[symbol.uid] = (symbol.uid - prelude.LAST_UID, dec)

    def prelude_function(self, builtin: str) -> tuple[prelude.File, Symbol] | None:
        """The function of the prelude that a built-in function is; its file is adopted."""
        if self.builtins.is_primitive(builtin):
            return None
        found = prelude.find(builtin, self.real_time)
        if found is not None and found[1].uid not in self._groups:
            self.adopt(found[0])
        return found

    def _is_static(self, e: core.Exp) -> bool:
        """Whether a function, or a record with functions, is the same and costs nothing each time it is looked at."""
        match e:
            case core.Lambda() | core.Builtin() | core.Con() | core.Lit():
                return True
            case core.Var(symbol=symbol):
                if symbol.uid in self._values and type_has_function(symbol.type):
                    return self._is_static(self._values[symbol.uid][1].value)
                return True
            case core.RecordExp(fields=fields):
                return all(self._is_static(f) for _, f in fields)
            case core.Apply(function=core.Builtin(name="General.o"), argument=argument):
                return self._is_static(argument)
            case core.Apply():
                # A curried function that waits for more.
                head: core.Exp = e
                arguments = 0
                while isinstance(head, core.Apply):
                    if not self._is_static(head.argument):
                        return False
                    head, arguments = head.function, arguments + 1
                return arguments < self._curried(head)
        return False

    def _curried(self, e: core.Exp) -> int:
        """The number of arguments a function takes before it does anything."""
        match e:
            case core.Var(symbol=symbol) if symbol.uid in self._groups:
                group = self._groups[symbol.uid]
                function = next(f for s, f in group.bindings if s == symbol)
                return len(split_parameters(function)[0])
            case core.Builtin():
                return self.builtins.arity(BuiltinFunction(e, e.type))
        return 0

    def constant(self, e: core.Exp) -> int | float | None:
        """The number that an expression is: a literal, its negation, a value declared as one."""
        match e:
            case core.Lit(value=int() | float() as value):
                return value
            case core.Apply(function=core.Builtin(name=name), argument=argument) if name.endswith(
                ".~"
            ):
                inner = self.constant(argument)
                return None if inner is None else -inner
            case core.Var(symbol=symbol) if symbol.uid in self._values:
                dec = self._values[symbol.uid][1]
                return self.constant(dec.value) if isinstance(dec.pattern, core.PVar) else None
        return None

    def truth(self, e: core.Exp) -> bool | None:
        """What a condition always is: `true`, `false`, a value declared as one of them, `not` of such.

        The way that is never taken is not generated: in C it would be dead code.
        """
        match e:
            case core.Con(constructor=constructor) if e.type == BOOL:
                return constructor.tag == 1
            case core.Apply(function=core.Builtin(name="Bool.not"), argument=argument):
                inner = self.truth(argument)
                return None if inner is None else not inner
            case core.Var(symbol=symbol) if symbol.uid in self._values:
                dec = self._values[symbol.uid][1]
                return self.truth(dec.value) if isinstance(dec.pattern, core.PVar) else None
        return None

    def _used(self, e: core.Exp) -> tuple[core.Exp, ...]:
        """What is computed where a node names something of the declarations or of the prelude."""
        if isinstance(e, core.Builtin):
            found = self.prelude_function(e.name)
            group = self._groups.get(found[1].uid) if found is not None else None
        elif isinstance(e, core.Var):
            primitive = self._primitives.get(e.symbol.uid)
            if primitive is not None:
                return (primitive,)
            group = self._groups.get(e.symbol.uid)
        else:
            group = None
        return () if group is None else tuple(f for _, f in group.bindings)
