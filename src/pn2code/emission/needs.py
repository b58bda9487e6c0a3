"""What a supervisor needs of the runtime, from the C of its net: all else is left out when it is linked.

needs = of(net_c, is_cell=True)
needs.next_time                       # "pn_next_time"; "NULL": the net has no time
needs.flags                           # ("-DPN_FLAT_TYPES",): no list, no union, no reference
"""

from __future__ import annotations

import re
from dataclasses import dataclass

SIDE = "supervisor"
"""The supervisor's name among the owners of a net, and in the shared directory."""
_NESTED = re.compile(r"\bPN_KIND_(?:LIST|UNION|REF)\b")
_NONE = "NULL"


@dataclass(frozen=True, slots=True)
class Needs:
    """Functions of the runtime that cell_config.c names, as C expressions.

    Args:
        run: what the program does from start to end.
        allow_files: for nets that read or write files.
        collect: for nets whose tokens or variables refer into the arena.
        next_time: for timed nets.
        object: the object file of the net that is deployed: of a cell it has no transitions of robots.
        flags: of the compiler, for the runtime of this net.
    """

    run: str
    allow_files: str
    collect: str
    next_time: str
    object: str
    flags: tuple[str, ...]

    @property
    def includes(self) -> tuple[str, ...]:
        """The lines that declare them."""
        found = []
        if self.allow_files != _NONE:
            found.append('#include "pn/pn_file.h"')
        if self.collect != _NONE or self.next_time != _NONE:
            found.append('#include "pn/pn_marking.h"')
        return tuple(found)


def of(net_c: str, *, is_cell: bool) -> Needs:
    """The needs of a net.

    Args:
        net_c: the generated net.
        is_cell: the supervisor has channels; without any it plays its net alone.
    """

    def if_in(name: str, *words: str) -> str:
        return name if any(word in net_c for word in words) else _NONE

    return Needs(
        run="sup_run_cell" if is_cell else "sup_run_alone",
        allow_files=if_in("pn_file_allow", "pn_file_"),
        collect=if_in("pn_marking_collect", ".refer_count =", ".held_count ="),
        object="net_own.o" if is_cell else "net.o",
        next_time=if_in("pn_next_time", ".timed = true"),
        flags=(
            *(() if _NESTED.search(net_c) else ("-DPN_FLAT_TYPES",)),
            *(() if ".is_packed = true" in net_c else ("-DPN_ARRAYS_ONLY",)),
        ),
    )
