"""A state of the net as overlays of its pages: tokens in places, borders around enabled transitions."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from pn2code.drawing.svg import Overlay, Tokens
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.reading.document import RawPage
from pn2code.semantics.game import report
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game


class State:
    """A marking of a net, page by page.

    Args:
        net: the net.
        marking: its marking.
        enabled: the transitions to be shown as enabled; see `enabled_in`.
        highlight: colours of elements, by id, on an instance of their page: (id, number of the instance).
    """

    def __init__(
        self,
        net: FlatNet,
        marking: Marking,
        enabled: Collection[FlatTransition],
        highlight: Mapping[tuple[str, int], str] | None = None,
    ) -> None:
        self._highlight = highlight or {}
        self._tokens: dict[str, dict[int, Tokens]] = {}
        self._enabled: dict[str, set[int]] = {}
        # `places` has a row for each place instance, in this order, and then some for fusion sets.
        for place, row in zip(net.place_instances, report.places(net, marking), strict=False):
            held = Tokens(len(marking.places[place.place]), str(row["marking"]))
            self._tokens.setdefault(place.id, {})[place.number] = held
        for t in enabled:
            self._enabled.setdefault(t.id, set()).add(t.instance_number)
        self._numbers: dict[str, set[int]] = {i: set(by) for i, by in self._tokens.items()}
        for transition in net.transitions:
            self._numbers.setdefault(transition.id, set()).add(transition.instance_number)

    def instances(self, page: RawPage) -> list[int]:
        """The numbers of a page's instances; none for a page without places and transitions."""
        found: set[int] = set()
        for node in page.nodes:
            found |= self._numbers.get(node.id, set())
        return sorted(found)

    def overlay(self, page: RawPage, instance: int, base: Overlay) -> Overlay:
        """What is drawn over an instance of a page; problems and highlights are those of `base`."""
        tokens = {
            p.id: self._tokens[p.id][instance]
            for p in page.places
            if instance in self._tokens.get(p.id, {})
        }
        enabled = frozenset(
            t.id for t in page.transitions if instance in self._enabled.get(t.id, ())
        )
        own = {i: ink for (i, number), ink in self._highlight.items() if number == instance}
        return Overlay(tokens, enabled, {**base.highlight, **own}, base.problems)

    def shown_first(self, page: RawPage) -> int:
        """The instance of a page on which something is highlighted, else the first."""
        numbers = self.instances(page)
        nodes = {node.id for node in page.nodes}
        marked = {number for i, number in self._highlight if i in nodes}
        return next((n for n in numbers if n in marked), numbers[0] if numbers else 1)

    def figures(self, page: RawPage, base: Overlay) -> list[tuple[str, Overlay]]:
        """The different looks of a page's instances, each with a caption when there are several."""
        looks: list[tuple[list[int], Overlay]] = []
        for number in self.instances(page):
            overlay = self.overlay(page, number, base)
            for numbers, known in looks:
                if known == overlay:
                    numbers.append(number)
                    break
            else:
                looks.append(([number], overlay))
        if len(looks) < 2:
            return [("", looks[0][1] if looks else base)]
        return [(_caption(numbers), overlay) for numbers, overlay in looks]


def enabled_in(game: Game, marking: Marking) -> list[FlatTransition]:
    """The transitions that are enabled in a marking, priorities respected; one binding of each is enough."""
    found: list[FlatTransition] = []
    for t in sorted(game.net.transitions, key=lambda t: t.priority):
        if found and t.priority > found[0].priority:
            break
        if next(iter(game.enabling.enabled(t, marking)), None) is not None:
            found.append(t)
    return found


def _caption(numbers: list[int]) -> str:
    listed = ", ".join(map(str, numbers))
    return f"instance {listed}" if len(numbers) == 1 else f"instances {listed}"
