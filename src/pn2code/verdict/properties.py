"""The answers to what is asked about a net or cell (`asked`), each looked at again, and shown."""

from __future__ import annotations

import os
import shlex
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.base.deadline import Deadline, TimeIsOverError
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.properties import codes
from pn2code.properties import meaning as m
from pn2code.properties.split import Split, is_about_bindings
from pn2code.semantics.game.errors import GivenUpError
from pn2code.semantics.game.token_game import GameError
from pn2code.semantics.values.data import MlException, MlLimit
from pn2code.trace.script import TraceRefusedError
from pn2code.verdict.asked import Asked, as_text
from pn2code.verdict.opened import OpenNet
from pn2code.verify.answers import confirm
from pn2code.verify.answers.lasso import write_loop
from pn2code.verify.answers.properties import (
    Answer,
    Evidence,
    answers,
    counted,
    drawn,
    from_unfolded,
)
from pn2code.verify.answers.reasons import clause
from pn2code.verify.answers.run_names import run_names
from pn2code.verify.codes import TRACE_UNWRITABLE
from pn2code.verify.controller.cell_answers import of_cell
from pn2code.verify.controller.control_types import Control
from pn2code.verify.controller.running import Running
from pn2code.verify.exploring import nondeterminism
from pn2code.verify.exploring.covering import Covering
from pn2code.verify.exploring.covering import write as write_covering
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits, Reduction
from pn2code.verify.exploring.programs import Sizes
from pn2code.verify.exploring.result import Exploration

_CALLED = {"yes": "true", "no": "false", "inconclusive": "not known"}
_WITH_RUNS = ("complete", "decided", "states", "memory", "error")
"""Ends of an exploration after which there was time to look for the runs, and the way to each marking is known."""

MOST_PUMPED = 100_000
"""Steps of a run that exceeds a bound by repeating its rounds; a longer one is not written."""


def of_bindings(
    asked: Asked,
    opened: OpenNet,
    found: Exploration,
    limits: Limits,
    options: ExploreOptions,
    d: Diagnostics,
    control: Control | None = None,
) -> tuple[Answer, ...]:
    """The answers to properties about bindings, each looked at again; their runs have no names yet.

    Args:
        asked: what is asked.
        opened: the net.
        found: its state space: if that was interrupted, nothing more is explored.
        limits: of each exploration.
        options: those for the net itself.
        d: gets the errors.
        control: what a cell was looked at in; None: the net is no cell.
    """
    # Reductions that look at binding elements keep nothing that is asked here.
    kept = tuple(r for r in limits.reductions if r is Reduction.TIME)
    given: list[Answer] = []
    for number, (split, questions) in enumerate(asked.splits):
        of = {p.name: p for p in asked.properties.properties}
        about = split.properties
        seen: Exploration | None = None
        if found.why not in ("interrupted", "error"):
            own = replace(
                options,
                traces=None,
                stem=f"bindings-{number}",
                questions=questions,
                ending=(),
                predicates=about.predicates,
                sizes=Sizes.start(split.net, opened.storage),
            )
            seen = explore(
                split.net, opened.storage, replace(limits, reductions=kept, graph=True), d, own
            )
        closed = []
        for answer in answers(about, seen.answers if seen else (), seen or found):
            run = answer.evidence
            if run is not None and seen is not None:
                answer = _confirmed(answer, about, split.net, opened, seen, limits.deadline, d)
                with suppress(OSError):
                    split.restore(run.trace)
            closed.append(replace(answer, about=of[answer.about.name], node=None))
        group = tuple(of[p.name] for p in about.properties)
        given += _bindings_of_cell(
            asked, group, opened, control, closed, number, limits, options, d
        )
    return tuple(given)


