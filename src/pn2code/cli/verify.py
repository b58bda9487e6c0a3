"""`pn2code verify`: the state space of a net, and what it says."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, nullcontext
from dataclasses import asdict, replace
from datetime import datetime
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, NoReturn

import typer

from pn2code.base.deadline import Deadline, TimeIsOverError
from pn2code.base.os_reason import os_reason
from pn2code.base.progress_line import Line, told
from pn2code.cli.interrupts import Interrupts
from pn2code.cli.nets import open_net, playing, refuse_wide
from pn2code.cli.options import (
    DEFAULT_INT_BITS,
    PAGES,
    Exit,
    Format,
    FormatOption,
    InputOption,
    IntBitsOption,
    JsonOption,
    NetArgument,
    SetOption,
    check_kind,
    check_writable,
    code_of,
    parse_values,
    print_diagnostics,
    seconds_option,
    stop,
)
from pn2code.cli.subject import Subject
from pn2code.cli.verify_closing import ending
from pn2code.cli.verify_full import full
from pn2code.cli.verify_screen import screen
from pn2code.cli.verify_swarm import (
    SchedulerOption,
    SwarmOption,
    WorkersOption,
    check_options,
    endings,
    swarm_of,
)
from pn2code.cli.verify_sweep import wanted_sweep
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.verdict import channel_model, properties
from pn2code.verdict.asked import Asked
from pn2code.verdict.asked import files as asked_files
from pn2code.verdict.opened import OpenNet
from pn2code.verdict.whole import (
    MOST_COLOURS,
    Checks,
    Said,
    conclude,
    look,
    question,
    stem,
    trace_folder,
)
from pn2code.verify.codes import TIME_OVER
from pn2code.verify.controller.control_types import Control
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import (
    ALONE,
    COUNTS_FROM,
    TURNS_FROM,
    Approximation,
    Limits,
    Order,
    Reduction,
    cores,
)
from pn2code.verify.exploring.result import Exploration, Seen
from pn2code.verify.exploring.result_rows import written
from pn2code.verify.report import writing
from pn2code.verify.report.pictures import GRAPH_KINDS, PLOT_KINDS, Pictures
from pn2code.verify.report.progress import ProgressLine
from pn2code.verify.report.text import report
from pn2code.verify.report.webpage import webpage

_TEXTS = (".txt", "")
"""Endings of reports; a name without one is that of a text, too."""
EPILOG = """Examples:

  pn2code verify net.cpn

  pn2code verify net.cpn --set n=6 --report net.html --threads 2

  pn2code verify net.cpn --max-states 1000000 --max-seconds 60 --json

  pn2code verify small.cpn --draw graph.html

  pn2code verify examples/welding --durations

  pn2code verify examples/shared-zone --geometry

  pn2code verify net.cpn --property "deadlock free" --property "always { size (Mark.Top'Buffer 1) <= 4 }"
