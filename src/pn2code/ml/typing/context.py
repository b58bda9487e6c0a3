"""What all parts of the elaborator share: diagnostics, unifier, scope, and how mistakes in types are reported."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Note, Span
from pn2code.diagnostics.suggestions import nearest
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.types import INT, TCon, Type
from pn2code.ml.library.builtin_table_sized import INTEGERS, WORD_BITS
from pn2code.ml.library.datatypes import DATATYPES, LITERAL_TYPES, WORD_TYPES
from pn2code.ml.library.exceptions import FIRST_EXCEPTION_TAG
from pn2code.ml.library.schemes import scheme
from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.advice import BY_CODE, CLOSE
from pn2code.ml.typing import type_advice
from pn2code.ml.typing.environment import Binding, ConEntry, Scope, library_scope
from pn2code.ml.typing.inference import (
    ERROR,
    ICon,
    IFun,
    IRec,
    Meta,
    Quant,
    Ty,
    from_type,
    prune,
    to_type,
)
from pn2code.ml.typing.shown_types import Shower
from pn2code.ml.typing.type_advice import conversion, label_notes
from pn2code.ml.typing.unifier import Unifier, UnifyError

BY_SOCKETS = "`simulate --sockets`"
"""Stands in what is said of a function that a run with connections to other programs has."""
MAX_DEPTH = 250
"""Nesting of operators and calls that is followed; the later stages recurse over what is built from it."""

_MOST_COLOURS = 8
_ENDS = {
    **{name: 1 << bits for name, bits in WORD_BITS.items()},
    **{f"{name}.int": 1 << (bits - 1) for name, bits in INTEGERS.items()},
}
"""Types of numbers of a fixed size -> the first literal that is too large."""


class TooDeepError(Exception):
    """Reported already; unwinds to the border."""


@frozen
class Draft:
    """An expression whose type may still be partly unknown; `build` gives the core expression once it is known."""

    type: Ty
    build: Callable[[], core.Exp]


PatternBuild = Callable[[], core.Pat]


def no_expression() -> core.Exp:
    """The `build` of something that was reported; never called."""
    raise AssertionError("an expression with an error was translated")


BROKEN = Draft(ERROR, no_expression)


class Context:
    """State of the elaboration of one net.

    Args:
        d: where errors go.
        real_time: whether the clock is real.
        int_bits: width of `int`.

    Attributes:
        unifier: types in the making.
        scope: present scope.
        top: scope of the top-level declarations.
        errors: number of errors reported here (`d` keeps equal ones once).
        depth: nesting of the expression being looked at.
        expected: the type that a name must have which is looked up, if that is known.
        token: of an arc or a marking the inscription, and the type of a token.
        unknown: names reported as not declared in this text; each is reported once.
        net_variables: names of the net's variables, for advice where they are not in scope.
        tainted: set when something is used whose declaration had an error.
        weak: types of values that are not generalised; what is unknown in them at the end of the declaration stays so.
        open_records: selectors and open patterns whose record type must be known in the end.
        tyvars: explicit type variables in force, innermost last.
        written_tyvars: those that no declaration around them binds, and where they are written.
        generic_base: number of type variables quantified around the declaration being translated.
        datatypes: all datatypes by name.
        colsets: by name; None for those with errors.
        equality: whether a datatype (of equality arguments) has equality.
        unread_files: files of declarations that are not there or could not be read.
        announced: gives all names that the net declares anywhere.
        mentions_instances: whether an inscription uses `inst`.
        on_page: whether what is typed stands on a page, whose instances have numbers.
        warned: element, part and function of each warning about a function that cannot run here.
        division: the innermost `/` whose operands are being looked at.
    """

    def __init__(self, d: Diagnostics, real_time: bool, *, int_bits: int = 31) -> None:
        self.d = d
        self.real_time = real_time
        self.int_bits = int_bits
        self.equality: dict[str, bool] = {}
        self.unifier = Unifier(self.equality)
        self.top = Scope(library_scope())
        self.scope = self.top
        self.tainted = False
        self.errors = 0
        self.depth = 0
        self.unknown: set[str] = set()
        self.expected: Ty | None = None
        self.token: tuple[s.Exp, Type] | None = None
        self.net_variables: set[str] = set()
        self.open_records: list[tuple[Meta, Span]] = []
        self.weak: list[Ty] = []
        self.tyvars: list[dict[str, Meta]] = []
        self.written_tyvars: list[tuple[str, Meta, Span]] = []
        self.generic_base = 0
        self.datatypes: dict[str, core.DatatypeDec] = dict(DATATYPES)
        self.colsets: dict[str, Colset | None] = {}
        self.unread_files: list[str] = []
        self.announced: Callable[[], frozenset[str]] = frozenset
        self.mentions_instances = False
        self.on_page = False
        self.warned: set[tuple[str, str, str]] = set()
        self.division: s.InfixExp | None = None
        self.next_uid = 0
        self.next_exception = FIRST_EXCEPTION_TAG
        self._names: dict[Type, str | None] = {}

    def enter(self, span: Span) -> None:
        """One level deeper; `depth` goes back by the caller.

        Raises:
            TooDeepError: the limit is passed, which was reported.
        """
        self.depth += 1
        if self.depth > MAX_DEPTH:
            self.error(
                codes.TOO_DEEP,
                f"this is nested more than {MAX_DEPTH} levels deep",
                Span(span.source, span.start, min(span.end, span.start + 40)),
                hint="give parts of it a name with `val` or `let`",
            )
            raise TooDeepError

    def warn_unsupported(self, name: str, reason: str, span: Span) -> None:
        """Says once per element that a function exists in CPN Tools but cannot run here."""
        without = " without `--sockets`" if BY_SOCKETS in reason else ""
        self.warn_once(
            codes.UNSUPPORTED_BUILTIN,
            name,
            f"`{name}` is not available here: {reason}",
            span,
            f"the net is accepted, but a run{without} stops where this is applied",
        )

    def warn_once(self, code: str, name: str, message: str, span: Span, hint: str) -> None:
        """Says something of a name once per element."""
        origin = span.source.origin
        key = (origin.element_id or str(origin), origin.part, name)
        if key not in self.warned:
            self.warned.add(key)
            self.d.warning(code, message, span, hint=hint)

    # --- scopes and symbols

    @contextmanager
    def block(self) -> Iterator[Scope]:
        """A scope inside the present one."""
        outer = self.scope
        self.scope = Scope(outer)
        try:
            yield self.scope
        finally:
            self.scope = outer

    def means_colset(self, structure: str) -> bool:
        """Whether a structure's name is that of a colour set here; a structure that was declared later hides it."""
        return structure in self.colsets and not self.scope.declares_structure(structure)

    @contextmanager
    def with_colsets(self, colsets: Mapping[str, Colset | None]) -> Iterator[None]:
        """While a functor's body is declared again, the colour sets are those that it saw."""
        outer, self.colsets = self.colsets, dict(colsets)
        try:
            yield
        finally:
            self.colsets = outer

    @property
    def at_top(self) -> bool:
        """Whether a declaration here is global."""
        return self.unifier.level == 0

    def fresh_symbol(self, name: str, t: Type, colset: Colset | None = None) -> core.Symbol:
        """A new symbol without generics."""
        self.next_uid += 1
        return core.Symbol(self.next_uid, name, t, colset=colset)

    def symbol_of(self, binding: Binding) -> core.Symbol:
        """The symbol of a binding whose type is known by now."""
        if binding.symbol is None:
            self.next_uid += 1
            binding.symbol = core.Symbol(
                self.next_uid,
                binding.name,
                to_type(binding.type),
                generics=len(binding.quants),
                colset=binding.colset,
                is_global=binding.is_global,
                first_generic=binding.quants[0].index if binding.quants else 0,
            )
        return binding.symbol

    @contextmanager
    def generics(self, quants: list[Quant]) -> Iterator[None]:
        """Numbers the quantified variables of a declaration while it is translated."""
        base = self.generic_base
        for i, quant in enumerate(quants):
            quant.index = base + i
        self.generic_base = base + len(quants)
        try:
            yield
        finally:
            self.generic_base = base

    def library_type(self, text: str) -> tuple[Type, int]:
        """A type of the built-in table."""
        return scheme(text, self.real_time)

    def constructor_type(self, entry: ConEntry) -> Ty:
        """A constructor's type, at fresh unknowns."""
        if entry.scheme is not None:
            body, quants = entry.scheme
            return self.unifier.instantiate(body, list(quants))[0]
        return self.unifier.instantiate_type(entry.type, entry.generics)[0]

    def unique_type_name(self, name: str) -> str:
        """The name, stamped if a datatype or built-in type has it already."""
        candidate, n = name, 1
        while candidate in self.datatypes or (n == 1 and candidate in library_scope().types):
            n += 1
            candidate = f"{name}#{n}"
        return candidate

    def add_datatype(self, declaration: core.DatatypeDec) -> None:
        """Makes a datatype known, and whether it has equality: it has if all constructor arguments have."""
        self.datatypes[declaration.name] = declaration
        self.equality[declaration.name] = True
        free: list[Ty] = [Quant(True) for _ in range(declaration.generics)]
        for _, argument in declaration.constructors:
            if argument is not None:
                try:
                    self.unifier.require_equality(from_type(argument, free))
                except UnifyError:
                    self.equality[declaration.name] = False

    def refuse_unknown_rows(self) -> None:
        """After `generalise`: as in SML, no later use tells which record a function takes."""
        for row, span in self.open_records:
            if any(prune(row) is unknown for unknown in self.unifier.unknown_rows) and not (
                self.tainted or self.errors
            ):
                self._row_not_known(span)
        self.unifier.unknown_rows.clear()

    def _row_not_known(self, span: Span) -> None:
        self.error(
            codes.UNRESOLVED_RECORD,
            f"the record type of `{span.text}` is not known here",
            span,
            hint="give the argument a type: `fun f (r : PART) = ..`",
        )

    def resolve_pending(self) -> None:
        """At the end of a declaration or inscription: overloaded types take the default, records must be known."""
        before = self.errors
        for row, span in self.open_records:
            if isinstance(prune(row), Meta) and not before:
                self._row_not_known(span)
        self.open_records.clear()
        for meta in self.unifier.pending:
            if meta.ref is None and meta.among:
                meta.ref = ICon(meta.among[0])
        self.unifier.pending.clear()

    # --- reporting

    def error(
        self,
        code: str,
        message: str,
        at: Span,
        *,
        label: str = "",
        notes: Iterable[Note | str] = (),
        hint: str = "",
    ) -> None:
        """Reports an error."""
        self.errors += 1
        hint = hint or BY_CODE.get(code, "")
        self.d.error(code, message, at, label=label, notes=notes, hint=hint)

    def announced_hint(self, name: str, own: str = "") -> str:
        """For a name that is declared nowhere above."""
        if name == own:
            return "a colour set cannot contain itself; recursive values need a `datatype`"
        if name in self.announced():
            return "it is declared further down: move its declaration up"
        return BY_CODE[codes.UNKNOWN_COLOUR_SET]

    def check_literal(self, value: object, t: Type, span: Span) -> None:
        """Refuses a literal beyond the width of its type, as CPN Tools does."""
        if not isinstance(t, TCon) or not isinstance(value, int):
            return
        end = 1 << (self.int_bits - 1) if t == INT else _ENDS.get(t.name)
        if end is None or -end <= value < end:
            return
        wider = (
            "use IntInf (`IntInf.fromString`, colour set `intinf`), or the option `--int-bits 64`"
        )
        if self.int_bits >= 64:
            wider = "use IntInf (colour set `intinf`)"
        self.error(
            codes.LITERAL_TOO_LARGE,
            f"`{span.text}` is too large for `{t.name}`, which ends at {end - 1}",
            span,
            hint=wider if t == INT else "",
        )

    def unify(self, found: Ty, expected: Ty, span: Span, what: str) -> bool:
        """Makes the types equal or says that `what`, at `span`, has the wrong type."""
        try:
            self.unifier.unify(found, expected)
        except UnifyError as problem:
            self.mismatch(found, expected, span, what, problem)
            return False
        return True

    def mismatch(self, found: Ty, expected: Ty, span: Span, what: str, problem: UnifyError) -> None:
        """Says in what way two types differ."""
        show = Shower(self)
        shown = show(found)
        reason = problem.reason
        if reason == "among" and prune(expected) is not problem.right:
            reason = "mismatch"  # the overloaded one is a literal in what was found
        match reason:
            case "circular":
                self.error(
                    codes.CIRCULAR_TYPE,
                    f"{what} would need a type that contains itself: `{shown}` and `{show(expected)}`",
                    span,
                )
            case "equality":
                self.error(
                    codes.NOT_EQUALITY,
                    f"{what} is `{shown}`, which has no equality",
                    span,
                    hint="functions cannot be compared; compare their results",
                )
            case "field":
                record = show(problem.left)
                known = (
                    [n for n, _ in problem.left.fields] if isinstance(problem.left, IRec) else []
                )
                self.error(
                    codes.UNKNOWN_FIELD,
                    f"`{record}` has no field `{problem.detail}`",
                    span,
                    hint=suggestion(problem.detail, known)
                    or f"it has {', '.join(f'`#{n}`' for n in known)}",
                )
            case "among":
                names = problem.right.among if isinstance(problem.right, Meta) else ()
                literal = set(names) <= {t.name for t in (*LITERAL_TYPES, *WORD_TYPES)}
                if literal:
                    names = names[:1]
                self.error(
                    codes.TYPE_MISMATCH if literal else codes.OVERLOAD,
                    f"{what} is `{show(problem.left)}`, but {type_advice.among(names)} is expected",
                    span,
                    label=f"this is `{show(problem.left)}`",
                    hint=type_advice.wrong_operand(what, problem.left, span.text)
                    or self._conversion(what, problem.left, names, span),
                )
            case _:
                notes = label_notes(found, expected)
                left, right = prune(problem.left), prune(problem.right)
                if not notes and {id(left), id(right)} != {id(prune(found)), id(prune(expected))}:
                    notes.append(f"`{show(left)}` and `{show(right)}` differ inside")
                if "`" in span.text and type_advice.is_list(found):
                    shown = shown.removesuffix(" list") + " ms"
                self.error(
                    codes.TYPE_MISMATCH,
                    f"{what} is `{shown}`, but {self._wanted(what, found, expected, show)} is expected",
                    span,
                    label=f"this is `{shown}`",
                    notes=notes,
                    hint=type_advice.wrong_operand(what, found, span.text, expected)
                    or self._conversion(what, found, (_name(expected),), span)
                    or self.constructor_hint(found, expected, span.text)
                    or type_advice.wrong_value(found, expected, span.text, what),
                )

    def _conversion(self, what: str, found: Ty, wanted: Iterable[str], span: Span) -> str:
        """How to convert `what`, which is at `span`."""
        hint = conversion(found, wanted)
        if self.real_time and what == "delay" and hint.startswith("convert with `floor`"):
            return f"a delay that is real is written with `@++`; or {hint}"
        divided = self.division is not None and span in type_advice.terms(self.division)
        if divided and hint.startswith("convert with `real`"):
            return f"{hint}; `/` divides reals, integers are divided with `div`"
        return hint

    def colours_hint(self, name: str, expected: Ty | None) -> tuple[str, str]:
        """For a name that is none, where a value of `expected` belongs: a colour that is like it, and all colours."""
        wanted = prune(expected) if expected is not None else None
        if not isinstance(wanted, ICon) or wanted.name not in self.colsets:
            return "", ""
        datatype = self.datatypes.get(wanted.name)
        if datatype is None:
            return "", ""
        values = [c.name for c, argument in datatype.constructors if argument is None]
        if not values:
            return "", ""
        listed = ", ".join(f"`{v}`" for v in values[:_MOST_COLOURS])
        listed += ", ..." if len(values) > _MOST_COLOURS else ""
        return suggestion(name, values), f"a value of `{datatype.name}` belongs here: {listed}"

    def constructor_hint(self, found: Ty, expected: Ty, text: str) -> str:
        """For the argument of a constructor without the constructor."""
        wanted = prune(expected)
        datatype = self.datatypes.get(wanted.name) if isinstance(wanted, ICon) else None
        if datatype is None or datatype.generics:
            return ""
        for constructor, argument in datatype.constructors:
            if argument is not None and self.unifier.attempt(found, from_type(argument, [])):
                inner = text if text.startswith("(") or text.isidentifier() else f"({text})"
                return f"put the constructor before it: `{constructor.name} {inner}`"
        return ""

    def _wanted(self, what: str, found: Ty, expected: Ty, show: Shower) -> str:
        """The expected type in words where it is a multi-set, a reference or a function of any type."""
        operator = type_advice.operand(what)
        of_multisets = operator in type_advice.MULTISET_OPERATORS
        if of_multisets and type_advice.is_list(expected) and not type_advice.is_list(found):
            return "a multi-set"
        if of_multisets and "timed" in show(found):
            return "an untimed multi-set"
        t = prune(expected)
        if isinstance(t, ICon) and t.name == "ref" and operator in ("", ":="):
            return "a reference"
        if isinstance(t, IFun):
            return f"a function `{show(expected)}`"
        return f"`{show(expected)}`"

    def show(self, t: Ty) -> str:
        """A type in the user's words."""
        return Shower(self)(t)

    def name_type(self, colset: Colset) -> None:
        """Lets a product or record type be shown by its colour set's name, as long as only one has it."""
        self._names[colset.type] = None if colset.type in self._names else colset.name

    def type_name(self, t: Type) -> str | None:
        """The colour set that alone has this type."""
        return self._names.get(t)


def suggestion(name: str, *known: Iterable[str]) -> str:
    """`did you mean ..?`, or nothing; names of an earlier group are preferred."""
    close = nearest(name, *known, cutoff=CLOSE)
    return f"did you mean `{close}`?" if close else ""


def _name(t: Ty) -> str:
    t = prune(t)
    return t.name if isinstance(t, ICon) else ""
