"""`./dev bench`: measures, prints the table of docs/benchmarks.md, exits 1 when a limit is missed by more than noise.

A figure is the median of its repetitions, with the smallest and the largest beside it; `work` is what the cores did for
it. A limit is missed when even the best repetition is beyond it: other programs on the machine make a figure worse,
never better. On a machine that is busy when this starts, a miss is shown, but is no failure.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does: the tests' helpers

from tools.bench import compile_times, monitor, pairs, snakes_peer, states
from tools.bench import measures as m


@dataclass(frozen=True, slots=True)
class Row:
    """A line of the table.

    Args:
        what: in words.
        unit: "s", "us" or "/s".
        samples: one a repetition.
        work: of the cores, s, for commands.
        limit: what must not be exceeded.
        peer: what does the same in another way, measured in the same run, and its name.
    """

    what: str
    unit: str
    samples: Sequence[float]
    work: Sequence[float] = ()
    limit: float | None = None
    peer: tuple[str, Sequence[float]] | None = None

    @property
    def missed(self) -> bool:
        """Beyond the limit, and not by noise."""
        return self.limit is not None and min(self.samples) > self.limit

    def cells(self) -> list[str]:
        """What stands in the columns."""
        middle = median(self.samples)
        spread = f"{self._number(min(self.samples))} .. {self._number(max(self.samples))}"
        limit = "" if self.limit is None else f"{self._number(self.limit)}"
        beside = ""
        if self.peer is not None:
            name, samples = self.peer
            other = median(samples)
            beside = f"{name}: {self._number(other)} ({middle / other:.3g} times)"
        missed = " **missed**" if self.missed else ""
        work = self._number(median(self.work)) if self.work else ""
        return [self.what, self._number(middle), spread, work, self.unit, limit + missed, beside]

    def _number(self, value: float) -> str:
        return {"s": f"{value:.2f}", "us": f"{value:.0f}"}.get(self.unit, f"{value:,.0f}")


def rows(bench: m.Bench) -> list[Row]:
    """All measures."""
    say("command")
    python = ("Python that does nothing", m.python_alone(bench).wall)
    out = [
        Row("start-up (`pn2code --version`)", "s", *m.start_up(bench), peer=python),
        Row("`check` of the riveting net", "s", *m.check_net(bench), 0.5),
        Row("`check` of 60 pages, 720 places, 600 transitions", "s", *m.check_large(bench), 3.0),
        Row("`check` of the riveting cell with its geometry", "s", *m.check_cell(bench)),
        Row("`generate` of the riveting cell", "s", *m.generate(bench), 1.0),
    ]
    say("C build")
    one = ("1 job", m.build(bench, 1).wall)
    out.append(Row("C build, 2 jobs", "s", *m.build(bench, 2), 5.0, one))
    largest = m.largest_of_corpus()
    if largest is not None:
        what = f"`generate` and C build, 2 jobs, of the largest net collected (`{largest.name}`)"
        out.append(Row(what, "s", *m.generate_and_build(bench, largest), 30.0))
    say("runs")
    bullet = m.run_cell(bench, "--no-pictures")
    fake = m.run_cell(bench, "--no-pictures", "--backend", "fake")
    beside = ("kinematics only", fake.wall)
    out.append(Row("full run, PyBullet, no pictures", "s", *bullet, 15.0, beside))
    out.append(Row("full run, PyBullet, pictures and charts", "s", *m.run_cell(bench)))
    say("latency")
    delays = m.latency(bench)
    for kind, words in (("published", "answer published"), ("woken", "robot woken by the answer")):
        for share, limit in (("p50", 70.0), ("p99", 250.0)):
            peer = ("bare C ping-pong", delays[f"bare {share}"])
            bound = limit if kind == "published" else None
            out.append(Row(f"{words}, {share}", "us", delays[f"{kind} {share}"], (), bound, peer))
    return out + firing_rows(bench)


def firing_rows(bench: m.Bench) -> list[Row]:
    """Firings per second beside those of the token game and of SNAKES."""
    say("firings")
    out = []
    for name, text, steps, slow, peer in (
        ("a ring of four transitions", m.RING, 30_000_000, 3_000, snakes_peer.ring),
        ("ten philosophers", m.TABLE, 4_000_000, 500, snakes_peer.table),
        ("a protocol with strings", m.PROTOCOL, 5_000_000, 1_000, snakes_peer.protocol),
    ):
        found = m.firings(bench, text, steps, slow, peer)
        for other, samples in (("SNAKES", found.snakes), ("token game", found.game)):
            row = Row(f"firings, {name}", "/s", found.compiled, (), None, (other, samples))
            out.append(row)
    return out


def say(what: str) -> None:
    """Progress, beside the table."""
    print(f"bench: {what}", file=sys.stderr)


def main() -> int:
    """Measure and print; 1 when a limit is missed."""
    parser = argparse.ArgumentParser(prog="python -m tools.bench", description=__doc__)
    parser.add_argument("--firings", action="store_true", help="only firings per second")
    parser.add_argument("--repeat", type=int, default=9, help="of short measures (default 9)")
    parser.add_argument("--states", action="store_true", help="only state spaces, beside SPIN")
    parser.add_argument(
        "--monitor", action="store_true", help="only what the supervisor's monitor costs"
    )
    parser.add_argument(
        "--database-15", action="store_true", help="only that: 71,744,536 states, minutes"
    )
    parser.add_argument(
        "--compile", action="store_true", help="only what compiling takes, by the size of the net"
    )
    parser.add_argument(
        "--sizes",
        type=int,
        nargs="*",
        metavar="N",
        help="with --compile: by host, nets of N transitions",
    )
    parser.add_argument(
        "--against", type=Path, metavar="CHECKOUT", help="only commands, beside those of a checkout"
    )
    parser.add_argument(
        "--swarm", action="store_true", help="only a swarm by one worker and by two, and a model"
    )
    parser.add_argument("--play", action="store_true", help="only a click in the page of `play`")
    parser.add_argument("--replay", action="store_true", help="only the replay page in a browser")
    parser.add_argument(
        "--replay-of", type=Path, metavar="RUN", help="the same, of the folder of a run"
    )
    parser.add_argument("--minutes", type=int, default=10, help="of playing, for its memory")
    parser.add_argument(
        "--live", type=Path, metavar="CELL", help="only what watchers cost the supervisor of a cell"
    )
    parser.add_argument("--pages", type=int, default=10, help="with --live (default 10)")
    parser.add_argument("--watchers", type=int, default=0, help="with --live, instead of pages")
    parser.add_argument("--speed", type=float, default=10.0, help="with --live (default 10)")
    options = parser.parse_args()
    if options.live:
        from tools.bench import live  # loads all that a run needs

        runs = min(options.repeat, 6)
        return live.measure(options.live, options.pages, runs, options.speed, options.watchers)
    if options.play:
        from tools.play import __main__ as play  # needs Playwright

        return play.measure()
    if options.replay or options.replay_of:
        from tools.bench import replay  # needs Playwright

        return replay.measure(options.replay_of, options.repeat, options.minutes)
    if options.swarm:
        from tools.bench import swarm  # needs `distributed`

        return swarm.measure(min(options.repeat, 3))
    if options.against:
        return pairs.measure(options.against, options.repeat)
    if options.compile and options.sizes is not None:
        return compile_times.measure_sizes(options.sizes or compile_times.LARGE_SIZES)
    if options.compile:
        return compile_times.measure(min(options.repeat, 3))
    if options.database_15:
        return states.measure_large(15, os.cpu_count() or 1)
    if options.states:
        return states.measure(min(options.repeat, 3), 1)
    cores = os.cpu_count() or 1
    load = os.getloadavg()[0]
    is_busy = load > cores / 2
    with tempfile.TemporaryDirectory(prefix="pn2code-bench-") as name:
        bench = m.Bench(Path(name), options.repeat)
        if options.monitor:
            return monitor.measure(bench)
        table = firing_rows(bench) if options.firings else rows(bench)
    print(f"{cores} cores; load at the start {load:.1f}" + is_busy * ": busy")
    print("\n| what | median | spread | work | unit | limit | compared with, in the same run |")
    print("|---|---|---|---|---|---|---|")
    for row in table:
        print("| " + " | ".join(row.cells()) + " |")
    return int(not is_busy and any(row.missed for row in table))


if __name__ == "__main__":
    sys.exit(main())