def _bindings_of_cell(
    asked: Asked,
    group: tuple[m.Property, ...],
    opened: OpenNet,
    control: Control | None,
    closed: Sequence[Answer],
    number: int,
    limits: Limits,
    options: ExploreOptions,
    d: Diagnostics,
) -> Sequence[Answer]:
    """Those of a cell as it runs: its net is made of the parts of the transitions."""
    if control is None:
        return closed
    running = control.running
    if running is not None and control.reduced:
        # What was looked at does more than the cell: in it robots go on after the supervisor's end.
        running = Running.of(control.partition, asked.properties.predicates)
    said: Sequence[Mapping[str, Any]] = ()
    seen = control.found
    is_choosing = False
    about = replace(asked.properties, properties=group)
    is_enough = seen is not None and (seen.complete or seen.why == "decided" or bool(seen.swarm))
    if running is not None and is_enough:
        split = Split.of(running.net, asked.properties, group)
        # Of parts of a transition of the supervisor it is not seen which binding comes first.
        is_choosing = any(
            split.names.count(t.name) > 1
            for t, owner in zip(
                opened.flat.transitions, control.partition.transition_owner, strict=True
            )
            if owner == 0
        )
        lines = running.lines(first=not is_choosing, names=split.names)
        own = replace(
            options,
            traces=None,
            stem=f"cell-bindings-{number}",
            questions="".join(f"{x}\n" for x in lines) + as_text(split.properties, d),
            predicates=split.properties.predicates,
            sizes=Sizes.start(split.net, opened.storage),
            quick=True,
            covering=False,  # its programs choose otherwise than the token game
        )
        kept = (Reduction.TIME,) if opened.flat.timed else ()
        limits = replace(limits, reductions=kept, graph=True, approximation=None)
        seen = explore(split.net, opened.storage, limits, d, own)
        said = seen.answers if seen is not None else ()
        for row in said:
            if row.get("trace"):
                with suppress(OSError):
                    split.restore(Path(row["trace"]))
        about = split.properties
    looked = replace(control, found=seen, running=running, reduced=False)
    return tuple(
        of_cell(
            about,
            said,
            looked,
            closed,
            storage=opened.storage,
            all_orders=is_choosing,
        )
    )


def are_of_states(asked: Asked) -> bool:
    """Whether nothing is asked of the closed net, so that not all of its markings are needed; the cell has its own."""
    if not asked:
        return True
    if asked.partition is None or asked.splits:
        return False
    return not any(p.of_net for p in asked.properties.properties)


@contextmanager
def unnamed_runs(asked: Asked, folder: Path) -> Iterator[Path | None]:
    """A folder for runs as long as they have no name (`answered` gives them one); None: there will be no runs.

    What is in it when the block ends, however it does, is removed.

    Args:
        asked: what is asked.
        folder: where the runs are kept in the end.
    """
    if not asked:
        yield None
        return
    try:
        unnamed = tempfile.TemporaryDirectory(prefix=".pn2code-", dir=folder)
    except OSError:
        yield folder  # the explorer will find out, and `answered` says so
        return
    with unnamed as name:
        yield Path(name)


