"""How many values a colour set has, where that is small enough to enumerate (CPN Tools: at most 100)."""

from __future__ import annotations

from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.terms import ListExp

SMALL = 100
"""CPN Tools' limit for enumerating a variable that nothing binds."""
DECLARED = 100_000
"""Our limit for colour sets with `declare all`, which CPN Tools enumerates at any size."""


def size(c: Colset, limit: int) -> int | None:
    """Number of values, or None when there are more than `limit` or the number is not known.

    For `subset .. by` the base counts: the predicate only makes it smaller.
    """
    count = _size(c, limit)
    return None if count is None or count > limit else count


def _size(c: Colset, limit: int) -> int | None:
    match c.kind:
        case Kind.UNIT:
            return 1
        case Kind.BOOL:
            return 2
        case Kind.ENUM:
            return len(c.names)
        case Kind.INT | Kind.INTINF | Kind.INDEX:
            if isinstance(c.low, int) and isinstance(c.high, int):
                return max(0, c.high - c.low + 1)
            return None
        case Kind.ALIAS | Kind.SUBSET:
            if isinstance(c.members, ListExp):
                return len(c.members.items)
            return None if c.components[0] is None else _size(c.components[0], limit)
        case Kind.PRODUCT | Kind.RECORD:
            product = 1
            for part in c.components:
                n = None if part is None else _size(part, limit)
                if n is None or (product := product * n) > limit:
                    return None
            return product
        case Kind.UNION:
            total = 0
            for part in c.components:
                n = 1 if part is None else _size(part, limit)
                if n is None:
                    return None
                total += n
            return total
        case Kind.LIST:
            base = None if c.components[0] is None else _size(c.components[0], limit)
            if base is None or not isinstance(c.low, int) or not isinstance(c.high, int):
                return None
            return _powers(base, c.low, c.high, limit)
        case Kind.STRING:
            if c.length is None or not isinstance(c.low, str) or not isinstance(c.high, str):
                return None
            return _powers(ord(c.high[:1]) - ord(c.low[:1]) + 1, *c.length, limit)
        case Kind.REAL | Kind.TIME:
            return None


def _powers(base: int, low: int, high: int, limit: int) -> int | None:
    """base**low + ... + base**high."""
    if base <= 1:
        return max(0, high - low + 1) if base == 1 else int(low == 0)
    if high > limit.bit_length():  # two to that power is above the limit already
        return None
    total = 0
    for n in range(low, high + 1):
        total += int(base**n)
    return total
