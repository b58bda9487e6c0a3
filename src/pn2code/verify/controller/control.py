"""Whether a cell's supervisor may follow its execution scheme (docs/execution.md), looked up in the cell as it runs.

    control = examine(partition, Plan(), limits, d)
    [(c.name, c.answer) for c in control.checks]     # ("finite-response", "yes"), ...

Two spaces are gone through, both of the net that `verify.controller.running` makes of a cell. In that of the *cell*
the supervisor takes the first of its binding elements: there it is looked what the cell can come to, and there
properties are asked. In that of all *orders* it takes any: there it is looked whether the order matters. Where the
supervisor never has more than one to choose from the two are one, and it is gone through once. Which questions are
asked is in `control_questions`, what the answers mean in `control_answers`; the graphs are gone through by
cnative/src/explore/query/explore_control.c and explore_running.c. That no owner touches what is not its own is seen in
the net itself (`ownership`).
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.verify.controller import by_counts
from pn2code.verify.controller.by_turns import Looked, OutOfReachError
from pn2code.verify.controller.control_answers import (
    ORDERS,
    STILL,
    Keeper,
    cell_answers,
    drawn,
    hesitating,
    is_short,
    order_answers,
    refusal,
    seen_in_turns,
    settled,
    silent,
)
from pn2code.verify.controller.control_in_turns import (
    has_runs,
    has_suspects,
    is_open,
    looked_in_turns,
    may_go_in_turns,
    told_in_turns,
    with_part,
)
from pn2code.verify.controller.control_messages import formats, memory
from pn2code.verify.controller.control_questions import asked_of_orders, of_cell, of_orders
from pn2code.verify.controller.control_swarm import swarmed
from pn2code.verify.controller.control_types import (
    BLOCKING,
    MOST_WRITTEN,
    CellProgram,
    Control,
    Plan,
    WrittenGraph,
)
from pn2code.verify.controller.crowd import Crowd, crowd
from pn2code.verify.controller.cut_answers import is_full, parted, too_late, with_reason
from pn2code.verify.controller.equals import NoPatternError
from pn2code.verify.controller.fewer_orders import may_reduce, part_of_orders, with_fewer_orders
from pn2code.verify.controller.hunted_properties import with_hunted_runs
from pn2code.verify.controller.not_looked import not_looked
from pn2code.verify.controller.not_modelled import NotModelledError
from pn2code.verify.controller.ownership import ownership
from pn2code.verify.controller.poses import Bad
from pn2code.verify.controller.reach_check import reach, suspects, told_poses
from pn2code.verify.controller.running import Running
from pn2code.verify.exploring import nondeterminism
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import REACHED, Limits, Reduction
from pn2code.verify.exploring.programs import Generated, Sizes
from pn2code.verify.exploring.result import Exploration

DOUBT = (
    "a condition of a script that waits for a message raises an exception in a state of the cell, and whether the "
    "script comes to it is not known"
)

FEW = 60_000
"""States before tokens are counted up to a limit where they are in the closed net."""
CELL_PART = 0.8
"""Of the time, what the exploration may take that most answers come from."""
HUNT_PART = 0.8
"""Of what is left then, what the search for runs may take; the rest is for what makes the states so many (`crowd`)."""


def examine(
    partition: Partition,
    plan: Plan,
    limits: Limits,
    d: Diagnostics,
    closed: Exploration | None = None,
) -> Control | None:
    """Explores the cell as it runs and answers all checks; None after an error that was reported.

    Args:
        partition: the cell.
        plan: how.
        limits: of each exploration.
        d: gets the errors.
        closed: the state space of the closed net, if it is known.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    poses = plan.poses(partition)
    try:
        running = Running.of(partition, plan.properties.predicates)
    except NotModelledError as problem:
        why = f"the cell as it runs cannot be modelled: {problem}"
        nothing = not_looked(why, partition, plan.capacities, closed, poses, plan.bounds)
        return replace(nothing, why=why)
    if limits.swarm is not None:
        return swarmed(partition, running, plan, limits, d, closed)
    limits = replace(
        limits,
        approximation=None,
        graph=True,
        reductions=(Reduction.TIME,) if partition.net.timed else (),
    )
    made = Generated()
    program = CellProgram(running, plan.properties.predicates, made)
    # To look for a choice in a state that draws random numbers would draw others.
    is_asked_at_once = not nondeterminism.draws(running.net)
    at_once = f"orders\n{asked_of_orders(plan.firings)}" if is_asked_at_once else ""
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        options = replace(
            plan.options,
            sizes=Sizes.start(running.net, plan.storage),
            generated=made,
            traces=Path(name),
            bindings=tuple(t.index for t in poses.moving) if poses else (),
            whole=(*(c.place for c in partition.channels), *(poses.places if poses else ())),
            graph=None,
            questions=of_cell(running, plan) + at_once,
            predicates=plan.properties.predicates,
            evidence=plan.evidence or Path(name),
            stem="cell",
        )
        # Where the whole is too large, there is time left to see how it comes to what is wrong.
        part = replace(limits, deadline=limits.deadline.share(CELL_PART))
        in_turns: Looked | None = None
        turned: tuple[Mapping[str, Any], ...] = ()
        in_counts: by_counts.Seen | None = None
        may_turn = may_go_in_turns(partition, plan, part)
        first_part = replace(part, max_states=part.turns_from) if may_turn else part
        may_count = _may_count(partition, plan, part)
        counts_part = first_part
        if may_count:
            # A cell whose closed net is so large is hardly small enough for all of its states.
            is_large = closed is not None and closed.known is not None
            few = min(part.counts_from or FEW, FEW) if is_large else part.counts_from
            counts_part = replace(part, max_states=few)
        # To compile better what sees so little takes longer than it saves.
        soon = replace(options, first_states=counts_part.max_states) if may_count else options

        def explore_all(limits: Limits, options: ExploreOptions) -> Exploration | None:
            own = replace(
                options, graph=plan.graph, graph_limit=None if plan.graph is None else MOST_WRITTEN
            )
            return explore(running.net, plan.storage, limits, d, own)

        found = explore_all(counts_part, soon)
        if may_count and found is not None and found.why == "states":
            own = replace(soon, questions=of_orders(running, plan.firings), stem="orders")
            orders_part = part_of_orders(running, plan, counts_part, own, d)
            if orders_part is None:
                return None
            in_counts = by_counts.look(
                partition,
                plan,
                part,
                options,
                part=found,
                order=orders_part.answers,
                in_order=at_once,
            )
            if in_counts is not None and has_suspects(poses, in_counts.looked.found, limits):
                in_counts = None
            if in_counts is not None and in_counts.has_open:
                rows = with_hunted_runs(running, plan, part, soon, in_counts.answers)
                in_counts = replace(in_counts, answers=rows)
            if in_counts is None or in_counts.has_open:
                found = explore_all(first_part if in_counts is None else part, options)
                if in_counts is not None and found is not None:
                    in_counts = in_counts.with_more(found)
        if in_counts is None and may_turn and found is not None and found.why == "states":
            try:
                in_turns = looked_in_turns(partition, plan, part, options, at_once, poses)
                if in_turns is not None:
                    turned = told_in_turns(running, plan, part, options, found, in_turns)
                if in_turns is None or is_open(plan, turned):
                    found = explore_all(part, options)
                    if found is not None and in_turns is not None:
                        turned = with_part(turned, found)
                        in_turns = in_turns if turned else None
                if in_turns is not None and in_turns.running.meek and has_runs(turned):
                    in_turns = None  # whether scripts can do so is looked for in the whole net
                    found = explore_all(part, options)
            except OutOfReachError as problem:  # what was seen of the whole is what is known
                plan = replace(plan, cut=str(problem))
        if found is None:
            return None
        of_orders_run = running
        if plan.graph is not None and found.complete and plan.graph.exists():
            program = replace(program, graph=WrittenGraph(plan.graph, found.nodes, found.arcs))
        if in_turns is not None:
            found, running = in_turns.found, in_turns.running
            of_orders_run = running
        if in_counts is not None:
            found, running = in_counts.looked.found, in_counts.looked.running
        if plan.cut and found.why == "states":
            found = replace(
                found, why=plan.cut, answers=tuple(with_reason(a, plan.cut) for a in found.answers)
            )
        # Fewer states than are permitted were to show whether all are needed; then the time was over.
        is_late = part.deadline.is_over() and not is_full(found, limits)
        if is_late and found.why == "states":
            found = replace(found, why="seconds", answers=too_late(found.answers))
        count = len(plan.properties.properties)
        answers = found.answers[:count] if in_counts is None else in_counts.answers
        if in_turns is not None:
            answers = turned
        if is_late:
            answers = too_late(answers)
        if in_counts is None and found.why in REACHED:
            # What was seen may be too much to tell how it comes to what is wrong; a run to it need not be.
            hunted = replace(limits, deadline=limits.deadline.share(HUNT_PART))
            open_row = {"answer": "unknown", "why": found.why, "trace": None}
            known: Sequence[Mapping[str, Any]] = answers or [open_row] * count
            answers = with_hunted_runs(running, plan, hunted, options, known)
        options = replace(options, evidence=Path(name))

        def explore_with_moves(moves: Sequence[Bad], *, first: bool = True) -> Exploration | None:
            other = Running.of(partition, (), moves)
            lines = other.lines(first=True)
            own = replace(
                options,
                sizes=made.sizes or options.sizes,  # its places are those of the cell
                generated=Generated(),
                questions="".join(f"{x}\n" for x in lines)
                if first
                else of_orders(other, plan.firings),
                predicates=(),
                stem="reach" if first else "orders",
                quick=True,
            )
            return explore(other.net, plan.storage, limits, d, own)

        told = told_poses(poses, found, limits.deadline)
        orders: Exploration | None = found
        # In turns the answers about properties are apart (`Looked.told`).
        others = found.answers if in_turns is not None else found.answers[count:]
        said, asked = parted(others, ORDERS if is_asked_at_once else 0)
        # Of a whole graph in which the supervisor never chooses the first question has an answer, and only of that.
        is_choiceless = found.complete and bool(asked) and asked[0]["answer"] != "unknown"
        ruled_out = False
        other: tuple[Exploration, Sequence[Mapping[str, Any]], Running] | None = None
        if in_counts is not None:
            said, asked = in_counts.said, in_counts.asked
            is_choiceless = False
        elif in_turns is not None:
            orders = in_turns.orders or found
            asked = orders.answers[:ORDERS] if orders is not found else asked
        elif found.complete or found.why == "decided":
            moves = suspects(told, found)
            if moves:
                # All orders are more than the cell does: what is not met there is met nowhere.
                with suppress(NoPatternError):
                    orders = explore_with_moves(moves, first=False)
                    ruled_out = orders is not None and orders.seen.markings
            if is_choiceless:
                orders = found
            elif not ruled_out:
                own = replace(options, questions=of_orders(running, plan.firings), stem="orders")
                first = limits.counts_from if not moves and may_reduce(partition, limits) else None
                some = limits if first is None else replace(limits, max_states=first)
                orders = explore(running.net, plan.storage, some, d, own)
                if first is not None and orders is not None and orders.why == "states":
                    other = with_fewer_orders(
                        partition, plan, part, options, found, orders, at_once
                    )
                    if other is not None:
                        orders, asked, of_orders_run = other
                    elif limits.max_states != first:
                        orders = explore(running.net, plan.storage, limits, d, own)
        if orders is None:
            return None
        if is_late:
            said, asked = too_late(said), too_late(asked)
        keep = Keeper(plan, running)
        if not is_choiceless and in_turns is None and in_counts is None and other is None:
            asked = orders.answers if orders is not found else ()
        doubt = ""
        if running.unsure is not None and said:
            said, last = said[:-1], said[-1]
            doubt = DOUBT if last["answer"] == "no" else ""
        checks = (
            *order_answers(partition, orders, asked, plan, Keeper(plan, of_orders_run)),
            *cell_answers(partition, found, said, plan, keep, closed),
            *formats(partition, found, plan, d),
            memory(found),
            *reach(told, partition, found, explore_with_moves, keep, ruled_out=ruled_out),
            ownership(partition),
        )
        checks = tuple(hesitating(c, said, keep) for c in checks)
        if in_turns is not None or in_counts is not None:
            checks = tuple(map(seen_in_turns, checks))
        refused = refusal(partition, found, keep)
        if refused is not None:
            checks = tuple(refused if c.name == BLOCKING else c for c in checks)
        why = nondeterminism.undetermined(partition.net)
        if why:
            checks = tuple(drawn(c, why) for c in checks)
        late = plan.premises.replies.late or silent(running, said)
        premises = plan.premises
        premises = replace(premises, moving=not is_short(said, STILL))
        control = Control(
            partition,
            checks,
            found,
            running,
            answers=answers,
            closed=closed,
            reduced=in_turns is not None or in_counts is not None,
            quiet=in_counts is not None and in_counts.is_quiet,
            reduced_orders=other is not None,
            counted_orders=other is not None and other[0].is_counted,
            program=program,
            crowd=_crowd(program.running, plan, limits, options, found),
        )
        return settled(replace(control, late=late, doubt=doubt, premises=premises))


def _crowd(
    running: Running, plan: Plan, limits: Limits, options: ExploreOptions, found: Exploration
) -> Crowd | None:
    """What makes the states so many, where that is why not all were seen."""
    if found.complete or found.why not in REACHED:
        return None
    return crowd(running, plan.storage, limits, options)


def _may_count(partition: Partition, plan: Plan, limits: Limits) -> bool:
    """Whether tokens are counted up to a limit only before more is looked at."""
    first, most = limits.counts_from, limits.max_states
    if first is None or limits.turns_from is None or first > limits.turns_from:
        return False
    is_enough = most is None or most >= first
    return is_enough and not partition.net.timed
