"""`pn2code enabled`: the binding elements that are enabled in the initial marking."""

from __future__ import annotations

import json

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

  pn2code enabled net.cpn

  pn2code enabled net.cpn --json
"""


def enabled(
    net: NetArgument,
    as_json: JsonOption = False,
    inputs: InputOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    seed: SeedOption = DEFAULT_SEED,
    files: FilesOption = None,
    int_bits: IntBitsOption = DEFAULT_INT_BITS,
    max_seconds: MaxSecondsOption = None,
    form: FormatOption = Format.FULL,
) -> None:
    """Print the binding elements that are enabled in the initial marking.

    If all tokens are still in the future, the clock is moved to the first time at which something is enabled.
    """
    with in_time(max_seconds, net, "the binding elements were found", form), playing(form):
        opened = open_net(net, parse_values(settings), form, int_bits=int_bits, inputs=inputs)
        game = opened.game(seed=seed, files=files)
        game.advance()
        elements = game.enabled()
    time = game.marking.time
    if as_json:
        rows = report.enabled(opened.flat, elements)
        typer.echo(json.dumps({"time": time, "enabled": rows}, indent=1))
    else:
        typer.echo(report.enabled_text(opened.flat, time, elements))
