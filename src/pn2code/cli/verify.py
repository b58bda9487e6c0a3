"""`pn2code verify`: the state space of a net, and what it says."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import asdict, replace
from datetime import datetime
from pathlib import Path
from typing import Annotated, Any

import typer

from pn2code import pipeline
from pn2code.cli import controller, medium, properties
from pn2code.cli.interrupts import Interrupts
from pn2code.cli.nets import OpenNet, open_net, playing, refuse_wide
from pn2code.cli.options import (
    DEFAULT_INT_BITS,
    Exit,
    Format,
    FormatOption,
    IntBitsOption,
    JsonOption,
    SetOption,
    finite,
    parse_values,
    print_diagnostics,
    stop,
)
from pn2code.cli.subject import Subject
from pn2code.cli.verify_screen import Said, closing, full, screen
from pn2code.deadline import Deadline, TimeIsOverError
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.lowering.robot import lower_robots
from pn2code.os_reason import os_reason
from pn2code.verify import chance
from pn2code.verify.answers import Answer, verdict
from pn2code.verify.codes import REPORT_UNWRITABLE, STATE_ERROR, TIME_OVER, TRACE_UNWRITABLE
from pn2code.verify.control_types import Control
from pn2code.verify.explore import Wishes, explore
from pn2code.verify.limits import Approximation, Limits, Order, Reduction, cores
from pn2code.verify.pictures import GRAPH_KINDS, PLOT_KINDS, Pictures
from pn2code.verify.programs import Sizes
from pn2code.verify.progress import ProgressLine
from pn2code.verify.report import report
from pn2code.verify.result import Exploration, Seen
from pn2code.verify.result import row as exploration_row
from pn2code.verify.webpage import webpage
from pn2code.whole_file import whole_file

EPILOG = """Examples:

  pn2code verify net.cpn

  pn2code verify net.cpn --set n=6 --report net.html --threads 2

  pn2code verify net.cpn --max-states 1000000 --max-seconds 60 --json

  pn2code verify small.cpn --draw graph.html

  pn2code verify net.cpn --property "deadlock free" --property "always { size (Mark.Top'Buffer 1) <= 4 }"
