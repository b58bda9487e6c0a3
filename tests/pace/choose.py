"""In what order tests run, and which of them a quick run has.

chosen(asked, known, 60.0)     # numbers of tests: at least one of each file, then one case of each function, ...
longest_first(asked, known)    # the same tests, files that take long before the others
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from pace.durations import Durations, file_of, function_of


class Asked(NamedTuple):
    """A test that was collected, and the names of all fixtures that it needs."""

    test: str
    fixtures: tuple[str, ...]


class _Purse:
    """What the tests chosen so far take; a fixture that several of them share is paid once."""

    def __init__(self, known: Durations) -> None:
        self.known = known
        self.seconds = 0.0
        self._made: set[str] = set()

    def price(self, asked: Asked) -> float:
        """What one more test takes."""
        new = set(self.known.fixtures_of(*asked)) - self._made
        # Exact, so that the order of a set does not matter: all workers have to choose the same tests.
        return self.known.of_test(asked.test) + math.fsum(self.known.fixtures[f] for f in new)

    def pay(self, asked: Asked) -> None:
        """It is chosen."""
        self.seconds += self.price(asked)
        self._made.update(self.known.fixtures_of(*asked))


def chosen(tests: Sequence[Asked], known: Durations, seconds: float) -> list[int]:
    """The tests of a quick run: of each file the cheapest, then of each function, the cheap ones first, one case.

    What is left of the time goes to further cases, again the cheap ones first.

    Args:
        tests: all there are.
        known: what they take.
        seconds: how long they may take together. One test of each file is chosen even if that takes longer.

    Returns:
        numbers of tests, in their order.
    """
    purse = _Purse(known)
    prices = [purse.price(asked) for asked in tests]
    by_price = sorted(range(len(tests)), key=lambda n: (prices[n], n))
    taken: list[int] = []
    files: set[str] = set()
    functions: set[str] = set()

    def take(number: int) -> None:
        asked = tests[number]
        purse.pay(asked)
        taken.append(number)
        files.add(file_of(asked.test))
        functions.add(function_of(asked.test))

    for n in by_price:
        if file_of(tests[n].test) not in files:
            take(n)
    for is_one_each in (True, False):
        already = set(taken)
        for n in by_price:
            if n in already or (is_one_each and function_of(tests[n].test) in functions):
                continue
            if purse.seconds + purse.price(tests[n]) <= seconds:
                take(n)
    return sorted(taken)


def longest_first(tests: Sequence[Asked], known: Durations) -> list[int]:
    """Numbers of tests, file by file; files that take long come first, so that all cores end together."""
    purses: dict[str, _Purse] = {}
    for asked in tests:
        purses.setdefault(file_of(asked.test), _Purse(known)).pay(asked)
    return sorted(range(len(tests)), key=lambda n: -purses[file_of(tests[n].test)].seconds)
