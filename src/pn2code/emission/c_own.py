"""How code that several instances of a page share reaches the places that each instance has for its own.

const MoveBoth_places_t *const own = pn_net.transition[self].places;
const ORDER_slot_t *const at_order = pn_multiset_look(own->order, m);
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.emission.names import Scope
from pn2code.ir.nodes import Access


@frozen
class OwnPlaces:
    """Of one transition.

    Args:
        struct: stem of the C type of the table of places.
        members: by place its member in that struct.
        kept: by place the stem of the C type of what holds its tokens.
    """

    struct: str
    members: Mapping[int, str]
    kept: Mapping[int, str]

    def reserve(self, scope: Scope) -> None:
        """The variables that `reach` declares."""
        scope.reserve("own", *(f"at_{member}" for member in self.members.values()))

    def names(self, others: Sequence[str]) -> tuple[str, ...]:
        """What local variables are named after, for all places of the net."""
        return self._with(others, "{}")

    def tokens(self, others: Sequence[str]) -> tuple[str, ...]:
        """What leads to the members of what holds the tokens."""
        return self._with(others, "at_{}->")

    def holders(self, others: Sequence[str]) -> tuple[str, ...]:
        """Pointers to what holds the tokens."""
        return self._with(others, "at_{}")

    def multisets(self, others: Sequence[str]) -> tuple[str, ...]:
        """Pointers to the tables of places."""
        return self._with(others, "own->{}")

    def _with(self, others: Sequence[str], pattern: str) -> tuple[str, ...]:
        texts = list(others)
        for place, member in self.members.items():
            texts[place] = pattern.format(member)
        return tuple(texts)

    def reach(self, access: Access, is_const: bool) -> list[str]:
        """What has to stand before the lines of a program that names these places; `is_const`: it changes nothing."""
        reached = [p for p in self.members if p in access.holders]
        if not reached and not any(p in access.tables for p in self.members):
            return []
        constant, call = ("const ", "pn_multiset_look") if is_const else ("", "pn_multiset_reach")
        return [
            f"    const {self.struct}_t *const own = pn_net.transition[self].places;",
            *(
                f"    {constant}{self.kept[p]}_t *const at_{self.members[p]} = {call}(own->{self.members[p]}, m);"
                for p in reached
            ),
        ]
