"""How far, and how, a state space is explored."""

from __future__ import annotations

import os
from contextlib import suppress
from enum import StrEnum
from pathlib import Path

from pn2code.base.deadline import NEVER, Deadline
from pn2code.base.frozen import frozen
from pn2code.verify.swarm.pool import Swarm

REACHED = ("states", "seconds", "memory")
"""Why an exploration has ended, where it was for a limit."""
TURNS_FROM = 1_000_000
"""States of a cell that are looked at before its programs are looked at in turns; fewer are all seen in seconds."""
COUNTS_FROM = 200_000
"""The same before it is tried to count tokens up to a limit only (`counts`)."""
ALONE = 1
"""Markings that are explored where the unfolded net is asked instead: no more than the initial one."""
_LEAST = 64
_UNKNOWN = 2048
"""MiB, when the system does not say what is free."""


class Order(StrEnum):
    """The order in which markings are expanded."""

    BREADTH = "bfs"
    DEPTH = "dfs"


class Approximation(StrEnum):
    """Ways of storing less than the markings; some may then be taken for others, and be missed."""

    BITSTATE = "bitstate"
    HASH = "hash"


class Reduction(StrEnum):
    """Ways of seeing less than the whole space that keep what is asked."""

    TIME = "time"
    PARTIAL_ORDER = "partial-order"
    SYMMETRY = "symmetry"


@frozen
class Limits:
    """What an exploration may use.

    Args:
        max_states: markings, None: no limit.
        processor_seconds: of processor time of one exploration, all threads together, None: no limit. What it has found
            by then is lost.
        deadline: when all has to be over: compiling, too, and whatever else is explored for the same command.
        memory: MiB of the explorer's tables, None: three quarters of what is free at the start.
        threads: at least 1.
        order: breadth first gives shortest traces.
        approximation: None: every marking is stored completely.
        swarm: many small searches instead of one that sees all; None: one. Then `max_states` and `memory` are those of
            each of them.
        spill: a folder for tables that are larger than memory, None: none.
        graph: whether the graph is analysed (components, home markings, liveness, fairness).
        traces: most dead markings that get a trace.
        reductions: those that are wanted; one that the net does not permit is left out, with a diagnostic.
        turns_from: states of a cell from which on its programs are looked at in turns, if that keeps what is asked;
            None: never.
        most_in_turns: states that are looked at then; None: as many as `max_states` says.
        sweeps: whether markings that cannot come back are forgotten (`progress`): always, never, or (None) in a second
            exploration, where the limit of memory has ended the first one.
        unfolds: whether the unfolded net is asked where a limit of states, time or memory ends an exploration.
        unfolds_alone: whether it is asked instead of one: `max_states` is `ALONE` then.
        counts_from: states from which on tokens are counted up to a limit only, if that is enough; None: never, nor
            where it is more than `turns_from`.
    """

    max_states: int | None = None
    processor_seconds: float | None = None
    deadline: Deadline = NEVER
    memory: int | None = None
    threads: int = 1
    order: Order = Order.BREADTH
    approximation: Approximation | None = None
    swarm: Swarm | None = None
    spill: Path | None = None
    graph: bool = True
    traces: int = 1
    reductions: tuple[Reduction, ...] = ()
    turns_from: int | None = TURNS_FROM
    most_in_turns: int | None = None
    counts_from: int | None = COUNTS_FROM
    sweeps: bool | None = False
    unfolds: bool = False
    unfolds_alone: bool = False


def default_memory() -> int:
    """Three quarters of what is free now, in MiB: of the machine, and of the control group that we are in."""
    free = [_machine(), _group()]
    known = [size for size in free if size is not None]
    return max(_LEAST, min(known) * 3 // 4 >> 20) if known else _UNKNOWN


def _machine() -> int | None:
    with suppress(OSError, ValueError, IndexError):
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) << 10
    return None


def _group() -> int | None:
    folder = Path("/sys/fs/cgroup")
    with suppress(OSError, ValueError):
        most = int((folder / "memory.max").read_text(encoding="ascii"))  # "max": no limit
        return max(most - int((folder / "memory.current").read_text(encoding="ascii")), 0)
    return None


def cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
