"""Whoever carries out the searches of a swarm, as the rest of it sees it, and what is wanted of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Protocol

from pn2code.base.deadline import Deadline
from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics
from pn2code.verify.swarm.task import Job


class Pool(Protocol):
    """Workers, here or elsewhere."""

    @property
    def is_here(self) -> bool:
        """Whether they are on this machine."""

    @property
    def workers(self) -> int:
        """How many there are now."""

    def start(self, d: Diagnostics, deadline: Deadline) -> bool:
        """Makes them ready, if they are not, and waits no longer for a scheduler; False after an error."""

    def results(
        self, job: Job, searches: Sequence[tuple[str, ...]]
    ) -> Iterator[tuple[int, dict[str, Any]] | None]:
        """What each search has found, with its number, as soon as it has; now and then None, while all are at work."""

    def end(self, first: int, *, gently: bool) -> None:
        """Searches from that number on are not wanted any more; `gently`: but what they have found until now is."""


@frozen
class Swarm:
    """What is wanted.

    Args:
        searches: how many.
        pool: who carries them out.
    """

    searches: int
    pool: Pool
