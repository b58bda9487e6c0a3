"""Sorts of PNML and the colour sets that they become.

| sort | colour set |
|---|---|
| `dot` | `unit` |
| `bool` | `bool` |
| `finiteenumeration`, `cyclicenumeration` | `with a | b | c` |
| `finiteintrange` | `int with low..high` |
| `productsort` | `product A * B`; of one component: the component itself |
| `partition` | `with part1 | part2` and a function from the sort it divides |
| `positive`, `natural`, `integer` | `int`, from 1, from 0, all |
"""

from __future__ import annotations

from enum import Enum

from pn2code.base.frozen import frozen


class SortKind(Enum):
    """Kinds of sorts, as the terms over them need to tell them apart."""

    DOT = "dot"
    BOOL = "bool"
    ENUM = "finite enumeration"
    CYCLIC = "cyclic enumeration"
    RANGE = "finite integer range"
    INTEGER = "integers"
    PRODUCT = "product"
    PARTITION = "partition"


@frozen
class Sort:
    """A sort, resolved.

    Args:
        name: of the colour set.
        shown: its name in the file, for messages.
        kind: what it is.
        values: ENUM, CYCLIC, PARTITION: the names of the constants.
        low, high: RANGE: the bounds.
        parts: PRODUCT: the components; PARTITION: the sort it divides.
    """

    name: str
    shown: str
    kind: SortKind
    values: tuple[str, ...] = ()
    low: int = 0
    high: int = 0
    parts: tuple[Sort, ...] = ()

    @property
    def is_number(self) -> bool:
        """Whether its values are numbers of CPN ML."""
        return self.kind in (SortKind.RANGE, SortKind.INTEGER)

    @property
    def is_listed(self) -> bool:
        """Whether its values are named constants."""
        return self.kind in (SortKind.ENUM, SortKind.CYCLIC, SortKind.PARTITION)

    def fits(self, other: Sort) -> bool:
        """Whether a value of the other sort may stand where one of this is wanted, as far as types can tell."""
        if self.is_number and other.is_number:
            return True
        if self.kind is SortKind.PRODUCT and other.kind is SortKind.PRODUCT:
            return len(self.parts) == len(other.parts) and all(
                a.fits(b) for a, b in zip(self.parts, other.parts, strict=True)
            )
        if self.kind is SortKind.DOT or self.kind is SortKind.BOOL:
            return self.kind is other.kind
        return self.name == other.name


DOT = Sort("", "dot", SortKind.DOT)
BOOL = Sort("", "bool", SortKind.BOOL)
INTEGER = Sort("", "integer", SortKind.INTEGER)
"""Sorts of terms for which no colour set is declared."""
