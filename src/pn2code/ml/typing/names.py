"""Uses of names: what the name stands for, at a fresh instance of its type."""

from __future__ import annotations

from collections.abc import Callable

from pn2code.diagnostics import Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import INT, UNIT, TFun, TRecord, Type
from pn2code.ml.library.builtin_table_sized import INTEGERS, WORDS, word_type
from pn2code.ml.library.builtins import BUILTINS, OVERLOADED
from pn2code.ml.library.datatypes import NIL
from pn2code.ml.parsing import advice
from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.parser import declared_names
from pn2code.ml.typing.colset_members import member_type, members_of, timed_member
from pn2code.ml.typing.context import BROKEN, Context, Draft, suggestion
from pn2code.ml.typing.environment import (
    Binding,
    BrokenEntry,
    BuiltinEntry,
    ColsetEntry,
    ConEntry,
    EmptyEntry,
    Entry,
    HiddenEntry,
    InstanceEntry,
    InstanceFunction,
    OverloadedEntry,
    SealedEntry,
    UnitEntry,
    UnsupportedEntry,
    split_name,
)
from pn2code.ml.typing.inference import (
    I_UNIT,
    ICon,
    IFun,
    IRec,
    Ty,
    from_type,
    i_list,
    prune,
    to_type,
)
from pn2code.ml.typing.shown_types import quoted

_SHORTEST_SUGGESTED = 4
"""Characters of a name of the library that a misspelt name may mean."""
_MOST_ADVICE = 200
"""After so many errors no advice is looked for, which takes longer than the errors themselves."""
_PRIORITIES = {"P_HIGH": 100, "P_NORMAL": 1000, "P_LOW": 10000}
"""The standard priorities of CPN Tools, which its nets declare themselves."""
_STRUCTURE_TYPES = {
    "Int": "int",
    "Real": "real",
    "IntInf": "IntInf.int",
    "String": "string",
    "Char": "char",
    **{name: word_type(name) for name in WORDS},
    **{name: f"{name}.int" for name in INTEGERS},
}


