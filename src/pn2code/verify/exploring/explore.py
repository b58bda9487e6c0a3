"""Exploring: the compiled explorer at work, and again with more room where a place turned out to hold more.

found = explore(net, {}, Limits(threads=2), d)
found.nodes, found.complete
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.base.deadline import TimeIsOverError
from pn2code.base.frozen import frozen
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
from pn2code.verify.exploring import covering, nondeterminism, programs, sweep
from pn2code.verify.exploring.counts import Counts
from pn2code.verify.exploring.explorer_process import nothing, run_with_tables
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
from pn2code.verify.swarm import searching

Progress = Callable[[Mapping[str, Any]], None]
"""Is told what the explorer says of itself twice a second: states, arcs, rate, frontier, depth, mib, phase."""
TOO_DEEP = "recursion too deep"
"""What the runtime says of it (pn_num.c)."""
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
            that they mention. `evidence`: a folder, that goes with all in it, for the runs that show answers.
        sizes: what the places of the compiled net hold at first; None: what their structure and initial marking say.
        generated: what an exploration of the same net with the same predicates has generated; gets what this one has.
        quick: the space is likely to be small: it is compiled quickly, and better if it turns out to be large.
        first_states: how many states are seen by what was compiled quickly; None: `programs.FIRST_STATES`.
        turns: the table by which the programs of a cell are looked at in turns; None: they are not.
        counts: with `turns`, the places whose tokens are counted up to a limit only; None: there are none.
        bindings: transitions of which it is told with which bindings they occur, if the graph is not large.
        heaps: places that need not be explored with more than `MOST_HEAPED` tokens: what is wrong has been seen then.
        needs_graph: where markings had to be forgotten, since there was no memory for all, not all was done.
        covering: look for a run that shows that a place grows without bound, and end when there is one.
        ending: of a swarm: the numbers of the questions of which a decided one ends it.
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
    needs_graph: bool = False
    covering: bool = False
    ending: tuple[int, ...] = ()
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
        may_sweep = limits.sweeps is None and options.turns is None and options.counts is None
        may_sweep = may_sweep and set(limits.reductions) <= {Reduction.TIME}
        if found is not None and may_sweep and sweep.may_help(found):
            found = _swept_after(net, storage, limits, d, options, found)
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


def _swept_after(
    net: FlatNet,
    storage: Mapping[str, str],
    limits: Limits,
    d: Diagnostics,
    options: ExploreOptions,
    first: Exploration,
) -> Exploration:
    """What was found within the limit of memory, with what an exploration that forgets markings finds besides."""
    unheard = Diagnostics()
    with suppress(TimeIsOverError), limits.deadline.enforced():
        if sweep.measure(net, storage, limits.reductions, unheard) is None:
            return first
        options.stage("exploring once more, forgetting markings that cannot come back ...")
        again = _explored(net, storage, replace(limits, sweeps=True), unheard, options, None)
        if again is not None:
            return sweep.joined(first, again, needs_graph=options.needs_graph)
    return first


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
    options = _with_own_folder(options)
    try:
        with deadline.enforced():
            if nondeterminism.refuse(net, d):
                return None
            chosen = possible(
                net, limits.reductions, d, options.predicates, storage, options.questions
            )
            if limits.sweeps:
                chosen = sweep.chosen(net, storage, chosen, d)
            made = options.generated or Generated()
            sizes = made.sizes or options.sizes or Sizes.start(net, storage)
    except TimeIsOverError:
        return _too_late(net, limits, time.perf_counter() - began, d)

    def interrupted() -> bool:
        return options.interrupted() or deadline.is_over()

    # Most spaces of large nets are small: it does not pay to have the compiler work for long before that is known.
    is_first = options.quick or len(net.transitions) > programs.MANY
    is_first = is_first and limits.swarm is None
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
                    return chosen.told(Exploration.of(net, seen, compiling), net)
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
            still = ["--still"] if nondeterminism.draws(net) else []
            if limits.swarm is None:
                arguments = [*_arguments(own, chosen, sizes, options), *still]
                deciding = replace(options, progress=_nothing) if is_limited else options
                found = run_with_tables(
                    net, program, arguments, chosen, deciding, limits, d, search
                )
            else:
                arguments = [*_of_all(chosen, sizes, options), *still]
                found = searching.search(
                    net, program, made, arguments, options, limits, limits.swarm, d
                )
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
        if error and error["kind"] == "sweep":
            d.error(
                EXPLORER_FAILED,
                f"the explorer refuses to forget markings: {error['message']}",
                Origin(net.file),
                hint="explore with `--no-sweep`",
            )
            return None
        if error and error["kind"] == "mismatch":
            _differs(net, error, d)
            return None
        if error and error["kind"] == "heap":
            heaped = {**found, "error": None, "why": HEAPED}
            return chosen.told(Exploration.of(net, heaped, compiling), net)
        if not error or error["kind"] not in ("capacity", "memory"):
            return chosen.told(Exploration.of(net, found, compiling), net)
        place = net.places[error["place"]] if error["kind"] == "capacity" else None
        if (
            place is not None
            and place.index in options.heaps
            and sizes.held(place.name) >= MOST_HEAPED
        ):
            heaped = {**found, "error": None, "why": HEAPED}
            return chosen.told(Exploration.of(net, heaped, compiling), net)
        larger = sizes.larger(place.name if place else None)
        if larger is None:
            what = f"place `{place.name}`" if place else "one marking's lists and strings"
            d.error(
                BEYOND_ROOM,
                f"{what} needs more memory than the explorer can give it",
                place.origins[0] if place else Origin(net.file),
                hint="run the net with `pn2code simulate`, limit the place in the net, or limit the exploration",
            )
            return chosen.told(Exploration.of(net, {**found, "why": "memory"}, compiling), net)
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


def _with_own_folder(options: ExploreOptions) -> ExploreOptions:
    """The same with a folder for the runs of this exploration; those of others, whose answers count still, stay."""
    if options.evidence is None:
        return options
    try:
        own = tempfile.mkdtemp(prefix=f"{options.stem}-", dir=options.evidence)
    except OSError:  # the explorer will find out, and whoever wants the runs says so
        return options
    return replace(options, evidence=Path(own))


def _arguments(limits: Limits, chosen: Chosen, sizes: Sizes, options: ExploreOptions) -> list[str]:
    left = limits.deadline.left
    late = None if left is None else max(left * LATE_PART, LEAST_SECONDS)
    # What was seen has to be told within the deadline, too.
    seconds = None if left is None else left * SEARCH_PART
    given: list[tuple[str, object]] = [
        ("--threads", limits.threads),
        ("--order", limits.order.value),
        ("--shuffle", options.shuffle or None),
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
        ("--write-graph", options.graph),
        ("--write-limit", options.graph_limit),
        ("--multiset-limit", options.colours),
        ("--whole", ",".join(map(str, options.whole)) or None),
        ("--bindings", ",".join(map(str, options.bindings)) or None),
        ("--heaps", ",".join(map(str, sorted(options.heaps))) or None),
        ("--most-heaped", MOST_HEAPED if options.heaps else None),
        ("--progress-every", options.pace),
    ]
    arguments = _of_all(chosen, sizes, options)
    arguments += [text for name, value in given if value is not None for text in (name, str(value))]
    arguments += ["--write-part"] if options.part else []
    return arguments + ["--progress"] + ([] if limits.graph else ["--no-graph"])


def _of_all(chosen: Chosen, sizes: Sizes, options: ExploreOptions) -> list[str]:
    """What is the same for each search of a swarm as for an explorer that sees all."""
    given: list[tuple[str, object]] = [
        ("--arena", sizes.memory >> 20),
        ("--initial", options.initial),
        *(("--reduce", reduction.value) for reduction in chosen.reductions),
    ]
    return [text for name, value in given if value is not None for text in (name, str(value))]


def _differs(net: FlatNet, error: Mapping[str, Any], d: Diagnostics) -> None:
    index = error["transition"]
    known = index is not None and index < len(net.transitions)
    d.error(
        REDUCTION_MISMATCH,
        f"the compiled net and the unfolded net differ: {error['message']}",
        net.transitions[index].origin if known else Origin(net.file),
        hint="explore with `--no-reduction`",
    )