"""

MOST_COLOURS = 200
"""Of a multi-set bound, unless all is wanted: a place with a colour for each marking has millions."""


def verify(
    net: Annotated[Path, typer.Argument(help="A .cpn or .pnml file, a cell.toml, or a folder.")],
    max_states: Annotated[
        int | None, typer.Option(metavar="N", min=1, help="Stop after N markings are found.")
    ] = None,
    max_seconds: Annotated[
        float | None,
        typer.Option(
            metavar="S",
            min=0.0,
            callback=finite,
            help="Stop after S seconds. Reading, compiling, exploring and answering count together.",
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
    reduce: Annotated[
        list[Reduction],
        typer.Option(
            help="Explore a reduced state space (docs/reductions.md). This option may be given several times.",
            show_default=False,
        ),
    ] = [],  # noqa: B006 - typer reads the default only
    no_reduction: Annotated[
        bool,
        typer.Option("--no-reduction", help="Explore the full state space, even with `--reduce`."),
    ] = False,
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
            help="Write the report to this file, as HTML if its name ends in .html.",
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
        int, typer.Option("--most-traces", metavar="N", min=0, help="Traces at most.")
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
    check_medium: Annotated[
        bool,
        typer.Option(
            "--medium/--no-medium",
            help="Check a cell together with its shared files (docs/protocol.md).",
        ),
    ] = True,
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
    deadline = Deadline.of_command(max_seconds)
    _check_kind(draw_to, GRAPH_KINDS, "--draw")
    _check_kind(plot_to, PLOT_KINDS, "--plot")
    d = Diagnostics()
    try:
        with deadline.enforced():
            opened = open_net(net, parse_values(settings), form, int_bits=int_bits)
            refuse_wide(opened.config, int_bits)
            partition = pipeline.divided(opened.flat, opened.config, d)
            if partition is not None and opened.config is not None:
                # What is said of a cell is said of its programs: without them there is nothing to say.
                lower_robots(partition, opened.config, d)
            asked = properties.asked(opened, texts, file, d, found=found_properties)
            chance.warn(opened.flat, d)
    except TimeIsOverError:
        d.warning(
            TIME_OVER,
            "the time was over before the net was read and checked",
            Origin(str(net)),
            hint="give it more time with `--max-seconds`",
        )
        print_diagnostics(d.sorted(), form)
        if as_json:
            none = {"complete": False, "why": "seconds", "seen": asdict(Seen()), "nodes": 0}
            typer.echo(json.dumps(none, indent=1))
        raise typer.Exit(Exit.INCONCLUSIVE) from None
    if d.has_errors:
        stop(d, form)
    wanted = () if no_reduction else tuple(dict.fromkeys(reduce))
    limits = Limits(
        max_states=max_states,
        deadline=deadline,
        memory=memory,
        threads=threads or cores(),
        order=order,
        approximation=approximate,
        spill=spill,
        graph=graph or bool(asked),
        traces=most_traces,
        reductions=wanted,
    )
    is_cell = opened.config is not None and check_controller
    with (
        _folder(traces, _stem(opened), wanted=bool(most_traces or asked or is_cell)) as folder,
        Pictures(draw_to, plot_to) as pictures,
        properties.unnamed_runs(asked, folder) as unnamed,
    ):
        with Interrupts() as interrupts, ProgressLine(shown=not (as_json or quiet)) as progress:
            wishes = Wishes(
                traces=folder if most_traces else None,
                stem=_stem(opened),
                colours=None if in_full else MOST_COLOURS,
                questions=asked.questions,
                predicates=asked.properties.predicates,
                evidence=unnamed,
                progress=progress.update,
                interrupted=interrupts.is_wanted,
            )
            control: Control | None = None
            with playing(form):
                # What the places hold is worked out once for all explorations of the net.
                with suppress(TimeIsOverError), deadline.enforced():
                    wishes = replace(wishes, sizes=Sizes.start(opened.flat, opened.storage))
                found = explore(opened.flat, opened.storage, limits, d, pictures.wishes(wishes))
                if found is not None and (check_controller or asked):
                    control = controller.look(opened, found, limits, wishes, folder, d, asked.plain)
                more: Sequence[Answer] = ()
                if found is not None:
                    more = properties.of_bindings(asked, opened, found, limits, wishes, d, control)
                seen: medium.Answers = ()
                if found is not None and check_medium:
                    looked = control if check_controller else None
                    seen = medium.look(opened, found, limits, wishes, d, looked)
        if found is None:
            stop(d, form)
        try:
            with deadline.enforced() if draw_to or plot_to else nullcontext():
                pictures.write(opened.flat, found, d)
        except TimeIsOverError:
            d.warning(
                TIME_OVER,
                "the time was over before all pictures were drawn",
                Origin(opened.flat.file),
                hint="give it more time with `--max-seconds`",
            )
        answers = properties.answered(
            asked, opened, found, more, folder, _stem(opened), deadline, d, control
        )
        if not check_controller:  # it was looked at for properties only
            control = None
        if found.error is not None and found.why == "error":
            _tell_error(opened, found, d)
        if found.graph is not None and len(found.traces) < min(most_traces, found.dead_count):
            _unwritable("a dead marking", folder, d)
        if found.error and found.error.get("node") and most_traces and found.error_trace is None:
            _unwritable("the marking in which an exception is raised", folder, d)
        said = Said(
            opened.flat, opened.storage, found, answers, control, seen, len(d.errors), deadline
        )
        if report_to is not None:
            subject = None
            if report_to.suffix.lower() in (".html", ".htm"):
                subject = Subject.of(
                    opened,
                    net,
                    parse_values(settings),
                    properties.files(opened, file, found=found_properties),
                    int_bits=int_bits,
                    complete=found.seen.markings or found.why == "decided",
                    deadline=deadline,
                )
            _write_report(said, subject, report_to, d)
        if not as_json and not quiet:
            typer.echo(full(said) if in_full else screen(said))
        print_diagnostics(d.sorted(), form)
        if as_json:
            typer.echo(json.dumps(_json(said), indent=1))
    codes = (_code(found, answers, d), controller.code(control), medium.code(seen))
    code = Exit.MODEL if Exit.MODEL in codes else max(codes)
    if code:
        raise typer.Exit(code)


def _json(said: Said) -> dict[str, Any]:
    row = exploration_row(said.net, said.found)
    if said.answers:
        row["properties"] = [a.row() for a in said.answers]
    if said.control is not None:
        row["controller"] = [c.row() for c in said.control.checks]
        row["cell"] = said.control.row()
    if said.medium:
        row["medium"] = [a.row() for a in said.medium]
    return row


@contextmanager
def _folder(traces: Path | None, stem: str, *, wanted: bool) -> Iterator[Path]:
    """Where traces go: the folder that was named, or one that is named after the net; an empty one is not left.

    Args:
        traces: the folder that was named.
        stem: the name of the net, as in the names of its files.
        wanted: whether there may be any; if not, no folder is made.
    """
    folder = traces or Path(f"{stem}.traces")
    is_new = wanted and not folder.exists()
    if wanted:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as problem:
            if traces is not None:
                raise typer.BadParameter(
                    f"`{folder}`: {os_reason(problem)}", param_hint="--traces"
                ) from None
            is_new = False  # nobody has asked for it: what cannot be written into it will be said
    try:
        yield folder
    finally:
        if is_new:
            with suppress(OSError):  # there are traces in it
                folder.rmdir()


def _check_kind(path: Path | None, kinds: tuple[str, ...], option: str) -> None:
    """The ending of a picture's name says its form."""
    if path is not None and path.suffix.lower() not in kinds:
        raise typer.BadParameter(
            f"`{path}` does not end in {' or '.join(kinds)}", param_hint=option
        )


