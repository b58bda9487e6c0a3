"""Places that several owners read: what the net says with them, and what a cell can have instead.

A token that one of several takes is for one of them only. A token that one owner replaces, and that others put back as
they found it, is a value that many read: no channel, but a register if the supervisor sets it (`registers`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from pn2code.cell.partition import SUPERVISOR, Owner
from pn2code.net.flat import ArcKind, FlatArc, FlatNet, FlatTransition

AS_REGISTER = (
    'write `kind = "register"` into its table (docs/cookbook.md, `A value that several read`)'
)
EACH = "give each reader a channel of its own, and let the transitions that write put a token into each of them"


def told(
    net: FlatNet, place: int, owners: Sequence[Owner], writers: set[int], readers: set[int]
) -> tuple[str, str] | None:
    """What is said of such a place, and a hint; None: it is none.

    Args:
        net: the net.
        place: the place.
        owners: supervisor first.
        writers, readers: the owners that put tokens there, and those that take or look.
    """
    if len(writers) == 1 and len(readers) > 1 and not writers & readers:
        says = f"is written by {_names(owners, writers)} and read by {_names(owners, readers)}"
        return says, (
            f"in the net a token there is for one of its readers, whoever takes it first; if all are to have it, {EACH}"
        )
    setting, looking = _divided(net, place, owners, writers | readers)
    if len(setting) != 1 or not looking:
        return None
    says = (
        f"is set by {_names(owners, setting)} and looked at by {_names(owners, looking)}: a value that stays there "
        "cannot be a message, which is taken"
    )
    if setting == {SUPERVISOR}:
        return says, AS_REGISTER
    return says, (
        f"{EACH}; a reader takes it into a place of its own, and looks there. What the supervisor sets can be a "
        "register (docs/cookbook.md, `A value that several read`)"
    )


def is_register(
    net: FlatNet, place: int, owners: Sequence[Owner], writers: set[int], readers: set[int]
) -> bool:
    """Whether the supervisor sets what others only look at: arguments as for `told`."""
    setting, looking = _divided(net, place, owners, writers | readers)
    return setting == {SUPERVISOR} and bool(looking)


def _divided(
    net: FlatNet, place: int, owners: Sequence[Owner], users: set[int]
) -> tuple[set[int], set[int]]:
    """Those of its users that set the value of a place, and those that only look at it."""
    setting = {i for i in users if not only_looks(net, place, owners[i])}
    return setting, users - setting


def _names(owners: Sequence[Owner], which: Iterable[int]) -> str:
    return ", ".join(f"`{owners[i].name}`" for i in sorted(which))


def only_looks(net: FlatNet, place: int, owner: Owner) -> bool:
    """Whether all that an owner does with a place is to look at its token, or to put back what it has taken."""
    own = (t for t in net.transitions if f"{t.instance}/".startswith(f"{owner.instance}/"))
    return all(_leaves(t, place) for t in own)


def _leaves(t: FlatTransition, place: int) -> bool:
    arcs = [a for a in t.arcs if a.place == place and a.kind is not ArcKind.BOTH]
    taken = [_value(a) for a in arcs if a.kind is ArcKind.INPUT]
    put = [_value(a) for a in arcs if a.kind is ArcKind.OUTPUT]
    return len(taken) + len(put) == len(arcs) and taken == put


def _value(a: FlatArc) -> object:
    return None if a.inscription is None else a.inscription.value
