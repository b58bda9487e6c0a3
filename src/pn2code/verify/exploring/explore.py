"""Exploring: the compiled explorer at work, and again with more room where a place turned out to hold more.

found = explore(net, {}, Limits(threads=2), d)
found.nodes, found.complete
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, suppress
from dataclasses import replace
from pathlib import Path
from typing import IO, Any

from pn2code.base.deadline import TimeIsOverError
from pn2code.base.frozen import frozen
from pn2code.base.os_reason import os_reason
from pn2code.base.processor_time import Patience, processor_time
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.net.flat import FlatNet
from pn2code.net.predicate import Predicate
from pn2code.verify.codes import (
    BEYOND_ROOM,
    EXPLORER_FAILED,
    REDUCTION_MISMATCH,
    SPILL_FULL,
    TIME_OVER,
)
from pn2code.verify.exploring import covering, nondeterminism, programs
from pn2code.verify.exploring.counts import Counts
from pn2code.verify.exploring.grace import Grace
from pn2code.verify.exploring.limits import REACHED, Limits, Reduction, default_memory
from pn2code.verify.exploring.meanwhile import Meanwhile
from pn2code.verify.exploring.programs import Generated, Sizes
from pn2code.verify.exploring.reductions import (
    MOST_WITH_TIMES,
    OF_ELEMENTS,
    Chosen,
    possible,
    refuse,
)
from pn2code.verify.exploring.result import Exploration
from pn2code.verify.exploring.time_reduction import why_not_reducible
from pn2code.verify.exploring.turns import Turns

Progress = Callable[[Mapping[str, Any]], None]
"""Is told what the explorer says of itself twice a second: states, arcs, rate, frontier, depth, mib, phase."""
KEPT_ERRORS = 20
"""Lines of what the explorer says that are no progress."""
TOO_DEEP = "recursion too deep"
"""What the runtime says of it (pn_num.c)."""
_TABLES = {
    "--elements": "binding elements",
    "--dependency": "dependencies",
    "--queries": "questions",
    "--turns": "turns",
    "--counts": "limits",
}
HEAPED = "messages"
"""Why an exploration has ended: a place of `ExploreOptions.heaps` holds more than `MOST_HEAPED` tokens."""
MOST_HEAPED = 64
"""Tokens in it, of one value or of several; of a place with counters (`Sizes`), of one colour."""
INFINITE = "infinite"
"""Why an exploration has ended: a covering run was found, so there is no end of markings."""
_LIMITS = (*REACHED, INFINITE)
"""Ends of an exploration after which it is asked whether there would have been another one."""
SEARCH_PART = 0.85
"""Of the time until a deadline, what an explorer may search; the rest is for telling what it has seen.

