"""A swarm without workers: one search after the other, in the process that asks for it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from pn2code.base.deadline import Deadline
from pn2code.diagnostics import Diagnostics
from pn2code.verify.swarm import task
from pn2code.verify.swarm.task import Job


class Inline:
    """A pool; `is_here`: or as a worker elsewhere would do it."""

    workers = 1

    def __init__(self, *, is_here: bool) -> None:
        self.is_here = is_here

    def start(self, d: Diagnostics, deadline: Deadline) -> bool:
        return True

    def results(
        self, job: Job, searches: Sequence[tuple[str, ...]]
    ) -> Iterator[tuple[int, dict[str, Any]] | None]:
        for number, own in enumerate(searches):
            yield number, task.run(job, number, own)

    def end(self, first: int, *, gently: bool) -> None:
        """All that begins is carried out."""
