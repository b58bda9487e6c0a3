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

from dataclasses import replace

from pn2code.semantics.evaluation.effects import Effects, outside
from pn2code.semantics.evaluation.references import References
from pn2code.semantics.game.errors import GameError, GivenUpError
from pn2code.semantics.game.marking import (
    Marking,
    place_text,
)
from pn2code.semantics.game.partial_marking import (
    EXACT,
    counted,
    final_difference,
)
from pn2code.semantics.game.report import PlaceRow, places, time_text
from pn2code.semantics.game.token_game import Game
from pn2code.trace.followed import Followed, State
from pn2code.trace.outside_values import RefusedError, on_one_line
from pn2code.trace.recording import Recording, TransitionNames
from pn2code.trace.replay_step import Stepping

MOST_STATES = 50
"""States that are carried along; of more, the first are."""


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


class _Follower(Stepping):
    """Carries states along a recording."""

    def __init__(
        self, game: Game, effects: Effects, references: References, *, lenient: bool
    ) -> None:
        super().__init__(game, effects, references, lenient=lenient)
        self.names = TransitionNames(game.net)

    def start(self) -> State:
        marking, unknown = self.game.marking, EXACT
        for p in self.net.places:
            if p.initial and self.vague(EXACT, p.initial[0]):
                marking, unknown = unknown.forget(marking, p.index)
        return State(self.game.with_references(marking), unknown, self.references.contents())

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
                    except (RefusedError, GameError) as refused:
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
                return (
                    state,
                    f"place `{name}` holds {on_one_line(ours)}, not {on_one_line(recorded)}",
                )
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


def _list(names: tuple[str, ...]) -> str:
    shown = ", ".join(f"`{name}`" for name in names[:4])
    return shown + (f" and {len(names) - 4} more" if len(names) > 4 else "")
