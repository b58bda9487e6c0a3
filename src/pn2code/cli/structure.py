"""`pn2code structure`: what follows from the net itself, without its state space."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from pn2code.base.progress_line import told
from pn2code.cli.nets import in_time, open_net
from pn2code.cli.options import (
    DEFAULT_INT_BITS,
    Format,
    FormatOption,
    InputOption,
    IntBitsOption,
    JsonOption,
    MaxSecondsOption,
    NetArgument,
    SetOption,
    parse_values,
)
from pn2code.structure import analyse, report

EPILOG = """Examples:

  pn2code structure net.cpn

  pn2code structure net.cpn --set n=10 --json
"""


def structure(
    net: NetArgument,
    as_json: JsonOption = False,
    everything: Annotated[bool, typer.Option("--all", help="Print long lists completely.")] = False,
    inputs: InputOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    int_bits: IntBitsOption = DEFAULT_INT_BITS,
    max_seconds: MaxSecondsOption = None,
    form: FormatOption = Format.FULL,
) -> None:
    """Compute invariants, siphons, traps, bounds and classes of a net from its structure alone."""
    in_its_time = in_time(max_seconds, net, "the structure was analysed", form)
    with in_its_time:
        opened = open_net(net, parse_values(settings), form, int_bits=int_bits, inputs=inputs)
        with told("looking at the structure") as line:
            analysis = analyse(opened.flat, storage=opened.storage, stage=line.turn_to)
            line.turn_to("writing what was found")
            said = (
                json.dumps(report.as_json(analysis), indent=1)
                if as_json
                else report.text(analysis, everything=everything)
            )
    typer.echo(said)