It ends the search earlier where that will take longer, as far as it can tell.
"""
LATE_PART = 0.95
"""The same, until it breaks off what it works out; soon after, and before the deadline, it says what it knows."""
LEAST_SECONDS = 1e-6
"""No time at all is a limit, too; the explorer wants a positive one."""
_LOOK_S = 0.05
"""So often it is looked whether an explorer is to be ended."""


def _nothing(_: Mapping[str, Any]) -> None:
    """For those who do not care."""


def _silent(_: str) -> None:
    """For those who do not care."""


def _never() -> bool:
    return False


@frozen
class ExploreOptions:
    """What to do besides counting.

    Args:
        traces: a folder for the traces to dead markings and to an exception; None: none are wanted.
        stem: what the names of their files begin with.
        initial: what their headers say of initial markings that are not those of the net's file, as JSON.
        graph: a file for the whole graph, marking by marking; None: not wanted. It is not written when the
            exploration is not complete, or has more than `graph_limit` nodes. `part`: where a limit was reached it is
            written of the first nodes, 200,000 at most; with `cut` at those of which arcs are missing.
        colours: of each multi-set bound at most so many colours are told; None: all. `whole`: places of which all are.
        questions: about the states and the runs (`properties.questions`), "" for none; `predicates`: the conditions
            that they mention. `evidence`: a folder for the runs that show the answers.
        sizes: what the places of the compiled net hold at first; None: what their structure and initial marking say.
        generated: what an exploration of the same net with the same predicates has generated; gets what this one has.
        quick: the space is likely to be small: it is compiled quickly, and better if it turns out to be large.
        first_states: how many states are seen by what was compiled quickly; None: `programs.FIRST_STATES`.
        turns: the table by which the programs of a cell are looked at in turns; None: they are not.
        counts: with `turns`, the places whose tokens are counted up to a limit only; None: there are none.
        bindings: transitions of which it is told with which bindings they occur, if the graph is not large.
        heaps: places that need not be explored with more than `MOST_HEAPED` tokens: what is wrong has been seen then.
        covering: look for a run that shows that a place grows without bound, and end when there is one.
        shuffle: depth first, the order of successors: 0 as they are found, 1 the other way round, others by chance.
        pace: seconds between two tellings of progress.
        progress, interrupted: how the outside hears and says that it has been enough.
        stage: hears in words what is explored next, where several things are.
    """

    traces: Path | None = None
    stem: str = "net"
    initial: str | None = None
    graph: Path | None = None
    graph_limit: int | None = None
    part: bool = False
    colours: int | None = None
    whole: tuple[int, ...] = ()
    questions: str = ""
    predicates: tuple[Predicate, ...] = ()
    evidence: Path | None = None
    sizes: Sizes | None = None
    generated: Generated | None = None
    quick: bool = False
    first_states: int | None = None
    turns: Turns | None = None
    counts: Counts | None = None
    bindings: tuple[int, ...] = ()
    heaps: frozenset[int] = frozenset()
    covering: bool = False
    shuffle: int = 0
    pace: float = 0.5
    progress: Progress = _nothing
    interrupted: Callable[[], bool] = _never
    stage: Callable[[str], None] = _silent


def explore(
    net: FlatNet,
    storage: Mapping[str, str],
    limits: Limits,
    d: Diagnostics,
    options: ExploreOptions | None = None,
) -> Exploration | None:
    """Explores a net; None after an error that was reported.

    Args:
        net: the net.
        storage: as for `Game`.
        limits: how far.
        d: gets the errors.
        options: what else.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    options = options or ExploreOptions()
    bounds = options.sizes.bounds if options.sizes is not None else None
    open_places = None
    time_alone = _may_go_on(net, limits, options.predicates)
    limits = _with_an_end(net, limits, options.predicates)
    is_limited = limits.max_states is not None
    if bounds is not None:
        open_places = [p.index for p in net.places if p.index not in bounds]
        if not open_places and not time_alone:
            options = replace(options, covering=False)  # no place can grow without bound
    with Meanwhile(
        net, storage, open_places, is_limited=is_limited, time_alone=time_alone
    ) as search:
        found = _explored(net, storage, limits, d, options, search if options.covering else None)
        is_open = found is not None and not found.seen.markings and found.why in _LIMITS
        if found is None or not options.covering or not is_open:
            return found
        run = search.last(lambda: options.interrupted() or limits.deadline.is_over())
    if run is None:
        return found
    if options.traces is not None:
        trace = options.traces / f"{options.stem}.unbounded.trace.jsonl"
        run = covering.kept(run, net, storage, trace)
    return replace(found, why=INFINITE, covering=run)


def _may_go_on(net: FlatNet, limits: Limits, predicates: Sequence[Predicate]) -> bool:
    """Whether nothing would end the exploration of a net whose time goes on for ever: no limit, and no reduction."""
    if not net.timed or _is_limited(limits):
        return False
    return Reduction.TIME not in limits.reductions or _keeps_times(net, predicates)


def _with_an_end(net: FlatNet, limits: Limits, predicates: Sequence[Predicate]) -> Limits:
    """The limits, with one of markings where times were to be left out, cannot be, and nothing else is an end."""
    is_wanted = net.timed and Reduction.TIME in limits.reductions
    if not is_wanted or _is_limited(limits) or not _keeps_times(net, predicates):
        return limits
    return replace(limits, max_states=MOST_WITH_TIMES)


def _is_limited(limits: Limits) -> bool:
    return (
        limits.max_states is not None
        or limits.memory is not None
        or limits.processor_seconds is not None
        or limits.deadline.seconds is not None
    )


def _keeps_times(net: FlatNet, predicates: Sequence[Predicate]) -> bool:
    """Whether the reduction by time is refused."""
    return why_not_reducible(net, predicates) is not None


