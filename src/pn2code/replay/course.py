"""The course of a run through the net: steps, what each changed, and now and then a whole marking.

    course = Course(net, time=lambda line, game: line["t"])
    course.begin(game)
    course.step(game, occurred, 1.25)       # for each occurrence
    course.described()                      # {"steps": 2, "time": {...}, "changes": {...}, "keys": {...}, ...}

A step holds the tokens that came and went, not a marking. A whole marking (a key) stands wherever the changes since the
last one have become more than twice the tokens of a marking: then any moment is reached from a key by few changes, and
all keys together are not larger than all changes. Texts stand in one table, each once.
"""

from __future__ import annotations

import array
from collections.abc import Mapping
from typing import Any

from pn2code.base.readable import readable
from pn2code.net.flat import FlatNet
from pn2code.replay.arrays import packed, packed_reals
from pn2code.semantics.game.constant import constant_transitions
from pn2code.semantics.game.marking import BindingElement, PlaceMarking, variable_text
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.colours import TEXTS
from pn2code.semantics.values.data import Data, Timed, Value, real_text
from pn2code.semantics.values.multiset import MultiSet

LONGEST = 4000
"""Characters of a value that are shown; the rest is cut off, and the text says so."""
MOST_DONE = 50_000
"""Elements of which it is remembered what they change."""
_FEWEST = 512
"""Changes between two keys, at least."""

Token = tuple[Value, int | float | None]


