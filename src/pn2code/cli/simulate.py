"""`pn2code simulate`: a run at random, with monitors, traces and a report."""

from __future__ import annotations

import json
import math
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from pn2code.base.os_reason import os_reason
from pn2code.base.readable import readable
from pn2code.base.writable import why_file_unwritable
from pn2code.cli.interrupts import Interrupts
from pn2code.cli.nets import open_net
from pn2code.cli.options import (
    DEFAULT_INT_BITS,
    PAGES,
    Engine,
    Exit,
    FilesOption,
    Format,
    FormatOption,
    InputOption,
    IntBitsOption,
    JsonOption,
    NetArgument,
    SetOption,
    check_kind,
    parse_values,
    print_diagnostics,
    stop,
)
from pn2code.cli.traces_there import traces_there
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.semantics.codes import TRACE_REFUSED
from pn2code.semantics.evaluation.connections import LONGEST_WAIT
from pn2code.semantics.game.report import places
from pn2code.simulate.choose import Ready, Wish, monitors_of
from pn2code.simulate.choose import simulate as play
from pn2code.simulate.codes import TRACE_UNWRITABLE
from pn2code.simulate.progress import ProgressLine
from pn2code.simulate.replications import Replications, replicated
from pn2code.simulate.replications import text as replications_text
from pn2code.simulate.report import text
from pn2code.simulate.run import Outcome, Request
from pn2code.trace.script import TraceRefusedError
from pn2code.trace.writing import TraceUnwritableError
from pn2code.verdict.opened import OpenNet, as_traced
from pn2code.verify.codes import REPORT_UNWRITABLE
from pn2code.verify.report import writing
from pn2code.verify.report.performance_page import of_one, of_several

EPILOG = """Examples:

  pn2code simulate net.cpn --steps 100 --seed 7 --trace run.trace.jsonl

  pn2code simulate net.cpn --until 1000 --json

  pn2code simulate net.cpn --replay run.trace.jsonl --steps 100

  pn2code simulate net.cpn --until 10000 --replications 20 --report performance.html
"""

DEFAULT_STEPS = 1000