def _explored(
    net: FlatNet,
    storage: Mapping[str, str],
    limits: Limits,
    d: Diagnostics,
    options: ExploreOptions,
    search: Meanwhile | None,
) -> Exploration | None:
    deadline = limits.deadline
    began = time.perf_counter()
    try:
        with deadline.enforced():
            if nondeterminism.refuse(net, d):
                return None
            chosen = possible(net, limits.reductions, d, options.predicates)
            made = options.generated or Generated()
            sizes = made.sizes or options.sizes or Sizes.start(net, storage)
    except TimeIsOverError:
        return _too_late(net, limits, time.perf_counter() - began, d)

    def interrupted() -> bool:
        return options.interrupted() or deadline.is_over()

    # Most spaces of large nets are small: it does not pay to have the compiler work for long before that is known.
    is_first = options.quick or len(net.transitions) > programs.MANY
    first: Mapping[str, Any] | None = None
    compiling = 0.0
    while True:
        began = time.perf_counter()
        with ExitStack() as stack:
            compiled = programs.program(
                net,
                storage,
                sizes,
                d,
                options.predicates,
                interrupted=interrupted,
                quick=is_first,
                made=made,
            )
            program = None
            with suppress(TimeIsOverError), deadline.enforced():
                program = stack.enter_context(compiled)
            compiling += time.perf_counter() - began
            if program is None:
                if d.has_errors or not interrupted():
                    return None
                if not options.interrupted() and first is not None:
                    # The compiler was not done in time: what the program before has seen is what is known.
                    seen = {**first, "why": "seconds"}
                    return Exploration.of(net, seen, compiling)
                if not options.interrupted():
                    return _too_late(net, limits, compiling, d)
                return Exploration.of(net, nothing(net, limits), compiling)
            own = limits
            is_limited = is_first and made.is_quick
            is_first = is_limited or (is_first and options.quick)
            if is_limited:
                first_states = options.first_states or programs.FIRST_STATES
                most = limits.max_states or first_states
                own = replace(limits, max_states=min(most, first_states))
            arguments = _arguments(own, chosen, sizes, options)
            arguments += ["--still"] if nondeterminism.draws(net) else []
            deciding = replace(options, progress=_nothing) if is_limited else options
            found = _run_with_tables(net, program, arguments, chosen, deciding, limits, d, search)
        if found is None:
            return None
        if is_limited and _is_too_much(found, own, limits):
            is_first = False
            first = found if found["why"] == "states" else None
            continue
        if found.get("spill_error") and found["why"] == "memory":
            d.warning(
                SPILL_FULL,
                f"no more can be kept in `{limits.spill}`: {found['spill_error'].lower()}",
                Origin(str(limits.spill)),
            )
        error = found["error"]
        if error and error["kind"] == "reduction" and options.turns is not None:
            d.error(
                EXPLORER_FAILED,
                f"the explorer refuses to take turns: {error['message']}",
                Origin(net.file),
            )
            return None
        if error and error["kind"] == "reduction":
            for reduction in set(OF_ELEMENTS).intersection(chosen.reductions):
                refuse(reduction, error["message"], Origin(net.file), d)
            chosen = chosen.without_elements()
            continue
        if error and error["kind"] == "mismatch":
            _differs(net, error, d)
            return None
        if error and error["kind"] == "heap":
            return Exploration.of(net, {**found, "error": None, "why": HEAPED}, compiling)
        if not error or error["kind"] not in ("capacity", "memory"):
            return replace(
                Exploration.of(net, found, compiling), symmetries=chosen.symmetry_names()
            )
        place = net.places[error["place"]] if error["kind"] == "capacity" else None
        if (
            place is not None
            and place.index in options.heaps
            and sizes.held(place.name) >= MOST_HEAPED
        ):
            return Exploration.of(net, {**found, "error": None, "why": HEAPED}, compiling)
        larger = sizes.larger(place.name if place else None)
        if larger is None:
            what = f"place `{place.name}`" if place else "one marking's lists and strings"
            d.error(
                BEYOND_ROOM,
                f"{what} needs more memory than the explorer can give it",
                place.origins[0] if place else Origin(net.file),
                hint="run the net with `pn2code simulate`, limit the place in the net, or limit the exploration",
            )
            return Exploration.of(net, {**found, "why": "memory"}, compiling)
        sizes = larger
        first = {**found, "error": None}


def _is_too_much(found: Mapping[str, Any], own: Limits, limits: Limits) -> bool:
    """Whether what was compiled quickly has come to an end of its own, not to one that the user has set.

    A stack that is full is full later in what the compiler has worked at for longer.
    """
    said = [found["error"]["message"]] if found["error"] else []
    said += [answer["why"] for answer in found.get("queries") or ()]
    return TOO_DEEP in said or (found["why"] == "states" and own.max_states != limits.max_states)


def _too_late(net: FlatNet, limits: Limits, compiling: float, d: Diagnostics) -> Exploration:
    """Nothing has been explored, since the time was over before that."""
    if all(i.code != TIME_OVER for i in d):
        d.warning(
            TIME_OVER,
            "the time was up before the net was compiled, so no marking has been explored",
            Origin(net.file),
            hint="give it more time with `--max-seconds`; a net that has been compiled once is kept",
        )
    return Exploration.of(net, nothing(net, limits, "seconds"), compiling)


