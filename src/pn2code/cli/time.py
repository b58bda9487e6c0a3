"""`pn2code time`: how long commands take, and a cycle, over everything that the net permits."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pn2code.base.os_reason import os_reason
from pn2code.base.progress_line import Line
from pn2code.cli.nets import in_time, open_net, playing
from pn2code.cli.options import (
    OUTPUT_FLAGS,
    CellArgument,
    Exit,
    Format,
    FormatOption,
    InputOption,
    JsonOption,
    MaxSecondsOption,
    MaxStatesOption,
    SetOption,
    finite,
    parse_values,
    print_diagnostics,
    stop,
)
from pn2code.diagnostics import Diagnostics
from pn2code.verify.exploring.limits import Limits, cores

if TYPE_CHECKING:
    from pn2code.timing.look import Times
    from pn2code.verdict.opened import OpenNet

EPILOG = """Examples:

  pn2code time examples/handover

  pn2code time examples/riveting --layout good --within 120

  pn2code time examples/tending -o time --json

  pn2code time examples/handover --run run
"""


def time(
    cell: CellArgument,
    layout: Annotated[
        str | None, typer.Option(metavar="NAME", help="Only this layout.  (default: all)")
    ] = None,
    within: Annotated[
        float | None,
        typer.Option(
            metavar="S",
            min=0.0,
            callback=finite,
            help="Ask whether each run comes to its end within S seconds. The exit code is the answer: 0, 1 or 3.",
        ),
    ] = None,
    run: Annotated[
        Path | None,
        typer.Option(
            metavar="RUN",
            help="Look at this run instead (a folder that `pn2code run` wrote, or its trace): its critical path, who "
            "waits for what, utilisation, and what could be gained by overlapping.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            *OUTPUT_FLAGS,
            metavar="DIR",
            help="Where a table (durations.tsv), time.json and traces of a fastest and a slowest run go.",
        ),
    ] = None,
    full: Annotated[bool, typer.Option("--full", help="Print all commands.")] = False,
    as_json: JsonOption = False,
    inputs: InputOption = None,
    max_seconds: MaxSecondsOption = None,
    max_states: MaxStatesOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    form: FormatOption = Format.FULL,
) -> None:
    """Measure each command from wherever the arm can be then, and the best and worst cycle over all runs.

    Commands are planned as a run plans them. The exit code is 3 if not everything is known.
    """
    from pn2code.timing.look import look
    from pn2code.timing.report import text

    d = Diagnostics()
    late = "everything was measured"
    with in_time(max_seconds, cell, late, form):
        opened = open_net(cell, parse_values(settings), form, warnings=d, inputs=inputs)
    if run is not None:
        if within is not None or out is not None or layout is not None:
            raise typer.BadParameter(
                "a run is one of one layout: `--layout`, `--within` and `-o` have no meaning with it",
                param_hint="--run",
            )
        with in_time(max_seconds, cell, late, form):
            _look_at(opened, run, d, full=full, as_json=as_json, form=form)
        return
    line = Line(shown=not as_json, plain=True, first="reading the cell ...")
    try:
        if out is not None:
            out.mkdir(parents=True, exist_ok=True)
        with in_time(max_seconds, cell, late, form), playing(form), line as progress:
            limits = Limits(max_states=max_states, threads=cores())
            found = look(opened, layout, limits, out, d, progress.stage, say=progress.say)
        if found is None or d.has_errors:
            stop(d, form)
        if out is not None:
            _write(found, opened.flat.file, out)
    except OSError as problem:
        raise typer.BadParameter(
            f"cannot write into `{out}`: {os_reason(problem)}", param_hint="--out"
        ) from None
    print_diagnostics(d.sorted(), form)
    answers = _answers(found, within)
    if as_json:
        typer.echo(json.dumps(_row(found, opened.flat.file, within), indent=1))
    elif found.why:
        typer.echo(f"not known: {found.why}")
    else:
        typer.echo(text(found.layouts, found.reply_timeout_s, full=full))
        for name, answer, why in answers:
            where = f" in layout `{name}`" if name else ""
            word = {"yes": "yes", "no": "NO", "unknown": "not known"}[answer]
            if answer == "yes":
                why = "if `pn2code verify` has nothing against the cell, and no fault stops a run"
            typer.echo(f"{word}: each run comes to its end within {within:g} s{where}: {why}")
    raise typer.Exit(_code(found, within))


def _look_at(
    opened: OpenNet, run: Path, d: Diagnostics, *, full: bool, as_json: bool, form: Format
) -> None:
    from pn2code.timing.run_look import look_at
    from pn2code.timing.run_report import text

    with playing(form):
        found = look_at(opened, run, d)
    if found is None or d.has_errors:
        stop(d, form)
    print_diagnostics(d.sorted(), form)
    if as_json:
        typer.echo(json.dumps({"file": opened.flat.file, **found.row()}, indent=1))
    else:
        typer.echo(text(found, full=full))


def _answers(found: Times, within: float | None) -> list[tuple[str, str, str]]:
    if within is None:
        return []
    return [(x.name, *x.cycle.within(within)) for x in found.layouts]


def _row(found: Times, file: str, within: float | None) -> dict[str, object]:
    row: dict[str, object] = {"file": file, **found.row()}
    if within is not None:
        row["within"] = [
            {"layout": name or None, "seconds": within, "answer": answer, "why": why or None}
            for name, answer, why in _answers(found, within)
        ]
    return row


def _code(found: Times, within: float | None) -> int:
    if found.why:
        return Exit.INCONCLUSIVE
    answers = {answer for _, answer, _ in _answers(found, within)}
    if "no" in answers:
        return Exit.MODEL
    if within is not None:
        return Exit.OK if answers == {"yes"} else Exit.INCONCLUSIVE
    is_known = not any(x.open or x.cycle.why for x in found.layouts)
    return Exit.OK if is_known else Exit.INCONCLUSIVE


def _write(found: Times, file: str, out: Path) -> None:
    keys = (
        "robot", "transition", "command", "kind", "least_s", "most_s", "least_from", "most_from", "places",
    )  # fmt: skip
    lines = ["\t".join(("layout", *keys))]
    for layout in found.layouts:
        for row in (c.row() for c in layout.commands):
            values = ("" if row[k] is None else str(row[k]) for k in keys)
            lines.append("\t".join((layout.name, *values)))
    (out / "durations.tsv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    text = json.dumps(_row(found, file, None), indent=1) + "\n"
    (out / "time.json").write_text(text, encoding="utf-8")
