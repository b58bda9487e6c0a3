"""Expressions in which one thing is evaluated after another, or instead of it: `if`, `case`, `fn`, `let`, `handle`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from pn2code.diagnostics import Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import BOOL, EXN, UNIT, TFun
from pn2code.ml.library.datatypes import FALSE, TRUE
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing import matches
from pn2code.ml.typing.context import BROKEN, Draft
from pn2code.ml.typing.expression_parts import ExpressionParts
from pn2code.ml.typing.inference import I_BOOL, I_EXN, I_UNIT, IFun, Meta, Ty, prune, to_type
from pn2code.ml.typing.matches import BuiltRule
from pn2code.ml.typing.patterns import Bindings, Deref, expand


class ControlExpressions(ExpressionParts):
    """Types branches, functions, blocks, sequences and exceptions."""

    def _if(self, e: s.IfExp, t: Ty, what: str) -> Draft:
        condition = self.check(e.condition, I_BOOL, "condition of `if`")
        known = not isinstance(prune(t), Meta)
        then = self.check(e.then, t, what if known else "`then` branch")
        otherwise = self.check(e.otherwise, t, what if known else "`else` branch")
        return Draft(
            t,
            lambda: core.If(condition.build(), then.build(), otherwise.build(), to_type(t), e.span),
        )

    def _logic(self, e: s.LogicExp) -> Draft:
        word = "andalso" if e.conjunction else "orelse"
        left = self.check(e.left, I_BOOL, f"left operand of `{word}`")
        right = self.check(e.right, I_BOOL, f"right operand of `{word}`")

        def build() -> core.Exp:
            first, second = left.build(), right.build()
            if e.conjunction:
                return core.If(first, second, core.Con(FALSE, BOOL, e.span), BOOL, e.span)
            return core.If(first, core.Con(TRUE, BOOL, e.span), second, BOOL, e.span)

        return Draft(I_BOOL, build)

    def _case(self, e: s.CaseExp, t: Ty, what: str) -> Draft:
        scrutinee = self.infer(e.exp)
        rules = self.rules(e.rules, scrutinee.type, t, what)

        def build() -> core.Exp:
            made, result = rules(), to_type(t)
            matches.warn(self._ctx, made, "`case`", e.exp.span)
            argument = to_type(scrutinee.type)
            assembled = matches.assemble(self._ctx, made, argument, result, e.span)
            return core.Case(scrutinee.build(), assembled, result, e.span)

        return Draft(t, build)

    def rules(
        self, rules: Sequence[s.Rule], argument: Ty, result: Ty, what: str
    ) -> Callable[[], list[BuiltRule]]:
        """The rules of a `case`, `fn` or `handle`."""
        known = not isinstance(prune(result), Meta)
        out: list[Callable[[], BuiltRule]] = []
        for i, rule in enumerate(rules, 1):
            choices = expand([rule.pattern])
            if choices is None:
                self._ctx.error(
                    codes.UNSUPPORTED_ML,
                    "a pattern with so many alternatives is not supported",
                    rule.pattern.span,
                )
                continue
            names = set[str]()
            for choice, (written,) in enumerate(choices):
                bindings = Bindings()
                pattern = self._patterns.check(written, argument, bindings)
                names = names if choice else set(bindings)
                self._patterns.same_names(names, bindings, rule.pattern.span)
                with self._ctx.block() as scope:
                    scope.values.update(bindings)
                    name = what if known or len(rules) == 1 else f"result of rule {i}"
                    body = self.check(rule.body, result, name)
                out.append(partial(_rule, pattern, body, rule.span, bindings.derefs))
        return lambda: [build() for build in out]

    def _fn(self, e: s.FnExp, t: IFun) -> Draft:
        rules = self.rules(e.rules, t.argument, t.result, "result of the function")

        def build() -> core.Exp:
            made, full = rules(), to_type(t)
            assert isinstance(full, TFun)
            at = Span(e.span.source, e.span.start, e.span.start + 2)
            matches.warn(self._ctx, made, "`fn`", at)
            assembled = matches.assemble(self._ctx, made, full.argument, full.result, e.span)
            return core.Lambda(assembled, full, e.span)

        return Draft(t, build)

    def _let(self, e: s.LetExp, t: Ty, what: str) -> Draft:
        with self._ctx.block():
            declarations = [self.declare(dec) for dec in e.declarations]
            body = self.check(e.body, t, what)

        def build() -> core.Exp:
            made = tuple(dec for declaration in declarations for dec in declaration())
            inner = body.build()
            return core.Let(made, inner, inner.type, e.span) if made else inner

        return Draft(t, build)

    def _sequence(self, e: s.SequenceExp, t: Ty, what: str) -> Draft:
        first = [self.infer(x) for x in e.items[:-1]]
        last = self.check(e.items[-1], t, what)

        def build() -> core.Exp:
            items = (*(x.build() for x in first), last.build())
            return core.Sequence(items, to_type(t), e.span)

        return Draft(t, build)

    def _while(self, e: s.WhileExp) -> Draft:
        condition = self.check(e.condition, I_BOOL, "condition of `while`")
        body = self.infer(e.body)
        return Draft(I_UNIT, lambda: core.While(condition.build(), body.build(), UNIT, e.span))

    def _raise(self, e: s.RaiseExp, t: Ty) -> Draft:
        exception = self.infer(e.exp)
        if not self._ctx.unifier.attempt(exception.type, I_EXN):
            self._ctx.error(
                codes.EXCEPTION_TYPE,
                f"`raise` needs an exception, but this is `{self._ctx.show(exception.type)}`",
                e.exp.span,
            )
            return BROKEN
        return Draft(t, lambda: core.Raise(exception.build(), to_type(t), e.span))

    def _handle(self, e: s.HandleExp) -> Draft:
        body = self.infer(e.exp)
        rules = self.rules(e.rules, I_EXN, body.type, "result of the handler")

        def build() -> core.Exp:
            made, result = rules(), to_type(body.type)
            matches.warn(self._ctx, made, "`handle`", e.span, raises="")

            def reraise(exception: core.Symbol) -> core.Exp:
                return core.Raise(core.Var(exception, EXN, e.span), result, e.span)

            assembled = matches.assemble(self._ctx, made, EXN, result, e.span, otherwise=reraise)
            return core.Handle(body.build(), assembled, result, e.span)

        return Draft(body.type, build)


def _rule(
    pattern: Callable[[], core.Pat], body: Draft, span: Span, derefs: Sequence[Deref]
) -> BuiltRule:
    return BuiltRule(core.Rule(pattern(), body.build(), span), tuple(derefs))
