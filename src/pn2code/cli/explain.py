"""`pn2code explain CODE`: what a diagnostic means and what to do."""

from __future__ import annotations

import importlib
import textwrap
from typing import Annotated

import typer

from pn2code.cli.options import Exit
from pn2code.diagnostics.codes import all_codes
from pn2code.diagnostics.suggestions import did_you_mean

EPILOG = """Examples:

  pn2code explain channel-direction

  pn2code explain            (lists all codes)
"""


REGISTERING = (
    "pn2code.cell.codes",
    "pn2code.cli.robot",
    "pn2code.cli.play",
    "pn2code.cli.show",
    "pn2code.conform.codes",
    "pn2code.convert.codes",
    "pn2code.drawing.codes",
    "pn2code.geometry.codes",
    "pn2code.timing.codes",
    "pn2code.lowering.codes",
    "pn2code.robot_scripts.codes",
    "pn2code.ml.codes",
    "pn2code.monitors.codes",
    "pn2code.net.codes",
    "pn2code.pnml.codes",
    "pn2code.text_form.codes",
    "pn2code.reading.codes",
    "pn2code.robot.codes",
    "pn2code.run.codes",
    "pn2code.semantics.codes",
    "pn2code.simulate.codes",
    "pn2code.tdl.codes",
    "pn2code.toolchain.build",
    "pn2code.toolchain.programs",
    "pn2code.unfold.codes",
    "pn2code.properties.codes",
    "pn2code.verify.codes",
)
"""The modules that declare codes; a verb loads some of them only."""


def explain(
    code: Annotated[
        str, typer.Argument(help="A diagnostic code. Without it, all codes are listed.")
    ] = "",
) -> None:
    """Explain a diagnostic code."""
    for module in REGISTERING:
        importlib.import_module(module)
    known = {c.code: c for c in all_codes()}
    if not code:
        for entry in known.values():
            typer.echo(f"{entry.code:32} {entry.title}")
        return
    if code not in known:
        hint = did_you_mean(code, known, "`pn2code explain` lists all codes")
        typer.echo(f"pn2code: no diagnostic has the code `{code}`; {hint}", err=True)
        raise typer.Exit(Exit.USAGE)
    entry = known[code]
    typer.echo(f"{entry.code}: {entry.title}\n")
    typer.echo(textwrap.fill(entry.explanation, 88))
