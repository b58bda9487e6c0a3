"""Declarations: `val`, `fun`, `type`, `datatype`, `exception`, `local`, `open`, `structure`.

`declare(dec)` enters the names into the present scope and gives a function that builds the core declarations
once all types are known. It serves the top level and `let` alike.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from pn2code.base.weakly import weakly
from pn2code.diagnostics import NOWHERE, SourceText, Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import UNIT
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing import matches
from pn2code.ml.typing.annotations import Annotations
from pn2code.ml.typing.context import Context, Draft
from pn2code.ml.typing.environment import Binding, TypeCon
from pn2code.ml.typing.expressions import Expressions
from pn2code.ml.typing.function_declarations import FunctionDeclarations
from pn2code.ml.typing.generalising import Build
from pn2code.ml.typing.matches import BuiltRule
from pn2code.ml.typing.modules import Modules
from pn2code.ml.typing.names import Names
from pn2code.ml.typing.patterns import Bindings, Deref, Patterns, is_irrefutable
from pn2code.ml.typing.type_declarations import TypeDeclarations, nothing

_NO_BODY = core.RecordExp((), UNIT, Span(SourceText("", NOWHERE), 0, 0))


class Declarations(FunctionDeclarations, TypeDeclarations):
    """Enters declarations."""

    def __init__(
        self,
        ctx: Context,
        annotations: Annotations,
        patterns: Patterns,
        expressions: Expressions,
        names: Names,
    ) -> None:
        super().__init__(ctx, annotations, patterns, expressions)
        declare = weakly(self.declare)
        self._modules = Modules(ctx, annotations, names, declare)
        expressions.declare = declare

    def declare(self, dec: s.Dec) -> Build:
        """Enters a declaration."""
        match dec:
            case s.ValDec():
                return self._val(dec)
            case s.FunDec():
                return self._fun(dec)
            case s.ExpDec():
                return self._expression(dec)
            case s.TypeDec():
                for binding in dec.bindings:
                    self._type(binding)
                return nothing
            case s.DatatypeDec():
                return self._datatype(dec)
            case s.DatatypeCopyDec():
                self._datatype_copy(dec)
                return nothing
            case s.ExceptionDec():
                return self._exception(dec)
            case s.LocalDec():
                return self._local(dec)
            case s.AbstypeDec():
                return self._abstype(dec)
            case s.OpenDec():
                self._modules.open(dec)
                return nothing
            case s.StructureDec():
                return partial(_all, self._modules.structures(dec))
            case s.SignatureDec():
                self._modules.signatures(dec)
                return nothing
            case s.FunctorDec():
                self._modules.functors(dec)
                return nothing
            case s.InfixDec():
                return nothing

    # --- values

    def _val(self, dec: s.ValDec) -> Build:
        at_top = self._ctx.at_top
        explicit = self._enter(dec)
        bindings = Bindings()
        made: list[tuple[Callable[[], core.Pat], Draft, s.ValBinding, list[Deref], bool]] = []
        plain = [b for b in dec.bindings if not b.recursive]
        recursive = [b for b in dec.bindings if b.recursive]
        for b in plain:
            t = self._ctx.unifier.fresh()
            own = Bindings()
            pattern = self._patterns.check(b.pattern, t, own)
            value = self._expressions.check(b.value, t, _value_of(own))
            always = is_irrefutable(b.pattern, self._ctx)
            made.append((pattern, value, b, own.derefs, always))
            self._merge(bindings, own, b.span)
        rec_build = self._recursive_values(recursive, bindings)
        self._leave()
        self._generalise(bindings, all(self._expressions.is_value(b.value) for b in dec.bindings))
        self._rigid(explicit, dec.span)
        for binding in (*bindings.values(), *(x.cell for _, _, _, xs, _ in made for x in xs)):
            binding.is_global = at_top
        self._ctx.scope.values.update(bindings)
        quants = next((b.quants for b in bindings.values()), [])

        def build() -> Sequence[core.Dec]:
            with self._ctx.generics(quants):
                out: list[core.Dec] = []
                for pattern, value, b, derefs, always in made:
                    bound = pattern()
                    if not always:
                        rule = BuiltRule(core.Rule(bound, _NO_BODY, b.span), tuple(derefs))
                        matches.warn(self._ctx, [rule], "`val`", b.pattern.span, raises="Bind")
                    out.append(core.ValBind(bound, value.build(), b.span))
                    out += matches.contents(self._ctx, derefs)
                return [*out, *rec_build()]

        return build

    def _recursive_values(self, items: Sequence[s.ValBinding], bindings: Bindings) -> Build:
        """`val rec f = fn ..`."""
        own: list[tuple[Binding, s.ValBinding]] = []
        with self._ctx.block() as scope:
            for b in items:
                name = _variable(b.pattern)
                if name is None or not isinstance(b.value, s.FnExp):
                    self._ctx.error(
                        codes.VAL_REC,
                        "`val rec` binds a name to a function: `val rec f = fn ..`",
                        b.span,
                    )
                    continue
                binding = Binding(name, self._ctx.unifier.fresh())
                scope.values[name] = binding
                self._patterns.check(b.pattern, binding.type, Bindings())
                named = Bindings()
                named[name] = binding
                self._merge(bindings, named, b.span)
                own.append((binding, b))
            drafts = [
                (
                    binding,
                    self._expressions.check(b.value, binding.type, f"value of `{binding.name}`"),
                    b,
                )
                for binding, b in own
            ]

        def build() -> Sequence[core.Dec]:
            if not drafts:
                return ()
            pairs = []
            for binding, draft, _ in drafts:
                value = draft.build()
                assert isinstance(value, core.Lambda)
                pairs.append((self._ctx.symbol_of(binding), value))
            return (core.RecBind(tuple(pairs), drafts[0][2].span),)

        return build

    def _merge(self, bindings: Bindings, own: Bindings, span: Span) -> None:
        for name in own:
            if name in bindings:
                self._ctx.error(
                    codes.DUPLICATE_NAME, f"`{name}` is bound twice in one declaration", span
                )
        bindings.update(own)

    def _expression(self, dec: s.ExpDec) -> Build:
        self._enter(dec)
        draft = self._expressions.infer(dec.exp)
        self._leave()
        self._ctx.unifier.lower(draft.type)

        def build() -> Sequence[core.Dec]:
            value = draft.build()
            return (core.ValBind(core.PWild(value.type, dec.span), value, dec.span),)

        return build

    # --- blocks

    def _local(self, dec: s.LocalDec) -> Build:
        with self._ctx.block():
            hidden = [self.declare(x) for x in dec.hidden]
            with self._ctx.block() as visible_scope:
                visible = [self.declare(x) for x in dec.visible]
        self._ctx.scope.absorb(visible_scope)
        return partial(_all, [*hidden, *visible])

    def _abstype(self, dec: s.AbstypeDec) -> Build:
        with self._ctx.block() as types:
            builds = [self._datatype(dec.datatypes)]
            with self._ctx.block() as visible:
                builds += [self.declare(x) for x in dec.declarations]
        for entry in types.types.values():
            if isinstance(entry, TypeCon):
                self._ctx.equality[entry.name] = False
        self._ctx.scope.types.update(types.types)
        self._ctx.scope.absorb(visible)
        return partial(_all, builds)


def _all(builds: Sequence[Build]) -> Sequence[core.Dec]:
    return [dec for build in builds for dec in build()]


def _variable(p: s.Pat) -> str | None:
    if isinstance(p, s.TypedPat):
        return _variable(p.pattern)
    return p.name if isinstance(p, s.NamePat) else None


def _value_of(bindings: Bindings) -> str:
    return f"value of `{next(iter(bindings))}`" if len(bindings) == 1 else "value"