class Course:
    """Collects the steps of a run, in order."""

    def __init__(self, net: FlatNet) -> None:
        self._net = net
        self._texts: dict[str, int] = {}
        self._tokens: list[dict[Token, int]] = [{} for _ in net.places]
        self._token_place = array.array("q")
        self._is_rounded = False
        self._before: tuple[PlaceMarking, ...] = ()
        self._time = array.array("d")
        self._clock = array.array("d")
        self._transition = array.array("q")
        self._binding = array.array("q")
        self._offset = array.array("q", [0])
        self._changed = array.array("q")
        self._count = array.array("q")
        self._held: dict[int, int] = {}
        self._key_step = array.array("q")
        self._key_offset = array.array("q", [0])
        self._key_token = array.array("q")
        self._key_count = array.array("q")
        self._since_key = 0
        self._constant = constant_transitions(net)
        self._seen: set[int] = set()
        # What an element has done, by its identity: it is held here, so no other one gets that.
        self._done: dict[int, tuple[BindingElement, list[int], list[tuple[int, int]]]] = {}

    @property
    def steps(self) -> int:
        """How many there are so far."""
        return len(self._transition)

    def begin(self, game: Game) -> None:
        """The initial marking."""
        self._before = game.marking.places
        for place, marking in enumerate(game.marking.places):
            for token, n in _counted(marking).items():
                self._held[self._token(place, token)] = n
        self._key()

    def step(self, game: Game, occurred: BindingElement, time: float) -> None:
        """The game has come to its marking by this occurrence, at this moment of the axis."""
        self._transition.append(occurred.transition)
        self._time.append(time)
        self._clock.append(game.marking.time)
        known = self._done.get(id(occurred))
        if known is None:
            self._look(game, occurred)
        else:
            self._binding.extend(known[1])
            for token, by in known[2]:
                self._change(token, by)
        self._before = game.marking.places
        self._offset.append(len(self._changed))
        if self._since_key > max(_FEWEST, 2 * len(self._held)):
            self._key()

    def _look(self, game: Game, occurred: BindingElement) -> None:
        """What an occurrence has changed; the same element changes the same the next time, if its transition is one
        that does."""
        t = self._net.transitions[occurred.transition]
        values, changes = len(self._binding), len(self._changed)
        bound = dict(occurred.values)
        for s in t.variables:
            self._binding.append(
                self._value(t.index, s, bound[s]) if s in bound else self._text("?")
            )
        after = game.marking.places
        for place in dict.fromkeys(a.place for a in t.arcs):
            if after[place] is not self._before[place]:
                self._difference(place, self._before[place], after[place])
        if t.index in self._constant and self._is_back(occurred):
            if len(self._done) >= MOST_DONE:
                self._done.clear()
            rows = list(zip(self._changed[changes:], self._count[changes:], strict=True))
            self._done[id(occurred)] = occurred, list(self._binding[values:]), rows

    def _is_back(self, occurred: BindingElement) -> bool:
        """Whether it has been there before; most elements of some runs are unlike all others."""
        number = hash(occurred)
        if number in self._seen:
            return True
        if len(self._seen) >= MOST_DONE:
            self._seen.clear()
        self._seen.add(number)
        return False

    def _difference(self, place: int, before: PlaceMarking, after: PlaceMarking) -> None:
        left, came = _counted(before), _counted(after)
        for token, n in left.items():
            if (change := came.get(token, 0) - n) != 0:
                self._change(self._token(place, token), change)
        for token, n in came.items():
            if token not in left:
                self._change(self._token(place, token), n)

    def _change(self, token: int, by: int) -> None:
        self._changed.append(token)
        self._count.append(by)
        self._since_key += 1
        if n := self._held.get(token, 0) + by:
            self._held[token] = n
        else:
            del self._held[token]

    def _key(self) -> None:
        self._key_step.append(self.steps)
        for token, n in self._held.items():
            self._key_token.append(token)
            self._key_count.append(n)
        self._key_offset.append(len(self._key_token))
        self._since_key = 0

    def _token(self, place: int, token: Token) -> int:
        known = self._tokens[place]
        if token not in known:
            known[token] = len(self._token_place)
            self._token_place.append(place)
        return known[token]

    def _value(self, transition: int, symbol: Any, value: Value) -> int:
        self._is_rounded = self._is_rounded or _is_rounded(value)
        return self._text(variable_text(TEXTS, symbol, value))

    def _text(self, text: str) -> int:
        if len(text) > LONGEST:
            self._is_rounded = True
            text = f"{text[:LONGEST]}… ({len(text) - LONGEST:,} more characters)"
        return self._texts.setdefault(text, len(self._texts))

    def described(self) -> dict[str, Any]:
        """All of it, as JSON-able data; tokens are numbered in the order in which CPN Tools prints them."""
        order, rows = self._order()
        return {
            "steps": self.steps,
            "time": packed_reals(_numbers(self._time), double=True),
            "clock": packed_reals(_numbers(self._clock), double=True) if self._net.timed else None,
            "transition": packed(_numbers(self._transition)),
            "binding": packed(_numbers(self._binding)),
            "changes": {
                "offset": packed(_numbers(self._offset)),
                "token": packed(order[_numbers(self._changed)]),
                "count": packed(_numbers(self._count)),
            },
            "keys": {
                "step": packed(_numbers(self._key_step)),
                "offset": packed(_numbers(self._key_offset)),
                "token": packed(order[_numbers(self._key_token)]),
                "count": packed(_numbers(self._key_count)),
            },
            "tokens": rows,
            "texts": list(self._texts),
            "rounded": self._is_rounded,
        }

    def _order(self) -> tuple[Any, dict[str, Any]]:
        """The final number of each token, and what the tokens are in that order."""
        import numpy as np

        order = np.zeros(len(self._token_place), np.int64)
        place_of, text_of, stamp_of = array.array("q"), array.array("q"), array.array("q")
        for place in self._net.places:
            own = self._tokens[place.index]
            keys = {value: TEXTS.key(place.colset, value) for value, _ in own}

            def position(token: Token, keys: Mapping[Value, Any] = keys) -> Any:
                value, stamp = token
                return keys[value], -stamp if stamp is not None else 0

            self._is_rounded = self._is_rounded or any(map(_is_rounded, own))
            for token in sorted(own, key=position):
                order[own[token]] = len(place_of)
                value, stamp = token
                place_of.append(place.index)
                text_of.append(self._text(readable(TEXTS.text(place.colset, value))))
                shown = (
                    None if stamp is None else TEXTS.token_text(place.colset, Timed(value, stamp))
                )
                stamp_of.append(0 if shown is None else 1 + self._text(shown.rpartition("@")[2]))
        return order, {
            "place": packed(_numbers(place_of)),
            "text": packed(_numbers(text_of)),
            "stamp": packed(_numbers(stamp_of)),
        }


def _is_rounded(value: Any) -> bool:
    """Whether a value has a real that its text does not tell from all others."""
    match value:
        case float():
            return value == value and float(real_text(value).replace("~", "-")) != value
        case tuple():
            return any(map(_is_rounded, value))
        case Data(argument=argument):
            return argument is not None and _is_rounded(argument)
    return False


def _numbers(values: array.array[Any]) -> Any:
    import numpy as np

    return np.frombuffer(values, dtype=values.typecode) if values else np.zeros(0, np.int64)


def _counted(marking: PlaceMarking) -> Mapping[Token, int]:
    """How often each token is there."""
    if isinstance(marking, MultiSet):
        return {(value, None): n for value, n in marking.counts.items()}
    counts: dict[Token, int] = {}
    for token in marking:
        key = (token.value, token.stamp)
        counts[key] = counts.get(key, 0) + 1
    return counts
