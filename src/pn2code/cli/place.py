"""`pn2code place`: where the bases of a cell's arms should stand."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pn2code.base.deadline import Deadline, TimeIsOverError
from pn2code.base.os_reason import os_reason
from pn2code.base.progress_line import Line
from pn2code.cli.nets import in_time, open_net, playing
from pn2code.cli.options import (
    OUTPUT_FLAGS,
    CellArgument,
    Exit,
    Format,
    FormatOption,
    InputOption,
    JsonOption,
    MaxSecondsOption,
    SetOption,
    finite,
    parse_values,
    print_diagnostics,
    stop,
)
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.claims import kept_apart
from pn2code.verify.exploring.limits import Limits, cores

if TYPE_CHECKING:
    from pn2code.geometry.placing.free import Free
    from pn2code.geometry.placing.look import Missed, Placed, Tried
    from pn2code.geometry.placing.proving import Proof
    from pn2code.geometry.placing.search import Candidate
    from pn2code.run.record import RunRecord

EPILOG = """Examples:

  pn2code place examples/riveting --layout paper --free robot2.base.x,y,z,yaw

  pn2code place examples/tending --free arm1.base.x=-0.2:0.2,y --goal clearance -o placed
"""
MOST_MISSED = 8
"""Poses that are listed."""


class GoalChoice(StrEnum):
    """What shall be as good as it can be."""

    CONDITION = "condition"
    LIMIT = "limit"
    CLEARANCE = "clearance"
    TIME = "time"


def place(
    cell: CellArgument,
    free: Annotated[
        list[str],
        typer.Option(
            "--free",
            metavar="ROBOT.base.KEY[=LOW:HIGH],...",
            help="What may be changed: x, y, z (m), roll, pitch, yaw (degrees) of the base of a robot, each between "
            "two bounds. This option may be given several times.",
        ),
    ],
    layout: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="The layout from which it starts.  (default: the first)"),
    ] = None,
    goal: Annotated[
        GoalChoice,
        typer.Option(
            help="What shall be as good as it can be: the worst condition number, the least margin of a limit, the "
            "least clearance, or how long all moves together take."
        ),
    ] = GoalChoice.CONDITION,
    around: Annotated[
        float,
        typer.Option(
            metavar="M",
            min=0.01,
            max=100.0,
            help="Metres to each side of where a base stands, for x, y and z without bounds.",
        ),
    ] = 1.0,
    condition: Annotated[
        float | None,
        typer.Option(
            metavar="C",
            min=1.0,
            callback=finite,
            help="No condition number may be worse than this.",
        ),
    ] = None,
    limit: Annotated[
        float,
        typer.Option(
            metavar="DEGREES", min=0.0, max=180.0, help="No axis may come nearer to its limit."
        ),
    ] = 3.0,
    clearance: Annotated[
        float,
        typer.Option(
            metavar="MM",
            min=0.0,
            max=450.0,
            help="No arm may come nearer to what stands than so far.",
        ),
    ] = 5.0,
    seed: Annotated[int, typer.Option(metavar="K", min=0, help="The seed of the search.")] = 1,
    generations: Annotated[
        int, typer.Option(metavar="N", min=1, max=10_000, help="How long to search, at most.")
    ] = 50,
    tries: Annotated[
        int,
        typer.Option(
            metavar="N", min=1, max=100, help="How many placings are looked at as a whole, at most."
        ),
    ] = 6,
    run: Annotated[
        bool, typer.Option("--run/--no-run", help="Run the cell in the placing that is chosen.")
    ] = True,
    out: Annotated[
        Path,
        typer.Option(*OUTPUT_FLAGS, metavar="DIR", help="Where the layout, picture and table go."),
    ] = Path("place"),
    as_json: JsonOption = False,
    inputs: InputOption = None,
    max_seconds: MaxSecondsOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    form: FormatOption = Format.FULL,
) -> None:
    """Search a better place for the bases of arms, and prove that it is one.

    What is found is looked at as `check --geometry` does, over all states of the cell, and in a run. It is written as
    a layout for cell.toml, which is not changed.
    """
    from pn2code.geometry.placing.free import FreeError
    from pn2code.geometry.placing.look import Request, look
    from pn2code.geometry.placing.search import Wish

    wish = Wish(
        goal.value,
        math.inf if condition is None else condition,
        math.radians(limit),
        clearance / 1000.0,
    )
    request = Request(tuple(free), layout, around, wish, seed, generations, tries)
    values = parse_values(settings)
    d = Diagnostics()
    late = "anything was found"
    with in_time(max_seconds, cell, late, form):
        _expect_known(free, cell)
        opened = open_net(cell, values, form, warnings=d, inputs=inputs)
    deadline = Deadline.of_command(max_seconds)
    line = Line(shown=not as_json, plain=True, first="reading the cell ...")
    record: RunRecord | None = None
    d_run = Diagnostics()
    try:
        with in_time(None, cell, late, form), playing(form), line as progress:
            limits = Limits(deadline=deadline, threads=cores())
            found = look(opened, request, limits, out, d, progress.stage)
            if found is not None and not d.has_errors and found.chosen is not None and run:
                progress.stage("running the cell ...")
                try:
                    with deadline.enforced():
                        record = _ran(cell, found.chosen, layout, values, inputs, out, d_run)
                except TimeIsOverError:
                    found = replace(found, unfinished=_and(found.unfinished, "it was not run"))
        if found is None or d.has_errors:
            stop(d, form)
        files = _written(found, out)
    except FreeError as problem:
        raise typer.BadParameter(str(problem), param_hint="--free") from None
    except OSError as problem:
        raise typer.BadParameter(
            f"cannot write into `{out}`: {os_reason(problem)}", param_hint="--out"
        ) from None
    print_diagnostics(d.sorted(), form)
    if as_json:
        typer.echo(json.dumps(_row(found, record, files), indent=1))
    else:
        typer.echo("\n".join(_text(found, record, run=run, files=files)))
    if d_run.has_errors:
        print_diagnostics(d_run.sorted(), form)
    raise typer.Exit(_code(found, record, d_run))


def _expect_known(free: list[str], path: Path) -> None:
    """Refuses a robot or key that there is not, before the net is read; of a cell that is wrong `open_net` tells."""
    from pn2code.cell.load import load
    from pn2code.geometry.placing.free import FreeError, expect_known

    config = load(path, Diagnostics()) if path.is_dir() or path.suffix == ".toml" else None
    if config is None:
        return
    try:
        expect_known(free, [r.name for r in config.robots])
    except FreeError as problem:
        raise typer.BadParameter(str(problem), param_hint="--free") from None


def _code(found: Placed, record: RunRecord | None, d: Diagnostics) -> int:
    """0: proved (and it ran); 1: there is none, or the run failed; 3: not known."""
    if found.chosen is None:
        unknown = bool(found.unfinished) or any(t.proof.answer == "unknown" for t in found.tried)
        return Exit.INCONCLUSIVE if unknown else Exit.MODEL
    if record is not None and record.verdict != "finished":
        return Exit.MODEL
    return Exit.MODEL if d.has_errors else Exit.OK


def _ran(
    path: Path,
    chosen: Tried,
    layout: str | None,
    values: dict[str, str],
    inputs: Path | None,
    out: Path,
    d: Diagnostics,
) -> RunRecord | None:
    from pn2code.run.placed import run_placed
    from pn2code.run.prepare import RunOptions

    # Unchecked: in the layout of cell.toml arms may stand where they cannot do their work, which is why this was asked.
    options = RunOptions(
        out=out / "run", layout=layout, input=inputs, values=values, looks=False, checked=False
    )
    return run_placed(path, chosen.cell, options, d)


def _and(before: str, more: str) -> str:
    return f"{before}, and {more}" if before else more


# --- files -------------------------------------------------------------------------------------------


def _written(found: Placed, out: Path) -> list[Path]:
    """The layout, the front as a picture and as a table; those of an earlier search do not stay."""
    from pn2code.geometry.placing.layout import layout_text
    from pn2code.geometry.placing.picture import draw

    out.mkdir(parents=True, exist_ok=True)
    names = [out / name for name in ("layout.toml", "front.png", "front.tsv")]
    for name in names:
        name.unlink(missing_ok=True)
    layout, picture, table = names
    files = []
    front = found.found.front
    if found.chosen is not None:
        layout.write_text(layout_text(found), encoding="utf-8")
        files.append(layout)
    if front:
        chosen = found.chosen.candidate if found.chosen is not None else None
        draw(front, found.found.here, chosen, picture)
        heads = [f"{f.robot}.{f.key}" for f in found.free]
        lines = ["\t".join([*heads, "condition", "limit_deg", "clearance_mm", "seconds"])]
        for c in front:
            own = (c.condition, math.degrees(c.limit), 1000.0 * c.clearance, c.seconds)
            lines.append("\t".join(f"{v:g}" for v in (*c.values, *(round(v, 3) for v in own))))
        table.write_text("\n".join(lines) + "\n", encoding="utf-8")
        files += [picture, table]
    return files


# --- words -------------------------------------------------------------------------------------------


def _text(
    found: Placed, record: RunRecord | None, *, run: bool, files: Sequence[Path]
) -> Iterator[str]:
    f = found.found
    yield f"{f.looked:,} placings looked at; {len(f.ranked):,} reach everything, touch nothing and are as wished"
    yield from _table(found)
    if found.unfinished:
        yield f"  unfinished, the time was up: {found.unfinished} (`--max-seconds`)"
    if found.open:
        yield f"  the arms may have more to do: {found.open}"
    if found.regardless:
        yield "NO: this does not depend on what may be moved, so nothing was searched:"
        yield f"    {found.regardless}"
        return
    if not f.ranked:
        if found.unfinished:
            yield "NOT KNOWN: nothing was found in that time from which everything is reached as wished"
        else:
            yield from _none(found)
        return
    for tried in found.tried:
        where = _where(found.free, tried.candidate)
        if tried.proof.meets:
            yield f"  proved for {where}:"
            yield "    each move can be done from wherever the arm can be then, without touching what stands or itself"
            yield f"    {kept_apart(devices=bool(found.cell.devices))}"
            yield f"    on the whole way: {_whole(tried.proof)}"
            continue
        holds = "not known" if tried.proof.answer == "unknown" else "does not hold"
        yield f"  {holds}, {where}: {tried.proof.trouble}"
        if math.isfinite(tried.proof.condition):
            yield f"    on the whole way: {_whole(tried.proof)}"
    if found.chosen is None:
        is_open = any(t.proof.answer == "unknown" for t in found.tried)
        answer = (
            "NOT KNOWN: none of these is proved"
            if is_open
            else "NO: none of these holds on the whole way"
        )
        more = "give it more time" if found.unfinished else "wish for more (`--clearance`)"
        yield f"{answer}; {more}, or look at more (`--tries`)"
    elif record is not None:
        why = f": {record.reason}" if record.reason else ""
        yield f"  ran in PyBullet: {record.verdict} after {record.time:.1f} s of the cell{why}"
    elif run:
        yield "  it could not be run (see below)"
    for path in files:
        yield f"  {path}"


def _table(found: Placed) -> Iterator[str]:
    rows = [("as it stands", found.found.here)]
    if found.found.ranked:
        rows.append(("best found", found.found.ranked[0]))
    if found.chosen is not None and found.chosen.candidate is not found.found.ranked[0]:
        rows.append(("chosen", found.chosen.candidate))
    for label, c in rows:
        yield f"  {label}: {_where(found.free, c)}"
        took = f", all moves {c.seconds:.1f} s" if c.is_walked and c.done >= 1.0 else ""
        yield f"    {100.0 * c.reach:.0f} % reached, {_figures(c.condition, c.limit, c.clearance)}{took}"


def _where(free: Sequence[Free], c: Candidate) -> str:
    """The numbers, by robot."""
    by_robot: dict[str, list[str]] = {}
    for f, v in zip(free, c.values, strict=True):
        by_robot.setdefault(f.robot, []).append(f"{f.key} {v:g}")
    return "; ".join(f"{robot} {', '.join(parts)}" for robot, parts in by_robot.items())


def _figures(condition: float, limit: float, clearance: float) -> str:
    worst = f"{condition:.1f}" if math.isfinite(condition) else "-"
    margin = f"{math.degrees(limit):.1f} deg" if math.isfinite(limit) else "-"
    apart = f"{1000.0 * clearance:.0f} mm" if math.isfinite(clearance) else "not measured"
    return f"worst condition {worst}, least margin of a limit {margin}, clearance {apart}"


def _whole(proof: Proof) -> str:
    """What is certain, not what was measured somewhere."""
    figures = _figures(proof.condition, proof.limit, proof.clearance)
    return (
        figures.replace("clearance ", "clearance at least ", 1)
        if math.isfinite(proof.clearance)
        else figures
    )


def _none(found: Placed) -> Iterator[str]:
    nearest = found.found.nearest
    where = _where(found.free, nearest)
    if found.missed:
        yield f"NO: no placing was found from which everything is reached; most is from {where}"
        for missed in found.missed[:MOST_MISSED]:
            yield f"    {_missed(missed)}"
        if len(found.missed) > MOST_MISSED:
            yield f"    and {len(found.missed) - MOST_MISSED} more"
        return
    yield f"NO: everything is reached, from {where} for instance, but never as wished and without touching anything"


def _missed(missed: Missed) -> str:
    where = "not from there" if missed.anywhere else "from none of the placings"
    return f"{missed.robot}, {missed.command} (to {missed.pose}): {where}"


# --- for programs ------------------------------------------------------------------------------------


def _row(found: Placed, record: RunRecord | None, files: Sequence[Path]) -> dict[str, Any]:
    chosen = found.chosen
    return {
        "layout": found.layout or None,
        "free": [
            {"robot": f.robot, "key": f.key, "low": f.low, "high": f.high} for f in found.free
        ],
        "looked": found.found.looked,
        "meeting": len(found.found.ranked),
        "here": _candidate(found.free, found.found.here),
        "best": _candidate(found.free, found.found.ranked[0]) if found.found.ranked else None,
        "tried": [
            {
                **_candidate(found.free, t.candidate),
                "answer": t.proof.answer,
                "holds": t.proof.meets,
                "trouble": t.proof.trouble or None,
                "whole_condition": _finite(t.proof.condition),
                "whole_limit_deg": _finite(math.degrees(t.proof.limit)),
                "whole_clearance_m": _finite(t.proof.clearance),
            }
            for t in found.tried
        ],
        "chosen": _candidate(found.free, chosen.candidate) if chosen is not None else None,
        "missed": [
            {"robot": m.robot, "command": m.command, "pose": m.pose, "anywhere": m.anywhere}
            for m in found.missed
        ],
        "open": found.open or None,
        "unfinished": found.unfinished or None,
        "regardless": found.regardless or None,
        "run": None
        if record is None
        else {"verdict": record.verdict, "reason": record.reason or None, "time_s": record.time},
        "files": [str(f) for f in files],
    }


def _candidate(free: Sequence[Free], c: Candidate) -> dict[str, Any]:
    bases: dict[str, dict[str, float]] = {}
    for f, v in zip(free, c.values, strict=True):
        bases.setdefault(f.robot, {})[f.key] = v
    return {
        "bases": bases,
        "reach": round(c.reach, 4),
        "condition": _finite(c.condition),
        "limit_deg": _finite(math.degrees(c.limit)),
        "clearance_m": _finite(c.clearance),
        "seconds": _finite(c.seconds) if c.done >= 1.0 else None,
    }


def _finite(value: float) -> float | None:
    return round(value, 5) if math.isfinite(value) else None
