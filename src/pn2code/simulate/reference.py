"""A run by the reference token game.

The choice of the next binding element is the one that cnative/include/pn/pn_random.h describes: a number below the
number of enabled transitions of the best priority, then a number below the number of its bindings.
"""

from __future__ import annotations

import time
from dataclasses import replace

from pn2code.diagnostics import Diagnostics
from pn2code.monitors.folder import Folder
from pn2code.monitors.watch import Breakpoint, Watch
from pn2code.net.flat import FlatTransition
from pn2code.semantics.evaluation.connections import Connections
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.evaluation.random import CHOICE, RandomStream
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.marking import BindingElement, Marking, variable_text
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.colour_json import to_json
from pn2code.simulate.run import Failure, Outcome, Output, Request
from pn2code.trace.script import Step, Trace, TraceRefusedError
from pn2code.trace.writing import TraceFile, json_text


def run(request: Request, d: Diagnostics) -> Outcome:
    """Plays the run.

    Args:
        request: what is asked for.
        d: gets warnings of monitors.

    Raises:
        TraceUnwritableError: the trace cannot be written.
        TraceRefusedError: the trace that is to be repeated is none.
        OSError: it cannot be read.
    """
    return ReferenceRun(request, d).play()


class ReferenceRun:
    """A run being made; `followed` ones are told each step by the compiled engine.

    Args:
        request: what is asked for.
        d: gets warnings of monitors.
        by: who writes the trace.
    """

    def __init__(self, request: Request, d: Diagnostics, by: str = "reference") -> None:
        self.request = request
        self.d = d
        self.by = by
        self.output = Output()
        self.game: Game | None = None
        self.watch: Watch | None = None
        self.trace_file: TraceFile | None = None
        self.replayed = 0
        self.seed, self._choice_seed = request.seeds(None)
        self._initial: Marking | None = None
        self._breakpoint: Breakpoint | None = None
        self._failure: Failure | None = None
        self._refusal = ""
        self._occurred: BindingElement | None = None
        self._folder = Folder(Files(request.files), request.output)
        self._connections = (
            None if request.sockets is None else Connections(request.sockets, request.interrupted)
        )

    # --- a whole run -----------------------------------------------------------------------------

    def play(self) -> Outcome:
        """From the start to the end."""
        given = Trace.open(self.request.replay, self.request.net) if self.request.replay else None
        if given is not None:
            self.seed, self._choice_seed = self.request.seeds(given.header.seed)
        began = time.perf_counter()
        try:
            why = self._whole(given)
        finally:
            self.close()
        return self.outcome("reference", why, time.perf_counter() - began)

    def close(self) -> None:
        """Closes all files and connections."""
        if self._connections is not None:
            self._connections.close_all()
        if self.trace_file is not None:
            self.trace_file.close()
        self._folder.close()

    def _whole(self, given: Trace | None) -> str:
        why = self.begin(given)
        if not why and given is not None:
            why = self._repeat(given)
        choice = RandomStream(self._choice_seed)
        limit = self.request.steps
        done = 0
        while not why:
            if limit is not None and done >= limit:
                why = self._at_limit(done)
            elif self.request.interrupted():
                why = "interrupted"
            else:
                why = self._step(choice)
                done += 1
                assert self.game is not None
                self.request.progress(self.game.steps, self.game.marking.time)
        return self.finish(why)

    def _at_limit(self, done: int) -> str:
        """Why a run ends that was to be no longer; one that only repeats a trace claims nothing more."""
        game = self.game
        assert game is not None
        try:
            is_over = done > 0 and not game.enabled_transitions(game.advance_time(game.marking))
        except GameError as error:
            return self._fail(error)
        return "finished" if is_over else "steps"

    def begin(self, given: Trace | None = None) -> str:
        """Makes the game; gives why the run ends here, or ""."""
        request = self.request
        try:
            self.game = Game(
                request.net,
                request.storage,
                given.header.initial if given else None,
                seed=self.seed,
                still=given is not None and given.header.still,
                output=self.output.write,
                files=Files(request.files, self.output.write, self._connections),
            )
        except GameError as error:
            return self._fail(error)
        self._initial = self.game.marking
        self.trace_file = TraceFile(request.trace)
        self.trace_file.header(self.game, self.by, self.seed, request.initial)
        if request.monitors is None:
            return ""
        try:
            self.watch = Watch(
                request.monitors,
                self.game,
                self.d,
                folder=self._folder,
                breakpoints=request.breakpoints,
            )
            self.watch.start()
        except GameError as error:
            return self._fail(error)
        return ""

    def finish(self, why: str) -> str:
        """Lets the monitors come to their end and ends the trace; gives why the run has ended."""
        if self.watch is not None and self.game is not None:
            try:
                self.watch.stop()
            except GameError as error:
                if why != "error":
                    why = self._fail(error)
        if self.trace_file is not None and self.game is not None:
            self.trace_file.end(self.game.marking.time, why)
        return why

    def outcome(self, engine: str, why: str, seconds: float) -> Outcome:
        """What has become of the run."""
        return Outcome(
            engine=engine,
            seed=self.seed,
            why=why,
            steps=self.game.steps if self.game else 0,
            replayed=self.replayed,
            initial=self._initial,
            final=self.game.marking if self.game else None,
            failure=self._failure,
            refusal=self._refusal,
            breakpoint=self._breakpoint.row() if self._breakpoint else None,
            monitors=tuple(self.watch.results()) if self.watch else (),
            output=self.output.text(),
            seconds=seconds,
        )

    # --- steps at random -------------------------------------------------------------------------

    def _step(self, choice: RandomStream) -> str:
        """One step; gives why the run ends here, or ""."""
        game = self.game
        assert game is not None
        try:
            enabled, why = self._advance_time()
            if why:
                return why
        except GameError as error:
            return self._fail(error)
        choice.start(game.steps, CHOICE)
        t = enabled[choice.below(len(enabled))]
        try:
            bindings = list(game.enabling.enabled(t, game.marking))
        except GameError as error:
            return self._fail(error, t)
        return self.fire(BindingElement.make(t, bindings[choice.below(len(bindings))]))

    def _advance_time(self) -> tuple[list[FlatTransition], str]:
        """Moves the clock to where something is enabled; gives what is, and why the run ends here, or ""."""
        game = self.game
        assert game is not None
        now = game.marking.time
        enabled = game.enabled_transitions(game.marking)
        if enabled:
            return enabled, "until" if self._is_beyond(now) else ""
        later = game.advance_time(game.marking) if game.net.timed else game.marking
        if later.time == now:
            return [], "finished"
        if self._is_beyond(later.time):
            assert self.request.until is not None
            game.marking = replace(game.marking, time=max(now, self.request.until))
            return [], "until"
        game.marking = later
        return game.enabled_transitions(later), self.time_grew()

    def _is_beyond(self, now: int | float) -> bool:
        return self.request.until is not None and now > self.request.until

    def time_grew(self) -> str:
        """Lets the monitors look after the clock was moved on; "breakpoint" or ""."""
        reached = self.watch.time_grew() if self.watch is not None else None
        if reached is not None:
            self._breakpoint = reached
            return "breakpoint"
        return ""

    def fire(self, element: BindingElement) -> str:
        """Lets an enabled element occur; gives why the run ends here, or ""."""
        game = self.game
        assert game is not None and self.trace_file is not None
        t = game.net.transitions[element.transition]
        try:
            occurred = game.fire(element, checked=False)
        except GameError as error:
            return self._fail(error, t, element)
        self._occurred = occurred
        self.trace_file.occurrence(game, occurred)
        if self.watch is None:
            return ""
        try:
            reached = self.watch.occurred(occurred)
        except GameError as error:
            return self._fail(error, t, occurred)
        if reached is not None:
            self._breakpoint = reached
            return "breakpoint"
        return ""

    def _fail(
        self,
        error: GameError,
        t: FlatTransition | None = None,
        element: BindingElement | None = None,
    ) -> str:
        binding: dict[str, str] | None = None
        if element is not None and self.game is not None:
            colours = self.game.colours
            binding = {s.name: variable_text(colours, s, v) for s, v in element.values}
        self._failure = Failure.of(error, t, binding)
        return "error"

    # --- steps that are given --------------------------------------------------------------------

    def _repeat(self, given: Trace) -> str:
        """Repeats the steps of a trace; gives why the run ends here, or ""."""
        try:
            for step in given.steps():
                if self.request.interrupted():
                    return "interrupted"
                why = self._repeat_one(step)
                if why:
                    return why
                self.replayed += 1
        except TraceRefusedError as refused:
            return self._refuse(refused.why, refused.line)
        return ""

    def _repeat_one(self, step: Step) -> str:
        game = self.game
        assert game is not None
        try:
            _, why = self._advance_time()
            if why:
                if why == "breakpoint":
                    return why
                return self._refuse(
                    f"`{step.transition.name}` is not enabled: nothing is", step.line
                )
            if step.time is not None and step.time != game.marking.time:
                return self._refuse(
                    f"it says time {step.time}, but the clock shows {game.marking.time}", step.line
                )
            element = BindingElement.make(step.transition, step.bound)
            reason = game.why_disabled(game.marking, element)
        except GameError as error:
            return self._fail(error, step.transition)
        if reason is not None:
            return self._refuse(f"`{step.transition.name}` is not enabled: {reason}", step.line)
        why = self.fire(element)
        return why or self._compare_outputs(step)

    def _compare_outputs(self, step: Step) -> str:
        """Whether the code segment gave what the trace says."""
        assert self._occurred is not None
        for symbol, ours in self._occurred.values:
            assert symbol.colset is not None, "a net variable has a colour set"
            mine = json_text(to_json(symbol.colset, ours))
            theirs = json_text(to_json(symbol.colset, step.values[symbol]))
            if mine != theirs:
                return self._refuse(
                    f"the code segment gives `{symbol.name}` = {mine}, the trace says {theirs}",
                    step.line,
                )
        return ""

    def _refuse(self, why: str, line: int) -> str:
        self.refuse(f"line {line}: {why}" if line else why)
        return "replay"

    def refuse(self, why: str) -> None:
        """The trace that was to be repeated is refused."""
        self._refusal = why

    def fail_as(self, failure: Failure) -> None:
        """The net has failed in another engine."""
        self._failure = failure
