"""What can be observed of a net: how many markings and occurrences, which are dead, the most tokens in each place."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pn2code
from pn2code.api.marking import Marking


@dataclass(frozen=True)
class Observed:
    """The behaviour of a net up to names; `is_whole` when all markings were seen."""

    nodes: int
    arcs: int
    dead: int
    is_whole: bool
    layers: tuple[tuple[int, int], ...]
    """markings and occurrences at each distance from the initial marking"""


def observed(path: Path, limit: int) -> Observed | str:
    """The observation, or what is wrong with the net. `limit`: the most markings."""
    try:
        net = pn2code.load(path)
        return _explore(_here(net.initial_marking(), net.is_timed), limit, is_timed=net.is_timed)
    except Exception as error:  # whatever it is, the rewritten net must say the same
        return f"{type(error).__name__}"


def _here(marking: Marking, is_timed: bool) -> Marking:
    return marking.advanced() if is_timed else marking


def _explore(first: Marking, limit: int, *, is_timed: bool) -> Observed:
    seen, layer = {first}, [first]
    dead = arcs = 0
    layers = []
    while layer and len(seen) < limit:
        after: list[Marking] = []
        fired = 0
        for one in layer:
            bindings = one.enabled()
            fired += len(bindings)
            dead += not bindings
            for binding in bindings:
                successor = _here(one.fire(binding), is_timed)
                if successor not in seen:
                    seen.add(successor)
                    after.append(successor)
        layers.append((len(layer), fired))
        arcs += fired
        layer = after
    return Observed(len(seen), arcs, dead, not layer, tuple(layers))
