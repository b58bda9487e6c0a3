"""Timers of the supervisor that are over before the answer that they wait for can come.

    Feed:     out feed, out Feeding, out Timer @+1      `feed` tells the conveyor to run its belt, which takes 4 s
    Arrived:  in Feeding, in Timer, in bottle           the conveyor's answer
    Timeout:  in Feeding, in Timer

short_timers(partition, config)[0].text       # "the timer of 1 s that `Feed` starts is over before ..."
warn(partition, config, d)                    # as warnings

It is one only if that is certain: what the owner does between command and answer counts with the least it can take
(moves and measurements: nothing), on the shortest way through its page; no other message ends the wait earlier; and
each such command starts the timer, so that the answer is not that to an earlier one.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from pn2code.base.frozen import frozen
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import OwnerKind, Partition
from pn2code.cell.reach import Reach
from pn2code.diagnostics import Diagnostics, Note
from pn2code.lowering.expressions.values import children
from pn2code.ml.core import terms as core
from pn2code.net.flat import ArcKind, FlatTransition
from pn2code.robot_scripts.machine import Machine, Outcome, Step
from pn2code.robot_scripts.tokens import delayed_tokens
from pn2code.verify.codes import SHORT_TIMER
from pn2code.verify.controller.commands import lasts
from pn2code.verify.controller.durations import Durations
from pn2code.verify.controller.stops import NoProgramError, machine

_TAKING = (ArcKind.INPUT, ArcKind.BOTH)


@frozen
class Least:
    """Seconds that something takes at least, and the commands that take them."""

    seconds: float = 0.0
    commands: tuple[str, ...] = ()

    def __add__(self, other: Least) -> Least:
        """One after the other."""
        return Least(self.seconds + other.seconds, (*self.commands, *other.commands))

    @staticmethod
    def of(ways: Iterable[Least]) -> Least:
        """Of several, one of which is taken."""
        return min(ways, key=lambda x: x.seconds, default=Least())


@frozen
class ShortTimer:
    """A timer, the transition that starts it, the one that occurs when it is over, and what it should wait for."""

    start: FlatTransition
    over: FlatTransition
    text: str


def short_timers(partition: Partition, config: CellConfig) -> list[ShortTimer]:
    """Those of a cell."""
    return list(_Timers(partition, config).found())


def warn(partition: Partition, config: CellConfig, d: Diagnostics) -> None:
    """A warning for each."""
    for short in short_timers(partition, config):
        d.warning(
            SHORT_TIMER,
            short.text,
            short.start.origin,
            notes=[Note(f"`{short.over.short}` occurs when it is over", short.over.origin)],
            hint="make the timer longer than that; how long moves take comes on top",
        )


class _Timers:
    def __init__(self, partition: Partition, config: CellConfig) -> None:
        self._partition = partition
        self._durations = Durations(partition.net, config.storage)
        self._reach = Reach(partition.net.program)
        self._channels = {c.place: c for c in partition.channels}
        self._machines: dict[int, Machine | None] = {}
        self._own = of_supervisor(partition)

    def found(self) -> Iterator[ShortTimer]:
        for start in self._own:
            asked = {
                p: self._channels[p].reader
                for p in puts_one(start, self._partition)
                if p in self._channels
                and self._partition.owners[self._channels[p].writer].kind is OwnerKind.SUPERVISOR
            }
            timers = self._delays(start) if asked else {}
            for place, seconds in timers.items():
                sent = {p: owner for p, owner in asked.items() if self._always_starts(p, place)}
                for over in self._own:
                    text = self._judged(start, over, place, seconds, sent)
                    if text:
                        yield ShortTimer(start, over, text)

    def _always_starts(self, command: int, timer: int) -> bool:
        """Whether no command of this kind is sent without the timer."""
        return all(
            timer in puts_one(t, self._partition)
            for t in self._own
            if any(a.place == command and a.kind is ArcKind.OUTPUT for a in t.arcs)
        )

    def _delays(self, start: FlatTransition) -> dict[int, float]:
        """By place of the supervisor the most seconds after which a token of the transition is there."""
        found: dict[int, float] = {}
        for place, delays in timers(start, self._partition):
            seconds = [self._durations.seconds(e) for e in delays]
            known = [s for s in seconds if s is not None]
            if delays and len(known) == len(seconds):
                found[place] = sum(known)
        return found

    def _judged(
        self,
        start: FlatTransition,
        over: FlatTransition,
        timer: int,
        seconds: float,
        asked: dict[int, int],
    ) -> str:
        """What is wrong with a timer; "": nothing that is certain."""
        waiting = ended(start, over, timer, self._partition)
        longest: tuple[float, str] | None = None
        for other in self._own:
            inputs = taken(other)
            if other is over or not inputs & waiting:
                continue
            answers = [p for p in inputs if p in self._channels]
            if not answers:
                continue  # nobody's answer: a choice of the supervisor
            spent = [
                self._between(command, owner, p)
                for p in answers
                for command, owner in asked.items()
            ]
            known = [s for s in spent if s is not None and s[0].seconds > seconds]
            if not known:
                return ""
            least, who, command, answer = max(known, key=lambda s: s[0].seconds)
            if longest is None or least.seconds < longest[0]:
                names = " and ".join(f"`{n}`" for n in dict.fromkeys(least.commands))
                with_ = f" ({names})" if names else ""
                longest = (
                    least.seconds,
                    f"{who} takes at least {least.seconds:g} s{with_} from `{command}` to `{answer}`",
                )
        if longest is None:
            return ""
        return (
            f"the timer of {seconds:g} s that `{start.short}` starts is over before the answer that it waits for can "
            f"come: {longest[1]}"
        )

    def _between(self, command: int, owner: int, answer: int) -> tuple[Least, str, str, str] | None:
        """The least time from a command to an answer; None: it may come without the command, or is another's."""
        if self._channels[answer].writer != owner:
            return None
        program = self._machine(owner)
        if program is None or _comes_unasked(program, command, answer):
            return None
        at: dict[int, Least] = {}
        ends: list[Least] = []
        steps = [(s, o, self._spent(s)) for s in program.steps for o in s.outcomes]
        for _ in range(len(program.control) + 1):
            ends = []
            for step, outcome, acts in steps:
                before = Least() if _takes(step, command) else at.get(_here(program, step))
                if before is None:
                    continue
                if _puts(outcome, answer):
                    ends.append(before + acts)
                    continue
                there, after = (
                    program.target(outcome),
                    before + acts + self._delay(step, outcome, program),
                )
                if there not in at or after.seconds < at[there].seconds:
                    at[there] = after
        if not ends:
            return None
        names = self._channels[command].name, self._channels[answer].name
        return Least.of(ends), self._partition.owners[owner].phrase, *names

    def _machine(self, owner: int) -> Machine | None:
        if owner not in self._machines:
            try:
                self._machines[owner] = machine(self._partition, owner)
            except NoProgramError:
                self._machines[owner] = None
        return self._machines[owner]

    def _spent(self, step: Step) -> Least:
        code = step.transition.code
        if code is None:
            return Least()
        self._reach.add_locals(code.action)
        return self._least(code.action, frozenset())

    def _delay(self, step: Step, outcome: Outcome, program: Machine) -> Least:
        delays = [e for p, e in outcome.delays if p == program.target(outcome)]
        delays += [] if step.transition.delay is None else [step.transition.delay]
        return sum((Least(self._shortest(e)) for e in delays), Least())

    def _shortest(self, e: core.Exp) -> float:
        return shortest(self._durations, e)

    def _least(self, e: core.Exp, inside: frozenset[int]) -> Least:
        """What the commands of an expression take at least; what is not understood takes nothing."""
        match e:
            case core.Apply(core.Var(symbol=symbol), argument):
                return self._least(argument, inside) + self._called(symbol, argument, inside)
            case core.If(condition, then, otherwise):
                chosen = Least.of((self._least(then, inside), self._least(otherwise, inside)))
                return self._least(condition, inside) + chosen
            case core.Case(scrutinee, rules):
                chosen = Least.of(self._least(r.body, inside) for r in rules)
                return self._least(scrutinee, inside) + chosen
            case core.Let(declarations, body):
                values = [d.value for d in declarations if isinstance(d, core.ValBind)]
                return sum((self._least(x, inside) for x in [*values, body]), Least())
            case core.RecordExp() | core.Sequence():
                return sum((self._least(x, inside) for x in children(e)), Least())
        return Least()

    def _called(self, symbol: core.Symbol, argument: core.Exp, inside: frozenset[int]) -> Least:
        primitive = self._partition.primitives.get(symbol.uid)
        if primitive is not None:
            known = lasts(primitive, argument)
            if known is None and primitive.command == "wait":
                known = self._shortest(argument)
            return Least(known, (symbol.name,)) if known is not None and known > 0.0 else Least()
        body = self._reach.body(symbol)
        if not isinstance(body, core.Lambda) or symbol.uid in inside:
            return Least()
        return Least.of(self._least(r.body, inside | {symbol.uid}) for r in body.rules)