def simulate(
    net: NetArgument,
    steps: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            min=0,
            help="Stop after N steps (default: 1000; a timed net with --until has no limit).",
            show_default=False,
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            metavar="K",
            min=0,
            max=2**64 - 1,
            help="The seed of all random numbers (default: 1).",
            show_default=False,
        ),
    ] = None,
    until: Annotated[
        str | None, typer.Option(metavar="T", help="Stop before the first step after model time T.")
    ] = None,
    trace: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write the run to this file (docs/trace.md)."),
    ] = None,
    replay: Annotated[
        Path | None,
        typer.Option(
            metavar="TRACE",
            help="Repeat this trace first, then continue. Its steps do not count towards --steps.",
        ),
    ] = None,
    engine: Annotated[
        Engine | None,
        typer.Option(
            help="Use the compiled net or the reference token game. Both make the same run.  "
            "(default: compiled, where that is possible)",
            show_default=False,
        ),
    ] = None,
    monitors: Annotated[
        bool, typer.Option("--monitors/--no-monitors", help="Use the monitors of the net.")
    ] = True,
    breakpoints: Annotated[
        bool, typer.Option("--breakpoints/--no-breakpoints", help="Stop the run at breakpoints.")
    ] = True,
    replications: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            min=2,
            help="Simulate N times, with N seeds, and print averages of the data collectors with confidence intervals.",
            show_default=False,
        ),
    ] = None,
    report: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Write what the data collectors say to this file, .html (or .htm).",
        ),
    ] = None,
    everything: Annotated[
        bool,
        typer.Option("--all", help="Show all places, not only those whose marking has changed."),
    ] = False,
    as_json: JsonOption = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", "-q", help="Print no progress and no report, only errors.")
    ] = False,
    inputs: InputOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    files: FilesOption = None,
    sockets: Annotated[
        float | None,
        typer.Option(
            metavar="SECONDS",
            help="Let code segments talk to other programs (Comms/CPN), and wait at most so long each time. "
            "Without this option a run stops there.",
            show_default=False,
        ),
    ] = None,
    int_bits: IntBitsOption = DEFAULT_INT_BITS,
    form: FormatOption = Format.FULL,
) -> None:
    """Simulate a net: choose an enabled binding element at random, let it occur, and repeat this.

    The same seed gives the same run in both engines. Ctrl-C ends the run and prints the results so far.
    """
    if trace is not None and str(trace) != "-":
        _check_writable(trace, TRACE_UNWRITABLE, f"the trace `{trace}`", form)
    if report is not None:
        check_kind(report, PAGES, "--report")
        _check_writable(report, REPORT_UNWRITABLE, f"`{report}`", form)
    if sockets is not None and not 0 <= sockets <= LONGEST_WAIT:
        raise typer.BadParameter(
            f"it is a number of seconds from 0 to {LONGEST_WAIT}", param_hint="--sockets"
        )
    if replications is not None and (trace is not None or replay is not None):
        raise typer.BadParameter(
            "a trace is of one run: leave one of them out",
            param_hint="--replications / " + ("--replay" if trace is None else "--trace"),
        )
    if replay is not None and inputs is not None:
        raise typer.BadParameter(
            "a trace that is repeated says itself what the places begin with: leave one of them out",
            param_hint="--input / --replay",
        )
    opened = open_net(
        net,
        parse_values(settings),
        form,
        int_bits=int_bits,
        inputs=inputs,
        has_own_marking=replay is not None,
    )
    if replay is not None:
        opened = as_traced(opened, replay)
    limit = _time(until, opened)
    _check_trace(trace, replay, Path(opened.flat.file))
    d = Diagnostics()
    connected = sockets is not None
    program = monitors_of(opened.examined, d, connected=connected) if monitors else None
    found: Replications | None = None
    most = _default_steps(opened, until) if steps is None else steps
    line = ProgressLine(
        shown=not (as_json or quiet),
        steps=most or 0,
        runs=replications or 1,
    )
    with Interrupts() as interrupts, line as progress:
        request = Request(
            net=opened.flat,
            initial=opened.initial,
            storage=opened.storage,
            steps=most,
            seed=seed,
            until=limit,
            trace=trace,
            replay=replay,
            monitors=program,
            breakpoints=breakpoints,
            files=files,
            sockets=sockets,
            progress=progress.update,
            interrupted=interrupts.is_wanted,
        )
        if replications is not None:
            another = partial(_another, engine, d, form, Ready(request))
            found = replicated(request, replications, another)
            outcome = found.outcomes[-1]
        else:
            outcome = _made(request, engine, d, form)
    if outcome.failure is not None:
        outcome.failure.report(d, outcome.steps)
    if outcome.refusal:
        d.error(TRACE_REFUSED, outcome.refusal, Origin(str(replay)))
    flat = opened.flat
    if report is not None:
        page = of_one(flat, outcome) if found is None else of_several(flat, found)
        writing.write(report, page, d)
    if not as_json and not quiet:
        if found is None:
            typer.echo(text(flat, outcome, everything=everything))
        else:
            typer.echo(replications_text(flat.file, found, timed=flat.timed))
    print_diagnostics(d.sorted(), form)
    if as_json:
        said = _json(opened, outcome) if found is None else found.json()
        typer.echo(json.dumps(said, indent=1))
    if any(item.code == REPORT_UNWRITABLE for item in d):
        raise typer.Exit(Exit.USAGE)
    code = _code(outcome)
    if code:
        raise typer.Exit(code)


def _another(
    engine: Engine | None,
    d: Diagnostics,
    form: Format,
    ready: Ready,
    request: Request,
    number: int,
) -> Outcome:
    """One of several simulations; what is said of the first one is not repeated."""
    return _made(request, engine, d if number == 1 else Diagnostics(), form, ready)


