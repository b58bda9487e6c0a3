"""Replaying a recording of the real engine: is it an occurrence sequence of the net?

    followed = follow(recording(json.load(file)), game)
    followed.ok, followed.steps, followed.why

A recording leaves things open: several transitions can have the name it gives, and of equal tokens with different
stamps the engine takes any. So all states are carried along that fit what has been seen.

What a net draws at random (in an arc, a delay, an action, an initial marking) is not part of a recording and cannot be
repeated. First the run is replayed as if nothing were drawn. If that fails and the net draws, it is followed a second
time: what depends on a drawn number is then taken as recorded (`unknown`), all else must still be as the rules say.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from pn2code.ml.core.reals import may_hold_reals
from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import ArcKind, FlatNet, FlatTransition
from pn2code.semantics.evaluation.effects import OUTSIDE, Effect, Effects, outside, texts
from pn2code.semantics.evaluation.evaluate import variables
from pn2code.semantics.evaluation.references import References
from pn2code.semantics.game.enabling import Demand
from pn2code.semantics.game.errors import GameError, GivenUpError
from pn2code.semantics.game.marking import (
    Binding,
    BindingElement,
    Marking,
    place_text,
    variable_text,
)
from pn2code.semantics.game.partial_marking import (
    EXACT,
    PartialMarking,
    alternatives,
    counted,
    final_difference,
    taken,
    without_delay,
)
from pn2code.semantics.game.report import PlaceRow, places, time_text
from pn2code.semantics.game.token_game import Game, reset
from pn2code.semantics.values.colour_text import read_value
from pn2code.semantics.values.data import Value
from pn2code.semantics.values.multiset import TimedMultiSet
from pn2code.trace.followed import EnabledBinding, Followed, State
from pn2code.trace.recording import RecordedStep, Recording, TransitionNames

MOST_STATES = 50
"""States that are carried along; of more, the first are."""
MOST_MARKINGS = 4
"""Ways to take the tokens of one binding that are followed."""


class _Refused(Exception):  # noqa: N818
    """A step cannot be repeated in a state; the message says why."""


def follow(run: Recording, game: Game) -> Followed:
    """Replays a recording from the game's marking on; the marking is not changed, references and `steps` are.

    An error of the net on the way is a reason why a step cannot be repeated.
    """
    effects = Effects(game.net.program)
    references = References(game.evaluator)
    at_first = references.contents()
    result = _Follower(game, effects, references, lenient=False).follow(run)
    if result.ok or not outside(effects, game.net):
        return result
    references.restore(at_first)
    return _Follower(game, effects, references, lenient=True).follow(run)


class _Follower:
    """Carries states along a recording."""

    def __init__(
        self, game: Game, effects: Effects, references: References, *, lenient: bool
    ) -> None:
        self.game = game
        self.net: FlatNet = game.net
        self.effects = effects
        self.lenient = lenient
        self.names = TransitionNames(game.net)
        self.references = references
        self.real_time = game.net.real_time
        self.final_tokens: dict[int, dict[str, int]] = {}

    # --- what is drawn -----------------------------------------------------------------------------

    def nature(self) -> str:
        """In words: in what way the net depends on more than itself."""
        found = self.effects.of(*texts(self.net))
        return " and ".join(
            words
            for effect, words in (
                (Effect.DRAW, "draws random numbers"),
                (Effect.LOOK, "depends on files or clocks"),
            )
            if effect in found
        )

    def vague(self, unknown: PartialMarking, *parts: Any) -> bool:
        """Whether the values of these expressions cannot be known."""
        if not self.lenient:
            return False
        found = self.effects.of(*parts)
        return bool(found & OUTSIDE) or (unknown.references and Effect.READ in found)

    def start(self) -> State:
        marking, unknown = self.game.marking, EXACT
        for p in self.net.places:
            if p.initial and self.vague(EXACT, p.initial[0]):
                marking, unknown = unknown.forget(marking, p.index)
        return State(self.game.with_references(marking), unknown, self.references.contents())

    # --- the run -------------------------------------------------------------------------------------

    def follow(self, run: Recording) -> Followed:
        self.final_tokens = self.tokens_of(run)
        states = [self.start()]
        for number, step in enumerate(run.steps):
            candidates = self.names.candidates(step)
            if not candidates:
                page = f" on page `{step.page}`" if step.page else ""
                which = f", instance {step.instance}" if step.instance > 1 else ""
                why = f"`{step.transition}`: the net has no such transition{page}{which}"
                return self.refused(states[0], number, why, run)
            self.game.evaluator.steps = number
            after: dict[State, None] = {}
            reasons: dict[str, None] = {}
            given_up = False
            for state in states:
                for t in candidates:
                    try:
                        for found in self.step(state, t, step):
                            after[found] = None
                    except (_Refused, GameError) as refused:
                        reasons[str(refused)] = None
                        given_up = given_up or isinstance(refused, GivenUpError)
            if not after:
                why = f"`{step.transition}`: {' / '.join(list(reasons)[:3])}"
                refusal = self.refused(states[0], number, why, run)
                return replace(refusal, given_up=given_up)
            states = list(after)[:MOST_STATES]
            self.game.evaluator.steps = number + 1
        return self.finished(states, run)

    def tokens_of(self, run: Recording) -> dict[int, dict[str, int]]:
        """The recorded final marking of the timed places: texts of tokens, how many of each."""
        found = {}
        for p in self.net.place_instances:
            colset = self.net.places[p.place].colset
            if colset.timed and (p.id, p.number) in run.final_marking:
                found[p.place] = counted(run.final_marking[p.id, p.number], colset)
        return found

    def finished(self, states: list[State], run: Recording) -> Followed:
        """After the last step: is one of the states the recorded final marking?"""
        if run.stopped_by_error or not (run.final_marking or run.final_time):
            return self.accepted(states[0], run)
        differences = []
        for state in states:
            settled, difference = self.final(state, run)
            if not difference:
                return self.accepted(settled, run)
            differences.append(difference)
        return self.refused(states[0], len(run.steps), f"in the end {differences[0]}", run)

    def final(self, state: State, run: Recording) -> tuple[State, str]:
        """The state at the recorded final time, and how it differs from the recorded marking."""
        if run.final_time and run.final_time != time_text(state.marking.time):
            if not self.net.timed:
                return state, ""
            settled = self.last(state, run.final_time)
            if run.final_time != time_text(settled.time) and not state.unknown:
                return state, f"the time is {time_text(settled.time)}, not {run.final_time}"
            state = replace(state, marking=settled)
        rows = self.rows_by_place(state.marking)
        for key, recorded in run.final_marking.items():
            if key not in rows:
                return (
                    state,
                    f"the recording has a place `{key[0]}`, instance {key[1]}, which the net does not have",
                )
            index, ours = rows[key]
            if ours != recorded and state.unknown.covers(index):
                colset = self.net.places[index].colset
                tokens = state.marking.places[index]
                ours = final_difference(
                    self.game.colours, colset, tokens, state.unknown, index, recorded
                )
                if not ours:
                    continue
            if ours != recorded:
                name = self.net.places[index].name
                return state, f"place `{name}` holds {_line(ours)}, not {_line(recorded)}"
        return state, ""

    def last(self, state: State, time: str) -> Marking:
        """The marking when the engine has found nothing to do at its time.

        If nothing will ever be enabled again it may have tried later times, at which tokens become available.
        """
        settled = self.game.advance_time(state.marking)
        if time_text(settled.time) == time or self.game.enabled_in(settled):
            return settled
        for t in self.net.transitions:
            for later in self.game.enabling.thresholds(t, settled):
                if time_text(later) == time:
                    return replace(settled, time=later)
        return settled

    def rows_by_place(self, marking: Marking) -> dict[tuple[str, int], tuple[int, str]]:
        texts = [
            place_text(self.game.colours, p.colset, marking.places[p.index])
            for p in self.net.places
        ]
        found = {(p.id, p.number): (p.place, texts[p.place]) for p in self.net.place_instances}
        found |= {(f.id, 1): (f.place, texts[f.place]) for f in self.net.fusions if f.place >= 0}
        return found

    def accepted(self, state: State, run: Recording) -> Followed:
        drawn = self.drawn(state)
        why = ""
        if self.lenient:
            why = (
                f"the net {self.nature()}, whose results are not in a recording: what depends on them was taken as "
                "recorded"
            )
            if drawn:
                why += f"; in the final marking these are tokens of {_list(drawn)}"
        return Followed(
            ok=True,
            steps=len(run.steps),
            why=why,
            random=self.lenient,
            time=state.marking.time,
            rows=self.rows(state, run),
            drawn=drawn,
            occurrences=state.occurrences(),
        )

    def refused(self, state: State, steps: int, why: str, run: Recording) -> Followed:
        return Followed(
            False, steps, why, self.lenient, state.marking.time, places(self.net, state.marking)
        )

    def drawn(self, state: State) -> tuple[str, ...]:
        return tuple(p.name for p in self.net.places if state.unknown.covers(p.index))

    def rows(self, state: State, run: Recording) -> list[PlaceRow]:
        """The marking; what is not known of it as recorded."""
        rows = places(self.net, state.marking)
        covered = {
            (p.id, p.number) for p in self.net.place_instances if state.unknown.covers(p.place)
        } | {(f.id, 1) for f in self.net.fusions if f.place >= 0 and state.unknown.covers(f.place)}
        for row in rows:
            key = (str(row["id"]), int(row["instance"]))
            if key in covered and key in run.final_marking:
                row["marking"] = run.final_marking[key]
        return rows

    # --- a step ----------------------------------------------------------------------------------------

    def step(self, state: State, t: FlatTransition, step: RecordedStep) -> Iterator[State]:
        """The states after an occurrence; raises _Refused when there is none.

        Inscriptions see `step ()` as it was while the occurrence was looked for, and counted while it occurs.
        """
        evaluator = self.game.evaluator
        done = evaluator.steps
        self.references.restore(state.references)
        self.check_names(t, step)
        state = self.at_time(state, step.time)
        self.check_priority(state, t)
        reason = ""
        count = 0
        for enabled in self.enabled(state, t, step):
            evaluator.steps = done + 1
            try:
                after = self.occur(state, t, enabled, step)
            except GivenUpError:
                raise
            except (_Refused, GameError) as refused:
                reason = reason or str(refused)
                continue
            finally:
                evaluator.steps = done
            count += 1
            yield after
        if not count:
            raise _Refused(reason or self.why_disabled(state, t, step))

    def check_names(self, t: FlatTransition, step: RecordedStep) -> None:
        ours = {s.name for s in t.variables}
        for name in sorted(set(step.binding) - ours):
            raise _Refused(f"the binding has `{name}`, which is no variable of the transition")
        for name in sorted(ours - set(step.binding)):
            raise _Refused(f"the binding lacks variable `{name}`")

    def at_time(self, state: State, time: str) -> State:
        """The state when the clock shows the recorded time."""
        now = state.marking.time
        if not self.net.timed or not time or time_text(now) == time:
            return state
        settled = self.game.advance_time(state.marking)
        if time_text(settled.time) == time:
            return replace(state, marking=settled)
        said = f"it is recorded at time {time}, but the clock shows {time_text(settled.time)}"
        if not state.unknown.anything:
            raise _Refused(said)
        value = _time(time, self.real_time)
        if value is None or value < now:
            raise _Refused(f"time goes back, from {time_text(now)} to {time}")
        if self.real_time:
            # Recorded with 12 digits: as late as a time can be that is printed like this.
            value += 0.49 * 10.0 ** (math.floor(math.log10(value)) - 11) if value else 0.0
            state = replace(state, unknown=replace(state.unknown, clock=True))
        self.check_eager(state, settled, value, said)
        return replace(state, marking=replace(state.marking, time=value))

    def check_eager(self, state: State, settled: Marking, value: float, said: str) -> None:
        """Time must not pass something that was certainly enabled before."""
        if settled.time >= value or self.inhibiting():
            return
        self.references.restore(state.references)
        for element in self.game.enabled_in(settled):
            if self.certain(state.unknown, self.net.transitions[element.transition]):
                raise _Refused(said)

    def inhibiting(self) -> bool:
        return any(a.kind is ArcKind.INHIBITOR for t in self.net.transitions for a in t.arcs)

    def certain(self, unknown: PartialMarking, t: FlatTransition) -> bool:
        """Whether tokens that are there enable the transition, whatever is drawn."""
        arcs = [a.inscription for a in t.arcs if a.inscription and a.kind is not ArcKind.OUTPUT]
        return not self.vague(unknown, t.guards, *(a.value for a in arcs))

    def check_priority(self, state: State, t: FlatTransition) -> None:
        if self.inhibiting() and state.unknown:
            return
        for other in self.net.transitions:
            if other.priority >= t.priority or not self.certain(state.unknown, other):
                continue
            if next(self.game.enabling.enabled(other, state.marking), None) is not None:
                raise _Refused(f"`{other.name}` has a higher priority and is enabled")

    def enabled(
        self, state: State, t: FlatTransition, step: RecordedStep
    ) -> Iterator[EnabledBinding]:
        """The ways in which the recorded binding is enabled."""
        enabling = self.game.enabling
        found = False
        if self.certain(state.unknown, t):

            def fits(symbol: Symbol, value: Value) -> bool:
                text = variable_text(self.game.colours, symbol, value)
                return text == step.binding.get(symbol.name)

            for binding in enabling.enabled(t, state.marking, accept=fits):
                demands = enabling.demands(t, binding)
                for left in self.plausible(list(alternatives(enabling, state.marking, demands))):
                    found = True
                    yield EnabledBinding(left, state.unknown, binding)
        depends = not self.certain(state.unknown, t)
        if depends or (not found and self.lenient and state.unknown.anything):
            yield self.enabled_by_unknown(state, t, step)

    def plausible(self, markings: list[Marking]) -> list[Marking]:
        """Some of the markings that may be left, with which the recorded final marking can still be reached.

        Nothing that is put later has a stamp before the present time: what the final marking has of such tokens must
        be there now. Which of the others are taken first makes no difference.
        """
        if len(markings) == 1:
            return markings
        return [m for m in markings if self.holds_final(m)][:MOST_MARKINGS] or markings[
            :MOST_MARKINGS
        ]

    def holds_final(self, marking: Marking) -> bool:
        for place, wanted in self.final_tokens.items():
            tokens = marking.places[place]
            if isinstance(tokens, TimedMultiSet):
                colset = self.net.places[place].colset
                held = counted(place_text(self.game.colours, colset, tokens), colset)
                for text, count in wanted.items():
                    stamp = _time(text.rpartition("@")[2], self.real_time)
                    early = stamp is not None and stamp < marking.time
                    if early and held.get(text, 0) < count:
                        return False
        return True

    def enabled_by_unknown(
        self, state: State, t: FlatTransition, step: RecordedStep
    ) -> EnabledBinding:
        """As `enabled`, with tokens that are not known: the binding is read from its text."""
        enabling = self.game.enabling
        unknown = state.unknown
        binding = self.read(t, step)
        self.game.evaluator.now = state.marking.time
        if not self.vague(unknown, t.guards):
            reason = enabling.why_guard_fails(t, binding)
            if reason:
                raise _Refused(reason)
        marking = state.marking
        demands: list[Demand] = []
        for n, arc in enumerate(t.arcs):
            inhibits = arc.kind is ArcKind.INHIBITOR and not unknown.covers(arc.place)
            if inhibits and enabling.inhibited(arc, marking):
                raise _Refused(f"place `{self.net.places[arc.place].name}` inhibits it")
            if arc.inscription is None or arc.kind not in (ArcKind.INPUT, ArcKind.BOTH):
                continue
            if self.vague(unknown, arc.inscription.value):
                marking, unknown = unknown.forget(marking, arc.place)
            else:
                demands += enabling.demands(t, binding, only=n)
        left = taken(enabling, self.game.colours, marking, unknown, demands)
        if isinstance(left, Demand):
            raise _Refused(enabling.shortage(marking, left, demands))
        return EnabledBinding(*left, binding, read=True)

    def read(self, t: FlatTransition, step: RecordedStep) -> dict[Symbol, Value]:
        """The recorded values of the variables that are not outputs of the code segment."""
        outputs = t.code.outputs if t.code else ()
        return {s: self.read_one(s, step) for s in t.variables if s not in outputs}

    def read_one(self, symbol: Symbol, step: RecordedStep) -> Value:
        assert symbol.colset is not None, "a net variable has a colour set"
        text = step.binding[symbol.name]
        value = read_value(symbol.colset, text, real_time=self.real_time)
        if value is None:
            raise _Refused(f"`{symbol.name}` = {_line(text)} is no value of `{symbol.colset.name}`")
        return value

    def why_disabled(self, state: State, t: FlatTransition, step: RecordedStep) -> str:
        """Why a binding is not enabled, in words."""
        element = BindingElement.make(t, self.read(t, step))
        found = self.game.why_disabled(state.marking, element)
        return f"not enabled: {found}" if found else "not enabled with this binding"

    # --- an occurrence -----------------------------------------------------------------------------------

    def occur(
        self, state: State, t: FlatTransition, enabled: EnabledBinding, step: RecordedStep
    ) -> State:
        """The state after the occurrence."""
        game = self.game
        unknown, now = enabled.unknown, enabled.left.time
        self.references.restore(state.references)
        game.evaluator.now = now
        action = t.code.action if t.code else None
        full = {**enabled.binding, **self.outputs(unknown, t, enabled.binding, step)}
        drawn = self.vague(unknown, action)
        # Reals are printed with fewer digits than they have.
        printed = {s for s in t.variables if self.is_rounded(s)} if enabled.read or drawn else set()
        unknown = self.remember(unknown, drawn, action)
        late = unknown.clock or self.vague(unknown, t.delay)
        delay = 0 if late else game.delay(t, full)
        held = list(enabled.left.places)
        for arc in t.arcs:
            if arc.inscription is None or arc.kind not in (ArcKind.OUTPUT, ArcKind.BOTH):
                continue
            drawn = self.vague(unknown, arc.inscription.value)
            rounded = bool(printed and printed & variables(arc.inscription.value))
            tokens = without_delay(arc) if drawn and not rounded else None
            if tokens and tokens.inscription and not self.vague(unknown, tokens.inscription.value):
                # Which tokens they are is known; when they are available is drawn.
                put = game.put(TimedMultiSet(), tokens, full, 0, now)
                assert isinstance(put, TimedMultiSet)
                unknown = unknown.with_late(arc.place, put.untimed())
                unknown = self.remember(unknown, drawn, arc.inscription.value)
            elif rounded or drawn:
                unknown = unknown.opened(arc.place)
                unknown = self.remember(unknown, drawn, arc.inscription.value)
            elif late and self.net.places[arc.place].colset.timed:
                put = game.put(TimedMultiSet(), arc, full, 0, now)
                assert isinstance(put, TimedMultiSet)
                unknown = unknown.with_late(arc.place, put.untimed())
            else:
                held[arc.place] = game.put(held[arc.place], arc, full, delay, now)
        for arc in t.arcs:
            if arc.kind is ArcKind.RESET:
                held[arc.place] = reset(held[arc.place], now)
                if unknown.covers(arc.place):
                    unknown = unknown.opened(arc.place)
        after = replace(enabled.left, places=tuple(held))
        path = (state.path, (now, BindingElement.make(t, full)))
        return State(self.game.with_references(after), unknown, self.references.contents(), path)

    def is_rounded(self, s: Symbol) -> bool:
        return may_hold_reals(s.type, self.net.program.datatypes)

    def remember(self, unknown: PartialMarking, drawn: bool, *parts: Any) -> PartialMarking:
        """Evaluating something that is drawn may have put drawn values into references."""
        if drawn and Effect.WRITE in self.effects.of(*parts):
            return replace(unknown, references=True)
        return unknown

    def outputs(
        self, unknown: PartialMarking, t: FlatTransition, binding: Binding, step: RecordedStep
    ) -> dict[Symbol, Value]:
        """The outputs of the code segment: ours if they are as recorded, else the recorded ones if they are drawn."""
        if t.code is None:
            return {}
        vague = self.vague(unknown, t.code.action)
        try:
            ours = self.game.action(t, binding)
        except GameError:
            if not vague:
                raise
            ours = {}
        found: dict[Symbol, Value] = {}
        for s in t.code.outputs:
            text = variable_text(self.game.colours, s, ours[s]) if s in ours else None
            if text == step.binding[s.name]:
                found[s] = ours[s]
            elif vague:
                found[s] = self.read_one(s, step)
            else:
                raise _Refused(
                    f"the code segment gives `{s.name}` = {_line(text or '')}, "
                    f"recorded is {_line(step.binding[s.name])}"
                )
        return found


def _time(text: str, real: bool) -> int | float | None:
    try:
        return float(text.replace("~", "-")) if real else int(text.replace("~", "-"))
    except ValueError:
        return None


def _line(text: str) -> str:
    return " ".join(text.split())


def _list(names: tuple[str, ...]) -> str:
    shown = ", ".join(f"`{name}`" for name in names[:4])
    return shown + (f" and {len(names) - 4} more" if len(names) > 4 else "")
