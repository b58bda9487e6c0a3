"""Infix operators of a net whose names the engine of CPN Tools uses in code of its own.

After `infix lt` at top level the engine cannot declare an enumeration, since it declares a function `lt` for it; after
`infix cmp` it accepts the net, but cannot compile its transitions. Inside structures and `local` nothing is wrong.
(Found by experiment with each name.)
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.net.codes import ENGINE_INFIX

_OF_VALUES = (
    "base", "all", "size", "ord", "col", "ran", "lt", "cmp", "legal", "illegal_msg", "mkstr", "mkstr_ms", "input",
    "output",
)  # fmt: skip
_OF_KINDS: dict[str, frozenset[str]] = {
    "enum": frozenset(_OF_VALUES),
    "index": frozenset({"lt", "size"}),
    "product": frozenset({*_OF_VALUES, "mult", "ref"}),
    "record": frozenset({*_OF_VALUES, "mult", "ref"}),
    "union": frozenset({*_OF_VALUES, "ref"}),
}
"""Kind of a colour set -> names that the code has which the engine makes for it; other kinds have none."""
_OF_TRANSITIONS = frozenset({"cmp", "time", "not", "ref"})


def refuse(kind: str, name: str, infix: Iterable[str], origin: Origin, d: Diagnostics) -> None:
    """Reports a colour set that is declared after an operator with the name of one of its functions.

    Args:
        kind: of the colour set, as in the file.
        name: of the colour set.
        infix: the operators that the net has declared before it.
        origin: of its declaration.
        d: gets the error.
    """
    found = _OF_KINDS.get(kind, frozenset()).intersection(infix)
    if found:
        operator = min(found)
        d.error(
            ENGINE_INFIX,
            f"colour set `{name}` needs a function `{operator}`, which is an infix operator here",
            origin,
            hint=f"put the colour set before `infix {operator}`, or give the operator another name",
        )


def warn(infix: Iterable[str], origin: Origin, d: Diagnostics) -> None:
    """Warns of operators because of which the engine cannot compile transitions, where they are declared."""
    for operator in sorted(_OF_TRANSITIONS.intersection(infix)):
        d.warning(
            ENGINE_INFIX,
            f"CPN Tools cannot compile the transitions of a net in which `{operator}` is infix",
            origin,
            hint="give the operator another name if the net is to be used there, too",
        )
