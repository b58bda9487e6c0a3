"""`pn2code show`: a run as one HTML page that shows net, arms, messages and time together."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from pn2code.base.os_reason import os_reason
from pn2code.base.progress_line import told
from pn2code.base.writable import why_file_unwritable
from pn2code.cli.options import (
    OUTPUT_FLAGS,
    Exit,
    FilesOption,
    Format,
    FormatOption,
    SetOption,
    parse_values,
    print_diagnostics,
    stop,
)
from pn2code.cli.trace_progress import TraceProgress
from pn2code.cli.traces_there import traces_there
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.codes import register

if TYPE_CHECKING:
    from pn2code.replay.description import Json

SHOW_RUN = register(
    "show-run",
    "there is no run to show",
    "`pn2code show` takes the folder of a run (with the `run.json` that `pn2code run` writes), or a trace "
    "(`*.trace.jsonl`) and its net.",
)

EPILOG = """Examples:

  pn2code show run -o replay.html

  pn2code show net.dead-40.trace.jsonl net.cpn -o replay.html

  pn2code show run --compare other-run -o both.html

  pn2code show run -o cell.glb
"""


def show(
    run: Annotated[
        Path, typer.Argument(help="The folder of a run, its run.json, or a trace (*.trace.jsonl).")
    ],
    net: Annotated[
        Path | None,
        typer.Argument(
            help="Of a trace: its net (.cpn, .cpnt or .pnml), a cell.toml, or a folder."
        ),
    ] = None,
    output: Annotated[
        Path,
        typer.Option(
            *OUTPUT_FLAGS,
            metavar="FILE",
            help="The HTML file to write; `*.glb`: the cell as glTF, for other programs.",
        ),
    ] = Path("replay.html"),
    compare: Annotated[
        Path | None,
        typer.Option("--compare", metavar="RUN", help="A second run or trace, shown beside it."),
    ] = None,
    steps: Annotated[
        int,
        typer.Option("--steps", metavar="N", min=1, help="Show at most so many steps of a trace."),
    ] = 1_000_000,
    description: Annotated[
        Path | None,
        typer.Option(
            "--description", metavar="FILE", help="Also write the description of the run as JSON."
        ),
    ] = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    files: FilesOption = None,
    form: FormatOption = Format.FULL,
) -> None:
    """Write a run as one HTML page that shows the net, the arms, the messages and the time together.

    The page needs no server and no network.
    """
    from pn2code.replay.description import text_of
    from pn2code.replay.differences import differences, sentences
    from pn2code.replay.page import page

    is_gltf = output.suffix.lower() == ".glb"
    if is_gltf and compare is not None:
        _refuse("a `.glb` has one run", "leave out --compare, or write an HTML file", form)
    for path in (output, *([description] if description else [])):
        if why := why_file_unwritable(path, makes_folders=True):
            _refuse(f"cannot write `{path}`: {why}", "give another file with -o", form)
    values = parse_values(settings)
    shown = _described(run, net, values, steps, files, form)
    other = None if compare is None else _described(compare, net, values, steps, files, form)
    names = _names(run, compare) if compare is not None else ("", "")
    try:
        with told("writing the page"):
            made = (
                _gltf(shown, form) if is_gltf else page(shown, other, names=names).encode("utf-8")
            )
        contents = {output: made}
        said = sentences(differences(shown, other)) if other is not None else []
    except (LookupError, TypeError, ValueError, AttributeError, OverflowError) as problem:
        if not any(path is not None and _is_description(path) for path in (run, compare)):
            raise  # of traces the description is our own
        _refuse(f"the description of a run is damaged: {problem}", "run the cell again", form)
    if description is not None:
        contents[description] = text_of(shown).encode("utf-8")
    for path, content in contents.items():
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        except OSError as problem:
            _refuse(f"cannot write `{path}`: {os_reason(problem)}", "give another file", form)
    typer.echo(f"{output}: {_sentence(shown, len(made))}")
    for sentence in said:
        typer.echo(sentence)
    runs = ((shown, "trace"),) if other is None else ((shown, "first run"), (other, "second run"))
    possible = [_is_possible(one, word) for one, word in runs]
    if not all(possible):
        raise typer.Exit(Exit.MODEL)


def _is_possible(shown: Json, word: str) -> bool:
    """Whether the net permits all steps; says which is the first that it does not."""
    refused = shown["course"].get("refused")
    if not refused:
        return True
    typer.echo(
        f"pn2code: the {word} is shown to step {refused['step'] - 1}: the next is not possible in this net "
        f"({': '.join(filter(None, (refused['transition'], refused['why'])))})",
        err=True,
    )
    return False


def _names(one: Path, other: Path) -> tuple[str, str]:
    """What two runs are called: by their files, or where these have one name by their folders as well."""
    names = [path.resolve().name for path in (one, other)]
    if names[0] == names[1]:
        names = [str(path) for path in (one, other)]
    return names[0], names[1]


def _gltf(shown: Json, form: Format) -> bytes:
    """What is to be seen of the cell."""
    from pn2code.replay.arrays import unpacked

    if not shown.get("cell"):
        _refuse("this run has no arms: there is no glTF of it", "write an HTML file", form)
    return unpacked(shown["cell"]["glb"]).tobytes()


def _sentence(shown: Json, size: int) -> str:
    steps = shown["course"]["steps"]
    arms = sum(not r.get("device") for r in (shown.get("cell") or {}).get("robots", ()))
    with_arms = f", {arms} arm{'s' * (arms != 1)}" if arms else ""
    return f"{steps:,} step{'s' * (steps != 1)}{with_arms}, {size / 1e6:.1f} MB"


def _is_description(run: Path) -> bool:
    """Whether it is said to be a run with its description, and not a trace."""
    return run.is_dir() or run.suffix == ".json"


def _described(
    run: Path,
    net: Path | None,
    values: dict[str, str],
    steps: int,
    files: Path | None,
    form: Format,
) -> Json:
    from pn2code.replay.description import NoDescription, read

    if not _is_description(run):
        return _trace(run, net, values, steps, files, form)
    try:
        return read(run)
    except NoDescription as problem:
        _refuse(
            str(problem), "give the folder that `pn2code run` wrote, or a trace and its net", form
        )


def _trace(
    trace: Path,
    net: Path | None,
    values: dict[str, Any],
    steps: int,
    files: Path | None,
    form: Format,
) -> Json:
    """A trace and its net."""
    from pn2code import registers
    from pn2code.cell.final_places import failed_names
    from pn2code.cell.locate import locate
    from pn2code.cli.nets import playing
    from pn2code.net import front
    from pn2code.properties.failing import Failing
    from pn2code.replay import trace as traces
    from pn2code.semantics.evaluation.constants import compute
    from pn2code.semantics.evaluation.files import Files

    is_trace = _is_trace(trace, form)
    if is_trace and net is None:
        _refuse(f"`{trace}` is a trace, but no net is named", "pn2code show TRACE NET", form)
    if net is None or not is_trace:
        _refuse(
            f"`{trace}` is neither the folder of a run nor a trace: its first line is not the head of one",
            "traces come from `run`, `simulate --trace` and `verify`",
            form,
        )
    d = Diagnostics()
    found = locate(net, d)
    if found is None:
        stop(d, form)
    path, config = found
    replaced = {**(config.values if config else {}), **values}
    examined = front.examine(path, d, replaced, drawn=True, compute=compute)
    if not d.has_errors:
        examined, config = registers.examined(examined, config, d)
    if examined.flat is None or examined.document is None or d.has_errors:
        stop(d, form)
    storage = config.storage if config else {}
    typed = examined.typed
    failing = Failing.of(config, examined.flat, typed.elaborator if typed else None, d)
    if d.has_errors:
        stop(d, form)
    try:
        with playing(form), TraceProgress(plain=True) as progress:
            return traces.describe(
                trace,
                examined.document,
                examined.flat,
                storage,
                most=steps,
                files=Files(files),
                failed=failed_names(examined.flat, config),
                failing=lambda game: failing.in_(game, game.marking),
                progress=progress.report,
            )
    except OSError as problem:
        _refuse(
            f"cannot read `{trace}`: {os_reason(problem)}",
            traces_there(trace, "give a file that can be read"),
            form,
        )


def _is_trace(trace: Path, form: Format) -> bool:
    try:
        with trace.open(encoding="utf-8", errors="replace") as lines:
            head = json.loads(lines.readline(10_000_000))
    except OSError as problem:
        _refuse(
            f"cannot read `{trace}`: {os_reason(problem)}",
            traces_there(trace, "give a file that can be read"),
            form,
        )
    except (ValueError, RecursionError):
        return False
    return isinstance(head, dict) and head.get("trace") == 1


def _refuse(message: str, hint: str, form: Format) -> NoReturn:
    d = Diagnostics()
    d.error(SHOW_RUN, message, Origin("command line"), hint=hint)
    print_diagnostics(d.sorted(), form)
    raise typer.Exit(Exit.USAGE)
