"""What else is in the cell where two things touch: where all arms stand, and which parts are where.

around = around_of(found, met, [(leg, contents), (other, its)])
around.stands["scara"]          # where that arm or device stands
around.parts                    # those that are there then, also in tools
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.geometry.answers import Around
from pn2code.geometry.contents import Contents, spot
from pn2code.geometry.legs import Leg
from pn2code.geometry.situation import Met
from pn2code.geometry.situations import Situations


def around_of(found: Situations, met: Met, legs: Iterable[tuple[Leg, Contents]]) -> Around:
    """Where something is met, as it is while these legs last: what is taken on one of them is in a tool then."""
    here = found.situations[met.situation]
    before = here.contents.parts.present
    parts = dict(before)
    for _, contents in legs:
        now = contents.parts.present
        for name in sorted({*before, *now}):
            old, new = before.get(name), now.get(name)
            if new is None:
                parts.pop(name, None)
            elif old is None or spot(old) != spot(new):
                parts[name] = new
    stands = {s.robot: s.q for s in here.stands}
    return Around(stands, tuple(parts[name] for name in sorted(parts)))
