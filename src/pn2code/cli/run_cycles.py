"""`pn2code run --cycles`: many runs of a cell, one after the other."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from pn2code.base.progress_line import Line
from pn2code.cli.options import Exit, Format, print_but_known, stop
from pn2code.cli.replay_files import write_replay
from pn2code.cli.run_trouble import trouble_told
from pn2code.diagnostics import Diagnostics

if TYPE_CHECKING:
    from pn2code.replay.motion import Motion
    from pn2code.run.cycles import Cycles, Plan, Spread
    from pn2code.run.prepare import RunOptions
    from pn2code.run.results import RunResult
    from pn2code.run.stops import Rate


def rates(texts: list[str]) -> dict[str, Rate]:
    """The options `--stops WHO:BETWEEN/LASTING`."""
    from pn2code.run.stops import parse

    out = {}
    for text in texts:
        found = parse(text)
        if found is None:
            raise typer.BadParameter(
                f"`{text}`: WHO:BETWEEN/LASTING is expected, mean seconds above 0, e.g. robot1:600/30",
                param_hint="--stops",
            )
        out[found[0]] = found[1]
    return out


def run_many(
    cell: Path, options: RunOptions, plan: Plan, form: Format, *, replay: bool = True
) -> None:
    """Runs a cell so often, prints what came of it, and leaves with code 1 if a run did not come to its end."""
    from pn2code.replay.motion import Motion
    from pn2code.run.alone import alone_in
    from pn2code.run.cycles import Keeping, run_cycles, table

    kept: dict[Path, tuple[RunResult, Motion]] = {}

    def keep(result: RunResult, motion: Motion, folder: Path) -> None:
        kept[folder] = result, motion

    d = Diagnostics()
    with trouble_told(options.out), alone_in(options.out):
        with Line(shown=True, plain=False, first="generating and building") as line:
            found = run_cycles(cell, options, plan, d, line.say, Keeping(Motion, keep))
        if found is None:
            stop(d, form)
        for folder, (result, motion) in kept.items():
            write_replay(result, motion, folder, wanted=replay)
        lines = "".join(f"{x}\n" for x in table(found.cycles))
        (options.out / "cycles.tsv").write_text(lines, encoding="utf-8")
        text = json.dumps(found.row(), indent=1) + "\n"
        (options.out / "cycles.json").write_text(text, encoding="utf-8")
    print_but_known(d, cell, form)
    for row in _lines(found, options.out):
        typer.echo(row)
    if any(c.verdict != "finished" for c in found.counted):
        raise typer.Exit(Exit.MODEL)


def _lines(found: Cycles, out: Path) -> list[str]:
    counted = found.counted
    done = sum(c.verdict == "finished" for c in counted)
    warm = len(found.cycles) - len(counted)
    more = f" after {warm:,} of warm-up" if warm else ""
    lines = [f"{len(counted):,} cycles{more}: {done:,} came to their end"]
    whole = found.finished()
    if whole is not None:
        lines.append(f"  cycle time  {_spread(whole)}")
    endings = found.endings()
    if len(endings) > 1:
        for place, spread in endings.items():
            short = " and ".join(p.rpartition(".")[2] for p in place.split(", "))
            lines.append(f"  to `{short}`: {spread.count:,} cycles, {_spread(spread)}")
    for name, number in found.per_hour().items():
        lines.append(f"  {name.removeprefix('counts.')} per hour  {number:.2f}")
    stops = sum(c.stops for c in counted)
    if stops:
        lines.append(f"  {stops:,} stops, {sum(c.stopped for c in counted):.1f} s together")
    for c in counted:
        if c.verdict != "finished":
            lines.append(f"  cycle {c.number} {c.verdict}: {c.reason}")
    lines.append(
        f"results in {out}/: cycles.tsv, cycles.json, and a slowest cycle in slowest/, with its replay page"
    )
    return lines


def _spread(s: Spread) -> str:
    if s.deviation is None or s.confidence is None:
        return f"{s.mean:.3f} s"
    return (
        f"mean {s.mean:.3f} s (95 %: +- {s.confidence:.3f} s), standard deviation {s.deviation:.3f} s, "
        f"least {s.least:.3f} s, median {s.median:.3f} s, most {s.most:.3f} s"
    )
