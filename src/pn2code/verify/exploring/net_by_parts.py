"""A net of which not all markings are counted, since equal parts of it are exchanged (`instances`).

    known = look(net, storage, limits, options, final)    # None: nothing

All orbits are explored, so it is exact what is raised, what occurs, whether each run comes to a dead marking (`AF
dead`; where one does not, nothing is said), and whether each of these has a token in one of the places `final`.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.properties.questions import Questions
from pn2code.verify.exploring.counted import MOST_STATES, SOON
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.find_instances import instances
from pn2code.verify.exploring.invariant_questions import AskedOf
from pn2code.verify.exploring.limits import Limits, Reduction
from pn2code.verify.exploring.programs import Generated
from pn2code.verify.exploring.result import Known


def look(
    net: FlatNet,
    storage: Mapping[str, str],
    limits: Limits,
    options: ExploreOptions,
    final: Collection[int],
) -> Known | None:
    """Explores; None: nothing can be said in this way. Its arguments are those of `net_by_counts.look`."""
    questions = _questions(final)
    if net.timed or not instances(net, storage, AskedOf(questions)).families:
        return None
    own = ExploreOptions(
        sizes=options.sizes,
        generated=Generated(),
        questions=questions,
        stem="parts",
        progress=options.progress,
        interrupted=options.interrupted,
        initial=options.initial,
        quick=True,
        first_states=SOON,
    )
    most = min(limits.max_states or MOST_STATES, MOST_STATES)
    kept = (Reduction.SYMMETRY,)
    own_limits = replace(limits, max_states=most, traces=0, graph=True, reductions=kept)
    d = Diagnostics()  # what is wrong with the net all of its markings tell
    found = explore(net, storage, own_limits, d, own)
    if found is None or found.error is not None or not found.complete or not found.symmetries:
        return None
    ends, rests = (row["answer"] == "yes" for row in found.answers)
    if not rests:
        return None
    never = found.dead_transitions()
    return Known(found.nodes, found.arcs, found.seconds, ends, never, found.symmetries)


def _questions(final: Collection[int]) -> str:
    """Whether each dead marking is an end, and whether each run comes to one."""
    asked = Questions()
    dead = asked.line("dead")
    found = asked.line(f"not {dead}")
    for place in sorted(final):
        found = asked.line(f"or {found} {asked.line(f'within {place} 1 -')}")
    asked.asked.append(f"? invariant {found}")
    asked.asked.append(f"? initially {asked.line(f'af {dead}')}")
    return asked.text()
