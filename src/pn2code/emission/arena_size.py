"""How much memory a deployed program gets for lists, strings and the moves of a firing: the size of its arena.

    arena_size.of(net, seen=None)
    # ArenaSize(0, "proven: the program puts nothing there", is_proven=True)

An allocation that is refused is a fault at run time, so a size is small only where a proof says that it is enough
(`lowering.passes.arena`). All other nets get what the state space shows, if it is known, but not less than `DEFAULT`:
the explored program has its places packed otherwise than the deployed one, and robots and other files may bring longer
values than those that were explored.
"""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.ir import nodes as ir

DEFAULT = 1 << 22
"""Bytes where nothing is proven: `PN_ARENA_DEFAULT_SIZE`."""


@frozen
class ArenaSize:
    """The size of an arena.

    Args:
        bytes: 0: the program has none.
        why: what says that it is enough, a line for people.
        is_proven: it is enough, whatever files and robots bring.
    """

    bytes: int
    why: str
    is_proven: bool = False


UNKNOWN = ArenaSize(DEFAULT, "the usual size; nothing proves it to be enough")


def of(net: ir.NetIR, seen: int | None) -> ArenaSize:
    """The size for a program.

    Args:
        net: what is deployed, with the room of its places.
        seen: bytes that are enough according to the state space; None: it does not say.
    """
    found = net.arena.bytes
    if found is None and seen is None:
        return ArenaSize(DEFAULT, f"not proven to be enough ({net.arena.why}): the usual size")
    if found is None:
        assert seen is not None
        text = f"more than twice what the state space shows, and no less than {DEFAULT:,}; not proven ({net.arena.why})"
        return ArenaSize(max(seen, DEFAULT), text)
    if found == 0:
        return ArenaSize(0, "proven: the program puts nothing there", is_proven=True)
    return ArenaSize(
        found,
        "proven to be enough for the initial marking, the moves of one firing, and a token that arrives",
        is_proven=True,
    )
