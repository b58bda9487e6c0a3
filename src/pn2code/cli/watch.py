"""`pn2code watch`: a cell that runs elsewhere, in a page of this machine."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from pn2code.base.os_reason import os_reason
from pn2code.cli.interrupts import Interrupts
from pn2code.cli.options import (
    Exit,
    Format,
    FormatOption,
    InputOption,
    SetOption,
    parse_values,
    port_option,
    print_but_known,
    stop,
)
from pn2code.diagnostics import Diagnostics

if TYPE_CHECKING:
    from pn2code.live.watched import WatchedCell
    from pn2code.live.watching import Where
    from pn2code.pipeline import Generated

EPILOG = """Examples:

  pn2code watch shared --cell examples/riveting

  pn2code watch run

  pn2code watch shared --cell mycell --trace robot1.trace.jsonl --port 8080
"""

RUN_FILE = "running.json"


def watch(
    directory: Annotated[
        Path,
        typer.Argument(
            metavar="DIR",
            help="The shared directory of a cell, or the folder of a `pn2code run --realtime`.",
        ),
    ],
    cell: Annotated[
        Path | None,
        typer.Option(
            help="The cell (a folder with cell.toml). The folder of a run says itself which."
        ),
    ] = None,
    layout: Annotated[
        str | None, typer.Option(help="The layout of cell.toml (default: the first).")
    ] = None,
    traces: Annotated[
        list[Path],
        typer.Option(
            "--trace",
            metavar="FILE",
            help="A trace that a side of the cell writes. Those in DIR are found by themselves. This option may be "
            "given several times.",
        ),
    ] = [],  # noqa: B006 - typer reads the default only
    port: Annotated[
        int, port_option("The port of the page on this machine. 0 is any that is free.")
    ] = 0,
    inputs: InputOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the page in a browser.")
    ] = True,
    form: FormatOption = Format.FULL,
) -> None:
    """Watch a cell that runs elsewhere: its state, messages, marking and arms, in a page of this machine.

    Nothing is written into the directory, and no file of it is locked: the cell does not notice that it is watched. The
    cell may start, end, and start again meanwhile. Ctrl-C ends the watch, not the cell.
    """
    from pn2code.live.watchserver import serve_watch
    from pn2code.web.guard import new_token
    from pn2code.web.serving import PortTaken, listening, open_browser, url

    run = _running(directory)
    if cell is None and run is None:
        _usage(
            f"`{directory}` does not say which cell runs there (it has no {RUN_FILE} of a `run --realtime`): "
            "name the cell with --cell"
        )
    d = Diagnostics()
    known = run or {}
    found = _cell(
        cell or Path(known["cell"]),
        layout or (known.get("layout") if cell is None else None),
        {**(known.get("values", {}) if cell is None else {}), **parse_values(settings)},
        inputs,
        d,
    )
    if found is None:
        stop(d, form)
    watched, described = found
    print_but_known(d, watched.config.path, form)
    try:
        with listening(port) as (on, number), Interrupts() as wish:
            token = new_token()
            address = url(number, token)

            def begun() -> None:
                typer.echo(f"watching {directory}: {address}")
                typer.echo("Ctrl-C ends the watch; the cell goes on.", err=True)
                if browser:
                    open_browser(address)

            ok = serve_watch(
                on,
                number,
                token,
                watched,
                described,
                lambda: _where(directory, tuple(traces)),
                is_over=wish.is_wanted,
                begun=begun,
            )
    except PortTaken as why:
        _usage(f"{why}; give another one, or leave --port out")
    if not ok:
        raise typer.Exit(Exit.INTERNAL)


def _running(directory: Path) -> dict[str, Any] | None:
    """What the folder of a run says; None: it is no such folder."""
    path = directory / RUN_FILE
    try:
        told = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except OSError as problem:
        _usage(f"cannot read `{path}`: {os_reason(problem)}")
    except ValueError:
        told = None
    is_one = isinstance(told, dict) and told.get("running") == 1
    texts = ("cell", "layout", "shared")
    if not is_one or not all(isinstance(told.get(k), str) for k in texts):
        _usage(f"`{path}` is not what `pn2code run --realtime` writes")
    values = told.get("values", {})
    told["values"] = values if isinstance(values, dict) else {}
    return dict(told)


def _where(directory: Path, traces: tuple[Path, ...]) -> Where:
    """Where the cell is now: a new run in the same folder has other shared files."""
    from pn2code.live.watching import Where

    try:
        told = json.loads((directory / RUN_FILE).read_text(encoding="utf-8"))
        shared = Path(told["shared"])
    except (OSError, ValueError, KeyError, TypeError):
        return Where(directory, traces, directory)
    own = (directory / "supervisor.trace.jsonl", directory / "robots.trace.jsonl")
    return Where(shared, (*own, *traces), run=directory)


def _cell(
    path: Path,
    layout: str | None,
    values: dict[str, str],
    inputs: Path | None,
    d: Diagnostics,
) -> tuple[WatchedCell, dict[str, Any]] | None:
    """The cell, and its description; None after an error that was reported."""
    from pn2code import pipeline
    from pn2code.input_files import begin
    from pn2code.live.described import describe
    from pn2code.live.watched import WatchedCell, initial_of
    from pn2code.net.source import read
    from pn2code.robot import scene

    generated: Generated | None = pipeline.generate(
        path, d, layout=layout, values=values, checked=False
    )
    if generated is None:
        return None
    config, partition = generated.config, generated.partition
    if config is None:
        _usage(f"`{path}` has no cell.toml beside it; give the folder of a cell with --cell")
    robot_cell = scene.load(config.geometry, config.folder, config.locator.origin, d)
    begun = begin(partition.net, config, d, given=inputs)
    document = read(Path(partition.net.file), Diagnostics(), drawn=True)
    if robot_cell is None or document is None or d.has_errors:
        return None
    blocks = {
        f.path.removesuffix(".tdl"): f.blocks for f in generated.files if f.path.endswith(".tdl")
    }
    initial = initial_of((g.name, g.marking) for g in begun.given)
    described = describe(generated, robot_cell, document, 1.0)
    return WatchedCell(partition, config, robot_cell, blocks, initial, generated.failing), {
        **described,
        "watched": True,
    }


def _usage(text: str) -> NoReturn:
    typer.echo(f"pn2code: {text}", err=True)
    raise typer.Exit(Exit.USAGE)
