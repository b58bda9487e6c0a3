"""A game of somebody: what can be done with it, step by step and back.

session = Session(loaded, typist, seed=1, folder=Path("/tmp/x"))
session.step()                       # what `simulate --seed 1` does first
session.fire(3, element)
session.undo()

The steps are those of the reference token game. Each session has a game of its own; what is the net's is shared.
"""

from __future__ import annotations

import json
import random
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.monitors.watch import Breakpoint
from pn2code.net.flat import FlatTransition
from pn2code.play import bindings
from pn2code.play.changes import Changes
from pn2code.play.history import History, Kind
from pn2code.play.loading import Loaded
from pn2code.play.tape import Tape
from pn2code.play.trouble import Trouble, of_game, rows
from pn2code.play.typed_texts import BadText, Typist
from pn2code.play.value_text import value_text
from pn2code.play.watching import Watching
from pn2code.properties.judge import tokens
from pn2code.semantics.evaluation.random import CHOICE, RandomStream
from pn2code.semantics.evaluation.references import References
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.marking import (
    BindingElement,
    Marking,
    element_text,
    initial_differences,
)
from pn2code.semantics.game.token_game import Game, NotEnabled
from pn2code.semantics.values.data import MlException, MlLimit, MlUnavailable, Value
from pn2code.trace.token_game import occurrence
from pn2code.trace.writing import json_text

MOST_BYTES = 256 << 20
"""Of memory for what can be taken back, of a session."""
MOST_OUTPUT = 100_000
"""Characters that the net has printed and that the page has not seen yet."""
NONE_ENABLED = "nothing is enabled, now or later: the marking is dead"

Initial = Mapping[str, Any]


