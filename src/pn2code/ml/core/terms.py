"""The typed core language: what the checker makes of CPN ML, and all that the later stages know of it.

Every name is resolved to a `Symbol` or a built-in, every node has its type and span, derived forms are gone:
`fun` with clauses is a lambda with rules, `andalso`/`orelse` are `If`, infix operators are applications, overloaded
operators are resolved (`+` on int is the built-in "Int.+", on real "Real.+"), `#f r` is `Select`,
open record patterns are complete,
list patterns and expressions use `nil` and `::` constructors only in patterns (`PCon`), expressions have `ListExp`.

The reference evaluator (`semantics`) and the compiler (`lowering`) both start here and share nothing further on.

Example: `fun f 0 = 1 | f n = n * f (n - 1)` becomes

    RecBind(((f : int -> int), (), Lambda([Rule(PLit 0, Lit 1), Rule(PVar n, Apply(Builtin "Int.*",
    Record{1: n, 2: Apply(f, ...)}))])))
"""

from __future__ import annotations

from dataclasses import field

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.types import Type


@frozen
class Symbol:
    """A variable: a net variable, a local of a function, or a top-level value or function.

    Equality is by `uid`, unique in the program, so shadowing needs no care later.

    Args:
        uid: unique number.
        name: as written.
        type: its type; for polymorphic let/top-level symbols the generic type with `TVar`s.
        generics: how many type variables are quantified (TVar indices first_generic..first_generic+generics-1).
        first_generic: 0 at top level; a polymorphic local numbers its variables after those of the functions around it,
            whose variables its type may mention as well.
        colset: the colour set, for net variables.
        is_global: declared at top level of the declarations (or of a structure).
    """

    uid: int
    name: str = field(compare=False)
    type: Type = field(compare=False)
    generics: int = field(compare=False, default=0)
    colset: Colset | None = field(compare=False, default=None)
    is_global: bool = field(compare=False, default=False)
    first_generic: int = field(compare=False, default=0)


@frozen
class Constructor:
    """A data or exception constructor.

    Args:
        name: as written (`true`, `::`, `SOME`, `Ack`, an enumeration's value).
        data_type: name of its TCon; "exn" for exceptions.
        tag: position among the constructors of its type, in order of declaration; for exceptions a unique number.
        has_argument: whether it takes one.
        siblings: number of constructors of the type; 0 for exceptions.
    """

    name: str
    data_type: str
    tag: int
    has_argument: bool
    siblings: int


# --- expressions -------------------------------------------------------------------------------


@frozen
class Lit:
    """A literal: int (also IntInf), real, str for string and char; the type tells which."""

    value: int | float | str
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class Var:
    """A use of a symbol; `inst` are the types for its generics, in index order."""

    symbol: Symbol
    type: Type
    span: Span = field(compare=False, repr=False)
    inst: tuple[Type, ...] = ()


INSTANCE_NUMBER = "Page.inst"
"""The built-in that `inst` is in inscriptions, until the net is flattened: see `pn2code.net.instance_numbers`."""


@frozen
class Builtin:
    """A function or value of the built-in environment by its full resolved name.

    Names are those of the structures: "Int.+", "Real.<", "List.map", "Math.sin", "String.^",
    "Ms.++", "Ms.`" (coefficient),
    "Time.@+", polymorphic equality is "=" and "<>" (`type` says at which type). Functions of a
    colour set's structure are
    "Colset.all", "Colset.mkstr", ... with `colset` set. `pn2code.ml.library.builtins` is the table with all
    types and one-line meanings.
    """

    name: str
    type: Type
    span: Span = field(compare=False, repr=False)
    inst: tuple[Type, ...] = ()
    colset: Colset | None = None


