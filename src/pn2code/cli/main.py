"""The command `pn2code`: one verb a module, collected here."""

from __future__ import annotations

import os
import signal
import sys
from types import FrameType
from typing import Annotated, NoReturn

import typer

import pn2code
from pn2code.cli import check, dump, explain, generate, robot, run
from pn2code.cli.options import Exit

app = typer.Typer(
    name="pn2code",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

app.command(epilog=check.EPILOG)(check.check)
app.command(epilog=generate.EPILOG)(generate.generate)
app.command(epilog=run.EPILOG)(run.run)
app.command(epilog=robot.EPILOG)(robot.robot)
app.command(epilog=dump.EPILOG)(dump.dump)
app.command(epilog=explain.EPILOG)(explain.explain)


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"pn2code {pn2code.__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
    debug: Annotated[
        bool, typer.Option("--debug", help="Show Python tracebacks of internal errors.")
    ] = False,
) -> None:
    """From Coloured Petri nets of robot cells to verified C supervisors and robot programs."""
    if debug:
        os.environ["PN2CODE_DEBUG"] = "1"


class Interrupted(BaseException):
    """SIGINT; not KeyboardInterrupt, which the command-line library turns into exit code 1."""


def _interrupt(_signal: int, _frame: FrameType | None) -> NoReturn:
    raise Interrupted


def main() -> NoReturn:
    """Entry point: runs a verb, turns bugs into a readable message and exit code 70."""
    signal.signal(signal.SIGINT, _interrupt)
    # Accepted expressions nest up to some 250 levels, each worth several Python frames.
    sys.setrecursionlimit(max(20_000, sys.getrecursionlimit()))
    try:
        app()
    except Interrupted:
        typer.echo("pn2code: interrupted", err=True)
        sys.exit(130)
    except BrokenPipeError:
        # The reader of our output has gone (`pn2code ... | head`): nothing more can be said.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(Exit.OK)
    except Exception as problem:
        if os.environ.get("PN2CODE_DEBUG"):
            raise
        typer.echo(
            f"pn2code: internal error: {type(problem).__name__}: {problem}\n"
            "This is a bug in pn2code, not in your net. "
            "`pn2code --debug ...` shows where it happened.",
            err=True,
        )
        sys.exit(Exit.INTERNAL)
    sys.exit(Exit.OK)
