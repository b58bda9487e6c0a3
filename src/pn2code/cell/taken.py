"""The kinds of parts that each robot takes, as the code segments of its pages call the primitives of tools.

kinds_taken(partition, config)        # {"scara": {"box": span of the call in the net}}
"""

from __future__ import annotations

from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.cell.reach import Reach
from pn2code.diagnostics import Span


def kinds_taken(partition: Partition, config: CellConfig) -> dict[str, dict[str, Span]]:
    """By robot or device, in the order of the net: each kind with the first use that leads to it."""
    net = partition.net
    taking = {
        net.program.globals[name].uid: primitive.handling.part
        for name, primitive in config.primitives.items()
        if primitive.handling is not None
        and primitive.handling.effect == "takes"
        and name in net.program.globals
    }
    out: dict[str, dict[str, Span]] = {}
    if not taking:
        return out
    reach = Reach(net.program)
    for t, index in zip(net.transitions, partition.transition_owner, strict=True):
        if not index or t.code is None:
            continue
        reach.add_locals(t.code.action)
        for uid, (_, span) in reach.everything(t.code.action).items():
            if uid in taking:
                out.setdefault(partition.owners[index].name, {}).setdefault(taking[uid], span)
    return out
