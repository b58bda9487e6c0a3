"""`pn2code cell`: what a cell.toml may say, for people and for editors."""

from __future__ import annotations

from typing import Annotated

import typer

from pn2code.cell_file.json_schema import FILE_NAME, HEAD
from pn2code.cli.options import Exit

EPILOG = f"""Examples:

  pn2code cell --keys

  pn2code cell --keys --section primitives

  pn2code cell --schema > {FILE_NAME}

Editors that know TOML complete and check a cell.toml beside this file that begins with `{HEAD.strip()}`.
"""


def cell(
    keys: Annotated[
        bool, typer.Option("--keys", help="Print all sections and keys, with defaults and units.")
    ] = False,
    section: Annotated[
        str,
        typer.Option(metavar="TEXT", help="With --keys: only sections whose title contains TEXT."),
    ] = "",
    schema: Annotated[
        bool, typer.Option("--schema", help="Print a JSON Schema of cell.toml, for editors.")
    ] = False,
) -> None:
    """Print what a cell.toml may say: all sections and keys, or a JSON Schema of them."""
    from pn2code.cell_file import json_schema, listing

    if keys == schema:
        raise typer.BadParameter("give one of them", param_hint="--keys, --schema")
    if schema:
        if section:
            raise typer.BadParameter("it belongs to --keys", param_hint="--section")
        typer.echo(json_schema.text(), nl=False)
        return
    text = listing.text(section)
    if not text:
        known = ", ".join(s.title for s in listing.sections())
        typer.echo(f"pn2code: no section contains `{section}`; sections are {known}", err=True)
        raise typer.Exit(Exit.USAGE)
    typer.echo(text.rstrip("\n"))
