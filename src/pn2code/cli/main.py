"""The command `pn2code`: one verb a module, collected here."""

from __future__ import annotations

import atexit
import errno
import gc
import importlib
import inspect
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from types import FrameType
from typing import Annotated, Any, NoReturn

import typer
from typer.core import TyperCommand, TyperGroup

import pn2code
from pn2code.cli import light_help
from pn2code.cli.options import Exit

VERBS = {
    "init": "Make a folder with a cell that runs at once, to begin with.",
    "check": "Check the syntax, types, bindings and hierarchy of a net, and the cell beside it.",
    "marking": "Print the initial marking of each place in the form of CPN Tools.",
    "enabled": "Print the binding elements that are enabled in the initial marking.",
    "simulate": "Simulate a net: choose an enabled binding element at random, let it occur, and repeat this.",
    "play": "Play the token game of a net in a browser: on a page of this machine, for this machine only.",
    "replay": "Repeat a recorded run, and check that each step is enabled when its turn comes.",
    "verify": "Explore the whole state space of a net, and report its properties.",
    "reach": "Map where the bases of arms could stand: what each reaches of all that the net makes it do, and how.",
    "place": "Search a better place for the bases of arms, and prove that it is one.",
    "time": "Measure each command from wherever the arm can be then, and the best and worst cycle over all runs.",
    "structure": "Compute invariants, siphons, traps, bounds and classes of a net from its structure alone.",
    "conform": "Compare the compiled net, the supervisor and each robot program with the net, state by state.",
    "generate": "Generate a C supervisor and, if there is a cell.toml, a script for each robot.",
    "run": "Run a cell: build the supervisor, run it together with the robots' programs, and report.",
    "robot": "Run one robot's script in real time, as a process of its own.",
    "watch": "Watch a cell that runs elsewhere: its state, messages, marking and arms, in a page of this machine.",
    "show": "Write a run as one HTML page that shows the net, the arms, the messages and the time together.",
    "report": "Check, draw, verify, generate, compare and run a cell, and write a report of all of it.",
    "draw": "Draw the pages of a net. Elements with errors are red.",
    "convert": "Convert a net to PNML, to a Promela model for SPIN, to text, or to a net of CPN Tools.",
    "contest": "Answer an examination of the Model Checking Contest, in its own words.",
    "cell": "Print what a cell.toml may say: all sections and keys, or a JSON Schema of them.",
    "dump": "Print the net as it is after a stage of the pipeline.",
    "explain": "Explain a diagnostic code.",
}
"""What each verb does, in a sentence: the list of verbs is printed without loading them."""


_FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})
"""A disk that takes no more, seen where nobody expects it: on the standard output."""


class _Verbs(TyperGroup):
    """Loads a verb's module when it is asked for: `check` need not wait for what only `run` needs."""

    _is_listing = False

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """The list of verbs."""
        light_help.load()
        with self._listing():
            super().format_help(ctx, formatter)

    def shell_complete(self, ctx: Any, incomplete: str) -> Any:
        """The verbs that begin so."""
        with self._listing():
            return super().shell_complete(ctx, incomplete)

    @contextmanager
    def _listing(self) -> Iterator[None]:
        """While the block lasts only names and sentences are wanted, for which no verb is loaded."""
        self._is_listing = True
        try:
            yield
        finally:
            self._is_listing = False

    def list_commands(self, ctx: Any) -> list[str]:
        return list(VERBS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        if cmd_name in VERBS:
            return _named(cmd_name) if self._is_listing else _command(cmd_name)
        self.commands.update({verb: _named(verb) for verb in VERBS})  # for "did you mean"
        return None


class _Verb(TyperCommand):
    """One verb."""

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Its options."""
        light_help.load()
        super().format_help(ctx, formatter)


def _named(verb: str) -> Any:
    """A verb as it stands in the list."""
    return TyperCommand(verb, help=VERBS[verb])


def _command(verb: str) -> Any:
    module = importlib.import_module(f"pn2code.cli.{verb}")
    return _made(verb, getattr(module, verb), module.EPILOG)


@cache
def _made(verb: str, function: Callable[..., None], epilog: str) -> Any:
    """The command of a function. Its annotations are evaluated once in a process, however often it is called."""
    single = typer.Typer(add_completion=False)
    decorated = single.command(
        verb, cls=_Verb, help=_flowing(function.__doc__ or ""), epilog=epilog
    )
    decorated(function)
    return typer.main.get_command(single)


def _flowing(text: str) -> str:
    """Each paragraph on one line: it is the terminal's width that breaks the lines of a help text."""
    paragraphs = inspect.cleandoc(text).split("\n\n")
    return "\n\n".join(" ".join(paragraph.split()) for paragraph in paragraphs)


app = typer.Typer(
    name="pn2code",
    cls=_Verbs,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


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
    """SIGINT or SIGTERM; not KeyboardInterrupt, which the command-line library turns into exit code 1."""


def _interrupt(_signal: int, _frame: FrameType | None) -> NoReturn:
    raise Interrupted


def main() -> NoReturn:
    """Entry point: runs a verb and ends the process."""
    try:
        play()
    except SystemExit as left:
        _leave(left.code)


def _leave(code: str | int | None) -> NoReturn:
    """End the process at once.

    Python would first free the net object by object, which takes a fifth of the time of checking a large one.
    """
    # "threading" first waits for other threads; a text as exit code is printed: Python does both. Daemons are left
    # alone: Python would end them where they ask for its lock, and libraries in C++ that are left so abort the process.
    others = [t for t in threading.enumerate() if t is not threading.main_thread()]
    if isinstance(code, str) or not all(t.daemon for t in others):
        sys.exit(code)
    atexit._run_exitfuncs()
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except BrokenPipeError:
        os._exit(code or Exit.UNREAD)  # what was found out is said by the code
    except (OSError, ValueError):
        sys.exit(code)  # says so
    os._exit(code or 0)


def _unread() -> None:
    """The reader of our output has gone (`pn2code ... | head`): nothing more can be said."""
    sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115, PTH123 - it stays open
    os.dup2(sys.stdout.fileno(), 1)


def play() -> NoReturn:
    """Run a verb, turn bugs into a readable message and exit code 70.

    Raises:
        SystemExit: always.
    """
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupt)
    if signal.getsignal(signal.SIGHUP) == signal.SIG_DFL:  # else: `nohup`
        signal.signal(signal.SIGHUP, _interrupt)
    # Nets are trees: the search for cycles finds nothing, and took a third of the time of checking a large one. At
    # 500,000 instead of 50,000 objects `check` takes 8 % less time and 1 to 3 % more memory.
    gc.set_threshold(500_000, 20, 20)
    # Accepted expressions nest up to some 250 levels, each worth several Python frames.
    sys.setrecursionlimit(max(20_000, sys.getrecursionlimit()))
    try:
        app()
    except Interrupted:
        typer.echo("pn2code: interrupted", err=True)
        sys.exit(130)
    except BrokenPipeError:
        _unread()
        sys.exit(Exit.UNREAD)
    except SystemExit as left:
        # The command-line library makes exit code 1 of it, which would say that the model is wrong.
        if not isinstance(left.__context__, BrokenPipeError):
            raise
        _unread()
        sys.exit(Exit.UNREAD)
    except Exception as problem:
        if isinstance(problem, OSError) and problem.errno in _FULL:
            where = f" `{problem.filename}`" if problem.filename else ""
            typer.echo(
                f"pn2code: cannot write{where}: {os.strerror(problem.errno).lower()}", err=True
            )
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            sys.exit(Exit.USAGE)
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
