"""`pn2code play`: the token game of a net, in a browser."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from pn2code.base.os_reason import os_reason
from pn2code.cell.codes import INPUT_MISSING
from pn2code.cli.options import (
    DEFAULT_SEED,
    Exit,
    Format,
    FormatOption,
    InputOption,
    NetArgument,
    SeedOption,
    SetOption,
    parse_values,
    port_option,
    print_diagnostics,
    stop,
)
from pn2code.cli.traces_there import traces_there
from pn2code.diagnostics import Diagnostic, Diagnostics, Origin, Severity
from pn2code.diagnostics.codes import register

if TYPE_CHECKING:
    from pn2code.play.seats import Seats

PLAY = register(
    "play-server",
    "the page cannot be served",
    "`pn2code play` listens on a port of the loopback interface (127.0.0.1). The port that `--port` names must be "
    "free; without the option any free one is taken. A trace must be one of the net.",
)

EPILOG = """Examples:

  pn2code play net.cpn

  pn2code play net.cpn --trace net.dead-40.trace.jsonl --port 8080
"""


def play(
    net: NetArgument,
    port: Annotated[
        int, port_option("The port of the page on this machine. 0 is any that is free.")
    ] = 0,
    trace: Annotated[
        Path | None,
        typer.Option(
            "--trace", metavar="FILE", help="Begin with the steps of a trace, which can be undone."
        ),
    ] = None,
    seed: SeedOption = DEFAULT_SEED,
    inputs: InputOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the page in a browser.")
    ] = True,
    form: FormatOption = Format.FULL,
) -> None:
    """Play the token game of a net in a browser: on a page of this machine, for this machine only.

    A net with errors is drawn with them. Ctrl-C ends the server.
    """
    from pn2code.play.app import application
    from pn2code.play.loading import load
    from pn2code.play.seats import Seats
    from pn2code.play.with_arms import WithArms
    from pn2code.web.guard import Guard, new_token
    from pn2code.web.serving import PortTaken, listening, open_browser, serve, url

    if trace is not None and inputs is not None:
        raise typer.BadParameter(
            "a trace says itself what the places begin with: leave one of them out",
            param_hint="--input / --trace",
        )
    d = Diagnostics()
    values = parse_values(settings)
    loaded = load(net, values, d, inputs=inputs)
    if loaded is None:
        stop(d, form)
    if loaded.opened is None:
        print_diagnostics(d.sorted(), form)
    else:
        print_diagnostics((i for i in d.sorted() if _is_urgent(i)), form)
    seats = arms = None
    try:
        if loaded.opened is not None:
            seats = Seats(loaded, seed=seed, trace=trace)
            _try(seats, trace, form)
            if loaded.opened.config is not None and inputs is None:
                arms = WithArms(net, values, seats.folder / "with-arms")
        with listening(port) as (socket, found):
            token = new_token()
            address = url(found, token)
            app = Guard(application(loaded, seats, found, arms), token, found)

            def begun() -> None:
                typer.echo(f"{loaded.path.name}: {address}")
                typer.echo("Ctrl-C ends it.", err=True)
                if browser:
                    open_browser(address)

            serve(app, socket, begun=begun)
    except PortTaken as why:
        _refuse(str(why), "give another one, or leave --port out", form)
    finally:
        if arms is not None:
            arms.close()
        if seats is not None:
            seats.close()
    if loaded.opened is None:
        raise typer.Exit(Exit.MODEL)


def _is_urgent(item: Diagnostic) -> bool:
    """What changes what is played, or will stop it; the page has the other warnings."""
    is_warning = item.severity is Severity.WARNING
    return is_warning and (item.code.startswith("unsupported-") or item.code == INPUT_MISSING)


def _try(seats: Seats, trace: Path | None, form: Format) -> None:
    """Begins a game, so that what is wrong with it is said in the terminal."""
    from pn2code.cli.nets import playing
    from pn2code.play.trouble import Trouble

    try:
        with playing(form):
            seat = seats.prepare()
    except Trouble as trouble:
        _refuse(f"`{trace}`: {trouble.message}", "give a trace of this net", form)
    except OSError as problem:
        hint = traces_there(trace, "give another file") if trace else "give another file"
        _refuse(f"cannot read `{trace}`: {os_reason(problem)}", hint, form)
    for text in seat.session.notices:
        typer.echo(f"pn2code: {text}", err=True)


def _refuse(message: str, hint: str, form: Format) -> NoReturn:
    d = Diagnostics()
    d.error(PLAY, message, Origin("command line"), hint=hint)
    print_diagnostics(d.sorted(), form)
    raise typer.Exit(Exit.USAGE)
