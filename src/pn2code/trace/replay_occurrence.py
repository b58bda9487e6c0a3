"""An occurrence of a recorded run: what tokens it puts, and what is not known of them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from pn2code.ml.core.reals import may_hold_reals
from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import ArcKind, FlatTransition
from pn2code.semantics.evaluation.effects import Effect
from pn2code.semantics.evaluation.used_symbols import variables
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.marking import Binding, BindingElement, variable_text
from pn2code.semantics.game.partial_marking import PartialMarking, without_delay
from pn2code.semantics.game.token_game import reset
from pn2code.semantics.values.data import Value
from pn2code.semantics.values.multiset import TimedMultiSet
from pn2code.trace.followed import EnabledBinding, State
from pn2code.trace.outside_values import OutsideValues, RefusedError, on_one_line
from pn2code.trace.recording import RecordedStep


class Occurring(OutsideValues):
    """Lets transitions occur as they are recorded."""

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
        printed = (
            {s for s in t.variables if self._is_rounded(s)} if enabled.read or drawn else set()
        )
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

    def _is_rounded(self, s: Symbol) -> bool:
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
                raise RefusedError(
                    f"the code segment gives `{s.name}` = {on_one_line(text or '')}, "
                    f"recorded is {on_one_line(step.binding[s.name])}"
                )
        return found