class Names:
    """Infers uses of names."""

    def __init__(self, ctx: Context) -> None:
        self._ctx = ctx
        self._types: dict[str, Ty] = {}
        self.own: Callable[[InstanceFunction, Span], Draft]

    def lookup(self, name: str) -> Entry | None:
        """What a name means: a value in scope, or a function of a colour set's structure."""
        *path, last = split_name(name)
        if path:
            structure = ".".join(path)
            if self._ctx.means_colset(structure) or self._ctx.scope.structure(structure) is None:
                return self._colset_member(structure, last)
        return self._ctx.scope.value(name)

    def _colset_member(self, structure: str, member: str) -> Entry | None:
        if structure not in self._ctx.colsets:
            return self._timed_member(structure.removesuffix("'timed"), structure, member)
        colset = self._ctx.colsets[structure]
        if colset is None:
            return BrokenEntry()
        return ColsetEntry(colset, member) if member in members_of(colset) else None

    def _timed_member(self, base: str, structure: str, member: str) -> Entry | None:
        if base == structure or base not in self._ctx.colsets:
            return None
        colset = self._ctx.colsets[base]
        if colset is None:
            return BrokenEntry()
        known = timed_member(member)
        return ColsetEntry(colset, known) if colset.timed and known is not None else None

    def infer(self, name: str, span: Span) -> Draft:
        """A use of a name."""
        entry = self.lookup(name)
        return self._unbound(name, span) if entry is None else self.entry(entry, name, span)

    def entry(self, entry: Entry, name: str, span: Span) -> Draft:
        """A use of what a name stands for."""
        match entry:
            case SealedEntry():
                return self._sealed(entry, name, span)
            case Binding():
                return self._variable(entry, span)
            case BuiltinEntry():
                info = BUILTINS[entry.name]
                if name == "null":
                    self._ctx.warn_once(
                        codes.NULL,
                        name,
                        "`null` is the time 0 in CPN Tools, which refuses it as a function of lists",
                        span,
                        "write `List.null`",
                    )
                t, generics = self._ctx.library_type(info.text)
                if not generics:
                    return self._simple(entry.name, name, t, span)
                own, inst = self._ctx.unifier.instantiate_type(t, generics)

                def build_builtin() -> core.Exp:
                    if info.unsupported:
                        self._ctx.warn_unsupported(name, info.unsupported, span)
                    return core.Builtin(entry.name, to_type(own), span, tuple(map(to_type, inst)))

                return Draft(own, build_builtin)
            case OverloadedEntry():
                return self._overloaded(entry, span)
            case ConEntry():
                return self._constructor(entry, span)
            case EmptyEntry():
                t_list = i_list(self._ctx.unifier.fresh())
                return Draft(t_list, lambda: core.ListExp((), to_type(t_list), span))
            case UnitEntry():
                return Draft(I_UNIT, lambda: core.RecordExp((), UNIT, span))
            case ColsetEntry():
                member = member_type(entry.colset, entry.member)
                return Draft(
                    from_type(member, []),
                    lambda: core.Builtin(f"Colset.{entry.member}", member, span, (), entry.colset),
                )
            case BrokenEntry():
                self._ctx.tainted = True
                return BROKEN
            case HiddenEntry():
                self._ctx.error(
                    codes.VALUE_CLASH,
                    f"variable `{name}` cannot be used: a constructor of that name was declared after it",
                    span,
                )
                return BROKEN
            case InstanceEntry():
                self._ctx.mentions_instances = True
                number = TFun(UNIT, INT)
                return Draft(
                    from_type(number, []),
                    lambda: core.Builtin(core.INSTANCE_NUMBER, number, span),
                )
            case InstanceFunction() if self._ctx.on_page:
                other = entry.changed(self._ctx.top)
                if not other:
                    return self.own(entry, span)
                self._ctx.error(
                    codes.UNSUPPORTED_BUILTIN,
                    f"function `{name}` is not supported: it uses `inst ()`, and `{other}`, which is declared again "
                    "after it",
                    span,
                    hint=f"give the second `{other}` another name",
                )
                return BROKEN
            case InstanceFunction():
                self._ctx.error(
                    codes.UNSUPPORTED_BUILTIN,
                    f"function `{name}` is not supported here: it uses `inst`, the number of the page instance",
                    span,
                    hint=advice.unsupported("inst"),
                )
                return BROKEN
            case UnsupportedEntry():
                self._ctx.error(
                    codes.UNSUPPORTED_BUILTIN,
                    f"function `{name}` is not supported",
                    span,
                    hint=advice.unsupported(name),
                )
                return BROKEN

    def _simple(self, builtin: str, name: str, t: Type, span: Span) -> Draft:
        """A built-in without type variables; its type is made once."""
        own = self._types.get(builtin)
        if own is None:
            own = self._types[builtin] = from_type(t, [])
        unsupported = BUILTINS[builtin].unsupported

        def build() -> core.Exp:
            if unsupported:
                self._ctx.warn_unsupported(name, unsupported, span)
            return core.Builtin(builtin, t, span, ())

        return Draft(own, build)

    def _sealed(self, entry: SealedEntry, name: str, span: Span) -> Draft:
        """A member of a structure: typed as its signature says, translated as what it is."""
        own, _ = self._ctx.unifier.instantiate(entry.type, list(entry.quants))
        inner = self.entry(entry.inner, name, span)
        unifier = self._ctx.unifier
        before, unifier.see_through = unifier.see_through, True
        try:
            unifier.unify(inner.type, own)
        finally:
            unifier.see_through = before
        return Draft(own, inner.build)

    def _variable(self, binding: Binding, span: Span) -> Draft:
        if not binding.generalised:
            # A use inside its own declaration, or of something not polymorphic.
            def build_same() -> core.Exp:
                symbol = self._ctx.symbol_of(binding)
                inst = tuple(to_type(q) for q in binding.quants)
                return core.Var(symbol, to_type(binding.type), span, inst)

            return Draft(binding.type, build_same)
        own, inst = self._ctx.unifier.instantiate(binding.type, binding.quants)

        def build() -> core.Exp:
            symbol = self._ctx.symbol_of(binding)
            return core.Var(symbol, to_type(own), span, tuple(map(to_type, inst)))

        return Draft(own, build)

    def _overloaded(self, entry: OverloadedEntry, span: Span) -> Draft:
        by_type = {_STRUCTURE_TYPES[c.split(".")[0]]: c for c in OVERLOADED[entry.name]}
        operand = self._ctx.unifier.fresh(among=by_type)
        first, _ = self._ctx.library_type(BUILTINS[entry.choices[0]].text)
        own = _replace_int(from_type(first, []), operand)

        def build() -> core.Exp:
            known = prune(operand)
            chosen = by_type[known.name] if isinstance(known, ICon) else entry.choices[0]
            return core.Builtin(chosen, to_type(own), span)

        return Draft(own, build)

    def _constructor(self, entry: ConEntry, span: Span) -> Draft:
        own = self._ctx.constructor_type(entry)
        if entry.constructor == NIL:
            return Draft(own, lambda: core.ListExp((), to_type(own), span))
        return Draft(own, lambda: core.Con(entry.constructor, to_type(own), span))

    def _unbound(self, name: str, span: Span) -> Draft:
        self._ctx.tainted = True
        if name in self._ctx.unknown:
            return BROKEN
        self._ctx.unknown.add(name)
        if self._ctx.errors > _MOST_ADVICE:
            self._ctx.error(codes.UNBOUND, f"{quoted(name)} is not declared", span)
            return BROKEN
        hint = ""
        *path, last = split_name(name)
        if path:
            structure = ".".join(path)
            means_colset = self._ctx.means_colset(structure)
            colset = self._ctx.colsets[structure] if means_colset else None
            if colset is not None:
                hint = suggestion(last, members_of(colset))
                self._ctx.error(
                    codes.UNBOUND,
                    f"colour set `{structure}` has no function `{last}`",
                    span,
                    hint=hint or f"it has: {', '.join(sorted(members_of(colset)))}",
                )
                return BROKEN
            hint = self._path_hint(structure, last)
        elif not name[0].isalpha():
            hint = advice.adjacent_symbols(name, self._ctx.scope.names())
        else:
            near, colours = self._ctx.colours_hint(name, self._ctx.expected)
            if not colours and self._ctx.token is not None:
                expected = _expected_at(*self._ctx.token, span.start)
                near, colours = self._ctx.colours_hint(name, expected)
            hint = (
                advice.behind_slashes(span.source.text[: span.start])
                or near
                or advice.unbound_word(name, self._ctx.colsets)
                or self._order_hint(name, span)
                or suggestion(name, self._ctx.scope.own_names(), self._library_names(name))
                or (colours and _colour_or_variable(colours, name, span))
            )
            if name in self._ctx.net_variables:
                hint = advice.variable_out_of_scope(span.source.origin.part)
        if not hint and name[0].isalpha() and self._ctx.unread_files:
            hint = f"it may be declared in `{self._ctx.unread_files[-1]}`, which could not be read"
        if not hint and name[0].isalpha() and not path:
            hint = f"declare it: `var {name} : C;` for a variable of colour set C, or `val {name} = ..`"
            if span.source.origin.part in ("initial marking", "priority"):
                hint = f"declare it: `val {name} = ..`, or `fun {name} () = ..`"
                if name in _PRIORITIES:
                    hint = f"declare it, as CPN Tools does in a new net: `val {name} = {_PRIORITIES[name]};`"
            if span.source.origin.part == "declaration":
                hint = "declare it above what uses it"
        self._ctx.error(codes.UNBOUND, f"{quoted(name)} is not declared", span, hint=hint)
        return BROKEN

    def _library_names(self, name: str) -> set[str]:
        """What may be meant besides the net's own names: a short one, like `lt`, is close to almost any short name, and
        is worth suggesting only where upper and lower case are wrong."""
        return {
            n
            for n in self._ctx.scope.names()
            if len(n) >= _SHORTEST_SUGGESTED or n.lower() == name.lower()
        }

    def _order_hint(self, name: str, span: Span) -> str:
        """For a name that is declared, but not above."""
        if span.source.origin.part != "declaration" or name in self._ctx.net_variables:
            return ""
        if name in declared_names(span.source):
            return (
                "it is declared only here or below: functions that call themselves are declared with `fun`, "
                "those that call each other joined with `and`"
            )
        return self._ctx.announced_hint(name) if name in self._ctx.announced() else ""

    def _path_hint(self, structure: str, member: str) -> str:
        """For `structure.member` where no such thing is known."""
        variable = self._ctx.scope.value(structure)
        if isinstance(variable, Binding):
            return f"a field of a record is selected with `#{member} {structure}`"
        return advice.unbound_path(structure, member, self._ctx.colsets, BUILTINS)


