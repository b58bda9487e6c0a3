"""Declarations of functions: `fun` with its clauses, as functions of one argument after another."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from pn2code.diagnostics import Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import TFun, Type, tuple_of
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing import matches
from pn2code.ml.typing.context import Draft
from pn2code.ml.typing.environment import Binding, ConEntry
from pn2code.ml.typing.generalising import Build, Generalising
from pn2code.ml.typing.inference import IFun, Ty, to_type
from pn2code.ml.typing.matches import BuiltRule
from pn2code.ml.typing.patterns import Bindings, Deref, expand, is_irrefutable


class FunctionDeclarations(Generalising):
    """Enters functions."""

    def _fun(self, dec: s.FunDec) -> Build:
        at_top = self._ctx.at_top
        explicit = self._enter(dec)
        bindings = Bindings()
        functions: list[s.FunBinding] = []
        for f in dec.bindings:
            assert isinstance(f, s.FunBinding)
            if f.name in bindings:
                self._ctx.error(
                    codes.DUPLICATE_NAME, f"function `{f.name}` is declared twice", f.name_span
                )
            if isinstance(self._ctx.scope.value(f.name), ConEntry):
                self._ctx.error(
                    codes.DUPLICATE_NAME,
                    f"`{f.name}` is a constructor and cannot be the name of a function",
                    f.name_span,
                )
            bindings[f.name] = Binding(f.name, self._ctx.unifier.fresh(), is_global=at_top)
            functions.append(f)
        self._ctx.scope.values.update(bindings)
        builds = [(bindings[f.name], self._function(f, bindings[f.name])) for f in functions]
        self._leave()
        self._generalise(bindings, True)
        self._rigid(explicit, functions[0].name_span)
        quants = next((b.quants for b in bindings.values()), [])

        def build() -> Sequence[core.Dec]:
            with self._ctx.generics(quants):
                symbols = [self._ctx.symbol_of(binding) for binding, _ in builds]
                pairs = tuple(
                    (symbol, made()) for symbol, (_, made) in zip(symbols, builds, strict=True)
                )
                return (core.RecBind(pairs, dec.span),)

        return build

    def _function(self, f: s.FunBinding, binding: Binding) -> Callable[[], core.Lambda]:
        fresh = self._ctx.unifier.fresh
        arguments: list[Ty] = [fresh() for _ in f.clauses[0].patterns]
        result: Ty = fresh()
        t: Ty = result
        for argument in reversed(arguments):
            t = IFun(argument, t)
        self._ctx.unify(binding.type, t, f.name_span, f"function `{f.name}`")
        rules: list[Callable[[], tuple[list[core.Pat], core.Exp, Span, tuple[Deref, ...]]]] = []
        seen: dict[int, set[str]] = {}
        for clause, written in self._choices(f):
            own = Bindings()
            patterns = [
                self._patterns.check(p, a, own) for p, a in zip(written, arguments, strict=True)
            ]
            names = seen.setdefault(id(clause), set(own))
            self._patterns.same_names(names, own, clause.patterns[0].span)
            if clause.result is not None:
                annotated = self._annotations.type(clause.result)
                self._ctx.unify(annotated, result, clause.result.span, f"result of `{f.name}`")
            with self._ctx.block() as scope:
                scope.values.update(own)
                body = self._expressions.check(clause.body, result, f"result of `{f.name}`")
            rules.append(partial(_clause, patterns, body, clause.span, tuple(own.derefs)))
        direct = len(rules) == 1 and all(
            is_irrefutable(p, self._ctx) for p in f.clauses[0].patterns
        )

        def build() -> core.Lambda:
            made = [rule() for rule in rules]
            types = [to_type(a) for a in arguments]
            return self._curried(made, types, to_type(result), direct, f)

        return build

    def _choices(self, f: s.FunBinding) -> list[tuple[s.Clause, tuple[s.Pat, ...]]]:
        """Each clause with its patterns, once for each choice of alternatives."""
        out: list[tuple[s.Clause, tuple[s.Pat, ...]]] = []
        for clause in f.clauses:
            choices = expand(clause.patterns)
            if choices is None:
                self._ctx.error(
                    codes.UNSUPPORTED_ML,
                    "a pattern with so many alternatives is not supported",
                    clause.patterns[0].span,
                )
            else:
                out += [(clause, patterns) for patterns in choices]
        return out

    def _curried(
        self,
        clauses: Sequence[tuple[list[core.Pat], core.Exp, Span, tuple[Deref, ...]]],
        arguments: Sequence[Type],
        result: Type,
        direct: bool,
        f: s.FunBinding,
    ) -> core.Lambda:
        """`fn p => e | ...`, or for several arguments `fn a => fn b => case (a, b) of ...`."""
        span = f.span
        pair = tuple_of(*arguments)
        labels = [str(i) for i in range(1, len(arguments) + 1)]
        several = len(arguments) > 1
        built = [
            BuiltRule(
                core.Rule(
                    core.PRecord(tuple(zip(labels, patterns, strict=True)), pair, at)
                    if several
                    else patterns[0],
                    body,
                    at,
                ),
                derefs,
            )
            for patterns, body, at, derefs in clauses
        ]
        matches.warn(
            self._ctx, built, f"function `{f.name}`", f.name_span, arguments=len(arguments)
        )
        if not several:
            rules = matches.assemble(self._ctx, built, arguments[0], result, span)
            return core.Lambda(rules, TFun(arguments[0], result), span)
        out: core.Exp
        if direct:
            ((patterns, out, _, _),) = clauses
        else:
            symbols = [self._ctx.fresh_symbol(f"a{i}", a) for i, a in enumerate(arguments, 1)]
            patterns = [core.PVar(x, x.type, span) for x in symbols]
            values = [core.Var(x, x.type, span) for x in symbols]
            scrutinee = core.RecordExp(tuple(zip(labels, values, strict=True)), pair, span)
            rules = matches.assemble(self._ctx, built, pair, result, span)
            out = core.Case(scrutinee, rules, result, span)
        t = result
        for pattern, argument in zip(reversed(patterns), reversed(arguments), strict=True):
            t = TFun(argument, t)
            out = core.Lambda((core.Rule(pattern, out, span),), t, span)
        assert isinstance(out, core.Lambda)
        return out


def _clause(
    patterns: Sequence[Callable[[], core.Pat]],
    body: Draft,
    span: Span,
    derefs: tuple[Deref, ...],
) -> tuple[list[core.Pat], core.Exp, Span, tuple[Deref, ...]]:
    return [p() for p in patterns], body.build(), span, derefs