def _stem(opened: OpenNet) -> str:
    """What the names of trace files begin with."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", opened.flat.name) or "net"


def _code(found: Exploration, answers: Sequence[Answer], d: Diagnostics) -> int:
    """Where properties are asked, their answers count, not whether all markings were seen."""
    if d.has_errors:
        return Exit.MODEL
    if answers:
        return {"yes": Exit.OK, "no": Exit.MODEL, "inconclusive": Exit.INCONCLUSIVE}[
            verdict(answers)
        ]
    return Exit.OK if found.complete else Exit.INCONCLUSIVE


def _tell_error(opened: OpenNet, found: Exploration, d: Diagnostics) -> None:
    error, trace = found.error, found.error_trace
    assert error is not None
    index = error.get("transition")
    t = None if index is None else opened.flat.transitions[index]
    where = f"transition `{t.name}`" if t is not None else error["where"]
    notes = [error["where"]] if error["where"] else []
    if error.get("binding"):
        values = ", ".join(f"{name} = {value}" for name, value in error["binding"].items())
        notes.append(f"the occurrence with {values}")
    if error.get("node") is None:
        notes.append("the way there is not known: it takes memory, and markings that are stored")
    if trace is not None:
        notes.append(f"{trace.steps} steps lead to that marking: {trace.file}")
    d.error(
        STATE_ERROR,
        f"{where} raises `{error['message']}` in a reachable marking",
        t.origin if t is not None else Origin(opened.flat.file),
        notes=notes,
        hint="`pn2code simulate` comes there too; guard the inscription, or handle the exception",
    )


def _unwritable(goal: str, folder: Path, d: Diagnostics) -> None:
    d.warning(
        TRACE_UNWRITABLE,
        f"a trace to {goal} cannot be written into `{folder}`",
        Origin(str(folder)),
        hint="give another folder with `--traces DIR`, or none are wanted with `--most-traces 0`",
    )


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
            medium=list(medium.rows(said.medium)),
            subject=subject.rows,
            remark=subject.remark,
            deadline=said.deadline,
        )
    else:
        body = report(said.net, said.found, now, said.answers, said.control)
        if said.medium:
            body = f"{body.rstrip()}\n\n\n{medium.told(said.medium)}\n"
        body = f"{body.rstrip()}\n\n\n{closing(said)}\n"
    try:
        with whole_file(path) as beside:
            beside.write_text(body, encoding="utf-8")
    except OSError as problem:
        d.error(
            REPORT_UNWRITABLE, f"cannot write `{path}`: {os_reason(problem)}", Origin(str(path))
        )
