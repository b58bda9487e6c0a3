"""A swarm from its first search to its merged report.

Searches are carried out in the order of their numbers. The one with the least number that has found something which
ends the swarm (a violation, an exception, a place that is full) is the last that counts: those before it are waited
for, those behind it are ended, and what they have found is forgotten, also where they were first. So the report is the
same whoever carries them out.
"""

from __future__ import annotations

import secrets
import tempfile
import time
from array import array
from collections.abc import Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pn2code.base.frozen import record
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.net.flat import FlatNet
from pn2code.toolchain.kept_files import digest_of_runtime
from pn2code.verify.codes import EXPLORER_FAILED, TRACE_UNWRITABLE
from pn2code.verify.exploring.explorer_process import nothing
from pn2code.verify.swarm.merging import SWARM, is_event, looked_at, merged
from pn2code.verify.swarm.plan import MEMORY, SKETCH, STATES, Search
from pn2code.verify.swarm.pool import Swarm
from pn2code.verify.swarm.task import DEAD, ERROR, QUERY, Job

if TYPE_CHECKING:
    from pn2code.verify.exploring.explore import ExploreOptions
    from pn2code.verify.exploring.limits import Limits
    from pn2code.verify.exploring.programs import Generated

_LEAST_S = 1e-6
_SEARCH_PART = 0.75
"""Of the time that is left, what the searches may take; the rest is for telling what was found."""
_LATE_PART = 0.85
"""The same, until a search breaks off what it works out, and says what it knows."""


@record
class _Course:
    """How far a swarm is.

    Args:
        found: by number, what searches have said.
        files: by number, their runs.
        end: searches from this number on do not count.
        why: it has ended early; "": it has not.
        problem: of the search with the least number that could not be carried out.
    """

    found: dict[int, Mapping[str, Any]]
    files: dict[int, Mapping[str, bytes]]
    end: int
    why: str = ""
    problem: tuple[int, str] | None = None

    def take(self, number: int, result: Mapping[str, Any], ending: Sequence[int]) -> bool:
        """One more has come to its end. Whether those behind it are not wanted any more."""
        if number >= self.end:
            return False
        said = result["said"]
        if said is None:
            if self.why or not result["problem"]:
                return False  # it was ended before it had anything to say
            self.problem = number, result["problem"]
        else:
            own = said["swarm"]
            # Of ten thousand searches the hashes alone would take hundreds of megabytes as numbers of Python.
            own["sketch"] = array("Q", own["sketch"])
            self.found[number], self.files[number] = said, result["files"]
            if not is_event(said, ending):
                return False
        self.end = number + 1
        return True

    def is_over(self) -> bool:
        """Whether all that count are there."""
        number = None if self.problem is None else self.problem[0]
        return all(i in self.found or i == number for i in range(self.end))

    def whole(self) -> list[int]:
        """Those that count: of a swarm that has ended early all that have said something."""
        return sorted(i for i in self.found if i < self.end)


def search(
    net: FlatNet,
    program: Path,
    made: Generated,
    arguments: Sequence[str],
    options: ExploreOptions,
    limits: Limits,
    swarm: Swarm,
    d: Diagnostics,
) -> dict[str, Any] | None:
    """What a swarm has found, as an explorer would say it; None after an error that was reported.

    Args:
        net: the net.
        program: the net compiled; `made`: what it was compiled from.
        arguments: for the explorer: how large it is, how it reduces, and the like.
        options, limits: as for `explore`.
        swarm: what is wanted.
        d: gets the errors.
    """
    began = time.perf_counter()
    if not swarm.pool.start(d, limits.deadline):
        return None
    with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
        job = Job(
            secrets.token_hex(8),
            made.host,
            made.files,
            digest_of_runtime(made.host.runtime()),
            program=str(program) if swarm.pool.is_here else "",
            arguments=(*arguments, *_common(limits)),
            questions=options.questions,
            folder=folder if swarm.pool.is_here else "",
        )
        course = _Course({}, {}, swarm.searches)
        _carry_out(course, job, options, limits, swarm, began)
    if course.problem is not None and course.problem[0] < course.end and not course.why:
        number, problem = course.problem
        d.error(
            EXPLORER_FAILED,
            f"search {number} of the swarm could not be carried out: {problem}",
            Origin(net.file),
            hint="give each search less memory with `--memory MIB`, or have fewer `--workers`",
        )
        return None
    counted = course.whole()
    if not counted:
        return nothing(net, limits, course.why or "interrupted")
    seconds = time.perf_counter() - began
    runs = _Runs(course.files, options, d)
    given = {i: runs.kept(i, course.found[i]) for i in counted}
    return merged(given, swarm.searches, course.why or SWARM, seconds, swarm.pool.workers)


