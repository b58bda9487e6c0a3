"""Expressions: type inference and translation to core in one walk.

`infer(e)` gives a `Draft`: the type so far, and a function that builds the core expression when all types
are known. `check(e, t, what)` also makes the type equal to `t`, going into branches and components first so
that an error is shown where it is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from pn2code.base.weakly import weakly
from pn2code.diagnostics import Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import BOOL, EXN, UNIT, TFun, Type
from pn2code.ml.library.datatypes import FALSE, LITERAL_TYPES, TRUE, WORD_TYPES
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing import matches, type_advice
from pn2code.ml.typing.annotations import Annotations
from pn2code.ml.typing.context import BROKEN, Context, Draft, no_expression
from pn2code.ml.typing.environment import (
    Binding,
    BuiltinEntry,
    ConEntry,
    Entry,
    InstanceEntry,
    InstanceFunction,
    Scope,
    UnsupportedEntry,
)
from pn2code.ml.typing.inference import (
    ERROR,
    I_BOOL,
    I_CHAR,
    I_EXN,
    I_REAL,
    I_STRING,
    I_UNIT,
    ICon,
    IError,
    IFun,
    IRec,
    Meta,
    Ty,
    i_list,
    i_record,
    i_tuple,
    prune,
    to_type,
)
from pn2code.ml.typing.matches import BuiltRule
from pn2code.ml.typing.names import Names
from pn2code.ml.typing.patterns import Bindings, Deref, Patterns, expand
from pn2code.ml.typing.shown_types import quoted

_ASSOCIATIVE = frozenset({"Ms.++", "Time.+++", "String.^", "List.@"})
"""Long chains of these become balanced trees: a sum of 1000 terms is then 10 levels deep."""
_BALANCE_FROM = 8

DeclareFunction = Callable[[s.Dec], Callable[[], Sequence[core.Dec]]]


class Expressions:
    """Infers expressions; declarations inside them are given to `declare`."""

    def __init__(
        self, ctx: Context, annotations: Annotations, patterns: Patterns, names: Names
    ) -> None:
        self._ctx = ctx
        self._annotations = annotations
        self._patterns = patterns
        self._names = names
        self.declare: DeclareFunction
        names.own = weakly(self._own)

    # --- checking against a type

    def check(self, e: s.Exp, t: Ty, what: str) -> Draft:
        """An expression that must have type `t`; `what` names it in messages (`argument of `f``)."""
        self._ctx.enter(e.span)
        draft = self._check(e, t, what)
        self._ctx.depth -= 1
        return draft

    def _check(self, e: s.Exp, t: Ty, what: str) -> Draft:
        expected = prune(t)
        match e:
            case s.IfExp():
                return self._if(e, t, what)
            case s.CaseExp():
                return self._case(e, t, what)
            case s.LetExp():
                return self._let(e, t, what)
            case s.SequenceExp():
                return self._sequence(e, t, what)
            case s.RecordExp() if isinstance(expected, IRec):
                wanted = dict(expected.fields)
                if {n for n, _ in e.fields} == set(wanted) and len(wanted) == len(e.fields):
                    return self._record(e, wanted, what)
            case s.ListExp() if isinstance(expected, ICon) and expected.name == "list":
                return self._list(e, expected.args[0], what)
            case s.FnExp() if isinstance(expected, IFun):
                return self._fn(e, expected)
            case s.RaiseExp():
                return self._raise(e, t)
            case _:
                pass
        match e:
            # What is expected of the result may tell more about the arguments, and errors are shown there.
            case s.ApplyExp():
                draft = self._apply(e, t)
            case s.InfixExp():
                draft = self._infix(e, t)
            case s.NameExp():
                self._ctx.expected = t
                draft = self.infer(e)
                self._ctx.expected = None
            case _:
                draft = self.infer(e)
        if not self._ctx.unify(draft.type, t, e.span, what):
            return Draft(t, no_expression)
        return Draft(t, draft.build)

    # --- inference

    def infer(self, e: s.Exp) -> Draft:
        """An expression of any type."""
        self._ctx.enter(e.span)
        draft = self._infer(e)
        self._ctx.depth -= 1
        return draft

    def _infer(self, e: s.Exp) -> Draft:
        match e:
            case s.LitExp():
                return self._literal(e)
            case s.NameExp():
                return self._names.infer(e.name, e.span)
            case s.ApplyExp():
                return self._apply(e)
            case s.InfixExp():
                return self._infix(e)
            case s.RecordExp():
                return self._record(e, {}, "field")
            case s.ListExp():
                return self._list(e, self._ctx.unifier.fresh(), "list")
            case s.VectorExp():
                function = s.NameExp("Vector.fromList", True, e.span)
                return self._apply(s.ApplyExp(function, s.ListExp(e.items, e.span), e.span))
            case s.SelectorExp():
                return self._selector(e)
            case s.LogicExp():
                return self._logic(e)
            case s.TypedExp():
                t = self._annotations.type(e.type)
                return self.check(e.exp, t, "expression")
            case s.FnExp():
                fresh = self._ctx.unifier.fresh
                return self._fn(e, IFun(fresh(), fresh()))
            case s.HandleExp():
                return self._handle(e)
            case s.WhileExp():
                return self._while(e)
            case s.RaiseExp():
                return self._raise(e, self._ctx.unifier.fresh())
            case s.IfExp() | s.CaseExp() | s.LetExp() | s.SequenceExp():
                return self.check(e, self._ctx.unifier.fresh(), "expression")
            case s.FlatExp():
                raise AssertionError("flat expression after the fixity pass")

    def _literal(self, e: s.LitExp) -> Draft:
        t: Ty
        match e.kind:
            case s.LitKind.INT:
                t = self._ctx.unifier.fresh(among=[c.name for c in LITERAL_TYPES])
            case s.LitKind.REAL:
                t = I_REAL
            case s.LitKind.STRING:
                t = I_STRING
            case s.LitKind.CHAR:
                t = I_CHAR
            case s.LitKind.WORD:
                t = self._ctx.unifier.fresh(among=[c.name for c in WORD_TYPES])

        return Draft(t, partial(self._literal_of, e, t))

    def _literal_of(self, e: s.LitExp, t: Ty) -> core.Exp:
        known = to_type(t)
        self._ctx.check_literal(e.value, known, e.span)
        return core.Lit(e.value, known, e.span)

    # --- application

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

    # --- records and lists

    def _record(self, e: s.RecordExp, wanted: dict[str, Ty], what: str) -> Draft:
        drafts: dict[str, Draft] = {}
        order: list[str] = []
        before = self._ctx.errors
        for label, exp in e.fields:
            if label in drafts:
                self._ctx.error(codes.DUPLICATE_NAME, f"field `{label}` is given twice", exp.span)
                continue
            order.append(label)
            if label in wanted:
                part = f"component {label}" if label.isdigit() else f"field `{label}`"
                if what not in ("field", "expression"):
                    part += f" of the {what}" if not what.startswith("component") else ""
                # Components in the wrong order are one mistake.
                is_reported = self._ctx.errors == before or not label.isdigit()
                drafts[label] = self.check(exp, wanted[label] if is_reported else ERROR, part)
            else:
                drafts[label] = self.infer(exp)
        t = i_record({label: draft.type for label, draft in drafts.items()})

        def build() -> core.Exp:
            fields = tuple((label, drafts[label].build()) for label in order)
            return core.RecordExp(fields, to_type(t), e.span)

        return Draft(t, build)

    def _list(self, e: s.ListExp, item: Ty, what: str) -> Draft:
        del what
        drafts = []
        before = self._ctx.errors
        literals: set[s.LitKind] = set()  # kinds that elements may have: long lists consist of them
        for x in e.items:
            wanted = item if self._ctx.errors == before else ERROR
            if isinstance(x, s.LitExp) and x.kind in literals and wanted is item:
                drafts.append(Draft(item, partial(self._literal_of, x, item)))
                continue
            drafts.append(self.check(x, wanted, "list element"))
            if isinstance(x, s.LitExp):
                literals.add(x.kind)
        t = i_list(item)

        def build() -> core.Exp:
            return core.ListExp(tuple(x.build() for x in drafts), to_type(t), e.span)

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

    # --- control

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

    def _own(self, entry: InstanceFunction, span: Span) -> Draft:
        """A declared function that asks for `inst ()`, declared again where it is used, with those that it needs."""
        outer = self._ctx.scope
        self._ctx.scope = Scope(self._ctx.top)
        if isinstance(self._ctx.scope.value("inst"), UnsupportedEntry):
            self._ctx.scope.values["inst"] = InstanceEntry()
        try:
            declarations = tuple(entry.declarations())
            return self.infer(s.LetExp(declarations, s.NameExp(entry.name, False, span), span))
        finally:
            self._ctx.scope = outer

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

    # --- value restriction

    def is_value(self, e: s.Exp) -> bool:
        """Whether evaluating the expression can have no effect, so that its type may be generalised."""
        match e:
            case s.LitExp() | s.NameExp() | s.FnExp() | s.SelectorExp():
                return True
            case s.RecordExp():
                return all(self.is_value(x) for _, x in e.fields)
            case s.ListExp():
                return all(self.is_value(x) for x in e.items)
            case s.TypedExp():
                return self.is_value(e.exp)
            case s.ApplyExp(function=s.NameExp() as f):
                return self._is_constructor(f.name) and self.is_value(e.argument)
            case s.InfixExp():
                return (
                    self._is_constructor(e.operator.name)
                    and self.is_value(e.left)
                    and self.is_value(e.right)
                )
            case _:
                return False

    def _is_constructor(self, name: str) -> bool:
        entry: Entry | None = self._ctx.scope.value(name)
        return isinstance(entry, ConEntry)


def _rule(
    pattern: Callable[[], core.Pat], body: Draft, span: Span, derefs: Sequence[Deref]
) -> BuiltRule:
    return BuiltRule(core.Rule(pattern(), body.build(), span), tuple(derefs))


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
