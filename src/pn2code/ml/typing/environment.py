"""Scopes: what each name means at a point of the program."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field
from functools import cache

from pn2code.base.frozen import frozen, record
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.terms import Constructor, DatatypeDec, Symbol
from pn2code.ml.core.types import EXN, TCon, TFun, TVar, Type
from pn2code.ml.library.builtins import (
    ABSENT_VALUES,
    BUILTINS,
    HIDDEN,
    OVERLOADED,
    QUALIFIED,
    STRUCTURE_ALIASES,
    STRUCTURES,
    TOP_LEVEL,
    UNSUPPORTED_NAMES,
    UTILITIES,
    internal_function,
)
from pn2code.ml.library.datatypes import DATATYPES, TYPE_ABBREVIATIONS, TYPE_ARITY
from pn2code.ml.library.exceptions import EXCEPTIONS, QUALIFIED_EXCEPTIONS, TOP_LEVEL_EXCEPTIONS
from pn2code.ml.parsing.syntax import Dec, FunctorBinding, Sig
from pn2code.ml.typing.engine_names import ENGINE_MEMBERS, ENGINE_STRUCTURES, ENGINE_VALUES
from pn2code.ml.typing.inference import Quant, Ty


@record(eq=False)
class Binding:
    """A variable of the program; its symbol is made when its declaration is translated and its type known.

    Args:
        name: as written.
        type: its type; with `quants` quantified.
        is_global: declared at top level.
        quants: quantified variables; filled when generalised.
        generalised: whether that has happened; uses before (recursive ones) have the one unknown type.
        symbol: the core symbol.
        colset: of a net variable.
    """

    name: str
    type: Ty
    is_global: bool = False
    quants: list[Quant] = field(default_factory=list)
    generalised: bool = False
    symbol: Symbol | None = None
    colset: Colset | None = None


@frozen
class BuiltinEntry:
    """A built-in function by its full name."""

    name: str


@frozen
class OverloadedEntry:
    """One of several built-in functions, by type."""

    name: str
    choices: tuple[str, ...]


@frozen
class ConEntry:
    """A constructor with its type scheme.

    Args:
        constructor: the constructor.
        type: its type as the later stages see it, with `TVar`s.
        generics: number of these.
        scheme: its type as declared where abstract types stand in it, with the quantified variables.
    """

    constructor: Constructor
    type: Type
    generics: int
    scheme: tuple[Ty, tuple[Quant, ...]] | None = None


@frozen
class SealedEntry:
    """A member of a structure at the type that its signature gives it; `quants` are quantified."""

    inner: Entry
    type: Ty
    quants: tuple[Quant, ...]


@frozen
class EmptyEntry:
    """The empty list or multi-set."""


@frozen
class UnitEntry:
    """The value of a unit colour set with a name of its own."""


@frozen
class ColsetEntry:
    """A function of a colour set's structure."""

    colset: Colset
    member: str


@frozen
class BrokenEntry:
    """Something whose declaration has an error that was reported."""


@frozen
class UnsupportedEntry:
    """Something of the library that is not supported."""

    name: str


@frozen
class InstanceEntry:
    """`inst`, in an inscription of a page."""


