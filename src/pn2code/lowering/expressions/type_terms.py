"""Types of ML as terms: variables are replaced, and it is asked what a type is made of."""

from __future__ import annotations

from collections.abc import Mapping

from pn2code.ml.core.types import UNIT, TCon, TFun, TRecord, TVar, Type


def substitute(t: Type, values: Mapping[int, Type]) -> Type:
    """Replace the type variables of a scheme."""
    if not values:
        return t
    match t:
        case TVar(index=i):
            return values.get(i, t)
        case TCon(name=name, args=args):
            return TCon(name, tuple(substitute(a, values) for a in args)) if args else t
        case TFun(argument=a, result=r):
            return TFun(substitute(a, values), substitute(r, values))
        case TRecord(fields=fields):
            return TRecord(tuple((label, substitute(f, values)) for label, f in fields))


def closed(t: Type) -> Type:
    """The type with unit for what nothing in the program decides (`length []`): any type will do."""
    match t:
        case TVar():
            return UNIT
        case TCon(name=name, args=args):
            return TCon(name, tuple(map(closed, args))) if args else t
        case TFun(argument=a, result=r):
            return TFun(closed(a), closed(r))
        case TRecord(fields=fields):
            return TRecord(tuple((label, closed(f)) for label, f in fields))


def has_function(t: Type) -> bool:
    """Whether a value of the type is or contains a function."""
    match t:
        case TFun():
            return True
        case TCon(args=args):
            return any(has_function(a) for a in args)
        case TRecord(fields=fields):
            return any(has_function(f) for _, f in fields)
        case TVar():
            return False
