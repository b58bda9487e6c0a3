"""What caused what in a recorded run: each occurrence with those whose tokens it has taken.

    story = told(path, net, owners, storage)     # Story; NoStoryError says why the trace is none
    story.occurrences[7].causes                  # (4, 6)
    story.occurrences[7].seconds                 # from the last of its causes to its own time

Of equal tokens the one that came first is taken. An inhibitor arc waits for whoever has emptied its place.
"""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen, record
from pn2code.base.os_reason import os_reason
from pn2code.net.flat import ArcKind, FlatNet
from pn2code.semantics.game.marking import BindingElement, Marking, PlaceMarking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import Timed
from pn2code.trace.replay import replay_lines


class NoStoryError(Exception):
    """A trace that cannot be read, or is none of this net; the text says why."""


@frozen
class Occurrence:
    """A transition that has occurred.

    Args:
        transition: its index; owner: whose it is.
        time: s, when its last command had ended.
        causes: the numbers of the occurrences whose tokens it has taken.
        since: s, when the last of them was: from then on it could have been under way.
    """

    transition: int
    owner: int
    time: float
    causes: tuple[int, ...]
    since: float

    @property
    def seconds(self) -> float:
        """How long it took."""
        return self.time - self.since


@frozen
class Story:
    """A run.

    Args:
        ended: why, as the trace says.
        seconds: how long it was.
    """

    occurrences: tuple[Occurrence, ...]
    ended: str
    seconds: float


def told(
    path: Path, net: FlatNet, owners: Sequence[int], storage: Mapping[str, str] | None = None
) -> Story:
    """The story of a trace of `pn2code run`.

    Args:
        path: the trace.
        net: the net; owners: by transition, whose it is.
        storage: as for `Game`.

    Raises:
        NoStoryError: it is none.
    """
    teller = _Teller(net, owners)
    try:
        with path.open(encoding="utf-8", errors="replace") as lines:
            result = replay_lines(teller.heard(lines), net, storage, watch=teller.watch)
    except OSError as problem:
        raise NoStoryError(f"`{path}` cannot be read: {os_reason(problem)}") from None
    if not result.ok:
        raise NoStoryError(f"`{path}`, line {result.line}: {result.why}")
    if teller.by != "run":
        raise NoStoryError(f"`{path}` is no trace of `pn2code run`, so it has no seconds")
    return Story(tuple(teller.occurrences), result.ended or "", teller.seconds)


Token = tuple[object, object]


@record
class _Place:
    """Who has put the tokens that a place holds, by colour and stamp; and who took one last."""

    makers: dict[Token, deque[int]]
    taker: int = -1


class _Teller:
    def __init__(self, net: FlatNet, owners: Sequence[int]) -> None:
        self.net, self.owners = net, owners
        self.occurrences: list[Occurrence] = []
        self.seconds = 0.0
        self.by = ""
        self._before: Marking | None = None
        self._places = [_Place({}) for _ in net.places]

    def heard(self, lines: Iterable[str]) -> Iterable[str]:
        """The same lines; the head and the end are noted."""
        for number, text in enumerate(lines):
            if number == 0 or '"end"' in text:
                self._note(text)
            yield text

    def _note(self, text: str) -> None:
        try:
            line = json.loads(text)
        except ValueError:
            return  # whoever repeats the trace says so
        if isinstance(line, dict):
            self.by = str(line.get("by", self.by))
            if line.get("event") == "end" and isinstance(line.get("t"), int | float):
                self.seconds = max(self.seconds, float(line["t"]))

    def watch(self, game: Game, occurred: BindingElement | None, line: Mapping[str, Any]) -> None:
        """One more occurrence."""
        before, after = self._before, game.marking
        self._before = after
        if before is None or occurred is None:
            for place, tokens in zip(self._places, after.places, strict=True):
                for token in _tokens(tokens):
                    place.makers.setdefault(token, deque()).append(-1)
            return
        t = self.net.transitions[occurred.transition]
        game.evaluator.now = after.time
        demands = game.enabling.demands(t, dict(occurred.values))
        left = game.enabling.take(replace(before, time=after.time), demands)
        assert isinstance(left, Marking), "it has just occurred"
        number, causes = len(self.occurrences), set[int]()
        for index in dict.fromkeys(a.place for a in t.arcs):
            place = self._places[index]
            taken = _less(_tokens(before.places[index]), _tokens(left.places[index]))
            for token in taken:
                causes.add(place.makers[token].popleft())
                place.taker = number
            for token in _less(_tokens(after.places[index]), _tokens(left.places[index])):
                place.makers.setdefault(token, deque()).append(number)
            for token in _less(_tokens(left.places[index]), _tokens(after.places[index])):
                place.makers[token].popleft()  # a reset arc
                place.taker = number
        causes |= {self._places[a.place].taker for a in t.arcs if a.kind is ArcKind.INHIBITOR}
        causes -= {-1, number}
        time = float(line.get("t", 0.0))
        self.seconds = max(self.seconds, time)
        since = max((self.occurrences[c].time for c in causes), default=0.0)
        owner = self.owners[t.index]
        self.occurrences.append(
            Occurrence(t.index, owner, time, tuple(sorted(causes)), min(since, time))
        )


def _tokens(marking: PlaceMarking) -> list[Token]:
    return [(x.value, x.stamp) if isinstance(x, Timed) else (x, None) for x in marking]


def _less(more: list[Token], less: list[Token]) -> list[Token]:
    """The tokens of one that are not in the other, each as often."""
    counts: dict[Token, int] = {}
    for token in less:
        counts[token] = counts.get(token, 0) + 1
    out = []
    for token in more:
        if counts.get(token, 0):
            counts[token] -= 1
        else:
            out.append(token)
    return out
