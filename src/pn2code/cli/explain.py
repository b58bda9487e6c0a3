"""`pn2code explain CODE`: what a diagnostic means and what to do."""

from __future__ import annotations

import difflib
import textwrap
from typing import Annotated

import typer

from pn2code.cli.options import Exit
from pn2code.diagnostics.codes import all_codes

EPILOG = """Examples:

  pn2code explain channel-direction

  pn2code explain            (lists all codes)
"""


def explain(
    code: Annotated[str, typer.Argument(help="A diagnostic code; none: list them all.")] = "",
) -> None:
    """Explain a diagnostic code."""
    known = {c.code: c for c in all_codes()}
    if not code:
        for entry in known.values():
            typer.echo(f"{entry.code:32} {entry.title}")
        return
    if code not in known:
        near = difflib.get_close_matches(code, known, n=1)
        hint = f"; did you mean `{near[0]}`?" if near else "; `pn2code explain` lists all codes"
        typer.echo(f"pn2code: no diagnostic has the code `{code}`{hint}", err=True)
        raise typer.Exit(Exit.USAGE)
    entry = known[code]
    typer.echo(f"{entry.code}: {entry.title}\n")
    typer.echo(textwrap.fill(entry.explanation, 88))