def nothing(net: FlatNet, limits: Limits, why: str = "interrupted") -> dict[str, Any]:
    """What an explorer would have printed that was ended before it began."""
    sizes = ("nodes", "arcs", "depth", "seconds", "bytes_per_state", "peak_mib", "dead_count")
    return {
        **dict.fromkeys(sizes, 0),
        "complete": False,
        "why": why,
        "error": None,
        "threads": limits.threads,
        "fired": [0] * len(net.transitions),
        "dead": [],
        "reductions": [reduction.value for reduction in limits.reductions],
    }


def _counted_only(net: FlatNet, last: Mapping[str, Any]) -> dict[str, Any]:
    """What an explorer has said of itself last that had to be ended: how much it has seen, and nothing of what."""
    return {
        **nothing(net, Limits(), "seconds"),
        "nodes": last.get("states", 0),
        "arcs": last.get("arcs", 0),
        "depth": last.get("depth", 0),
        "seconds": last.get("seconds", 0.0),
        "told": False,
    }


def _arguments(limits: Limits, chosen: Chosen, sizes: Sizes, options: ExploreOptions) -> list[str]:
    left = limits.deadline.left
    late = None if left is None else max(left * LATE_PART, LEAST_SECONDS)
    # What was seen has to be told within the deadline, too.
    seconds = None if left is None else left * SEARCH_PART
    given: list[tuple[str, object]] = [
        ("--threads", limits.threads),
        ("--order", limits.order.value),
        ("--shuffle", options.shuffle or None),
        ("--arena", sizes.memory >> 20),
        ("--max-states", limits.max_states),
        ("--max-seconds", None if seconds is None else max(seconds, LEAST_SECONDS)),
        ("--late-seconds", late),
        ("--memory", limits.memory or default_memory()),
        ("--parent", os.getpid()),
        ("--approximate", limits.approximation.value if limits.approximation else None),
        ("--spill", limits.spill),
        ("--trace-to", options.traces and options.traces / f"{options.stem}.dead-"),
        ("--traces", limits.traces if options.traces else None),
        ("--error-trace-to", options.traces and options.traces / f"{options.stem}.error-"),
        ("--query-trace-to", options.evidence and options.evidence / f"{options.stem}.query-"),
        ("--initial", options.initial),
        ("--write-graph", options.graph),
        ("--write-limit", options.graph_limit),
        ("--multiset-limit", options.colours),
        ("--whole", ",".join(map(str, options.whole)) or None),
        ("--bindings", ",".join(map(str, options.bindings)) or None),
        ("--heaps", ",".join(map(str, sorted(options.heaps))) or None),
        ("--most-heaped", MOST_HEAPED if options.heaps else None),
        ("--progress-every", options.pace),
        *(("--reduce", reduction.value) for reduction in chosen.reductions),
    ]
    arguments = [text for name, value in given if value is not None for text in (name, str(value))]
    arguments += ["--write-part"] if options.part else []
    return arguments + ["--progress"] + ([] if limits.graph else ["--no-graph"])


def _run_with_tables(
    net: FlatNet,
    program: Path,
    arguments: Sequence[str],
    chosen: Chosen,
    options: ExploreOptions,
    limits: Limits,
    d: Diagnostics,
    search: Meanwhile | None,
) -> dict[str, Any] | None:
    """Like `_run`, with files of binding elements (for reductions) and of questions as long as it runs."""
    tables = {
        "--elements": chosen.elements.text() if chosen.elements else "",
        "--dependency": chosen.dependency.text() if chosen.dependency else "",
        "--queries": options.questions,
        "--turns": options.turns.text() if options.turns else "",
        "--counts": options.counts.text() if options.counts else "",
    }
    made: list[Path] = []
    arguments = list(arguments)
    try:
        for option, text in tables.items():
            if not text:
                continue
            try:
                handle, name = tempfile.mkstemp(prefix="pn2code-")
                os.close(handle)
                made.append(Path(name))
                made[-1].write_text(text, encoding="ascii")
            except OSError as problem:
                what = _TABLES[option]
                d.error(
                    EXPLORER_FAILED,
                    f"there is no room for the table of {what}: {os_reason(problem)}",
                    Origin(net.file),
                    hint="explore with `--no-reduction`, or set TMPDIR",
                )
                return None
            arguments += [option, name]
        return _run(net, program, arguments, options, limits, d, search)
    finally:
        for table in made:
            table.unlink(missing_ok=True)


