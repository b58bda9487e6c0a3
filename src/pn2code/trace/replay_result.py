"""What becomes of a trace that is replayed, how strictly it is read, and what its notes are compared with."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, Protocol

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.net.flat import FlatTransition
from pn2code.semantics.codes import TRACE_REFUSED
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game


@frozen
class ReplayResult:
    """What became of a trace.

    Args:
        ok: whether every step could be repeated.
        steps: how many were.
        why: if not ok: what is wrong with the next one.
        line: its line number in the file, from 1; 0 if ok.
        transition: its transition, "" if the line names none.
        ended: the trace's own last word (`why` of its `end` line), None when it just stops.
        game: the game after the last step that was repeated; None when the net itself could not be started.
        given_up: whether the next step is not known to be wrong: the token game gave up an evaluation.
        given: places that begin with other tokens than the net's, because the header says so.
        by_hand: notes of what a person has chosen.
        ended_at: the model time of that word; None: it has none.
    """

    ok: bool
    steps: int
    why: str
    line: int
    transition: str
    ended: str | None
    game: Game | None
    given_up: bool = False
    given: tuple[str, ...] = ()
    by_hand: int = 0
    ended_at: float | None = None

    @property
    def marking(self) -> Marking | None:
        """The marking after the last step that was repeated."""
        return self.game.marking if self.game else None

    def message(self) -> str:
        """One line for people."""
        if self.ok:
            end = f", ended: {self.ended}" if self.ended else ", without an end"
            return f"{self.steps} steps, each enabled when its turn came{end}"
        what = f" `{self.transition}`" if self.transition else ""
        return f"line {self.line}: after {self.steps} steps{what}: {self.why}"

    def report(self, d: Diagnostics, path: Path) -> None:
        """What is wrong, if anything is, as a diagnostic at the line of the trace file."""
        if not self.ok:
            at = Origin(str(path), line=self.line, element=f"step {self.steps + 1}")
            name = f"`{self.transition}`: " if self.transition else ""
            d.error(TRACE_REFUSED, name + self.why, at)


class Notes(Protocol):
    """What a run notes of its robots, beside what the net makes them do. Each answer is what is wrong, or None."""

    def begin(self, game: Game, by: str) -> None:
        """Before the first step."""

    def note(self, line: Mapping[str, Any]) -> str | None:
        """A note that is not the end."""

    def occurring(self) -> AbstractContextManager[None]:
        """While a transition occurs."""

    def step(
        self, line: Mapping[str, Any], t: FlatTransition, before: Marking, after: Marking
    ) -> str | None:
        """After it has occurred; the markings around it."""

    def end(self, game: Game, why: str) -> str | None:
        """The last line."""


@frozen
class Rules:
    """How strictly a trace is read.

    Args:
        own_clock: the clock follows the rules of the net and `t` must agree; else it follows `t`.
        priorities: whether no transition of higher priority may be enabled, whoever's it is; else none of the same
            party.
        time_unit: seconds in a unit of model time, where the clock follows `t`.
    """

    own_clock: bool
    priorities: bool
    time_unit: float = 1.0
