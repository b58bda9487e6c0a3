"""`pn2code report`: everything about a cell in one folder, with a first page that leads to all of it."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from pn2code.base.os_reason import os_reason
from pn2code.base.progress_line import Line
from pn2code.base.writable import why_folder_unwritable
from pn2code.cli.options import (
    OUTPUT_FLAGS,
    BackendChoice,
    Exit,
    Format,
    FormatOption,
    InputOption,
    SetOption,
    parse_values,
    seconds_option,
    stop,
)
from pn2code.diagnostics import Diagnostics

if TYPE_CHECKING:
    from pn2code.cell.config import CellConfig
    from pn2code.dossier.findings import Chapter
    from pn2code.dossier.steps import Done, Step
    from pn2code.dossier.subject import Subject

EPILOG = """Examples:

  pn2code report examples/minimal -o report

  pn2code report examples/riveting -o report --layout paper --backend fake

  cd report && sha256sum --check SHA256SUMS
"""
INDEX, SUMS, TABLE = "index.html", "SHA256SUMS", "traceability.csv"
MARK = ".pn2code-report"
"""A file by which an older report is known, which may be replaced; a folder of somebody else is never."""


def report(
    net: Annotated[
        Path, typer.Argument(help="The folder of a cell (with cell.toml), or a net without one.")
    ],
    out: Annotated[
        Path,
        typer.Option(
            *OUTPUT_FLAGS, help="The folder for the report: a new or empty one, or an older report."
        ),
    ] = Path("report"),
    layouts: Annotated[
        list[str],
        typer.Option(
            "--layout",
            metavar="L",
            help="Run this layout of cell.toml (default: all). This option may be given several times.",
            show_default=False,
        ),
    ] = [],  # noqa: B006 - typer reads the default only
    backend: Annotated[
        BackendChoice, typer.Option(help="What carries the arms, as of `pn2code run`.")
    ] = BackendChoice.BULLET,
    max_seconds: Annotated[
        float | None, seconds_option("Stop verification after S seconds.")
    ] = None,
    durations: Annotated[
        bool,
        typer.Option(
            "--durations",
            help="Measure how long commands take, as `verify --durations` does, for properties in seconds.",
        ),
    ] = False,
    inputs: InputOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    form: FormatOption = Format.FULL,
) -> None:
    """Check, draw, verify, generate, compare and run a cell, and write a report of all of it.

    The report is a folder with a first page, `index.html`: all answers and what they assume, the programs, the runs,
    which line of which program comes from which element of the net, and the hashes of all files.

    The exit code is 0 if all is as it should be, 1 if something is not, and 3 if something is not known.
    """
    from rich.console import Console

    from pn2code.cell.locate import locate
    from pn2code.dossier import findings, steps

    parse_values(settings)
    d = Diagnostics()
    found = locate(net, d)
    if found is None:
        stop(d, form)
    path, config = found
    subject = _subject(path, config, inputs)
    console = Console(highlight=False)
    if durations and config is None:
        _refuse(f"only a cell has durations, and there is no cell.toml beside `{net}`")
    if config is not None and config.folder.resolve().is_relative_to(out.resolve()):
        _refuse(f"the cell is in `{out}`: give another folder with -o")
    _prepare(out)
    wanted = steps.steps(
        _seen_from(out, net),
        _layouts(config, layouts),
        backend=backend.value,
        geometry=_swept(config, layouts, backend),
        values=settings,
        inputs=None if inputs is None else _seen_from(out, inputs),
        max_seconds=max_seconds,
        durations=durations,
    )

    line = Line(first="")

    def name(step: Step) -> str:
        return f"{step.name} ({1 + wanted.index(step)} of {len(wanted)})"

    def say(step: Step, text: str) -> None:
        line.say(f"{name(step)}: {text}")

    def told(step: Step, done: Done | None) -> None:
        if done is None:
            console.print(f"{step.command}", style="dim", soft_wrap=True)
            line.turn_to(name(step))
        else:
            line.clear()
            ended = (
                "left out" if done.code is None else f"exit code {done.code}, {done.seconds:.1f} s"
            )
            console.print(f"  {step.name}: {ended}")

    try:
        with line:
            carried = steps.carry_out(wanted, out, told, say)
        chapters = [findings.read(done, out) for done in carried]
        left_out = _left_out(config, layouts, backend)
        changed = subject.changed(_subject(path, config, inputs))
        _write(chapters, subject.rows, net, out, left_out, changed)
    except OSError as problem:
        _refuse(f"cannot work in `{out}`: {os_reason(problem)}")
    verdict = findings.worst([*(c.answer for c in chapters), *([findings.OPEN] if changed else [])])
    said = (
        _SAYS[verdict] if not left_out else f"{_SAYS_OF_PART[verdict]}; not looked at: {left_out}"
    )
    if changed:
        names = ", ".join(f"`{name}`" for name in changed)
        said += f"; changed while the report was made: {names}"
    console.print(f"report in {out / INDEX}: {said}", soft_wrap=True)
    code = _CODES[verdict]
    if code is not Exit.OK:
        raise typer.Exit(code)


_SAYS = {
    "yes": "all is as it should be",
    "no": "something is not as it should be",
    "not known": "something is not known",
}
_SAYS_OF_PART = {**_SAYS, "yes": "all that was looked at is as it should be"}
_CODES = {"yes": Exit.OK, "no": Exit.MODEL, "not known": Exit.INCONCLUSIVE}


def _refuse(message: str) -> NoReturn:
    typer.echo(f"pn2code: {message}", err=True)
    raise typer.Exit(Exit.USAGE)


def _seen_from(out: Path, path: Path) -> str:
    """A path relative to the folder of the report, so that the report says nothing of other folders."""
    try:
        return os.path.relpath(path.resolve(), out.resolve())
    except ValueError:  # on another drive
        return str(path.resolve())


def _layouts(config: CellConfig | None, wanted: list[str]) -> tuple[str, ...]:
    """The layouts to run; "" for a cell that has none, and nothing for a net without a cell."""
    if config is None:
        if wanted:
            _refuse("a net without a cell.toml has no layouts")
        return ()
    unknown = [name for name in wanted if name not in config.layouts]
    if unknown:
        known = ", ".join(f"`{name}`" for name in config.layouts) or "none"
        _refuse(f"there is no layout `{unknown[0]}`; the cell's layouts: {known}")
    return tuple(dict.fromkeys(wanted)) or tuple(config.layouts) or ("",)


def _swept(config: CellConfig | None, wanted: list[str], backend: BackendChoice) -> tuple[str, ...]:
    """The layouts whose geometry is looked at, "" for all; none without arms, or without what measures distances."""
    if config is None or not config.robots or backend is BackendChoice.FAKE:
        return ()
    return tuple(dict.fromkeys(wanted)) or ("",)


def _left_out(config: CellConfig | None, wanted: list[str], backend: BackendChoice) -> str:
    """What nobody looks at, as it was asked for; "": nothing."""
    if config is None:
        return ""
    found = []
    if config.robots and backend is BackendChoice.FAKE:
        found.append(
            "the moves of the arms, and whether arms and devices keep apart (`--backend fake`)"
        )
    others = [f"`{name}`" for name in config.layouts if wanted and name not in wanted]
    if others:
        what = "the geometry and runs" if _swept(config, wanted, backend) else "runs"
        found.append(f"{what} of layout{'s' * (len(others) > 1)} {', '.join(others)} (`--layout`)")
    return "; ".join(found)


def _prepare(out: Path) -> None:
    """An empty folder; what an older report has left there is removed, and nothing else."""
    why = why_folder_unwritable(out)
    if why:
        _refuse(f"cannot write `{out}`: {why}")
    try:
        if out.is_dir() and any(out.iterdir()):
            if not (out / MARK).is_file():
                _refuse(f"`{out}` is not empty, and no report: give a new folder with -o")
            shutil.rmtree(out)
        out.mkdir(parents=True, exist_ok=True)
        (out / MARK).touch()  # from now on it is a report, if an unfinished one
    except OSError as problem:
        _refuse(f"cannot write `{out}`: {os_reason(problem)}")


def _subject(path: Path, config: CellConfig | None, inputs: Path | None) -> Subject:
    """The net, what stands beside it as TOML or is used by it, the data of the cell, and the models of its arms."""
    from pn2code.dossier.subject import Subject, used

    folder = path.parent if config is None else config.folder
    found = [path, *path.parent.glob("*.toml"), *used(path, config)]
    if config is not None:
        found += [config.path, *(config.input_path(i, inputs) for i in config.inputs)]
        found += [config.folder / s.file for s in config.sensors if s.file]
    return Subject.of(folder, found)


def _write(
    chapters: list[Chapter],
    subject: list[tuple[str, str]],
    net: Path,
    out: Path,
    left_out: str,
    changed: tuple[str, ...],
) -> None:
    """The first page, the table of traceability and the hashes."""
    from pn2code.base.sha256 import sha256_of
    from pn2code.base.whole_file import whole_file
    from pn2code.dossier import hashes, origin, traceability
    from pn2code.dossier.listing import LISTING, listing
    from pn2code.dossier.page import Facts, index
    from pn2code.dossier.pictures import pictures
    from pn2code.dossier.steps import NETS, PROGRAMS

    runs = [
        r
        for c in chapters
        if c.done.step.verb == "run"
        for r in c.done.step.results
        if (out / r / "replay.html").is_file()
    ]
    has_programs = (out / PROGRAMS / "manifest.json").is_file()
    elements = (
        traceability.read(out / PROGRAMS, [out / run for run in runs]) if has_programs else ()
    )
    title = net.resolve().name
    if elements:
        (out / LISTING).write_text(listing(title, out / PROGRAMS, elements), encoding="utf-8")
        (out / TABLE).write_text(traceability.table(elements, runs), encoding="utf-8")
    results = [p for p in out.rglob("*") if p.name not in (INDEX, SUMS)]
    rows = hashes.of_files(out, results)
    facts = Facts(
        title=title,
        written=origin.date(),
        versions=origin.versions(),
        subject=subject,
        results=rows,
        runs=runs,
        pictures={run: pictures(out, run) for run in runs},
        drawn=traceability.drawn(out / NETS),
        elements=elements,
        left_out=left_out,
        changed=changed,
    )
    with whole_file(out / INDEX) as beside:
        beside.write_text(index(chapters, facts), encoding="utf-8")
    rows.append((INDEX, sha256_of(out / INDEX)))
    with whole_file(out / SUMS) as beside:
        beside.write_text(hashes.listing(sorted(rows)), encoding="utf-8")
