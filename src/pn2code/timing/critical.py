"""Why a run takes as long as it does: the critical path, who waits for whom, and what could be gained.

    study = Study(story, ends)
    study.path                          # the occurrences of the critical path, in order
    study.gain({3, 8})                  # s that a run is shorter if these took no time

The run is taken as its occurrences with their causes and durations. So what is said of another duration keeps the
orders of this run: who gets a zone first stays so.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import cached_property

from pn2code.base.frozen import frozen
from pn2code.timing.causes import Occurrence, Story


@frozen
class Wait:
    """While an owner had nothing to do, others were at work that it waited for: which transition, and how long (s)."""

    owner: int
    transition: int
    seconds: float


class Study:
    """A run that is looked at.

    Args:
        story: its occurrences.
        ends: the owners whose last occurrences end a run: the supervisor and the arms.
    """

    def __init__(self, story: Story, ends: Collection[int]) -> None:
        self.story = story
        self._last = [i for i, o in enumerate(story.occurrences) if o.owner in ends]
        self.path = tuple(self._path())

    @property
    def seconds(self) -> float:
        """When the last of all that ends a run has occurred."""
        return max((self.story.occurrences[i].time for i in self._last), default=0.0)

    @property
    def last(self) -> float:
        """When the last of all has occurred: a device may be at work after the end."""
        return max((o.time for o in self.story.occurrences), default=0.0)

    def _path(self) -> list[int]:
        occurrences = self.story.occurrences
        if not self._last:
            return []
        now = max(self._last, key=lambda i: (occurrences[i].time, i))
        out = [now]
        while occurrences[now].causes:
            now = max(occurrences[now].causes, key=lambda i: (occurrences[i].time, i))
            out.append(now)
        return out[::-1]

    def shortened(self, quick: Mapping[int, float] | Collection[int]) -> float:
        """How long the run would be if these occurrences took no time, or as long as is said."""
        times: list[float] = []
        for i, o in enumerate(self.story.occurrences):
            since = max((times[c] for c in o.causes), default=0.0)
            seconds = o.seconds
            if i in quick:
                seconds = quick[i] if isinstance(quick, Mapping) else 0.0
            times.append(since + seconds)
        return max((times[i] for i in self._last), default=0.0)

    def gain(self, quick: Collection[int]) -> float:
        """By how much the run would be shorter then."""
        return max(0.0, self.seconds - self.shortened(quick))

    def busy(self, owner: int) -> float:
        """How long an owner is at work."""
        return sum(o.seconds for o in self.story.occurrences if o.owner == owner)

    def needed(self, owner: int) -> float:
        """How long of that it was at work on what the end of the run had to wait for."""
        return sum(o.seconds for o in self._needed if o.owner == owner)

    @cached_property
    def _needed(self) -> list[Occurrence]:
        occurrences = self.story.occurrences
        found, todo = set(self._last), list(self._last)
        while todo:
            causes = set(occurrences[todo.pop()].causes) - found
            found |= causes
            todo += causes
        return [occurrences[i] for i in sorted(found)]

    def waits(self, owner: int) -> list[Wait]:
        """For whom an owner waits between its occurrences, the longest first."""
        found: dict[int, float] = {}
        before = 0.0
        for o in self.story.occurrences:
            if o.owner != owner:
                continue
            for other, seconds in self._work(o, before):
                found[other.transition] = found.get(other.transition, 0.0) + seconds
            before = o.time
        waits = (Wait(owner, t, seconds) for t, seconds in found.items())
        return sorted(waits, key=lambda w: (-w.seconds, w.transition))

    def _work(self, o: Occurrence, before: float) -> Iterator[tuple[Occurrence, float]]:
        """What was done from a time until an occurrence could begin, back along its last causes."""
        occurrences = self.story.occurrences
        until = o.since
        while until > before and o.causes:
            o = occurrences[max(o.causes, key=lambda i: (occurrences[i].time, i))]
            begins = max(o.since, before)
            if until > begins and o.seconds > 0.0:
                yield o, min(until, o.time) - begins
            until = min(until, o.since)
