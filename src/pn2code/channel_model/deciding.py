"""Scripts that wait for one of several messages: what they look at before they decide."""

from __future__ import annotations

from pn2code.cell.partition import Partition
from pn2code.channel_model.life_cycle import LifeCycle
from pn2code.channel_model.places import Crashes
from pn2code.channel_model.rules import Rules
from pn2code.net.flat import ArcKind
from pn2code.verify.controller.rival_transitions import hasty as hasty_ones
from pn2code.verify.controller.rival_transitions import meek


class Deciding(LifeCycle):
    """Knows when a side is calm again, and when it looks at all files before that.

    Args:
        partition, rules, crashes, loose, hasty: see `compose`.
    """

    def __init__(
        self,
        partition: Partition,
        rules: Rules,
        crashes: Crashes,
        *,
        loose: bool = False,
        hasty: bool = False,
    ) -> None:
        super().__init__(partition, rules, crashes)
        self.is_loose = loose
        self._own_places()
        is_exact = not (loose or crashes.life_cycle)
        self.meek = frozenset(meek(partition)) if is_exact else frozenset()
        self.undecided = self._undecided()
        self.fresh = self._fresh()
        self.to_decide = {o: self.memory(o, "is to decide") for o in self.fresh}
        self.hasty = {partition.transition_owner[t] for t, _ in hasty_ones(partition) if hasty}
        self.looks_on: dict[int, int] = {}

    def _fresh(self) -> dict[int, int]:
        """Where scripts begin to look that wait for one of several messages: by owner, a place.

        Such a script takes what comes first in its order of what is there. Whatever was there before its last
        transition it finds, since it looks at all files after it; what has come since it may have missed. Loosely, and
        with crashes, scripts may miss anything.
        """
        owners = {self.partition.transition_owner[t] for t in self.meek}
        found = {o: self.memory(o, "looks anew") for o in sorted(owners)}
        for o, place in found.items():
            own = (p for p in self.undecided if self.partition.place_owner[p] == o)
            if any(self.b.places[p].initial is not None for p in own):
                self.b.forget_initial(self.sides[o].calm)
                self.b.begin(place, self.b.dot)
        return found

    def _undecided(self) -> frozenset[int]:
        """The places of scripts, without their messages, where one of several messages may be waited for."""
        messages = {c.place for c in self.partition.channels}
        inputs = (ArcKind.INPUT, ArcKind.BOTH)
        return frozenset(
            a.place
            for t in self.meek
            for a in self.partition.net.transitions[t].arcs
            if a.kind in inputs and a.place not in messages
        )

    def _goes_on(self, name: str, o: int, here: int, at: int) -> None:
        """A side has done something, and is calm, or looks at all files before it decides what comes next."""
        calm = self.on(self.sides[o].calm)
        if o not in self.fresh:
            self.step(name, "", self.off(here), calm, at=at)
            return
        decides = self.to_decide[o]
        self.step(name, "", self.off(here), self.b.absent(decides), calm, at=at)
        anew = [self.off(decides), self.on(self.fresh[o])]
        self.step(f"{name} and looks anew", "", self.off(here), *anew, at=at)
