"""A look at fewer states than there are, which stand for all: what it has in common with the look at all of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.verify.exploring.counted import MOST_STATES, SOON
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits, Reduction
from pn2code.verify.exploring.programs import Generated
from pn2code.verify.exploring.result import Exploration


def explored(
    net: FlatNet,
    storage: Mapping[str, str],
    limits: Limits,
    options: ExploreOptions,
    own: ExploreOptions,
    *,
    graph: bool,
    reductions: tuple[Reduction, ...] = (),
) -> Exploration | None:
    """Explores; None after an error, of which the look at all markings tells.

    Args:
        net, storage: as for `explore`.
        limits, options: of the look at all markings.
        own: what is asked of this one, and how its states are fewer.
        graph: whether arcs are kept.
        reductions: by which its states are fewer.
    """
    own = replace(
        own,
        generated=Generated(),
        progress=options.progress,
        interrupted=options.interrupted,
        initial=options.initial,
        quick=True,
        first_states=SOON,
    )
    most = min(limits.max_states or MOST_STATES, MOST_STATES)
    own_limits = replace(limits, max_states=most, traces=0, graph=graph, reductions=reductions)
    return explore(net, storage, own_limits, Diagnostics(), own)
