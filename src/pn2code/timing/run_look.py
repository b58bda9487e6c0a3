"""`pn2code time CELL --run RUN`: the critical path of a run, waits, utilisation, and what could be gained.

found = look_at(opened, Path("run"), d)         # RunTimes; None after an error that was reported
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.cell.divide import divide
from pn2code.cell.partition import OwnerKind
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.timing import codes
from pn2code.timing.causes import NoStoryError, Story, told
from pn2code.timing.critical import Study
from pn2code.verdict.opened import OpenNet


@frozen
class Segment:
    """A stretch of the critical path: who did what from when to when (s). The supervisor waits for a time stamp."""

    owner: str
    transition: str
    begin: float
    end: float


@frozen
class Activity:
    """A transition over the whole run (s).

    Args:
        times: how often it occurred; busy: how long that took; critical: how much of it lies on the critical path.
        gain: by how much the run would be shorter if it took no time, or all of it went on beside other work.
    """

    owner: str
    transition: str
    times: int
    busy: float
    critical: float
    gain: float


@frozen
class Side:
    """A robot or device: how long it works, and for which transitions of others it waits (s).

    Args:
        needed: how long of that it works on what the end of the run had to wait for.
    """

    owner: str
    busy: float
    needed: float
    share: float
    waits: tuple[tuple[str, float], ...]


@frozen
class RunTimes:
    """What is said of a run.

    Args:
        ended: why, as the trace says; seconds: until the last occurrence of the supervisor or an arm.
        whole: until the run ended.
    """

    file: str
    ended: str
    seconds: float
    whole: float
    path: tuple[Segment, ...]
    activities: tuple[Activity, ...]
    sides: tuple[Side, ...]

    def row(self) -> dict[str, Any]:
        """For programs (docs/time.md)."""
        return {
            "run": self.file,
            "ended": self.ended,
            "seconds": round(self.seconds, 6),
            "critical_path": [
                {
                    "owner": s.owner,
                    "transition": s.transition,
                    "begin_s": round(s.begin, 6),
                    "end_s": round(s.end, 6),
                }
                for s in self.path
            ],
            "activities": [
                {
                    "owner": a.owner,
                    "transition": a.transition,
                    "times": a.times,
                    "busy_s": round(a.busy, 6),
                    "critical_s": round(a.critical, 6),
                    "gain_s": round(a.gain, 6),
                }
                for a in self.activities
            ],
            "sides": [
                {
                    "owner": s.owner,
                    "busy_s": round(s.busy, 6),
                    "utilisation": round(s.share, 4),
                    "waits_s": {name: round(seconds, 6) for name, seconds in s.waits},
                }
                for s in self.sides
            ],
        }


def look_at(opened: OpenNet, run: Path, d: Diagnostics) -> RunTimes | None:
    """Looks at a run; None after an error that was reported.

    Args:
        opened: the cell.
        run: the folder that `pn2code run` wrote, or its trace.
        d: gets the errors.
    """
    if opened.config is None:
        d.error(
            codes.TIME_NO_CELL,
            "only a cell has durations, and there is no cell.toml",
            Origin(opened.flat.file),
            hint="give a cell.toml or its folder",
        )
        return None
    partition = divide(opened.flat, opened.config, d)
    if partition is None:
        return None
    file = run / f"{opened.flat.name}.trace.jsonl" if run.is_dir() else run
    try:
        story = told(file, opened.flat, partition.transition_owner, opened.storage)
    except NoStoryError as problem:
        d.error(
            codes.TIME_NO_RUN,
            str(problem),
            Origin(str(run)),
            hint="give the folder that `pn2code run` of this cell wrote, or its NET.trace.jsonl",
        )
        return None
    arms = {r.name for r in opened.config.robots}
    owners = partition.owners
    ends = {o.index for o in owners if o.kind is OwnerKind.SUPERVISOR or o.name in arms}
    study = Study(story, ends)
    names = [o.name for o in owners]
    transitions = [t.name for t in opened.flat.transitions]
    whole = max(study.last, 1e-9)
    sides = tuple(
        Side(
            o.name,
            study.busy(o.index),
            study.needed(o.index),
            study.busy(o.index) / whole,
            tuple((transitions[w.transition], w.seconds) for w in study.waits(o.index)),
        )
        for o in owners
        if o.kind is not OwnerKind.SUPERVISOR
    )
    return RunTimes(
        str(file),
        story.ended,
        study.seconds,
        story.seconds,
        tuple(_segments(story, study, names, transitions)),
        tuple(_activities(story, study, names, transitions)),
        sides,
    )


def _segments(
    story: Story, study: Study, names: list[str], transitions: list[str]
) -> Iterator[Segment]:
    for i in study.path:
        o = story.occurrences[i]
        if o.seconds > 0.0:
            yield Segment(names[o.owner], transitions[o.transition], o.since, o.time)


def _activities(
    story: Story, study: Study, names: list[str], transitions: list[str]
) -> list[Activity]:
    own: dict[int, list[int]] = {}
    for i, o in enumerate(story.occurrences):
        if o.seconds > 0.0:
            own.setdefault(o.transition, []).append(i)
    critical = set(study.path)
    found = []
    for t, numbers in own.items():
        those = [story.occurrences[i] for i in numbers]
        on_path = sum(story.occurrences[i].seconds for i in numbers if i in critical)
        found.append(
            Activity(
                names[those[0].owner],
                transitions[t],
                len(those),
                sum(o.seconds for o in those),
                on_path,
                study.gain(set(numbers)),
            )
        )
    return sorted(found, key=lambda a: (-a.gain, -a.busy, a.transition))
