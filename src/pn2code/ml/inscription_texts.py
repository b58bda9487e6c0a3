"""The texts of a net's inscriptions, and of what is asked about it: parsed, typed, as core expressions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import TypeVar

from pn2code.diagnostics import Diagnostics, SourceText
from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol
from pn2code.ml.core.types import Type
from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.fixity import Fixities, resolve_expression, resolve_pattern
from pn2code.ml.parsing.parser import parse_layered
from pn2code.ml.typing.code_segments import CodeSegments, TypedCode
from pn2code.ml.typing.context import Context
from pn2code.ml.typing.inscriptions import Inscriptions

T = TypeVar("T")


class InscriptionTexts(ABC):
    """Types inscriptions after the declarations; who declares has the names."""

    _d: Diagnostics
    _ctx: Context
    _fixities: Fixities
    _inscriptions: Inscriptions
    _code_segments: CodeSegments

    @abstractmethod
    def _parse(self, text: SourceText, *, output: bool = False) -> s.Exp | None:
        """An expression with its operators resolved."""

    @abstractmethod
    def _border(self, text: SourceText, work: Callable[[], T]) -> T | None:
        """Runs one text's elaboration."""

    @abstractmethod
    def _once(self, key: Hashable, text: SourceText, work: Callable[[], T | None]) -> T | None:
        """What `work` makes of a text, or what it made of the same text elsewhere."""

    def expression(
        self,
        text: SourceText,
        types: Sequence[Type],
        *,
        expected_name: str,
        declared: Mapping[str, Symbol] | None = None,
        output: bool = False,
    ) -> tuple[int, core.Exp] | None:
        """An inscription or initial marking.

        Args:
            text: the text.
            types: tried in this order; a `timed_of(t)` stands for the form `v @+ d` (one timed token).
            expected_name: name of the place's colour set, for messages.
            declared: further names in scope.
            output: an OUTPUT arc: everything before the first `@+` is one operand (the real tool's rule).

        Returns:
            The index of the first type that fits and the expression; None when an error was reported (one
            diagnostic), or when the text uses something whose declaration has an error.
        """

        def work() -> tuple[int, core.Exp] | None:
            exp = self._parse(text, output=output)
            if exp is None:
                return None
            return self._inscriptions.expression(text, exp, types, expected_name, declared or {})

        if declared:
            return self._border(text, work)
        key = (text.text, text.origin.part, tuple(types), expected_name, output)
        return self._once(key, text, work)

    def fits(self, text: SourceText, t: Type, expected_name: str) -> bool:
        """Whether an initial marking that is well-typed could have this type as well: `empty` fits any multi-set."""
        exp = self._parse(text)
        quiet, self._ctx.d = self._ctx.d, Diagnostics()
        errors = self._ctx.errors
        try:
            return exp is not None and (
                self._inscriptions.expression(text, exp, [t], expected_name, {}) is not None
            )
        finally:
            self._ctx.d = quiet
            self._ctx.errors = errors

    def layered(self, text: SourceText, t: Type) -> tuple[core.Exp, core.Pat, core.Exp] | None:
        """`x as pattern` on an input arc: the token x, the pattern that binds, and the condition that x matches it.

        Only for texts that `is_layered`; None when an error was reported.
        """

        def work() -> tuple[core.Exp, core.Pat, core.Exp] | None:
            parsed = parse_layered(text, self._d)
            if parsed is None:
                return None
            name = resolve_expression(parsed[0], self._fixities, self._d)
            pattern = resolve_pattern(parsed[1], self._fixities, self._d)
            if name is None or pattern is None:
                return None
            return self._inscriptions.layered(name, pattern, t)

        return self._border(text, work)

    def guard(self, text: SourceText) -> tuple[core.Exp, ...] | None:
        """`[g1, g2]`, `g1, g2` or one expression -> conjuncts of type bool; empty or `[]` -> ()."""
        key = (text.text, "guard")
        return self._once(key, text, lambda: self._inscriptions.guard(text, self._fixities))

    def code_segment(self, text: SourceText) -> TypedCode | None:
        """`input (..); output (..); action exp;`."""
        return self._border(text, lambda: self._code_segments.code_segment(text, self._fixities))

    def delay(self, text: SourceText, real_time: bool = False) -> core.Exp | None:
        """`@+ e` (int; the type is int) or `@++ t` (the type is IntInf.int or real): the delay expression."""
        del real_time  # the clock is known from the beginning

        def work() -> tuple[core.Exp] | None:
            made = self._inscriptions.delay(text, self._fixities)
            return None if made is None else (made,)

        found = self._once((text.text, "delay"), text, work)
        return None if found is None else found[0]

    def priority(self, text: SourceText) -> int | None:
        """The constant value of a priority inscription."""
        return self._border(text, lambda: self._inscriptions.priority(text, self._fixities))

    def condition(
        self,
        text: SourceText,
        prepare: Callable[[s.Exp], tuple[s.Exp, Mapping[str, Symbol]] | None],
    ) -> core.Exp | None:
        """A condition that does not belong to the net, as of a property; the variables of the net are not in scope.

        Args:
            text: the text.
            prepare: changes the syntax tree, operators resolved, before it is typed, and says which further names are
                in scope; None after an error.
        """

        def work() -> core.Exp | None:
            parsed = self._parse(text)
            prepared = None if parsed is None else prepare(parsed)
            return None if prepared is None else self._inscriptions.condition(*prepared)

        return self._border(text, work)

    def evaluation(
        self,
        text: SourceText,
        prepare: Callable[[s.Exp], tuple[s.Exp, Mapping[str, Symbol]] | None],
    ) -> tuple[core.Exp, Type] | None:
        """An expression of any type that does not belong to the net, and its type; otherwise as `condition`."""

        def work() -> tuple[core.Exp, Type] | None:
            parsed = self._parse(text)
            prepared = None if parsed is None else prepare(parsed)
            return None if prepared is None else self._inscriptions.any(*prepared)

        return self._border(text, work)
