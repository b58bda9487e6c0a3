"""The order of the values of untimed places in C, with their types known."""

from __future__ import annotations

from collections.abc import Mapping

from pn2code.emission.c_types import Types
from pn2code.emission.names import Names, label
from pn2code.ir.nodes import Descriptor, Rep

_SCALAR = frozenset({Rep.BOOL, Rep.INT, Rep.CHAR, Rep.ENUM})
"""Representations whose values C compares in the order of the colour set."""


class Orders:
    """Names and text of the functions that say which of two values comes first."""

    def __init__(self, types: Types, names: Names, descriptors: Mapping[str, Descriptor]) -> None:
        self._types = types
        self._names = names
        self._descriptors = descriptors
        self.functions: dict[str, list[str]] = {}

    def name(self, key: str) -> str:
        """The macro or function that is `less` for a descriptor; makes the function if there is none yet."""
        d = self._descriptors[key]
        if d.type.rep in _SCALAR:
            return "PN_LESS"
        name = f"is_before_{self._names.table(key).removeprefix('s_')}"
        if name not in self.functions:
            self.functions[name] = self._function(name, key)
        return name

    def _function(self, name: str, key: str) -> list[str]:
        d = self._descriptors[key]
        c_type = self._types.name(d.type)
        lines: list[str] = []
        if d.type.rep is Rep.UNIT:
            lines += ["    (void)a;", "    (void)b;", "    return false;"]
        elif d.type.rep is Rep.STRUCT and d.fields:
            self._fields(key, "", lines)
            if not lines:  # all its components are units
                lines += ["    (void)a;", "    (void)b;"]
            lines.append("    return false;")
        else:
            lines.append(f"    return pn_compare(&{self._names.table(key)}, a, b) < 0;")
        head = f"static inline bool {name}(const {c_type} *a, const {c_type} *b)"
        return [head, "{", *lines, "}"]

    def _fields(self, key: str, path: str, lines: list[str]) -> None:
        """Component by component, nested ones in place."""
        for text, part in self._descriptors[key].fields:
            inner = self._descriptors[part]
            member = f"{path}{label(text)}"
            if inner.type.rep is Rep.UNIT:
                continue
            if inner.type.rep is Rep.STRUCT and inner.fields:
                self._fields(part, f"{member}.", lines)
            elif inner.type.rep in _SCALAR:
                lines.append(f"    if (a->{member} != b->{member}) {{")
                lines.append(f"        return a->{member} < b->{member};")
                lines.append("    }")
            else:
                order = f"{member.replace('.', '_')}_order"
                if inner.type.rep is Rep.STRING:
                    call = f"pn_string_order(a->{member}, b->{member})"
                else:
                    call = f"pn_compare(&{self._names.table(part)}, &a->{member}, &b->{member})"
                lines.append(f"    const int {order} = {call};")
                lines.append(f"    if ({order} != 0) {{")
                lines.append(f"        return {order} < 0;")
                lines.append("    }")
