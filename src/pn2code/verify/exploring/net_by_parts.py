"""A net of which not all markings are counted, since equal parts of it are exchanged (`instances`).

    known = look(net, storage, limits, options, final)    # None: nothing

All orbits are explored, so it is exact what is raised, what occurs, whether each run comes to a dead marking (`AF
dead`; where one does not, nothing is said), and whether each of these has a token in one of the places `final`.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping

from pn2code.net.flat import FlatNet
from pn2code.properties.questions import Questions
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.find_instances import instances
from pn2code.verify.exploring.invariant_questions import AskedOf
from pn2code.verify.exploring.limits import Limits, Reduction
from pn2code.verify.exploring.result import Known
from pn2code.verify.exploring.smaller_look import explored


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
    own = ExploreOptions(sizes=options.sizes, questions=questions, stem="parts")
    kept = (Reduction.SYMMETRY,)
    found = explored(net, storage, limits, options, own, graph=True, reductions=kept)
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
