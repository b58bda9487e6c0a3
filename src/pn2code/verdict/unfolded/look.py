"""What the unfolded net tells where a limit has ended the exploration of all markings, or instead of it.

    found = look(opened, asked, found, limits, options)
    found.unfolded.whole, found.unfolded.told["a property"]

The net is unfolded, and asked by methods that need not visit one marking after the other: decision diagrams with
saturation, structural reductions with the state equation, random walks, searches over stubborn sets (docs/contest.md).
First the sizes of its state space, then whether a marking is dead and the properties, then what occurs, and how many
tokens places hold. What the exploration has seen must agree with it.

It is asked only where its answers are about the same state space (`askable`), and no binding raises an exception.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from pn2code.base.deadline import Deadline, TimeIsOverError
from pn2code.base.frozen import record
from pn2code.contest.building import wait_until_built
from pn2code.contest.engine import engine
from pn2code.contest.evidence import evidence, rests_on
from pn2code.contest.examinations import Asked as Question
from pn2code.contest.lines import Result
from pn2code.contest.portfolio import answers
from pn2code.contest.space import space
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.token_game import Game
from pn2code.unfold.codes import UNFOLDING_FAULT
from pn2code.unfold.net import Unfolding
from pn2code.unfold.unfold import unfold
from pn2code.verdict.asked import Asked
from pn2code.verdict.opened import OpenNet
from pn2code.verdict.unfolded.askable import why_not
from pn2code.verdict.unfolded.conditions import Counted, transition_name
from pn2code.verdict.unfolded.hunt import hunt, write
from pn2code.verdict.unfolded.questions import DEAD, Questions
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import REACHED, Limits, default_memory
from pn2code.verify.exploring.result import Exploration
from pn2code.verify.exploring.unfolded import Told, Unfolded, Whole

_LEAST_S, _MOST_S = 10.0, 300.0
"""Where time is not limited: half of what the exploration took, within these bounds."""
_UNFOLDING = 0.35
"""Of the time, for unfolding: where colours do not end it would go on for ever."""
_ASKING = 0.9
"""Of what is left then, for all questions; the rest is for telling what is known."""
_SIZES = 0.4
_PROPERTIES = 0.7
_RUNS = 0.3
"""Of the time that is left, in this order: for sizes, for properties, for runs; the rest is for the bounds."""
_LEAST_MIB = 256
_LOOK_S = 0.1
_RUN_S = 10.0
_CERTIFICATES_S = 5.0
_DEAD_RUN = ""
"""The name of the run to a dead marking; properties have names."""


def look(
    opened: OpenNet,
    asked: Asked,
    found: Exploration,
    limits: Limits,
    options: ExploreOptions,
    why: str | None = None,
) -> Exploration:
    """The exploration, with what the unfolded net tells besides.

    Args:
        opened: the net, no cell.
        asked: what is asked of it.
        found: what was explored, up to a limit.
        limits, options: of the exploration; runs go where they say.
        why: why it cannot be asked; "": it can; None: that was not looked at yet.

    Raises:
        RuntimeError: the methods contradict each other, or the exploration.
    """
    if found.why not in REACHED or found.approximation is not None or found.covering is not None:
        return found
    if why:
        return _with(found, Unfolded(why=why), limits)
    began = time.monotonic()
    deadline = limits.deadline
    if deadline.is_over():
        return _with(found, Unfolded(why="there was no time to ask it"), limits)
    options.stage("unfolding the net ...")
    sys.set_int_max_str_digits(0)  # numbers of markings may be longer than Python allows
    try:
        with deadline.enforced():
            wait_until_built()
    except TimeIsOverError:
        return _with(found, Unfolded(why="there was no time to compile what asks it"), limits)
    if deadline.left is None:
        deadline = Deadline.after(min(max(_LEAST_S, found.seconds / 2), _MOST_S))
    try:
        with deadline.enforced():
            if why is None and (why := why_not(opened.flat)):
                return _with(found, Unfolded(why=why), limits)
            with deadline.share(_UNFOLDING).enforced():
                unfolding = unfolded(opened.flat)
            if isinstance(unfolding, str):
                return _with(found, Unfolded(why=unfolding), limits)
            game = Game(opened.flat, opened.storage, files=Files(None))
            questions = Questions.of(game, unfolding, asked.plain)
    except TimeIsOverError:
        return _with(found, Unfolded(why="it took too long to unfold it"), limits)
    except GameError as problem:
        return _with(found, Unfolded(why=problem.message), limits)
    built = Diagnostics()
    with engine(built) as program:
        if program is None:  # the explorer may have been kept from before
            return _with(found, Unfolded(why=built.errors[0].message), limits)
        occurred = frozenset(i for i, count in enumerate(found.fired) if count)
        made = Unfolded(
            places=len(unfolding.places),
            transitions=len(unfolding.transitions),
            bounds={},
            told={},
            refused=questions.refused,
        )
        ends = deadline.share(_ASKING)
        asker = _Asker(program, unfolding, questions, ends, limits, options, occurred, made)
        with suppress(TimeIsOverError), _until(options.interrupted).enforced():
            asker.ask_all()
            asker.find_runs(opened)
            asker.find_certificates()
    made = replace(asker.made, seconds=time.monotonic() - began)
    proven = (options.sizes.bounds if options.sizes is not None else None) or {}
    made = without_overflows(opened.flat, made, questions.counted, proven)
    if wrong := contradiction(found, made):
        raise RuntimeError(f"the unfolded net is another one: {wrong}")
    return _with(found, made, limits)


def _with(found: Exploration, made: Unfolded, limits: Limits) -> Exploration:
    made = replace(made, is_alone=limits.unfolds_alone)
    if not limits.unfolds_alone:
        return replace(found, unfolded=made)
    # Nothing is to be said of the initial marking as if it were a state space.
    why = "unfolded" if made.is_asked else "not unfolded"
    return replace(found, why=why, told=False, bounds=None, fired=(), unfolded=made)


def _until(interrupted: Callable[[], bool]) -> Deadline:
    """A deadline that comes when somebody interrupts: it is looked at ten times a second."""
    return Deadline(_LOOK_S, _LOOK_S, lambda: 2 * _LOOK_S if interrupted() else 0.0)


def unfolded(net: FlatNet) -> Unfolding | str:
    """The net unfolded, or why it cannot be asked."""
    d = Diagnostics()
    unfolding = unfold(net, d, with_code=True)
    if unfolding is None:
        error = d.errors[0]
        return f"{error.message}; {error.hint}" if error.hint else error.message
    # Also one that a search for bindings raises: whose tokens are not known, so that it is no `Fault`.
    fault = next((x for x in d if x.code == UNFOLDING_FAULT), None)
    if fault is None:
        return unfolding
    return f"an exception may be raised: {fault.message}; guard what raises it, or handle the exception"


@record
class _Asker:
    """Asks one thing after the other, as far as the time allows.

    `occurred`: transitions that were seen to occur.
    """

    program: Path
    unfolding: Unfolding
    questions: Questions
    deadline: Deadline
    limits: Limits
    options: ExploreOptions
    occurred: frozenset[int]
    made: Unfolded

    @property
    def mebibytes(self) -> int:
        """Of memory for all that runs side by side."""
        return max(self.limits.memory or default_memory(), _LEAST_MIB)

    def _left(self, part: float = 1.0) -> float:
        return part * max(0.0, self.deadline.left or 0.0)

    def ask_all(self) -> None:
        """Sizes, properties, and what a report says of places and transitions."""
        q = self.questions
        if not q.tables.fits():
            self.made = replace(self.made, why="its numbers of tokens are too large")
            return
        self.options.stage("counting the markings of the unfolded net ...")
        sizes = space(self.program, q.tables, seconds=self._left(_SIZES), mebibytes=self.mebibytes)
        if sizes is not None:
            methods = tuple(sizes.method.split())
            self.made = replace(self.made, whole=Whole(sizes.states, sizes.arcs, methods))
        self.options.stage("asking the unfolded net for dead markings and properties ...")
        told: dict[str, Told] = {}
        for result in self._answers([q.dead(), *q.properties], self._left(_PROPERTIES)):
            methods = tuple(result.techniques.split())
            if result.name == DEAD:
                self.made = replace(self.made, has_dead=bool(result.value), dead_methods=methods)
            else:
                told[result.name] = Told(bool(result.value), methods)
        self.made = replace(self.made, told=told)
        self._ask_rest()

    def _answers(self, asked: Sequence[Question], seconds: float) -> Iterable[Result]:
        if not asked or seconds <= 0.0:
            return ()
        return answers(
            self.program, self.questions.tables, asked, seconds=seconds, mebibytes=self.mebibytes
        )

    def _ask_rest(self) -> None:
        """What occurs, as far as it was not seen to, and how many tokens places hold at most."""
        q, net = self.questions, self.unfolding.net
        which = range(len(net.transitions))
        without = {i for i in which if not q.tables.transitions[transition_name(i)]}
        unseen = [i for i in which if i not in without and i not in self.occurred]
        self.options.stage("asking the unfolded net what occurs, and for bounds ...")
        rest = [*q.transitions(unseen), *q.bounds(range(len(net.places)))]
        known = {r.name: r.value for r in self._answers(rest, self._left(1.0 - _RUNS))}
        never = sorted([*without, *(i for i in unseen if known.get(transition_name(i)) is False)])
        open_ = [i for i in unseen if transition_name(i) not in known]
        bounds = {i: int(known[f"p{i}"]) for i in range(len(net.places)) if f"p{i}" in known}
        bounds |= {i: 0 for i, own in enumerate(self.unfolding.of_place) if not own}
        self.made = replace(self.made, never=tuple(never), open_=tuple(open_), bounds=bounds)

    def find_runs(self, opened: OpenNet) -> None:
        """Runs that show what a marking shows, where walks find them."""
        told = dict(self.made.told or {})
        turned = {q.name: q.is_turned for q in self.questions.properties}
        wanted: dict[str, str] = {}
        for name, text in self.questions.shown.items():
            if self.options.evidence and name in told and told[name].holds != turned[name]:
                wanted[name] = text
        if self.made.has_dead and self.options.traces is not None:
            wanted[_DEAD_RUN] = "reach dead"
        self.options.stage("looking for runs in the unfolded net ...")
        seconds = min(self._left(), max(_RUN_S, self._left(_RUNS)))
        found = hunt(self.program, self.unfolding, self.questions.tables, wanted, seconds=seconds)
        for number, (name, steps) in enumerate(sorted(found.items())):
            path = self._path(name, number)
            if not write(self.unfolding, opened.storage, steps, path):
                continue
            run = path, len(steps)
            if name == _DEAD_RUN:
                self.made = replace(self.made, dead_run=run)
            else:
                told[name] = replace(told[name], run=run)
        self.made = replace(self.made, told=told)

    def find_certificates(self) -> None:
        """Evidence for what is not reachable, of the unfolded net as it is."""
        self.options.stage("looking for certificates in the unfolded net ...")
        until = time.monotonic() + min(_CERTIFICATES_S, self._left())
        q, told = self.questions, dict(self.made.told or {})
        turned = {one.name: one.is_turned for one in q.properties}
        for name, text in q.shown.items():
            if name not in told or told[name].holds != turned[name]:
                continue
            found = evidence(text, q.tables, self._name, until)
            is_late = found is None and time.monotonic() > until
            rests = "" if found is not None else rests_on(told[name].methods, is_late=is_late)
            told[name] = replace(told[name], certificate=found, rests=rests)
        self.made = replace(self.made, told=told)
        if self.made.has_dead is False:
            found = evidence("reach dead", q.tables, self._name, until)
            self.made = replace(self.made, dead_certificate=found)

    def _name(self, number: int) -> str:
        """Of an unfolded place, or of the number of steps of a transition, which comes after these."""
        places = self.unfolding.places
        if number < len(places):
            return places[number].name
        return f"steps of {self.unfolding.transitions[number - len(places)].name}"

    def _path(self, name: str, number: int) -> Path:
        """Where a run goes: those of properties get their names later."""
        o = self.options
        if name == _DEAD_RUN:
            assert o.traces is not None
            return o.traces / f"{o.stem}.dead.trace.jsonl"
        assert o.evidence is not None
        return o.evidence / f".pn2code-{os.getpid()}-u{number}.trace.jsonl"


def without_overflows(
    net: FlatNet, made: Unfolded, counted: Mapping[str, Counted], proven: Mapping[int, int]
) -> Unfolded:
    """The same, without answers that no run shows about numbers of tokens that may be too large for `int`.

    Args:
        net: the net.
        made: what is known.
        counted: by name of a property, what its conditions compute from numbers of tokens.
        proven: by place, most tokens, where the structure of the net proves it.
    """
    most = 2 ** (net.program.int_bits - 1) - 1
    bounds = {**proven, **(made.bounds or {})}
    told, refused = dict(made.told or {}), dict(made.refused or {})
    for name, own in counted.items():
        place = own.may_exceed(most, bounds)
        if place is not None and name in told and told[name].run is None:
            del told[name]
            refused[name] = (
                f"its condition counts the tokens of place `{net.places[place].name}`, and whether they are too many "
                "for `int` (`Overflow`) is not known; `bound` asks how many tokens a place holds without that"
            )
    return replace(made, told=told, refused=refused)


def contradiction(found: Exploration, made: Unfolded) -> str:
    """What was seen of the state space and is not in what is said of all of it; "": nothing."""
    if made.whole is not None and not found.is_reduced and made.whole.states < found.nodes:
        return f"there are {made.whole.states} markings, but {found.nodes} were seen"
    if found.dead_count and made.has_dead is False:
        return "there is no dead marking, but one was seen"
    if any(i < len(found.fired) and found.fired[i] for i in made.never):
        return "a transition never occurs that was seen to"
    bounds: Mapping[int, int] = made.bounds or {}
    if any(found.bounds is not None and found.bounds[i].upper > n for i, n in bounds.items()):
        return "places hold fewer tokens at most than were seen in them"
    return ""
