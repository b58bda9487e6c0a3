"""How a long exploration went: states, waiting states, rate and memory, over time and over depth.

record = Record()
explore(net, storage, limits, d, ExploreOptions(progress=record.add, pace=0.1))
plot(record, found, "net.cpn", Path("net.svg"))
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.verify.exploring.result import Exploration

_BLUE, _RED, _GREEN, _PURPLE = "#0072B2", "#D55E00", "#009E73", "#CC79A7"
_MOST_POINTS, _FEW_POINTS = 200, 5


@frozen
class Sample:
    """What the explorer said at a time; `rate` is of the time since the sample before, in states/s."""

    seconds: float
    states: int
    arcs: int
    waiting: int
    depth: int
    mib: float
    rate: float


class Record:
    """Gathers what an exploration says of itself while it explores."""

    def __init__(self) -> None:
        self._samples: list[Sample] = []

    def add(self, said: Mapping[str, Any]) -> None:
        """A line of progress; an exploration that begins anew forgets the one before."""
        before = self._samples[-1] if self._samples else None
        seconds, states = float(said.get("seconds", 0.0)), int(said.get("states", 0))
        if before is not None and (states < before.states or seconds < before.seconds):
            self._samples.clear()
            before = None
        if said.get("phase", "explore") != "explore":
            return
        self._samples.append(
            Sample(
                seconds,
                states,
                int(said.get("arcs", 0)),
                int(said.get("frontier", 0)),
                int(said.get("depth", 0)),
                float(said.get("mib", 0.0)),
                0.0,
            )
        )

    def samples(self, found: Exploration) -> tuple[Sample, ...]:
        """From the start to the end, which `found` knows; at most some hundred, with their rates."""
        last = self._samples[-1] if self._samples else None
        own = [Sample(0.0, 1, 0, 1, 0, 0.0, 0.0), *self._samples]
        if found.seconds > own[-1].seconds and found.nodes >= own[-1].states:
            waiting = 0 if found.complete else own[-1].waiting
            mib = max(last.mib if last else 0.0, found.bytes_per_state * found.nodes / 2**20)
            own.append(
                Sample(found.seconds, found.nodes, found.arcs, waiting, found.depth, mib, 0.0)
            )
        least = own[-1].seconds / _MOST_POINTS
        kept = own[:1]
        for sample in own[1:-1]:
            if sample.seconds - kept[-1].seconds >= least or sample.depth != kept[-1].depth:
                kept.append(sample)
        return _with_rates([*kept, own[-1]] if len(own) > 1 else kept)


def _with_rates(samples: Sequence[Sample]) -> tuple[Sample, ...]:
    """With the mean rate from each sample to the next."""
    found = list(samples[:1])
    for before, sample in pairwise(samples):
        since = sample.seconds - before.seconds
        rate = (sample.states - before.states) / since if since > 0 else found[-1].rate
        found.append(replace(sample, rate=rate))
    return tuple(found)


def plot(record: Record, found: Exploration, title: str, path: Path) -> None:
    """Draws it, as SVG or PNG by the name of the file.

    Raises:
        OSError: the file cannot be written.
    """
    import matplotlib  # takes a while, and most runs draw nothing

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import EngFormatter, MaxNLocator

    samples = record.samples(found)
    rows: list[tuple[str, str, str, Callable[[Sample], float]]] = [
        ("states", "", _BLUE, lambda s: float(s.states)),
        ("states that wait", "", _RED, lambda s: float(s.waiting)),
        ("states per second", "", _GREEN, lambda s: s.rate),
        ("memory of tables", "B", _PURPLE, lambda s: s.mib * 2**20),
    ]
    style: dict[Any, Any] = {"svg.hashsalt": "pn2code", "svg.fonttype": "none", "font.size": 10}
    with plt.rc_context(style):
        figure, axes = plt.subplots(
            len(rows), 2, figsize=(11, 10), sharex="col", sharey="row", layout="constrained"
        )
        deep = _by_depth(samples)
        for (label, unit, colour, value), (left, right) in zip(rows, axes, strict=True):
            skip = 1 if value(samples[0]) == 0.0 and label == "states per second" else 0
            for at, own, across in (
                (left, samples[skip:], [s.seconds for s in samples[skip:]]),
                (right, deep[skip:], [float(s.depth) for s in deep[skip:]]),
            ):
                mark = "." if len(own) < 60 else ""
                at.plot(across, [value(s) for s in own], color=colour, marker=mark, lw=1.5)
                at.grid(True, color="#e3e6ec", lw=0.7)
                at.spines[["top", "right"]].set_visible(False)
            left.set_ylabel(label)
            left.set_ylim(bottom=0)
            left.yaxis.set_major_locator(MaxNLocator(5, integer=True))
            left.yaxis.set_major_formatter(EngFormatter(unit=unit, sep=" " if unit else ""))
        axes[-1][0].set_xlabel("time of exploration [s]")
        axes[-1][1].set_xlabel("depth [steps from the initial marking]")
        axes[-1][0].set_xlim(left=0)
        axes[-1][1].set_xlim(left=0)
        short = "\n(too short for more points)" if len(samples) < _FEW_POINTS else ""
        figure.suptitle(f"{title}\n{_facts(found)}{short}", fontsize=11)
        try:
            kept = {"Date": None} if path.suffix.lower() == ".svg" else None
            figure.savefig(path, dpi=110, metadata=kept)
        finally:
            plt.close(figure)


def _by_depth(samples: Sequence[Sample]) -> list[Sample]:
    """The last sample of each depth: when a level is done; rates are those of the level."""
    found: dict[int, Sample] = {}
    for s in samples:
        found[s.depth] = s
    return list(_with_rates(list(found.values())))


def _facts(found: Exploration) -> str:
    text = (
        f"{found.nodes:,} states, {found.arcs:,} arcs, depth {found.depth:,}, {found.seconds:.2f} s, "
        f"{found.bytes_per_state:.1f} bytes a state, {found.threads} thread{'s' * (found.threads > 1)}"
    )
    return text if found.complete else f"{text}; truncated ({found.why})"
