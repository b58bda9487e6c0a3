"""How far a loop is: said now and then, with a rate, and with what is left where the number of all is known.

more = HowFar(line.say, "sweeping pairs", total=len(pairs))
for pair in pairs:
    more()      # "sweeping pairs: 1,200 of 9,870, 310 a second, about 28 s left"

with listening(line.say):               # whoever shows how a command goes on
    ...
for t in counted(transitions, "translating transitions"):    # in a loop deep inside, which knows nothing of a line
    ...
beginning("solving 2,000 equations")    # before a call that lets no other thread run, so that nobody can count seconds
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

PERIOD_S = 0.5
"""It is said no more often than that."""

Say = Callable[[str], None]


T = TypeVar("T")


def silent(_text: str) -> None:
    """Nobody listens."""


_LISTENER: ContextVar[Say] = ContextVar("_LISTENER", default=silent)


@contextmanager
def listening(say: Say) -> Iterator[None]:
    """Loops in this block, and in all that it calls, say how far they are."""
    before = _LISTENER.set(say)
    try:
        yield
    finally:
        _LISTENER.reset(before)


class HowFar:
    """Counts.

    Args:
        say: hears in words how far it is.
        what: is done; noun: what is counted, where not all are known.
        total: all of them; 0: nobody knows.
        clock: seconds since any moment.
    """

    def __init__(
        self,
        say: Say,
        what: str,
        *,
        noun: str = "",
        total: int = 0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._say, self._what, self._noun, self._total = say, what, noun, total
        self._clock = clock
        self._began = self._said = clock()
        self._count = 0

    def __call__(self, count: int = 1) -> None:
        """One more is done, or so many."""
        self._count += count  # one is too few for a rate
        now = self._clock()
        if now - self._said >= PERIOD_S and self._count > 1:
            self._said = now
            self._say(self._text(now - self._began))

    def _text(self, passed: float) -> str:
        rate = self._count / passed
        counted = f" of {self._total:,}" if self._total else f" {self._noun}"
        text = f"{self._what}: {self._count:,}{counted}, {_rate(rate)}"
        if not self._total:
            return text
        return f"{text}, about {max(self._total - self._count, 0) / rate:,.0f} s left"


def _rate(a_second: float) -> str:
    return f"{a_second:,.0f} a second" if a_second >= 10 else f"{a_second:.1f} a second"


def counting(what: str, *, noun: str = "", total: int = 0) -> HowFar:
    """For a loop whose listener is that of the command."""
    return HowFar(_LISTENER.get(), what, noun=noun, total=total)


def counted(items: Collection[T], what: str) -> Iterator[T]:
    """The items; whoever listens is told how many of them are done."""
    more = counting(what, total=len(items))
    for item in items:
        yield item
        more()


def beginning(what: str) -> None:
    """Whoever listens is told what begins: a call of a library during which no thread runs that could count seconds.

    Args:
        what: is done, and how large it is.
    """
    _LISTENER.get()(f"{what} ...")