@frozen
class Con:
    """A constructor as a value (a function if it takes an argument). `bool` and `nil` are constructors too."""

    constructor: Constructor
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class Apply:
    """Application."""

    function: Exp
    argument: Exp
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class Lambda:
    """`fn p1 => e1 | p2 => e2`; no rule matching raises Match."""

    rules: tuple[Rule, ...]
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class RecordExp:
    """Record, tuple, unit. Fields are evaluated in *this* order (as written); the type has them sorted."""

    fields: tuple[tuple[str, Exp], ...]
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class Select:
    """`#label e`."""

    label: str
    record: Exp
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class ListExp:
    """`[e1, ..., en]`."""

    items: tuple[Exp, ...]
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class If:
    """Conditional (also `andalso`, `orelse`)."""

    condition: Exp
    then: Exp
    otherwise: Exp
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class Case:
    """`case e of rules`; no rule matching raises Match (or Bind, from a `val`)."""

    scrutinee: Exp
    rules: tuple[Rule, ...]
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class Let:
    """`let decs in e end`."""

    declarations: tuple[Dec, ...]
    body: Exp
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class Sequence:
    """`(e1; ...; en)`: all evaluated, the last is the value."""

    items: tuple[Exp, ...]
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class While:
    """`while c do e`, of type unit."""

    condition: Exp
    body: Exp
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class Raise:
    """`raise e`."""

    exception: Exp
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class Handle:
    """`e handle rules`; no rule matching raises the exception again."""

    body: Exp
    rules: tuple[Rule, ...]
    type: Type
    span: Span = field(compare=False, repr=False)


Exp = (
    Lit | Var | Builtin | Con | Apply | Lambda | RecordExp | Select | ListExp | If | Case | Let
    | Sequence | While | Raise | Handle
)  # fmt: skip


@frozen
class Rule:
    """`pattern => body`."""

    pattern: Pat
    body: Exp
    span: Span = field(compare=False, repr=False)


# --- patterns ----------------------------------------------------------------------------------


@frozen
class PWild:
    """`_`."""

    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class PVar:
    """A variable. In a pattern of a net inscription the symbol is a net variable: the first
    occurrence met binds it, each
    further one is an equality test."""

    symbol: Symbol
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class PLit:
    """A literal; in inscriptions of a net also reals (equality types in CPN ML)."""

    value: int | float | str
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class PEqual:
    """In a pattern of a net inscription: the name of a declared value, which is compared."""

    value: Var
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class PRecord:
    """Record, tuple, unit; complete, fields sorted as in the type."""

    fields: tuple[tuple[str, Pat], ...]
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class PCon:
    """A constructor with its argument pattern, if any; lists are `nil` and `::` of a pair."""

    constructor: Constructor
    argument: Pat | None
    type: Type
    span: Span = field(compare=False, repr=False)


@frozen
class PAs:
    """`x as p`."""

    symbol: Symbol
    pattern: Pat
    type: Type
    span: Span = field(compare=False, repr=False)


Pat = PWild | PVar | PLit | PEqual | PRecord | PCon | PAs


# --- declarations ------------------------------------------------------------------------------


@frozen
class ValBind:
    """`val p = e`. For a generalised binding the pattern's symbols have `generics` > 0."""

    pattern: Pat
    value: Exp
    span: Span = field(compare=False, repr=False)


@frozen
class RecBind:
    """A group of mutually recursive functions (`fun f .. and g ..`, `val rec`)."""

    bindings: tuple[tuple[Symbol, Lambda], ...]
    span: Span = field(compare=False, repr=False)


@frozen
class ExceptionDec:
    """A declared exception; evaluation does nothing (constructors are static)."""

    constructor: Constructor
    argument: Type | None
    span: Span = field(compare=False, repr=False)


@frozen
class DatatypeDec:
    """A declared data type, also of enumeration and union colour sets: constructors with argument
    types (generic in TVars)."""

    name: str
    generics: int
    constructors: tuple[tuple[Constructor, Type | None], ...]
    span: Span | None = field(compare=False, repr=False)


Dec = ValBind | RecBind | ExceptionDec | DatatypeDec


@frozen
class Program:
    """All declarations of a net, checked, in order: colour sets, values, functions, references.

    Args:
        declarations: core declarations in order of evaluation (globref is a ValBind to a ref).
        colsets: by name, in order of declaration.
        variables: net variables by name.
        datatypes: every data type of the program by TCon name, built-in ones included (bool, list, option, order).
        globals: top-level symbols by name (the last declaration of a name), for `--set` and reports.
        int_bits: width of `int`: 31 as in CPN Tools, or 64; beyond it `Overflow` is raised.
        used: the files of declarations that were read (`use "functions.sml"`), each with the SHA-256 of its content.
    """

    declarations: tuple[Dec, ...]
    colsets: dict[str, Colset]
    variables: dict[str, Symbol]
    datatypes: dict[str, DatatypeDec]
    globals: dict[str, Symbol]
    int_bits: int = 31
    used: tuple[tuple[str, str], ...] = ()
