"""Markings and bindings as Python values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from pn2code.api.drawing import Drawing
from pn2code.api.errors import playing
from pn2code.base.frozen import frozen
from pn2code.semantics.game import report
from pn2code.semantics.game.marking import (
    BindingElement,
    binding_to_json,
    element_text,
    place_text,
    place_to_json,
)
from pn2code.semantics.game.marking import Marking as State
from pn2code.semantics.game.token_game import NotEnabled
from pn2code.semantics.values.colours import TEXTS

if TYPE_CHECKING:
    from pn2code.api.net import Net


@frozen
class Token:
    """Equal tokens of a place.

    Args:
        count: how many, at least 1.
        value: as in traces (docs/trace.md): numbers, texts, `None` for `()`, lists, dictionaries for records, names of
            enumerations, `[constructor, value]` for unions.
        time: their time stamp; None in a place that is not timed.
    """

    count: int
    value: Any
    time: int | float | None = None


@frozen
class Binding:
    """A transition with values of its variables.

    Args:
        transition: its path, such as "Top.Robot1.Accept".
        values: by variable, as in `Token`. The outputs of a code segment are not there before it has occurred.
    """

    transition: str
    values: Mapping[str, Any]
    _element: BindingElement
    _text: str

    def __str__(self) -> str:
        """As in messages: `Top.Send (n=1, p="COL")`."""
        return self._text


class Marking:
    """A state of a net: the model time, and what each place holds. It never changes; `fire` gives another one.

    Attributes:
        net: the net.
        time: the model time.
    """

    def __init__(self, net: Net, state: State) -> None:
        self.net = net
        self.time = state.time
        self._state = state

    # --- what places hold ------------------------------------------------------------------------

    def __getitem__(self, place: str) -> tuple[Token, ...]:
        """The tokens of a place, sorted by value and time.

        Args:
            place: its path (`net.places`), the end of it, or `Page'Place` as in CPN Tools.

        Raises:
            KeyError: the net has no such place, or several.
        """
        index = self.net.place_index(place)
        colset = self.net.flat.places[index].colset
        rows = place_to_json(TEXTS, colset, self._state.places[index])
        return tuple(Token(*row) for row in rows)

    def __iter__(self) -> Iterator[str]:
        """The paths of all places."""
        return iter(self.net.places)

    def __len__(self) -> int:
        """How many places there are."""
        return len(self.net.places)

    @property
    def total(self) -> int:
        """How many tokens there are in all places."""
        return sum(len(tokens) for tokens in self._state.places)

    def text(self, place: str) -> str:
        """What a place holds, as CPN Tools writes it: ``1`3++ 2`5``.

        Raises:
            KeyError: as for `marking[place]`.
        """
        index = self.net.place_index(place)
        return place_text(TEXTS, self.net.flat.places[index].colset, self._state.places[index])

    def __str__(self) -> str:
        """All places that hold something, page by page."""
        return report.marking_text(self.net.flat, self._state)

    def __eq__(self, other: object) -> bool:
        """The same time, tokens, and contents of references."""
        return isinstance(other, Marking) and self._state == other._state

    def __hash__(self) -> int:
        """Of all of it."""
        return hash(self._state)

    # --- what can occur --------------------------------------------------------------------------

    def enabled(self) -> tuple[Binding, ...]:
        """What can occur now, in the documented order; the time does not advance for it (see `advanced`).

        Raises:
            NetError: a guard or an inscription raises an exception.
        """
        game = self.net.game
        with playing():
            found = game.enabled_in(self._state)
        return tuple(self._binding(element) for element in found)

    def advanced(self) -> Marking:
        """This marking at the first time, now or later, at which something is enabled; itself where nothing ever is.

        Raises:
            NetError: a guard or an inscription raises an exception.
        """
        with playing():
            return Marking(self.net, self.net.game.advance_time(self._state))

    def fire(self, binding: Binding) -> Marking:
        """The marking after an occurrence.

        Args:
            binding: one of `enabled()`, of this marking or an equal one.

        Raises:
            ValueError: it is not enabled here; the message says why.
            NetError: the code segment or an inscription raises an exception.
        """
        game = self.net.game
        with playing():
            why = game.why_disabled(self._state, binding._element)
            if why is not None:
                raise NotEnabled(f"{binding}: {why}")
            after, _ = game.occur(self._state, binding._element)
        return Marking(self.net, after)

    def _binding(self, element: BindingElement) -> Binding:
        net = self.net.flat
        return Binding(
            net.transitions[element.transition].name,
            binding_to_json(element),
            element,
            element_text(TEXTS, net, element),
        )

    # --- pictures --------------------------------------------------------------------------------

    def draw(self, page: str | None = None) -> Drawing:
        """The pages with their tokens; enabled transitions are green.

        Raises:
            KeyError: the net has no such page.
        """
        return self.net.draw(page, marking=self)

    def _repr_svg_(self) -> str:
        return self.draw().svg