def shortest(durations: Durations, e: core.Exp) -> float:
    """The least seconds that a wait or delay may be; 0: they are not known."""
    values = durations.values(e)
    if not values or not all(isinstance(v, int | float) for v in values):
        return 0.0
    least = min(map(float, values))
    return least if math.isfinite(least) and least > 0.0 else 0.0


def puts_one(t: FlatTransition, partition: Partition) -> dict[int, core.Exp | None]:
    """The places that get one token in any case, and its delay."""
    found: dict[int, core.Exp | None] = {}
    for a in t.arcs:
        if a.kind is ArcKind.OUTPUT and a.inscription is not None:
            inscription, program = a.inscription, partition.net.program
            ways = list(delayed_tokens(inscription.value, inscription.form, program))
            if len(ways) == 1 and ways[0][1] is not None and len(ways[0][1]) == 1:
                found[a.place] = ways[0][2]
    return found


def of_supervisor(partition: Partition) -> list[FlatTransition]:
    """The transitions of the supervisor."""
    return [
        t
        for t, owner in zip(partition.net.transitions, partition.transition_owner, strict=True)
        if partition.owners[owner].kind is OwnerKind.SUPERVISOR
    ]


def timers(start: FlatTransition, partition: Partition) -> Iterator[tuple[int, list[core.Exp]]]:
    """The places of the supervisor that get a token with a time, and the delays of it."""
    channels = {c.place for c in partition.channels}
    for place, delay in puts_one(start, partition).items():
        if place not in channels and partition.net.places[place].colset.timed:
            yield place, [e for e in (start.delay, delay) if e is not None]


