"""What the claims of a trace are compared with, and how `replay` refuses a file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NoReturn

import typer

from pn2code.base.frozen import frozen
from pn2code.cli.options import Exit, Format, stop
from pn2code.diagnostics import Diagnostics
from pn2code.trace.parties import Parties
from pn2code.trace.replay_result import Notes
from pn2code.verdict.opened import OpenNet


def refuse(message: str) -> NoReturn:
    """Leaves: a file is not what it should be."""
    typer.echo(f"pn2code: {message}", err=True)
    raise typer.Exit(Exit.USAGE)


@frozen
class Claims:
    """What the claims of a trace are compared with; see `trace.replay.replay`."""

    parties: Parties
    check_digest: bool
    may_fail_outside: bool
    notes: Notes | None = None


def claims(
    opened: OpenNet,
    values: Mapping[str, str],
    int_bits: int,
    *,
    any_digest: bool,
    form: Format = Format.FULL,
) -> Claims:
    """Who runs what, and which digests the traces of these programs have."""
    from pn2code.cell.divide import divide
    from pn2code.conform.notes import RunNotes
    from pn2code.pipeline import program_digest
    from pn2code.simulate.choose import monitors_of

    d = Diagnostics()
    config = opened.config
    replaced = {**(config.values if config else {}), **values}
    digests = frozenset({program_digest(opened.flat, config, replaced, int_bits)})
    may_fail = monitors_of(opened.examined, d) is not None
    if config is None:
        return Claims(Parties.one(opened.flat, digests), not any_digest, may_fail)
    partition = divide(opened.flat, config, d)
    if partition is None:
        stop(d, form)
    return Claims(
        Parties.of(partition, digests), not any_digest, may_fail, RunNotes(config, partition)
    )
