"""Traces of the token game: writing the lines of a `*.trace.jsonl` (docs/trace.md)."""

from __future__ import annotations

import json
from collections.abc import Iterator

from pn2code.semantics.game.marking import BindingElement, binding_to_json, initial_differences
from pn2code.semantics.game.token_game import Game


def header(game: Game, by: str = "reference") -> dict[str, object]:
    """The first line; to be made before the game begins."""
    own = game.own_initial_marking
    return {
        "trace": 1,
        "net": game.net.name,
        "source": game.net.file.replace("\\", "/").rsplit("/", 1)[-1],
        "digest": game.net.sha256,
        "by": by,
        "initial": initial_differences(game.colours, game.net.places, own, game.marking),
    }


def occurrence(game: Game, occurred: BindingElement) -> dict[str, object]:
    """The line of the occurrence that has just been fired."""
    t = game.net.transitions[occurred.transition]
    return {
        "step": game.steps,
        "t": game.marking.time,
        "transition": t.name,
        "binding": binding_to_json(occurred),
        "origin": t.id,
    }


def trace(game: Game, steps: int | None = None) -> Iterator[str]:
    """Plays on with the first enabled element each time, giving the lines of a trace, the last one included."""
    yield json.dumps(header(game), ensure_ascii=False)
    for occurred in game.run(steps=steps):
        yield json.dumps(occurrence(game, occurred), ensure_ascii=False)
    why = "steps" if game.enabled_in(game.advance_time(game.marking)) else "finished"
    yield json.dumps({"t": game.marking.time, "event": "end", "why": why})
