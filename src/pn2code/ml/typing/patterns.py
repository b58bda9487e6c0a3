"""Patterns: checked against a type, they give variables and a core pattern."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import UNIT, TRecord
from pn2code.ml.library.builtins import BUILTINS
from pn2code.ml.library.datatypes import CONS, LITERAL_TYPES, NIL, WORD_TYPES
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing.annotations import Annotations
from pn2code.ml.typing.context import Context, PatternBuild, suggestion
from pn2code.ml.typing.environment import Binding, BrokenEntry, BuiltinEntry, ConEntry, UnitEntry
from pn2code.ml.typing.inference import (
    I_CHAR,
    I_REAL,
    I_STRING,
    I_UNIT,
    ICon,
    IFun,
    IRec,
    Ty,
    i_list,
    i_record,
    i_tuple,
    prune,
    to_type,
)

MAX_ALTERNATIVES = 256
"""Rules that one rule with alternatives may stand for."""


@frozen
class Deref:
    """`ref p` or `#[p, q]` in a pattern: the cell gets a hidden name, and its contents are matched afterwards.

    Args:
        cell: the hidden variable, a reference or a vector.
        content: type of the contents; those of a vector are a list.
        inner: the pattern for the contents.
        irrefutable: whether that always matches.
        span: of the pattern.
    """

    cell: Binding
    content: Ty
    inner: PatternBuild
    irrefutable: bool
    span: Span


class Bindings(dict[str, Binding]):
    """The variables of a pattern by name, and the references in it."""

    def __init__(self) -> None:
        super().__init__()
        self.derefs: list[Deref] = []


TIMED = core.Constructor("@", "timed", 0, True, 1)
"""What `v@s` is in a pattern."""


class Patterns:
    """Checks patterns."""

    def __init__(self, ctx: Context, annotations: Annotations) -> None:
        self._ctx = ctx
        self._annotations = annotations
        self._on_arc = False

    def check_on_arc(self, p: s.Pat, t: Ty, bindings: Bindings) -> PatternBuild:
        """The same of an arc, where the value of a unit colour set and real numbers are compared."""
        self._on_arc = True
        try:
            return self.check(p, t, bindings)
        finally:
            self._on_arc = False

    def check(self, p: s.Pat, t: Ty, bindings: Bindings) -> PatternBuild:
        """A pattern for values of a type; its variables are added to `bindings`."""
        match p:
            case s.WildPat():
                return lambda: core.PWild(to_type(t), p.span)
            case s.LitPat():
                return self._literal(p, t)
            case s.NamePat():
                return self._name(p, t, bindings)
            case s.RecordPat():
                return self._record(p, t, bindings)
            case s.ListPat():
                return self._list(p, t, bindings)
            case s.VectorPat():
                return self._vector(p, t, bindings)
            case s.ConPat():
                return self._constructor(p, t, bindings)
            case s.TypedPat():
                self._unify(self._annotations.type(p.type), t, p.span)
                return self.check(p.pattern, t, bindings)
            case s.AsPat():
                if p.type is not None:
                    self._unify(self._annotations.type(p.type), t, p.span)
                binding = self._bind(p.name.name, p.name.span, t, bindings)
                inner = self.check(p.pattern, t, bindings)
                return lambda: core.PAs(self._ctx.symbol_of(binding), inner(), to_type(t), p.span)
            case s.OrPat():
                self._ctx.error(
                    codes.UNSUPPORTED_ML,
                    "alternatives `(p | q)` are supported in the rules of functions and `case` only",
                    p.span,
                )
                return lambda: core.PWild(to_type(t), p.span)
            case s.FlatPat():
                raise AssertionError("flat pattern after the fixity pass")

    def same_names(self, names: set[str], bindings: Bindings, span: Span) -> None:
        """Refuses alternatives of one pattern that bind different names."""
        different = sorted(names.symmetric_difference(bindings))
        if different:
            self._ctx.error(
                codes.UNBOUND,
                f"`{different[0]}` is bound in some alternatives of this pattern only",
                span,
                hint="each alternative has to bind the same variables",
            )

    def _unify(self, found: Ty, expected: Ty, span: Span) -> None:
        self._ctx.unify(found, expected, span, "pattern")

    def _bind(self, name: str, span: Span, t: Ty, bindings: Bindings) -> Binding:
        if name in bindings:
            self._ctx.error(
                codes.DUPLICATE_NAME,
                f"`{name}` occurs twice in one pattern",
                span,
                hint="use two names and compare them",
            )
        binding = Binding(name, t)
        bindings[name] = binding
        return binding

    def _literal(self, p: s.LitPat, t: Ty) -> PatternBuild:
        kinds: dict[s.LitKind, Ty] = {
            s.LitKind.REAL: I_REAL,
            s.LitKind.STRING: I_STRING,
            s.LitKind.CHAR: I_CHAR,
        }
        if p.kind is s.LitKind.REAL and not self._on_arc:
            self._ctx.error(
                codes.SYNTAX_ERROR,
                "a real number is not allowed in a pattern",
                p.span,
                hint="compare: `if x = 1.5 then .. else ..`",
            )
        own = kinds.get(p.kind)
        if own is None:
            types = WORD_TYPES if p.kind is s.LitKind.WORD else LITERAL_TYPES
            own = self._ctx.unifier.fresh(among=[c.name for c in types])
        self._unify(own, t, p.span)

        def build() -> core.Pat:
            known = to_type(t)
            self._ctx.check_literal(p.value, known, p.span)
            return core.PLit(p.value, known, p.span)

        return build

    def _name(self, p: s.NamePat, t: Ty, bindings: Bindings) -> PatternBuild:
        entry = self._ctx.scope.value(p.name)
        if isinstance(entry, ConEntry):
            return self._constant(p, entry, t)
        if isinstance(entry, BuiltinEntry) and entry.name == "Ref.ref":
            self._ctx.error(
                codes.CONSTRUCTOR_ARITY,
                "constructor `ref` needs an argument",
                p.span,
                hint="write `ref _` for any argument",
            )
            return lambda: core.PWild(to_type(t), p.span)
        if isinstance(entry, UnitEntry) and self._on_arc:
            self._unify(I_UNIT, t, p.span)
            return lambda: core.PRecord((), UNIT, p.span)
        if "." in p.name and p.name[0].isalpha():
            self._unknown(p)
            return lambda: core.PWild(to_type(t), p.span)
        binding = self._bind(p.name, p.span, t, bindings)
        return lambda: core.PVar(self._ctx.symbol_of(binding), to_type(t), p.span)

    def _unknown(self, p: s.NamePat) -> None:
        entry = self._ctx.scope.value(p.name)
        if isinstance(entry, BrokenEntry):
            self._ctx.tainted = True
            return
        constructors = [
            n for n in self._ctx.scope.names() if isinstance(self._ctx.scope.value(n), ConEntry)
        ]
        self._ctx.error(
            codes.UNKNOWN_CONSTRUCTOR,
            f"`{p.name}` is not a constructor",
            p.span,
            hint=suggestion(p.name, constructors) or self._no_constructor(p.name),
        )

    def _no_constructor(self, name: str) -> str:
        if not name[0].isalpha():
            return (
                "a pattern cannot compute: use a variable there; names may contain `_`, but not `-`"
            )
        if name in self._ctx.colsets or name in ("int", "real", "string", "bool", "char", "unit"):
            return f"a type follows its variable: `(x : {name})`"
        return "only constructors of unions and data types can be applied in a pattern"

    def _constant(self, p: s.NamePat, entry: ConEntry, t: Ty) -> PatternBuild:
        if entry.constructor.has_argument:
            self._ctx.error(
                codes.CONSTRUCTOR_ARITY,
                f"constructor `{p.name}` needs an argument",
                p.span,
                hint=f"write `{p.name} _` for any argument",
            )
            return lambda: core.PWild(to_type(t), p.span)
        own = self._ctx.constructor_type(entry)
        self._unify(own, t, p.span)
        return lambda: core.PCon(entry.constructor, None, to_type(t), p.span)

    def _constructor(self, p: s.ConPat, t: Ty, bindings: Bindings) -> PatternBuild:
        name = p.constructor
        entry = self._ctx.scope.value(name.name)
        if isinstance(entry, BuiltinEntry) and entry.name == "Ref.ref":
            return self._reference(p, t, bindings)
        if isinstance(entry, BuiltinEntry) and entry.name == "Time.@":
            return self._timed(p, t, bindings)
        if not isinstance(entry, ConEntry):
            self._unknown(name)
            self.check(p.argument, self._ctx.unifier.fresh(), bindings)
            return lambda: core.PWild(to_type(t), p.span)
        own = self._ctx.constructor_type(entry)
        if not isinstance(own, IFun):
            self._ctx.error(
                codes.CONSTRUCTOR_ARITY, f"constructor `{name.name}` takes no argument", name.span
            )
            self.check(p.argument, self._ctx.unifier.fresh(), bindings)
            return lambda: core.PWild(to_type(t), p.span)
        self._unify(own.result, t, p.span)
        argument = self.check(p.argument, own.argument, bindings)
        return lambda: core.PCon(entry.constructor, argument(), to_type(t), p.span)

    def _reference(self, p: s.ConPat, t: Ty, bindings: Bindings) -> PatternBuild:
        """`ref p`: a variable here; the contents are matched after the rest of the pattern."""
        content = self._ctx.unifier.fresh()
        self._unify(ICon("ref", (content,)), t, p.span)
        return self._opened(p.argument, t, content, p.span, bindings)

    def _vector(self, p: s.VectorPat, t: Ty, bindings: Bindings) -> PatternBuild:
        """`#[p, q]`: a variable here; the list of the elements is matched after the rest of the pattern."""
        item = self._ctx.unifier.fresh()
        self._unify(ICon("vector", (item,)), t, p.span)
        return self._opened(s.ListPat(p.items, p.span), t, i_list(item), p.span, bindings)

    def _opened(
        self, inside: s.Pat, t: Ty, content: Ty, span: Span, bindings: Bindings
    ) -> PatternBuild:
        """A hidden variable for what has contents that are matched later."""
        cell = Binding("cell", t)
        at = len(bindings.derefs)
        inner = self.check(inside, content, bindings)
        always = is_irrefutable(inside, self._ctx)
        bindings.derefs.insert(at, Deref(cell, content, inner, always, span))
        return lambda: core.PVar(self._ctx.symbol_of(cell), to_type(t), span)

    def _timed(self, p: s.ConPat, t: Ty, bindings: Bindings) -> PatternBuild:
        """`v@s`: a timed token taken apart; to CPN Tools `@` is a constructor."""
        own, generics = self._ctx.library_type(BUILTINS["Time.@"].text)
        function, _ = self._ctx.unifier.instantiate_type(own, generics)
        assert isinstance(function, IFun)
        self._unify(function.result, t, p.span)
        argument = self.check(p.argument, function.argument, bindings)
        return lambda: core.PCon(TIMED, argument(), to_type(t), p.span)

    def _record(self, p: s.RecordPat, t: Ty, bindings: Bindings) -> PatternBuild:
        fields: dict[str, Ty] = {}
        for label, part in p.fields:
            if label in fields:
                self._ctx.error(codes.DUPLICATE_NAME, f"field `{label}` is given twice", part.span)
            fields[label] = self._ctx.unifier.fresh()
        if p.open:
            row = self._ctx.unifier.fresh_record(fields)
            self._ctx.open_records.append((row, p.span))
            self._unify(row, t, p.span)
        else:
            known = prune(t)
            if not isinstance(known, IRec) or {n for n, _ in known.fields} != set(fields):
                self._unify(i_record(fields), t, p.span)
            else:
                fields = dict(known.fields)
        inner = {label: self.check(part, fields[label], bindings) for label, part in p.fields}

        def build() -> core.Pat:
            full = to_type(t)
            assert isinstance(full, TRecord)
            parts = tuple(
                (n, inner[n]() if n in inner else core.PWild(f, p.span)) for n, f in full.fields
            )
            return core.PRecord(parts, full, p.span)

        return build

    def _list(self, p: s.ListPat, t: Ty, bindings: Bindings) -> PatternBuild:
        item = self._ctx.unifier.fresh()
        self._unify(i_list(item), t, p.span)
        items = [self.check(x, item, bindings) for x in p.items]

        def build() -> core.Pat:
            full = to_type(t)
            pair = to_type(i_tuple(item, t))
            out: core.Pat = core.PCon(NIL, None, full, p.span)
            for part in reversed(items):
                cell = core.PRecord((("1", part()), ("2", out)), pair, p.span)
                out = core.PCon(CONS, cell, full, p.span)
            return out

        return build


def is_irrefutable(p: s.Pat, ctx: Context) -> bool:
    """Whether a pattern matches every value of its type (by its form: variables and records of them)."""
    match p:
        case s.WildPat():
            return True
        case s.NamePat():
            return not isinstance(ctx.scope.value(p.name), ConEntry)
        case s.RecordPat():
            return all(is_irrefutable(x, ctx) for _, x in p.fields)
        case s.TypedPat() | s.AsPat():
            return is_irrefutable(p.pattern, ctx)
        case s.ConPat():
            entry = ctx.scope.value(p.constructor.name)
            is_timed = isinstance(entry, BuiltinEntry) and entry.name == "Time.@"
            return is_timed and is_irrefutable(p.argument, ctx)
        case _:
            return False


def expand(patterns: Sequence[s.Pat]) -> list[tuple[s.Pat, ...]] | None:
    """The patterns without alternatives: one tuple for each choice among them; None if these are too many."""
    out: list[tuple[s.Pat, ...]] = [()]
    for p in patterns:
        choices = _choices(p)
        if choices is None or len(out) * len(choices) > MAX_ALTERNATIVES:
            return None
        out = [(*before, c) for before in out for c in choices]
    return out


def _choices(p: s.Pat) -> list[s.Pat] | None:
    match p:
        case s.OrPat():
            found: list[s.Pat] = []
            for alternative in p.alternatives:
                inner = _choices(alternative)
                if inner is None:
                    return None
                found += inner
            return found
        case s.RecordPat():
            parts = expand([x for _, x in p.fields])
            if parts is None or len(parts) == 1:
                return None if parts is None else [p]
            labels = [n for n, _ in p.fields]
            return [replace(p, fields=tuple(zip(labels, c, strict=True))) for c in parts]
        case s.ListPat() | s.VectorPat():
            parts = expand(p.items)
            if parts is None or len(parts) == 1:
                return None if parts is None else [p]
            return [replace(p, items=c) for c in parts]
        case s.ConPat():
            return _inside(p, p.argument, lambda x: replace(p, argument=x))
        case s.TypedPat():
            return _inside(p, p.pattern, lambda x: replace(p, pattern=x))
        case s.AsPat():
            return _inside(p, p.pattern, lambda x: replace(p, pattern=x))
        case _:
            return [p]


def _inside(p: s.Pat, part: s.Pat, rebuild: Callable[[s.Pat], s.Pat]) -> list[s.Pat] | None:
    choices = _choices(part)
    if choices is None or len(choices) == 1:
        return None if choices is None else [p]
    return [rebuild(c) for c in choices]


def pattern_names(patterns: Sequence[s.Pat]) -> set[str]:
    """All names that patterns may bind, for the case that the declaration has an error."""
    out: set[str] = set()
    for p in patterns:
        match p:
            case s.NamePat():
                out.add(p.name)
            case s.RecordPat():
                out |= pattern_names([x for _, x in p.fields])
            case s.OrPat():
                out |= pattern_names(p.alternatives)
            case s.ListPat() | s.VectorPat():
                out |= pattern_names(p.items)
            case s.ConPat():
                out |= pattern_names([p.argument])
            case s.TypedPat():
                out |= pattern_names([p.pattern])
            case s.AsPat():
                out |= {p.name.name} | pattern_names([p.pattern])
            case _:
                pass
    return out
