"""Which type variables belong to a declaration, and which of its types become polymorphic."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from pn2code.diagnostics import Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing.annotations import Annotations
from pn2code.ml.typing.context import Context
from pn2code.ml.typing.declared import written_variables
from pn2code.ml.typing.expressions import Expressions
from pn2code.ml.typing.inference import IError, Meta, Quant, prune
from pn2code.ml.typing.patterns import Bindings, Patterns

Build = Callable[[], Sequence[core.Dec]]


class Generalising:
    """Enters and leaves declarations of values.

    Args:
        ctx: what is shared.
        annotations: types written types.
        patterns: types patterns.
        expressions: types expressions.
    """

    def __init__(
        self,
        ctx: Context,
        annotations: Annotations,
        patterns: Patterns,
        expressions: Expressions,
    ) -> None:
        self._ctx = ctx
        self._annotations = annotations
        self._patterns = patterns
        self._expressions = expressions

    def _enter(self, dec: s.ValDec | s.FunDec | s.ExpDec) -> dict[str, Meta]:
        """One level deeper; gives the type variables that belong to this declaration.

        These are the ones written in it outside of inner `val` and `fun`, unless they belong to one around it.
        """
        self._ctx.unifier.level += 1
        known = {name for scope in self._ctx.tyvars for name in scope}
        own: dict[str, Meta] = {}
        if not isinstance(dec, s.ExpDec):
            for name in (*dec.tyvars, *written_variables(dec)):
                if name not in known and name not in own:
                    own[name] = self._ctx.unifier.fresh(equality=name.startswith("''"))
        self._ctx.tyvars.append(own)
        return own

    def _rigid(self, explicit: dict[str, Meta], span: Span) -> None:
        """Reports type variables that turned out to be one certain type, or two that are the same."""
        seen: list[Quant] = []
        for name, meta in explicit.items():
            t = prune(meta)
            if isinstance(t, Quant) and t not in seen:
                seen.append(t)
                if t.equality and not name.startswith("''"):
                    self._ctx.error(
                        codes.NOT_EQUALITY,
                        f"values of the type variable `{name}` are compared with `=`",
                        span,
                        hint=f"write `'{name}`, which stands for types with equality",
                    )
            elif isinstance(t, IError) or self._ctx.errors:
                continue
            else:
                unknown = isinstance(t, Quant) or (isinstance(t, Meta) and not t.among)
                shown = "another one" if unknown else f"`{self._ctx.show(t)}`"
                self._ctx.error(
                    codes.TYPE_VARIABLE,
                    f"the type variable `{name}` would have to be {shown}",
                    span,
                    hint=f"`{name}` stands for any type; leave it out, or write the type that is meant",
                )

    def _leave(self) -> None:
        self._ctx.tyvars.pop()
        self._ctx.unifier.level -= 1

    def _generalise(self, bindings: Bindings, is_value: bool) -> None:
        """Quantifies the unknowns of a group; all its members share the variables."""
        if is_value:
            quants = self._ctx.unifier.generalise(b.type for b in bindings.values())
            self._ctx.refuse_unknown_rows()
            for binding in bindings.values():
                binding.quants, binding.generalised = quants, True
        else:
            for binding in bindings.values():
                self._ctx.unifier.lower(binding.type)
                self._ctx.weak.append(binding.type)
