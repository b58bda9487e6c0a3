"""What `verify` says in seconds, once it is known how long each command takes (`pn2code verify CELL --durations`).

    said = with_durations(said, control, opened, limits, asked, folder, d)
    said.durations.layouts[0].cycle.most        # as `pn2code time` has it
    said.answers                                # those with `within N time` are answered

Properties that say within which time an event is followed by another one are answered over all runs in which each
command takes its planned time (`timing.search`). The answer rests on that; where it also holds in whatever order
commands end, if none takes more than its planned time (`timing.anyhow`), it rests on this only.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.base.deadline import TimeIsOverError
from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.graph import Element
from pn2code.geometry.runs import write
from pn2code.properties import meaning as m
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.errors import running
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.timing.answers import Cycle, Layout, seconds_down, seconds_up
from pn2code.timing.contradicted import weighed
from pn2code.timing.doings import NS
from pn2code.timing.look import AT_ONCE, CLOCK_RUNS, PLANNED, Measured, Times, look
from pn2code.timing.own_work import by_own_work
from pn2code.timing.search import TIE, Search
from pn2code.timing.too_long import WHY, Shown, seen_too_long, too_long, why_open
from pn2code.timing.waits import Is, Wait, longest_wait
from pn2code.verdict.opened import OpenNet
from pn2code.verdict.whole import Said, stem
from pn2code.verify.answers.properties import Answer, Evidence
from pn2code.verify.answers.reasons import clause
from pn2code.verify.answers.run_names import run_names
from pn2code.verify.controller.control_types import Control
from pn2code.verify.exploring.limits import Limits

AT_MOST = "no command takes more than its planned time, and messages and the supervisor none (docs/time.md)"
NO_FAULT = "no fault stops a run"


@frozen(eq=False)
class Durations:
    """What was measured, for the screen and for programs."""

    times: Times

    @property
    def lines(self) -> tuple[str, ...]:
        """For the screen."""
        if self.times.why:
            return (f"not known: {self.times.why}",)
        out = []
        for x in self.times.layouts:
            where = f"layout `{x.name}`, " if x.name else ""
            c = x.cycle
            if c.why:
                out.append(f"{where}cycle: not known: {c.why}{_bounds(c)}")
            for e in c.endings if not c.why else ():
                best = "not known" if e.least is None else f"{seconds_down(e.least)} s"
                no_most = "no limit" if c.repeats or c.late else "not known"
                worst = no_most if e.most is None else f"{seconds_up(e.most)} s"
                seconds = f"{best} to {worst}"
                if c.late:
                    seconds = f"not known, as answers may be too late; if none were: {seconds}"
                last = " and ".join(p.rpartition(".")[2] for p in e.places)
                out.append(f"{where}cycle to `{last}`: {seconds}")
            out += [f"{where}{other}" for other in c.others]
        return tuple(out)

    def row(self) -> dict[str, Any]:
        """For programs."""
        return self.times.row()


def with_durations(
    said: Said,
    control: Control | None,
    opened: OpenNet,
    limits: Limits,
    asked: m.Properties,
    folder: Path,
    d: Diagnostics,
) -> Said | None:
    """The same with answers in seconds; None after an error that was reported.

    Args:
        said: what is known without durations.
        control: what is known of the supervisor and the programs, whether or not it is told; None: nothing.
        opened: the cell.
        limits: of the exploration.
        asked: all properties.
        folder: where runs are written.
        d: gets the errors.
    """
    measured: list[Measured] = []
    answers: list[Answer] = []
    times: Times | None = None
    try:
        with limits.deadline.enforced():
            program = None if control is None else control.program
            times = look(opened, None, limits, None, d, measured=measured.append, program=program)
            if times is None:
                return None
            judge = _Judge(control, opened, asked, times, measured, folder)
            for a in said.answers:
                answers.append(judge.answer(a))
    except TimeIsOverError:
        # What was found out by then stays known.
        config = opened.config
        timeout = config.supervisor.reply_timeout_s if config is not None else 0.0
        times = times or Times((), timeout, clause("seconds"))
        for a in said.answers[len(answers) :]:
            answers.append(replace(a, why=clause("seconds")) if is_timed(a) else a)
    said = replace(said, answers=tuple(answers), durations=Durations(times))
    return said if control is None else weighed(said, control.premises, times)


def is_timed(a: Answer) -> bool:
    """Whether the property is about a cell, and says within which time."""
    return (
        a.cell
        and not a.about.of_net
        and isinstance(a.about.asked, m.Response)
        and a.about.asked.time is not None
    )


class _Judge:
    """Answers one property after the other."""

    def __init__(
        self,
        control: Control | None,
        opened: OpenNet,
        asked: m.Properties,
        times: Times,
        measured: Sequence[Measured],
        folder: Path,
    ) -> None:
        self.control, self.opened, self.asked = control, opened, asked
        self.times, self.measured, self.folder = times, measured, folder

    @property
    def _overflow(self) -> str:
        """Why no run is known to come so far; "": nothing is why."""
        found = self.control.overflow if self.control is not None else ""
        return found and f"a run may stop before it: {found}"

    def answer(self, a: Answer) -> Answer:
        """The answer in seconds; another one stays as it is."""
        if not is_timed(a):
            return a
        if self.times.why:
            return replace(a, why=self.times.why)
        found: list[Answer] = []
        for number in range(len(self.measured)):
            found.append(self._in(a, number))
            if found[-1].answer == "no":
                return found[-1]  # with its run, which that of another layout would replace
        for one in found:
            if one.answer == "inconclusive":
                return one
        weakest = max(found, key=lambda x: PLANNED in x.assumes)
        return replace(weakest, value=max(x.value or 0.0 for x in found))

    def _in(self, a: Answer, number: int) -> Answer:
        """In one layout."""
        one, layout = self.measured[number], self.times.layouts[number]
        where = f"in layout `{layout.name}`: " if layout.name else ""
        asked = a.about.asked
        assert isinstance(asked, m.Response) and asked.time is not None

        def open_(why: str) -> Answer:
            return Answer(a.about, "inconclusive", where + why, cell=True)

        cycle = layout.cycle
        first, second = self._event(a, one, asked.first), self._event(a, one, asked.second)
        for event in (first, second):
            if isinstance(event, str):
                return open_(event)
        assert not isinstance(first, str) and not isinstance(second, str)
        limit = math.floor(float(asked.time) * NS)
        search = one.search
        if cycle.why:
            found = open_(cycle.why)
            if cycle.bounded is not None:
                found = self._bounded(a, one, layout, (first, second), limit)
            shown = seen_too_long(one, first, second, limit)
            if shown is not None:
                return open_(self._overflow) if self._overflow else self._shown(a, one, shown)
            own = None if cycle.late else self._by_own_work(a, one, (first, second), limit)
            if own is None or found.answer == "yes":
                return found
            if isinstance(own, Answer):
                return own
            return found if cycle.bounded is not None else open_(f"{cycle.why}; {own}")
        over = _over(search, second)
        wait = longest_wait(search.successors, first, second, over | search.ends, over)
        if wait.ns is None or wait.ns + TIE > limit:
            shown = too_long(one, wait, (first, second), limit, over)
            if shown is not None:
                return open_(self._overflow) if self._overflow else self._shown(a, one, shown)
            return open_(why_open(one, cycle, wait, (first, second), limit))
        others = [self.control.stops] if self.control is not None and self.control.stops else []
        others += layout.cycle.ends
        if others:
            return open_(f"where it comes, it comes in time, but {others[0]}")
        anyhow = one.anyhow
        slow = Wait(None, "open")
        if not anyhow.why and anyhow.adds_up:
            slow = longest_wait(anyhow.successors, first, second, anyhow.ends())
        is_kept = (
            slow.ns is not None and slow.ns + TIE <= limit and anyhow.never_stops(one.runs.latest)
        )
        clock = [CLOCK_RUNS] if search.graph.partition.net.timed else []
        return self._yes(a, wait, AT_MOST if is_kept else PLANNED, *clock)

    def _yes(self, a: Answer, wait: Wait, *assumes: str) -> Answer:
        assert wait.ns is not None
        value = math.ceil((wait.ns + TIE) / (NS // 1000)) / 1000 if wait.way else 0.0
        config = self.opened.config
        at_once = [AT_ONCE] if config is not None and config.sensors else []
        all_of_them = (*assumes, *at_once, NO_FAULT)
        return Answer(a.about, "yes", value=value, cell=True, assumes=all_of_them)

    def _bounded(
        self, a: Answer, one: Measured, layout: Layout, events: tuple[Is, Is], limit: int
    ) -> Answer:
        """Where belts come to a stop: a wait is at most as long as all that is done meanwhile, in whatever order."""
        where = f"in layout `{layout.name}`: " if layout.name else ""
        cycle, anyhow = layout.cycle, one.anyhow
        slow = longest_wait(anyhow.successors, *events, anyhow.ends())
        why = cycle.why
        if slow.ns is not None:
            stops = self.control.stops if self.control is not None else ""
            others = [*([stops] if stops else []), *(cycle.bounded or ())]
            if slow.ns + TIE > limit:
                why = f"{cycle.why}; no wait is longer than {seconds_up(slow.ns)} s"
            elif others:
                why = f"where it comes, it comes in time, but {others[0]}"
            else:
                return self._yes(a, slow, AT_MOST)
        return Answer(a.about, "inconclusive", where + why, cell=True)

    def _by_own_work(
        self, a: Answer, one: Measured, events: tuple[Is, Is], limit: int
    ) -> Answer | str | None:
        """Where not all situations are known: by what one program does between the two events.

        In words how long that is at most where it is too long; None: somebody else is waited for.
        """
        control, anyhow = self.control, one.anyhow
        if control is None or control.stops or anyhow.faults or anyhow.halts:
            return None
        wait = by_own_work(anyhow, *events)
        if wait is None:
            return None
        if wait.ns is None:
            return f"in some order of commands {WHY[wait.why]}" if wait.why in WHY else None
        if wait.ns + TIE > limit:
            return f"no wait is longer than {seconds_up(wait.ns)} s"
        in_time = control.premises.replies.premise
        return self._yes(a, wait, AT_MOST, *([in_time] if in_time else []))

    def _event(self, a: Answer, one: Measured, f: m.Formula) -> Is | str:
        """Whether an element is the event; in words why that is not known."""
        graph = one.search.graph
        atoms = list(m.atoms(f))
        if any(x.kind not in ("fires", "fires so") for x in atoms) or not _is_or(f):
            return "of events with durations only `fires(..)` is looked at"
        game = Game(graph.partition.net, graph.storage, files=Files(None))
        try:
            with running(a.about.origin, "its condition on a binding"):
                found = {
                    e.number
                    for e in graph.elements
                    if not e.is_step
                    and e.owner >= 0
                    and any(self._is(x, game, one, e) for x in atoms)
                }
        except GameError as problem:
            return problem.message
        return found.__contains__

    def _is(self, atom: m.Atom, game: Game, one: Measured, e: Element) -> bool:
        if atom.kind == "fires":
            return atom.number == e.transition
        condition = self.asked.steps[atom.number]
        if condition.transition != e.transition:
            return False
        return game.evaluator.value(condition.exp, one.search.graph.binding(e)) is True

    def _shown(self, a: Answer, one: Measured, shown: Shown) -> Answer:
        """With the run of a wait that is too long, or that has no end."""
        elements = [x for _, x in (*shown.before, *shown.wait.way) if x >= 0]
        name = run_names(p.name for p in self.asked.properties)[a.about.name]
        file = self.folder / f"{stem(self.opened)}.{name}.trace.jsonl"
        run = write(one.search.graph, elements, (), file, self.opened.initial)
        evidence = None if run.file is None else Evidence(run.file, run.steps, None)
        value = None if shown.ns is None else max(0, shown.ns - TIE) // (NS // 1000) / 1000
        return Answer(
            a.about, "no", "", evidence, value=value, cell=True, assumes=(PLANNED,)
        )  # fmt: skip


def _bounds(cycle: Cycle) -> str:
    """Where only they are known."""
    if cycle.bounded is None or cycle.at_least is None or cycle.at_most is None:
        return ""
    return f"; at least {seconds_down(cycle.at_least)} s, and at most {seconds_up(cycle.at_most)} s"


def _over(search: Search, second: Is) -> frozenset[int]:
    """The situations after which the event may not come any more, as the supervisor has finished.

    A robot ends where it hears of that: the command that is under way then it does to its end, but nothing that
    follows. For what a device does nobody waits.
    """
    over = search.graph.over
    return frozenset(
        i
        for i, (state, _, under_way) in enumerate(search.situations)
        if state in over and not any(second(element) for _, element, _ in under_way)
    )


def _is_or(f: m.Formula) -> bool:
    return isinstance(f, m.Atom) or (f.operator == "or" and all(map(_is_or, f.parts)))