@frozen
class InstanceFunction:
    """A declared function that asks for `inst ()`: each inscription of a page has its own one, of its own instance.

    Args:
        name: of the function.
        declaration: what declares it.
        known: what the names in it stood for; None for what is not declared.
        types: the same for the names of types.
        bound: those that its patterns may bind.
        needs: other functions like it that it may call.
    """

    name: str
    declaration: Dec
    known: Mapping[str, object]
    types: Mapping[str, object]
    bound: frozenset[str]
    needs: tuple[InstanceFunction, ...] = ()

    def declarations(self) -> list[Dec]:
        """What is declared with it: each declaration once, behind those that it needs."""
        return [one.declaration for one in self._all()]

    def _all(self) -> list[InstanceFunction]:
        """One for each declaration, behind those that it needs."""
        found: dict[int, InstanceFunction] = {}
        begun: set[int] = set()
        todo = [(self, False)]
        while todo:
            one, is_behind = todo.pop()
            key = id(one.declaration)
            if is_behind:
                found[key] = one
            elif key not in begun:
                begun.add(key)
                todo.append((one, True))
                todo.extend((other, False) for other in one.needs)
        return list(found.values())

    def changed(self, top: Scope) -> str:
        """A name in what is declared with it that stands for something else by now; "" if there is none."""
        return next((name for one in self._all() for name in one._changed(top)), "")

    def _changed(self, top: Scope) -> Iterator[str]:
        for name, before in self.known.items():
            now = declared_at(top, name)
            own = before is None and name in self.bound and not isinstance(now, ConEntry)
            if now is not before and not own:
                yield name
        for name, before in self.types.items():
            if type_at(top, name) is not before:
                yield name


def declared_at(top: Scope, name: str) -> object:
    """What a name stands for at top level; of a qualified name, its structure, if the net has declared one."""
    first, *rest = split_name(name)
    if rest:
        return top.structures.get(first)
    found = top.value(name)
    if isinstance(found, InstanceEntry) and top.parent is not None:
        return top.parent.value(name)
    return found


def type_at(top: Scope, name: str) -> object:
    """The same for the name of a type."""
    first, *rest = split_name(name)
    return top.structures.get(first) if rest else top.type(name)


@frozen
class HiddenEntry:
    """A variable of the net whose name has become that of a constructor: it cannot be used."""


Entry = (
    Binding | BuiltinEntry | OverloadedEntry | ConEntry | EmptyEntry | UnitEntry | ColsetEntry | BrokenEntry
    | UnsupportedEntry | InstanceEntry | InstanceFunction | HiddenEntry | SealedEntry
)  # fmt: skip


@frozen
class TypeCon:
    """A type constructor."""

    name: str
    arity: int


@frozen
class TypeAbbreviation:
    """A name for another type."""

    parameters: tuple[Quant, ...]
    body: Ty


@frozen
class BuiltinAbbreviation:
    """A built-in name for a type, as text of the table."""

    text: str
    arity: int


@frozen
class BrokenType:
    """A type whose declaration has an error that was reported."""


@frozen
class AbstractType:
    """A type of a structure whose signature hides what it is."""

    name: str
    parameters: tuple[Quant, ...]
    hidden: Ty
    equality: bool


TypeEntry = TypeCon | TypeAbbreviation | AbstractType | BuiltinAbbreviation | BrokenType


@frozen
class BuiltinStructure:
    """A structure of the library."""

    name: str


@frozen
class BrokenStructure:
    """A structure, signature or functor whose declaration has an error that was reported."""


