"""Traces that go round in a circle for ever: their last line says where the cycle begins.

{"t": 0, "event": "end", "why": "finished", "loop": 2}      the first two steps lead to it
"""

from __future__ import annotations

import json
from pathlib import Path

from pn2code.base.whole_file import whole_file

_TAIL = 1 << 16
"""Bytes in which the last line is looked for."""


def write_loop(trace: Path, loop: int) -> None:
    """Adds to the last line of a trace that its cycle begins after so many steps.

    Raises:
        OSError: it cannot be read or written.
    """
    *lines, last = trace.read_bytes().rstrip(b"\n").split(b"\n")
    end = json.loads(last)
    if end.get("event") == "end":
        lines.append(json.dumps({**end, "loop": loop}).encode())
        with whole_file(trace) as beside:
            beside.write_bytes(b"".join(line + b"\n" for line in lines))


def read_loop(trace: Path) -> int | None:
    """How many steps come before the cycle; None: the trace has none.

    Raises:
        OSError: it cannot be read.
    """
    with trace.open("rb") as file:
        size = file.seek(0, 2)
        file.seek(max(0, size - _TAIL))
        lines = file.read().splitlines()
    try:
        end = json.loads(lines[-1]) if lines else None
    except ValueError:
        return None
    loop = end.get("loop") if isinstance(end, dict) and end.get("event") == "end" else None
    return loop if isinstance(loop, int) and not isinstance(loop, bool) and loop >= 0 else None
