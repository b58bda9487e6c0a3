"""What keeps a run from beginning, or from writing its results, is told, and is wrong usage."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import typer

from pn2code.base.os_reason import os_reason
from pn2code.cli.options import Exit
from pn2code.emission.write import OutputFolderError


@contextmanager
def trouble_told(out: Path) -> Iterator[None]:
    """Around all that runs a cell with its results in `out`."""
    from pn2code.robot.backend import BackendUnavailableError

    try:
        yield
    except (OutputFolderError, BackendUnavailableError) as problem:
        typer.echo(f"pn2code: {problem}", err=True)
        raise typer.Exit(Exit.USAGE) from None
    except OSError as problem:
        where = f" `{problem.filename}`" if problem.filename else f" `{out}`"
        typer.echo(f"pn2code: cannot work with{where}: {os_reason(problem)}", err=True)
        raise typer.Exit(Exit.USAGE) from None
