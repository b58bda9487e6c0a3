"""`pn2code contest`: the examinations of the Model Checking Contest."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterable
from contextlib import suppress
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from pn2code.base.deadline import Deadline, TimeIsOverError
from pn2code.base.progress_line import SILENCE_S, Line
from pn2code.base.whole_file import whole_file
from pn2code.cli.options import (
    Exit,
    Format,
    check_writable,
    print_diagnostics,
    seconds_option,
    stop,
)
from pn2code.contest import ptnet
from pn2code.contest.asking import Asking
from pn2code.contest.building import wait_until_built
from pn2code.contest.engine import engine
from pn2code.contest.formulas import FormulaError
from pn2code.contest.rounds import METHODS
from pn2code.contest.tables import Tables
from pn2code.contest.watchdog import MOST_S, watched
from pn2code.contest.words import ALL, UNKNOWN, names, unknown
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
Examination = StrEnum("Examination", {name: name for name in ALL})  # type: ignore[misc]  # its members are a table
Method = StrEnum("Method", {name: name for name in METHODS})  # type: ignore[misc]  # its members are a table


def contest(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="The folder of an input.")],
    examination: Annotated[Examination, typer.Argument(help="What is asked.")],
    max_seconds: Annotated[float, seconds_option("Stop after S seconds.")] = MOST_S,
    memory: Annotated[
        int, typer.Option(metavar="MIB", min=16, help="The most memory for all methods.")
    ] = 8192,
    only: Annotated[Method | None, typer.Option(help="Use this method alone.")] = None,
    evidence: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="In the time that is left then, write into this file, as lines of JSON, why what is not reachable "
            "is not: weights of places that anybody can check (docs/contest.md).",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Answer an examination of the Model Checking Contest, in its own words.

    `CANNOT_COMPUTE` stands for what is not known when the time is over. The exit code is 0, and 1 if the input is
    wrong.
    """
    sys.set_int_max_str_digits(0)  # numbers of markings may be longer than Python allows
    check_writable(evidence, "--evidence")
    deadline = Deadline.of_command(max_seconds)
    lines = names(examination, folder)
    watch = watched(deadline, lines)
    d = Diagnostics()
    net: Tables | FlatNet | None = None
    with suppress(TimeIsOverError), deadline.enforced():
        net = ptnet.tables_of(folder / "model.pnml")
        if net is None:
            net = front.load(folder / "model.pnml", d, compute=compute)
            if net is None:
                typer.echo(UNKNOWN)
                stop(d, Format.FULL)
    if net is None:
        typer.echo("\n".join(map(unknown, lines)) or UNKNOWN)
        return
    wait_until_built()
    with engine(d) as program:
        if program is None:
            stop(d, Format.FULL)
        asking = Asking(
            program,
            examination,
            folder,
            deadline,
            mebibytes=memory,
            only=only or "",
            say=lambda why: typer.echo(f"pn2code: {why}", err=True),
            watch=watch,
        )
        try:
            if isinstance(net, Tables):
                answers = asking.of_tables(net)
            else:
                answers = asking.of_net(net, lambda net: _tables(net, d))
            _print(answers, asking)
            if evidence is not None:
                rows = (json.dumps(row, ensure_ascii=False) + "\n" for row in asking.evidence())
                with whole_file(evidence) as beside:
                    beside.write_text("".join(rows), encoding="utf-8", errors="surrogateescape")
        except FormulaError as error:
            typer.echo(f"pn2code: {error}", err=True)
            typer.echo(UNKNOWN)
            raise typer.Exit(Exit.MODEL) from None
        except GameError as problem:  # more tokens than are made
            typer.echo(f"pn2code: the initial marking cannot be made: {problem.message}", err=True)
            typer.echo(UNKNOWN)


def _print(lines: Iterable[str], asking: Asking) -> None:
    """The answers as they come; meanwhile a terminal shows how many there are, how many a minute, and how long yet."""
    began = time.monotonic()

    def so_far() -> str:
        left = f"{max(asking.deadline.left or 0.0, 0.0):.0f} s left at most"
        if asking.unknown is None:
            return f"   {left}"
        rate = 60.0 * count / max(time.monotonic() - began, 1.0)
        return f"   {count} answered, {rate:,.0f}/min   {len(asking.unknown)} open   {left}"

    count = 0
    with Line(first="", silence=SILENCE_S) as line:
        line.turn_to(str(asking.examination), so_far, began)
        for text in lines:
            count += 1
            line.clear()
            typer.echo(text)
            line.turn_to(str(asking.examination), so_far, began)


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
