"""Inscriptions of a net: arc expressions, initial markings, guards, delays, priorities."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import accumulate

from pn2code.diagnostics import Diagnostics, SourceText
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.computing import Computed
from pn2code.ml.core.terms import Symbol
from pn2code.ml.core.types import BOOL, INTINF, REAL, TCon, TFun, Type, list_of, timed_of, tuple_of
from pn2code.ml.library.builtins import BUILTINS
from pn2code.ml.library.datatypes import FALSE, TRUE
from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.fixity import Fixities, resolve_expression
from pn2code.ml.parsing.lexer import tokenize
from pn2code.ml.parsing.parser import (
    parse_expression,
    parse_expressions,
)
from pn2code.ml.parsing.pasted import is_whole_delay
from pn2code.ml.typing import type_advice
from pn2code.ml.typing.context import Context, Draft
from pn2code.ml.typing.environment import (
    Binding,
    BrokenEntry,
    BuiltinEntry,
    Scope,
)
from pn2code.ml.typing.expressions import Expressions
from pn2code.ml.typing.inference import (
    I_BOOL,
    I_INT,
    ICon,
    Ty,
    from_type,
    i_list,
    prune,
    to_type,
)
from pn2code.ml.typing.inscription_scope import InscriptionScope
from pn2code.ml.typing.layered_patterns import comparing, matches
from pn2code.ml.typing.mismatches import explain
from pn2code.ml.typing.patterns import Bindings, Patterns

_ALL_OF_LIST = "write `List.all (fn c => c) (..)`, which is one condition"

_DELAYS = {"Time.@+": "Time.token@+", "Time.@++": "Time.token@++"}
"""How a delay is added to a multi-set, and to one token."""


class Inscriptions(InscriptionScope):
    """Types inscriptions; their texts may use the net variables of `variables`."""

    def __init__(
        self,
        ctx: Context,
        expressions: Expressions,
        patterns: Patterns,
        variables: Scope,
        computed: Callable[[core.Exp], Computed],
    ) -> None:
        super().__init__(ctx, expressions, variables)
        self._patterns = patterns
        self._computed = computed

    # --- arc expressions and initial markings

    def expression(
        self,
        text: SourceText,
        exp: s.Exp,
        types: Sequence[Type],
        expected_name: str,
        declared: Mapping[str, Symbol],
    ) -> tuple[int, core.Exp] | None:
        """The first type that fits."""
        what = text.origin.part or "expression"
        # Only arcs know the variables of the net.
        scope = Scope(self._ctx.top if what == "initial marking" else self._variables)
        for name, symbol in declared.items():
            scope.values[name] = Binding(
                name, from_type(symbol.type, []), symbol=symbol, colset=symbol.colset
            )
        with self._scope(scope, on_page=bool(text.origin.part)), self._one_mistake():
            before = self._ctx.errors
            self._ctx.token = (exp, types[0]) if types else None
            found = self._first(exp, types)
            self._ctx.token = None
            if isinstance(found, tuple):
                return self._finish(before, lambda: (found[0], found[1].build()))
            if self._ctx.errors == before and not self._ctx.tainted:
                explain(
                    self._ctx,
                    self._expressions,
                    exp,
                    found,
                    types,
                    what,
                    expected_name,
                    self._delayed(exp),
                )
            return None

    def layered(
        self, name: s.Exp, written: s.Pat, t: Type
    ) -> tuple[core.Exp, core.Pat, core.Exp] | None:
        """`x as pattern` on an input arc: the token, the pattern for it, and whether the token matches."""
        with self._scope(self._variables, on_page=True), self._one_mistake():
            before = self._ctx.errors
            wanted = from_type(t, [])
            draft = self._expressions.check(name, wanted, "inscription")
            bindings = Bindings()
            pattern = self._patterns.check_on_arc(written, wanted, bindings)
            variables: dict[str, Symbol] = {}
            constants: dict[Symbol, core.Var] = {}
            for own in bindings.values():
                known = self._variables.value(own.name)
                if isinstance(known, BrokenEntry):
                    self._ctx.tainted = True
                elif not isinstance(known, Binding) or known.symbol is None:
                    self._ctx.error(
                        codes.UNBOUND,
                        f"`{own.name}` is not a variable of the net",
                        written.span,
                        hint=f"declare it: `var {own.name} : C;` for a variable of colour set C",
                    )
                elif self._ctx.unify(own.type, known.type, written.span, f"`{own.name}`"):
                    variables[own.name] = known.symbol
                    if own.name not in self._variables.values:
                        constants[known.symbol] = core.Var(
                            known.symbol, known.symbol.type, written.span
                        )

            def build() -> tuple[core.Exp, core.Pat, core.Exp] | None:
                whole = draft.build()
                if not isinstance(whole, core.Var) or whole.symbol.colset is None:
                    self._ctx.error(
                        codes.SYNTAX_ERROR,
                        "a variable of the net is needed before `as`",
                        name.span,
                    )
                    return None
                own = pattern()  # with symbols of its own: they are compared with the variables
                test = matches(whole, own, variables)
                for binding in bindings.values():
                    binding.symbol = variables[binding.name]
                inner = comparing(pattern(), constants)
                bound = core.PAs(whole.symbol, inner, t, written.span)
                return whole, bound, test

            return self._finish(before, build)

    def plain(
        self, exp: s.Exp, types: Sequence[Type], what: str, *, on_page: bool = False
    ) -> tuple[int, core.Exp] | None:
        """An expression without net variables."""
        with self._scope(self._ctx.top, on_page=on_page):
            before = self._ctx.errors
            if len(types) == 1:
                draft = self._expressions.check(exp, from_type(types[0], []), what)
                return self._finish(before, lambda: (0, draft.build()))
            found = self._first(exp, types)
            if isinstance(found, tuple):
                return self._finish(before, lambda: (found[0], found[1].build()))
            if self._ctx.errors == before and not self._ctx.tainted:
                self._expressions.check(exp, from_type(types[0], []), what)
            return None

    def _first(self, exp: s.Exp, types: Sequence[Type]) -> tuple[int, Draft] | Draft:
        """Index and draft for the first type that fits; only the draft if none does."""
        delayed = self._delayed(exp)
        if delayed is not None:
            return self._first_delayed(*delayed, types)
        draft = self._expressions.infer(exp)
        for i, t in enumerate(types):
            if self._ctx.unifier.attempt(draft.type, from_type(t, [])):
                return i, draft
        return draft

    def _delayed(self, exp: s.Exp) -> tuple[s.InfixExp, str] | None:
        """`e @+ d` at the top."""
        if isinstance(exp, s.InfixExp):
            entry = self._ctx.scope.value(exp.operator.name)
            if isinstance(entry, BuiltinEntry) and entry.name in _DELAYS:
                return exp, entry.name
        return None

    def _first_delayed(
        self, exp: s.InfixExp, operator: str, types: Sequence[Type]
    ) -> tuple[int, Draft] | Draft:
        """The left side of `e @+ d` may be a token or a multi-set: the place's colour set decides."""
        left = self._expressions.infer(exp.left)
        time = REAL if self._ctx.real_time else INTINF
        delay_type: Type = time if operator.endswith("++") else TCon("int")
        delay = self._expressions.check(exp.right, from_type(delay_type, []), "delay")
        for i, t in enumerate(types):
            if not isinstance(t, TCon):
                continue
            inner = t.args[0] if t.args else None
            if t.name == "timed" and inner is not None:
                wanted, name, base = inner, _DELAYS[operator], inner
            elif t.name == "list" and isinstance(inner, TCon) and inner.name == "timed":
                wanted, name, base = list_of(inner.args[0]), operator, inner.args[0]
            else:
                continue
            if self._ctx.unifier.attempt(left.type, from_type(wanted, [])):
                if name in _DELAYS.values():
                    self._refuse_parentheses(exp)
                full = TFun(tuple_of(wanted, delay_type), t)

                def build(
                    name: str = name,
                    full: TFun = full,
                    base: Type = base,
                ) -> core.Exp:
                    function = core.Builtin(name, full, exp.operator.span, (base,))
                    pair = core.RecordExp(
                        (("1", left.build()), ("2", delay.build())), full.argument, exp.span
                    )
                    return core.Apply(function, pair, full.result, exp.span)

                return i, Draft(from_type(t, []), build)
        assert BUILTINS[operator]
        element = prune(left.type)
        if isinstance(element, ICon) and element.name == "list":
            return Draft(i_list(ICon("timed", element.args)), left.build)
        return Draft(ICon("timed", (left.type,)), left.build)

    def _refuse_parentheses(self, exp: s.InfixExp) -> None:
        """CPN Tools completes a token with a delay to a multi-set where the delay stands outside of parentheses."""
        words = [t.text for t in tokenize(exp.span.source, Diagnostics()) or ()]
        depths = list(accumulate((w == "(") - (w == ")") for w in words))
        if words[:1] == ["("] and depths.index(0) == len(words) - 1:
            self._ctx.error(
                codes.TYPE_MISMATCH,
                f"one token with a delay in parentheses: to CPN Tools `{exp.operator.name}` is there the one of "
                "multi-sets",
                exp.span,
                hint="leave the parentheses out, or write 1` before the token",
            )

    # --- guards

    def guard(self, text: SourceText, fixities: Fixities) -> tuple[core.Exp, ...] | None:
        """The conjuncts."""
        tokens = tokenize(text, self._ctx.d)
        if tokens is None:
            return None
        if not tokens:
            return ()
        parsed = parse_expressions(text, self._ctx.d)
        if parsed is None:
            return None
        resolved = [resolve_expression(e, fixities, self._ctx.d) for e in parsed]
        is_alone = len(resolved) == 1
        if len(resolved) == 1 and isinstance(resolved[0], s.ListExp):
            resolved = list(resolved[0].items)
            is_alone = False
        with self._scope(self._variables, on_page=True):
            before = self._ctx.errors
            drafts = []
            for e in resolved:
                if e is not None:
                    with self._one_mistake():
                        drafts.append(self._conjunct(e, is_alone))
            if len(drafts) != len(resolved):
                return None
            return self._finish(before, lambda: tuple(x.build() for x in drafts))

    def _conjunct(self, e: s.Exp, is_alone: bool) -> Draft:
        """A condition; where it is the whole guard, without brackets, also an expression for a list of conditions."""
        draft = self._expressions.infer(e)
        if self._ctx.unifier.attempt(draft.type, I_BOOL):
            return draft
        shown = self._ctx.show(draft.type)
        is_list = self._ctx.unifier.attempt(draft.type, i_list(I_BOOL))
        if is_list and is_alone:
            if isinstance(e, s.InfixExp) and e.operator.name != "::":
                self._ctx.d.warning(
                    codes.GUARD_OPERATOR,
                    f"CPN Tools cannot check a page with this guard: `{e.operator.name}` makes its list of conditions",
                    e.span,
                    hint="write the conditions in one pair of brackets, `[a, b]`, or as one: "
                    "`List.all (fn c => c) (..)`",
                )
            elif not _is_written_list(e):
                self._ctx.d.warning(
                    codes.GUARD_LIST,
                    "CPN Tools accepts this guard, but does not test it: it computes a list of conditions",
                    e.span,
                    hint=_ALL_OF_LIST,
                )
            return Draft(I_BOOL, lambda: _all_true(draft.build()))
        if is_list:
            self._ctx.error(
                codes.GUARD_TYPE,
                "a condition of the guard is a list of conditions, and CPN Tools refuses lists in lists",
                e.span,
                label=f"this is `{self._ctx.show(draft.type)}`",
                hint="write the conditions in one pair of brackets: `[a, b]`"
                if isinstance(e, s.ListExp)
                else _ALL_OF_LIST,
            )
            return draft
        self._ctx.error(
            codes.GUARD_TYPE,
            f"guard is `{shown}`, but a condition (`bool`) is expected",
            e.span,
            label=f"this is `{shown}`",
            hint=type_advice.wrong_operand("condition of `if`", draft.type, e.span.text)
            or type_advice.wrong_value(draft.type, I_BOOL, e.span.text),
        )
        return draft

    def condition(self, exp: s.Exp, declared: Mapping[str, Symbol]) -> core.Exp | None:
        """Of type bool, without the variables of the net."""
        scope = Scope(self._ctx.top)
        for name, symbol in declared.items():
            scope.values[name] = Binding(name, from_type(symbol.type, []), symbol=symbol)
        with self._scope(scope), self._one_mistake():
            before = self._ctx.errors
            draft = self._expressions.check(exp, I_BOOL, "condition")
            return self._finish(before, draft.build)

    def any(self, exp: s.Exp, declared: Mapping[str, Symbol]) -> tuple[core.Exp, Type] | None:
        """Of whatever type it has, without the variables of the net."""
        scope = Scope(self._ctx.top)
        for name, symbol in declared.items():
            scope.values[name] = Binding(name, from_type(symbol.type, []), symbol=symbol)
        with self._scope(scope), self._one_mistake():
            before = self._ctx.errors
            draft = self._expressions.infer(exp)
            return self._finish(before, lambda: (draft.build(), self._most_general(draft.type)))

    def _most_general(self, t: Ty) -> Type:
        """A type with variables for what nothing decides; nobody goes on with it."""
        self._ctx.unifier.level = 0
        for index, quant in enumerate(self._ctx.unifier.generalise([t])):
            quant.index = index
        return to_type(t)

    # --- delays and priorities

    def delay(self, text: SourceText, fixities: Fixities) -> core.Exp | None:
        """The expression after `@+` or `@++`."""
        tokens = tokenize(text, self._ctx.d)
        if tokens is None:
            return None
        if not tokens or tokens[0].text not in ("@+", "@++"):
            merged = bool(tokens) and tokens[0].text.startswith("@+")
            span = text.span(tokens[0].start, tokens[0].end) if tokens else text.span()
            self._ctx.error(
                codes.DELAY,
                "time inscription does not begin with `@+`",
                span,
                hint="adjacent symbols are read as one name: put a blank after `@+`"
                if merged
                else "write `@+ delay`, e.g. `@+ 5`",
            )
            return None
        time = REAL if self._ctx.real_time else INTINF
        wanted: Type = time if tokens[0].text == "@++" else TCon("int")
        parsed = parse_expression(text, self._ctx.d, skip=1)
        exp = None if parsed is None else resolve_expression(parsed, fixities, self._ctx.d)
        if exp is None:
            return None
        with self._scope(self._variables, on_page=True), self._one_mistake():
            before = self._ctx.errors
            draft = self._expressions.check(exp, from_type(wanted, []), "delay")
            built = self._finish(before, draft.build)
        if built is not None and not is_whole_delay(text, fixities):
            symbol, start, end = tokens[0].text, tokens[1].start, tokens[-1].end
            delay = text.text[start:end]
            self._ctx.error(
                codes.DELAY_PARENTHESES,
                "this delay must be in parentheses: CPN Tools refuses the transition (`Error in time region`)",
                text.span(start, end),
                hint=f"write `{symbol}({delay})`"
                if "\n" not in delay and len(delay) <= 60
                else f"put everything after `{symbol}` in parentheses",
            )
            return None
        return built

    def priority(self, text: SourceText, fixities: Fixities) -> int | None:
        """The value."""
        parsed = parse_expression(text, self._ctx.d)
        exp = None if parsed is None else resolve_expression(parsed, fixities, self._ctx.d)
        if exp is None:
            return None
        with self._scope(self._ctx.top), self._one_mistake():
            before = self._ctx.errors
            draft = self._expressions.check(exp, I_INT, "priority")
            built = self._finish(before, draft.build)
        if built is None:
            return None
        computed = self._computed(built)
        value = computed.value
        if not isinstance(value, int):
            self._ctx.error(
                codes.PRIORITY,
                f"priority {computed.why}",
                exp.span,
                hint="use a number, or a `val` such as `P_HIGH`; smaller numbers go first",
            )
            return None
        if value < 0:
            self._ctx.d.warning(
                codes.PRIORITY_BELOW_ZERO,
                f"the priority is {value}: pn2code accepts it, but CPN Tools cannot start such a net",
                exp.span,
                hint="use numbers from 0 upwards; smaller numbers go first",
            )
        return value


def _is_written_list(e: s.Exp) -> bool:
    """Whether an expression shows its items: `a :: b :: nil`."""
    while isinstance(e, s.InfixExp) and e.operator.name == "::":
        e = e.right
    return isinstance(e, s.ListExp) or (isinstance(e, s.NameExp) and e.name == "nil")


def _all_true(conditions: core.Exp) -> core.Exp:
    """Whether all of a list of conditions hold: a guard that computes a list."""
    span = conditions.span
    test = TFun(BOOL, BOOL)
    over = TFun(conditions.type, BOOL)
    function = core.Builtin("List.all", TFun(test, over), span, (BOOL,))
    rules = tuple(
        core.Rule(core.PCon(c, None, BOOL, span), core.Con(c, BOOL, span), span)
        for c in (TRUE, FALSE)
    )
    same = core.Lambda(rules, test, span)
    return core.Apply(core.Apply(function, same, over, span), conditions, BOOL, span)


__all__ = ["Inscriptions", "timed_of"]
