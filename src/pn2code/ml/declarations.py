"""Declarations: `val`, `fun`, `type`, `datatype`, `exception`, `local`, `open`, `structure`.

`declare(dec)` enters the names into the present scope and gives a function that builds the core declarations
once all types are known. It serves the top level and `let` alike.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from pn2code.diagnostics import Span
from pn2code.ml import codes, core
from pn2code.ml import syntax as s
from pn2code.ml.annotations import Annotations
from pn2code.ml.context import Context, Draft, suggestion
from pn2code.ml.environment import (
    Binding,
    BuiltinStructure,
    ConEntry,
    Scope,
    TypeAbbreviation,
    TypeCon,
    constructor_entries,
    library_members,
)
from pn2code.ml.expressions import Expressions
from pn2code.ml.inference import IFun, Meta, Quant, Ty, to_type
from pn2code.ml.patterns import Bindings, Patterns, is_irrefutable, pattern_names
from pn2code.ml.types import EXN, TFun, Type, tuple_of

Build = Callable[[], Sequence[core.Dec]]


def _nothing() -> Sequence[core.Dec]:
    return ()


class Declarations:
    """Enters declarations."""

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
        expressions.declare = self.declare

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
                return _nothing
            case s.DatatypeDec():
                return self._datatype(dec)
            case s.DatatypeCopyDec():
                self._datatype_copy(dec)
                return _nothing
            case s.ExceptionDec():
                return self._exception(dec)
            case s.LocalDec():
                return self._local(dec)
            case s.OpenDec():
                self._open(dec)
                return _nothing
            case s.StructureDec():
                return self._structure(dec)
            case s.InfixDec():
                return _nothing

    # --- values

    def _val(self, dec: s.ValDec) -> Build:
        at_top = self._ctx.at_top
        self._enter()
        bindings: Bindings = {}
        made: list[tuple[Callable[[], core.Pat], Draft, s.ValBinding]] = []
        plain = [b for b in dec.bindings if not b.recursive]
        recursive = [b for b in dec.bindings if b.recursive]
        for b in plain:
            t = self._ctx.unifier.fresh()
            own: Bindings = {}
            pattern = self._patterns.check(b.pattern, t, own)
            value = self._expressions.check(b.value, t, _value_of(own))
            made.append((pattern, value, b))
            self._merge(bindings, own, b.span)
        rec_build = self._recursive_values(recursive, bindings)
        self._leave()
        self._generalise(bindings, all(self._expressions.is_value(b.value) for b in dec.bindings))
        for binding in bindings.values():
            binding.is_global = at_top
        self._ctx.scope.values.update(bindings)
        quants = next((b.quants for b in bindings.values()), [])

        def build() -> Sequence[core.Dec]:
            with self._ctx.generics(quants):
                out: list[core.Dec] = [
                    core.ValBind(pattern(), value.build(), b.span) for pattern, value, b in made
                ]
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
                self._patterns.check(b.pattern, binding.type, {})
                self._merge(bindings, {name: binding}, b.span)
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
        self._enter()
        draft = self._expressions.infer(dec.exp)
        self._leave()
        self._ctx.unifier.lower(draft.type)

        def build() -> Sequence[core.Dec]:
            value = draft.build()
            return (core.ValBind(core.PWild(value.type, dec.span), value, dec.span),)

        return build

    def _enter(self) -> None:
        self._ctx.unifier.level += 1
        self._ctx.tyvars.append({})

    def _leave(self) -> None:
        self._ctx.tyvars.pop()
        self._ctx.unifier.level -= 1

    def _generalise(self, bindings: Bindings, is_value: bool) -> None:
        """Quantifies the unknowns of a group; all its members share the variables."""
        if is_value:
            quants = self._ctx.unifier.generalise(b.type for b in bindings.values())
            for binding in bindings.values():
                binding.quants, binding.generalised = quants, True
        else:
            for binding in bindings.values():
                self._ctx.unifier.lower(binding.type)

    # --- functions

    def _fun(self, dec: s.FunDec) -> Build:
        at_top = self._ctx.at_top
        self._enter()
        bindings: Bindings = {}
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
        rules: list[Callable[[], tuple[list[core.Pat], core.Exp, Span]]] = []
        for clause in f.clauses:
            own: Bindings = {}
            patterns = [
                self._patterns.check(p, a, own)
                for p, a in zip(clause.patterns, arguments, strict=True)
            ]
            if clause.result is not None:
                annotated = self._annotations.type(clause.result)
                self._ctx.unify(annotated, result, clause.result.span, f"result of `{f.name}`")
            with self._ctx.block() as scope:
                scope.values.update(own)
                body = self._expressions.check(clause.body, result, f"result of `{f.name}`")
            rules.append(partial(_clause, patterns, body, clause.span))
        direct = len(f.clauses) == 1 and all(
            is_irrefutable(p, self._ctx) for p in f.clauses[0].patterns
        )

        def build() -> core.Lambda:
            made = [rule() for rule in rules]
            types = [to_type(a) for a in arguments]
            return self._curried(made, types, to_type(result), direct, f.span)

        return build

    def _curried(
        self,
        clauses: Sequence[tuple[list[core.Pat], core.Exp, Span]],
        arguments: Sequence[Type],
        result: Type,
        direct: bool,
        span: Span,
    ) -> core.Lambda:
        """`fn p => e | ...`, or for several arguments `fn a => fn b => case (a, b) of ...`."""
        t = result
        if len(arguments) == 1:
            rules = tuple(core.Rule(patterns[0], body, at) for patterns, body, at in clauses)
            return core.Lambda(rules, TFun(arguments[0], result), span)
        out: core.Exp
        if direct:
            ((patterns, out, _),) = clauses
        else:
            symbols = [self._ctx.fresh_symbol(f"a{i}", a) for i, a in enumerate(arguments, 1)]
            patterns = [core.PVar(x, x.type, span) for x in symbols]
            pair = tuple_of(*arguments)
            labels = [str(i) for i in range(1, len(arguments) + 1)]
            values = [core.Var(x, x.type, span) for x in symbols]
            scrutinee = core.RecordExp(tuple(zip(labels, values, strict=True)), pair, span)
            rules = tuple(
                core.Rule(core.PRecord(tuple(zip(labels, ps, strict=True)), pair, at), body, at)
                for ps, body, at in clauses
            )
            out = core.Case(scrutinee, rules, result, span)
        for pattern, argument in zip(reversed(patterns), reversed(arguments), strict=True):
            t = TFun(argument, t)
            out = core.Lambda((core.Rule(pattern, out, span),), t, span)
        assert isinstance(out, core.Lambda)
        return out

    # --- types

    def _parameters(self, names: Sequence[str]) -> tuple[list[Quant], dict[str, Meta]]:
        quants = [Quant(n.startswith("''"), i) for i, n in enumerate(names)]
        return quants, {n: Meta(0, ref=q) for n, q in zip(names, quants, strict=True)}

    def _written_type(self, t: s.Ty, tyvars: dict[str, Meta]) -> Ty:
        """A type in which only the declared type variables may stand."""
        known = set(tyvars)
        self._ctx.tyvars.append(tyvars)
        try:
            out = self._annotations.type(t)
        finally:
            self._ctx.tyvars.pop()
        for name in set(tyvars) - known:
            self._ctx.error(
                codes.UNKNOWN_COLOUR_SET, f"type variable `{name}` is not declared", t.span,
                hint=f"write it in front of the name: `{name} ..`",
            )  # fmt: skip
            del tyvars[name]
        return out

    def _type(self, b: s.TypeBinding) -> None:
        quants, tyvars = self._parameters(b.parameters)
        body = self._written_type(b.type, tyvars)
        self._ctx.scope.types[b.name] = TypeAbbreviation(tuple(quants), body)

    def _datatype(self, dec: s.DatatypeDec) -> Build:
        names: list[str] = []
        for b in dec.bindings:
            name = self._ctx.unique_type_name(b.name)
            while name in names:
                name += "'"
            names.append(name)
            self._ctx.scope.types[b.name] = TypeCon(name, len(b.parameters))
            self._ctx.equality[name] = True
        for w in dec.withtypes:
            self._type(w)
        made: list[core.DatatypeDec] = []
        for b, name in zip(dec.bindings, names, strict=True):
            _, tyvars = self._parameters(b.parameters)
            constructors: list[tuple[core.Constructor, Type | None]] = []
            for tag, c in enumerate(b.constructors):
                if any(c.name == other.name for other, _ in constructors):
                    self._ctx.error(
                        codes.DUPLICATE_NAME, f"constructor `{c.name}` is declared twice", c.span
                    )
                before = self._ctx.errors
                argument = None if c.argument is None else self._written_type(c.argument, tyvars)
                if self._ctx.errors > before or self._ctx.tainted:
                    return _nothing  # the caller marks the names as broken
                has_argument = argument is not None
                constructor = core.Constructor(c.name, name, tag, has_argument, len(b.constructors))
                constructors.append((constructor, None if argument is None else to_type(argument)))
            made.append(core.DatatypeDec(name, len(b.parameters), tuple(constructors), b.span))
        for declaration in made:
            self.enter_datatype(declaration)
        for declaration in reversed(made):  # equality of one may depend on a later one
            self._ctx.add_datatype(declaration)
        return lambda: made

    def enter_datatype(self, declaration: core.DatatypeDec) -> None:
        """Enters the constructors of a datatype."""
        self._ctx.add_datatype(declaration)
        self._ctx.scope.values.update(constructor_entries(declaration))

    def _datatype_copy(self, dec: s.DatatypeCopyDec) -> None:
        entry = self._ctx.scope.type(dec.original)
        if not isinstance(entry, TypeCon) or entry.name not in self._ctx.datatypes:
            self._ctx.error(
                codes.UNKNOWN_COLOUR_SET,
                f"there is no datatype `{dec.original}`",
                dec.span,
                hint=suggestion(dec.original, self._ctx.datatypes),
            )
            return
        self._ctx.scope.types[dec.name] = entry
        self._ctx.scope.values.update(constructor_entries(self._ctx.datatypes[entry.name]))

    def _exception(self, dec: s.ExceptionDec) -> Build:
        made: list[core.Dec] = []
        for b in dec.bindings:
            if b.original is not None:
                entry = self._ctx.scope.value(b.original)
                if isinstance(entry, ConEntry) and entry.constructor.data_type == "exn":
                    self._ctx.scope.values[b.name] = entry
                else:
                    self._ctx.error(codes.UNBOUND, f"there is no exception `{b.original}`", b.span)
                continue
            before = self._ctx.errors
            argument = None if b.argument is None else self._annotations.type(b.argument)
            if self._ctx.errors > before or self._ctx.tainted:
                return _nothing
            full = None if argument is None else to_type(argument)
            constructor = core.Constructor(
                b.name, "exn", self._ctx.next_exception, full is not None, 0
            )
            self._ctx.next_exception += 1
            self._ctx.scope.values[b.name] = ConEntry(
                constructor, EXN if full is None else TFun(full, EXN), 0
            )
            made.append(core.ExceptionDec(constructor, full, b.span))
        return lambda: made

    # --- blocks

    def _local(self, dec: s.LocalDec) -> Build:
        with self._ctx.block():
            hidden = [self.declare(x) for x in dec.hidden]
            with self._ctx.block() as visible_scope:
                visible = [self.declare(x) for x in dec.visible]
        self._ctx.scope.absorb(visible_scope)
        return partial(_all, [*hidden, *visible])

    def _structure(self, dec: s.StructureDec) -> Build:
        if dec.alias is not None:
            target = self._structure_named(dec.alias, dec.span)
            if target is not None:
                self._ctx.scope.structures[dec.name] = target
            return _nothing
        with self._ctx.block() as scope:
            inside = [self.declare(x) for x in dec.declarations]
        self._ctx.scope.structures[dec.name] = scope
        return partial(_all, inside)

    def _structure_named(self, name: str, span: Span) -> Scope | BuiltinStructure | None:
        structure = self._ctx.scope.structure(name)
        if structure is None:
            self._ctx.error(codes.UNBOUND, f"there is no structure `{name}`", span)
        return structure

    def _open(self, dec: s.OpenDec) -> None:
        for name in dec.names:
            structure = self._structure_named(name, dec.span)
            if isinstance(structure, BuiltinStructure):
                self._ctx.scope.values.update(library_members(structure.name))
            elif structure is not None:
                self._ctx.scope.absorb(structure)


def _all(builds: Sequence[Build]) -> Sequence[core.Dec]:
    return [dec for build in builds for dec in build()]


def _clause(
    patterns: Sequence[Callable[[], core.Pat]], body: Draft, span: Span
) -> tuple[list[core.Pat], core.Exp, Span]:
    return [p() for p in patterns], body.build(), span


def _variable(p: s.Pat) -> str | None:
    if isinstance(p, s.TypedPat):
        return _variable(p.pattern)
    return p.name if isinstance(p, s.NamePat) else None


def _value_of(bindings: Bindings) -> str:
    return f"value of `{next(iter(bindings))}`" if len(bindings) == 1 else "value"


def declared_by(dec: s.Dec) -> set[str]:
    """The values that a declaration makes, for the case that it has an error."""
    match dec:
        case s.ValDec():
            return pattern_names([b.pattern for b in dec.bindings])
        case s.FunDec():
            return {b.name for b in dec.bindings if isinstance(b, s.FunBinding)}
        case s.DatatypeDec():
            return {c.name for b in dec.bindings for c in b.constructors}
        case s.ExceptionDec():
            return {b.name for b in dec.bindings}
        case s.LocalDec():
            return {n for x in dec.visible for n in declared_by(x)}
        case _:
            return set()


def types_declared_by(dec: s.Dec) -> set[str]:
    """The types that a declaration makes."""
    match dec:
        case s.TypeDec():
            return {b.name for b in dec.bindings}
        case s.DatatypeDec():
            return {b.name for b in dec.bindings} | {b.name for b in dec.withtypes}
        case s.DatatypeCopyDec():
            return {dec.name}
        case s.LocalDec():
            return {n for x in dec.visible for n in types_declared_by(x)}
        case _:
            return set()