def answered(
    asked: Asked,
    opened: OpenNet,
    found: Exploration,
    more: Sequence[Answer],
    folder: Path,
    stem: str,
    deadline: Deadline,
    d: Diagnostics,
    control: Control | None = None,
) -> tuple[Answer, ...]:
    """The answers; runs have got readable names, and have been looked at again.

    A run that does not show what it should is an error: then either engine is wrong.

    Args:
        asked: what was asked.
        opened: the net.
        found: its state space.
        more: what `of_bindings` has given.
        folder, stem: where runs are kept, and what their names begin with.
        deadline: when it is over no run is looked at again.
        d: gets the errors.
        control: what a cell was looked at in; None: the net is no cell.
    """
    plain = answers(asked.plain, found.answers, found)
    plain = tuple(from_unfolded(a, found) for a in plain)
    if found.covering is not None:
        plain = tuple(
            _pumped(a, found.covering, opened, folder, number) for number, a in enumerate(plain)
        )
    if nondeterminism.draws(opened.flat):
        plain, more = tuple(map(drawn, plain)), tuple(map(drawn, more))
    if nondeterminism.counts(opened.flat):
        plain, more = tuple(map(counted, plain)), tuple(map(counted, more))
    if control is not None:
        plain = tuple(of_cell(asked.plain, control.answers, control, plain, storage=opened.storage))
    by_name = {answer.about.name: answer for answer in (*plain, *more)}
    given = tuple(by_name[p.name] for p in asked.properties.properties)
    named = _named(given, folder, stem)
    looked = []
    for before, answer in zip(given, named, strict=True):
        if answer.evidence is not None and not is_about_bindings(answer.about):
            looked.append(
                _confirmed(answer, asked.properties, opened.flat, opened, found, deadline, d)
            )
            continue
        is_lost = before.net_evidence is not None and answer.net_evidence is None
        if answer.net_evidence is not None and not is_about_bindings(answer.about):
            of_net = _of_net(answer)
            of_net = _confirmed(of_net, asked.properties, opened.flat, opened, found, deadline, d)
            answer = replace(answer, net_evidence=of_net.evidence)
        is_shownless = (
            answer.answer == "no"
            and _has_run(answer.about.asked)
            and not answer.is_pumped
            and not answer.no_run
        )
        if is_shownless and answer.evidence is None and not had_time(answer, found, control):
            answer = replace(answer, no_run=_how_to_get_a_run(answer, found, control))
        looked.append(answer)
        if answer.evidence is not None or answer.methods:
            continue  # it has been looked at, or it is said why there is none
        if (
            before.evidence is not None
            or is_lost
            or (
                answer.answer == "no"
                and _has_run(answer.about.asked)
                and found.approximation is None
                and had_time(answer, found, control)
            )
        ):
            d.warning(
                TRACE_UNWRITABLE,
                f"the run that shows why `{answer.about.name}` is {_CALLED[answer.answer]} cannot be written",
                answer.about.origin,
                hint=how_to_have_runs(found, None if control is None else control.found),
            )
    return tuple(looked)


def how_to_have_runs(*spaces: Exploration | None) -> str:
    """What to do where a run could not be written."""
    if any(found is not None and found.why == "memory" for found in spaces):
        return "no memory was left to look for the way: give more with `--memory`, or ask for less at once"
    return "give another folder with `--traces DIR`"


def _of_net(a: Answer) -> Answer:
    """What is so of the closed net, of which there is a run, as an answer of its own."""
    return Answer(a.about, a.net or "inconclusive", evidence=a.net_evidence)


def _how_to_get_a_run(a: Answer, found: Exploration, control: Control | None) -> str:
    """Why there is none, and what to type, as a clause."""
    of_cell = control.found if a.cell and control is not None else None
    seen = of_cell or found
    if seen.approximation is not None:
        return "an approximate exploration knows no way to what it has seen"
    alone = ["--no-found", *(["--no-controller"] if control is not None else [])]
    alone += ["--property", _quoted(a.about.holds)]
    return f"{clause(seen.why)}; to look for it alone: `{' '.join(alone)}`"


def _quoted(text: str) -> str:
    """For a shell; names of places have apostrophes."""
    return f'"{text}"' if "'" in text and not set(text) & set('"$`\\!') else shlex.quote(text)


def had_time(answer: Answer, found: Exploration, control: Control | None) -> bool:
    """Whether there was time to look for the run of an answer, in the net and, if it is one of a cell, in that."""
    of_cell = control.found if answer.cell and control is not None else None
    return all(x is None or x.why in _WITH_RUNS for x in (found, of_cell))


