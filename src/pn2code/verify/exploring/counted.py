"""A net of which tokens are counted up to a limit only: all that it is explored with.

made = counted(net, storage, table, free)           # None: there is nothing to count so
options = ExploreOptions(turns=made.turns, counts=made.counts, sizes=made.sizes)
made.ranking.rising()                               # transitions of which it is to be asked whether they go on for ever
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from types import MappingProxyType

from pn2code.base.frozen import frozen
from pn2code.net.flat import FlatNet
from pn2code.structure import bounds_and_sums
from pn2code.structure.relations import relations
from pn2code.verify.exploring.counts import LEAST_TOKENS, Counts, counts
from pn2code.verify.exploring.programs import Sizes
from pn2code.verify.exploring.ranking import Ranking
from pn2code.verify.exploring.turns import Turns

MOST_STATES = 2_000_000
"""Where there are more the limits do not help enough."""
SOON = 300_000
"""States that are seen by what was compiled quickly."""


@frozen
class Counted:
    """What is counted up to a limit, the turns as far as such numbers tell, the weights, and what places hold."""

    counts: Counts
    turns: Turns
    ranking: Ranking
    sizes: Sizes


def counted(
    net: FlatNet,
    storage: Mapping[str, str],
    table: Turns,
    free: Collection[int],
    *,
    never: Collection[int] = (),
    least: int = LEAST_TOKENS,
    demanded: Mapping[int, int] = MappingProxyType({}),
) -> Counted | None:
    """The limits of a net; None: there is nothing to count so.

    Args:
        net, storage: as for `explore`.
        table: its turns.
        free: places whose tokens need not be known exactly.
        never: transitions that never occur.
        least, demanded: as for `counts`.
    """
    known = bounds_and_sums(net, storage=storage)
    bounds = {p: b.bound for p, b in known[0].items() if b.bound is not None}
    found = counts(net, relations(net, storage), bounds, free=free, least=least, demanded=demanded)
    if found is None or not found.limited:
        return None
    sizes = _sizes(net, Sizes.start(net, storage, known), found)
    return Counted(found, found.within(table), Ranking.of(net, storage, bounds, never), sizes)


def _sizes(net: FlatNet, start: Sizes, found: Counts) -> Sizes:
    """With counters for the limits at once: what proves too small only later is compiled twice."""
    width = dict(start.packing.width)
    for x in found.limits:
        name = net.places[x.place].name
        own = start.packing.of(name)
        if own > 0:
            # A firing puts tokens there before what is more than the limit is forgotten.
            width[name] = max(own, (2 * x.most + 1).bit_length())
    # A place that follows from others does so in markings only.
    return replace(start, packing=replace(start.packing, width=width, sums=()))
