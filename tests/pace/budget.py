"""What a whole run costs: processor time, measured by a fixed piece of work; a slow or busy machine is no excuse.

meter = Meter()
meter.look()                # now and then, while tests run
meter.cost()                # how many pieces of work the processor could have done instead, children included
"""

from __future__ import annotations

import gc
import os
import statistics
import time

EXCESS = 1.5
"""A whole run that costs that many times what the table says fails."""
_SIZE = 20_000


def processor() -> float:
    """Seconds that this process and the children it has waited for were worked on."""
    used = os.times()
    return used.user + used.system + used.children_user + used.children_system


def piece() -> float:
    """Seconds of the processor for the piece: objects, texts and numbers, as tests have them."""
    # The garbage collector would go through all that the process holds, which has nothing to do with the machine.
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        began = time.process_time()
        rows: dict[int, list[tuple[int, str]]] = {}
        for n in range(_SIZE):
            rows.setdefault(n * 7 % 101, []).append((n, str(n)))
        assert sum(len(text) for row in rows.values() for n, text in sorted(row) if n % 2) > _SIZE
        return time.process_time() - began
    finally:
        if was_enabled:
            gc.enable()


class Meter:
    """Of one process, from now on. It looks at the pace of the machine when it begins, and when it is told to."""

    def __init__(self) -> None:
        self._pieces = [piece()]
        self._began = processor()

    def look(self) -> None:
        """The machine may have become busy: one more piece."""
        self._pieces.append(piece())

    def cost(self) -> float:
        """In pieces."""
        return (processor() - self._began) / statistics.median(self._pieces)


def is_exceeded(cost: float, recorded: float) -> bool:
    """Whether a whole run is too expensive; without a record nothing is."""
    return bool(recorded) and cost > EXCESS * recorded