def _check_trace(trace: Path | None, *read: Path | None) -> None:
    """A trace must not be written over what is read."""
    if trace is None:
        return
    if str(trace) == "-":
        raise typer.BadParameter("a file is expected", param_hint="--trace")
    for other in read:
        if other is not None and trace.exists() and other.exists() and trace.samefile(other):
            raise typer.BadParameter(f"`{trace}` is read by this run", param_hint="--trace")


def _default_steps(opened: OpenNet, until: str | None) -> int | None:
    """Where nothing else ends a run; a net without model time never comes to one."""
    return None if until is not None and opened.flat.timed else DEFAULT_STEPS


def _time(until: str | None, opened: OpenNet) -> int | float | None:
    """The model time that was given: on an integer clock the last one that is not after it."""
    if until is None:
        return None
    try:
        value = float(until.replace("~", "-"))
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise typer.BadParameter(
            f"`{until}`: a model time is expected, e.g. 100", param_hint="--until"
        )
    if opened.flat.real_time:
        return value
    digits = until.strip().replace("~", "-")
    return int(digits) if digits.lstrip("+-").isdigit() else math.floor(value)


def _check_writable(path: Path, code: str, what: str, form: Format) -> None:
    """What cannot be written is told of before the run."""
    why = why_file_unwritable(path)
    if why:
        d = Diagnostics()
        d.error(code, f"cannot write {what}: {why}", Origin(str(path)))
        print_diagnostics(d.sorted(), form)
        raise typer.Exit(Exit.USAGE)


def _made(
    request: Request,
    engine: Engine | None,
    d: Diagnostics,
    form: Format,
    ready: Ready | None = None,
) -> Outcome:
    """The run; leaves with a message when it cannot be made."""
    wish = Wish(engine.value) if engine is not None else Wish.ANY
    try:
        outcome = play(request, wish, d, ready)
    except (TraceUnwritableError, TraceRefusedError, OSError) as problem:
        if isinstance(problem, TraceUnwritableError):
            d.error(TRACE_UNWRITABLE, str(problem), Origin(str(problem.path)))
        print_diagnostics(d.sorted(), form)
        if not isinstance(problem, TraceUnwritableError):
            typer.echo(f"pn2code: {_sentence(problem, request)}", err=True)
        raise typer.Exit(Exit.USAGE) from None
    if outcome is None:
        if request.interrupted():  # while the net was compiled
            typer.echo("pn2code: interrupted", err=True)
            raise typer.Exit(Exit.INTERRUPTED)
        stop(d, form)
    return outcome


def _sentence(problem: Exception, request: Request) -> str:
    match problem:
        case TraceRefusedError():
            return f"`{request.replay}` cannot be repeated: {problem}"
        case OSError():
            file = Path(problem.filename or request.replay or "")
            there = traces_there(file, "")
            return f"cannot read `{file}`: {os_reason(problem)}{f'; {there}' if there else ''}"
        case _:
            raise AssertionError("no other problem is told in this way")


def _json(opened: OpenNet, outcome: Outcome) -> dict[str, Any]:
    final = outcome.final
    return {
        "engine": outcome.engine,
        "seed": outcome.seed,
        "steps": outcome.steps,
        "replayed": outcome.replayed,
        "time": final.time if final else None,
        "why": outcome.why,
        "places": places(opened.flat, final) if final else [],
        "monitors": list(outcome.monitors),
        "interpreted": list(outcome.interpreted),
        "breakpoint": outcome.breakpoint,
        "error": outcome.failure.row() if outcome.failure else None,
        "refusal": outcome.refusal or None,
        "seconds": round(outcome.seconds, 6),
        "output": readable(outcome.output),
    }


def _code(outcome: Outcome) -> int:
    if outcome.why in ("error", "replay"):
        return Exit.MODEL
    return Exit.INTERRUPTED if outcome.why == "interrupted" else Exit.OK
