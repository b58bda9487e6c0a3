"""Expressions: type inference and translation to core in one walk.

`infer(e)` gives a `Draft`: the type so far, and a function that builds the core expression when all types
are known. `check(e, t, what)` also makes the type equal to `t`, going into branches and components first so
that an error is shown where it is.
"""

from __future__ import annotations

from functools import partial

from pn2code.base.weakly import weakly
from pn2code.diagnostics import Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.library.datatypes import LITERAL_TYPES, WORD_TYPES
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing.annotations import Annotations
from pn2code.ml.typing.applications import Applications
from pn2code.ml.typing.context import Context, Draft, no_expression
from pn2code.ml.typing.control_expressions import ControlExpressions
from pn2code.ml.typing.environment import (
    ConEntry,
    Entry,
    InstanceEntry,
    InstanceFunction,
    Scope,
    UnsupportedEntry,
)
from pn2code.ml.typing.inference import (
    ERROR,
    I_CHAR,
    I_REAL,
    I_STRING,
    ICon,
    IFun,
    IRec,
    Ty,
    i_list,
    i_record,
    prune,
    to_type,
)
from pn2code.ml.typing.names import Names
from pn2code.ml.typing.patterns import Patterns


class Expressions(Applications, ControlExpressions):
    """Infers expressions; declarations inside them are given to `declare`."""

    def __init__(
        self, ctx: Context, annotations: Annotations, patterns: Patterns, names: Names
    ) -> None:
        super().__init__(ctx, annotations, patterns, names)
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

    # --- declared functions that are declared again

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