"""

TEXTS_PART = 0.9
"""Of the time that is left, what the texts of all colours may take; the rest is for printing them."""
_CODES = {"no": Exit.MODEL, "inconclusive": Exit.INCONCLUSIVE}


def verify(
    net: NetArgument,
    max_states: Annotated[
        int | None, typer.Option(metavar="N", min=1, help="Stop after N markings are found.")
    ] = None,
    max_seconds: Annotated[
        float | None,
        seconds_option(
            "Stop after S seconds. Reading, compiling, exploring and answering count together."
        ),
    ] = None,
    memory: Annotated[
        int | None,
        typer.Option(
            metavar="MIB",
            min=16,
            help="The most memory for the tables.  (default: three quarters of what is free)",
            show_default=False,
        ),
    ] = None,
    threads: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            min=1,
            max=64,
            help="The number of threads.  (default: the number of processors)",
            show_default=False,
        ),
    ] = None,
    order: Annotated[
        Order,
        typer.Option(help="Search breadth first, which finds shortest traces, or depth first."),
    ] = Order.BREADTH,
    approximate: Annotated[
        Approximation | None,
        typer.Option(
            help="Store less than the whole markings. Some may be missed; the report says how many are expected to be."
        ),
    ] = None,
    swarm: SwarmOption = None,
    scheduler: SchedulerOption = None,
    workers: WorkersOption = None,
    reduce: Annotated[
        list[Reduction],
        typer.Option(
            help="Explore a reduced state space (docs/reductions.md). This option may be given several times.",
            show_default=False,
        ),
    ] = [],  # noqa: B006 - typer reads the default only
    no_reduction: Annotated[
        bool,
        typer.Option(
            "--no-reduction",
            help="Explore the full state space, even of a large cell, and with `--reduce`.",
        ),
    ] = False,
    sweep: Annotated[
        bool | None,
        typer.Option(
            "--sweep/--no-sweep",
            help="Forget markings that cannot come back, by a measure of progress (docs/reductions.md); or never.  "
            "(default: once more, where the limit of memory ends the exploration)",
            show_default=False,
        ),
    ] = None,
    unfold: Annotated[
        bool | None,
        typer.Option(
            "--unfold/--no-unfold",
            help="Ask the unfolded net at once, without exploring one marking after the other; or never.  "
            "(default: where a limit ends the exploration)",
            show_default=False,
        ),
    ] = None,
    spill: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            exists=True,
            file_okay=False,
            help="Keep tables that are larger than the memory in this folder.",
        ),
    ] = None,
    report_to: Annotated[
        Path | None,
        typer.Option(
            "--report",
            metavar="FILE",
            help="Write the report to this file: .html (or .htm), or .txt, as without an ending.",
        ),
    ] = None,
    draw_to: Annotated[
        Path | None,
        typer.Option(
            "--draw",
            metavar="FILE",
            help="Draw the graph of a small state space to this file (.svg or .html).",
        ),
    ] = None,
    plot_to: Annotated[
        Path | None,
        typer.Option(
            "--plot",
            metavar="FILE",
            help="Plot states, rate and memory over time and depth to this file (.svg or .png).",
        ),
    ] = None,
    traces: Annotated[
        Path | None,
        typer.Option(
            "--traces",
            "-o",
            metavar="DIR",
            help="The folder for the traces.  (default: NET.traces)",
            show_default=False,
        ),
    ] = None,
    most_traces: Annotated[
        int,
        typer.Option(
            "--most-traces",
            metavar="N",
            min=0,
            help="The most runs to dead markings that are written as traces; 0: no traces of them.",
        ),
    ] = 1,
    graph: Annotated[
        bool,
        typer.Option(
            "--graph/--no-graph",
            help="Compute components, home markings, liveness and fairness, which takes another pass over all arcs.",
        ),
    ] = True,
    texts: Annotated[
        list[str],
        typer.Option(
            "--property",
            metavar="TEXT",
            help="Check this property, e.g. `deadlock free` (docs/properties.md). "
            "This option may be given several times.",
            show_default=False,
        ),
    ] = [],  # noqa: B006 - typer reads the default only
    file: Annotated[
        Path | None,
        typer.Option(
            "--properties",
            metavar="FILE",
            exists=True,
            dir_okay=False,
            help="Check the properties in this file.  (default: NET.properties.toml beside the net, if there is one)",
            show_default=False,
        ),
    ] = None,
    found_properties: Annotated[
        bool,
        typer.Option(
            "--found/--no-found",
            help="Check the properties in NET.properties.toml and in cell.toml.",
        ),
    ] = True,
    check_controller: Annotated[
        bool,
        typer.Option(
            "--controller/--no-controller",
            help="Check the supervisor of a cell against its execution scheme (docs/execution.md).",
        ),
    ] = True,
    check_channel_model: Annotated[
        bool,
        typer.Option(
            "--medium/--no-medium",
            help="Check a cell together with its shared files (docs/protocol.md).",
        ),
    ] = True,
    durations: Annotated[
        bool,
        typer.Option(
            "--durations",
            help="Measure how long each command of a cell takes, as `pn2code time` does, and answer properties "
            "`within N seconds` with it (docs/time.md).",
        ),
    ] = False,
    geometry: Annotated[
        bool,
        typer.Option(
            "--geometry",
            help="Look also at the arms of a cell in space, as `pn2code check --geometry` does: all moves and pairs of "
            "moves that the net permits (docs/geometry.md).",
        ),
    ] = False,
    unbounded_ok: Annotated[
        bool,
        typer.Option(
            "--unbounded-ok",
            help="Go on up to the limits where a place is known to grow without bound.",
        ),
    ] = False,
    as_json: JsonOption = False,
    in_full: Annotated[
        bool,
        typer.Option(
            "--full",
            help="Print the whole report with all runs, and all colours of multi-set bounds.",
        ),
    ] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", "-q", help="Print no progress and no report, only errors.")
    ] = False,
    inputs: InputOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    int_bits: IntBitsOption = DEFAULT_INT_BITS,
    form: FormatOption = Format.FULL,
) -> None:
    """Explore the whole state space of a net, and report its properties.

    It prints the sizes, what is wrong, a run that leads there, and the verdict. With `--full` it prints the report of
    CPN Tools: bounds, dead and home markings, dead and live transitions, fairness, and all runs step by step.

    The exit code is 0 if everything was seen, and 3 if a limit was hit or the exploration was approximate. With
    properties it is 0 if all are true, 1 if one is false, and 3 if one is not known and none is false. With a
    cell.toml the checks of its supervisor count in the same way.
    """
    if unfold and (reduce or approximate or max_states is not None or swarm is not None):
        raise typer.BadParameter(
            "it explores no marking, so that nothing limits, reduces or approximates how it explores them",
            param_hint="--unfold",
        )
    deadline = Deadline.of_command(max_seconds)
    check_kind(draw_to, GRAPH_KINDS, "--draw")
    check_kind(plot_to, PLOT_KINDS, "--plot")
    check_kind(report_to, (*PAGES, *_TEXTS), "--report")
    reductions = () if no_reduction else tuple(dict.fromkeys(reduce))
    unused = (
        ("--order", order is not Order.BREADTH),
        ("--approximate", approximate is not None),
        ("--spill", spill is not None),
        ("--threads", threads is not None),
        ("--durations", durations),
        ("--geometry", geometry),
    )
    check_options(swarm, scheduler, workers, reductions, unused)
    sweeps = wanted_sweep(
        sweep,
        reductions,
        (
            ("--order dfs", order is Order.DEPTH),
            ("--approximate", approximate is not None),
            ("--swarm", swarm is not None),
            ("--unfold", bool(unfold)),
            ("--draw", draw_to is not None),
        ),
    )
    d = Diagnostics()
    try:
        with deadline.enforced():
            opened = open_net(
                net, parse_values(settings), form, int_bits=int_bits, warnings=d, inputs=inputs
            )
            refuse_wide(opened.config, int_bits)
            asked = question(opened, texts, file, d, found=found_properties)
            if unfold and opened.config is not None:
                raise typer.BadParameter(
                    "what is said of a cell is said of its programs, which are explored",
                    param_hint="--unfold",
                )
            if durations and opened.config is None:
                raise typer.BadParameter(
                    f"only a cell has durations, and there is no cell.toml beside `{net}`",
                    param_hint="--durations",
                )
            if geometry:
                _check_geometric(opened, report_to, d)
    except TimeIsOverError:
        _stop_unread(net, d, as_json, form)
    if d.has_errors:
        stop(d, form)
    limits = Limits(
        max_states=ALONE if unfold else max_states,
        deadline=deadline,
        memory=memory,
        threads=threads or cores(),
        order=order,
        approximation=approximate,
        spill=spill,
        graph=graph or bool(asked),
        traces=most_traces,
        reductions=reductions,
        turns_from=None if no_reduction else TURNS_FROM,
        counts_from=None if no_reduction else COUNTS_FROM,
        sweeps=sweeps,
        unfolds=unfold is not False,
        unfolds_alone=bool(unfold),
    )
    is_cell = opened.config is not None and check_controller
    with (
        _folder(traces, stem(opened), wanted=bool(most_traces or asked or is_cell)) as folder,
        Pictures(draw_to, plot_to) as pictures,
        properties.unnamed_runs(asked, folder) as unnamed,
        TemporaryDirectory(prefix="pn2code-") as scratch,
        swarm_of(swarm, scheduler, workers) as wanted_swarm,
    ):
        if wanted_swarm is not None:
            limits = replace(limits, swarm=wanted_swarm, approximation=Approximation.BITSTATE)
        checks = Checks(
            controller=check_controller,
            channel_model=check_channel_model,
            graph=Path(scratch) / "graph.jsonl" if durations else None,
        )
        for path, option in ((draw_to, "--draw"), (plot_to, "--plot"), (report_to, "--report")):
            check_writable(path, option)  # perhaps in the folder that was just made
        line = ProgressLine(
            shown=not (as_json or quiet),
            is_limited=max_states is not None or max_seconds is not None,
            is_timed=opened.flat.timed and Reduction.TIME not in limits.reductions,
        )
        with Interrupts() as interrupts, line as progress:
            options = ExploreOptions(
                traces=folder if most_traces else None,
                stem=stem(opened),
                colours=None if in_full else MOST_COLOURS,
                questions=asked.questions,
                predicates=asked.properties.predicates,
                evidence=unnamed,
                covering=not unbounded_ok and swarm is None,
                ending=endings(asked.plain),
                progress=progress.update,
                stage=progress.stage,
                interrupted=interrupts.is_wanted,
            )
            with playing(form):
                looked = look(
                    opened, asked, limits, options, folder, d, checks, pictures.options(options)
                )
        if looked is None:
            stop(d, form)
        with told("drawing the pictures", shown=not quiet) as after:
            _draw(pictures, opened, looked.found, deadline, d, wanted=bool(draw_to or plot_to))
            after.turn_to("finding what the answers say")
            said = conclude(looked, opened, asked, limits, folder, d, checks)
        if durations:
            said = _timed(said, looked.control, opened, limits, asked, folder, d, form)
        if geometry:
            said = _in_space(said, opened, limits, folder, d, form, quiet=as_json or quiet)
        if in_full:  # sorting all colours and making texts of them takes time, too
            said = replace(
                said,
                found=written(opened.flat, said.found, deadline.share(TEXTS_PART), MOST_COLOURS),
            )
        if report_to is not None:
            subject = None
            if report_to.suffix.lower() in PAGES:
                subject = Subject.of(
                    opened,
                    net,
                    parse_values(settings),
                    asked_files(opened, file, found=found_properties),
                    int_bits=int_bits,
                    complete=said.found.seen.markings or said.found.why == "decided",
                    deadline=deadline,
                )
            with told("writing the report", shown=not quiet):
                _write_report(said, subject, report_to, d)
        if not as_json and not quiet:
            typer.echo(full(said) if in_full else screen(said))
        print_diagnostics(d.sorted(), form)
        if as_json:
            typer.echo(json.dumps(said.row(), indent=1))
    if d.has_errors:
        raise typer.Exit(Exit.MODEL if said.verdict == "no" else code_of(d))
    if said.verdict != "yes":
        raise typer.Exit(_CODES[said.verdict])


def _timed(
    said: Said,
    control: Control | None,
    opened: OpenNet,
    limits: Limits,
    asked: Asked,
    folder: Path,
    d: Diagnostics,
    form: Format,
) -> Said:
    """The same, with answers in seconds."""
    from pn2code.timing.verified import with_durations

    with playing(form):
        timed = with_durations(said, control, opened, limits, asked.properties, folder, d)
    if timed is None:
        stop(d, form)
    return timed


def _check_geometric(opened: OpenNet, report_to: Path | None, d: Diagnostics) -> None:
    """Refuses `--geometry` where there are no arms to look at, or nothing to look with."""
    from pn2code.geometry.check import cell_of, is_there

    if report_to is not None:
        raise typer.BadParameter(
            "the report with the geometry of a cell is that of `pn2code report`",
            param_hint="--geometry",
        )
    config = cell_of(opened, d)
    if config is not None:
        is_there(config, d)


def _in_space(
    said: Said,
    opened: OpenNet,
    limits: Limits,
    folder: Path,
    d: Diagnostics,
    form: Format,
    *,
    quiet: bool,
) -> Said:
    """The same, with what is said of the arms in space."""
    from pn2code.geometry.verified import with_geometry

    with playing(form), Line(shown=not quiet, plain=True) as progress:
        told = with_geometry(said, opened, limits, folder, d, progress.stage, progress.say)
    if told is None:
        stop(d, form)
    return told


def _stop_unread(net: Path, d: Diagnostics, as_json: bool, form: Format) -> NoReturn:
    """Leaves, because the time was over before anything was known."""
    d.warning(
        TIME_OVER,
        "the time was up before the net was read and checked",
        Origin(str(net)),
        hint="give it more time with `--max-seconds`",
    )
    print_diagnostics(d.sorted(), form)
    if as_json:
        none = {"complete": False, "why": "seconds", "seen": asdict(Seen()), "nodes": 0}
        typer.echo(json.dumps(none, indent=1))
    raise typer.Exit(Exit.INCONCLUSIVE)


def _draw(
    pictures: Pictures,
    opened: OpenNet,
    found: Exploration,
    deadline: Deadline,
    d: Diagnostics,
    *,
    wanted: bool,
) -> None:
    """Writes the pictures that are wanted, as long as there is time."""
    try:
        with deadline.enforced() if wanted else nullcontext():
            pictures.write(opened.flat, found, d)
    except TimeIsOverError:
        d.warning(
            TIME_OVER,
            "the time was up before all pictures were drawn",
            Origin(opened.flat.file),
            hint="give it more time with `--max-seconds`",
        )


@contextmanager
def _folder(traces: Path | None, name: str, *, wanted: bool) -> Iterator[Path]:
    """Where traces go: the folder that was named, or one that is named after the net."""
    folder = traces or Path(f"{name}.traces")
    with ExitStack() as stack:
        try:
            made = trace_folder(folder, wanted=wanted, needed=traces is not None)
            stack.enter_context(made)
        except OSError as problem:
            raise typer.BadParameter(
                f"`{folder}`: {os_reason(problem)}", param_hint="--traces"
            ) from None
        yield folder


def _write_report(said: Said, subject: Subject | None, path: Path, d: Diagnostics) -> None:
    """As a page, if there is a subject, or as a text."""
    now = datetime.now().astimezone()
    if subject is not None:
        body = webpage(
            said.net,
            said.found,
            said.storage,
            now,
            said.answers,
            said.control,
            channel_model=list(channel_model.rows(said.channel_model)),
            subject=subject.rows,
            remark=subject.remark,
            counts=said.counts,
            notes=said.notes,
            deadline=said.deadline,
        )
    else:
        body = report(said.net, said.found, now, said.answers, said.control, said.counts)
        if said.channel_model:
            body = f"{body.rstrip()}\n\n\n{channel_model.told(said.channel_model)}\n"
        body = f"{body.rstrip()}\n\n\n{ending(said)}\n"
    writing.write(path, body, d)