def _colour_or_variable(colours: str, name: str, span: Span) -> str:
    """The colours that fit, and the variable that may be missing where there can be one."""
    if span.source.origin.part in ("initial marking", "declaration", "priority"):
        return colours
    return f"{colours}; or a variable of it: `var {name} : C;`"


def _expected_at(exp: s.Exp, token: Type, start: int) -> Ty | None:
    """The type that the name which begins at an offset of an inscription must have, where the token has one."""
    todo: list[tuple[s.Exp, Type]] = [(exp, token)]
    while todo:
        e, t = todo.pop()
        match e:
            case s.NameExp() if e.span.start == start:
                return from_type(t, [])
            case s.RecordExp() if isinstance(t, TRecord):
                fields = dict(t.fields)
                todo += [(x, fields[label]) for label, x in e.fields if label in fields]
            case s.InfixExp() if e.operator.name in ("++", "+++"):
                todo += [(e.left, t), (e.right, t)]
            case s.InfixExp() if e.operator.name == "`":
                todo.append((e.right, t))
            case s.InfixExp() if e.operator.name.startswith("@"):
                todo.append((e.left, t))
            case s.IfExp():
                todo += [(e.then, t), (e.otherwise, t)]
    return None


def _replace_int(t: Ty, by: Ty) -> Ty:
    if isinstance(t, ICon):
        return by if t.name == "int" else t
    if isinstance(t, IRec):
        return IRec(tuple((n, _replace_int(f, by)) for n, f in t.fields))
    if isinstance(t, IFun):
        return IFun(_replace_int(t.argument, by), _replace_int(t.result, by))
    return t
