"""ML types and colour sets -> C representations (`IrType`, definitions) and runtime tables (`Descriptor`).

Two colour sets with the same ML type share one C type, named after the first of them, and have a table each:
their order of components, their ranges and their storage may differ.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from pn2code.base.frozen import replace
from pn2code.diagnostics import NOWHERE, Origin, Span
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Definition, Descriptor, IrType, Rep
from pn2code.ir.types import is_restricted
from pn2code.lowering.codes import UNSUPPORTED_TYPE, UnsupportedError
from pn2code.lowering.expressions.type_terms import closed, substitute
from pn2code.lowering.prelude import representation
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.terms import Program
from pn2code.ml.core.types import TCon, TFun, TRecord, TVar, Type

_SCALARS = {
    "int": ir.INT,
    "IntInf.int": ir.BIG,
    "real": ir.REAL,
    "string": ir.STRING,
    "char": ir.CHAR,
    "bool": ir.BOOL,
}


class Types:
    """Makes and remembers the types of one net."""

    def __init__(self, program: Program, storage: Mapping[str, str]) -> None:
        self._program = program
        self._storage = storage
        self._definitions: dict[str, Definition] = {}
        self._known: dict[Type, IrType] = {}
        self.descriptors: dict[str, Descriptor] = {}
        self._colset_keys: dict[tuple[str, str, str], str] = {}
        self.subsets: list[tuple[str, Colset]] = []
        self._colset_of_type: dict[Type, Colset] = {}
        for colset in program.colsets.values():
            if colset.kind in (Kind.PRODUCT, Kind.RECORD, Kind.LIST, Kind.ENUM, Kind.UNION):
                self._colset_of_type.setdefault(colset.type, colset)
        self._open: list[str] = []
        self.functions: dict[str, TFun] = {}
        self._index_types = {c.type for c in program.colsets.values() if c.kind is Kind.INDEX}

    # --- types ---------------------------------------------------------------------------------

    def is_index(self, t: Type) -> bool:
        """Whether it is the type of an index colour set, represented by its number."""
        return t in self._index_types

    def lower(self, t: Type, at: Origin | Span = NOWHERE) -> IrType:
        """The representation of a closed type."""
        if t in self._known:
            return self._known[t]
        plain = closed(representation(t))
        made = self._make(t, at) if plain == t else self.lower(plain, at)
        self._known[t] = made
        return made

    def _make(self, t: Type, at: Origin | Span) -> IrType:
        match t:
            case TRecord(fields=()):
                return ir.UNIT
            case TRecord():
                return self._struct(t, at)
            case TCon() if self.is_index(t):
                return ir.INT
            case TCon(name=name) if name in _SCALARS:
                return _SCALARS[name]
            case TCon(name="list", args=(element,)):
                inner = self.lower(element, at)
                if t in self._known:
                    return self._known[t]  # made on the way, by a type that contains itself
                name = self._fresh(self._named(t) or f"{inner}_list")
                self._definitions[name] = ir.ListDef(name, inner)
                return IrType(Rep.LIST, name)
            case TCon(name="timed", args=(value,)):
                inner = self.lower(value, at)
                name = self._fresh(f"timed_{inner}")
                self._definitions[name] = ir.StructDef(name, (("value", inner), ("stamp", ir.TIME)))
                return IrType(Rep.STRUCT, name)
            case TCon(name=name) if name in self._program.datatypes:
                return self._datatype(t, at)
            case TVar():
                return ir.UNIT
            case TFun():
                return self._function(t, at)
            case TCon(name="ref", args=(target,)):
                inner = self.lower(target, at)
                return self.reference_to(inner)
            case TCon(name="exn"):
                name = self._fresh("exn")
                self._open.append(name)
                self._definitions[name] = ir.UnionDef(name, ())
                return IrType(Rep.UNION, name)
            case TCon():
                raise UnsupportedError(
                    UNSUPPORTED_TYPE, f"values of type `{t}` are not supported", at
                )

    def _named(self, t: Type) -> str:
        colset = self._colset_of_type.get(t)
        return colset.name if colset else ""

    def _fresh(self, hint: str) -> str:
        name, n = hint, 2
        while name in self._definitions:
            name, n = f"{hint}_{n}", n + 1
        return name

    def _struct(self, t: TRecord, at: Origin | Span) -> IrType:
        colset = self._colset_of_type.get(t)
        labels = [label for label, _ in t.fields]
        if colset is not None and colset.kind is Kind.RECORD:
            labels = list(colset.labels)
        fields = []
        for label in labels:
            field_type = t.field(label)
            assert field_type is not None
            fields.append((label, self.lower(field_type, at)))
        if t in self._known:
            return self._known[t]
        hint = self._named(t) or "_".join(
            (["tuple"] if t.is_tuple else ["record"]) + [str(f) for _, f in fields]
        )
        name = self._fresh(hint)
        self._definitions[name] = ir.StructDef(name, tuple(fields))
        return IrType(Rep.STRUCT, name)

    def _datatype(self, t: TCon, at: Origin | Span) -> IrType:
        dec = self._program.datatypes[t.name]
        values = dict(enumerate(t.args))
        hint = self._named(t) or "_".join([t.name, *(str(self.lower(a, at)) for a in t.args)])
        name = self._fresh(hint)
        if all(argument is None for _, argument in dec.constructors):
            self._definitions[name] = ir.EnumDef(name, tuple(c.name for c, _ in dec.constructors))
            return IrType(Rep.ENUM, name)
        made = IrType(Rep.UNION, name)
        self._definitions[name] = ir.UnionDef(name, ())  # reserves the name
        self._known[t] = made
        constructors: list[tuple[str, IrType | None, bool]] = []
        for constructor, argument in dec.constructors:
            if argument is None:
                constructors.append((constructor.name, None, False))
                continue
            lowered = self.lower(substitute(argument, values), at)
            constructors.append((constructor.name, lowered, False))
        self._definitions[name] = ir.UnionDef(name, tuple(constructors))
        return made

    # --- functions, exceptions and references as values ----------------------------------------

    def _function(self, t: TFun, at: Origin | Span) -> IrType:
        """A union of all functions that are used as values of this type; see `closures`."""
        argument, result = self.lower(t.argument, at), self.lower(t.result, at)
        if t in self._known:
            return self._known[t]
        name = self._fresh(f"{argument}_to_{result}")
        self._definitions[name] = ir.UnionDef(name, ())
        self._open.append(name)
        self.functions[name] = t
        return IrType(Rep.UNION, name)

    def add_constructor(self, union: IrType, hint: str, argument: IrType | None) -> int:
        """One more constructor of a union of functions or of exceptions; gives its tag."""
        definition = self._definitions[union.name]
        assert isinstance(definition, ir.UnionDef)
        known = {c for c, _, _ in definition.constructors}
        name, n = hint, 2
        while name in known:
            name, n = f"{hint} {n}", n + 1
        added = (name, argument, argument is not None)
        self._definitions[union.name] = ir.UnionDef(union.name, (*definition.constructors, added))
        return len(definition.constructors)

    def struct(self, hint: str, fields: tuple[tuple[str, IrType], ...]) -> IrType:
        """A struct that no ML type has."""
        name = self._fresh(hint)
        self._definitions[name] = ir.StructDef(name, fields)
        return IrType(Rep.STRUCT, name)

    def reference_to(self, target: IrType) -> IrType:
        """The type of references to values of this representation."""
        for definition in self._definitions.values():
            if isinstance(definition, ir.RefDef) and definition.target == target:
                return IrType(Rep.REF, definition.name)
        name = self._fresh(f"{target}_ref")
        self._definitions[name] = ir.RefDef(name, target)
        return IrType(Rep.REF, name)

    def holds(self, t: IrType, what: Callable[[IrType], bool]) -> bool:
        """Whether a value of the type may have a part of some kind in it."""
        seen: set[IrType] = set()
        waiting = [t]
        while waiting:
            t = waiting.pop()
            if what(t):
                return True
            if t.name and t not in seen:
                seen.add(t)
                waiting += ir.parts(self._definitions[t.name])
        return False

    def holds_function(self, t: IrType) -> bool:
        """Whether there may be functions in a value of the type."""
        return self.holds(t, lambda part: part.name in self.functions)

    def holds_reference(self, t: IrType) -> bool:
        """Whether there may be references in a value of the type."""
        return self.holds(t, lambda part: part.rep is Rep.REF)

    def _box(self) -> None:
        """Arguments that would make a data type part of itself are behind pointers."""
        for name in reversed(self._definitions):
            definition = self._definitions[name]
            if isinstance(definition, ir.UnionDef) and name not in self._open:
                self._definitions[name] = ir.UnionDef(
                    name,
                    tuple(
                        (c, a, a is not None and self._contains(a, name))
                        for c, a, _ in definition.constructors
                    ),
                )

    def is_recursive(self, t: IrType) -> bool:
        """Whether arguments of a data type may be behind pointers."""
        definition = self._definitions.get(t.name)
        return isinstance(definition, ir.UnionDef) and any(
            a is not None and self._contains(a, t.name) for _, a, _ in definition.constructors
        )

    def _contains(self, t: IrType, name: str) -> bool:
        """Whether a value of the type has one of the other in it, not behind a pointer."""
        seen: set[str] = set()
        waiting = [t]
        while waiting:
            t = waiting.pop()
            if t.name == name:
                return True
            if t.rep in (Rep.STRUCT, Rep.UNION) and t.name not in seen:
                seen.add(t.name)
                match self._definitions[t.name]:
                    case ir.StructDef(fields=fields):
                        waiting += [f for _, f in fields]
                    case ir.UnionDef(constructors=constructors):
                        waiting += [
                            a for _, a, boxed in constructors if a is not None and not boxed
                        ]
        return False

    def close(self) -> None:
        """All functions and exceptions are known: finish their tables."""
        self._box()
        for name in self._open:
            definition = self._definitions[name]
            assert isinstance(definition, ir.UnionDef)
            if not definition.constructors:
                self._definitions[name] = ir.UnionDef(name, (("none", None, False),))
        finished: set[str] = set()
        while True:
            keys = {
                f"type {name}": name
                for name in self._open
                if f"type {name}" in self.descriptors and name not in finished
            }
            if not keys:
                return
            for key, name in keys.items():
                finished.add(name)
                definition = self._definitions[name]
                assert isinstance(definition, ir.UnionDef)
                fields = tuple(
                    (c, self.plain(a) if a is not None else "")
                    for c, a, _ in definition.constructors
                )
                self.descriptors[key] = replace(self.descriptors[key], fields=fields)

    def list_of(self, element: IrType) -> IrType:
        """The list type with elements of this representation, which some ML type must have."""
        for definition in self._definitions.values():
            if isinstance(definition, ir.ListDef) and definition.element == element:
                return IrType(Rep.LIST, definition.name)
        raise KeyError(f"no list of {element}")

    def definition(self, t: IrType) -> Definition:
        """The definition of a type that has one."""
        return self._definitions[t.name]

    def definitions(self) -> tuple[Definition, ...]:
        """All definitions, each after those that it contains by value."""
        order: list[Definition] = []
        seen: set[str] = set()

        def visit(name: str) -> None:
            if name in seen:
                return
            seen.add(name)
            definition = self._definitions[name]
            parts: list[IrType] = []
            match definition:
                case ir.StructDef(fields=fields):
                    parts = [f for _, f in fields]
                case ir.ListDef(element=element):
                    parts = [element]
                case ir.UnionDef(constructors=constructors):
                    parts = [
                        a
                        for _, a, boxed in constructors
                        if a is not None and (not boxed or a.rep in (Rep.ENUM, Rep.REF))
                    ]
                case ir.RefDef(target=target) if target.rep in (Rep.ENUM, Rep.REF):
                    parts = [target]
                case ir.EnumDef() | ir.RefDef():
                    pass
            for part in parts:
                if part.name and part.rep is not Rep.LIST:
                    visit(part.name)
            order.append(definition)

        for name in self._definitions:
            visit(name)
        return tuple(order)

    # --- descriptors ---------------------------------------------------------------------------

    def plain(self, t: IrType) -> str:
        """The key of the table of a type, without ranges."""
        key = f"type {t}"
        if key in self.descriptors:
            return key
        self.descriptors[key] = Descriptor(key, t)  # stops recursion
        made = Descriptor(key, t)
        if t.name:
            match self.definition(t):
                case ir.EnumDef(constructors=names):
                    made = replace(made, names=names)
                case ir.StructDef(fields=fields):
                    parts = tuple((label, self.plain(f)) for label, f in fields)
                    is_tuple = all(label.isdigit() for label, _ in fields)
                    made = replace(made, fields=parts, is_tuple=is_tuple)
                case ir.ListDef(element=element) | ir.RefDef(target=element):
                    made = replace(made, element=self.plain(element))
                case ir.UnionDef() if t.name in self._open:
                    pass  # see `close`
                case ir.UnionDef(constructors=constructors):
                    made = replace(
                        made,
                        fields=tuple((c, self.plain(a) if a else "") for c, a, _ in constructors),
                    )
        return self._store(key, made)

    def colset(self, colset: Colset) -> str:
        """The key of the table of a colour set."""
        identity = (colset.name, colset.origin.location(), str(colset.type))
        if identity in self._colset_keys:
            return self._colset_keys[identity]
        key = colset.name
        n = 2
        while key in self.descriptors:
            key, n = f"{colset.name} {n}", n + 1
        self._colset_keys[identity] = key
        self.descriptors[key] = Descriptor(key, self.lower(colset.type, colset.origin))
        return self._store(key, self._describe(key, colset))

    def _store(self, key: str, made: Descriptor) -> str:
        """Remember a finished table after those of its parts."""
        parts = [part for _, part in made.fields if part] + ([made.element] if made.element else [])
        narrow = made.is_float32 or any(self.descriptors[part].is_narrow for part in parts)
        self.descriptors.pop(key, None)
        self.descriptors[key] = replace(made, is_narrow=narrow)
        return key

    def _part(self, colset: Colset | None) -> str:
        return self.colset(colset) if colset is not None else ""

    def _describe(self, key: str, colset: Colset) -> Descriptor:
        t = self.lower(colset.type, colset.origin)
        made = Descriptor(key, t, comment=f"colset {colset.name}")
        if self._storage.get(colset.name) == "float32":
            made = replace(made, is_float32=True)
        low, high = colset.low, colset.high
        match colset.kind:
            case Kind.ALIAS | Kind.SUBSET:
                base = colset.components[0]
                assert base is not None
                inner = self.descriptors[self.colset(base)]
                made = replace(
                    inner,
                    name=key,
                    comment=made.comment,
                    is_float32=inner.is_float32 or made.is_float32,
                )
                if colset.kind is Kind.SUBSET:
                    made = replace(made, member=f"member {key}")
                    self.subsets.append((key, colset))
            case Kind.ENUM | Kind.UNIT | Kind.BOOL:
                made = replace(made, names=colset.names)
            case Kind.INT | Kind.INTINF | Kind.TIME | Kind.REAL:
                assert not isinstance(low, str)
                assert not isinstance(high, str)
                made = replace(made, low=low, high=high)
            case Kind.INDEX:
                assert not isinstance(low, str)
                assert not isinstance(high, str)
                made = replace(made, low=low, high=high, is_index=True, names=colset.names)
            case Kind.STRING:
                chars = None
                if isinstance(low, str) and isinstance(high, str):
                    chars = (ord(low[0]), ord(high[0]))
                length = colset.length or (None, None)
                made = replace(made, chars=chars, low=length[0], high=length[1])
            case Kind.PRODUCT:
                parts = tuple((str(i), self._part(c)) for i, c in enumerate(colset.components, 1))
                made = replace(made, fields=parts, is_tuple=True)
            case Kind.RECORD:
                parts = tuple(
                    (label, self._part(c))
                    for label, c in zip(colset.labels, colset.components, strict=True)
                )
                made = replace(made, fields=parts)
            case Kind.LIST:
                assert not isinstance(low, str)
                assert not isinstance(high, str)
                made = replace(made, element=self._part(colset.components[0]), low=low, high=high)
            case Kind.UNION if t.rep is Rep.ENUM:  # all constructors are constants
                made = replace(made, names=colset.names, is_tuple=True)
            case Kind.UNION:
                pairs = zip(colset.names, colset.components, strict=True)
                made = replace(made, fields=tuple((c, self._part(a)) for c, a in pairs))
        return made

    def has_subset(self, key: str) -> bool:
        """Whether the values cannot be counted from the table alone."""
        d = self.descriptors[key]
        parts = [part for _, part in d.fields if part]
        return bool(d.member) or any(part != key and self.has_subset(part) for part in parts)

    def is_small(self, key: str) -> bool:
        """Whether the runtime can count the values: bounded, without subsets."""
        d = self.descriptors[key]
        if d.member or d.type.rep in (Rep.REAL, Rep.STRING, Rep.LIST):
            return False
        if d.type.rep in (Rep.INT, Rep.BIG):
            bounds = (d.low, d.high)
            return all(x is not None and (d.type == ir.INT or abs(x) < 2**63) for x in bounds)
        return all(self.is_small(part) for _, part in d.fields if part)

    def count(self, key: str) -> int:
        """The number of values of a small table."""
        d = self.descriptors[key]
        match d.type.rep:
            case Rep.INT | Rep.BIG:
                return int(d.high or 0) - int(d.low or 0) + 1
            case Rep.BOOL:
                return 2
            case Rep.ENUM:
                return len(d.names)
            case Rep.STRUCT:
                return math.prod(self.count(part) for _, part in d.fields)
            case Rep.UNION:
                return sum(self.count(part) if part else 1 for _, part in d.fields)
            case _:
                return 1

    def is_restricted(self, key: str) -> bool:
        """Whether the table excludes values of its type."""
        return is_restricted(self.descriptors, key)
