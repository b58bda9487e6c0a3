"""What CPN Tools' syntax check says of the variables of a transition, without a word of who is right.

    answer = examine(arcs, guards, reader, is_small)
    answer.kind   # "" accepted; "stuck", "large" refused; "undecided"; "tables", "repeats" an internal error
    answer.parted # arcs from one place whose variables it takes for others, whatever the kind is

It looks at the arcs that only take tokens first, the last one of the file first, then at those in both directions in
the same way, then at the guard. (Found by experiment.) Of what it does with each see `engine_parts`, `engine_tables`
and `engine_search`. Of 1,700 generated transitions with one to four arcs and a guard, all verdicts were the engine's,
but for one in which it takes variables for others.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal

from pn2code.base.frozen import frozen
from pn2code.ml.core.terms import Exp, Symbol
from pn2code.net.engine_order import faults
from pn2code.net.engine_parts import PartReader
from pn2code.net.engine_search import LargeError, StuckError, UndecidedError, search
from pn2code.net.engine_tables import BrokenError, Tables
from pn2code.net.flat import ArcInscription, ArcKind

Kind = Literal["", "stuck", "large", "undecided", "tables", "repeats"]


@frozen
class PlaceNode:
    """A place as it is drawn: its id, whether its tokens have time stamps, their fields as its colour set has them."""

    id: str
    timed: bool
    fields: tuple[str, ...] = ()


@frozen
class TakingArc:
    """An arc that takes tokens: its kind, its place, what is on it."""

    kind: ArcKind
    node: PlaceNode
    inscription: ArcInscription


@frozen
class Answer:
    """What CPN Tools says.

    Args:
        kind: accepted; no order is found, or a variable of a large colour set is left; it is not known; the tables
            break, or a variable that is twice in a coefficient or a condition is not known.
        names: of the last but two: variables that get no value.
        parted: an arc at which the tables break or from which on they are wrong, and an earlier one from its place.
        odd: arcs that it may write as patterns, and that are none.
        is_odd: whether it does so with one, whatever it chooses.
        repeated: variables that are twice in a pattern, and that it may not compare.
    """

    kind: Kind
    names: frozenset[Symbol] = frozenset()
    parted: tuple[int, int] | None = None
    odd: frozenset[int] = frozenset()
    is_odd: bool = False
    repeated: frozenset[Symbol] = frozenset()


def examine(
    arcs: Sequence[TakingArc],
    guards: Sequence[Exp],
    reader: PartReader,
    is_small: Callable[[Symbol], bool],
) -> Answer:
    """What CPN Tools says of a transition.

    Args:
        arcs: those that take tokens, in the order of the file.
        guards: the conditions.
        reader: of the net.
        is_small: whether all values of a variable's colour set are tried.
    """
    order = sorted(range(len(arcs)), key=lambda i: (arcs[i].kind is ArcKind.BOTH, -i))
    tables = Tables()
    first: dict[str, int] = {}
    parted: tuple[int, int] | None = None
    for i in order:
        arc = arcs[i]
        earlier = first.setdefault(arc.node.id, i)
        try:
            tables.arc(arc.node.id, reader.summands(arc.inscription.value, arc.inscription.form), i)
        except BrokenError:
            return Answer("tables", parted=(i, earlier))
        if tables.is_parted and parted is None:
            parted = (i, earlier)
    for guard in guards:
        tables.condition(reader.item(guard))
    try:
        for group in sorted(tables.groups, reverse=True):
            search(tables, group, is_small)
    except StuckError as error:
        names = frozenset(n for n in error.names if isinstance(n, Symbol))
        return Answer("stuck", names, parted)
    except LargeError as error:
        return Answer("large", frozenset({error.name}), parted)
    except UndecidedError:
        return Answer("undecided", parted=parted)
    except BrokenError as error:
        return Answer("repeats" if str(error) == "get_vids" else "tables", parted=parted)
    wrong = [faults(tables, group, is_small) for group in tables.groups]
    odd = frozenset(i for x in wrong for i in x.arcs)
    repeated = frozenset(s for x in wrong for s in x.repeated)
    is_odd = any(x.is_certain for x in wrong)
    return Answer("", parted=parted, odd=odd, is_odd=is_odd, repeated=repeated)
