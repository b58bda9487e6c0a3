"""A step of a recorded run: whether a state has it, at its time and with its binding."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import ArcKind, FlatTransition
from pn2code.semantics.evaluation.effects import Effects
from pn2code.semantics.evaluation.references import References
from pn2code.semantics.game.demands import Demand
from pn2code.semantics.game.errors import GameError, GivenUpError
from pn2code.semantics.game.marking import BindingElement, Marking, place_text, variable_text
from pn2code.semantics.game.partial_marking import PartialMarking, alternatives, counted, taken
from pn2code.semantics.game.report import time_text
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import Value
from pn2code.semantics.values.multiset import TimedMultiSet
from pn2code.trace.followed import EnabledBinding, State
from pn2code.trace.outside_values import RefusedError
from pn2code.trace.recording import RecordedStep
from pn2code.trace.replay_occurrence import Occurring

MOST_MARKINGS = 4
"""Ways to take the tokens of one binding that are followed."""


class Stepping(Occurring):
    """Carries a state over one step."""

    def __init__(
        self, game: Game, effects: Effects, references: References, *, lenient: bool
    ) -> None:
        super().__init__(game, effects, references, lenient=lenient)
        self.final_tokens: dict[int, dict[str, int]] = {}
        """The recorded final marking of the timed places: texts of tokens, how many of each."""

    def step(self, state: State, t: FlatTransition, step: RecordedStep) -> Iterator[State]:
        """The states after an occurrence; raises RefusedError when there is none.

        Inscriptions see `step ()` as it was while the occurrence was looked for, and counted while it occurs.
        """
        evaluator = self.game.evaluator
        done = evaluator.steps
        self.references.restore(state.references)
        self._check_names(t, step)
        state = self.at_time(state, step.time)
        self._check_priority(state, t)
        reason = ""
        count = 0
        for enabled in self.enabled(state, t, step):
            evaluator.steps = done + 1
            try:
                after = self.occur(state, t, enabled, step)
            except GivenUpError:
                raise
            except (RefusedError, GameError) as refused:
                reason = reason or str(refused)
                continue
            finally:
                evaluator.steps = done
            count += 1
            yield after
        if not count:
            raise RefusedError(reason or self.why_disabled(state, t, step))

    def _check_names(self, t: FlatTransition, step: RecordedStep) -> None:
        ours = {s.name for s in t.variables}
        for name in sorted(set(step.binding) - ours):
            raise RefusedError(f"the binding has `{name}`, which is no variable of the transition")
        for name in sorted(ours - set(step.binding)):
            raise RefusedError(f"the binding lacks variable `{name}`")

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
            raise RefusedError(said)
        value = _time(time, self.real_time)
        if value is None or value < now:
            raise RefusedError(f"time goes back, from {time_text(now)} to {time}")
        if self.real_time:
            # Recorded with 12 digits: as late as a time can be that is printed like this.
            value += 0.49 * 10.0 ** (math.floor(math.log10(value)) - 11) if value else 0.0
            state = replace(state, unknown=replace(state.unknown, clock=True))
        self.check_eager(state, settled, value, said)
        return replace(state, marking=replace(state.marking, time=value))

    def check_eager(self, state: State, settled: Marking, value: float, said: str) -> None:
        """Time must not pass something that was certainly enabled before."""
        if settled.time >= value or self._inhibiting():
            return
        self.references.restore(state.references)
        for element in self.game.enabled_in(settled):
            if self.certain(state.unknown, self.net.transitions[element.transition]):
                raise RefusedError(said)

    def _inhibiting(self) -> bool:
        return any(a.kind is ArcKind.INHIBITOR for t in self.net.transitions for a in t.arcs)

    def certain(self, unknown: PartialMarking, t: FlatTransition) -> bool:
        """Whether tokens that are there enable the transition, whatever is drawn."""
        arcs = [a.inscription for a in t.arcs if a.inscription and a.kind is not ArcKind.OUTPUT]
        return not self.vague(unknown, t.guards, *(a.value for a in arcs))

    def _check_priority(self, state: State, t: FlatTransition) -> None:
        if self._inhibiting() and state.unknown:
            return
        for other in self.net.transitions:
            if other.priority >= t.priority or not self.certain(state.unknown, other):
                continue
            if next(self.game.enabling.enabled(other, state.marking), None) is not None:
                raise RefusedError(f"`{other.name}` has a higher priority and is enabled")

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
        return [m for m in markings if self._holds_final(m)][:MOST_MARKINGS] or markings[
            :MOST_MARKINGS
        ]

    def _holds_final(self, marking: Marking) -> bool:
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
                raise RefusedError(reason)
        marking = state.marking
        demands: list[Demand] = []
        for n, arc in enumerate(t.arcs):
            inhibits = arc.kind is ArcKind.INHIBITOR and not unknown.covers(arc.place)
            if inhibits and enabling.inhibited(arc, marking):
                raise RefusedError(f"place `{self.net.places[arc.place].name}` inhibits it")
            if arc.inscription is None or arc.kind not in (ArcKind.INPUT, ArcKind.BOTH):
                continue
            if self.vague(unknown, arc.inscription.value):
                marking, unknown = unknown.forget(marking, arc.place)
            else:
                demands += enabling.demands(t, binding, only=n)
        left = taken(enabling, self.game.colours, marking, unknown, demands)
        if isinstance(left, Demand):
            raise RefusedError(enabling.shortage(marking, left, demands))
        return EnabledBinding(*left, binding, read=True)

    def read(self, t: FlatTransition, step: RecordedStep) -> dict[Symbol, Value]:
        """The recorded values of the variables that are not outputs of the code segment."""
        outputs = t.code.outputs if t.code else ()
        return {s: self.read_one(s, step) for s in t.variables if s not in outputs}

    def why_disabled(self, state: State, t: FlatTransition, step: RecordedStep) -> str:
        """Why a binding is not enabled, in words."""
        element = BindingElement.make(t, self.read(t, step))
        found = self.game.why_disabled(state.marking, element)
        return f"not enabled: {found}" if found else "not enabled with this binding"


def _time(text: str, real: bool) -> int | float | None:
    try:
        return float(text.replace("~", "-")) if real else int(text.replace("~", "-"))
    except ValueError:
        return None