def _pumped(a: Answer, run: Covering, opened: OpenNet, folder: Path, number: int) -> Answer:
    """The answer about an upper bound of a place that grows: so many rounds of the run exceed it.

    `number`: of the answer, by which its run is known until it gets a name.
    """
    asked = a.about.asked
    if a.answer != "inconclusive" or not isinstance(asked, m.Bound) or asked.high is None:
        return a
    rounds = run.rounds_to(asked.place, asked.high)
    if rounds is None:
        return a
    steps = len(run.prefix) + rounds * len(run.round)
    found = replace(a, answer="no", why="")
    if steps > MOST_PUMPED:
        return replace(found, is_pumped=True)
    trace = folder / f".pn2code-{os.getpid()}-{number}.trace.jsonl"
    written = write_covering(opened.flat, opened.storage, run, trace, rounds)
    return replace(found, evidence=Evidence(trace, steps, None)) if written else found


def _has_run(asked: m.Asked) -> bool:
    """Whether a run shows that it is false."""
    return isinstance(asked, m.Bound | m.Linear) or (
        isinstance(asked, m.Invariant) and asked.wanted
    )


def _confirmed(
    answer: Answer,
    asked: m.Properties,
    net: FlatNet,
    opened: OpenNet,
    found: Exploration,
    deadline: Deadline,
    d: Diagnostics,
) -> Answer:
    """The answer, of which it is known whether its run has been looked at again.

    Where the number of steps decides, it is not known without a run that can be played: the explorer counts none.
    """
    assert answer.evidence is not None
    counts = nondeterminism.counts(net)
    unplayed = Answer(answer.about, "inconclusive", clause("steps")) if counts else answer
    if answer.evidence.steps > confirm.MOST_STEPS:
        return unplayed
    try:
        with deadline.enforced():
            problem = confirm.problem(
                net,
                opened.storage,
                asked,
                answer,
                exact_times="time" not in found.reductions,
                as_net=not answer.cell,
            )
    except TimeIsOverError:
        return unplayed
    except (GivenUpError, MlLimit) as limit:
        if counts:
            return unplayed
        d.warning(
            codes.UNPLAYED,
            f"the run that shows why `{answer.about.name}` is {_CALLED[answer.answer]} could not be played again: "
            f"{limit}",
            answer.about.origin,
            notes=["the token game, which plays it, evaluates an expression only up to a limit"],
            hint="the answer is that of the explorer, which has no such limit",
        )
        return answer
    except (TraceRefusedError, GameError, OSError, ValueError, MlException) as error:
        problem = str(error)
    if problem is not None and counts:
        return unplayed
    if problem is not None:
        d.error(
            codes.EVIDENCE,
            f"the run that should show why `{answer.about.name}` is {answer.answer} does not: {problem}",
            answer.about.origin,
            notes=[f"the run is {answer.evidence.trace}"],
            hint="the explorer and the token game differ: this is a bug in pn2code",
        )
        return answer
    return replace(answer, evidence=replace(answer.evidence, confirmed=True))


def _named(given: Sequence[Answer], folder: Path, stem: str) -> tuple[Answer, ...]:
    """With traces called by the names of the properties; without those that cannot be called so."""
    names = run_names(answer.about.name for answer in given)
    named = []
    for answer in given:
        if answer.net_evidence is not None:
            trace = folder / f"{stem}.closed-net.{names[answer.about.name]}.trace.jsonl"
            named.append(replace(answer, net_evidence=_kept(answer.net_evidence, trace)))
            continue
        if answer.evidence is None:
            named.append(answer)
            continue
        trace = folder / f"{stem}.{names[answer.about.name]}.trace.jsonl"
        named.append(replace(answer, evidence=_kept(answer.evidence, trace)))
    return tuple(named)


def _kept(run: Evidence, trace: Path) -> Evidence | None:
    """The run in a file of another name; None: it cannot be called so."""
    try:
        if run.loop is not None:
            write_loop(run.trace, run.loop)
        run.trace.replace(trace)
    except OSError:
        return None
    return replace(run, trace=trace)
