"""Which values may have reals in them: equal ones may then differ in the sign of a zero, and a NaN equals nothing.

may_hold_reals(net.places[0].colset.type, net.program.datatypes)      # True: `union Speed: REAL + Off`
"""

from __future__ import annotations

from collections.abc import Mapping

from pn2code.ml.core.terms import DatatypeDec
from pn2code.ml.core.types import REAL, TCon, TRecord, TVar, Type


def may_hold_reals(
    t: Type, datatypes: Mapping[str, DatatypeDec], inside: frozenset[str] = frozenset()
) -> bool:
    """Whether values of a type may; of functions and of types that are not known it is assumed.

    Args:
        t: the type.
        datatypes: of the program (`Program.datatypes`).
        inside: data types whose constructors are being looked at.
    """
    match t:
        case TRecord(fields):
            return any(may_hold_reals(x, datatypes, inside) for _, x in fields)
        case TCon(name, arguments):
            if t == REAL or any(may_hold_reals(x, datatypes, inside) for x in arguments):
                return True
            if name in inside or name not in datatypes:
                return False
            within = inside | {name}
            return any(
                may_hold_reals(x, datatypes, within)
                for _, x in datatypes[name].constructors
                if x is not None
            )
        case TVar():
            return not inside  # what it stands for in a data type has been looked at
        case _:
            return True
