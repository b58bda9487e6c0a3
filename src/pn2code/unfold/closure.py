"""Forward closure: all colours that can come into places, and what puts them there, if tokens were never used up.

In rounds (semi-naive): what is searched over the colours known so far uses at least one that is new, so that each
binding is found once. One whose other demands are not known yet waits for them.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Hashable, Iterator, Mapping
from typing import Generic, Protocol, TypeVar

Colour = TypeVar("Colour", bound=Hashable)


class Demanding(Protocol[Colour]):
    """What can occur when all that it demands can be there."""

    @property
    def pre(self) -> Mapping[tuple[int, Colour], int]:
        """How many tokens of each colour, by place and colour."""


Element = TypeVar("Element", bound=Demanding)  # type: ignore[type-arg]


class Closure(Generic[Colour, Element]):
    """A closure under way.

    Args:
        places: how many there are.

    Attributes:
        known: the colours of each place.
        seen: those that the searches so far have used; new: those that came since.
        ready: elements all of whose demands are known, which have not put anything yet.
    """

    def __init__(self, places: int) -> None:
        self.known: list[set[Colour]] = [set() for _ in range(places)]
        self.seen: list[tuple[list[Colour], set[Colour]]] = [([], set()) for _ in range(places)]
        self.new: list[list[Colour]] = [[] for _ in range(places)]
        self.ready: deque[Element] = deque()
        self._waiting: dict[tuple[int, Colour], list[Element]] = {}

    def come(self, token: tuple[int, Colour]) -> None:
        """A colour that is not known yet can come into a place; what has waited for it may be ready."""
        place, colour = token
        self.known[place].add(colour)
        self.new[place].append(colour)
        for element in self._waiting.pop(token, ()):
            self.wait(element)

    def wait(self, element: Element) -> None:
        """Let an element be ready when all that it demands can be there."""
        for token in element.pre:
            place, colour = token
            if colour not in self.known[place]:
                self._waiting.setdefault(token, []).append(element)
                return
        self.ready.append(element)

    def rounds(
        self,
    ) -> Iterator[
        tuple[list[tuple[list[Colour], set[Colour]]], list[tuple[list[Colour], set[Colour]]]]
    ]:
        """As long as there is something new: what is new of each place, and that with what was seen before."""
        while any(self.new):
            delta = [(n, set(n)) for n in self.new]
            self.new = [[] for _ in self.known]
            whole = [
                (s[0] + n[0], s[1] | n[1]) if n[0] else s
                for s, n in zip(self.seen, delta, strict=True)
            ]
            yield delta, whole
            self.seen = whole
