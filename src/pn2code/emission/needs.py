"""What a supervisor needs of the runtime, from its net: all else is left out when it is linked.

needs = of(net, is_cell=True)
needs.next_time                       # "pn_next_time"; "NULL": the net has no time
needs.flags                           # ("-DPN_FLAT_TYPES",): no list, no union, no reference
nesting(net)                          # 3: a value has at most three levels
"""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.ir.nodes import NetIR, Rep

SIDE = "supervisor"
"""The supervisor's name among the owners of a net, and in the shared directory."""
_NESTED = frozenset({Rep.LIST, Rep.UNION, Rep.REF})
_NONE = "NULL"

UNLIMITED = 0
"""The nesting of a net with a recursive datatype."""


@frozen
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


def of(net: NetIR, *, is_cell: bool) -> Needs:
    """The needs of a net.

    Args:
        net: what is deployed.
        is_cell: the supervisor has channels; without any it plays its net alone.
    """

    def named(name: str, is_needed: bool) -> str:
        return name if is_needed else _NONE

    refers = any(p.refers for p in net.places) or any(g.is_held for g in net.globals)
    tables = {*net.used.tables, *net.used.further_tables}
    is_nested = any(d.type.rep in _NESTED for d in net.descriptors if d.name in tables)
    is_packed = any(p.packed for p in net.places)
    return Needs(
        run="sup_run_cell" if is_cell else "sup_run_alone",
        allow_files=named("pn_file_allow", net.used.files),
        collect=named("pn_marking_collect", refers),
        object="net_own.o" if is_cell else "net.o",
        next_time=named("pn_next_time", net.timed),
        flags=(
            *(() if is_nested else ("-DPN_FLAT_TYPES",)),
            *(() if is_packed else ("-DPN_ARRAYS_ONLY",)),
        ),
    )


def nesting(net: NetIR) -> int:
    """How deeply the values of a net are nested at most, as the runtime's functions walk them: 1 of an integer, 3 of a
    list of records of integers; `UNLIMITED` where a datatype contains itself."""
    of_name = {d.name: d for d in net.descriptors}
    known: dict[str, int] = {}
    waiting = [(name, False) for name in (*net.used.tables, *net.used.further_tables)]
    above: set[str] = set()
    while waiting:
        name, is_left = waiting.pop()
        found = of_name[name]
        parts = [part for _, part in found.fields if part] + [found.element] * bool(found.element)
        if is_left:
            above.remove(name)
            known[name] = 1 + max((known[part] for part in parts), default=0)
        elif name in above:
            return UNLIMITED
        elif name not in known:
            above.add(name)
            waiting.append((name, True))
            waiting += [(part, False) for part in parts]
    return max(known.values(), default=1)
