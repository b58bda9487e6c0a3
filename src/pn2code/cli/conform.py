"""`pn2code conform`: do the compiled programs do what the net does, in every state that can be reached?"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from pn2code.base.kept_answers import KeptAnswers
from pn2code.base.progress_line import Line
from pn2code.cell.locate import locate
from pn2code.cli.nets import in_time, refuse_wide
from pn2code.cli.options import (
    DEFAULT_INT_BITS,
    Exit,
    Format,
    FormatOption,
    InputOption,
    IntBitsOption,
    JsonOption,
    MaxSecondsOption,
    NetArgument,
    SetOption,
    UncheckedOption,
    parse_values,
    print_but_known,
    stop,
)
from pn2code.conform.cell import Conformance, conform_cell
from pn2code.conform.core import CoreReport
from pn2code.conform.folder import Folder
from pn2code.conform.scheme import MOST_STATES
from pn2code.conform.script_state import RobotReport
from pn2code.conform.supervisor import Report
from pn2code.diagnostics import Diagnostics

EPILOG = """Examples:

  pn2code conform examples/riveting

  pn2code conform net.cpn --most 100000 --json
"""


_EDITED = (
    "              (this script is not the one that is generated: what it does in states that were not reached here "
    "was not compared)"
)
MOST_NAMES = 8
"""Of transitions that never occur."""


def conform(
    net: NetArgument,
    most: Annotated[
        int,
        typer.Option(
            metavar="N",
            min=1,
            help="Compare all states if there are at most N, otherwise samples of them.",
        ),
    ] = MOST_STATES,
    generated: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            exists=True,
            file_okay=False,
            help="Compare the generated files in this folder instead of newly generated ones.",
        ),
    ] = None,
    unchecked: UncheckedOption = False,
    inputs: InputOption = None,
    as_json: JsonOption = False,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    int_bits: IntBitsOption = DEFAULT_INT_BITS,
    max_seconds: MaxSecondsOption = None,
    form: FormatOption = Format.FULL,
) -> None:
    """Compare the compiled net, the supervisor and each robot program with the net, state by state.

    The exit code is 0 if everything was compared and agrees, 1 if something differs, and 3 if only a part was compared.
    """
    d = Diagnostics()
    if int_bits != DEFAULT_INT_BITS:
        where = locate(net, Diagnostics())  # what is wrong there is said below
        refuse_wide(None if where is None else where[1], int_bits)
    with (
        in_time(max_seconds, net, "the programs were compared with the net", form),
        Line(shown=not as_json, plain=True, first="reading and checking the net ...") as progress,
    ):
        found = conform_cell(
            net,
            d,
            values=parse_values(settings),
            int_bits=int_bits,
            most=most,
            generated=generated,
            checked=not unchecked,
            inputs=inputs,
            kept=KeptAnswers.of_user(),
            stage=progress.stage,
            say=progress.say,
        )
    if found is None:
        stop(d, form)
    if as_json:
        typer.echo(json.dumps(_row(found), indent=1))
    else:
        for line in _lines(found):
            typer.echo(line)
    print_but_known(d, net, form)
    if found.deviates:
        raise typer.Exit(Exit.MODEL)
    if not found.complete:
        raise typer.Exit(Exit.INCONCLUSIVE)


def _row(found: Conformance) -> dict[str, Any]:
    return {
        "ok": not found.deviates,
        "complete": found.complete,
        "files": asdict(found.folder) if found.folder else None,
        "core": asdict(found.core),
        "supervisor": _supervisor_row(found.supervisor) if found.supervisor else None,
        "robots": [asdict(r) for r in found.robots],
    }


def _supervisor_row(report: Report) -> dict[str, Any]:
    return {**asdict(report), "transitions": len(report.transitions)}


def _lines(found: Conformance) -> list[str]:
    lines = [] if found.folder is None else list(_files(found.folder))
    lines.append(_core(found.core))
    if found.supervisor is not None:
        lines += _supervisor(found.supervisor)
    edited = () if found.folder is None else found.folder.edited
    for robot in found.robots:
        lines += _robot(robot, f"{robot.robot}.tdl" in edited)
    return lines


def _files(folder: Folder) -> Iterator[str]:
    if folder.deviates:
        yield "files         DIFFER from those that are generated now:"
        for name in folder.differing:
            yield f"              `{name}` differs: generate it again"
        for name in folder.intruding:
            yield f"              `{name}` is not generated, but would become a part of the programs: remove it"
    else:
        same = folder.files - len(folder.edited)
        yield f"files         {same} of {folder.files} are as they are generated now"
    if folder.edited:
        yield f"              edited, and compared by what they do: {', '.join(folder.edited)}"
    if not folder.complete:
        yield "              of net.c only the supervisor is compared as it was edited, not `./simulate`"
    if folder.foreign:
        yield f"              not generated, and not compared: {', '.join(folder.foreign)}"


def _core(core: CoreReport) -> str:
    if core.deviation is not None:
        return f"net.c         DIFFERS from the token game: {core.deviation}"
    if core.given_up:
        return f"net.c         not compared to the end, because the token game gives up: {core.given_up}"
    if core.complete:
        # Random runs besides a complete space compare the times, see `CoreReport`.
        apart = ", where markings that differ only in the time count once" if core.walks else ""
        return (
            f"net.c         agrees with the token game in all {core.nodes:,} reachable markings "
            f"and {core.arcs:,} occurrences{apart}"
        )
    why = "the state space is larger than the limit"
    if core.raises:
        why = "the state space ends with an error of the net, see `verify`"
    return (
        f"net.c         agrees with the token game in a sample: {core.walks} random runs, "
        f"{core.steps:,} occurrences ({why})"
    )


def _supervisor(report: Report) -> list[str]:
    counts = (
        f"{report.states:,} states (it can distinguish {report.sights:,} of them): "
        f"{report.cycles:,} cycles, {report.firings:,} firings of "
        f"{len(report.transitions)} of its {report.all_transitions} transitions, "
        f"{report.received:,} messages received, {report.sent:,} sent"
    )
    if report.deviation is not None:
        return [
            f"supervisor    DIFFERS from the net: {report.deviation.what}",
            *_path_lines(report.deviation.way),
        ]
    some = "all" if report.complete else f"a part ({report.why}),"
    lines = [f"supervisor    agrees with the net in {some} {counts}", *_idle(report)]
    if report.overruns:
        lines.append(
            "              in the net a message can arrive before the previous one has been taken:"
        )
        lines += _path_lines(report.overruns[0])
    return lines


def _robot(report: RobotReport, is_edited: bool) -> list[str]:
    name = f"{report.robot:<13}"
    if report.deviation is not None:
        return [f"{name} DIFFERS from its page: {report.deviation}", *_path_lines(report.way)]
    some = "all" if report.complete else f"a part ({report.why or 'a limit was reached'}),"
    return [
        f"{name} agrees with its page in {some} {report.states:,} states: {report.marks:,} firings of "
        f"{report.transitions} of its {report.all_transitions} transitions, "
        f"{report.commands:,} commands",
        *_idle(report),
        *([_EDITED] if is_edited else []),
    ]


def _idle(report: Report | RobotReport) -> list[str]:
    """The transitions of which nothing was compared, since they never occurred."""
    names = [f"`{name}`" for name in report.idle]
    if not names:
        return []
    shown = ", ".join(names[:MOST_NAMES])
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return [f"              in none of them occur {shown}{more}"]


def _path_lines(way: tuple[str, ...], most: int = 30) -> list[str]:
    shown = [f"    {n:>4}  {text}" for n, text in enumerate(way, 1)]
    cut = len(shown) - most
    return [f"    ... {cut} before", *shown[-most:]] if cut > 0 else shown
