"""A cell with its medium where that is large: its sides are looked at in turns (`verify.exploring.turns`).

    in_turns(partition, rules, storage, limits, options, d)    # None: the whole space has to decide

What is looked at can do more than the net with its medium, in three ways:

* priorities count among the transitions of one side: what a side does in its memory need not come at once;
* a side that looks at one file after the other may pass over one that holds a message, as if that came a little later;
* nothing ends with a verdict: a token in the place of faults stays there, and the others go on.

So a run of the net with its medium, up to a fault, is one of this net. If in this net no fault can be reached, no run
goes on for ever, and in each dead state the supervisor has finished, then the same is so in the net with its medium:
each of its states leads to a dead one (but for the transition that says that an end has been reached), and that is dead
here, too. As turns keep dead states and what each place holds if there is no cycle, the reduced space tells.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pn2code.cell.partition import Partition
from pn2code.channel_model.compose import compose
from pn2code.channel_model.places import ChannelModel, Crashes
from pn2code.channel_model.rules import Rules
from pn2code.diagnostics import Diagnostics
from pn2code.lowering.nets.packing import choose
from pn2code.properties.questions import ENDLESS
from pn2code.verify.controller.rival_transitions import hasty
from pn2code.verify.controller.running import chunks
from pn2code.verify.exploring.elements import NotPossibleError
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.programs import Generated, Sizes
from pn2code.verify.exploring.result import Exploration
from pn2code.verify.exploring.turns import turns


def in_turns(
    partition: Partition,
    rules: Rules,
    storage: Mapping[str, str],
    limits: Limits,
    options: ExploreOptions,
    d: Diagnostics,
) -> tuple[ChannelModel, Exploration] | None:
    """The net and its reduced space, if that says that nothing is wrong; None: it does not."""
    if partition.net.timed or not partition.final_places:
        return None
    made = compose(partition, rules, Crashes(life_cycle=False), loose=True)
    owners = owners_of(made)
    if owners is None:
        return None
    own = partition.transition_owner
    try:
        table = turns(
            made.net,
            owners,
            firsts=[i for i, o in enumerate(own) if o == 0],
            chosen=[i for i, o in enumerate(own) if o],
        )
    except NotPossibleError:
        return None
    options = replace(
        options,
        turns=table,
        questions=questions(made, owners),
        sizes=Sizes(choose(made.net, [[] for _ in made.net.places], {})),
        generated=Generated(),
        heaps=frozenset({made.fault}),  # a fault may come again and again
        quick=False,
    )
    found = explore(made.net, storage, limits, d, options)
    if found is None or not found.complete or not found.seen.arcs or found.error is not None:
        return None
    is_good = len(found.answers) == ASKED and all(a["answer"] == "yes" for a in found.answers)
    return (made, found) if is_good else None


def owners_of(made: ChannelModel) -> list[int] | None:
    """By transition of the net, the side in whose memory it does something; None: of some that is not one side."""
    whose = {place: o for o, places in enumerate(made.memory) for place in places}
    found = list(made.partition.transition_owner)
    for t in made.net.transitions[len(found) :]:
        sides = {whose[a.place] for a in t.arcs if a.place in whose}
        if len(sides) != 1:
            return None
        found += sides
    return found


ASKED = 3


def questions(made: ChannelModel, owners: list[int]) -> str:
    """The lines for the explorer: who chooses how, and `ASKED` questions."""
    lines: list[str] = []
    everything = range(len(owners))
    for owner in range(len(made.partition.owners)):
        lines += chunks(f"owner {owner}", (t for t in everything if owners[t] == owner))
        own = (i for i, o in enumerate(made.partition.transition_owner) if o == owner)
        lines += chunks(f"{'choose' if owner else 'first'} {owner + 1}", own)
    lines += chunks("meek", (t for t, is_shared in hasty(made.partition) if is_shared))
    lines.append("priorities own")
    lines += chunks("instant 0", everything)
    items = [f"within {made.sides[0].calm} 1 -"]  # operands are numbers of lines
    end = None
    for place in made.partition.final_places:
        items += [f"within {place} 1 -", f"and 0 {len(items)}"]
        if end is not None:
            items.append(f"or {end} {len(items) - 1}")
        end = len(items) - 1
    items += [f"ef {end}", f"ag {len(items)}"]
    asked = [
        f"? bound {made.fault} 0 0",
        f"? restless 0 {ENDLESS}",
        f"? initially {len(items) - 1}",
    ]
    return "".join(f"{line}\n" for line in (*lines, *items, *asked))
