"""Values that the caller gives for `val NAME = ..` of a net."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from pn2code.diagnostics import Diagnostics, Origin, PlacedText, SourceText
from pn2code.ml import codes
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing.context import Context, suggestion
from pn2code.ml.typing.environment import Binding
from pn2code.ml.typing.expressions import Expressions


class GivenValues:
    """Those for one net.

    Args:
        ctx: of its declarations.
        expressions: types the net's own values, and those that are given.
        values: name -> CPN ML text.
        parse: the expression of a text; None if it was reported to be wrong.
    """

    def __init__(
        self,
        ctx: Context,
        expressions: Expressions,
        values: Mapping[str, str],
        parse: Callable[[SourceText], s.Exp | None],
    ) -> None:
        self._ctx = ctx
        self._expressions = expressions
        self._values = dict(values)
        self._parse = parse
        self._replaced: set[str] = set()

    def replace_in(self, dec: s.ValDec) -> s.ValDec:
        """`val NAME = ..` with the value that the caller has given for NAME; its type must stay."""
        if not self._values:
            return dec
        bindings = []
        for b in dec.bindings:
            pattern = b.pattern.pattern if isinstance(b.pattern, s.TypedPat) else b.pattern
            if isinstance(pattern, s.NamePat) and pattern.name in self._values:
                name = pattern.name
                self._replaced.add(name)
                origin = replace(self._given_at(name), part="declaration")
                if not origin.line:
                    origin = replace(origin, line=1, column=1)
                given = self._parse(SourceText(self._values[name], origin))
                if given is not None and self._same_type(b.value, given, name):
                    b = replace(b, value=given)
            bindings.append(b)
        return replace(dec, bindings=tuple(bindings))

    def refuse_unknown(self) -> None:
        """Reports those given for values that the net does not declare."""
        for name in sorted(self._values.keys() - self._replaced):
            known = [n for n, e in self._ctx.top.values.items() if isinstance(e, Binding)]
            self._ctx.d.error(
                codes.UNKNOWN_VALUE,
                f"the net declares no value `{name}` that could be replaced",
                self._given_at(name),
                hint=suggestion(name, known),
            )

    def _given_at(self, name: str) -> Origin:
        """Where the value for `val NAME` stands."""
        given = self._values[name]
        file = given.origin if isinstance(given, PlacedText) else Origin("command line")
        return replace(file, element=f"value `{name}`")

    def _same_type(self, old: s.Exp, new: s.Exp, name: str) -> bool:
        quiet, self._ctx.d = self._ctx.d, Diagnostics()
        errors = self._ctx.errors
        try:
            t = self._expressions.infer(old).type
            failed = self._ctx.d.has_errors
        finally:
            self._ctx.d = quiet
            self._ctx.errors = errors
        self._ctx.open_records.clear()
        if failed:
            return False  # the net's own value is wrong, which is reported when it is declared
        self._expressions.check(new, t, f"value given for `{name}`")
        return self._ctx.errors == errors
