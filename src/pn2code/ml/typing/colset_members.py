"""The functions of a colour set's own structure (`INT.all()`, `PART.set_weight`) and their types."""

from __future__ import annotations

from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import BOOL, TFun, Type, list_of, tuple_of
from pn2code.ml.library.builtins import COLSET_MEMBERS
from pn2code.ml.library.schemes import scheme

_MADE = ("mult", "set", "of")


def members_of(colset: Colset) -> frozenset[str]:
    """The names of the functions that a colour set has."""
    own = colset.resolved
    out = {name for name in COLSET_MEMBERS if name not in _MADE and "." not in name}
    if own.kind in (Kind.PRODUCT, Kind.RECORD):
        out.add("mult")
        out |= {f"set_{label}" for label in _labels(own)}
    if own.kind is Kind.UNION:
        out |= {f"of_{name}" for name in own.names}
    return frozenset(out)


def timed_member(member: str) -> str | None:
    """What a function of `CS'timed` is called among the members of `CS`; None if there is no such function."""
    name = f"timed.{member}"
    return name if name in COLSET_MEMBERS else None


def member_type(colset: Colset, member: str) -> Type:
    """The type of a function; the colour set must have it."""
    own = colset.resolved
    if member == "mult":
        lists = [list_of(c.type) for c in own.components if c is not None]
        return TFun(tuple_of(*lists), list_of(own.type))
    if member.startswith("set_"):
        component = own.components[_labels(own).index(member.removeprefix("set_"))]
        assert component is not None
        return TFun(own.type, TFun(component.type, own.type))
    if member.startswith("of_"):
        return TFun(own.type, BOOL)
    t, _ = scheme(COLSET_MEMBERS[member].text, False, own.type)
    return t


def _labels(colset: Colset) -> tuple[str, ...]:
    if colset.kind is Kind.RECORD:
        return colset.labels
    return tuple(str(i) for i in range(1, len(colset.components) + 1))
