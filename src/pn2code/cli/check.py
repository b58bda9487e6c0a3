"""`pn2code check`: is the net (and the cell beside it) well-formed?"""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from pn2code.base.kept_answers import KeptAnswers
from pn2code.base.progress_line import told
from pn2code.cell.channel_table import lines as channel_lines
from pn2code.cli.nets import in_time
from pn2code.cli.options import (
    DEFAULT_INT_BITS,
    Format,
    FormatOption,
    InputOption,
    IntBitsOption,
    JobsOption,
    JsonOption,
    MaxSecondsOption,
    MaxStatesOption,
    NetArgument,
    SetOption,
    code_of,
    parse_values,
    print_diagnostics,
)
from pn2code.diagnostics import Diagnostic, Diagnostics, render
from pn2code.verdict.checking import check as examined

EPILOG = """Examples:

  pn2code check net.cpn

  pn2code check examples/riveting --json

  pn2code check examples/shared-zone --geometry
"""

COUNTED = ("pages", "places", "transitions", "arcs")
"""What is counted, as the file has it: substitution transitions are transitions, a page counts once."""


def check(
    net: NetArgument,
    geometry: Annotated[
        bool,
        typer.Option(
            "--geometry",
            help="Look at all moves and pairs of moves that the net permits (docs/geometry.md).",
        ),
    ] = False,
    layout: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="With `--geometry`: only this layout of the cell."),
    ] = None,
    traces: Annotated[
        Path | None,
        typer.Option(
            "--traces",
            "-o",
            metavar="DIR",
            help="With `--geometry`: the folder for the runs and pictures.  (default: NET.geometry)",
            show_default=False,
        ),
    ] = None,
    pictures: Annotated[
        bool,
        typer.Option("--pictures", help="With `--geometry`: a picture of each pair that touches."),
    ] = False,
    full: Annotated[
        bool, typer.Option("--full", help="With `--geometry`: print the whole table of moves.")
    ] = False,
    as_json: JsonOption = False,
    inputs: InputOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    int_bits: IntBitsOption = DEFAULT_INT_BITS,
    max_seconds: MaxSecondsOption = None,
    max_states: MaxStatesOption = None,
    jobs: JobsOption = None,
    form: FormatOption = Format.FULL,
) -> None:
    """Check the syntax, types, bindings and hierarchy of a net, and the cell beside it.

    With `--geometry` it explores the cell and says whether each move is possible from wherever the arm can be then, and
    whether two arms can collide in any interleaving that the net permits. The exit code is then 0 (yes, both), 1 or 3.
    """
    if geometry:
        from pn2code.cli.check_geometry import check_geometry

        check_geometry(
            net,
            parse_values(settings),
            layout=layout,
            traces=traces,
            pictures=pictures,
            full=full,
            as_json=as_json,
            inputs=inputs,
            int_bits=int_bits,
            max_seconds=max_seconds,
            max_states=max_states,
            jobs=jobs,
            form=form,
        )
        return
    given = {"max-states": max_states, "jobs": jobs}
    _refuse_without(layout=layout, traces=traces, pictures=pictures, full=full, **given)
    d = Diagnostics()
    with in_time(max_seconds, net, "the net was checked", form), told("checking the net"):
        checked = examined(
            net,
            parse_values(settings),
            d,
            int_bits=int_bits,
            inputs=inputs,
            kept=KeptAnswers.of_user(),
        )
    result = checked.examined
    elements = result.document.elements if result.document else {}
    numbers = {key: elements.get(key, 0) for key in COUNTED}
    if as_json:
        items = [_as_json(item, str(checked.file)) for item in d.sorted()]
        shape = {"file": str(checked.file), "ok": checked.is_fine, **numbers, "diagnostics": items}
        if checked.channels:
            shape["channels"] = [asdict(c) for c in checked.channels]
        typer.echo(json.dumps(shape, indent=1))
    else:
        print_diagnostics(d.sorted(), form)
        if checked.channels:
            table = channel_lines(checked.channels)
            typer.echo("\n".join(["Channels (docs/cell.md explains the kinds):", *table, ""]))
        words = (f"{n} {key if n != 1 else key[:-1]}" for key, n in numbers.items())
        counted = ", ".join(words) + ": "
        typer.echo(f"{checked.file}: {counted if elements else ''}{render.count(d)}")
    if not checked.is_fine:
        raise typer.Exit(code_of(d))


def _refuse_without(**given: object) -> None:
    """Options that mean something with `--geometry` only."""
    for name, value in given.items():
        if value:
            raise typer.BadParameter("it needs `--geometry`", param_hint=f"--{name}")


def _as_json(item: Diagnostic, net: str) -> dict[str, object]:
    """One diagnostic; its `file` is left out when that is the net."""
    return {k: v for k, v in render.as_json(item).items() if (k, v) != ("file", net)}
