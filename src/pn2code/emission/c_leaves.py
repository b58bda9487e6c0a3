"""The scalars of a colour set, in order: what a token is in an input file or a message."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pn2code.emission.c_lines import wrap
from pn2code.emission.environment import c_string
from pn2code.emission.names import Names
from pn2code.lowering.ir import Descriptor, Place, Rep

_KINDS = {
    Rep.BOOL: "PN_LEAF_BOOL",
    Rep.INT: "PN_LEAF_INT",
    Rep.BIG: "PN_LEAF_INT",
    Rep.REAL: "PN_LEAF_REAL",
    Rep.STRING: "PN_LEAF_STRING",
    Rep.ENUM: "PN_LEAF_ENUM",
    Rep.UNIT: "PN_LEAF_ENUM",
}


class Leaves:
    """The scalars of a net's colour sets, by the key of a descriptor."""

    def __init__(self, names: Names, descriptors: Mapping[str, Descriptor]) -> None:
        self._names = names
        self._descriptors = descriptors

    def of(self, key: str) -> list[tuple[str, str]] | None:
        """Name and kind of each scalar; None: no fixed number."""
        d = self._descriptors[key]
        if d.type.rep in _KINDS:
            return [("", "PN_LEAF_ENUM" if d.is_index else _KINDS[d.type.rep])]
        if d.type.rep is not Rep.STRUCT:
            return None
        leaves = []
        for text, part in d.fields:
            inner = self.of(part)
            if inner is None:
                return None
            leaves += [(f"{text}.{name}" if name else text, kind) for name, kind in inner]
        return leaves

    def lines(self, key: str) -> list[int]:
        """Leaves per line of an input file: a line for each component that is itself composed; scalars alone
        on one line each, unless all are scalars: then they share one line."""
        d = self._descriptors[key]
        if d.type.rep is not Rep.STRUCT:
            return [1]
        counts = [len(self.of(part) or []) for _, part in d.fields]
        return [sum(counts)] if all(n == 1 for n in counts) else counts

    def tables(self, places: Sequence[Place]) -> list[dict[str, list[str]]]:
        """The arrays for each colour set of a place with a fixed number of scalars."""
        tables = []
        for key in dict.fromkeys(p.table for p in places):
            leaves = self.of(key)
            if not leaves:
                continue
            name = self._names.table(key)
            kinds = ", ".join(kind for _, kind in leaves)
            labels = ", ".join(c_string(x) for x, _ in leaves)
            lines = ", ".join(f"{n}U" for n in self.lines(key))
            tables.append(
                {
                    "lines": [
                        *wrap(f"static const pn_leaf_kind_t {name}_kinds[] = {{ {kinds} }};"),
                        *wrap(f"static const char *const {name}_leaves[] = {{ {labels} }};"),
                        *wrap(f"static const uint32_t {name}_lines[] = {{ {lines} }};"),
                    ]
                }
            )
        return tables
