"""`pn2code marking`: the initial marking of a net."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from pn2code.cli.nets import in_time, open_net, playing
from pn2code.cli.options import (
    DEFAULT_INT_BITS,
    DEFAULT_SEED,
    FilesOption,
    Format,
    FormatOption,
    InputOption,
    IntBitsOption,
    JsonOption,
    MaxSecondsOption,
    NetArgument,
    SeedOption,
    SetOption,
    parse_values,
)
from pn2code.semantics.game import report

EPILOG = """Examples:

  pn2code marking net.cpn

  pn2code marking net.cpn --json
"""

EmptyOption = Annotated[bool, typer.Option("--empty", help="Print empty places as well.")]


def marking(
    net: NetArgument,
    as_json: JsonOption = False,
    empty: EmptyOption = False,
    inputs: InputOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    seed: SeedOption = DEFAULT_SEED,
    files: FilesOption = None,
    int_bits: IntBitsOption = DEFAULT_INT_BITS,
    max_seconds: MaxSecondsOption = None,
    form: FormatOption = Format.FULL,
) -> None:
    """Print the initial marking of each place in the form of CPN Tools."""
    with in_time(max_seconds, net, "the marking was computed", form), playing(form):
        opened = open_net(net, parse_values(settings), form, int_bits=int_bits, inputs=inputs)
        game = opened.game(seed=seed, files=files)
    if as_json:
        rows = report.places(opened.flat, game.marking)
        typer.echo(json.dumps({"time": game.marking.time, "places": rows}, indent=1))
    else:
        typer.echo(report.marking_text(opened.flat, game.marking, empty=empty))
