"""Packed places in C: the number of a colour among all of its colour set, and the colour of a number."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from pn2code.emission.c_expressions import PackedPlace
from pn2code.emission.c_literals import c_integer
from pn2code.emission.c_types import Types
from pn2code.emission.names import Names, label
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Descriptor, Rep
from pn2code.lowering.nets.packing import colours


class Numbers:
    """Names and text of the functions `number_of_X` and `colour_of_X`, for colour sets that can be packed."""

    def __init__(self, types: Types, names: Names, descriptors: Mapping[str, Descriptor]) -> None:
        self._types = types
        self._names = names
        self._descriptors = descriptors
        self._made: set[str] = set()
        self.functions: list[list[str]] = []

    def number_of(self, key: str) -> str:
        """The function that numbers the colours of a descriptor."""
        self._make(key)
        return self._number(key)

    def colour_of(self, key: str) -> str:
        """Its inverse."""
        self._make(key)
        return self._colour(key)

    def pointers(self, key: str) -> list[str]:
        """The same two as functions over untyped values, for the table of a place."""
        c_type = self._types.name(self._descriptors[key].type)
        return [
            f"static uint32_t {self.finder(key)}(const void *value)",
            "{",
            f"    return {self.number_of(key)}(value);",
            "}",
            f"static void {self.maker(key)}(uint32_t number, void *value)",
            "{",
            f"    {c_type} *const colour = value;",
            f"    *colour = {self.colour_of(key)}(number);",
            "}",
        ]

    def of_places(
        self, places: tuple[ir.Place, ...], is_pure: Callable[[str], bool], *, by_table: bool
    ) -> tuple[PackedPlace | None, ...]:
        """What statements print of the places that are packed.

        Args:
            places: of the net.
            is_pure: whether the function that decides about the members of a subset gives always the same answers.
            by_table: places that are alike have the same functions.
        """
        return tuple(
            PackedPlace(
                p.packed.colours,
                self.colour_of(p.table),
                all(map(is_pure, self.members(p.table))),
                self._names.kept(p.table, f"packed_{p.packed.width}") if by_table else "",
            )
            if p.packed
            else None
            for p in places
        )

    def if_whole(self, key: str) -> str:
        """`number_of` of a colour set that has numbers, and in which everything is that has one; "" otherwise."""
        is_numbered = colours(self._descriptors, key) > 0
        return self.number_of(key) if is_numbered and not self.members(key) else ""

    def members(self, key: str) -> tuple[str, ...]:
        """The functions that decide about members of subsets that a colour set is made of."""
        d = self._descriptors[key]
        own = (d.member,) if d.member else ()
        return own + tuple(m for _, part in d.fields if part for m in self.members(part))

    def _number(self, key: str) -> str:
        return self._names.number(key, "number_of_{}")

    def _colour(self, key: str) -> str:
        return self._names.number(key, "colour_of_{}")

    def finder(self, key: str) -> str:
        """`number_of` over untyped values."""
        return self._names.number(key, "find_number_of_{}")

    def maker(self, key: str) -> str:
        """`colour_of` over untyped values."""
        return self._names.number(key, "put_colour_of_{}")

    def _make(self, key: str) -> None:
        if key in self._made:
            return
        self._made.add(key)
        d = self._descriptors[key]
        for _, part in d.fields:
            if part:
                self._make(part)
        c_type = self._types.name(d.type)
        number, colour = self._bodies(d)
        kind = "PN_SHARED" if len(d.fields) > 1 else "PN_INLINE"
        self.functions.append(
            [
                f"{kind} uint32_t {self._number(key)}(const {c_type} *v)",
                "{",
                *(f"    {line}" for line in number),
                "}",
                f"{kind} {c_type} {self._colour(key)}(uint32_t number)",
                "{",
                *(f"    {line}" for line in colour),
                "}",
            ]
        )

    def _bodies(self, d: Descriptor) -> tuple[list[str], list[str]]:
        match d.type.rep:
            case Rep.UNIT:
                return ["(void)v;", "return 0U;"], ["(void)number;", "return PN_UNIT;"]
            case Rep.BOOL:
                return ["return *v ? 1U : 0U;"], ["return number != 0U;"]
            case Rep.CHAR:
                return ["return *v;"], ["return (uint8_t)number;"]
            case Rep.ENUM:
                c_type = self._types.name(d.type)
                return ["return (uint32_t)*v;"], [f"return ({c_type})number;"]
            case Rep.INT:
                return self._range(int(d.low or 0), int(d.high or 0))
            case Rep.STRUCT:
                return self._struct(d)
            case _:
                return self._union(d)

    @staticmethod
    def _range(low: int, high: int) -> tuple[list[str], list[str]]:
        first, last = c_integer(low), c_integer(high)
        shifted = "*v" if low == 0 else (f"*v - {first}" if low > 0 else f"*v + {c_integer(-low)}")
        distance = f" {'+' if low > 0 else '-'} {c_integer(abs(low))}" if low else ""
        number = f"((*v >= {first}) && (*v <= {last})) ? (uint32_t)({shifted}) : PN_NO_COLOUR"
        return [f"return {number};"], [f"return (int64_t)number{distance};"]

    def _is_total(self, key: str) -> bool:
        """Whether every value that C can hold has a number."""
        d = self._descriptors[key]
        if d.type.rep in (Rep.UNIT, Rep.BOOL, Rep.CHAR, Rep.ENUM):
            return True
        parts = [part for _, part in d.fields if part]
        return d.type.rep is Rep.STRUCT and all(map(self._is_total, parts))

    def _struct(self, d: Descriptor) -> tuple[list[str], list[str]]:
        number: list[str] = []
        colour: list[str] = []
        partial: list[str] = []
        text = ""
        sizes = [colours(self._descriptors, part) for _, part in d.fields]
        below = 1
        for n in sizes:
            below *= n
        for i, ((name, part), n) in enumerate(zip(d.fields, sizes, strict=True)):
            member = label(name)
            call = f"{self._number(part)}(&v->{member})"
            if self._is_total(part):
                own = call
            else:
                own = f"of_{member}"
                number.append(f"const uint32_t {own} = {call};")
                partial.append(own)
            before = text if i == 1 else f"({text})"
            text = f"({before} * {n}U) + {own}" if text else own
            below //= n
            rest = "number" if below == 1 else f"(number / {below}U)"
            rest = rest if len(d.fields) == 1 else f"{rest} % {n}U"
            colour.append(f"    .{member} = {self._colour(part)}({rest}),")
        if partial:
            each = [f"{p} == PN_NO_COLOUR" for p in partial]
            tests = each[0] if len(each) == 1 else " || ".join(f"({test})" for test in each)
            number += [f"if ({tests}) {{", "    return PN_NO_COLOUR;", "}"]
        number.append(f"return {text or '0U'};")
        if not d.fields:
            return ["(void)v;", *number], ["(void)number;", f"return {self._types.zero(d.type)};"]
        c_type = self._types.name(d.type)
        return number, [f"return ({c_type}){{", *colour, "};"]

    def _union(self, d: Descriptor) -> tuple[list[str], list[str]]:
        definition = self._types.definitions[d.type.name]
        assert isinstance(definition, ir.UnionDef)
        c_type = self._types.name(d.type)
        number = ["switch (v->tag) {"]
        colour: list[str] = []
        before = 0
        for i, (constructor, part) in enumerate(d.fields):
            tag = self._names.constructor(d.type.name, definition.constructors[i][0])
            number.append(f"case {tag}:")
            n = 1
            if part:
                n = colours(self._descriptors, part)
                own = f"{self._number(part)}(&v->as.{label(constructor)})"
                if before == 0:
                    number.append(f"    return {own};")
                elif self._is_total(part):
                    number.append(f"    return {before}U + {own};")
                else:
                    number += [
                        f"    return ({own} != PN_NO_COLOUR)",
                        f"        ? ({before}U + {own})",
                        "        : PN_NO_COLOUR;",
                    ]
                own_number = "number" if before == 0 else f"number - {before}U"
                made = (
                    f".tag = {tag}, .as.{label(constructor)} = {self._colour(part)}({own_number})"
                )
            else:
                number.append(f"    return {before}U;")
                made = f".tag = {tag}"
            before += n
            if i < len(d.fields) - 1:
                colour += [
                    f"if (number < {before}U) {{",
                    f"    return ({c_type}){{ {made} }};",
                    "}",
                ]
            else:
                colour.append(f"return ({c_type}){{ {made} }};")
        if len(d.fields) == 1 and not d.fields[0][1]:
            colour.insert(0, "(void)number;")
        number += ["default:", "    return PN_NO_COLOUR;", "}"]
        return number, colour
