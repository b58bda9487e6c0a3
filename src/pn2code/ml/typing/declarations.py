"""Declarations: `val`, `fun`, `type`, `datatype`, `exception`, `local`, `open`, `structure`.

`declare(dec)` enters the names into the present scope and gives a function that builds the core declarations
once all types are known. It serves the top level and `let` alike.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from pn2code.base.weakly import weakly
from pn2code.diagnostics import NOWHERE, SourceText, Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import EXN, UNIT, TFun, Type, tuple_of
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing import matches
from pn2code.ml.typing.annotations import Annotations
from pn2code.ml.typing.context import Context, Draft, suggestion
from pn2code.ml.typing.declared import declared_by, written_variables
from pn2code.ml.typing.environment import (
    Binding,
    BrokenEntry,
    BrokenType,
    ConEntry,
    TypeAbbreviation,
    TypeCon,
    constructor_entries,
)
from pn2code.ml.typing.expressions import Expressions
from pn2code.ml.typing.inference import (
    I_EXN,
    ICon,
    IError,
    IFun,
    Meta,
    Quant,
    Ty,
    parts,
    prune,
    to_type,
)
from pn2code.ml.typing.matches import BuiltRule
from pn2code.ml.typing.modules import Modules
from pn2code.ml.typing.names import Names
from pn2code.ml.typing.patterns import Bindings, Deref, Patterns, expand, is_irrefutable

Build = Callable[[], Sequence[core.Dec]]
_NO_BODY = core.RecordExp((), UNIT, Span(SourceText("", NOWHERE), 0, 0))


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
        names: Names,
    ) -> None:
        self._ctx = ctx
        self._annotations = annotations
        self._patterns = patterns
        self._expressions = expressions
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
            case s.AbstypeDec():
                return self._abstype(dec)
            case s.OpenDec():
                self._modules.open(dec)
                return _nothing
            case s.StructureDec():
                return partial(_all, self._modules.structures(dec))
            case s.SignatureDec():
                self._modules.signatures(dec)
                return _nothing
            case s.FunctorDec():
                self._modules.functors(dec)
                return _nothing
            case s.InfixDec():
                return _nothing

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

    # --- functions

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
        before = self._ctx.errors
        body = self._written_type(b.type, tyvars)
        broken = self._ctx.errors > before or self._ctx.tainted
        self._ctx.scope.types[b.name] = (
            BrokenType() if broken else TypeAbbreviation(tuple(quants), body)
        )

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
        schemes: dict[tuple[str, str], tuple[Ty, tuple[Quant, ...]]] = {}
        for b, name in zip(dec.bindings, names, strict=True):
            quants, tyvars = self._parameters(b.parameters)
            own = ICon(name, tuple(quants))
            constructors: list[tuple[core.Constructor, Type | None]] = []
            seen: set[str] = set()
            for tag, c in enumerate(b.constructors):
                if c.name in seen:
                    self._ctx.error(
                        codes.DUPLICATE_NAME, f"constructor `{c.name}` is declared twice", c.span
                    )
                seen.add(c.name)
                before = self._ctx.errors
                argument = None if c.argument is None else self._written_type(c.argument, tyvars)
                if self._ctx.errors > before or self._ctx.tainted:
                    for name in declared_by(dec):
                        self._ctx.scope.values[name] = BrokenEntry()
                    return _nothing
                has_argument = argument is not None
                constructor = core.Constructor(c.name, name, tag, has_argument, len(b.constructors))
                constructors.append((constructor, None if argument is None else to_type(argument)))
                t = own if argument is None else IFun(argument, own)
                schemes[name, c.name] = (t, tuple(quants))
            made.append(core.DatatypeDec(name, len(b.parameters), tuple(constructors), b.span))
        for declaration in made:
            self.enter_datatype(declaration)
            for con_name, entry in constructor_entries(declaration).items():
                scheme = schemes[declaration.name, con_name]
                self._ctx.scope.values[con_name] = replace(entry, scheme=scheme)
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
        declaration = self._ctx.datatypes[entry.name]
        path = dec.original.rpartition(".")[0]
        for con_name, made in constructor_entries(declaration).items():
            own = self._ctx.scope.value(f"{path}.{con_name}" if path else con_name)
            same = isinstance(own, ConEntry) and own.constructor == made.constructor
            self._ctx.scope.values[con_name] = own if same and own is not None else made
        self._ctx.scope.types[dec.name] = entry

    def _exception(self, dec: s.ExceptionDec) -> Build:
        made: list[tuple[core.Constructor, Ty | None, Span]] = []
        for b in dec.bindings:
            if b.original is not None:
                entry = self._ctx.scope.value(b.original)
                if isinstance(entry, ConEntry) and entry.constructor.data_type == "exn":
                    self._ctx.scope.values[b.name] = entry
                    continue
                if isinstance(entry, BrokenEntry):
                    self._ctx.tainted = True
                else:
                    self._ctx.error(codes.UNBOUND, f"there is no exception `{b.original}`", b.span)
                self._ctx.scope.values[b.name] = BrokenEntry()
                continue
            before = self._ctx.errors
            argument = None if b.argument is None else self._annotations.type(b.argument)
            if argument is not None:
                self._free(argument, b)
            if self._ctx.errors > before or self._ctx.tainted:
                self._ctx.scope.values[b.name] = BrokenEntry()
                continue
            full = None if argument is None else to_type(argument)
            scheme = None if argument is None else (IFun(argument, I_EXN), ())
            constructor = core.Constructor(
                b.name, "exn", self._ctx.next_exception, full is not None, 0
            )
            self._ctx.next_exception += 1
            self._ctx.scope.values[b.name] = ConEntry(
                constructor, EXN if full is None else TFun(full, EXN), 0, scheme
            )
            made.append((constructor, argument, b.span))

        def build() -> Sequence[core.Dec]:
            return [
                core.ExceptionDec(c, None if t is None else to_type(t), span) for c, t, span in made
            ]

        return build

    def _free(self, t: Ty, b: s.ExceptionBinding) -> None:
        """Reports type variables that no surrounding function quantifies."""
        t = prune(t)
        known = (m for scope in self._ctx.tyvars for m in scope.values())
        if isinstance(t, Meta) and not any(prune(m) is t for m in known):
            self._ctx.error(
                codes.UNKNOWN_COLOUR_SET,
                f"exception `{b.name}` carries a type variable",
                b.span,
                hint="give it a type",
            )
            return
        for part in parts(t):
            self._free(part, b)

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


def _clause(
    patterns: Sequence[Callable[[], core.Pat]],
    body: Draft,
    span: Span,
    derefs: tuple[Deref, ...],
) -> tuple[list[core.Pat], core.Exp, Span, tuple[Deref, ...]]:
    return [p() for p in patterns], body.build(), span, derefs


def _variable(p: s.Pat) -> str | None:
    if isinstance(p, s.TypedPat):
        return _variable(p.pattern)
    return p.name if isinstance(p, s.NamePat) else None


def _value_of(bindings: Bindings) -> str:
    return f"value of `{next(iter(bindings))}`" if len(bindings) == 1 else "value"
