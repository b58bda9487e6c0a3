"""`pn2code convert`: a net in the format of another tool."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

import pn2code
from pn2code.base.deadline import Deadline, TimeIsOverError
from pn2code.base.progress_line import Line
from pn2code.base.whole_file import whole_file
from pn2code.cli.nets import open_net, playing
from pn2code.cli.options import (
    OUTPUT_FLAGS,
    Exit,
    Format,
    FormatOption,
    InputOption,
    NetArgument,
    SetOption,
    check_writable,
    parse_values,
    print_diagnostics,
    seconds_option,
    stop,
)
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.verify.codes import TIME_OVER

if TYPE_CHECKING:
    from pn2code.net.flat import FlatNet
    from pn2code.reading.document import Document

EPILOG = """Examples:

  pn2code convert net.pnml -o net.cpn

  pn2code convert net.cpn -o net.cpnt    (as text, and back)

  pn2code convert net.cpn -o net.pnml --unfold

  pn2code convert net.cpn -o net.pml     (a model for SPIN)
"""

_PACE_S = 0.5
"""Between two tellings of progress."""
_FORMATS = (".pnml", ".pml", ".promela", ".cpn", ".cpnt")


def convert(
    net: NetArgument,
    output: Annotated[
        Path,
        typer.Option(
            *OUTPUT_FLAGS,
            metavar="FILE",
            help="The file to write: FILE.pnml, FILE.pml (SPIN), FILE.cpn, or FILE.cpnt (text).",
        ),
    ],
    unfold: Annotated[
        bool,
        typer.Option(
            "--unfold", help="Write a place/transition net, with a place for each colour."
        ),
    ] = False,
    max_seconds: Annotated[
        float | None,
        seconds_option("Stop after S seconds, without a file."),
    ] = None,
    inputs: InputOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    form: FormatOption = Format.FULL,
) -> None:
    """Convert a net to PNML, to a Promela model for SPIN, to text, or to a net of CPN Tools."""
    from pn2code.convert.codes import CONVERT_FORMAT

    deadline = Deadline.of_command(max_seconds)
    d = Diagnostics()
    kind = output.suffix.lower()
    if kind not in _FORMATS:
        d.error(
            CONVERT_FORMAT,
            f"`{output}` names none of the formats that nets are converted to",
            Origin(str(output)),
            hint="let the name end in .pnml, .pml, .cpn or .cpnt",
        )
        stop(d, form)
    check_writable(output, "-o")
    try:
        with deadline.enforced(), Line(first="reading ...") as line:
            _convert(net, output, kind, parse_values(settings), inputs, unfold, d, form, line)
    except TimeIsOverError:
        d.warning(
            TIME_OVER,
            f"the time was up before the net was converted, so `{output}` was not written",
            Origin(str(net)),
            hint="give it more time with `--max-seconds`, or make colour sets smaller: unfolding makes a "
            "transition for each binding",
        )
        print_diagnostics(d.sorted(), form)
        raise typer.Exit(Exit.INCONCLUSIVE) from None


def _convert(
    net: Path,
    output: Path,
    kind: str,
    values: dict[str, str],
    inputs: Path | None,
    unfold: bool,
    d: Diagnostics,
    form: Format,
    line: Line,
) -> None:
    """Reads the net and writes the file."""
    from pn2code.convert.codes import UNSUPPORTED_IN_CPN

    opened = open_net(net, values, form, inputs=inputs)
    document = opened.examined.document
    assert document is not None
    if unfold and kind in (".cpn", ".cpnt"):
        d.error(
            UNSUPPORTED_IN_CPN,
            f"nets are not unfolded when they are written as {kind} files",
            Origin(str(net)),
            hint=f"write the unfolded net as PNML first, then that as {kind}",
        )
        stop(d, form)
    if values and kind in (".cpn", ".cpnt"):
        raise typer.BadParameter(
            f"a {kind} file has the declarations of the net as they are: set the values when you use it",
            param_hint="--set",
        )
    if kind == ".cpn" and document.tool not in ("PNML", "text"):
        d.error(
            UNSUPPORTED_IN_CPN,
            "the net is a .cpn file already",
            Origin(str(net)),
            hint="copy it, or convert it to .pnml, .pml or .cpnt",
        )
        stop(d, form)
    with playing(form):
        text = _text(kind, opened.flat, document, unfold, net, d, line)
    line.clear()
    if text is None:
        stop(d, form)
    print_diagnostics(d.sorted(), form)
    try:
        with whole_file(output) as beside:
            beside.write_text(text, encoding="utf-8")
    except OSError as problem:
        typer.echo(f"pn2code: cannot write `{output}`: {problem.strerror}", err=True)
        raise typer.Exit(Exit.USAGE) from None
    if kind in (".cpn", ".cpnt") and form is not Format.JSON:
        _say_which_net_a_cell_has(output)


def _say_which_net_a_cell_has(output: Path) -> None:
    """Changes of a net that the `cell.toml` beside it does not name would have no effect on the cell."""
    from pn2code.cell.load import load

    beside = output.parent / "cell.toml"
    config = load(beside, Diagnostics()) if beside.is_file() else None
    if config is not None and config.net_path.resolve() != output.resolve():
        typer.echo(
            f"wrote {output}; the net of the cell is still `{config.net_path.name}`: to change that, write "
            f'`file = "{output.name}"` under [net] in {beside}'
        )


def _text(
    kind: str,
    flat: FlatNet,
    document: Document,
    unfolded: bool,
    net: Path,
    d: Diagnostics,
    line: Line,
) -> str | None:
    """The file's contents; None after errors."""
    from pn2code.convert import cpn, pnml_plain, pnml_symmetric, promela
    from pn2code.drawing.positions import positions
    from pn2code.ml.core.colsets import Kind
    from pn2code.reading.cpn import read_data
    from pn2code.text_form import write as text_form
    from pn2code.unfold.unfold import unfold

    if kind == ".cpnt":
        if document.tool == "PNML":  # what PNML leaves out, a file of CPN Tools says
            made = cpn.emit(document, positions(document)).encode()
            document = cast("Document", read_data(made, document.file, d))
        written = text_form.emit(document, d)
        return None if d.has_errors else written
    if kind == ".cpn":
        return cpn.emit(document, positions(document))
    plain = all(p.colset.resolved.kind is Kind.UNIT for p in flat.places)
    several = len(document.pages) > 1
    where = {} if several else {i: (x, -y) for i, (x, y) in positions(document).items()}
    if kind == ".pnml" and not (unfolded or plain):
        return pnml_symmetric.emit(flat, d, title=net.stem, positions=where)
    shown = time.monotonic()

    def report(places: int, transitions: int) -> None:
        nonlocal shown
        if time.monotonic() - shown > _PACE_S:
            shown = time.monotonic()
            line.say(f"unfolding: {places:,} places  {transitions:,} transitions")

    line.say("unfolding ...")
    u = unfold(flat, d, progress=report)
    if u is None:
        return None
    if kind == ".pnml":
        return pnml_plain.emit(u, d, title=net.stem, positions=where)
    return promela.emit(u, d, source=net.name, version=pn2code.__version__)
