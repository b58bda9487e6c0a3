"""An item: the states in which nobody waits for others while it owes an answer (I8 of docs/protocol.md)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce

from pn2code.properties.questions import Questions
from pn2code.verify.controller.silence import Ready, Silence


def kept_silence(asked: Questions, silence: Silence, idle: int | None) -> int:
    """The item of the states in which it does *not* wait for others while it owes an answer.

    `idle`: the place of a supervisor that rests; None: it counts whether or not that does.
    """

    def marked(place: int) -> int:
        return asked.line(f"within {place} 1 -")

    def no(item: int) -> int:
        return asked.line(f"not {item}")

    def joined(operator: str, items: Sequence[int]) -> int:
        return reduce(lambda a, b: asked.line(f"{operator} {a} {b}"), items)

    def possible(transition: int) -> int:
        return asked.line(f"enabled {transition}")

    def goes_on(ready: Ready) -> list[int]:
        own = [] if ready.transition is None else [possible(ready.transition)]
        return [*(marked(place) for places in ready.messages for place in places), *own]

    def waits_at(place: int, ways: Sequence[Ready]) -> int:
        ends = [joined("and", goes_on(ready)) for ready in ways]
        if any(ready.transition is not None for ready in ways):
            ends += map(possible, silence.steps)
        return joined("and", [marked(place), *map(no, ends)])

    waits = [waits_at(place, ways) for place, ways in silence.states]
    unseen = [joined("and", [marked(p), no(marked(seen))]) for p, seen in silence.answers]
    others = [marked(p) for p in (silence.owes, idle) if p is not None] + [*map(no, unseen)]
    return no(joined("and", [*others, joined("or", waits)]))
