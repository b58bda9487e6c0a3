"""Which functions of the net an expression uses, directly or through other functions.

calls = Reach(net.program)
calls.uses(code.action)             # [(Symbol moveHome, span), ...] as written there
calls.everything(code.action)       # {uid: (symbol, span of the use that leads to it)}
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.diagnostics import Span
from pn2code.ml.core import terms as core
from pn2code.net.uses import pattern_variables, walk


class Reach:
    """The declarations of a program by symbol, and what can be reached from them."""

    def __init__(self, program: core.Program) -> None:
        self._bodies: dict[int, core.Exp] = {}
        for declaration in program.declarations:
            self._add(declaration)
        self._reached: dict[int, tuple[core.Symbol, ...]] = {}
        self._functions = [
            symbol
            for declaration in program.declarations
            if isinstance(declaration, core.RecBind)
            for symbol, _ in declaration.bindings
        ]

    def _add(self, declaration: core.Dec) -> None:
        """A declaration and those inside it."""
        for symbol, value in bound(declaration):
            self._bodies[symbol.uid] = value
            self.add_locals(value)

    def add_locals(self, *expressions: core.Exp) -> None:
        """Takes note of what is declared inside expressions, with `let`."""
        for e in expressions:
            for x in walk(e):
                if isinstance(x, core.Let):
                    for declaration in x.declarations:
                        for symbol, value in bound(declaration):
                            self._bodies[symbol.uid] = value

    def functions(self) -> list[core.Symbol]:
        """The functions of the declarations, in order."""
        return list(self._functions)

    def body(self, symbol: core.Symbol) -> core.Exp | None:
        """What a symbol stands for; None for variables of the net and of patterns."""
        return self._bodies.get(symbol.uid)

    def from_symbol(self, symbol: core.Symbol) -> tuple[core.Symbol, ...]:
        """The declared symbols that its meaning depends on, itself first."""
        known = self._reached.get(symbol.uid)
        if known is None:
            known = tuple(self._closure(symbol))
            self._reached[symbol.uid] = known
        return known

    def uses(self, e: core.Exp) -> Iterator[tuple[core.Symbol, Span]]:
        """The symbols that an expression mentions, in order of the text."""
        for x in walk(e):
            if isinstance(x, core.Var):
                yield x.symbol, x.span

    def everything(self, e: core.Exp) -> dict[int, tuple[core.Symbol, Span]]:
        """All declared symbols that the meaning of an expression depends on, each with where it is used first."""
        found: dict[int, tuple[core.Symbol, Span]] = {}
        for symbol, span in self.uses(e):
            for inner in self.from_symbol(symbol):
                found.setdefault(inner.uid, (inner, span))
        return found

    def _closure(self, symbol: core.Symbol) -> Iterator[core.Symbol]:
        seen: set[int] = set()
        todo = [symbol]
        while todo:
            symbol = todo.pop()
            value = self._bodies.get(symbol.uid)
            if value is None or symbol.uid in seen:
                continue
            seen.add(symbol.uid)
            yield symbol
            todo += [s for s, _ in self.uses(value)]


def bound(declaration: core.Dec) -> Iterator[tuple[core.Symbol, core.Exp]]:
    """The symbols that a declaration binds to an expression of their own."""
    match declaration:
        case core.ValBind(core.PVar(symbol), value):
            yield symbol, value
        case core.ValBind(pattern, value):
            for symbol in pattern_variables(pattern):
                yield symbol, value
        case core.RecBind(bindings):
            yield from bindings
        case _:
            return
