"""Compiled simulators: a net and the host `simulate`.

with program(net, {}, d) as path:      # None after a diagnostic
    subprocess.run([path, "--steps", "100"])
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import pn2code
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.emission import c as emit_c
from pn2code.emission.output import OutputFile
from pn2code.lowering.nets import net as lower_net
from pn2code.lowering.nets.packing import MOST_WIDTH, Packing
from pn2code.net.flat import FlatNet
from pn2code.toolchain import programs
from pn2code.toolchain.programs import Host

HOST = Host("simulate", without="; or use `--engine reference`", whole="simulate/simulate_play.c")
ROOM = 1 << 14
"""Different tokens that a place can hold at first. What is not used costs address space only."""
PACKING = Packing({}, MOST_WIDTH, most_colours=2, successors=False)
"""Counters instead of arrays where there are so few colours that this is faster; they never overflow."""


@contextmanager
def program(
    net: FlatNet,
    storage: Mapping[str, str],
    d: Diagnostics,
    *,
    room: int = ROOM,
    known: dict[int, tuple[OutputFile, ...]] | None = None,
) -> Iterator[Path | None]:
    """The simulator of a net, as long as the block lasts; None after a diagnostic.

    Args:
        net: the net.
        storage: as for `Game`.
        d: gets the errors.
        room: different tokens that each place can hold.
        known: room -> what has been generated of this net with it before; gets what is generated now.
    """
    known = {} if known is None else known
    if room not in known:
        files = generated(net, storage, d, room)
        if files is None:
            yield None
            return
        known[room] = files
    with programs.program(HOST, known[room], d) as found:
        yield found


def generated(
    net: FlatNet, storage: Mapping[str, str], d: Diagnostics, room: int = ROOM
) -> tuple[OutputFile, ...] | None:
    """net.c and net.h; None when the net cannot be compiled, which was reported."""
    partition = divide(net, None, d)
    if partition is None:
        return None
    capacity = {p.name: room for p in net.places}
    ir = lower_net.lower(partition, storage, d, capacity=capacity, packing=PACKING)
    return None if ir is None or d.has_errors else emit_c.emit(ir, pn2code.__version__)