class Scope:
    """Names of one block; unknown ones are looked up in the block around it. A structure is one, too."""

    def __init__(self, parent: Scope | None = None) -> None:
        self.parent = parent
        self.values: dict[str, Entry] = {}
        self.types: dict[str, TypeEntry] = {}
        self.structures: dict[str, Scope | BuiltinStructure | BrokenStructure] = {}
        self.signatures: dict[str, SignatureEntry | BrokenStructure] = {}
        self.functors: dict[str, FunctorEntry | BrokenStructure] = {}

    def _chain(self) -> Iterator[Scope]:
        scope: Scope | None = self
        while scope is not None:
            yield scope
            scope = scope.parent

    def structure(self, name: str) -> Scope | BuiltinStructure | BrokenStructure | None:
        """A structure by its name, `A` or `A.B`."""
        head, *rest = name.split(".")
        found = next((s.structures[head] for s in self._chain() if head in s.structures), None)
        for part in rest:
            if isinstance(found, BuiltinStructure):
                found = BuiltinStructure(f"{found.name}.{part}")
            elif isinstance(found, Scope):
                found = found.structures.get(part)
        return found

    def declares_structure(self, name: str) -> bool:
        """Whether a structure of the net has that name (`A` of `A.B`); it hides others, and colour sets."""
        head, _, _ = name.partition(".")
        return any(head in s.structures for s in self._chain() if s.parent is not None)

    def signature(self, name: str) -> SignatureEntry | BrokenStructure | None:
        """A signature by its name."""
        return next((s.signatures[name] for s in self._chain() if name in s.signatures), None)

    def functor(self, name: str) -> FunctorEntry | BrokenStructure | None:
        """A functor by its name."""
        return next((s.functors[name] for s in self._chain() if name in s.functors), None)

    def value(self, name: str) -> Entry | None:
        """What a name means as a value."""
        *path, last = split_name(name)
        if not path:
            return next((s.values[last] for s in self._chain() if last in s.values), None)
        structure = self.structure(".".join(path))
        if isinstance(structure, Scope):
            own = structure.values.get(last)
            return UnsupportedEntry(name) if own is None and name in ENGINE_MEMBERS else own
        if isinstance(structure, BrokenStructure):
            return BrokenEntry()
        return library_value(structure.name, last) if structure is not None else None

    def type(self, name: str) -> TypeEntry | None:
        """What a name means as a type."""
        found = next((s.types[name] for s in self._chain() if name in s.types), None)
        if found is None and "." in name:
            *path, last = split_name(name)
            structure = self.structure(".".join(path))
            if isinstance(structure, Scope):
                return structure.types.get(last)
            if isinstance(structure, BrokenStructure):
                return BrokenType()
        return found

    def names(self) -> set[str]:
        """All value names in scope, for suggestions."""
        return {name for s in self._chain() for name in s.values}

    def own_names(self) -> set[str]:
        """The value names in scope that the net itself declares, for suggestions."""
        return {name for s in self._chain() if s.parent is not None for name in s.values}

    def type_names(self) -> set[str]:
        """All type names in scope, for suggestions."""
        return {name for s in self._chain() for name in s.types}

    def absorb(self, other: Scope) -> None:
        """Takes over all names of another block (`open`, `local`)."""
        self.values.update(other.values)
        self.types.update(other.types)
        self.structures.update(other.structures)
        self.signatures.update(other.signatures)
        self.functors.update(other.functors)

    def take(self, names: Iterable[str], other: Scope) -> None:
        """Takes over what names mean in another block, whatever that is."""
        for name in names:
            if name in other.values:
                self.values[name] = other.values[name]
            if name in other.structures:
                self.structures[name] = other.structures[name]
            if name in other.signatures:
                self.signatures[name] = other.signatures[name]
            if name in other.functors:
                self.functors[name] = other.functors[name]

    def kept(self) -> Scope:
        """A copy that later declarations do not change."""
        if self.parent is None:
            return self  # the library
        copy = Scope(self.parent.kept())
        copy.absorb(self)
        return copy


@frozen(eq=False)
class SignatureEntry:
    """A signature, and the names in force where it was declared."""

    signature: Sig
    scope: Scope


@frozen(eq=False)
class FunctorEntry:
    """A functor, and the names and colour sets in force where it was declared."""

    binding: FunctorBinding
    scope: Scope
    colsets: Mapping[str, Colset | None]


def split_name(name: str) -> list[str]:
    """`A.B.c` -> [A, B, c]; symbolic names may follow the last point."""
    parts: list[str] = []
    while name and (name[0].isalpha()) and "." in name:
        head, name = name.split(".", 1)
        parts.append(head)
    return [*parts, name]


