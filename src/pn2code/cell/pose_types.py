"""The types of poses in a net: records of six reals x y z rx ry rz, whose labels may be written in upper case.

A primitive that takes anything (`fun moveJoint p = ()`) is told poses all the same; of which type they are, only the
rest of the net says.
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.cell.reach import bound
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import REAL, TRecord, Type
from pn2code.net.flat import FlatNet
from pn2code.net.uses import walk

LABELS = frozenset({"x", "y", "z", "rx", "ry", "rz"})


def is_pose(t: Type) -> bool:
    """Whether the values of a type are poses."""
    return (
        isinstance(t, TRecord)
        and len(t.fields) == len(LABELS)
        and {label.lower() for label, _ in t.fields} == LABELS
        and all(x == REAL for _, x in t.fields)
    )


def pose_types(net: FlatNet) -> tuple[TRecord, ...]:
    """Those that a net has, in order of appearance."""
    found: dict[TRecord, None] = {}
    for e in _expressions(net):
        for x in walk(e):
            t = getattr(x, "type", None)
            if isinstance(t, TRecord) and is_pose(t):
                found[t] = None
    return tuple(found)


def _expressions(net: FlatNet) -> Iterator[core.Exp]:
    for declaration in net.program.declarations:
        yield from (e for _, e in bound(declaration))
    for t in net.transitions:
        if t.code is not None:
            yield t.code.action
