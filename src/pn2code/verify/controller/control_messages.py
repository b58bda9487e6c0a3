"""Whether what the programs of a cell say and keep has room: messages in their files, lists and strings in memory."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.emission import arena_size
from pn2code.verify.controller import arena, messages
from pn2code.verify.controller.control_answers import STRUCTURE, unknown
from pn2code.verify.controller.control_types import (
    MEMORY,
    MESSAGES,
    MOST_IN_TURNS,
    MOST_STATES,
    Check,
    Evidence,
    Plan,
)
from pn2code.verify.controller.running import chunks
from pn2code.verify.exploring.result import Exploration
from pn2code.verify.exploring.token_run import token_run


def formats(
    partition: Partition, found: Exploration | None, plan: Plan, d: Diagnostics, why: str = ""
) -> list[Check]:
    """Whether every message can be sent; nothing of a cell without channels. `why` there is no space to look in."""
    if not partition.channels:
        return []
    sent = messages.examine(partition, found, d)
    if sent.answer == "unknown":
        return [unknown(MESSAGES, {"why": why if found is None else found.why})]
    if not sent.wrong:
        return [
            Check(
                MESSAGES, sent.answer, sent.says, sent.count, STRUCTURE if not sent.count else None
            )
        ]
    tokens = [(x.channel.place, x.value) for x in sent.wrong]
    asked = "".join(f"{line}\n" for line in own_priorities(partition))
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        to = (plan.folder or Path(name)) / f"{plan.stem}.controller-{MESSAGES}.trace.jsonl"
        run = token_run(partition.net, plan.storage, asked, tokens, to, d)
    # After the message that comes first the cell would have stopped.
    first = sent.wrong[run.token if run is not None else 0]
    evidence: tuple[Evidence, ...] = ()
    if run is not None:
        kept = None if plan.folder is None else run.file
        evidence = (Evidence(run.steps, None, run.node, run.transitions, kept),)
    place = partition.net.places[first.channel.place]
    return [Check(MESSAGES, "no", first.says, sent.count, evidence=evidence, place=place.name)]


def own_priorities(partition: Partition) -> Iterator[str]:
    """For the explorer of the closed net: priorities count among the transitions of one owner."""
    for owner in partition.owners:
        own = [i for i, o in enumerate(partition.transition_owner) if o == owner.index]
        yield from chunks(f"owner {owner.index}", own)
    yield "priorities own"


def _most(found: Exploration) -> int:
    """States at which `generate` looks."""
    return MOST_IN_TURNS if "turns" in found.reductions else MOST_STATES


def memory(found: Exploration | None, why: str = "", *, of_cell: bool = True) -> Check:
    """Whether the supervisor's lists and strings have room.

    Its arena is made as large as the state space says, if `generate` sees that, and has the usual size otherwise.

    Args:
        found: the state space.
        why: why there is none.
        of_cell: it is that of the cell as it runs, at which `generate` looks; else of the closed net.
    """
    size, least = arena.size(found), arena.need(found)
    if found is None or size is None or least is None or found.arena is None:
        return unknown(MEMORY, {"why": why if found is None else found.why})
    firing, marking = found.arena["firing"], found.arena["marking"]
    held = f"lists and strings take at most {marking:,} bytes in a marking"
    if marking == 0:
        held = "no marking has lists or strings that need any"
    needs = f"{held}, and what is worked out on the way {firing:,} in one firing"
    if size > arena.MOST:
        return Check(MEMORY, "no", f"{needs}, which is too much", firing)
    says = f"{needs}; the supervisor has room for more than twice that"
    if size > arena_size.DEFAULT and not (of_cell and found.nodes <= _most(found)):
        says = f"{needs}; the supervisor needs {least:,} bytes for both, and has the usual {arena_size.DEFAULT:,}"
        blind = "the cell cannot be modelled"
        if of_cell:
            blind = f"there are more than the {MOST_STATES:,} states at which it looks"
        says += f", because `generate` does not know that ({blind})"
        return Check(MEMORY, "no" if least > arena_size.DEFAULT else "yes", says, firing)
    if firing == marking == 0:
        says = "no list or string needs memory while the supervisor runs"
    return Check(MEMORY, "yes", says, firing)
