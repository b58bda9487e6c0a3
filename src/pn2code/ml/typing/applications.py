"""Applications: functions, operators and selectors with their arguments."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from pn2code.diagnostics import Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import TFun, Type
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing import type_advice
from pn2code.ml.typing.context import BROKEN, Draft
from pn2code.ml.typing.environment import Binding, BuiltinEntry, ConEntry
from pn2code.ml.typing.expression_parts import ExpressionParts
from pn2code.ml.typing.inference import (
    ERROR,
    IError,
    IFun,
    IRec,
    Meta,
    Ty,
    i_record,
    i_tuple,
    prune,
    to_type,
)
from pn2code.ml.typing.shown_types import quoted

_ASSOCIATIVE = frozenset({"Ms.++", "Time.+++", "String.^", "List.@"})
"""Long chains of these become balanced trees: a sum of 1000 terms is then 10 levels deep."""
_BALANCE_FROM = 8


class Applications(ExpressionParts):
    """Types applications."""

    def _apply(self, e: s.ApplyExp, expected: Ty | None = None) -> Draft:
        if isinstance(e.function, s.SelectorExp):
            return self._select(e.function, e.argument, e.span)
        return self.application(
            self.infer(e.function),
            e.function,
            partial(self._argument, e.argument, e.function),
            e.span,
            expected,
        )

    def _argument(self, argument: s.Exp, function: s.Exp, t: Ty) -> Draft:
        return self.check(argument, t, f"argument of {_called(function)}")

    def application(
        self,
        function: Draft,
        written: s.Exp,
        argument: Callable[[Ty], Draft],
        span: Span,
        expected: Ty | None = None,
    ) -> Draft:
        """A function applied to what `argument` gives for the type it must have."""
        t = prune(function.type)
        if isinstance(t, IError):
            argument(ERROR)
            return BROKEN
        if isinstance(t, Meta):
            arrow = IFun(self._ctx.unifier.fresh(), self._ctx.unifier.fresh())
            if not t.among and t.fields is None:
                if not self._ctx.unify(t, arrow, written.span, _called(written)):
                    return BROKEN
                t = arrow
        if not isinstance(t, IFun):
            before = self._ctx.errors
            argument(ERROR)
            if self._ctx.errors > before:
                return BROKEN
            self._ctx.error(
                codes.NOT_A_FUNCTION,
                f"{_called(written)} is `{self._ctx.show(t)}`, not a function",
                written.span,
                label="this is applied to what follows",
                hint=self._application_hint(written, span),
            )
            return BROKEN
        result = t.result
        if expected is not None:
            self._ctx.unifier.attempt(result, expected)
        before = self._ctx.errors
        given = argument(t.argument)
        if self._ctx.errors > before:
            return BROKEN  # nothing is said about further arguments
        return Draft(
            result,
            lambda: core.Apply(function.build(), given.build(), to_type(result), span),
        )

    def _application_hint(self, written: s.Exp, span: Span) -> str:
        """What may be meant where something that is no function is applied."""
        if isinstance(written, s.LitExp):
            if span.source.origin.part in ("delay", "priority"):
                return (
                    "it is one expression: a number without a unit, or an operator between the two"
                )
            if span.source.origin.part == "declaration":
                return "is an operator missing between the two, or `|` before another clause?"
            return "is an operator missing between the two, such as a backquote: 1`x ?"
        arguments = [span.source.text[written.span.end : span.end].strip()]
        head: s.Exp = written
        while isinstance(head, s.ApplyExp):
            arguments.insert(0, head.argument.span.text)
            head = head.function
        if isinstance(head, s.NameExp):
            entry = self._names.lookup(head.name)
            components = 0
            if isinstance(entry, Binding) and isinstance(function := prune(entry.type), IFun):
                domain = prune(function.argument)
                components = len(domain.fields) if isinstance(domain, IRec) else 1
            hint = type_advice.not_a_function(
                head.name, arguments, components, constructor=isinstance(entry, ConEntry)
            )
            if hint:
                return hint
        return "is an operator or a comma missing between the two?"

    def _infix(self, e: s.InfixExp, expected: Ty | None = None) -> Draft:
        entry = self._ctx.scope.value(e.operator.name)
        if isinstance(entry, BuiltinEntry) and entry.name in _ASSOCIATIVE:
            return self._chain(e, expected)
        operator = self._names.infer(e.operator.name, e.operator.span)
        name = e.operator.name

        def pair(t: Ty) -> Draft:
            domain = prune(t)
            both = dict(domain.fields) if isinstance(domain, IRec) else {}
            if set(both) != {"1", "2"}:
                fresh = self._ctx.unifier.fresh
                both = {"1": fresh(), "2": fresh()}
                self._ctx.unify(
                    i_record(both), t, e.operator.span, f"operand pair of {quoted(name)}"
                )
            before, outside = self._ctx.errors, self._ctx.division
            if name == "/":
                self._ctx.division = e
            left = self.check(e.left, both["1"], f"left operand of {quoted(name)}")
            wanted = both["2"] if self._ctx.errors == before else ERROR
            right = self.check(e.right, wanted, f"right operand of {quoted(name)}")
            self._ctx.division = outside
            return _pair(left, right, e.span)

        return self.application(operator, e.operator, pair, e.span, expected)

    def _chain(self, e: s.InfixExp, expected: Ty | None) -> Draft:
        """`a ++ b ++ c ...` without recursion over the terms."""
        name = e.operator.name
        terms: list[s.Exp] = []
        operators: list[s.NameExp] = []
        node: s.Exp = e
        while isinstance(node, s.InfixExp) and node.operator.name == name:
            terms.append(node.right)
            operators.append(node.operator)
            node = node.left
        terms.append(node)
        terms.reverse()
        operators.reverse()
        function = self._names.infer(name, operators[0].span)  # one use for all of them
        operator_type = prune(function.type)
        assert isinstance(operator_type, IFun)
        t = operator_type.result
        if expected is not None:
            self._ctx.unifier.attempt(t, expected)
        drafts = []
        before = self._ctx.errors
        for x in terms:  # after one error the others are only looked at for errors inside
            wanted = t if self._ctx.errors == before else ERROR
            drafts.append(self.check(x, wanted, f"operand of `{name}`"))

        made: list[tuple[core.Exp, Type, Type]] = []

        def join(left: core.Exp, right: core.Exp, span: Span) -> core.Exp:
            if not made:
                made.append((function.build(), to_type(t), to_type(i_tuple(t, t))))
            operator, full, both = made[0]
            pair = core.RecordExp((("1", left), ("2", right)), both, span)
            return core.Apply(operator, pair, full, span)

        def build() -> core.Exp:
            if len(terms) > _BALANCE_FROM:
                operands = [(x.span, draft) for x, draft in zip(terms, drafts, strict=True)]
                return _balanced(operands, join)
            out = drafts[0].build()
            for i, draft in enumerate(drafts[1:]):
                out = join(out, draft.build(), terms[0].span.to(terms[i + 1].span))
            return out

        return Draft(t, build)

    def _selector(self, e: s.SelectorExp) -> Draft:
        field = self._ctx.unifier.fresh()
        row = self._ctx.unifier.fresh_record({e.label: field})
        self._ctx.open_records.append((row, e.span))

        def build() -> core.Exp:
            argument, result = to_type(row), to_type(field)
            symbol = self._ctx.fresh_symbol("r", argument)
            body = core.Select(e.label, core.Var(symbol, argument, e.span), result, e.span)
            rule = core.Rule(core.PVar(symbol, argument, e.span), body, e.span)
            return core.Lambda((rule,), TFun(argument, result), e.span)

        return Draft(IFun(row, field), build)

    def _select(self, selector: s.SelectorExp, argument: s.Exp, span: Span) -> Draft:
        record = self.infer(argument)
        t = prune(record.type)
        if isinstance(t, IError):
            return BROKEN
        field = self._ctx.unifier.fresh()
        row = self._ctx.unifier.fresh_record({selector.label: field})
        if not self._ctx.unify(t, row, span, f"argument of `#{selector.label}`"):
            return BROKEN
        self._ctx.open_records.append((row, selector.span))
        return Draft(
            field, lambda: core.Select(selector.label, record.build(), to_type(field), span)
        )


def _balanced(
    operands: Sequence[tuple[Span, Draft]], join: Callable[[core.Exp, core.Exp, Span], core.Exp]
) -> core.Exp:
    """A tree of operands; `join` makes one of two neighbours."""
    if len(operands) == 1:
        return operands[0][1].build()
    middle = len(operands) // 2
    span = operands[0][0].to(operands[-1][0])
    return join(_balanced(operands[:middle], join), _balanced(operands[middle:], join), span)


def _pair(left: Draft, right: Draft, span: Span) -> Draft:
    t = i_tuple(left.type, right.type)

    def build() -> core.Exp:
        return core.RecordExp((("1", left.build()), ("2", right.build())), to_type(t), span)

    return Draft(t, build)


def _called(e: s.Exp) -> str:
    if isinstance(e, s.NameExp):
        return quoted(e.name)
    if isinstance(e, s.LitExp):
        return f"`{e.span.text}`"
    if isinstance(e, s.ApplyExp):
        return f"{_called(e.function)} with these arguments"
    return "the function" if isinstance(e, s.FnExp) else "this"
