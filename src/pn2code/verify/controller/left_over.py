"""Where nothing can happen any more: whether the supervisor has finished, and nothing is left that it could still take.

asked = Questions()
asked.asked.append(f"? invariant {nothing_left(asked, running)}")

The cell as it runs ends with its supervisor, but the cell with its medium does not (`channel_model.compose`): there a
supervisor that has finished would take a message that comes later. Where programs of robots go on after the end
(`Running.of(loose=True)`) a message to the supervisor stays, so that it is there where nothing can happen any more.
"""

from __future__ import annotations

from pn2code.cell.partition import SUPERVISOR
from pn2code.properties.questions import ENDLESS, Questions
from pn2code.verify.controller.running import Running, chunks


def nothing_left(asked: Questions, running: Running) -> int:
    """The item: something can happen, or the supervisor has finished, and no message to it is there."""
    found = asked.line(f"within {running.over} 1 -")
    for c in running.partition.channels:
        if c.reader == SUPERVISOR:
            empty = asked.line(f"not {asked.line(f'within {c.place} 1 -')}")
            found = asked.line(f"and {found} {empty}")
    going = asked.line(f"not {asked.line('dead')}")
    return asked.line(f"or {going} {found}")


def questions(running: Running) -> str:
    """How programs choose, and what has to be answered with "yes" for files to do no harm (`channel_model.by_cell`)."""
    lines = [x for x in running.lines(first=True) if not x.startswith("instant ")]
    lines += chunks("instant 0", range(len(running.net.transitions)))
    q = Questions()
    ends = [running.stopped, *([] if running.unsure is None else [running.unsure])]
    q.asked += [
        f"? restless 0 {ENDLESS}",
        *(f"? bound {place} 0 0" for place in ends),
        *(f"? bound {c.place} 0 1" for c in running.partition.channels),
        f"? invariant {nothing_left(q, running)}",
    ]
    return "".join(f"{line}\n" for line in lines) + q.text()
