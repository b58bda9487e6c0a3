"""Two runs: the first step in which they differ."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from pn2code.replay.arrays import Numbers, unpacked
from pn2code.replay.description import Json

Held = tuple[str, str, int]
"""Of a token: text, stamp, and how many of it there are."""


def first_difference(a: Json, b: Json) -> Json | None:
    """The first step in which two runs differ: its number, what each of them did, when. None: they are the same.

    Step 0 is the initial marking; `alike` says how many of the first steps are the same, whatever that was.

    Steps are compared by transition, binding, and the tokens that they take and put. A run that goes on where the other
    has ended differs there, too, unless steps of the other are left out there; so does one whose next step is not
    possible. Times are not compared: the same steps at other times are the same run.
    """
    one, two = _Steps(a), _Steps(b)
    shared = min(one.count, two.count)
    at = one.alike(two, shared)
    changed = one.changed_alike(two, at)
    start = one.other_start(two)
    if start is not None:
        return {"step": 0, "alike": at, "what": start, "t": [0.0, 0.0]}
    if changed < at:
        what = [f"{one.text(changed)}, by which {said}" for said in one.other_changes(two, changed)]
        return {
            "step": changed + 1,
            "alike": changed,
            "what": what,
            "t": [one.time(changed), two.time(changed)],
        }
    if at == shared and one.has_ended_like(two):
        return None
    return {
        "step": at + 1,
        "alike": at,
        "what": [one.text(at), two.text(at)],
        "t": [one.time(at), two.time(at)],
    }


def is_cut(described: Json) -> bool:
    """Whether steps at the end are left out of a description."""
    return bool(described["verdict"].get("word") == "cut")


class _Steps:
    """The steps of a description, to be looked up."""

    def __init__(self, described: Json) -> None:
        course = described["course"]
        self._course = course
        self._transitions: list[Json] = described["net"]["transitions"]
        self._places: list[str] = [p["name"] for p in described["net"]["places"]]
        self.kinds = [(t["name"], *t["variables"]) for t in self._transitions]
        self.transition = unpacked(course["transition"]).astype(np.int64)
        self.count = len(self.transition)
        self.refused = course.get("refused")
        self.is_cut = is_cut(described)
        self._binding = unpacked(course["binding"])
        self._t = unpacked(course["time"])
        sizes = np.array([len(t["variables"]) for t in self._transitions], np.int64)
        self._offset = np.concatenate([[0], np.cumsum(sizes[self.transition])]).astype(np.int64)
        self._texts: list[str] = course["texts"]

    def alike(self, other: _Steps, most: int) -> int:
        """How many of the first steps are the same in both, `most` at most: transition, variables and their values."""
        kinds: dict[tuple[str, ...], int] = {}
        first, second = (
            np.array([kinds.setdefault(k, len(kinds)) for k in run.kinds], np.int64)[
                run.transition[:most]
            ]
            for run in (self, other)
        )
        apart = np.flatnonzero(first != second)
        at = int(apart[0]) if apart.size else most
        # To there the values of both stand at the same positions.
        bound = int(self._offset[at])
        number = {text: i for i, text in enumerate(self._texts)}
        as_here = np.array([number.get(text, -1) for text in other._texts], np.int64)
        mine, theirs = self._binding[:bound], other._binding[:bound]
        odd = np.flatnonzero(mine != as_here[theirs]) if bound else np.zeros(0, np.int64)
        return int(np.searchsorted(self._offset, odd[0], side="right")) - 1 if odd.size else at

    def has_ended_like(self, other: _Steps) -> bool:
        """Of runs of which one begins like the other: whether nothing is known of another step after that."""
        shorter = min(self, other, key=lambda run: run.count)
        if self.count != other.count:
            return shorter.is_cut
        return self.is_cut or other.is_cut or self.refused == other.refused

    def _changes(self, most: int, number: dict[tuple[str, str, str], int]) -> Numbers:
        """What the first steps take and put: rows of step, token and how many, in a fixed order."""
        changes = self._course["changes"]
        offset = unpacked(changes["offset"]).astype(np.int64)[: most + 1]
        last = int(offset[-1]) if len(offset) else 0
        own = np.array([number.setdefault(k, len(number)) for k in self._tokens], np.int64)
        token = own[unpacked(changes["token"])[:last]] if last else np.zeros(0, np.int64)
        count = unpacked(changes["count"])[:last].astype(np.int64)
        step = np.repeat(np.arange(len(offset) - 1), np.diff(offset))
        order = np.lexsort((count, token, step))
        return np.stack([step[order], token[order], count[order]], axis=1)

    @cached_property
    def _tokens(self) -> list[tuple[str, str, str]]:
        """All tokens: place, text, stamp (with `@`; without one, nothing)."""
        tokens = self._course["tokens"]
        rows = (unpacked(tokens[name]).tolist() for name in ("place", "text", "stamp"))
        return [
            (self._places[p], self._texts[t], f"@{self._texts[s - 1]}" if s else "")
            for p, t, s in zip(*rows, strict=True)
        ]

    def changed_alike(self, other: _Steps, most: int) -> int:
        """How many of the first steps take and put the same tokens, `most` at most."""
        number: dict[tuple[str, str, str], int] = {}
        a, b = self._changes(most, number), other._changes(most, number)
        shared = min(len(a), len(b))
        odd = np.flatnonzero((a[:shared] != b[:shared]).any(axis=1))
        ends = [
            int(rows[i, 0])
            for rows in (a, b)
            for i in [odd[0] if odd.size else shared]
            if i < len(rows)
        ]
        return min(ends, default=most)

    def other_changes(self, other: _Steps, step: int) -> list[str]:
        """What a step takes and puts in each run, of the first place where that differs."""
        found = _first_other(*(run._by_place("changes", step) for run in (self, other)))
        assert found is not None, "another change is one of some place"
        place, sides = found
        texts = [sorted(f"{n:+d}`{text}{stamp}" for text, stamp, n in held) for held in sides]
        return [f"{place} changes by {', '.join(held) or 'nothing'}" for held in texts]

    def binding(self, step: int) -> list[str]:
        """The values of the variables, as texts."""
        rows = self._binding[self._offset[step] : self._offset[step + 1]]
        return [self._texts[i] for i in rows.tolist()]

    def text(self, step: int) -> str:
        """What occurred in a step (from 0); what is said where the run has ended."""
        if step >= self.count and self.refused and not self.refused["transition"]:
            return f"the run ends with what is not so: {self.refused['why']}"
        if step >= self.count and self.refused:
            return f"the next step is not possible: {self.refused['transition']}: {self.refused['why']}"
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

    def other_start(self, other: _Steps) -> list[str] | None:
        """What the first place holds that holds something else at the beginning; None: there is none."""
        found = _first_other(*(run._by_place("keys", 0) for run in (self, other)))
        if found is None:
            return None
        place, sides = found
        texts = [[f"{n}`{text}{stamp}" for text, stamp, n in held] for held in sides]
        return [
            f"{place} holds {' ++ '.join(held) or 'nothing'} at the beginning" for held in texts
        ]

    def _by_place(self, rows: str, at: int) -> dict[str, list[Held]]:
        """The tokens of a row of `changes` (what a step takes and puts) or `keys` (what all places hold), by place."""
        part = self._course[rows]
        first, last = unpacked(part["offset"])[at : at + 2].tolist()
        found: dict[str, list[Held]] = {}
        for token, n in zip(
            unpacked(part["token"])[first:last].tolist(),
            unpacked(part["count"])[first:last].tolist(),
            strict=True,
        ):
            place, text, stamp = self._tokens[token]
            found.setdefault(place, []).append((text, stamp, n))
        return {place: sorted(held) for place, held in found.items()}


def _first_other(
    one: dict[str, list[Held]], two: dict[str, list[Held]]
) -> tuple[str, tuple[list[Held], list[Held]]] | None:
    """The first place that has not the same in both, and what it has."""
    for place in dict.fromkeys((*one, *two)):
        sides = one.get(place, []), two.get(place, [])
        if sides[0] != sides[1]:
            return place, sides
    return None
