"""Which colour sets have tokens that are a fixed number of scalars, so that a message or file can hold one."""

from __future__ import annotations

from pn2code.ml.core.colsets import Colset, Kind

_SCALARS = {
    Kind.UNIT,
    Kind.BOOL,
    Kind.INT,
    Kind.INTINF,
    Kind.TIME,
    Kind.REAL,
    Kind.STRING,
    Kind.ENUM,
    Kind.INDEX,
}


def has_fixed_size(colset: Colset) -> bool:
    """Whether a token is a fixed number of scalars."""
    c = colset.resolved
    if c.kind in (Kind.PRODUCT, Kind.RECORD):
        return all(part is not None and has_fixed_size(part) for part in c.components)
    if c.kind is Kind.SUBSET:
        base = c.components[0]
        return base is not None and has_fixed_size(base)
    return c.kind in _SCALARS
