"""What a search for runs adds to what is known of the properties of a cell that is too large to be seen whole."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from pn2code.diagnostics import Diagnostics
from pn2code.properties import meaning as m
from pn2code.verify.controller.control_questions import with_programs
from pn2code.verify.controller.control_types import Plan
from pn2code.verify.controller.hunts import hunt
from pn2code.verify.controller.running import Running
from pn2code.verify.exploring import nondeterminism
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import Exploration


def with_hunted_runs(
    running: Running,
    plan: Plan,
    limits: Limits,
    options: ExploreOptions,
    rows: Sequence[Mapping[str, Any]],
) -> tuple[Mapping[str, Any], ...]:
    """What is known of properties, with what a search for runs finds, where not all states can be seen."""
    properties = [with_programs(p.asked, running) for p in plan.properties.properties]
    if running.meek or len(rows) != len(properties) or nondeterminism.draws(running.net):
        return tuple(rows)
    lines = "".join(f"{x}\n" for x in running.lines(first=True))

    def explored(limits: Limits, options: ExploreOptions) -> Exploration | None:
        return explore(running.net, plan.storage, limits, Diagnostics(), options)

    own = replace(options, bindings=(), whole=())
    mine = [i for i, p in enumerate(plan.properties.properties) if not p.of_net]
    failing = [k for k, i in enumerate(mine) if _fails_in_a_marking(plan.properties.properties[i])]
    found = hunt(
        [properties[i] for i in mine],
        [rows[i] for i in mine],
        lines,
        limits,
        own,
        explored,
        failing,
    )
    all_rows = list(rows)
    for i, row in zip(mine, found, strict=True):
        all_rows[i] = row
    return tuple(all_rows)


def _fails_in_a_marking(p: m.Property) -> bool:
    """Whether a run to one marking shows that a property does not come out as expected."""
    match p.asked:
        case m.Bound():
            return p.expect
        case m.Invariant(_, wanted):
            return p.expect == wanted
        case _:
            return False
