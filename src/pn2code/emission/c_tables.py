"""C declarations of the net's types, and the constant tables (`pn_type_t`) that describe its colour sets."""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.emission.c_lines import wrap
from pn2code.emission.c_literals import c_big_initialiser, c_integer
from pn2code.emission.c_types import Types
from pn2code.emission.environment import c_comment, c_float, c_string
from pn2code.emission.names import label
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Definition, Descriptor, Rep
from pn2code.ir.types import closure

_KINDS = {
    Rep.UNIT: "PN_KIND_UNIT",
    Rep.BOOL: "PN_KIND_BOOL",
    Rep.INT: "PN_KIND_INT",
    Rep.BIG: "PN_KIND_BIG",
    Rep.TIME: "PN_KIND_INT",
    Rep.REAL: "PN_KIND_REAL",
    Rep.STRING: "PN_KIND_STRING",
    Rep.CHAR: "PN_KIND_CHAR",
    Rep.ENUM: "PN_KIND_ENUM",
    Rep.STRUCT: "PN_KIND_RECORD",
    Rep.LIST: "PN_KIND_LIST",
    Rep.UNION: "PN_KIND_UNION",
    Rep.REF: "PN_KIND_REF",
}


def forward(definition: Definition, types: Types) -> str:
    """The typedef that comes before all bodies, "" for enumerations."""
    names = types.names
    match definition:
        case ir.EnumDef() | ir.RefDef():
            return ""
        case ir.StructDef(name=name) | ir.UnionDef(name=name):
            return f"typedef struct {names.tag(name)} {names.type(name)};"
        case ir.ListDef(name=name):
            cell = names.cell(name)
            tag = cell.removesuffix("_t")
            return f"typedef struct {tag} {cell};\ntypedef const {cell} *{names.type(name)};"


def body(definition: Definition, types: Types) -> list[str]:
    """The declaration itself."""
    names = types.names
    match definition:
        case ir.EnumDef(name=name, constructors=constructors):
            return [*_enum(name, constructors, types, f"enum {names.tag(name)}", names.type(name))]
        case ir.StructDef(name=name, fields=fields):
            lines = [f"struct {names.tag(name)} {{"]
            lines += [f"    {types.name(t)} {label(x)};" for x, t in fields]
            return [*lines, "};"]
        case ir.ListDef(name=name, element=element):
            tag = names.cell(name).removesuffix("_t")
            return [
                f"struct {tag} {{",
                f"    {names.type(name)} tail;",
                f"    {types.name(element)} head;",
                "};",
            ]
        case ir.RefDef(name=name, target=target):
            return [f"typedef {types.name(target)} *{names.type(name)};"]
        case ir.UnionDef(name=name, constructors=union):
            tag = f"{names.tag(name)}_tag"
            lines = _enum(name, tuple(c for c, _, _ in union), types, f"enum {tag}", f"{tag}_t")
            lines += ["", f"struct {names.tag(name)} {{", f"    {tag}_t tag;"]
            if all(argument is None for _, argument, _ in union):
                return [*lines, "};"]
            lines.append("    union {")
            for constructor, argument, boxed in union:
                if argument is not None:
                    pointer = "const " if boxed else ""
                    star = "*" if boxed else ""
                    lines.append(
                        f"        {pointer}{types.name(argument)} {star}{label(constructor)};"
                    )
            return [*lines, "    } as;", "};"]


def _enum(
    name: str, constructors: tuple[str, ...], types: Types, head: str, typedef: str
) -> list[str]:
    lines = [f"typedef {head} {{"]
    last = len(constructors) - 1
    for i, c in enumerate(constructors):
        comma = "," if i < last else ""
        lines.append(f"    {types.names.constructor(name, c)} = {i}{comma}")
    return [*lines, f"}} {typedef};"]