class Session:
    """A game.

    Args:
        loaded: the net, free of errors.
        typist: types what is typed in.
        seed: of all random numbers.
        folder: a folder of its own, for its files.
        most_bytes: of memory for what can be taken back.

    Attributes:
        stop: set by others to end what takes long.
        output: what the net has printed; notices: what is to be said. Both are emptied by who shows them.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """

    def __init__(
        self,
        loaded: Loaded,
        typist: Typist,
        *,
        seed: int,
        folder: Path,
        most_bytes: int = MOST_BYTES,
    ) -> None:
        assert loaded.opened is not None, "the net has no errors"
        self.loaded = loaded
        self.opened = loaded.opened
        self.net = loaded.opened.flat
        self.typist = typist
        self.folder = folder
        self.seed = seed
        self.stop = threading.Event()
        self.history = History(Changes.of(self.net), most_bytes)
        self.tape = Tape(folder / "steps.jsonl")
        self.output: list[str] = []
        self.notices: list[str] = []
        self._runs: list[tuple[int, Initial, str]] = []
        self.begin()

    def close(self) -> None:
        """No more of it."""
        self.stop.set()
        self.tape.close()

    # --- the beginning ---------------------------------------------------------------------------

    def begin(self) -> None:
        """A new game with the net's initial marking.

        Raises:
            GameError: a declaration or an initial marking raises an exception.
        """
        game = Game(self.net, self.opened.storage, seed=self.seed, output=self._print)
        self.adopt(game, {}, "")

    def adopt(self, game: Game, initial: Initial, obstacle: str) -> None:
        """A new run with this game, at its start.

        Args:
            game: the game.
            initial: what places begin with that do not begin with the net's own initial marking.
            obstacle: why the run cannot be saved; "" if it can.
        """
        self.game = game
        self.references = References(game.evaluator)
        self._chance = random.Random(self.seed)
        self.history.clear()
        self.tape.clear()
        self._runs = [(0, initial, obstacle)]
        program = self.loaded.monitors
        self.watching: Watching | None = None
        self.history.more = 0
        if program is not None:
            try:
                self.watching = Watching(program, game)
                self.history.more = self.watching.weight
            except GameError as error:
                self.notices.append(f"the monitors do not work: {error.message}")

    def _print(self, text: str) -> None:
        if sum(map(len, self.output)) < MOST_OUTPUT:
            self.output.append(text)

    @property
    def run(self) -> tuple[int, Initial, str]:
        """The run that goes on: the entry with which it begins, what places begin with, why it cannot be saved."""
        return next(r for r in reversed(self._runs) if r[0] <= self.history.position)

    # --- one step --------------------------------------------------------------------------------

    def transition(self, index: int) -> FlatTransition:
        """The transition of this number.

        Raises:
            Trouble: there is none.
        """
        if not 0 <= index < len(self.net.transitions):
            raise Trouble("the net has no such transition")
        return self.net.transitions[index]

    def fire(self, element: BindingElement) -> Breakpoint | None:
        """Lets an element occur that somebody has chosen; the breakpoint of a monitor that it has reached.

        Raises:
            Trouble: it is not enabled, or the net raises an exception.
        """
        return self._occur(element, (self.game.marking, self.game.steps), None, checked=True)

    def fire_later(self, element: BindingElement) -> None:
        """Lets an element occur, when it is enabled: the time moves on first if nothing is enabled now.

        Raises:
            Trouble: it is not enabled, or the net raises an exception.
        """
        before = self.game.marking, self.game.steps
        try:
            if not self.game.enabled_or_raising(self.game.marking)[0]:
                self.game.marking = self.game.advance_time(self.game.marking)
        except GameError as error:
            raise of_game(error) from None
        self._occur(element, before, None, checked=True)

    def fire_any(self, index: int) -> Breakpoint | None:
        """Lets a transition occur with a binding chosen at random.

        Raises:
            Trouble: it is not enabled, or the net raises an exception.
        """
        t = self.transition(index)
        try:
            found = bindings.listed(self.game, t, most=10_000)
        except GameError as error:
            raise of_game(error) from None
        if not found.elements:
            raise Trouble(f"`{t.short}` is not enabled")
        return self.fire(self._chance.choice(found.elements))

    def step(self) -> Breakpoint | None:
        """A step chosen at random, as `simulate` chooses it; the time moves on if nothing is enabled now.

        Raises:
            Trouble: nothing is ever enabled, or the net raises an exception.
        """
        before = self.game.marking, self.game.steps
        try:
            element = self.chosen()
        except GameError as error:
            self.game.marking = before[0]
            raise of_game(error) from None
        if element is None:
            raise Trouble(NONE_ENABLED)
        return self._occur(element, before, self.seed, checked=False)

    def chosen(self) -> BindingElement | None:
        """What `simulate` would let occur next, at the time to which it is moved; None if there is nothing.

        Raises:
            GameError: an inscription raises an exception.
        """
        game = self.game
        later = game.advance_time(game.marking)
        enabled = game.enabled_transitions(later)
        if not enabled:
            return None
        game.marking = later
        choice = RandomStream(self.seed)
        choice.start(game.steps, CHOICE)
        t = enabled[choice.below(len(enabled))]
        found = list(game.bindings(t, later))
        return BindingElement.make(t, found[choice.below(len(found))])

    def _occur(
        self,
        element: BindingElement,
        before: tuple[Marking, int],
        chosen: int | None,
        *,
        checked: bool,
    ) -> Breakpoint | None:
        game = self.game
        try:
            if checked:
                self._expect_enabled(element)
            occurred = game.fire(element, checked=False)
        except GameError as error:
            game.marking, game.steps = before
            raise of_game(error) from None
        except NotEnabled as why:
            game.marking, game.steps = before
            raise Trouble(str(why)) from None
        number = self.history.position
        self._record(Kind.STEP, before, element=occurred, chosen=chosen)
        if self.watching is None:
            return None
        try:
            return self.watching.occurred(number, occurred)
        except GameError as error:
            raise of_game(error) from None

    def _expect_enabled(self, element: BindingElement) -> None:
        """Looks at the transition itself; another one that raises an exception does not disable it.

        Raises:
            NotEnabled: it is not enabled with this binding, or another one has a higher priority.
            GameError: an inscription of it raises an exception.
        """
        game = self.game
        why = game.why_disabled(game.marking, element, priorities=False)
        enabled = [t.index for t in game.enabled_or_raising(game.marking)[0]]
        if why is None and element.transition not in enabled:
            why = game.why_disabled(game.marking, element)
        if why is not None:
            raise NotEnabled(f"{element_text(game.colours, game.net, element)}: {why}")

    def _record(
        self,
        kind: Kind,
        before: tuple[Marking, int],
        *,
        element: BindingElement | None = None,
        place: int = -1,
        chosen: int | None = None,
        lines: Sequence[bytes] | None = None,
    ) -> None:
        """Something has happened; the game is in the marking after it."""
        game, number = self.game, self.history.position
        self._runs = [r for r in self._runs if r[0] <= number]
        if lines is None:
            lines = () if element is None else (self.line(element),)
        self.tape.add(number, lines)
        after = game.marking, game.steps
        self.history.add(kind, before, after, element=element, place=place, chosen=chosen)
        if self.watching is not None:
            missed = after[1] - before[1] if kind is Kind.LEAP else 0
            self.watching.goes_on(number, missed)
            self.watching.forget(self.history.forgotten)

    def made(self, before: tuple[Marking, int], occurred: BindingElement) -> None:
        """The game has made a step at somebody else's order."""
        number = self.history.position
        self._record(Kind.STEP, before, element=occurred)
        if self.watching is not None:
            try:
                self.watching.occurred(number, occurred)
            except GameError as error:
                self.notices.append(error.message)

    def leapt(self, marking: Marking, steps: int, lines: Sequence[bytes]) -> None:
        """Many steps were made elsewhere: the marking after them, the number of steps, their lines."""
        game = self.game
        before = game.marking, game.steps
        game.marking, game.steps = replace(marking, references=game.marking.references), steps
        self._record(Kind.LEAP, before, chosen=self.seed, lines=lines)

    def forbid_saving(self, why: str) -> None:
        """From here on the run cannot be saved."""
        _, initial, before = self.run
        self._runs.append((self.history.position, initial, before or why))

    def stopped_at(self, time: int | float) -> None:
        """The clock was moved on to where a run had to end."""
        before = self.game.marking, self.game.steps
        self.game.marking = replace(self.game.marking, time=time)
        self._record(Kind.TIME, before, chosen=self.seed)

    def line(self, element: BindingElement) -> bytes:
        """What a trace says of what has just occurred."""
        text = json_text(occurrence(self.game, element))
        return (text + "\n").encode("utf-8", "surrogateescape")

    # --- back and on -----------------------------------------------------------------------------

    def undo(self) -> None:
        """Takes the last entry back.

        Raises:
            Trouble: there is none.
        """
        if not self.history.can_go_back:
            forgotten = self.history.forgotten
            raise Trouble(
                "this is the beginning"
                if not forgotten
                else f"the first {forgotten:,} steps cannot be taken back: they were more than there is memory for"
            )
        self.game.marking, self.game.steps = self.history.back(self.game.marking)
        if self.watching is not None:
            self.watching.back(self.history.position)

    def redo(self) -> None:
        """Makes the next entry again.

        Raises:
            Trouble: there is none.
        """
        if self.history.position == self.history.length:
            raise Trouble("nothing was taken back")
        number = self.history.position
        self.game.marking, self.game.steps = self.history.on(self.game.marking)
        if self.watching is not None:
            self.watching.on(number)

    def go(self, position: int) -> None:
        """To the moment after so many entries.

        Raises:
            Trouble: they are not remembered.
        """
        if not self.history.forgotten <= position <= self.history.length:
            raise Trouble(f"there is no step {position}")
        while self.history.position > position:
            self.undo()
        while self.history.position < position:
            self.redo()

    # --- time ------------------------------------------------------------------------------------

    def later(self) -> int | float | None:
        """The time at which something is enabled next, if nothing is now; None if nothing ever is.

        Raises:
            GameError: an inscription raises an exception.
        """
        found = self.game.advance_time(self.game.marking)
        return None if found.time == self.game.marking.time else found.time

    def advance(self, time: int | float | None = None) -> None:
        """Moves the clock on to where something is enabled.

        Args:
            time: or to this time, if that is earlier.

        Raises:
            Trouble: something is enabled now, or nothing ever is.
        """
        game = self.game
        before = game.marking, game.steps
        try:
            if game.enabled_transitions(game.marking):
                raise Trouble("the clock stands while something is enabled")
            found = self.later()
        except GameError as error:
            raise of_game(error) from None
        if found is None:
            raise Trouble(NONE_ENABLED)
        game.marking = replace(game.marking, time=found if time is None else min(found, time))
        self._record(Kind.TIME, before, chosen=self.seed)
        if self.watching is not None:
            self.watching.time_grew()

    def set_seed(self, seed: int) -> None:
        """The seed of the choices from now on; before the first step, of all random numbers."""
        self.seed = seed
        self._chance = random.Random(seed)
        if self.history.length == 0 and not self.run[1] and not self.run[2]:
            self.begin()

    # --- by hand ---------------------------------------------------------------------------------

    def edit(self, place: int, text: str) -> None:
        """What a place holds from now on; with it a new run begins.

        Args:
            place: index of the place.
            text: CPN ML, as an initial marking; tokens without a stamp are available now.

        Raises:
            Trouble: the text is wrong, or the net raises an exception.
        """
        if not 0 <= place < len(self.net.places):
            raise Trouble("the net has no such place")
        game, p = self.game, self.net.places[place]
        try:
            exp, form, origin = self.typist.marking(text, p)
        except BadText as bad:
            raise Trouble(str(bad), rows(bad.diagnostics)) from None
        before = game.marking, game.steps
        held = self.references.contents()
        try:
            game.enter(game.marking)
            own = game.marking_of(p, exp, form, origin, "the new marking")
        except GameError as error:
            raise of_game(error) from None
        finally:
            self.references.restore(held)
        places = list(game.marking.places)
        places[place] = own
        game.marking, game.steps = replace(game.marking, places=tuple(places)), 0
        self._record(Kind.EDIT, before, place=place)
        self._runs.append((self.history.position, *self._begun_here()))

    def _begun_here(self) -> tuple[Initial, str]:
        """What a run begins with that begins with the marking of now, and why it cannot be saved."""
        game = self.game
        own = game.own_initial_marking
        initial = initial_differences(game.colours, self.net.places, own, game.marking)
        why = self.run[2]
        if game.marking.references != own.references:
            why = "the marking was changed when references held other values than at the start"
        return {**self.given(), **initial}, why

    def given(self) -> Initial:
        """What files have given the net, as the header of a trace has it."""
        return dict(json.loads(self.opened.initial)) if self.opened.initial else {}

    # --- expressions -----------------------------------------------------------------------------

    def evaluate(self, text: str) -> tuple[str, str]:
        """The type and the value of an expression in the current marking; nothing of the net changes.

        Raises:
            Trouble: it is wrong, or raises an exception.
        """
        try:
            typed = self.typist.expression(text)
        except BadText as bad:
            raise Trouble(str(bad), rows(bad.diagnostics)) from None
        value = self._value(lambda: self._evaluated(typed.exp, typed.looks))
        return str(typed.type), value_text(typed.type, value, self.net.program.datatypes)

    def _evaluated(self, exp: Any, looks: Any) -> Value:
        game = self.game
        game.enter(game.marking)
        found = {symbol: tokens(game, game.marking, place) for symbol, place in looks}
        return game.evaluator.value(exp, found)

    def _value(self, work: Callable[[], Value]) -> Value:
        held = self.references.contents()
        try:
            return work()
        except MlException as raised:
            raise Trouble(f"the expression raised the exception `{raised}`") from None
        except (MlUnavailable, MlLimit, RecursionError) as why:
            raise Trouble(f"the expression was given up: {why}") from None
        finally:
            self.references.restore(held)

    def holds(self, exp: Any, looks: Any) -> bool:
        """Whether a condition is true now.

        Raises:
            Trouble: it raises an exception.
        """
        return self._value(lambda: self._evaluated(exp, looks)) is True
