"""`pn2code init`: a cell to begin with."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pn2code.cli.options import Exit, Format, FormatOption, stop
from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.suggestions import did_you_mean

EPILOG = """Examples:

  pn2code init press

  pn2code init press --template palletiser

  pn2code init --list
"""


def init(
    folder: Annotated[
        Path | None,
        typer.Argument(metavar="DIR", help="The folder to make. It may exist, if it is empty."),
    ] = None,
    template: Annotated[
        str, typer.Option(metavar="NAME", help="The cell to begin with. Without it: minimal.")
    ] = "",
    is_listing: Annotated[
        bool, typer.Option("--list", help="Print the templates, and what their cells do.")
    ] = False,
    form: FormatOption = Format.FULL,
) -> None:
    """Make a folder with a cell that runs at once, to begin with.

    It gets a net for CPN Tools, a cell.toml with comments, a schema for editors, and a README.
    """
    from pn2code.new_cell.catalogue import templates

    known = {t.name: t for t in templates()}
    if is_listing:
        if folder is not None or template:
            raise typer.BadParameter("it makes no folder", param_hint="--list")
        width = max(map(len, known))
        for t in known.values():
            typer.echo(f"{t.name:<{width}}  {t.says}")
        return
    if folder is None:
        raise typer.BadParameter("give the folder to make", param_hint="DIR")
    name = template or next(iter(known))
    if name not in known:
        hint = did_you_mean(name, known, f"known are {', '.join(known)}")
        raise typer.BadParameter(f"there is no template `{name}`; {hint}", param_hint="--template")
    from pn2code.new_cell.contents import contents
    from pn2code.new_cell.writing import why_unwritable, write

    why = why_unwritable(folder)
    if why:
        _refuse(folder, why)
    d = Diagnostics()
    files = contents(known[name], folder.resolve().name, d)
    if files is None:
        stop(d, form)
    try:
        write(folder, files)
    except OSError as problem:
        _refuse(folder, (problem.strerror or str(problem)).lower())
    for file in sorted(files):
        typer.echo(f"wrote {folder / file}")
    typer.echo(f"\nNext: pn2code check {folder}\n{folder / 'README.md'} says what comes then.")


def _refuse(folder: Path, why: str) -> None:
    typer.echo(
        f"pn2code: cannot begin a cell in `{folder}`: {why}; give a folder that is new or empty",
        err=True,
    )
    raise typer.Exit(Exit.USAGE)
