"""The fixity pass: flat sequences of operands and operators become applications.

`1`x ++ y` parsed as a flat sequence becomes `InfixExp(++, InfixExp(`, 1, x), y)`, since the backquote binds
tighter. Which names are infix is decided by the `infix` declarations in force, so a `Fixities` goes along
and declarations change it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TypeGuard, TypeVar

from pn2code.diagnostics import Diagnostics, Span
from pn2code.ml import codes
from pn2code.ml.parsing import advice
from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.flat_sequence import FlatSequence
from pn2code.ml.parsing.tree_parts import is_long

MAX_DEPTH = 200
"""Nesting of expressions and patterns that is followed; the later stages recurse over the same trees."""

Fixities = Mapping[str, tuple[int, str]]
"""Infix names: precedence (9 binds tightest) and "left" or "right"."""


N = TypeVar("N")


class FixityError(Exception):
    """Reported already; unwinds to the border."""


def resolve_expression(exp: s.Exp, fixities: Fixities, d: Diagnostics) -> s.Exp | None:
    """An expression without flat sequences; None when an error was reported."""
    try:
        return Resolver(dict(fixities), d).exp(exp)
    except FixityError:
        return None


def resolve_pattern(pattern: s.Pat, fixities: Fixities, d: Diagnostics) -> s.Pat | None:
    """A pattern without flat sequences; None when an error was reported."""
    try:
        return Resolver(dict(fixities), d).pat(pattern)
    except FixityError:
        return None


def resolve_declaration(
    dec: s.Dec, fixities: Fixities, d: Diagnostics
) -> tuple[s.Dec, Fixities] | None:
    """A declaration without flat sequences, and the fixities in force after it; None when an error was reported."""
    resolver = Resolver(dict(fixities), d)
    try:
        resolved = resolver.dec(dec)
    except FixityError:
        return None
    return resolved, resolver.fixities


class Resolver:
    """Resolves declarations, expressions and patterns with the infix names in force."""

    def __init__(self, fixities: dict[str, tuple[int, str]], d: Diagnostics) -> None:
        self.fixities = fixities
        self._d = d
        self._depth = 0

    def error(self, message: str, span: Span, hint: str = "") -> FixityError:
        """Reports what is wrong; the exception is to be raised."""
        self._d.error(codes.FIXITY_ERROR, message, span, hint=hint)
        return FixityError()

    def _enter(self, span: Span) -> None:
        self._depth += 1
        if self._depth > MAX_DEPTH:
            self._d.error(
                codes.TOO_DEEP,
                f"this is nested more than {MAX_DEPTH} levels deep",
                Span(span.source, span.start, min(span.end, span.start + 40)),
                hint="give parts of it a name with `val` or `let`",
            )
            raise FixityError

    # --- expressions

    def exp(self, e: s.Exp) -> s.Exp:
        """An expression with its operators resolved."""
        self._enter(e.span)
        resolved = self._exp(e)
        self._depth -= 1
        return resolved

    def _exp(self, e: s.Exp) -> s.Exp:
        match e:
            case s.FlatExp():
                return FlatSequence(self, e).resolve()
            case s.RecordExp():
                return replace(e, fields=tuple((n, self.exp(x)) for n, x in e.fields))
            case s.ListExp() | s.SequenceExp() | s.VectorExp():
                return replace(e, items=tuple(self.exp(x) for x in e.items))
            case s.LetExp():
                saved = dict(self.fixities)
                declarations = tuple(self.dec(dec) for dec in e.declarations)
                body = self.exp(e.body)
                self.fixities = saved
                return replace(e, declarations=declarations, body=body)
            case s.RaiseExp():
                return replace(e, exp=self.exp(e.exp))
            case s.IfExp():
                return self._if(e)
            case s.WhileExp():
                return replace(e, condition=self.exp(e.condition), body=self.exp(e.body))
            case s.CaseExp():
                return replace(e, exp=self.exp(e.exp), rules=self.rules(e.rules))
            case s.FnExp():
                return replace(e, rules=self.rules(e.rules))
            case _:
                return e

    def _if(self, e: s.IfExp) -> s.Exp:
        return replace(
            e,
            condition=self.exp(e.condition),
            then=self.exp(e.then),
            otherwise=self.exp(e.otherwise),
        )

    def rules(self, rules: Sequence[s.Rule]) -> tuple[s.Rule, ...]:
        """Rules with their operators resolved."""
        return tuple(replace(r, pattern=self.pat(r.pattern), body=self.exp(r.body)) for r in rules)

    # --- patterns

    def pat(self, p: s.Pat) -> s.Pat:
        """A pattern with its operators resolved."""
        self._enter(p.span)
        resolved = self._pat(p)
        self._depth -= 1
        return resolved

    def _pat(self, p: s.Pat) -> s.Pat:
        match p:
            case s.FlatPat():
                return self._flat_pat(p.items, p.span)
            case s.RecordPat():
                for label, part in p.fields:
                    if not label:
                        raise self.error(
                            "a record pattern lists `label = pattern` or variables", part.span
                        )
                return replace(p, fields=tuple((n, self.pat(x)) for n, x in p.fields))
            case s.ListPat() | s.VectorPat():
                return replace(p, items=tuple(self.pat(x) for x in p.items))
            case s.OrPat():
                return replace(p, alternatives=tuple(self.pat(x) for x in p.alternatives))
            case _:
                return p

    def _flat_pat(self, items: Sequence[s.Pat | s.Keyword | s.Constraint], span: Span) -> s.Pat:
        for i, item in enumerate(items):
            if isinstance(item, s.Keyword):  # `as`
                return self._layered(items[:i], items[i + 1 :], item, span)
        typed = next((i for i, x in enumerate(items) if isinstance(x, s.Constraint)), len(items))
        pattern = self._infix_pat([x for x in items[:typed] if _is_pat(x)], span)
        for item in items[typed:]:
            if not isinstance(item, s.Constraint):
                raise self.error("a type must be the last part of a pattern", item.span)
            pattern = s.TypedPat(pattern, item.type, pattern.span.to(item.span))
        return pattern

    def _layered(
        self,
        before: Sequence[s.Pat | s.Keyword | s.Constraint],
        after: Sequence[s.Pat | s.Keyword | s.Constraint],
        keyword: s.Keyword,
        span: Span,
    ) -> s.Pat:
        match before:
            case [s.NamePat() as name]:
                annotation = None
            case [s.NamePat() as name, s.Constraint() as constraint]:
                annotation = constraint.type
            case _:
                raise self.error("a variable is needed before `as`", keyword.span)
        if is_long(name.name):
            raise self.error(
                f"`{name.name}` cannot be declared here", name.span, "a name has no points"
            )
        if not after:
            raise self.error("a pattern is needed after `as`", keyword.span)
        self._enter(span)
        inner = self._flat_pat(after, after[0].span.to(after[-1].span))
        self._depth -= 1
        return s.AsPat(name, annotation, inner, span)

    def _infix_pat(self, items: Sequence[s.Pat], span: Span) -> s.Pat:
        if not items:
            raise self.error("a pattern is missing before `:`", span)

        def join(operator: s.Pat, left: s.Pat, right: s.Pat) -> s.Pat:
            assert isinstance(operator, s.NamePat)
            both = left.span.to(right.span)
            pair = s.RecordPat((("1", left), ("2", right)), False, both)
            return s.ConPat(operator, pair, both)

        def operand(atoms: Sequence[s.Pat]) -> s.Pat:
            if len(atoms) == 1:
                return self.pat(atoms[0])
            head, argument, *rest = atoms
            if not isinstance(head, s.NamePat):
                hint = "patterns that belong together are written as a tuple: `(p, q)`"
                if isinstance(head, s.LitPat):
                    hint = "a name begins with a letter"
                raise self.error(
                    "only a constructor can be applied in a pattern", head.span, hint
                )  # fmt: skip
            if rest:
                raise self.error(
                    f"`{head.name}` is applied to more than one pattern", rest[0].span,
                    f"a constructor takes one argument; use parentheses: `({head.name} ..)`",
                )  # fmt: skip
            return s.ConPat(head, self.pat(argument), head.span.to(argument.span))

        return self.infix(items, self._is_infix_pat, operand, join)

    def _is_infix_pat(self, item: s.Pat) -> tuple[str, tuple[int, str]] | None:
        if isinstance(item, s.NamePat) and not item.op and item.name in self.fixities:
            return item.name, self.fixities[item.name]
        return None

    # --- infix sequences

    def infix(
        self,
        items: Sequence[N],
        operator_of: Callable[[N], tuple[str, tuple[int, str]] | None],
        operand: Callable[[Sequence[N]], N],
        join: Callable[[N, N, N], N],
    ) -> N:
        """Operator precedence parsing without recursion, so that long sums are no problem."""
        output: list[N] = []
        stack: list[tuple[N, str, int, str]] = []
        atoms: list[N] = []

        def reduce() -> None:
            operator, *_ = stack.pop()
            right = output.pop()
            output.append(join(operator, output.pop(), right))

        for item in items:
            found = operator_of(item)
            if found is None:
                atoms.append(item)
                continue
            name, (precedence, side) = found
            if not atoms:
                raise self._missing(name, "left", item)
            output.append(operand(atoms))
            atoms = []
            while stack and stack[-1][2] >= precedence:
                _, other, other_precedence, other_side = stack[-1]
                if other_precedence == precedence:
                    if (
                        other_side != side
                    ):  # the left one goes first, as in SML/NJ, which warns, too
                        self._d.warning(
                            codes.MIXED_OPERATORS,
                            f"`{other}` and `{name}` have the same precedence, but different associativity",
                            _span(item),
                            hint=f"`{other}` is taken first; write parentheses",
                        )
                    elif side == "right":
                        break
                reduce()
            stack.append((item, name, precedence, side))
        if not atoms:
            last = stack[-1]
            raise self._missing(last[1], "right", last[0])
        output.append(operand(atoms))
        while stack:
            reduce()
        return output[0]

    def foreign(self, operator: s.NameExp) -> FixityError:
        """Reports an operator of another language between its operands."""
        hint = advice.FOREIGN_OPERATORS[operator.name]
        return self.error(f"`{operator.name}` is not an operator of CPN ML", operator.span, hint)

    def _missing(self, name: str, side: str, item: object) -> FixityError:
        shown = "the backquote" if name == "`" else f"operator `{name}`"
        hint = advice.missing_operand(name, side)
        return self.error(f"{shown} has no {side} operand", _span(item), hint)

    # --- declarations

    def dec(self, dec: s.Dec) -> s.Dec:
        """A declaration with its operators resolved; afterwards its own `infix` is in force."""
        match dec:
            case s.ValDec():
                bindings = tuple(
                    replace(b, pattern=self.pat(b.pattern), value=self.exp(b.value))
                    for b in dec.bindings
                )
                return replace(dec, bindings=bindings)
            case s.FunDec():
                return replace(dec, bindings=tuple(self._function(b) for b in dec.bindings))
            case s.LocalDec():
                saved = dict(self.fixities)
                hidden = tuple(self.dec(x) for x in dec.hidden)
                inner = dict(self.fixities)
                visible = tuple(self.dec(x) for x in dec.visible)
                exported = {k: v for k, v in self.fixities.items() if inner.get(k) != v}
                self.fixities = saved | exported
                return replace(dec, hidden=hidden, visible=visible)
            case s.AbstypeDec():
                return replace(dec, declarations=tuple(self.dec(x) for x in dec.declarations))
            case s.StructureDec():
                bodies = tuple(replace(b, body=self.structure(b.body)) for b in dec.bindings)
                return replace(dec, bindings=bodies)
            case s.FunctorDec():
                functors = tuple(replace(b, body=self.structure(b.body)) for b in dec.bindings)
                return replace(dec, bindings=functors)
            case s.InfixDec():
                if not 0 <= dec.precedence <= 9:
                    self._d.error(
                        codes.FIXITY_ERROR,
                        "the precedence of an infix operator is a digit, 0 to 9",
                        dec.span,
                        hint="9 binds most tightly; `*` has 7, `+` 6, `=` 4",
                    )
                for name in dec.names:
                    if dec.kind == "nonfix":
                        self.fixities.pop(name, None)
                    else:
                        self.fixities[name] = (dec.precedence, dec.kind)
                return dec
            case s.ExpDec():
                return replace(dec, exp=self.exp(dec.exp))
            case _:
                return dec

    def structure(self, e: s.Str) -> s.Str:
        """A structure; what it says of fixity ends with it."""
        self._enter(e.span)
        resolved = self._structure(e)
        self._depth -= 1
        return resolved

    def _structure(self, e: s.Str) -> s.Str:
        saved = dict(self.fixities)
        try:
            match e:
                case s.StructStr():
                    return replace(e, declarations=tuple(self.dec(x) for x in e.declarations))
                case s.LetStr():
                    declarations = tuple(self.dec(x) for x in e.declarations)
                    return replace(e, declarations=declarations, body=self.structure(e.body))
                case s.ApplyStr():
                    return replace(e, argument=self.structure(e.argument))
                case s.SealedStr():
                    return replace(e, structure=self.structure(e.structure))
                case s.NameStr():
                    return e
        finally:
            self.fixities = saved

    def _function(self, b: s.FunBinding | s.FlatFunBinding) -> s.FunBinding:
        if isinstance(b, s.FunBinding):
            return b
        clauses: list[s.Clause] = []
        first: s.NamePat | None = None
        for flat in b.clauses:
            name, clause = self._clause(flat)
            if first is None:
                first = name
            elif name.name != first.name:
                self._d.error(
                    codes.CLAUSES,
                    f"clause of `{name.name}` among the clauses of `{first.name}`",
                    name.span,
                    hint="functions that use each other are joined with `and`",
                )
                raise FixityError
            elif len(clause.patterns) != len(clauses[0].patterns):
                count = len(clauses[0].patterns)
                self._d.error(
                    codes.CLAUSES,
                    f"this clause of `{first.name}` has {len(clause.patterns)} arguments, the first has {count}",
                    clause.span,
                    hint=advice.BY_CODE[codes.CLAUSES],
                )
                raise FixityError
            clauses.append(clause)
        assert first is not None
        return s.FunBinding(first.name, tuple(clauses), first.span, b.span)

    def _clause(self, flat: s.FlatClause) -> tuple[s.NamePat, s.Clause]:
        left = flat.left
        items = list(left.items) if isinstance(left, s.FlatPat) else [left]
        result: s.Ty | None = None
        if items and isinstance(last := items[-1], s.Constraint):
            result = last.type
            items.pop()
        name, patterns = self._head(items, left.span)
        if is_long(name.name):
            raise self.error(
                f"`{name.name}` cannot be declared here", name.span, "a name has no points"
            )
        resolved = tuple(self.pat(p) for p in patterns)
        return name, s.Clause(resolved, result, self.exp(flat.body), flat.span)

    def _head(
        self, items: Sequence[s.Pat | s.Keyword | s.Constraint], span: Span
    ) -> tuple[s.NamePat, list[s.Pat]]:
        """Name and arguments of `f p q`, `p ++ q`, `(p ++ q) r`."""
        atoms = [x for x in items if _is_pat(x)]
        if len(atoms) == len(items):
            match atoms:
                case [left, s.NamePat() as name, right] if self._is_infix_pat(name):
                    return name, [_pair(left, right)]
                case [s.FlatPat(items=[left, s.NamePat() as name, right]), *rest] if (
                    self._is_infix_pat(name) and _is_pat(left) and _is_pat(right)
                ):
                    return name, [_pair(left, right), *rest]
                case [s.NamePat() as name, _, *_] if not any(map(self._is_infix_pat, atoms)):
                    return name, list(atoms[1:])
                case [s.NamePat() as name]:
                    raise self.error(
                        f"function `{name.name}` has no argument", name.span,
                        f"write `val {name.name} = ..`, or `fun {name.name} () = ..`",
                    )  # fmt: skip
        raise self.error(
            "this is not the left side of a function", span, "`fun name argument = ..`"
        )


def _pair(left: s.Pat, right: s.Pat) -> s.RecordPat:
    return s.RecordPat((("1", left), ("2", right)), False, left.span.to(right.span))


def _is_pat(item: s.Pat | s.Keyword | s.Constraint) -> TypeGuard[s.Pat]:
    return not isinstance(item, s.Keyword | s.Constraint)


def _span(node: object) -> Span:
    span = getattr(node, "span", None)
    assert isinstance(span, Span)
    return span
