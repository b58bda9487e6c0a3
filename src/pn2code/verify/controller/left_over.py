"""Where nothing can happen any more: whether the supervisor has finished, and nothing is left that it could still take.

asked = Questions()
asked.asked.append(f"? invariant {nothing_left(asked, running)}")

The cell as it runs ends with its supervisor, but the cell with its medium does not (`channel_model.compose`): there a
supervisor that has finished would take a message that comes later. Where programs of robots go on after the end
(`Running.of(loose=True)`) a message to the supervisor stays, so that it is there where nothing can happen any more.
"""

from __future__ import annotations

from pn2code.properties.questions import Questions
from pn2code.verify.controller.running import SUPERVISOR, Running


def nothing_left(asked: Questions, running: Running) -> int:
    """The item: something can happen, or the supervisor has finished, and no message to it is there."""
    found = asked.line(f"within {running.over} 1 -")
    for c in running.partition.channels:
        if c.reader == SUPERVISOR:
            empty = asked.line(f"not {asked.line(f'within {c.place} 1 -')}")
            found = asked.line(f"and {found} {empty}")
    going = asked.line(f"not {asked.line('dead')}")
    return asked.line(f"or {going} {found}")