def library_value(structure: str, member: str) -> Entry | None:
    """A member of a structure of the library."""
    structure = STRUCTURE_ALIASES.get(structure, structure)
    name = f"{structure}.{member}"
    if name in QUALIFIED:
        return BuiltinEntry(QUALIFIED[name])
    if name in BUILTINS and name not in HIDDEN:
        return BuiltinEntry(name)
    if name in _qualified_constructors():
        return _qualified_constructors()[name]
    base = _library().values.get(member)
    if isinstance(base, ConEntry | EmptyEntry) and member in _CONSTRUCTORS_OF.get(structure, ()):
        return base
    first = name.split(".")[0]
    if name in ABSENT_VALUES or name in ENGINE_MEMBERS or first in ENGINE_STRUCTURES | UTILITIES:
        return UnsupportedEntry(name)
    internal = internal_function(name)
    return None if internal is None else BuiltinEntry(internal)


_CONSTRUCTORS_OF = {
    "General": ("LESS", "EQUAL", "GREATER"),
    "List": ("nil", "::"),
    "Option": ("NONE", "SOME"),
    "Bool": ("true", "false"),
}


@cache
def _qualified_constructors() -> dict[str, ConEntry]:
    """Constructors and exceptions that are members of structures, by qualified name."""
    found = {
        f"{declaration.name.rpartition('.')[0]}.{name}": entry
        for declaration in DATATYPES.values()
        if "." in declaration.name
        for name, entry in constructor_entries(declaration).items()
    }
    for qualified, name in QUALIFIED_EXCEPTIONS.items():
        found[qualified] = _exception_entry(name)
    return found


def _exception_entry(name: str) -> ConEntry:
    constructor, argument = EXCEPTIONS[name]
    return ConEntry(constructor, EXN if argument is None else TFun(argument, EXN), 0)


def library_members(structure: str) -> dict[str, Entry]:
    """All members of a structure of the library, for `open`."""
    structure = STRUCTURE_ALIASES.get(structure, structure)
    prefix = structure + "."
    names = {*BUILTINS, *QUALIFIED, *_qualified_constructors()}
    members = {n.removeprefix(prefix) for n in names if n.startswith(prefix)}
    members |= {*_CONSTRUCTORS_OF.get(structure, ())}
    found = {m: library_value(structure, m) for m in sorted(members) if "." not in m}
    return {m: e for m, e in found.items() if e is not None}


def constructor_entries(declaration: DatatypeDec) -> dict[str, ConEntry]:
    """The constructors of a datatype with their type schemes."""
    own = TCon(declaration.name, tuple(TVar(i) for i in range(declaration.generics)))
    return {
        c.name: ConEntry(c, own if argument is None else TFun(argument, own), declaration.generics)
        for c, argument in declaration.constructors
    }


def library_scope() -> Scope:
    """A scope around all others: the built-in names. Never changed, so all nets share it."""
    return _library()


_LIBRARY: list[Scope] = []


def _library() -> Scope:
    if _LIBRARY:
        return _LIBRARY[0]
    scope = Scope()
    _LIBRARY.append(scope)
    for short, full in TOP_LEVEL.items():
        scope.values[short] = BuiltinEntry(full)
    for short, choices in OVERLOADED.items():
        scope.values[short] = OverloadedEntry(short, choices)
    for declaration in DATATYPES.values():
        if "." not in declaration.name:
            scope.values.update(constructor_entries(declaration))
    for name in sorted(TOP_LEVEL_EXCEPTIONS):
        scope.values[name] = _exception_entry(name)
    scope.values["empty"] = EmptyEntry()
    for name in (UNSUPPORTED_NAMES | ENGINE_VALUES) - scope.values.keys():
        scope.values[name] = UnsupportedEntry(name)
    for name, arity in TYPE_ARITY.items():
        scope.types[name] = TypeCon(name, arity)
    for name, text in TYPE_ABBREVIATIONS.items():
        scope.types[name] = BuiltinAbbreviation(text, ("'a" in text) + ("'b" in text))
    for name in STRUCTURES | ENGINE_STRUCTURES:
        if "." not in name:
            scope.structures[name] = BuiltinStructure(name)
    return scope
