"""One flat expression, atoms and words between them, becomes a tree."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from pn2code.diagnostics import Span
from pn2code.ml.parsing import advice
from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.long_chains import LONG_CHAIN, shortened

if TYPE_CHECKING:
    from pn2code.ml.parsing.fixity import Resolver


_OPEN_ENDED = (s.IfExp, s.WhileExp, s.CaseExp, s.FnExp, s.RaiseExp)
_OPEN_WORD = {
    "IfExp": "if",
    "WhileExp": "while",
    "CaseExp": "case",
    "FnExp": "fn",
    "RaiseExp": "raise",
}


class FlatSequence:
    """One flat expression: `handle` binds loosest, then `orelse`, `andalso`, `:`, and infix operators."""

    def __init__(self, resolver: Resolver, flat: s.FlatExp) -> None:
        self._r = resolver
        self._items = flat.items
        self._at = 0
        self._around: dict[int, Span] = {}
        """Of operands in parentheses, by `id`: their spans with these."""

    def resolve(self) -> s.Exp:
        """The tree."""
        exp = self._orelse()
        while self._at < len(self._items):
            item = self._items[self._at]
            if not isinstance(item, s.Handler):
                raise self._r.error("this cannot follow `handle`", item.span)
            exp = s.HandleExp(exp, self._r.rules(item.rules), self._span(exp).to(item.span))
            self._at += 1
        return exp

    def _word(self) -> str:
        item = self._items[self._at] if self._at < len(self._items) else None
        return item.word if isinstance(item, s.Keyword) else ""

    def _orelse(self) -> s.Exp:
        parts = [self._andalso()]
        while self._word() == "orelse":
            self._at += 1
            parts.append(self._andalso())
        return _logic(False, parts, self._span)

    def _andalso(self) -> s.Exp:
        parts = [self._typed()]
        while self._word() == "andalso":
            self._at += 1
            parts.append(self._typed())
        return _logic(True, parts, self._span)

    def _typed(self) -> s.Exp:
        exp = self._infix()
        while self._at < len(self._items):
            item = self._items[self._at]
            if not isinstance(item, s.Constraint):
                break
            exp = s.TypedExp(exp, item.type, self._span(exp).to(item.span))
            self._at += 1
        if self._at < len(self._items) and not isinstance(
            self._items[self._at], s.Keyword | s.Handler
        ):
            item = self._items[self._at]
            raise self._r.error(
                "this cannot follow a type", item.span, "use parentheses: `(e : t)`"
            )
        return exp

    def _infix(self) -> s.Exp:
        start = self._at
        atoms: list[s.Exp] = []
        while self._at < len(self._items):
            item = self._items[self._at]
            if isinstance(item, s.Keyword | s.Constraint | s.Handler):
                break
            atoms.append(item)
            self._at += 1
        if not atoms:
            at = self._items[min(start, len(self._items) - 1)]
            word = f"`{at.word}`" if isinstance(at, s.Keyword) else "this"
            raise self._r.error(f"an expression is missing beside {word}", at.span)
        if len(atoms) > 1 and isinstance(atoms[-1], _OPEN_ENDED):
            word = _OPEN_WORD[type(atoms[-1]).__name__]
            raise self._r.error(
                f"`{word}` must be in parentheses here", atoms[-1].span, f"write `({word} ..)`"
            )
        exp = self._r.infix(atoms, self._operator, self._operand, self._join)
        return shortened(exp, self._r.fixities) if len(atoms) > LONG_CHAIN else exp

    def _operator(self, item: s.Exp) -> tuple[str, tuple[int, str]] | None:
        if isinstance(item, s.NameExp) and not item.op and item.name in self._r.fixities:
            return item.name, self._r.fixities[item.name]
        return None

    def _operand(self, atoms: Sequence[s.Exp]) -> s.Exp:
        for atom in atoms[1:-1]:
            if (
                isinstance(atom, s.NameExp)
                and not atom.op
                and atom.name in advice.FOREIGN_OPERATORS
            ):
                raise self._r.foreign(atom)
        exp = self._r.exp(atoms[0])
        if len(atoms) == 1:
            self._around[id(exp)] = atoms[0].span
        for atom in atoms[1:]:
            exp = s.ApplyExp(exp, self._r.exp(atom), atoms[0].span.to(atom.span))
        return exp

    def _join(self, operator: s.Exp, left: s.Exp, right: s.Exp) -> s.Exp:
        assert isinstance(operator, s.NameExp)
        return s.InfixExp(operator, left, right, self._span(left).to(self._span(right)))

    def _span(self, exp: s.Exp) -> Span:
        """The span of a part of this sequence, with the parentheses around it."""
        return self._around.get(id(exp), exp.span)


def _logic(conjunction: bool, parts: Sequence[s.Exp], span_of: Callable[[s.Exp], Span]) -> s.Exp:
    if len(parts) > LONG_CHAIN:  # in which order does not matter
        middle = len(parts) // 2
        left = _logic(conjunction, parts[:middle], span_of)
        right = _logic(conjunction, parts[middle:], span_of)
        return s.LogicExp(conjunction, left, right, span_of(left).to(span_of(right)))
    exp = parts[-1]
    for part in reversed(parts[:-1]):
        exp = s.LogicExp(conjunction, part, exp, span_of(part).to(span_of(exp)))
    return exp