def _differs(net: FlatNet, error: Mapping[str, Any], d: Diagnostics) -> None:
    index = error["transition"]
    known = index is not None and index < len(net.transitions)
    d.error(
        REDUCTION_MISMATCH,
        f"the compiled net and the unfolded net differ: {error['message']}",
        net.transitions[index].origin if known else Origin(net.file),
        hint="explore with `--no-reduction`",
    )


def _run(
    net: FlatNet,
    program: Path,
    arguments: Sequence[str],
    options: ExploreOptions,
    limits: Limits,
    d: Diagnostics,
    search: Meanwhile | None,
) -> dict[str, Any] | None:
    """One process from its start to its last word; it ends when `search` has found a covering run."""
    process = subprocess.Popen(
        [str(program), *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,  # Ctrl-C is for us; we pass it on, once
        env={**os.environ, "LC_ALL": "C"},
    )
    assert process.stdout is not None and process.stderr is not None
    said: list[str] = []
    report: list[bytes] = []
    last: dict[str, Any] = {}
    reader = threading.Thread(target=_read, args=(process.stdout, report), daemon=True)
    listeners = (
        threading.Thread(
            target=_listen, args=(process.stderr, options, said, last, search), daemon=True
        ),
        reader,
    )
    for listener in listeners:
        listener.start()
    told = is_late = is_endless = is_long = False
    if search is not None:
        search.is_heard = False
    grace = Grace(limits.deadline, lambda: processor_time(process.pid))
    patience = None
    if limits.processor_seconds is not None:
        patience = Patience(limits.processor_seconds, lambda: processor_time(process.pid))
    try:
        while True:
            # Its last word wakes us at once; `wait` with a limit would sleep and look.
            reader.join(_LOOK_S)
            if not reader.is_alive():
                with suppress(subprocess.TimeoutExpired):
                    process.wait(_LOOK_S)
                    break
            if not told and options.interrupted():
                told = True
                process.send_signal(signal.SIGINT)
            if search is not None and search.found and search.is_heard and not is_endless:
                is_endless = True
                process.send_signal(signal.SIGUSR1)
            if grace.is_over():  # in an inscription that takes too long, or for ever
                is_late = True
                process.kill()
            if patience is not None and patience.is_over():
                is_long = True
                process.kill()
    except BaseException:
        process.kill()
        process.wait()
        _tidy(options, process.pid)
        raise
    for listener in listeners:
        listener.join()
    try:
        found: dict[str, Any] = json.loads(b"".join(report).decode("utf-8", "surrogateescape"))
    except ValueError:
        _tidy(options, process.pid)
        if told and process.returncode == -signal.SIGINT:  # before it could listen
            return nothing(net, Limits())
        if is_long:
            return {**_counted_only(net, last), "why": "processor"}
        if is_late:
            d.warning(
                TIME_OVER,
                "the explorer did not end when its time was up, and was stopped; of what it had found only the "
                "number of markings is known",
                Origin(net.file),
                hint="an inscription may compute for very long, or for ever; `--max-states` ends it earlier",
            )
            return _counted_only(net, last)
        _bad_end(net, process.returncode, said, d)
        return None
    if found["why"] == "seconds":  # it may have ended in the middle of a trace
        _tidy(options, process.pid)
    return found


def _tidy(options: ExploreOptions, pid: int) -> None:
    """Removes what an explorer that came to a sudden end was writing."""
    if options.traces is not None:
        for part in options.traces.glob(f"*.{pid}.part"):
            with suppress(OSError):
                part.unlink()


def _read(stream: IO[bytes], report: list[bytes]) -> None:
    with stream:
        report.append(stream.read())


def _listen(
    stream: IO[bytes],
    options: ExploreOptions,
    said: list[str],
    last: dict[str, Any],
    search: Meanwhile | None,
) -> None:
    """Hears what an explorer says: progress, of which `last` keeps the last line, and errors, which `said` keeps."""
    with stream:
        for line in stream:
            text = line.decode("utf-8", "replace").rstrip()
            try:
                progress = json.loads(text)
            except ValueError:
                progress = None
            if isinstance(progress, dict):
                last.update(progress)
                options.progress(progress)
                if search is not None:
                    search.note(int(progress.get("states", 0)))
            elif text and len(said) < KEPT_ERRORS:
                said.append(text)


def _bad_end(net: FlatNet, code: int, said: Sequence[str], d: Diagnostics) -> None:
    how = f"was ended by signal {-code}" if code < 0 else f"ended with code {code}"
    d.error(
        EXPLORER_FAILED,
        f"the explorer {how} without a report",
        Origin(net.file),
        notes=said[-3:],
        hint="give it a limit: `--memory MIB` or `--max-states N`",
    )
