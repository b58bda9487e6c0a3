"""A course that grows: what has been added since the last look, in the form of a description.

    course = GrowingCourse(net)
    course.begin(game)
    course.step(game, occurred, 1.25)
    course.news()      # {"steps": 1, "time": [1.25], "changes": [[...]], "tokens": {...}, ...}

Tokens get their numbers as they come. The order in which CPN Tools prints them is that of their `rank`, a number
between those of the neighbours in the same place; where there is no room for one, the whole place gets new ones.
"""

from __future__ import annotations

from bisect import bisect_left
from typing import Any

from pn2code.base.readable import readable
from pn2code.net.flat import FlatNet
from pn2code.replay.course import Course, Token
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.colours import TEXTS
from pn2code.semantics.values.data import Timed

Json = dict[str, Any]
_Key = tuple[Any, int | float]


class GrowingCourse(Course):
    """Collects the steps of a run that goes on."""

    def __init__(self, net: FlatNet) -> None:
        super().__init__(net)
        self._fresh: list[Token] = []
        self._order_of: list[list[tuple[_Key, int]]] = [[] for _ in net.places]
        self._rank: list[float] = []
        self._ranked_again: set[int] = set()
        self._told_steps = self._told_changes = self._told_bindings = self._told_texts = 0
        self._told_tokens = 0
        self._first: list[list[int]] | None = None

    def begin_unknown(self) -> None:
        """The marking is not known yet, and perhaps never: nothing is shown of it until `begin`."""
        self._first = []

    def begin(self, game: Game) -> None:
        """The marking with which it begins."""
        super().begin(game)
        self._first = [[token, n] for token, n in self._held.items()]

    def _key(self) -> None:
        """A course that grows has one key only, its beginning."""
        if not self._key_step:
            super()._key()

    def _token(self, place: int, token: Token) -> int:
        known = len(self._token_place)
        number = super()._token(place, token)
        if number == known:
            self._fresh.append(token)
            self._rank.append(self._ranked(place, token, number))
        return number

    def _ranked(self, place: int, token: Token, number: int) -> float:
        value, stamp = token
        key: _Key = (TEXTS.key(self._net.places[place].colset, value), -(stamp or 0))
        row = self._order_of[place]
        at = bisect_left(row, (key, -1))
        low = self._rank[row[at - 1][1]] if at else None
        high = self._rank[row[at][1]] if at < len(row) else None
        row.insert(at, (key, number))
        if low is None or high is None:
            return (low + 1.0) if low is not None else (high - 1.0) if high is not None else 0.0
        middle = (low + high) / 2.0
        if low < middle < high:
            return middle
        self._ranked_again.add(place)
        for i, (_, other) in enumerate(row):
            if other != number:
                self._rank[other] = float(i)
        return float(at)

    def news(self) -> Json:
        """What came since the last call. In the first there is the marking of the beginning, too (`first`)."""
        steps, changes = self.steps, self._offset
        told = self._told_steps
        rows = [
            [
                number
                for i in range(changes[k], changes[k + 1])
                for number in (self._changed[i], self._count[i])
            ]
            for k in range(told, steps)
        ]
        added: Json = {
            "steps": steps,
            "time": list(self._time[told:]),
            "clock": list(self._clock[told:]) if self._net.timed else None,
            "transition": list(self._transition[told:]),
            "binding": list(self._binding[self._told_bindings :]),
            "changes": rows,
            "tokens": self._new_tokens(),
        }
        added["texts"] = list(self._texts)[self._told_texts :]
        if self._first is not None:
            added["first"], self._first = self._first, None
        self._told_steps, self._told_bindings = steps, len(self._binding)
        self._told_texts = len(self._texts)
        return added

    def _new_tokens(self) -> Json:
        place_of, text_of, stamp_of = [], [], []
        first = self._told_tokens
        for place, (value, stamp) in zip(self._token_place[first:], self._fresh, strict=True):
            colset = self._net.places[place].colset
            place_of.append(place)
            text_of.append(self._text(readable(TEXTS.text(colset, value))))
            shown = None if stamp is None else TEXTS.token_text(colset, Timed(value, stamp))
            stamp_of.append(0 if shown is None else 1 + self._text(shown.rpartition("@")[2]))
        again = {
            number: self._rank[number]
            for place in self._ranked_again
            for _, number in self._order_of[place]
        }
        rows = {
            "place": place_of,
            "text": text_of,
            "stamp": stamp_of,
            "rank": self._rank[first:],
            "again": list(again.items()),
        }
        self._fresh, self._ranked_again = [], set()
        self._told_tokens = len(self._token_place)
        return rows
