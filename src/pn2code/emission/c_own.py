"""How code that several instances of a page share reaches the places that each instance has for its own.

    const MoveBoth_places_t *const own = pn_net.transition[self].places;
    const ORDER_slot_t *const at_order = pn_bag_look(own->order, m);
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from pn2code.emission.c_lines import mentions
from pn2code.emission.names import Scope


@dataclass(frozen=True, slots=True)
class OwnPlaces:
    """Of one transition.

    Args:
        struct: stem of the C type of the table of places.
        members: by place its member in that struct.
        kept: by place the C type of what holds its tokens.
    """

    struct: str
    members: Mapping[int, str]
    kept: Mapping[int, str]

    def texts(
        self, names: Sequence[str], tokens: Sequence[str], bags: Sequence[str], scope: Scope
    ) -> tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
        """Names, ways to the tokens, and pointers to the tables of all places, where these are reached in this way."""
        own = (list(names), list(tokens), list(bags))
        scope.reserve("own", *(f"at_{member}" for member in self.members.values()))
        for place, member in self.members.items():
            own[0][place] = member
            own[1][place] = f"at_{member}->"
            own[2][place] = f"own->{member}"
        return tuple(own[0]), tuple(own[1]), tuple(own[2])

    def reach(self, lines: Sequence[str], is_const: bool) -> list[str]:
        """What has to stand before these lines."""
        text = "\n".join(lines)
        reached = [p for p, member in self.members.items() if mentions(f"at_{member}", text)]
        if not reached and not mentions("own", text):
            return []
        constant, call = ("const ", "pn_bag_look") if is_const else ("", "pn_bag_reach")
        return [
            f"    const {self.struct}_t *const own = pn_net.transition[self].places;",
            *(
                f"    {constant}{self.kept[p]} *const at_{self.members[p]} = {call}(own->{self.members[p]}, m);"
                for p in reached
            ),
        ]
