"""Two runs: the first step in which they differ."""

from __future__ import annotations

from typing import Any

import numpy as np

from pn2code.replay.arrays import unpacked
from pn2code.replay.description import Json


def first_difference(a: Json, b: Json) -> Json | None:
    """The first step in which two runs differ: its number, what each of them did, when. None: they are the same.

    Steps are compared by transition and binding. A run that goes on where the other has ended differs there, too; times
    are not compared: the same steps at other times are the same run.
    """
    one, two = _Steps(a), _Steps(b)
    shared = min(one.count, two.count)
    names = {name: i for i, name in enumerate(dict.fromkeys((*one.names, *two.names)))}
    first = np.array([names[n] for n in one.names], np.int64)[one.transition[:shared]]
    second = np.array([names[n] for n in two.names], np.int64)[two.transition[:shared]]
    apart = np.flatnonzero(first != second)
    at = int(apart[0]) if apart.size else shared
    for step in range(at):
        if one.binding(step) != two.binding(step):
            at = step
            break
    if at == shared and one.count == two.count:
        if one.start() == two.start():
            return None
        at = 0
        return {
            "step": 0,
            "what": ["another initial marking", "another initial marking"],
            "t": [0.0, 0.0],
        }
    return {
        "step": at + 1,
        "what": [one.text(at), two.text(at)],
        "t": [one.time(at), two.time(at)],
    }


class _Steps:
    """The steps of a description, to be looked up."""

    def __init__(self, described: Json) -> None:
        course = described["course"]
        self._course = course
        self._transitions: list[Json] = described["net"]["transitions"]
        self.names = [t["name"] for t in self._transitions]
        self.transition = unpacked(course["transition"]).astype(np.int64)
        self.count = len(self.transition)
        self._binding = unpacked(course["binding"])
        self._t = unpacked(course["time"])
        sizes = np.array([len(t["variables"]) for t in self._transitions], np.int64)
        self._offset = np.concatenate([[0], np.cumsum(sizes[self.transition])]).astype(np.int64)
        self._texts: list[str] = course["texts"]

    def binding(self, step: int) -> list[str]:
        """The values of the variables, as texts."""
        rows = self._binding[self._offset[step] : self._offset[step + 1]]
        return [self._texts[i] for i in rows.tolist()]

    def text(self, step: int) -> str:
        """What occurred in a step (from 0); what is said where the run has ended."""
        if step >= self.count:
            return "the run has ended"
        t = self._transitions[int(self.transition[step])]
        bound = zip(t["variables"], self.binding(step), strict=True)
        return f"{t['name']} ({', '.join(f'{n} = {v}' for n, v in bound)})"

    def time(self, step: int) -> float:
        """When; the end of the axis where the run has ended."""
        return (
            float(self._t[step]) if step < self.count else float(self._t[-1] if self.count else 0.0)
        )

    def start(self) -> Any:
        """The initial marking, by place."""
        course = self._course
        keys, tokens = course["keys"], course["tokens"]
        last = int(unpacked(keys["offset"])[1])
        place, text = unpacked(tokens["place"]), unpacked(tokens["text"])
        rows = zip(
            unpacked(keys["token"])[:last].tolist(),
            unpacked(keys["count"])[:last].tolist(),
            strict=True,
        )
        return sorted((int(place[i]), self._texts[int(text[i])], n) for i, n in rows)
