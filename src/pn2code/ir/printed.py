"""Which parts of an expression are printed in C: not those that nobody has to compute."""

from __future__ import annotations

from pn2code.ir import expressions as ir
from pn2code.ir.calls import parts_of
from pn2code.ir.operations import CONTAINED, OPS, Call, Literal
from pn2code.ir.types import Rep


def is_nil(value: object) -> bool:
    """Whether a list is known to be empty where the code is made; what would be behind it is, too."""
    match value:
        case ir.Op(name="list.nil" | "zero"):
            return True
        case ir.Head(list=inner) | ir.Tail(list=inner):
            return is_nil(inner)
    return False


PARTLY_PRINTED = frozenset({ir.Head, ir.Tail, ir.IsNil, ir.Op})
"""Those for which `printed_parts` may leave something out; all others are printed with all their parts."""


def printed_parts(e: object) -> tuple[object, ...]:
    """The parts of an expression, or of whatever else of the IR, that come into the C that is printed for it."""
    match e:
        case ir.Head(list=inner) | ir.Tail(list=inner) | ir.IsNil(list=inner) if is_nil(inner):
            return ()
        case ir.Op(name="zero" | "list.nil" | "Colset.all"):
            return ()
        case ir.Op(name="=" | "same", arguments=(left, _)) if left.type.rep is Rep.UNIT:
            return ()  # they are equal
        case ir.Op(name="List.null", arguments=(inner,)) if is_nil(inner):
            return ()
        case ir.Op(name=name, arguments=arguments):
            form = OPS.get(CONTAINED.get(name, name))
            if isinstance(form, Literal):
                return ()
            return arguments[:1] if isinstance(form, Call) and not form.function else arguments
    return tuple(parts_of(e))
