"""What goes wrong in a session, in a form that the page shows in place."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pn2code.diagnostics import Diagnostic, Diagnostics
from pn2code.semantics.game.errors import GameError

Json = dict[str, Any]

MOST_ROWS = 200


class Trouble(Exception):
    """A command cannot be carried out (a user's matter): the message, and rows about it.

    Args:
        message: lower case, without full stop.
        rows: what is wrong, each with its place.
    """

    def __init__(self, message: str, rows: Iterable[Json] = ()) -> None:
        super().__init__(message)
        self.message = message
        self.rows = list(rows)


def row(item: Diagnostic) -> Json:
    """A diagnostic for the page."""
    span = item.span
    return {
        "severity": item.severity.value,
        "code": item.code,
        "message": item.message,
        "hint": item.hint,
        "label": item.label,
        "notes": [note.message for note in item.notes],
        "where": item.origin.describe(),
        "page": item.origin.page,
        "id": item.origin.element_id,
        "part": item.origin.part,
        "line": item.origin.line,
        "column": item.origin.column,
        "text": span.source.text[:2000] if span is not None else "",
        "from": span.start if span is not None else -1,
        "to": span.end if span is not None else -1,
    }


def rows(items: Iterable[Diagnostic]) -> list[Json]:
    """Diagnostics for the page; of very many the first."""
    return [row(item) for item, _ in zip(items, range(MOST_ROWS), strict=False)]


def of_game(error: GameError) -> Trouble:
    """What the net has done wrong."""
    d = Diagnostics()
    error.report(d)
    return Trouble(error.message, rows(d.sorted()))


def of_diagnostics(d: Diagnostics, otherwise: str) -> Trouble:
    """What was reported."""
    found = d.errors
    return Trouble(found[0].message if found else otherwise, rows(d.sorted()))
