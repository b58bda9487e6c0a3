"""Colour sets: what a place may hold.

A colour set is more than its ML type: it has a declared order of components, ranges, names to
print, and may be timed. Two
colour sets may share one ML type (`colset COORD = real; colset WEIGHT = real;`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field
from enum import Enum
from typing import TYPE_CHECKING

from pn2code.base.frozen import frozen
from pn2code.diagnostics import NOWHERE, Origin
from pn2code.ml.core.types import Type

if TYPE_CHECKING:
    from pn2code.ml.core.terms import Exp


class Kind(Enum):
    """The kinds of colour set of CPN Tools."""

    UNIT = "unit"
    BOOL = "bool"
    INT = "int"
    INTINF = "intinf"
    TIME = "time"
    REAL = "real"
    STRING = "string"
    ENUM = "enum"
    INDEX = "index"
    PRODUCT = "product"
    RECORD = "record"
    LIST = "list"
    UNION = "union"
    SUBSET = "subset"
    ALIAS = "alias"


@frozen
class Colset:
    """One colour set, resolved.

    Args:
        name: declared name.
        kind: ALIAS keeps its own name; use `resolved` to look through it.
        type: the ML type of its values.
        timed: whether its tokens carry time stamps.
        names: UNIT the one name; BOOL (false name, true name); ENUM the constructors; INDEX
        (stem,); UNION constructors.
        components: PRODUCT, RECORD, UNION: per component in *declared* order (UNION: None for a constant constructor);
            LIST, SUBSET, ALIAS: the base as the single component.
        labels: RECORD: the field names in declared order.
        low, high: INT, INDEX: the range; LIST: the length range; REAL: the range; STRING: the
        character range (as strings).
            None: unbounded.
        length: STRING `with .. and l1..l2`: the length range.
        members: SUBSET `with [..]`: the members as a core expression of type list.
        predicate: SUBSET `by f`: a core expression of type base -> bool.
        origin: declaration.
    """

    name: str
    kind: Kind
    type: Type
    timed: bool = False
    names: tuple[str, ...] = ()
    components: tuple[Colset | None, ...] = ()
    labels: tuple[str, ...] = ()
    low: int | float | str | None = None
    high: int | float | str | None = None
    length: tuple[int, int] | None = None
    members: Exp | None = None
    predicate: Exp | None = None
    origin: Origin = field(default=NOWHERE, compare=False)

    @property
    def resolved(self) -> Colset:
        """The colour set with aliases looked through (the alias's own `timed` flag is on the alias)."""
        c = self
        while c.kind is Kind.ALIAS:
            base = c.components[0]
            assert base is not None
            c = base
        return c

    @property
    def whole(self) -> Colset:
        """The colour set from which its colours are: with aliases and subsets looked through."""
        c = self
        while c.kind in (Kind.ALIAS, Kind.SUBSET) and c.components[0] is not None:
            c = c.components[0]
        return c

    def tests(self) -> Iterator[Exp]:
        """The expressions that say which values it has: its own, and those of its parts."""
        yield from (test for test in (self.members, self.predicate) if test is not None)
        for part in self.components:
            if part is not None:
                yield from part.tests()


def definition(c: Colset) -> str:
    """What a colour set is, in the words of its declaration, shortened: `INT * STRING`, `{name: STRING}`."""
    parts = [p.name if p is not None else "" for p in c.components]
    match c.kind:
        case Kind.PRODUCT:
            return " * ".join(parts)
        case Kind.RECORD:
            return "{" + ", ".join(f"{n}: {p}" for n, p in zip(c.labels, parts, strict=True)) + "}"
        case Kind.UNION:
            shown = [f"{n}: {p}" if p else n for n, p in zip(c.names, parts, strict=True)]
            return _some(" + ", shown)
        case Kind.ENUM:
            return _some(" | ", list(c.names))
        case Kind.LIST:
            return f"list {parts[0]}"
        case Kind.ALIAS | Kind.SUBSET:
            return parts[0] if c.kind is Kind.ALIAS else f"subset {parts[0]}"
        case Kind.INDEX:
            return f"{c.names[0]}({c.low}), .., {c.names[0]}({c.high})"
        case Kind.UNIT | Kind.BOOL if c.names:
            return " | ".join(reversed(c.names)) if c.kind is Kind.BOOL else c.names[0]
        case Kind.INT | Kind.INTINF | Kind.REAL if c.low is not None:
            return f"{c.kind.value} with {c.low}..{c.high}"
        case _:
            return str(c.kind.value)


def _some(separator: str, words: list[str]) -> str:
    """The words, the first ones if there are many."""
    return separator.join(words if len(words) <= 6 else [*words[:5], ".."])
