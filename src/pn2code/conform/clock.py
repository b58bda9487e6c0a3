"""Time in a comparison: states that differ only in how late it is are one, where nothing in the net looks at the time
itself.

clock = Clock(net)
clock.relative(marking)          # the same, its stamps counted from its time on; at time 0
clock.tokens(tokens, now=17)     # the same of one place

A net that runs in a circle has infinitely many markings otherwise (`verify/exploring/time_reduction.py` says when
this is possible, and why). Where it is not, or in an untimed net, markings stay as they are.
"""

from __future__ import annotations

from dataclasses import replace

from pn2code.net.flat import FlatNet
from pn2code.semantics.game.marking import Marking, PlaceMarking
from pn2code.semantics.values.data import Timed
from pn2code.semantics.values.multiset import TimedMultiSet
from pn2code.verify.exploring.time_reduction import why_not_reducible


class Clock:
    """How much of the time counts in a net. `is_relative`: only how long it is until something."""

    def __init__(self, net: FlatNet) -> None:
        self.is_relative = net.timed and why_not_reducible(net) is None

    def relative(self, marking: Marking) -> Marking:
        """The marking at time 0; as it is where the time counts."""
        if not self.is_relative:
            return marking
        places = tuple(self.tokens(tokens, marking.time) for tokens in marking.places)
        return replace(marking, time=0, places=places)

    def tokens(self, tokens: PlaceMarking, now: float) -> PlaceMarking:
        """What a place holds, with stamps from `now` on; those that are not after it are 0."""
        if not self.is_relative or not isinstance(tokens, TimedMultiSet):
            return tokens
        return TimedMultiSet.of(Timed(t.value, max(t.stamp - now, 0)) for t in tokens)