class Tables:
    """Prints descriptors."""

    def __init__(
        self, types: Types, descriptors: dict[str, Descriptor], names_of_members: dict[str, str]
    ) -> None:
        self._types = types
        self._names = types.names
        self._descriptors = descriptors
        self._members = names_of_members

    def is_recursive(self, key: str) -> bool:
        """Whether the table refers to itself, perhaps through others."""
        d = self._descriptors[key]
        parts = {part for _, part in d.fields if part} | ({d.element} if d.element else set())
        return key in closure(self._descriptors, parts)

    def to_declare(self, keys: list[str]) -> list[str]:
        """The tables that are needed before they are defined, in this order."""
        found = [key for key in keys if self.is_recursive(key)]
        for i, key in enumerate(keys):
            d = self._descriptors[key]
            parts = [part for _, part in d.fields if part] + ([d.element] if d.element else [])
            found += [p for p in parts if p in keys[i + 1 :] and p not in found]
        return found

    def print(self, key: str) -> list[str]:
        """The constants that make the table."""
        d = self._descriptors[key]
        name = self._names.table(key)
        c_type = self._types.name(d.type)
        lines: list[str] = []
        if d.comment:
            lines.append(f"/* {c_comment(d.comment)} */")
        members = [
            f".kind = {_KINDS[d.type.rep]}",
            f".name = {c_string(key.removeprefix('type '))}",
            f".size = sizeof({c_type})",
        ]
        members += self._flags(d)
        if d.names:
            strings = ", ".join(c_string(n) for n in d.names)
            lines.append(f"static const char *const {name}_names[] = {{ {strings} }};")
            members.append(f".name_of_value = {name}_names")
        if d.type.rep is Rep.ENUM:
            members.append(f".count = {len(d.names)}U")
        if d.fields:
            lines += self._fields(d, name, c_type)
            members += [f".count = {len(d.fields)}U", f".field = {name}_fields"]
        if d.fields and d.type.rep is Rep.STRUCT:
            parts = list(self._parts(key))
            lines.append(f"static const pn_part_t {name}_parts[] = {{")
            lines += [
                f"    {{ &{self._names.table(part)}, offsetof({c_type}, {member}) }},"
                for part, member in parts
            ]
            lines.append("};")
            members += [f".part_count = {len(parts)}U", f".part = {name}_parts"]
        if d.element and d.type.rep is Rep.REF:
            members.append(f".element = &{self._names.table(d.element)}")
        elif d.element:
            cell = self._names.cell(d.type.name)
            members += [
                f".element = &{self._names.table(d.element)}",
                f".head = offsetof({cell}, head)",
                f".cell = sizeof({cell})",
            ]
        if d.member:
            members.append(f".member = {self._members[d.member]}")
        return [*lines, *wrap(f"static const pn_type_t {name} = {{ {', '.join(members)} }};")]

    def _parts(self, key: str) -> Iterator[tuple[str, str]]:
        """Tables and members of what a record consists of; a record in it only if it is a subset, after its parts."""
        for text, part in self._descriptors[key].fields:
            inner = self._descriptors[part]
            member = label(text)
            if inner.type.rep is not Rep.STRUCT:
                yield part, member
                continue
            for further, path in self._parts(part):
                yield further, f"{member}.{path}"
            if inner.member:
                yield part, member

    @staticmethod
    def _flags(d: Descriptor) -> list[str]:
        members = []
        if d.low is not None or d.high is not None:
            members.append(".has_range = true")
            if d.type.rep is Rep.REAL:
                low = c_float(float(d.low)) if d.low is not None else "-(double)INFINITY"
                high = c_float(float(d.high)) if d.high is not None else "(double)INFINITY"
                members += [f".real_low = {low}", f".real_high = {high}"]
            elif d.type.rep is Rep.BIG:
                assert d.low is not None
                assert d.high is not None
                low, high = (c_big_initialiser(int(x)) for x in (d.low, d.high))
                members += [f".big_low = {low}", f".big_high = {high}"]
            else:
                low = c_integer(int(d.low)) if d.low is not None else "INT64_MIN"
                high = c_integer(int(d.high)) if d.high is not None else "INT64_MAX"
                members += [f".low = {low}", f".high = {high}"]
        for flag in ("is_index", "is_float32", "is_narrow", "is_tuple"):
            if getattr(d, flag):
                members.append(f".{flag} = true")
        if d.chars:
            members += [
                ".has_chars = true", f".char_low = {d.chars[0]}U", f".char_high = {d.chars[1]}U",
            ]  # fmt: skip
        return members

    def _fields(self, d: Descriptor, name: str, c_type: str) -> list[str]:
        lines = [f"static const pn_field_t {name}_fields[] = {{"]
        definition = self._types.definitions[d.type.name]
        boxed: dict[str, bool] | None = None
        if isinstance(definition, ir.UnionDef):
            boxed = {c: b for c, _, b in definition.constructors}
        for text, part in d.fields:
            # Two exceptions of one name are apart in C, but not to their readers.
            name_of = c_string(text.split(" ")[0] if boxed is not None else text)
            if not part:
                lines.append(f"    {{ {name_of}, NULL, 0U, false }},")
                continue
            member = label(text) if isinstance(definition, ir.StructDef) else f"as.{label(text)}"
            flag = "true" if boxed is not None and boxed[text] else "false"
            table = self._names.table(part)
            lines.append(f"    {{ {name_of}, &{table}, offsetof({c_type}, {member}), {flag} }},")
        return [*lines, "};"]
