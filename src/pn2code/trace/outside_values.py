"""What of a recorded run depends on more than the net: numbers that are drawn, files and clocks."""

from __future__ import annotations

from typing import Any

from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.effects import OUTSIDE, Effect, Effects, texts
from pn2code.semantics.evaluation.references import References
from pn2code.semantics.game.partial_marking import PartialMarking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.colour_text import read_value
from pn2code.semantics.values.data import Value
from pn2code.trace.recording import RecordedStep


class RefusedError(Exception):
    """A step cannot be repeated in a state; the message says why."""


class OutsideValues:
    """Knows what of a net depends on more than itself.

    Args:
        game: of the net.
        effects: of its expressions.
        references: of its declarations.
        lenient: whether what depends on more than the net is taken as it is recorded.
    """

    def __init__(
        self, game: Game, effects: Effects, references: References, *, lenient: bool
    ) -> None:
        self.game = game
        self.net: FlatNet = game.net
        self.effects = effects
        self.lenient = lenient
        self.references = references
        self.real_time = game.net.real_time

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

    def read_one(self, symbol: Symbol, step: RecordedStep) -> Value:
        """The recorded value of a variable."""
        assert symbol.colset is not None, "a net variable has a colour set"
        text = step.binding[symbol.name]
        value = read_value(symbol.colset, text, real_time=self.real_time)
        if value is None:
            raise RefusedError(
                f"`{symbol.name}` = {on_one_line(text)} is no value of `{symbol.colset.name}`"
            )
        return value


def on_one_line(text: str) -> str:
    """A text without line breaks."""
    return " ".join(text.split())