def taken(t: FlatTransition) -> set[int]:
    """The places from which it takes tokens, perhaps to put them back."""
    return {a.place for a in t.arcs if a.kind in _TAKING}


def ended(
    start: FlatTransition, over: FlatTransition, timer: int, partition: Partition
) -> set[int]:
    """What the start has put and the end of the timer takes for good: whoever takes one of these was quicker.

    Nothing if `over` is not the end of the timer.
    """
    inputs = {a.place for a in over.arcs if a.kind is ArcKind.INPUT}
    given = {a.place for a in over.arcs if a.kind is ArcKind.OUTPUT}
    is_message = any(c.place in inputs for c in partition.channels)
    if timer not in inputs or timer in given or is_message or not _waits_for(over, timer):
        return set()
    return (inputs - given) & puts_one(start, partition).keys()


def _waits_for(t: FlatTransition, timer: int) -> bool:
    """Whether it takes the token of the timer only when that is over."""
    return all(
        a.inscription is not None
        and all(x.delay is None and not x.whole for x in a.inscription.terms)
        for a in t.arcs
        if a.kind in _TAKING and a.place == timer
    )


def _takes(step: Step, place: int) -> bool:
    return any(p == place for p, *_ in step.takes)


def _puts(outcome: Outcome, place: int) -> bool:
    return any(p == place for p, _ in outcome.puts)


def _here(program: Machine, step: Step) -> int:
    return next(p for p, *_ in step.takes if p in program.control)


def _comes_unasked(program: Machine, command: int, answer: int) -> bool:
    """Whether an answer can come from the start, or after another answer, without the command."""
    reached = {program.start} | {
        program.target(o) for s in program.steps for o in s.outcomes if _puts(o, answer)
    }
    quiet = [s for s in program.steps if not _takes(s, command)]
    for _ in program.control:
        for s in quiet:
            if _here(program, s) in reached:
                reached |= {program.target(o) for o in s.outcomes}
    return any(
        _here(program, s) in reached and any(_puts(o, answer) for o in s.outcomes) for s in quiet
    )