def _common(limits: Limits) -> list[str]:
    left = limits.deadline.left
    given: list[tuple[str, object]] = [
        ("--max-states", limits.max_states or STATES),
        ("--memory", limits.memory or MEMORY),
        ("--sketch", SKETCH),
        ("--multiset-limit", 0),
        ("--traces", min(limits.traces, 1)),
        ("--max-seconds", None if left is None else max(left * _SEARCH_PART, _LEAST_S)),
        ("--late-seconds", None if left is None else max(left * _LATE_PART, _LEAST_S)),
    ]
    return [text for name, value in given if value is not None for text in (name, str(value))]


def _carry_out(
    course: _Course,
    job: Job,
    options: ExploreOptions,
    limits: Limits,
    swarm: Swarm,
    began: float,
) -> None:
    """Until all that count are there, the time is over, or it was interrupted."""
    deadline, pool = limits.deadline, swarm.pool
    ending = options.ending
    searches = []
    for i in range(swarm.searches):
        own = [] if not ending else ["--ending", ",".join(map(str, ending))]
        searches.append((*Search.of(i).arguments(), *own))
    told = 0.0
    for result in pool.results(job, searches):
        if result is not None and course.take(*result, ending):
            pool.end(course.end, gently=False)
        if course.is_over():
            break
        now = time.perf_counter()
        if now - told >= options.pace:
            told = now
            options.progress(_progress(course, now - began))
        if not course.why and (options.interrupted() or deadline.is_over()):
            course.why = "seconds" if deadline.is_over() else "interrupted"
            pool.end(0, gently=True)
        elif course.why and deadline.is_long_over():
            break
    pool.end(0, gently=False)


def _progress(course: _Course, seconds: float) -> dict[str, Any]:
    said = course.found.values()
    return {
        "phase": f"swarm, {len(said)} of {course.end} searches done",
        "states": sum(map(looked_at, said)),
        "arcs": sum(own["arcs"] for own in said),
        "mib": max((own["peak_mib"] for own in said), default=0),
        "seconds": seconds,
    }


@record
class _Runs:
    """The runs of searches, in their order: the first to each goal is kept in a file of ours.

    Args:
        files: by number, what searches have written.
        options: where files go.
        d: gets the warnings.
        known: goals to which a run is kept.
    """

    files: Mapping[int, Mapping[str, bytes]]
    options: ExploreOptions
    d: Diagnostics
    known: set[str] = field(default_factory=set)

    def kept(self, number: int, found: Mapping[str, Any]) -> Mapping[str, Any]:
        """What a search has said, with the files of its runs; those that cannot be written are none."""
        answers = []
        for i, answer in enumerate(found.get("queries") or ()):
            run = self._file(number, f"{QUERY}{i}", self.options.evidence)
            answers.append({**answer, "trace": run, "steps": answer["steps"] if run else None})
        dead, error = found["swarm"]["dead_trace"], found["error"]
        if dead is not None:
            run = self._file(number, f"{DEAD}0", self.options.traces)
            dead = {**dead, "file": run} if run is not None else None
        if error is not None and error.get("trace"):
            run = self._file(number, f"{ERROR}0", self.options.traces)
            error = {**error, "trace": {**error["trace"], "file": run} if run else None}
        swarm = {**found["swarm"], "dead_trace": dead}
        return {**found, "queries": answers, "swarm": swarm, "error": error}

    def _file(self, number: int, goal: str, folder: Path | None) -> str | None:
        """The file of a run; None: there is none, or one to the same goal is kept already."""
        written = self.files[number].get(f"{goal}.trace.jsonl")
        if written is None or folder is None or goal in self.known:
            return None
        path = folder / f"{self.options.stem}.{goal}.trace.jsonl"
        try:
            path.write_bytes(written)
        except OSError:
            self.d.warning(
                TRACE_UNWRITABLE,
                f"a run cannot be written into `{folder}`",
                Origin(str(folder)),
                hint="give another folder with `--traces DIR`",
            )
            return None
        self.known.add(goal)
        return str(path)
