"""`pn2code run`: a whole cell, the compiled supervisor and its robots, in 3D."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pn2code.base.kept_answers import KeptAnswers
from pn2code.base.os_reason import os_reason
from pn2code.cli.interrupts import Interrupts
from pn2code.cli.options import (
    OUTPUT_FLAGS,
    BackendChoice,
    Exit,
    Format,
    FormatOption,
    InputOption,
    SetOption,
    UncheckedOption,
    finite,
    parse_values,
    port_option,
    print_but_known,
    stop,
)
from pn2code.cli.replay_files import write_replay
from pn2code.cli.run_trouble import trouble_told
from pn2code.diagnostics import Diagnostics

if TYPE_CHECKING:
    from pn2code.live.view import LiveView
    from pn2code.run.hand import Hand
    from pn2code.run.prepare import Prepared

EPILOG = """Examples:

  pn2code run examples/riveting

  pn2code run examples/riveting --layout paper --backend fake --out /tmp/run

  pn2code run examples/riveting --unchecked

  pn2code run examples/riveting --realtime --live

  pn2code run examples/sorting --realtime --live --intervene

  pn2code run examples/sorting --backend fake --cycles 50 --warm-up 5 --seed 1 --stops robot:600/30
"""


def run(
    cell: Annotated[Path, typer.Argument(help="The folder of a cell (with cell.toml).")],
    layout: Annotated[
        str | None, typer.Option(help="The layout of cell.toml to use (default: the first).")
    ] = None,
    inputs: InputOption = None,
    backend: Annotated[
        BackendChoice,
        typer.Option(
            help="`bullet` uses PyBullet and measures clearances; `fake` computes only the kinematics."
        ),
    ] = BackendChoice.BULLET,
    out: Annotated[Path, typer.Option(*OUTPUT_FLAGS, help="The folder for the results.")] = Path(
        "run"
    ),
    pictures: Annotated[
        bool, typer.Option("--pictures/--no-pictures", help="Make pictures and charts.")
    ] = True,
    replay: Annotated[
        bool,
        typer.Option(
            "--replay/--no-replay",
            help="Write replay.html, a page that shows the run, and run.json.",
        ),
    ] = True,
    video: Annotated[bool, typer.Option("--video", help="Also record cell.mp4.")] = False,
    gui: Annotated[bool, typer.Option("--gui", help="Show PyBullet's window.")] = False,
    realtime: Annotated[
        bool,
        typer.Option(
            "--realtime", help="Run in real time; the supervisor is woken when its files change."
        ),
    ] = False,
    speed: Annotated[
        float,
        typer.Option(
            min=0.01,
            max=1000.0,
            callback=finite,
            help="With --realtime, run this many times as fast as real time.",
        ),
    ] = 1.0,
    live: Annotated[
        bool,
        typer.Option(
            "--live",
            help="With --realtime, show the run in a page of this machine while it happens, with a Stop button.",
        ),
    ] = False,
    port: Annotated[
        int, port_option("With --live, the port of the page. 0 is any that is free.")
    ] = 0,
    intervene: Annotated[
        bool,
        typer.Option(
            "--intervene",
            help="With --live, let whoever has a token of its own play a robot or the fault: say what sensors see, "
            "make a command fail, hold a robot, delay or lose messages.",
        ),
    ] = False,
    patience: Annotated[
        float | None,
        typer.Option(
            metavar="S",
            min=0.1,
            max=3600.0,
            callback=finite,
            help="With --intervene, how many seconds a person has to say what a sensor sees. (Default: 15, or half of "
            "reply_timeout_s in cell.toml if that is less.)",
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(metavar="K", help="The seed of the values that sensors draw at random."),
    ] = None,
    cycles: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            min=1,
            max=1_000_000,
            help="Run the cell N times, one run after the other, and report cycle times with their spread, and "
            "throughput. Sensors go on from run to run.",
        ),
    ] = None,
    warm_up: Annotated[
        int,
        typer.Option(
            "--warm-up",
            metavar="K",
            min=0,
            help="With --cycles: run K more before, which are not counted.",
        ),
    ] = 0,
    stops: Annotated[
        list[str],
        typer.Option(
            "--stops",
            metavar="WHO:BETWEEN/LASTING",
            help="With --cycles: a robot or device works BETWEEN seconds on average, then stands LASTING seconds on "
            "average; both are drawn (exponential). This option may be given several times.",
        ),
    ] = [],  # noqa: B006 - typer reads the default only
    unchecked: UncheckedOption = False,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    form: FormatOption = Format.FULL,
) -> None:
    """Run a cell: build the supervisor, run it together with the robots' programs, and report.

    All programs run in lock-step, as fast as possible, so that two runs give the same trace.

    Ctrl-C stops the cell safely and writes the results as far as it went; a second one ends everything at once.
    """
    # PyBullet, SciPy and the like take half a second to load: only this verb needs them.
    from rich.console import Console

    from pn2code.replay.motion import Motion
    from pn2code.report import summary as summaries
    from pn2code.report.album import Album
    from pn2code.run.alone import alone_in
    from pn2code.run.cell import run_cell
    from pn2code.run.observer import Observer
    from pn2code.run.prepare import RunOptions
    from pn2code.run.progress import Progress

    if speed != 1.0 and not realtime:
        raise typer.BadParameter("it has a meaning only with `--realtime`", param_hint="--speed")
    if live and not realtime:
        raise typer.BadParameter("it has a meaning only with `--realtime`", param_hint="--live")
    if port and not live:
        raise typer.BadParameter("it has a meaning only with `--live`", param_hint="--port")
    if intervene and not live:
        raise typer.BadParameter("it has a meaning only with `--live`", param_hint="--intervene")
    if patience is not None and not intervene:
        raise typer.BadParameter(
            "it has a meaning only with `--intervene`", param_hint="--patience"
        )
    if cycles is None and (warm_up or stops):
        raise typer.BadParameter(
            "it has a meaning only with `--cycles`",
            param_hint="--warm-up" if warm_up else "--stops",
        )
    if cycles is not None and (realtime or gui or video):
        raise typer.BadParameter(
            "many runs go on in lock-step and without pictures: not with `--realtime`, `--gui` or `--video`",
            param_hint="--cycles",
        )
    d = Diagnostics()
    console = Console(highlight=False)
    options = RunOptions(
        out=out,
        layout=layout,
        input=inputs,
        backend=backend.value,
        values=parse_values(settings),
        gui=gui,
        realtime=realtime,
        speed=speed,
        looks=(pictures or video) and cycles is None,
        seed=seed,
        checked=not unchecked,
        kept=KeptAnswers.of_user(),
    )
    if cycles is not None:
        from pn2code.cli.run_cycles import rates, run_many
        from pn2code.run.cycles import Plan

        plan = Plan(cycles, warm_up, rates(stops))
        run_many(cell, options, plan, form, replay=replay)
        return
    album = Album(out, pictures=pictures, video=video)
    motion = Motion()
    view = _live_view(port, speed, may_act=intervene) if live else None
    with ExitStack() as stack:
        if view is not None:
            stack.enter_context(view)
        progress = stack.enter_context(Progress(console))
        progress.say("generating and building")
        observers: list[Observer] = [progress, motion]
        if backend is BackendChoice.BULLET:
            observers.append(album)
        if view is not None:
            observers.append(view)
        wish = Interrupts()
        with trouble_told(out), ExitStack() as running:
            stack.enter_context(alone_in(out))

            def ready(prepared: Prepared) -> None:
                if view is not None:
                    view.ready(prepared)
                running.enter_context(wish)  # until now Ctrl-C ends the program

            def interrupted() -> str:
                who = view.interrupted() if view is not None else ""
                return who or ("an interrupt" if wish.is_wanted() else "")

            def hand_of(prepared: Prepared) -> Hand:
                assert view is not None
                return view.lend(prepared, patience)

            result = run_cell(
                cell, options, d, observers, ready=ready, interrupted=interrupted,
                hand_of=hand_of if intervene else None,
            )  # fmt: skip
            if view is not None and view.has_failed:
                typer.echo("pn2code: the live page has ended before the run did", err=True)
        if result is not None and wish.is_wanted():
            progress.clear()
            trace = out / f"{result.prepared.generated.partition.net.name}.trace.jsonl"
            typer.echo(f"pn2code: interrupted; the run as far as it went is in {trace}", err=True)
        if result is not None and pictures:
            progress.say("drawing charts")
            from pn2code.report import charts

            prepared = result.prepared
            limits = charts.Limits(
                prepared.robot_cell.scene.warning_clearance, prepared.config.report.warn_condition
            )
            names = tuple(r.name for r in prepared.config.programs)
            charts.draw(result.record, names, limits, out)
        if result is not None:
            progress.say("writing the replay page")
            try:
                write_replay(result, motion, out, wanted=replay)
            except OSError as problem:
                typer.echo(
                    f"pn2code: cannot write the replay page in `{out}`: {os_reason(problem)}",
                    err=True,
                )
                raise typer.Exit(Exit.USAGE) from None
    if result is None:
        stop(d, form)
    print_but_known(d, cell, form)
    console.print(summaries.page(result.summary))
    if album.is_empty:
        console.print("No pictures of the cell were made, because it has no arms.")
    console.print(f"results in {out}/", style="dim")
    if result.record.verdict != "finished":
        raise typer.Exit(Exit.INTERRUPTED if wish.is_wanted() else Exit.MODEL)


def _live_view(port: int, speed: float, *, may_act: bool) -> LiveView:
    """The live page; its address and the token of its Stop button are printed."""
    from pn2code.live.view import LiveView
    from pn2code.web.serving import PortTaken

    try:
        view = LiveView(port, speed, may_act=may_act)
    except PortTaken as why:
        typer.echo(f"pn2code: {why}; give another one, or leave --port out", err=True)
        raise typer.Exit(Exit.USAGE) from None
    typer.echo(f"live: {view.address}")
    typer.echo(f"with a Stop button that needs no token: {view.stop_address}")
    typer.echo(f"token of the Stop button: {view.stop_token}")
    if may_act:
        typer.echo(f"to play a robot or the fault: {view.act_address}")
    return view
