"""What a page is told of a session: all of it once, then what has changed.

view = View(session)
view.state()  # {"position": 3, "places": {"7": [2, "1`1++\\n1`5"]}, "enabled": {"more": [4], "less": []}, ...}
"""

from __future__ import annotations

from itertools import islice
from typing import Any

from pn2code.play.history import Entry, Kind
from pn2code.play.session import Session
from pn2code.play.trouble import Json, of_game
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.marking import PlaceMarking, place_text, variable_text
from pn2code.semantics.game.report import time_text
from pn2code.semantics.values.colours import TEXTS

LONGEST = 4_000
"""Characters of a marking that are sent; the page asks for the rest."""
WHOLE = 2_000_000
"""Characters of a marking that somebody asks for."""
MOST_RAISING = 100
"""Transitions that raise an exception are told."""
MOST_WORDS = 400
"""Characters of a value in a binding."""
MOST_POINTS = 2_000
"""Points of a plot that are sent at a time."""


def shortened(text: str, most: int) -> str:
    """A text of at most so many characters; what is cut off is told."""
    return text if len(text) <= most else f"{text[:most]}… ({len(text) - most:,} more characters)"


class View:
    """What one page has been told.

    Args:
        session: the session.
    """

    def __init__(self, session: Session) -> None:
        self.session = session
        self._told: list[PlaceMarking | None] = [None] * len(session.net.places)
        self._enabled_told: set[int] | None = None
        self._points: list[int] = []

    def state(self) -> Json:
        """What has changed since the last time."""
        session = self.session
        game, history = session.game, session.history
        enabled, later, error, raising = self._enabled()
        last = history.position - 1
        return {
            "position": history.position,
            "length": history.length,
            "forgotten": history.forgotten,
            "steps": game.steps,
            "time": time_text(game.marking.time),
            "seed": session.seed,
            "places": self._places(),
            "enabled": self._changed(enabled),
            "later": None if later is None else time_text(later),
            "error": error,
            "raising": raising,
            "last": entry_row(session, last) if last >= history.forgotten else None,
            "saves": session.run[2],
            "output": self._taken(session.output),
            "notices": self._taken(session.notices),
            "monitors": self._monitors(),
        }

    def _enabled(self) -> tuple[list[int], int | float | None, Json | None, list[Json]]:
        """What is enabled; when something is; why the net cannot go on; transitions that raise an exception."""
        game = self.session.game
        found, wrong = game.enabled_or_raising(game.marking)
        enabled = [t.index for t in found]
        raising = [
            {"transition": index, "message": error.message}
            for index, error in islice(wrong.items(), MOST_RAISING)
        ]
        if enabled:
            return enabled, None, None, raising
        try:
            if wrong:
                raise next(iter(wrong.values()))
            return [], self.session.later(), None, raising
        except GameError as error:
            trouble = of_game(error)
            return [], None, {"message": trouble.message, "rows": trouble.rows}, raising

    def _changed(self, enabled: list[int]) -> list[int] | Json:
        """All that is enabled, for a page that knows nothing yet; else what is now, and what is no more."""
        told, now = self._enabled_told, set(enabled)
        self._enabled_told = now
        if told is None:
            return enabled
        return {"more": sorted(now - told), "less": sorted(told - now)}

    def _places(self) -> Json:
        found: Json = {}
        for p, tokens in zip(
            self.session.net.places, self.session.game.marking.places, strict=True
        ):
            if tokens is self._told[p.index]:
                continue
            self._told[p.index] = tokens
            text = place_text(TEXTS, p.colset, tokens)
            row: list[Any] = [len(tokens), text[:LONGEST]]
            found[str(p.index)] = [*row, len(text)] if len(text) > LONGEST else row
        return found

    @staticmethod
    def _taken(texts: list[str]) -> list[str]:
        taken = list(texts)
        texts.clear()
        return taken

    def _monitors(self) -> Json | None:
        watching = self.session.watching
        if watching is None:
            return None
        if len(self._points) != len(watching.points):
            self._points = [0] * len(watching.points)
        position = self.session.history.position
        plots = []
        for i, points in enumerate(watching.points):
            start = min(self._points[i], len(points))
            plots.append({"from": start, "points": thinned(points[start:])})
            self._points[i] = len(points)
        return {
            "rows": watching.rows(),
            "plots": plots,
            "missed": watching.missed,
            "warnings": watching.warnings(),
            "position": position,
        }

    def place(self, index: int) -> Json:
        """All that a place holds."""
        p = self.session.net.places[index]
        text = place_text(TEXTS, p.colset, self.session.game.marking.places[index])
        return {"text": shortened(text, WHOLE)}


def thinned(points: list[tuple[int, float, Any]]) -> list[list[Any]]:
    """The points of a plot, of very many every so many."""
    every = max(1, len(points) // MOST_POINTS)
    return [[at, float(time), _number(value)] for at, time, value in points[::every]]


def _number(value: Any) -> float:
    number = float(value)
    return number if number == number and abs(number) != float("inf") else 0.0


def binding_rows(session: Session, element: Any) -> list[list[str]]:
    """The values of an element's variables: [name, text]."""
    return [
        [s.name, shortened(variable_text(TEXTS, s, value), MOST_WORDS)]
        for s, value in element.values
    ]


def entry_row(session: Session, number: int) -> Json:
    """An entry of the history for the page."""
    entry: Entry = session.history.entry(number)
    row: Json = {
        "number": number,
        "kind": entry.kind.value,
        "step": entry.after.steps,
        "time": time_text(entry.after.time),
    }
    if entry.kind is Kind.STEP and entry.element is not None:
        row["transition"] = entry.element.transition
        row["binding"] = binding_rows(session, entry.element)
    elif entry.kind is Kind.EDIT:
        row["place"] = entry.place
    elif entry.kind is Kind.LEAP:
        row["count"] = entry.after.steps - entry.before.steps
    return row


def entries(session: Session, start: int, end: int) -> list[Json]:
    """Rows of the history, those that are remembered."""
    first = max(start, session.history.forgotten)
    return [entry_row(session, i) for i in range(first, min(end, session.history.length))]
