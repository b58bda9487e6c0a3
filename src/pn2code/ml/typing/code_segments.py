"""Code segments: the variables that they read and bind, and their action."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.diagnostics import SourceText
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol
from pn2code.ml.core.types import tuple_of
from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.fixity import Fixities, resolve_expression, resolve_pattern
from pn2code.ml.parsing.parser import (
    is_action_of_comments,
    misplaced_comment,
    parse_code,
)
from pn2code.ml.typing.environment import (
    Binding,
    BrokenEntry,
    Scope,
)
from pn2code.ml.typing.inference import (
    I_UNIT,
    from_type,
)
from pn2code.ml.typing.inscription_scope import InscriptionScope


@frozen
class TypedCode:
    """A code segment: the variables it reads, those it binds, and the action giving a value (tuple) for the latter."""

    inputs: tuple[Symbol, ...]
    outputs: tuple[Symbol, ...]
    action: core.Exp


class CodeSegments(InscriptionScope):
    """Types code segments."""

    def code_segment(self, text: SourceText, fixities: Fixities) -> TypedCode | None:
        """Inputs, outputs and action."""
        parsed = parse_code(text, self._ctx.d)
        if parsed is None:
            return None
        before = self._ctx.errors
        inputs = self._code_variables(parsed.inputs, "input", fixities)
        outputs = self._code_variables(parsed.outputs, "output", fixities)
        if inputs is None or outputs is None:
            return None
        written = parsed.action
        if written is None and not outputs and is_action_of_comments(text):
            written = s.RecordExp((), text.span())
        if written is None:
            self._ctx.error(
                codes.CODE_SEGMENT,
                "code segment has no `action`, which CPN Tools wants",
                text.span(),
                hint="write `action ..;` after it, with a value for each output variable, or `action ();`",
            )
            return None
        comment = misplaced_comment(text)
        if comment is not None:
            self._ctx.error(
                codes.CODE_SEGMENT,
                "CPN Tools does not read a comment before `action`, or after the last `;`",
                text.span(*comment),
                hint="put it behind the word `action`, or remove the `;` before it",
            )
            return None
        exp: s.Exp | None = resolve_expression(written, fixities, self._ctx.d)
        if exp is None:
            return None
        scope = Scope(self._ctx.top)
        for symbol in inputs:
            scope.values[symbol.name] = Binding(
                symbol.name, from_type(symbol.type, []), symbol=symbol, colset=symbol.colset
            )
        with self._scope(scope, on_page=True):
            wanted = from_type(tuple_of(*(x.type for x in outputs)), []) if outputs else I_UNIT
            action = self._expressions.check(exp, wanted, "action")
            return self._finish(before, lambda: TypedCode(inputs, outputs, action.build()))

    def _code_variables(
        self, pattern: s.Pat | None, word: str, fixities: Fixities
    ) -> tuple[Symbol, ...] | None:
        if pattern is None:
            return ()
        resolved = resolve_pattern(pattern, fixities, self._ctx.d)
        if resolved is None:
            return None
        parts = [p for _, p in resolved.fields] if isinstance(resolved, s.RecordPat) else [resolved]
        out: list[Symbol] = []
        for part in parts:
            if not isinstance(part, s.NamePat):
                self._ctx.error(
                    codes.CODE_SEGMENT,
                    f"`{word}` lists something that is not a variable",
                    part.span,
                    hint=f"only variables are allowed there: `{word} (x, y)`",
                )
                return None
            entry = self._variables.values.get(part.name)
            if isinstance(entry, BrokenEntry):
                self._ctx.tainted = True
                return None
            if not isinstance(entry, Binding) or entry.symbol is None:
                self._ctx.error(
                    codes.UNBOUND,
                    f"`{part.name}` is not a variable of the net",
                    part.span,
                    hint=f"`{word}` lists variables declared with `var`",
                )
                return None
            if entry.symbol in out:
                self._ctx.error(
                    codes.DUPLICATE_NAME,
                    f"`{part.name}` is listed twice",
                    part.span,
                    hint="remove one of them",
                )
                return None
            out.append(entry.symbol)
        return tuple(out)
