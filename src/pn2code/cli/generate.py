"""`pn2code generate`: a net, or a cell, to C and robot scripts."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, NoReturn

import typer

from pn2code import pipeline
from pn2code.base.kept_answers import KeptAnswers
from pn2code.base.progress_line import told
from pn2code.cli.nets import in_time
from pn2code.cli.options import (
    OUTPUT_FLAGS,
    Exit,
    Format,
    FormatOption,
    InputOption,
    MaxSecondsOption,
    NetArgument,
    SetOption,
    UncheckedOption,
    parse_values,
    print_but_known,
    stop,
)
from pn2code.conform.folder import intruding
from pn2code.diagnostics import Diagnostics
from pn2code.emission.write import OutputFolderError, expect_writable, write

EPILOG = """Examples:

  pn2code generate examples/riveting/cell.cpn -o generated/riveting

  pn2code generate examples/riveting --unchecked -o draft

  pn2code generate mynet.cpn && make -C generated/mynet && generated/mynet/supervisor
"""


def generate(
    net: NetArgument,
    output: Annotated[
        Path | None,
        typer.Option(*OUTPUT_FLAGS, help="The output folder (default: generated/<net>)."),
    ] = None,
    check: Annotated[
        bool,
        typer.Option(
            "--check",
            help="Write nothing, and exit with code 1 if a file would change, or one is there that `make` would take.",
        ),
    ] = False,
    unchecked: UncheckedOption = False,
    inputs: InputOption = None,
    max_seconds: MaxSecondsOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    form: FormatOption = Format.FULL,
) -> None:
    """Generate a C supervisor and, if there is a cell.toml, a script for each robot.

    `make && ./supervisor` in the output folder builds and runs the supervisor. The supervisor of a cell is checked
    first. It is not generated if it does not keep to its execution scheme, or if nothing proves how many tokens a place
    can hold.
    """
    d = Diagnostics()
    if output is not None and not check:
        _expect_writable(output)
    late = "the programs were generated, so nothing was written"
    with in_time(max_seconds, net, late, form), told("reading the net") as line:
        result = pipeline.generate(
            net,
            d,
            values=parse_values(settings),
            checked=not unchecked,
            inputs=inputs,
            kept=KeptAnswers.of_user(),
            stage=line.turn_to,
        )
    if result is None:
        stop(d, form)
    print_but_known(d, net, form)
    folder = output or Path("generated") / result.partition.net.name
    try:
        written = write(folder, result.files, check=check)
    except OutputFolderError as problem:
        _stop(problem)
    changed = len(written.changed) + len(written.removed)
    total = len(result.files)
    word = "would change" if check else "changed"
    typer.echo(f"{folder}: {total} files, {changed} {word}, digest {result.digest[:8]}")
    strange = intruding(folder, result.files)
    if check:
        for path in (*written.changed, *written.removed):
            typer.echo(f"  {path}")
    for path in strange:
        typer.echo(
            f"  {path} is not generated, and `make` would take it for a part of the programs"
        )
    if check and (changed or strange):
        raise typer.Exit(Exit.MODEL)


def _expect_writable(folder: Path) -> None:
    try:
        expect_writable(folder)
    except OutputFolderError as problem:
        _stop(problem)


def _stop(problem: OutputFolderError) -> NoReturn:
    typer.echo(f"pn2code: {problem}", err=True)
    raise typer.Exit(Exit.USAGE) from None
