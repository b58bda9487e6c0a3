"""Inscriptions that cannot raise an exception: they may be looked at before all variables of a transition are bound.

This is a part of what an order of steps means (`binding`), for all who take it.
"""

from __future__ import annotations

from pn2code.ml.core import terms as core
from pn2code.net.enumerable import SMALL, size

_TOTAL = frozenset(
    {"=", "<>", "Ms.`", "Ms.++", "Bool.not", "String.^"}
    | {f"{s}.{op}" for s in ("Int", "IntInf", "Real", "String") for op in ("<", "<=", ">", ">=")}
    | {f"{s}.{op}" for s in ("Int", "IntInf", "Real") for op in ("+", "-", "*", "~")}
)
"""Built-in functions that do nothing but give a value; an Overflow is taken where it comes."""


def is_total(e: core.Exp) -> bool:
    """Whether an expression has a value without doing anything: neither exceptions nor random numbers."""
    match e:
        case core.Lit() | core.Var() | core.Con():
            return True
        case core.RecordExp(fields=fields):
            return all(is_total(x) for _, x in fields)
        case core.ListExp(items=items):
            return all(map(is_total, items))
        case core.Apply(function=core.Con(), argument=argument):
            return is_total(argument)
        case core.Apply(function=core.Builtin(name=name), argument=argument) if name in _TOTAL:
            return is_total(argument)
        case core.Apply(function=core.Builtin(name="Colset.all", colset=colset)):
            return colset is not None and size(colset, SMALL) is not None
        case core.Select(record=record):
            return is_total(record)
        case core.If(condition=c, then=t, otherwise=o):
            return is_total(c) and is_total(t) and is_total(o)
    return False
