"""Transitions that never occur, in a sentence: no failure, but hardly ever what somebody has meant.

never(net, found, control)      # Never("the cell", ("Sup'Extra 1",))
.sentence                       # "`Sup'Extra 1` never occurs in the cell (dead transition)."
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.base.frozen import frozen
from pn2code.net.engine_names import EngineNames
from pn2code.net.flat import FlatNet, Role
from pn2code.verify.controller.control_types import Control
from pn2code.verify.exploring.result import Exploration

MOST_NAMED = 5
"""Transitions that are named in the sentence."""


@frozen
class Never:
    """Transitions that never occur.

    Args:
        where: "the net", "the cell" or "the closed net".
        transitions: by name.
    """

    where: str
    transitions: tuple[str, ...]

    @property
    def sentence(self) -> str:
        """For people; "": there are none."""
        count = len(self.transitions)
        if not count:
            return ""
        names = ", ".join(f"`{x}`" for x in self.transitions[:MOST_NAMED])
        names += f" and {count - MOST_NAMED} more" if count > MOST_NAMED else ""
        return (
            f"{names} never occur{'s' * (count == 1)} in {self.where} "
            f"(dead transition{'s' * (count != 1)})."
        )


def never(net: FlatNet, found: Exploration, control: Control | None) -> Never | None:
    """Those of the cell as it runs, if all of it was seen, else of the net; None: nobody knows.

    Not those that were added for a register: nobody has drawn them.
    """
    own = control.dead if control is not None else None
    if own is not None:
        return _named(net, "the cell", own)
    where = "the net" if control is None else "the closed net"
    if found.known is not None:
        return _named(net, where, found.known.never)
    if not found.seen.markings or not found.knows_dead_transitions:
        return None
    return _named(net, where, found.dead_transitions())


def _named(net: FlatNet, where: str, transitions: Iterable[int]) -> Never:
    names = EngineNames(net)
    drawn = [t for t in transitions if net.transitions[t].role is Role.OWN]
    return Never(where, tuple(map(names.transition, drawn)))
