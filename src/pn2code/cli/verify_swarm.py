"""`verify --swarm`: what its options mean, and what they exclude."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Annotated

import typer

from pn2code.properties import meaning as m
from pn2code.verify.exploring.limits import Reduction, cores
from pn2code.verify.swarm.cluster import Cluster
from pn2code.verify.swarm.pool import Swarm

SwarmOption = Annotated[
    int | None,
    typer.Option(
        "--swarm",
        metavar="N",
        min=1,
        max=100_000,
        help="Instead of one exploration N small searches with other orders, hashes and walks, "
        "which find what is wrong and never prove that nothing is (docs/verify.md).",
        show_default=False,
    ),
]
SchedulerOption = Annotated[
    str | None,
    typer.Option(
        "--scheduler",
        metavar="ADDRESS",
        help="Have the searches of `--swarm` carried out by the workers of this scheduler of dask, "
        "e.g. `tcp://host:8786`.",
        show_default=False,
    ),
]
WorkersOption = Annotated[
    int | None,
    typer.Option(
        "--workers",
        metavar="K",
        min=1,
        max=1_024,
        help="The processes that carry out the searches of `--swarm` here.  (default: the number of processors)",
        show_default=False,
    ),
]


@contextmanager
def swarm_of(
    searches: int | None, scheduler: str | None, workers: int | None
) -> Iterator[Swarm | None]:
    """The swarm that is wanted; its workers are there as long as the block lasts, once they are needed."""
    if searches is None:
        yield None
        return
    with Cluster(min(workers or cores(), searches), scheduler) as pool:
        yield Swarm(searches, pool)


def check_options(
    searches: int | None,
    scheduler: str | None,
    workers: int | None,
    reductions: Sequence[Reduction],
    others: Sequence[tuple[str, bool]],
) -> None:
    """Refuses options that do not go together.

    Args:
        searches, scheduler, workers: what `--swarm` and its own options say.
        reductions: those that are wanted.
        others: options that mean nothing to a swarm, and whether they are given.

    Raises:
        typer.BadParameter: some do not.
    """
    if searches is None:
        for option, given in (("--scheduler", scheduler), ("--workers", workers)):
            if given is not None:
                raise typer.BadParameter("it needs `--swarm N`", param_hint=option)
        return
    if scheduler is not None and workers is not None:
        raise typer.BadParameter(
            "the scheduler of `--scheduler` has its own workers", param_hint="--workers"
        )
    for option, is_given in others:
        if is_given:
            raise typer.BadParameter(
                f"`{option}` means nothing to its searches", param_hint="--swarm"
            )
    if any(r is not Reduction.TIME for r in reductions):
        raise typer.BadParameter(
            "of the reductions its searches know `--reduce time` alone", param_hint="--swarm"
        )


def endings(properties: m.Properties) -> tuple[int, ...]:
    """The numbers of the properties that a marking violates: where a search has found one, nothing more is needed."""
    found = []
    for number, p in enumerate(properties.properties):
        is_turned = isinstance(p.asked, m.Invariant) and not p.asked.wanted
        if isinstance(p.asked, m.Invariant | m.Bound) and p.expect != is_turned:
            found.append(number)
    return tuple(found)
