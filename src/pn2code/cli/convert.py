"""`pn2code convert`: a net in the format of another tool."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import pn2code
from pn2code.base.whole_file import whole_file
from pn2code.cli.nets import open_net, playing
from pn2code.cli.options import (
    OUTPUT_FLAGS,
    Exit,
    Format,
    FormatOption,
    SetOption,
    parse_values,
    print_diagnostics,
    stop,
)
from pn2code.diagnostics import Diagnostics, Origin

if TYPE_CHECKING:
    from pn2code.net.flat import FlatNet
    from pn2code.reading.document import Document

EPILOG = """Examples:

  pn2code convert net.pnml -o net.cpn

  pn2code convert net.cpn -o net.pnml --unfold

  pn2code convert net.cpn -o net.pml     (a model for SPIN)
"""

_FORMATS = (".pnml", ".pml", ".promela", ".cpn")


def convert(
    net: Annotated[Path, typer.Argument(help="A .cpn or .pnml file, a cell.toml, or a folder.")],
    output: Annotated[
        Path,
        typer.Option(
            *OUTPUT_FLAGS,
            metavar="FILE",
            help="The file to write: FILE.pnml, FILE.pml (SPIN) or FILE.cpn.",
        ),
    ],
    unfold: Annotated[
        bool,
        typer.Option(
            "--unfold", help="Write a place/transition net, with a place for each colour."
        ),
    ] = False,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    form: FormatOption = Format.FULL,
) -> None:
    """Convert a net to PNML or to a Promela model for SPIN, or a PNML net to a net of CPN Tools."""
    from pn2code.convert.codes import CONVERT_FORMAT, UNSUPPORTED_IN_CPN

    d = Diagnostics()
    kind = output.suffix.lower()
    if kind not in _FORMATS:
        d.error(
            CONVERT_FORMAT,
            f"`{output}` names none of the formats that nets are converted to",
            Origin(str(output)),
            hint="let the name end in .pnml, .pml or .cpn",
        )
        stop(d, form)
    opened = open_net(net, parse_values(settings), form)
    document = opened.examined.document
    assert document is not None
    if kind == ".cpn" and (document.tool != "PNML" or unfold):
        d.error(
            UNSUPPORTED_IN_CPN,
            "only PNML nets are written as .cpn files, and not unfolded",
            Origin(str(net)),
            hint="write the unfolded net as PNML first, then that as .cpn",
        )
        stop(d, form)
    with playing(form):
        text = _text(kind, opened.flat, document, unfold, net, d)
    if text is None:
        stop(d, form)
    print_diagnostics(d.sorted(), form)
    try:
        with whole_file(output) as beside:
            beside.write_text(text, encoding="utf-8")
    except OSError as problem:
        typer.echo(f"pn2code: cannot write `{output}`: {problem.strerror}", err=True)
        raise typer.Exit(Exit.USAGE) from None


def _text(
    kind: str, flat: FlatNet, document: Document, unfolded: bool, net: Path, d: Diagnostics
) -> str | None:
    """The file's contents; None after errors."""
    from pn2code.convert import cpn, pnml_plain, pnml_symmetric, promela
    from pn2code.drawing.scene import positions
    from pn2code.ml.core.colsets import Kind
    from pn2code.unfold.unfold import unfold

    if kind == ".cpn":
        return cpn.emit(document, positions(document))
    plain = all(p.colset.resolved.kind is Kind.UNIT for p in flat.places)
    several = len(document.pages) > 1
    where = {} if several else {i: (x, -y) for i, (x, y) in positions(document).items()}
    if kind == ".pnml" and not (unfolded or plain):
        return pnml_symmetric.emit(flat, d, title=net.stem, positions=where)
    u = unfold(flat, d)
    if u is None:
        return None
    if kind == ".pnml":
        return pnml_plain.emit(u, d, title=net.stem, positions=where)
    return promela.emit(u, d, source=net.name, version=pn2code.__version__)
