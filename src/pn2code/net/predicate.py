"""`Predicate`: a condition on one marking, as the compiler takes it.

{ length (Mark.Top'Free 1) > 2 }     exp: length m > 2, places: ((m : COLOUR list, 3),)
"""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol
from pn2code.ml.core.types import Type, list_of, timed_of
from pn2code.net.flat import FlatPlace


@frozen
class Predicate:
    """A typed CPN ML expression over the marking of some places.

    Args:
        name: unique among the predicates of a net; for messages and comments.
        text: as the author wrote it.
        exp: of type bool. Beside the top-level names of the net's declarations its free symbols are those of `places`.
        places: a symbol for the multi-set of a place (index in `FlatNet.places`): of type `marking_type`, tokens in the
            order of the colour set, equal ones next to each other; in a timed place those of a colour by their stamps.
    """

    name: str
    text: str
    exp: core.Exp
    places: tuple[tuple[Symbol, int], ...]


def marking_type(place: FlatPlace) -> Type:
    """What `Mark.Page'Place n` is: `c ms`, of a timed place `c tms`."""
    t = place.colset.type
    return list_of(timed_of(t) if place.colset.timed else t)
