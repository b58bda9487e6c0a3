"""`pn2code reach`: where the bases of a cell's arms could stand."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pn2code.base.os_reason import os_reason
from pn2code.base.progress_line import Line, told
from pn2code.cli.nets import in_time, open_net, playing
from pn2code.cli.options import (
    OUTPUT_FLAGS,
    CellArgument,
    Format,
    FormatOption,
    InputOption,
    JsonOption,
    MaxSecondsOption,
    SetOption,
    parse_values,
    print_diagnostics,
    stop,
)
from pn2code.diagnostics import Diagnostics
from pn2code.verify.exploring.limits import Limits, cores

if TYPE_CHECKING:
    from pn2code.geometry.reach_look import Found
    from pn2code.geometry.reach_map import Map

EPILOG = """Examples:

  pn2code reach examples/riveting --layout paper --robot robot2

  pn2code reach examples/handover --around 0.5 --steps 21 --json
"""


def reach(
    cell: CellArgument,
    layout: Annotated[
        str | None, typer.Option(metavar="NAME", help="The layout.  (default: the first)")
    ] = None,
    robot: Annotated[
        str | None, typer.Option(metavar="NAME", help="Only this robot.  (default: all)")
    ] = None,
    around: Annotated[
        float,
        typer.Option(metavar="M", min=0.01, max=100.0, help="Metres to each side of its base."),
    ] = 1.0,
    steps: Annotated[
        int, typer.Option(metavar="N", min=2, max=1001, help="Bases along each side.")
    ] = 41,
    out: Annotated[
        Path,
        typer.Option(*OUTPUT_FLAGS, metavar="DIR", help="Where the pictures and tables go."),
    ] = Path("reach"),
    as_json: JsonOption = False,
    inputs: InputOption = None,
    max_seconds: MaxSecondsOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    form: FormatOption = Format.FULL,
) -> None:
    """Map where the bases of arms could stand: what each reaches of all that the net makes it do, and how.

    For each robot it writes a picture (NAME.reach.png) and a table (NAME.reach.tsv).
    """
    from pn2code.geometry.reach_look import Wanted, look

    d = Diagnostics()
    late = "all bases were looked at"
    with in_time(max_seconds, cell, late, form):
        opened = open_net(cell, parse_values(settings), form, warnings=d, inputs=inputs)
    line = Line(shown=not as_json, plain=True, first="reading the cell ...")
    with in_time(max_seconds, cell, late, form), playing(form), line as progress:
        limits = Limits(threads=cores())
        found = look(opened, Wanted(layout, robot, around, steps), limits, d, progress.stage)
    if found is None or d.has_errors:
        stop(d, form)
    try:
        out.mkdir(parents=True, exist_ok=True)
        with told("drawing the maps"):
            files = [_written(f, out) for f in found]
    except OSError as problem:
        raise typer.BadParameter(
            f"cannot write into `{out}`: {os_reason(problem)}", param_hint="--out"
        ) from None
    print_diagnostics(d.sorted(), form)
    if as_json:
        typer.echo(json.dumps([_row(f, x) for f, x in zip(found, files, strict=True)], indent=1))
        return
    for f, picture in zip(found, files, strict=True):
        typer.echo(_text(f, picture))


def _written(found: Found, out: Path) -> Path:
    from pn2code.geometry.map_picture import draw
    from pn2code.geometry.reach_map import rows

    name = found.robot.name
    picture = out / f"{name}.reach.png"
    draw(found.map, found.task, found.cell, name, picture)
    keys = ("x", "y", "reach", "condition", "limit_deg")
    lines = ["\t".join(keys)]
    lines += ["\t".join("" if r[k] is None else f"{r[k]:g}" for k in keys) for r in rows(found.map)]
    (out / f"{name}.reach.tsv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return picture


def _row(found: Found, picture: Path) -> dict[str, Any]:
    from pn2code.geometry.reach_map import rows

    best = found.map.best
    table = rows(found.map)
    return {
        "robot": found.robot.name,
        "poses": len(found.task.poses),
        "moves": len(found.task.groups),
        "open": found.open or None,
        "here": rows(found.here)[0],
        "best": table[best] if best is not None else None,
        "bases": table,
        "picture": str(picture),
    }


def _text(found: Found, picture: Path) -> str:
    count, whole = len(found.map.bases), int((found.map.reach >= 1.0).sum())
    lines = [
        f"{found.robot.name}: {len(found.task.groups):,} moves, {count:,} bases; {whole:,} reach everything",
        f"  where it stands: {_words(found.here, 0)}",
    ]
    best = found.map.best
    if best is not None:
        lines.append(f"  best conditioned: {_words(found.map, best)}")
    if found.open:
        lines.append(f"  there may be more moves: {found.open}")
    lines.append(f"  picture: {picture}, table: {picture.with_suffix('.tsv')}")
    return "\n".join(lines)


def _words(found: Map, i: int) -> str:
    x, y = found.bases[i]
    condition = found.condition[i]
    shown = f"{condition:.1f}" if math.isfinite(condition) else "-"
    limit = found.limit[i]
    degrees = f"{math.degrees(limit):.1f} deg" if math.isfinite(limit) else "-"
    return (
        f"x {x:.3f}, y {y:.3f}: {100.0 * found.reach[i]:.0f} % reached, worst condition {shown}, "
        f"least margin of a limit {degrees}"
    )
