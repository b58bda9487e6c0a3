"""`pn2code dump`: what a net is after each stage, as tests and people read it."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

import pn2code
from pn2code.cli.options import Format, FormatOption, NetArgument, SetOption, parse_values, stop
from pn2code.diagnostics import Diagnostics

EPILOG = """Examples:

  pn2code dump net.cpn --stage flat

  pn2code dump examples/riveting --stage partition

  pn2code dump net.cpn --stage ir --only Pick
"""


class Stage(StrEnum):
    """The stages of the pipeline."""

    DOCUMENT = "doc"
    NET = "net"
    DECLARATIONS = "ml"
    FLAT = "flat"
    PARTITION = "partition"
    IR = "ir"
    DEPLOYED = "deployed"
    ROBOTS = "robots"


def dump(
    net: NetArgument,
    stage: Annotated[
        Stage, typer.Option(help="The stage after which the net is printed.")
    ] = Stage.FLAT,
    only: Annotated[
        str, typer.Option(help="Print only elements whose name contains this text.")
    ] = "",
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    form: FormatOption = Format.FULL,
) -> None:
    """Print the net as it is after a stage of the pipeline."""
    d = Diagnostics()
    text = stage_text(net, stage, only, parse_values(settings), d)
    if text is None:
        stop(d, form)
    typer.echo(text.rstrip("\n"))


def stage_text(
    path: Path, stage: Stage, only: str, values: dict[str, str], d: Diagnostics
) -> str | None:
    """The dump; None after diagnostics."""
    from pn2code import registers
    from pn2code.cell.dump import dump_partition
    from pn2code.cell.locate import locate
    from pn2code.division import divided
    from pn2code.emission.tdl import emit
    from pn2code.ir.dump import dump as dump_ir
    from pn2code.lowering.nets.net import lower
    from pn2code.ml.core.dump import dump_program
    from pn2code.net import front
    from pn2code.net.dump import dump_document, dump_flat, dump_net
    from pn2code.net.link import link
    from pn2code.net.source import read
    from pn2code.robot_scripts.translate import lower_robots
    from pn2code.semantics.evaluation.constants import compute
    from pn2code.verify.controller.proofs import prove
    from pn2code.verify.exploring.place_capacity import with_place_capacities

    found = locate(path, d)
    if found is None:
        return None
    net_path, config = found
    if stage in (Stage.DOCUMENT, Stage.NET):
        document = read(net_path, d)
        if document is None or stage is Stage.DOCUMENT:
            return None if document is None else dump_document(document)
        linked = link(document, d)
        return None if linked is None else dump_net(linked)
    flat = front.load(net_path, d, {**(config.values if config else {}), **values}, compute=compute)
    if flat is not None and not d.has_errors:
        flat, config = registers.as_messages(flat, config, d)
    if flat is None or d.has_errors:
        return None
    if stage is Stage.DECLARATIONS:
        return dump_program(flat.program)
    if stage is Stage.FLAT:
        return dump_flat(flat, only)
    partition = divided(flat, config, d)
    if partition is None:
        return None
    if stage is Stage.PARTITION:
        return dump_partition(partition)
    if stage in (Stage.IR, Stage.DEPLOYED):
        compiled = lower(partition, config.storage if config else {}, d)
        if compiled is not None and stage is Stage.DEPLOYED:
            proofs = prove(partition, config, d, checked=False)
            compiled = (
                None if proofs is None else with_place_capacities(compiled, proofs.place_capacities)
            )
        return None if compiled is None else dump_ir(compiled, only)
    robots = lower_robots(partition, config, d) if config else ()
    if robots is None:
        return None
    files = emit(robots, source=net_path.name, digest="", version=pn2code.__version__)
    return "\n".join(f.text for f in files if only in f.path)
