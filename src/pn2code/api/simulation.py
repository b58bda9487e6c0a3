"""Runs at random."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pn2code.api.errors import playing, refuse
from pn2code.api.marking import Marking
from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics
from pn2code.simulate.choose import Wish, monitors_of
from pn2code.simulate.choose import simulate as play
from pn2code.simulate.run import Request
from pn2code.verdict.opened import OpenNet

if TYPE_CHECKING:
    from pn2code.api.net import Net


@frozen
class Simulation:
    """What became of a run.

    Args:
        steps: how many occurrences there were.
        why: why it ended: "finished" (nothing is enabled, now or later), "steps", "until", "breakpoint" or "error" (the
            net raised an exception; `error` says which).
        initial, final: the markings at its ends.
        monitors: what the monitors of the net have collected, as `pn2code simulate --json` prints it.
        output: what the net has printed.
        error: of "error": what happened, where.
        engine: "compiled" or "reference".
    """

    steps: int
    why: str
    initial: Marking
    final: Marking
    monitors: tuple[Mapping[str, Any], ...]
    output: str
    error: str | None
    engine: str


def simulate(
    net: Net,
    opened: OpenNet,
    steps: int | None,
    *,
    seed: int,
    until: float | None,
    trace: str | Path | None,
    engine: str,
    files: str | Path | None,
) -> Simulation:
    """Makes a run; see `Net.simulate`."""
    d = Diagnostics()
    request = Request(
        net=opened.flat,
        storage=opened.storage,
        initial=opened.initial,
        steps=steps,
        seed=seed,
        until=until,
        trace=None if trace is None else Path(trace),
        monitors=monitors_of(opened.examined, d),
        files=None if files is None else Path(files),
    )
    with playing():
        outcome = play(request, Wish(engine), d)
    if outcome is None or outcome.initial is None or outcome.final is None:
        if outcome is not None and outcome.failure is not None:
            outcome.failure.report(d, outcome.steps)
        raise refuse(d)
    return Simulation(
        steps=outcome.steps,
        why=outcome.why,
        initial=Marking(net, outcome.initial),
        final=Marking(net, outcome.final),
        monitors=outcome.monitors,
        output=outcome.output,
        error=None if outcome.failure is None else outcome.failure.message,
        engine=outcome.engine,
    )
