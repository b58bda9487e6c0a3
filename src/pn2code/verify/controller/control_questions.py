"""What the explorer is asked about the cell as it runs, and about all orders of the supervisor's firings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pn2code.properties import meaning as m
from pn2code.properties.questions import Questions
from pn2code.verify.controller.by_turns import validity
from pn2code.verify.controller.control_types import MAX_FIRINGS, Plan
from pn2code.verify.controller.kept_silence import kept_silence
from pn2code.verify.controller.running import Running
from pn2code.verify.controller.stated import Stated


def of_cell(
    running: Running,
    plan: Plan,
    *,
    in_turns: bool = False,
    conditions: Sequence[Stated] = (),
    by_markings: bool = False,
) -> str:
    """The lines for the explorer about the cell: first properties, then what `cell_answers` understands.

    Args:
        running: its net.
        plan: what is asked.
        in_turns: in a space that is seen in turns (`by_turns`).
        conditions: what is asked there of states instead of the properties.
        by_markings: there will be no graph: of the end it is asked whether a dead marking is one, and then, in the last
            line, whether it can still be reached.
    """
    asked = Questions()
    resting = None if in_turns else running.resting
    for x in conditions:
        x.ask(asked)
    for p in () if in_turns else plan.properties.properties:
        asked.ask(with_programs(p.asked, running))
    over = None
    if running.partition.final_places:
        over = asked.line(f"within {running.over} 1 -")
    asked.asked += [
        _no_dead_end(asked, over) if by_markings else _ends(asked, over),
        f"? bound {running.stopped} 0 0",
        *(f"? restless {i} {steps.most}" for i, steps in enumerate(running.moments.sets())),
        *(f"? invariant {kept_silence(asked, s, resting)}" for s in running.silences),
        *(f"? bound {c.place} 0 1" for c in running.partition.channels),
        *(f"? bound {place} 0 {most}" for place, most in plan.capacities.items()),
        *([] if running.unsure is None else [f"? bound {running.unsure} 0 0"]),
        *([_ends(asked, over)] if by_markings else ()),
    ]
    lines = running.lines(first=True, at_once=in_turns)
    return "".join(f"{line}\n" for line in lines) + asked.text()


def _ends(asked: Questions, over: int | None) -> str:
    """Whether the end can be reached from everywhere; without one, whether the cell goes on."""
    return f"? ends {'-' if over is None else asked.line(f'ef {over}')}"


def _no_dead_end(asked: Questions, over: int | None) -> str:
    """Whether something can happen in each marking that is no end."""
    goes_on = asked.line(f"not {asked.line('dead')}")
    return f"? invariant {goes_on if over is None else asked.line(f'or {goes_on} {over}')}"


def with_programs(asked: m.Asked, running: Running) -> m.Asked:
    """Who assumes that a transition is treated fairly assumes as well that the programs run.

    A transition is enabled in the cell only when its program has come to it: if no step of the program ever had to be
    taken, nothing of a path on which the program stands still would be unfair. Steps of the clock, and those that stop
    the cell, are left out: whoever assumes less proves less.
    """
    if not isinstance(asked, m.Linear) or not asked.fair:
        return asked
    return replace(
        asked, fair=(*asked.fair, *(m.Fairness(False, i) for i in running.steps_that_come()))
    )


def of_orders(running: Running, firings: int = MAX_FIRINGS, *, in_turns: bool = False) -> str:
    """The lines for the explorer about all orders, which `order_answers` understands."""
    lines = running.lines(first=False, at_once=in_turns)
    more = "".join(f"{line}\n" for line in validity(running)) if in_turns else ""
    return "".join(f"{line}\n" for line in lines) + asked_of_orders(firings) + more


def asked_of_orders(firings: int) -> str:
    """`ORDERS` questions."""
    asked = ["finite-response", f"bounded-response {firings}", "confluence 0", "confluence 1"]
    return "".join(f"? {question}\n" for question in asked)
