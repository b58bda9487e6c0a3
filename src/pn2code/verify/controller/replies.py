"""Whether a robot answers before `reply_timeout_s` is over (I8 of docs/protocol.md), as far as durations are known.

A robot that owes an answer for longer stops the cell. What its tools, waits and delays take is written in cell.toml and
in the net, or computed there from what has few values (`durations`); how long it moves and measures is not known
(layouts decide that), nor how long somebody else lets it wait.

replies = Replies.of(partition, config)
replies.late      # "device `press` may need 4 s ...": that the cell ends is no certainty then; "": it is not known
replies.premise   # what a "yes" rests on otherwise
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from pn2code.base.components import components
from pn2code.base.frozen import frozen, record
from pn2code.cell.config import CellConfig, Primitive
from pn2code.cell.partition import ChannelKind, Partition
from pn2code.cell.reach import Reach
from pn2code.lowering.expressions.values import children
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.types import TFun
from pn2code.net.dump import text_of
from pn2code.net.uses import pattern_variables
from pn2code.robot_scripts.machine import Machine
from pn2code.verify.controller.commands import ALONG, applied, lasts, longest, of_colset
from pn2code.verify.controller.durations import MOST_VALUES, NOTHING, Durations, Known
from pn2code.verify.controller.rounds import ControlStep, Turns, turns
from pn2code.verify.controller.stops import NoProgramError, machine
from pn2code.verify.controller.unanswered import ADVICE, unanswered

_ENDLESS = math.inf
_LONGEST = "a colour set of lists with a longest length, `with 0..n`,"


@frozen
class Time:
    """Seconds that are known, and whether there are further ones.

    Args:
        seconds: known ones.
        is_open: moves or measurements take further ones.
        computed: a wait or a delay that takes further ones, which nobody knows; "": there is none.
        round: transitions that may occur one after the other again and again, if the seconds are without bound.
        advice: what would tell what is computed.
    """

    seconds: float = 0.0
    is_open: bool = False
    computed: str = ""
    round: tuple[str, ...] = ()
    advice: str = f"a colour set of at most {MOST_VALUES:,} values"

    def __add__(self, other: Time) -> Time:
        """One after the other."""
        return Time(
            self.seconds + other.seconds,
            self.is_open or other.is_open,
            self.computed or other.computed,
            advice=self.advice if self.computed else other.advice,
        )

    @staticmethod
    def longest(times: Iterable[Time]) -> Time:
        """Of several, one of which is taken."""
        known = list(times)
        unknown = next((t for t in known if t.computed), Time())
        return Time(
            max((t.seconds for t in known), default=0.0),
            any(t.is_open for t in known),
            unknown.computed,
            advice=unknown.advice,
        )


OPEN = Time(0.0, True)


@frozen
class Replies:
    """What is known of a cell's answers.

    Args:
        late: why an answer may come too late; "": that is not known of any.
        premise: what "the cell comes to its end" rests on; "": nobody owes answers.
    """

    late: str = ""
    premise: str = ""

    @staticmethod
    def of(partition: Partition, config: CellConfig) -> Replies:
        """Those of a cell."""
        limit = config.supervisor.reply_timeout_s
        asked = {
            c.reader for c in partition.channels if c.kind is ChannelKind.FLAG and c.writer == 0
        }
        most = Time()
        durations = Durations(partition.net, config.storage)
        for owner in sorted(asked):
            try:
                program = machine(partition, owner)
            except NoProgramError:
                return Replies()
            time = _Silence(program, config, durations).longest()
            who = partition.owners[owner].phrase
            # An answer takes a little longer than its commands: with as much time as there is, it is late.
            if time.seconds >= limit:
                none = unanswered(program)
                if none:
                    return Replies(f"{who} may give no answer: {none}")
                if time.seconds == _ENDLESS:
                    return Replies(_endless(who, time.round, limit))
                return Replies(
                    f"{who} may need {time.seconds:g} s for an answer, by its tools, waits and delays alone, and "
                    f"`reply_timeout_s` is {limit:g}: whoever owes an answer for that long stops the cell "
                    f"(make it longer, or {ADVICE})"
                )
            if time.computed:
                return Replies(
                    f"how long {who} takes for an answer is not known, because {time.computed} is computed, and "
                    f"whoever owes an answer for longer than `reply_timeout_s`, {limit:g} s, stops the cell "
                    f"({time.advice} would tell)"
                )
            most = Time.longest((most, time))
        if not asked:
            return Replies()
        known = f"tools, waits and delays take at most {most.seconds:g} s"
        more = (
            "; how long moves and measurements take is not known here, `pn2code time` measures it"
            if most.is_open
            else ""
        )
        return Replies(
            "",
            f"nobody owes an answer for longer than `reply_timeout_s`, {limit:g} s ({known}{more})",
        )


@frozen
class _Quiet:
    """A step without a message: its places and tokens, what it takes, and its transition."""

    way: ControlStep
    time: Time
    name: str


def _endless(who: str, around: Sequence[str], limit: float) -> str:
    """Why there is no bound, and what helps; a longer limit does not."""
    names = ", ".join(f"`{name}`" for name in around)
    again = "occurs" if len(around) == 1 else "occur"
    return (
        f"{who} may need any time for an answer: for all that its places say, {names} {again} again and again "
        f"without a message; of what may end that, only lists that get shorter and numbers that "
        f"count within their range are looked at here. Whoever owes an answer for "
        f"`reply_timeout_s`, {limit:g} s, stops the cell (draw each round with places of its own, send a "
        f"message in each round, or {ADVICE})"
    )


def _round(quiet: Sequence[_Quiet]) -> tuple[str, ...]:
    """The transitions of a shortest round that takes time."""
    found: list[tuple[str, ...]] = []
    for one in quiet:
        if one.time.seconds <= 0:
            continue
        here, there = one.way.here, one.way.there
        ways: dict[int, tuple[str, ...]] = {there: (one.name,)}
        todo = deque([there])
        while todo and here not in ways:
            at = todo.popleft()
            for step in quiet:
                end = step.way.there
                if step.way.here == at and end not in ways:
                    ways[end] = (*ways[at], step.name)
                    todo.append(end)
        if here in ways:
            found.append(ways[here])
    return min(found, key=len, default=())


def _spent(round_: Sequence[_Quiet], colsets: Mapping[int, Colset]) -> Time | None:
    """What steps that lead round take altogether, at most; None: there is no bound."""
    if not round_:
        return Time()
    every = sum((q.time for q in round_), Time())
    if every.seconds <= 0:
        return every
    found = turns([q.way for q in round_], colsets)
    if found is None:
        return None
    return replace(every, seconds=_seconds(found, [q.time.seconds for q in round_]))


def _seconds(found: Turns, each: Sequence[float]) -> float:
    """Of steps that occur as often as they can: those that count nothing once before, between and after the others."""
    counts = [(seconds / by, by) for seconds, by in zip(each, found.by, strict=True) if by]
    between = sum(seconds for seconds, by in zip(each, found.by, strict=True) if not by)
    if not counts:
        return between
    times = found.room // min(by for _, by in counts)
    return found.room * max(per for per, _ in counts) + (times + 1) * between


@record
class _Silence:
    """How long a program may go on without a message to the supervisor."""

    program: Machine
    config: CellConfig
    durations: Durations

    def longest(self) -> Time:
        """From the start, or from one message on, until the next one; unbounded if it may go round meanwhile."""
        net, channels = self.program.net, self.program.channels
        spent = _Commands(net.program, self.config, self.durations)
        quiet: list[_Quiet] = []
        begins: dict[int, Time] = {self.program.start: Time()}
        last: list[tuple[int, Time]] = []
        for step in self.program.steps:
            t = step.transition
            ((here, term),) = ((p, term) for p, term, *_ in step.takes if p in self.program.control)
            acts = spent.of(t.code.action) if t.code is not None else Time()
            for outcome in step.outcomes:
                there = self.program.target(outcome)
                delays = [e for p, e in outcome.delays if p == there]
                delays += [] if t.delay is None else [t.delay]
                after = sum((self._delay(e, t.short) for e in delays), Time())
                if any(p in channels and channels[p].reader == 0 for p, _ in outcome.puts):
                    last.append((here, acts))  # commands, then the message, then the delay
                    begins[there] = Time.longest((begins.get(there, Time()), after))
                else:
                    put = None if term.whole else dict(outcome.puts)[there]
                    quiet.append(
                        _Quiet(ControlStep(here, there, term.value, put), acts + after, t.short)
                    )
        at = dict(begins)
        for turn in range(len(self.program.control) + 1):
            changed = False
            for one in quiet:
                here, there = one.way.here, one.way.there
                if here in at:
                    reached = Time.longest((at.get(there, Time()), at[here] + one.time))
                    changed = changed or reached != at.get(there)
                    at[there] = reached
            if not changed:
                break
            if turn == len(self.program.control):
                reachable = [q for q in quiet if q.way.here in at]
                counted = self._counted(begins, reachable)
                if counted is None:
                    return Time(_ENDLESS, True, round=_round(reachable))
                at = counted
        return Time.longest([*at.values(), *(at[p] + acts for p, acts in last if p in at)])

    def _counted(
        self, begins: Mapping[int, Time], quiet: Sequence[_Quiet]
    ) -> dict[int, Time] | None:
        """When places are left, at the latest, where each round ends by what its tokens are; None: one does not."""
        onward: dict[int, list[int]] = {}
        for q in quiet:
            onward.setdefault(q.way.here, []).append(q.way.there)
        groups = list(components(begins, lambda p: onward.get(p, ())))
        colsets = {p: self.program.net.places[p].colset for group in groups for p in group}
        at = dict(begins)
        for group in reversed(groups):
            inside = set(group)
            round_ = [q for q in quiet if q.way.here in inside and q.way.there in inside]
            spent = _spent(round_, colsets)
            if spent is None:
                return None
            left = Time.longest(at[p] for p in inside if p in at) + spent
            at |= dict.fromkeys(inside, left)
            for q in quiet:
                if q.way.here in inside and q.way.there not in inside:
                    known = at.get(q.way.there, Time())
                    at[q.way.there] = Time.longest((known, left + q.time))
        return at

    def _delay(self, e: core.Exp, transition: str) -> Time:
        found = self.durations.seconds(e)
        if found is None:
            return Time(computed=f"the delay of `{transition}`, `{text_of(e)}`,")
        return Time(max(found, 0.0))


class _Commands:
    """The commands that an expression gives."""

    def __init__(self, program: core.Program, config: CellConfig, durations: Durations) -> None:
        self._durations = durations
        self._reach = Reach(program)
        self._given: dict[int, core.Exp] = {}
        """What the parameters of functions stand for; none is called while it is under way."""
        self._primitives: Mapping[int, Primitive] = {
            program.globals[name].uid: p
            for name, p in config.primitives.items()
            if name in program.globals
        }

    def of(self, e: core.Exp) -> Time:
        """What its commands take, at most."""
        self._reach.add_locals(e)
        return self._of(e, frozenset(), NOTHING)

    def _of(self, e: core.Exp, inside: frozenset[int], known: Known) -> Time:
        match e:
            case core.Apply():
                return self._application(e, inside, known)
            case core.Var(symbol=symbol, type=TFun()) if self._acts(e):
                return Time(computed=f"what calls `{symbol.name}`")
            case core.Lambda() if self._acts(e):
                return Time(computed=f"what calls `{text_of(e)}`")
            case core.Var() | core.Lambda():
                return Time()
            case core.If(condition, then, otherwise):
                chosen = Time.longest(
                    (self._of(then, inside, known), self._of(otherwise, inside, known))
                )
                return self._of(condition, inside, known) + chosen
            case core.Case(scrutinee, rules):
                chosen = Time.longest(
                    self._of(r.body, inside, self._durations.bind(r.pattern, scrutinee, known))
                    for r in rules
                )
                return self._of(scrutinee, inside, known) + chosen
            case core.Let(declarations, body):
                spent = Time()
                for declaration in declarations:
                    # Functions are counted where they are mentioned.
                    if isinstance(declaration, core.ValBind):
                        if not _is_named_function(declaration):
                            spent += self._of(declaration.value, inside, known)
                        known = self._durations.bind(declaration.pattern, declaration.value, known)
                return spent + self._of(body, inside, known)
        return sum((self._of(part, inside, known) for part in children(e)), Time())

    def _acts(self, e: core.Exp) -> bool:
        """Whether its meaning depends on a primitive."""
        return not self._primitives.keys().isdisjoint(self._reach.everything(e))

    def _application(self, e: core.Apply, inside: frozenset[int], known: Known) -> Time:
        """A function, and what it is applied to, one argument after the other."""
        function, arguments = applied(e)
        if isinstance(function, core.Builtin) and len(arguments) == ALONG.get(function.name):
            along = self._along(function.name, arguments, inside, known)
            if along is not None:
                return along
        spent = sum((self._of(x, inside, known) for x in arguments), Time())
        match function:
            case core.Var(symbol=symbol) if symbol.uid in self._primitives:
                return spent + self._command(symbol, arguments[0], known)
            case core.Var(symbol=symbol):
                body = self._reach.body(symbol)
                if isinstance(body, core.Lambda) and symbol.uid not in inside:
                    return spent + self._call(body, arguments, inside | {symbol.uid}, known)
                # A parameter: whoever says what it stands for is asked.
                open_ = body is not None and not isinstance(body, core.Lambda) and self._acts(body)
                return spent + Time(computed=f"what `{symbol.name}` calls" if open_ else "")
            case core.Lambda():
                return spent + self._call(function, arguments, inside, known)
        return spent + self._of(function, inside, known)

    def _along(
        self, name: str, arguments: Sequence[core.Exp], inside: frozenset[int], known: Known
    ) -> Time | None:
        """A function that is called for each item of a list; None: which one is computed."""
        function, *others = arguments
        once = self._item(function, inside, known)
        if once is None:
            return None
        spent = sum((self._of(x, inside, known) for x in others), Time())
        if once.seconds <= 0:
            return spent + once
        most = longest(others[-1], self._items)
        if most is None:
            many = f"how many items `{text_of(others[-1])}` of `{name}` has"
            return spent + Time(0.0, once.is_open, many, advice=_LONGEST)
        return spent + (replace(once, seconds=most * once.seconds) if most else Time())

    def _item(self, function: core.Exp, inside: frozenset[int], known: Known) -> Time | None:
        """What a call of a function takes, whatever it is applied to; None: which one is computed."""
        if isinstance(function, core.Var):
            symbol = function.symbol
            if symbol.uid in self._primitives:
                return self._command(symbol, None, known)
            body = self._reach.body(symbol)
            if not isinstance(body, core.Lambda) or symbol.uid in inside:
                return None
            function, inside = body, inside | {symbol.uid}
        if not isinstance(function, core.Lambda):
            return None
        return Time.longest(self._of(rule.body, inside, known) for rule in function.rules)

    def _items(self, symbol: core.Symbol) -> int | None:
        """The most items of the list that a name stands for; None: it is not known."""
        stands = self._given.get(symbol.uid, self._reach.body(symbol))
        return of_colset(symbol) if stands is None else longest(stands, self._items)

    def _call(
        self,
        function: core.Lambda,
        arguments: Sequence[core.Exp],
        inside: frozenset[int],
        known: Known,
    ) -> Time:
        """The body of a function, and of those that it gives for the further arguments."""
        first, *others = arguments
        ways = []
        for rule in function.rules:
            within = self._durations.bind(rule.pattern, first, known)
            self._stand(rule.pattern, first)
            if others and isinstance(rule.body, core.Lambda):
                ways.append(self._call(rule.body, others, inside, within))
            else:  # a function that is computed is a value there
                ways.append(self._of(rule.body, inside, within))
        return Time.longest(ways)

    def _stand(self, pattern: core.Pat, value: core.Exp) -> None:
        """Takes note of what the names of a pattern stand for, and forgets what they stood for in another call."""
        for symbol in pattern_variables(pattern):
            self._given.pop(symbol.uid, None)
        match pattern, value:
            case core.PVar(symbol), _:
                self._given[symbol.uid] = value
            case core.PRecord(names), core.RecordExp(fields):
                given = dict(fields)
                for label, part in names:
                    if label in given:
                        self._stand(part, given[label])

    def _command(self, symbol: core.Symbol, argument: core.Exp | None, known: Known) -> Time:
        primitive = self._primitives[symbol.uid]
        found = lasts(primitive, argument)
        if found is None and primitive.command == "wait":
            if argument is not None:
                found = self._durations.seconds(argument, known)
            if found is None:
                shown = "" if argument is None else f" `{text_of(argument)}`"
                return Time(computed=f"the time{shown} of `{symbol.name}`")
        return OPEN if found is None else Time(max(found, 0.0))


def _is_named_function(declaration: core.ValBind) -> bool:
    """`val f = fn ..`: it is counted where it is called."""
    return isinstance(declaration.pattern, core.PVar) and isinstance(declaration.value, core.Lambda)
