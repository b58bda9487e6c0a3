"""The front end's face: declarations and inscriptions go in as text, the typed core language comes out.

Typical use (the `link` and `check` stages of `pn2code.net`):

    e = Elaborator(d)
    e.colset(ColsetSpec("INT", "int", ...))
    e.variables(("n",), "INT", origin)
    e.declarations(SourceText("fun twice x = 2 * x", origin))
    index, exp = e.expression(SourceText("1`twice n", origin), (INT, list_of(INT)), expected_name="INT")
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import Any, TypeVar

from pn2code.base.weakly import weakly
from pn2code.diagnostics import Diagnostics, Origin, Severity, SourceText
from pn2code.ml import codes, library
from pn2code.ml.aside import Aside
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.computing import Compute, Computed, Computing
from pn2code.ml.core.constants import Constant, fold
from pn2code.ml.core.terms import Program, Symbol
from pn2code.ml.core.types import STRING, Type
from pn2code.ml.inscription_texts import InscriptionTexts
from pn2code.ml.library.builtins import INFIX
from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.fixity import Fixities, resolve_declaration, resolve_expression
from pn2code.ml.parsing.parser import declared_names, is_layered, parse_expression, parse_program
from pn2code.ml.parsing.plain_text import plain_names
from pn2code.ml.typing.annotations import Annotations
from pn2code.ml.typing.border import at_border
from pn2code.ml.typing.code_segments import CodeSegments, TypedCode
from pn2code.ml.typing.colset_specs import Colsets
from pn2code.ml.typing.context import Context
from pn2code.ml.typing.declarations import Declarations
from pn2code.ml.typing.declared import break_modules, declared_by, types_declared_by
from pn2code.ml.typing.environment import Binding, BrokenEntry, BrokenType, Scope, library_scope
from pn2code.ml.typing.expressions import Expressions
from pn2code.ml.typing.given_values import GivenValues
from pn2code.ml.typing.inscriptions import Inscriptions
from pn2code.ml.typing.instance_functions import InstanceFunctions
from pn2code.ml.typing.names import Names
from pn2code.ml.typing.patterns import Patterns
from pn2code.ml.typing.repeats import Repeats
from pn2code.ml.typing.used_files import UsedFiles, used_by
from pn2code.ml.typing.variables import Variables
from pn2code.ml.typing.written_colset import ColsetSpec

__all__ = ["ColsetSpec", "Elaborator", "TypedCode", "is_layered"]

T = TypeVar("T")
Examine = Callable[[s.Dec, Diagnostics], None]
"""Reports what is wrong with a declaration besides its types."""


def _nothing(dec: s.Dec, d: Diagnostics) -> None:
    """An `Examine` that finds nothing wrong."""


@cache
def _of_library(name: str) -> tuple[SourceText, tuple[s.Dec, ...]]:
    """A text of the library, and its declarations: they are the same for all nets of a process."""
    text = SourceText(library.declaration(name), Origin(f"library/{name}.sml", 1, 1))
    return text, parse_program(text, Diagnostics()) or ()


class Elaborator(InscriptionTexts):
    """Checks the declarations of one net in order, then its inscriptions.

    Args:
        d: where errors go.
        values: replaces `val NAME = ...` of the net: name -> CPN ML text.
        real_time: whether the clock is real (option `realtimestamp`); decides the type `time`.
        int_bits: width of `int`, 31 or 64.
        folder: the net's folder, where used files are; None: there are none.
        compute: evaluates bounds and priorities that cannot be folded; None: such are refused.
    """

    def __init__(
        self,
        d: Diagnostics,
        *,
        values: Mapping[str, str] | None = None,
        real_time: bool = False,
        int_bits: int = 31,
        folder: Path | None = None,
        compute: Compute | None = None,
    ) -> None:
        self._d = d
        self._compute = compute
        self._files = UsedFiles(folder)
        self._ctx = Context(d, real_time, int_bits=int_bits)
        annotations = Annotations(self._ctx)
        patterns = Patterns(self._ctx, annotations)
        names = Names(self._ctx)
        self._expressions = Expressions(self._ctx, annotations, patterns, names)
        self._instances = InstanceFunctions(self._ctx)
        self._given = GivenValues(self._ctx, self._expressions, values or {}, weakly(self._parse))
        self._declare = Declarations(self._ctx, annotations, patterns, self._expressions, names)
        self._fixities: Fixities = dict(INFIX)
        self._made: list[core.Dec] = []
        self._library_top = Scope(library_scope())
        self._variables = Variables(self._ctx, self._library_top)
        self._constants: dict[int, Constant] = {}
        self._bodies: dict[int, core.Exp] = {}
        self._computing = Computing(self._constants, self._bodies)
        self._inscriptions = Inscriptions(
            self._ctx,
            self._expressions,
            patterns,
            self._variables.scope,
            partial(weakly(self._fold), fixed=True),
        )
        self._code_segments = CodeSegments(self._ctx, self._expressions, self._variables.scope)
        self._repeats = Repeats()
        self._beside = 0
        self._library: set[str] = set()
        self._from_library: set[str] = set()
        self._colsets = Colsets(self._ctx, self._declare, weakly(self._plain), weakly(self._fold))

    # --- declarations

    def colset(self, spec: ColsetSpec) -> Colset | None:
        """Declares a colour set; None when it was reported to be wrong."""
        self._repeats.clear()
        self._ctx.tainted = False
        colset, datatypes = self._colsets.declare(spec)
        self._made += datatypes
        if colset is not None:
            self._variables.redeclared(colset)
        self._variables.hide({*spec.ids, *(label for label, _ in spec.fields)}, spec.origin)
        return colset

    @property
    def infix(self) -> frozenset[str]:
        """The operators that are infix now, besides those of the language."""
        return frozenset(self._fixities) - frozenset(INFIX)

    def announce(self, names: Callable[[], frozenset[str]]) -> None:
        """Gives the names that the net declares anywhere: hints tell of declarations in the wrong order."""
        self._ctx.announced = names

    def variables(self, names: Sequence[str], colset_name: str, origin: Origin) -> None:
        """`var names : colset_name`."""
        self._repeats.clear()
        self._variables.declare(names, colset_name, origin)

    def _tables(self) -> tuple[dict[str, Any], ...]:
        """What is declared for the whole net, by name."""
        top = self._ctx.top
        modules = (top.structures, top.signatures, top.functors)
        return (
            top.values,
            top.types,
            *modules,
            self._ctx.colsets,
            self._variables.symbols,
            self._variables.scope.values,
        )

    @contextmanager
    def noting(self, forget: list[Callable[[], None]]) -> Iterator[None]:
        """Appends to `forget` what takes the names away again that are declared meanwhile."""
        before = [dict(table) for table in self._tables()]
        yield
        made = [
            {name: x for name, x in table.items() if x is not old.get(name)}
            for table, old in zip(self._tables(), before, strict=True)
        ]
        forget.append(partial(self._forget, made))

    def _forget(self, made: Sequence[Mapping[str, Any]]) -> None:
        """Takes names away, unless they have been declared again; with a colour set, its variables."""
        self._repeats.clear()
        tables = self._tables()
        for table, names in zip(tables, made, strict=True):
            for name, x in names.items():
                if table.get(name) is x:
                    del table[name]
        self._variables.forget_lost()

    def declarations(self, text: SourceText, examine: Examine = _nothing) -> None:
        """An `ml` element: any number of CPN ML declarations.

        Args:
            text: the declarations.
            examine: is given each of them that is well-typed, and reports what else is wrong with it.
        """
        program = parse_program(text, self._d)
        if program is None:
            colsets, values = plain_names(text.text)
            self.unreadable((*declared_names(text), *values), colsets)
            return
        self._each(text, program, examine)

    def _each(self, text: SourceText, program: Iterable[s.Dec], examine: Examine) -> None:
        """Declarations one after the other."""
        for dec in program:
            before = len(self._d.items)
            self._border(text, partial(self._declaration, text, dec, examine))
            if any(x.severity is Severity.ERROR for x in self._d.items[before:]):
                names = declared_names(text, dec.span.start, dec.span.end)
                self._break(names, types_declared_by(dec))
                break_modules(dec, self._ctx.top)

    def _declaration(self, text: SourceText, dec: s.Dec, examine: Examine = _nothing) -> None:
        self._repeats.clear()
        resolved = resolve_declaration(dec, self._fixities, self._d)
        if resolved is None:
            self._break(declared_names(text, dec.span.start, dec.span.end), types_declared_by(dec))
            break_modules(dec, self._ctx.top)
            return
        changed, self._fixities = resolved
        used = used_by(changed, self._ctx.scope)
        if used is not None:
            self._use(used)
            return
        if isinstance(changed, s.ValDec):
            changed = self._given.replace_in(changed)
        before = self._ctx.errors
        self._ctx.tainted = False
        asks = self._instances.asks(changed)
        before_it = dict(self._ctx.top.values) if asks else {}
        computes = not asks and not self._beside and self._instances.may_ask(changed)
        with self._instances.on_page(asks or computes):
            build = self._declare.declare(changed)
        if self._ctx.errors == before and not self._ctx.tainted:
            self._ctx.resolve_pending()
        self._ctx.open_records.clear()
        if self._ctx.errors > before or self._ctx.tainted:
            self._break(declared_by(changed), types_declared_by(changed))
            break_modules(changed, self._ctx.top)
            return
        examine(changed, self._d)
        for name in sorted(declared_by(changed) | types_declared_by(changed)):
            if "." in name and not isinstance(changed, s.ValDec):
                self._d.error(
                    codes.SYNTAX_ERROR,
                    f"`{name}` cannot be declared: it would be a member of a structure",
                    dec.span,
                )
        self._variables.meet(declared_by(changed), dec.span)
        self._variables.hide(declared_by(changed), dec.span)
        made = build()
        if computes:
            made = self._instances.at_opening(made, self._made)
            if self._ctx.errors > before:
                self._break(declared_by(changed), types_declared_by(changed))
                break_modules(changed, self._ctx.top)
                return
        if not asks:
            self._made += made
        for weak in self._ctx.weak:
            self._ctx.unifier.close(weak)
        self._ctx.weak.clear()
        if asks:
            self._instances.declare_anew(changed, before_it)
            return
        for one in made:
            if isinstance(one, core.ValBind) and isinstance(one.pattern, core.PVar):
                value = fold(one.value, self._constants)
                if value is not None:
                    self._constants[one.pattern.symbol.uid] = value
                else:
                    self._bodies[one.pattern.symbol.uid] = one.value
            elif isinstance(one, core.RecBind):
                self._bodies.update({symbol.uid: body for symbol, body in one.bindings})

    def unreadable(self, values: Sequence[str], types: Sequence[str]) -> None:
        """Names that declarations declare about which all has been said; nothing is said about their uses."""
        self._break(values, types)
        for name in types:
            self._ctx.colsets[name] = None

    def _break(self, values: Sequence[str] | set[str], types: Sequence[str] | set[str]) -> None:
        """Names of a declaration with an error are known, but nothing is said about their uses."""
        self._repeats.clear()
        for name in values:
            self._ctx.top.values[name] = BrokenEntry()
        for name in types:
            self._ctx.top.types[name] = BrokenType()

    def use(self, text: SourceText) -> None:
        """`use text`: the declarations of a file; the text is CPN ML for its name."""
        self._border(text, lambda: self._use_text(text))

    def _use_text(self, text: SourceText) -> None:
        name = self._parse(text)
        if name is not None:
            self._use(name)

    def _use(self, written: s.Exp) -> None:
        found = self._inscriptions.plain(written, (STRING,), "name of a file")
        if found is None:
            return
        computed = self._fold(found[1])
        name = computed.value
        if not isinstance(name, str):
            self._d.error(
                codes.USED_FILE,
                f"the name of this file {computed.why}",
                written.span,
                hint='write it as a text: `use "functions.sml"`',
            )
            return
        with self._files.read(name, written.span, self._d) as text:
            if text is not None:
                self.declarations(text)
            else:
                self._ctx.unread_files.append(name)

    def globref(self, name: str, text: SourceText) -> None:
        """`globref name = text`."""
        self._border(text, lambda: self._globref(name, text))

    def _globref(self, name: str, text: SourceText) -> None:
        exp = self._parse(text)
        if exp is None:
            self._break([name], ())
            return
        span = text.span()
        value = s.ApplyExp(s.NameExp("ref", True, span), exp, span)
        with_reference = self._ctx.top.values.pop("ref", None)
        pattern = s.NamePat(name, True, span)
        dec = s.ValDec((s.ValBinding(pattern, value, False, span),), span)
        self._declaration(text, dec)
        if with_reference is not None and name != "ref":
            self._ctx.top.values["ref"] = with_reference

    def program(self) -> Program:
        """All declarations of the net. Meaningful when no error was reported."""
        self._given.refuse_unknown()
        return self._so_far()

    def _so_far(self) -> Program:
        """All declarations so far."""
        return Program(
            declarations=tuple(self._made),
            colsets={n: c for n, c in self._ctx.colsets.items() if c is not None},
            variables=dict(self._variables.symbols),
            datatypes=self.datatypes(),
            globals={
                n: e.symbol
                for n, e in self._ctx.top.values.items()
                if isinstance(e, Binding) and e.symbol is not None
            },
            int_bits=self._ctx.int_bits,
            used=tuple(self._files.found),
        )

    def datatypes(self) -> dict[str, core.DatatypeDec]:
        """All datatypes so far, also those that inscriptions declare for themselves."""
        return dict(self._ctx.datatypes)

    @contextmanager
    def aside(self, d: Diagnostics) -> Iterator[Aside]:
        """In its block declarations are made that do not belong to the net, e.g. for a monitor; blocks nest.

        Errors go to `d`. Afterwards all names mean again what they meant before.
        """
        top, made, fixities = self._ctx.top, len(self._made), dict(self._fixities)
        kept, declared = top.kept(), (set(self._library), set(self._from_library))
        before = self._d, self._ctx.d, self._ctx.errors
        result = Aside()
        self._d = self._ctx.d = d
        self._beside += 1
        try:
            yield result
        finally:
            self._beside -= 1
            result.declarations = tuple(self._made[made:])
            result.globals = {
                n: e.symbol
                for n, e in top.values.items()
                if isinstance(e, Binding) and e.symbol is not None
            }
            del self._made[made:]
            top.values, top.types, top.structures = kept.values, kept.types, kept.structures
            top.signatures, top.functors = kept.signatures, kept.functors
            self._d, self._ctx.d, self._ctx.errors = before
            self._fixities, (self._library, self._from_library) = fixities, declared
            self._repeats.clear()

    # --- symbols

    def symbol(self, name: str, t: Type) -> Symbol:
        """A new symbol, which no text can mention by its name unless it is declared for it."""
        return self._ctx.fresh_symbol(name, t)

    def another(self, symbol: Symbol) -> Symbol:
        """A symbol that differs from this one, and is like it in all else."""
        return replace(symbol, uid=self._ctx.fresh_symbol(symbol.name, symbol.type).uid)

    # --- helpers

    def _parse(self, text: SourceText, *, output: bool = False) -> s.Exp | None:
        exp = parse_expression(text, self._d, output=output)
        return None if exp is None else resolve_expression(exp, self._fixities, self._d)

    def _plain(
        self, text: SourceText, types: Sequence[Type], what: str
    ) -> tuple[int, core.Exp] | None:
        """A text outside the net's inscriptions, e.g. a bound: net variables are not in scope."""

        def work() -> tuple[int, core.Exp] | None:
            exp = self._parse(text)
            if exp is None:
                return None
            before = self._ctx.errors
            found = self._inscriptions.plain(exp, types, what, on_page=True)
            bound = None if found is None else (found[0], self._instances.bound(found[1]))
            return bound if self._ctx.errors == before else None

        return self._border(text, work)

    def _fold(self, exp: core.Exp, *, fixed: bool = False) -> Computed:
        """The value of an expression after the declarations so far; else the end of a sentence about it."""
        value: object = self._computing.value(exp)
        why = ""
        if value is None and self._compute is not None:
            real_time = self._ctx.real_time
            computed = self._compute(self._so_far(), exp, fixed=fixed, real_time=real_time)
            value, why = computed.value, computed.why
        if isinstance(value, int | float | str):
            return Computed(value)
        what = "is not a constant that can be computed here"
        return Computed(None, f"{what}: {why}" if why else what)

    @property
    def mentions_instances(self) -> bool:
        """Whether an inscription so far uses `inst`."""
        return self._ctx.mentions_instances

    def tokens(self, exp: core.Exp, is_token: bool) -> Counter[Any] | None:
        """The tokens of an initial marking, which is one of them or a multi-set; None when they cannot be said."""
        return self._computing.tokens(exp, is_token)

    def evaluated(self, exp: core.Exp) -> Computed:
        """The value of an initial marking, by the evaluator that was lent."""
        if self._compute is None:
            return Computed(None)
        return self._compute(self._so_far(), exp, fixed=False, real_time=self._ctx.real_time)

    def _once(self, key: Hashable, text: SourceText, work: Callable[[], T | None]) -> T | None:
        """What `work` makes of a text, or what it made of the same text elsewhere, if there was nothing to say."""
        found: T | None = self._repeats.get(key, text)
        if found is not None:
            return found
        before = len(self._d.items)
        made: T | None = self._border(text, work)
        if made is not None and len(self._d.items) == before:
            self._repeats.keep(key, text, made)
        return made

    def with_library(self, text: SourceText) -> None:
        """Declares what the text mentions of the library of SML/NJ, unless the net has something of that name.

        The library's texts see none of the net's names: a colour `first` does not change what `first` is in them.
        """
        top, library_top = self._ctx.top, self._library_top
        for name in library.mentioned(text.text):
            bare = name.removeprefix("more/")
            if top is not library_top:
                own = (top.structures, top.functors, top.signatures, self._ctx.colsets)
                values = (top.values, self._ctx.net_variables)
                if name in self._from_library or any(bare in known for known in (*own, *values)):
                    continue
                self._from_library.add(name)
            if name not in self._library:
                self._library.add(name)
                self._declare_in_library(name)
            if top is not library_top:
                top.take(library.declared(name), library_top)

    def _declare_in_library(self, name: str) -> None:
        """Declares something of the library where only the library is in scope."""
        before = self._ctx.top, self._ctx.scope, self._ctx.colsets, self._fixities
        self._ctx.top = self._ctx.scope = self._library_top
        self._ctx.colsets, self._fixities = {}, dict(INFIX)
        try:
            self._each(*_of_library(name), _nothing)
        finally:
            self._ctx.top, self._ctx.scope, self._ctx.colsets, self._fixities = before

    def _border(self, text: SourceText, work: Callable[[], T]) -> T | None:
        """Runs one text's elaboration, after what it mentions of the library."""
        self.with_library(text)
        return at_border(self._ctx, text, work)
