"""`pn2code check --geometry`: what is asked, and how the answers are printed."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from pn2code.base.deadline import Deadline
from pn2code.base.os_reason import os_reason
from pn2code.base.progress_line import Line
from pn2code.base.so_far import SoFar
from pn2code.cli.nets import in_time, open_net, playing
from pn2code.cli.options import Exit, Format, print_diagnostics, stop
from pn2code.diagnostics import Diagnostics
from pn2code.verify.exploring.limits import Limits, cores

if TYPE_CHECKING:
    from pn2code.geometry.check import Geometry

_CODES = {"yes": Exit.OK, "no": Exit.MODEL, "unknown": Exit.INCONCLUSIVE}


def check_geometry(
    path: Path,
    values: dict[str, str],
    *,
    layout: str | None,
    traces: Path | None,
    pictures: bool,
    full: bool,
    as_json: bool,
    inputs: Path | None,
    int_bits: int,
    max_seconds: float | None,
    max_states: int | None,
    jobs: int | None,
    form: Format,
) -> None:
    """Looks at all moves and pairs of a cell, prints what is found, and leaves with its exit code."""
    from pn2code.geometry.check import examine
    from pn2code.geometry.report import text

    d = Diagnostics()
    late = "all moves and pairs were looked at"
    with in_time(max_seconds, path, late, form):
        opened = open_net(path, values, form, int_bits=int_bits, warnings=d, inputs=inputs)
    folder = traces or Path(f"{opened.flat.name}.geometry")
    is_new = not folder.exists()
    so_far = SoFar()
    deadline = Deadline.of_command(None)
    limits = Limits(max_states=max_states, deadline=deadline, threads=jobs or cores())
    line = Line(shown=not as_json, plain=True, first="reading the cell ...")
    until_then: list[Geometry] = []

    def done() -> str:
        return so_far.words(is_told=bool(until_then))

    def in_its_time() -> Geometry | None:
        with in_time(max_seconds, path, late, form, done), playing(form), line as progress:

            def stage(text: str) -> None:
                so_far.stage(text)
                progress.stage(text)

            def say(text: str) -> None:
                so_far.say(text)
                progress.say(text)

            return examine(opened, layout, limits, folder, d, stage, say, until_then.append)

    try:
        try:
            found = in_its_time()
        except typer.Exit:
            if not until_then:
                raise
            found = until_then[0]
        if found is None or d.has_errors:
            stop(d, form)
        if pictures:
            found = _drawn(found, folder)
    except OSError as problem:
        raise typer.BadParameter(
            f"cannot write into `{folder}`: {os_reason(problem)}", param_hint="--traces"
        ) from None
    finally:
        if is_new and folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()
    print_diagnostics(d.sorted(), form)
    if as_json:
        typer.echo(json.dumps({"file": opened.flat.file, **found.row()}, indent=1))
    elif found.why:
        typer.echo(f"not known: {found.why}")
    else:
        typer.echo(text([x for x, _ in found.layouts], full=full))
    if found.answer != "yes":
        raise typer.Exit(_CODES[found.answer])


def _drawn(found: Geometry, folder: Path) -> Geometry:
    from pn2code.geometry.pictures import draw

    layouts = []
    for layout, cell in found.layouts:
        stem = f"touch-{layout.name}" if layout.name else "touch"
        layouts.append((replace(layout, pairs=draw(cell, layout.pairs, folder, stem)), cell))
    return replace(found, layouts=tuple(layouts))
