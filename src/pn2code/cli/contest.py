"""`pn2code contest`: the examinations of the Model Checking Contest."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import suppress
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from pn2code.base.deadline import Deadline, TimeIsOverError
from pn2code.cli.options import Exit, Format, print_diagnostics, seconds_option, stop
from pn2code.contest import ptnet
from pn2code.contest.engine import Space, engine
from pn2code.contest.examinations import ALL, SPACE, Asked, asked
from pn2code.contest.formulas import FormulaError
from pn2code.contest.portfolio import METHODS, answers, space
from pn2code.contest.tables import Tables
from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.game.token_game import GameError
from pn2code.unfold.codes import UNFOLDING_FAULT
from pn2code.unfold.plain import plain
from pn2code.unfold.unfold import unfold

EPILOG = """Examples:

  pn2code contest Philosophers-PT-000005 ReachabilityFireability

  pn2code contest Philosophers-PT-000005 StateSpace --max-seconds 300

The folder holds `model.pnml` and the XML files of the examinations (docs/contest.md).
"""
Examination = StrEnum("Examination", {name: name for name in ALL})  # type: ignore[misc]
Method = StrEnum("Method", {name: name for name in METHODS})  # type: ignore[misc]
UNKNOWN = "CANNOT_COMPUTE"


def contest(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="The folder of an input.")],
    examination: Annotated[Examination, typer.Argument(help="What is asked.")],
    max_seconds: Annotated[float, seconds_option("Stop after S seconds.")] = 60.0,
    memory: Annotated[
        int, typer.Option(metavar="MIB", min=16, help="The most memory for all methods.")
    ] = 8192,
    only: Annotated[Method | None, typer.Option(help="Use this method alone.")] = None,
) -> None:
    """Answer an examination of the Model Checking Contest, in its own words.

    `CANNOT_COMPUTE` stands for what is not known when the time is over. The exit code is 0, and 1 if the input is
    wrong.
    """
    sys.set_int_max_str_digits(0)  # numbers of markings may be longer than Python allows
    deadline = Deadline.of_command(max_seconds)
    found = None
    try:
        with suppress(TimeIsOverError), deadline.enforced():
            found = _read(folder, examination)
    except FormulaError as error:
        typer.echo(f"pn2code: {error}", err=True)
        raise typer.Exit(Exit.MODEL) from None
    except GameError as problem:  # more tokens than are made
        typer.echo(f"pn2code: the initial marking cannot be made: {problem.message}", err=True)
    if found is None:
        typer.echo(UNKNOWN)
        return
    tables, questions = found
    d = Diagnostics()
    with engine(d) as program:
        if program is None:
            stop(d, Format.FULL)
        left = max(0.0, deadline.left or 0.0)
        if examination == SPACE:
            sizes = space(program, tables, seconds=left, mebibytes=memory, only=only or "")
            lines = _space(sizes)
        else:
            lines = _formulas(program, tables, questions, left, memory, only)
        for line in lines:
            typer.echo(line)


def _read(folder: Path, examination: Examination) -> tuple[Tables, list[Asked]] | None:
    """The net and what is asked of it; None, with the reason on the standard error, if it cannot be unfolded.

    It leaves with a report when the net is wrong.
    """
    d = Diagnostics()
    tables = ptnet.tables_of(folder / "model.pnml")
    if tables is None:
        net = front.load(folder / "model.pnml", d, compute=compute)
        if net is None:
            stop(d, Format.FULL)
        tables = _tables(net, d)
    if tables is None:
        return None
    return tables, [] if examination == SPACE else asked(tables, examination, folder)


def _tables(net: FlatNet, d: Diagnostics) -> Tables | None:
    """The net unfolded, without names if that can be done; None after the reason, on the standard error."""
    found = plain(net)
    if found is not None:
        return Tables.of_plain(net, found)
    unfolding = unfold(net, d)
    print_diagnostics(d.sorted(), Format.FULL)
    if unfolding is None or any(x.code == UNFOLDING_FAULT for x in d):
        return None
    try:
        return Tables.of(unfolding)
    except ValueError as error:
        typer.echo(f"pn2code: {error}", err=True)
        return None


def _formulas(
    program: Path,
    tables: Tables,
    questions: list[Asked],
    seconds: float,
    mebibytes: int,
    only: Method | None,
) -> Iterator[str]:
    unknown = {q.name: q.why_not for q in questions}
    found = answers(
        program, tables, questions, seconds=seconds, mebibytes=mebibytes, only=only or ""
    )
    for result in found:
        del unknown[result.name]
        yield f"FORMULA {result.name} {str(result.value).upper()} TECHNIQUES {result.techniques}"
    for name, why in unknown.items():
        if why:
            typer.echo(f"pn2code: {name}: {why}", err=True)
        yield f"FORMULA {name} {UNKNOWN}"


def _space(found: Space | None) -> Iterator[str]:
    if found is None:
        yield UNKNOWN
        return
    for what, number in (
        ("STATES", found.states),
        ("TRANSITIONS", found.arcs),
        ("MAX_TOKEN_IN_PLACE", found.tokens_in_place),
        ("MAX_TOKEN_PER_MARKING", found.tokens_in_marking),
    ):
        yield f"STATE_SPACE {what} {number} TECHNIQUES {found.method}"
