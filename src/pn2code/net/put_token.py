"""What an output arc puts, if that is one token whatever the binding is.

token_put(arc)      # of the inscriptions v, 1`v, (1`v), [v], and of none at a place of UNIT: the expression v
"""

from __future__ import annotations

from pn2code.ml.core.terms import Exp, ListExp, Lit, Sequence
from pn2code.net.flat import FlatArc, Form
from pn2code.net.terms import binary


def token_put(arc: FlatArc) -> Exp | None:
    """The colour of the token; None: it may put none, several, or one with a time stamp of its own."""
    if arc.inscription is None:
        return None
    value = arc.inscription.value
    if arc.inscription.form is Form.TOKEN:
        return value
    if arc.inscription.form is not Form.MULTISET:
        return None
    while isinstance(value, Sequence) and len(value.items) == 1:
        (value,) = value.items
    if isinstance(value, ListExp) and len(value.items) == 1:
        return value.items[0]
    counted = binary(value, ("Ms.`",))
    if counted is None:
        return None
    number, token = counted
    return token if isinstance(number, Lit) and number.value == 1 else None
