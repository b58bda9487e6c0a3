"""Whether a cell's supervisor may follow its execution scheme (docs/execution.md), looked up in the cell as it runs.

    control = examine(partition, Plan(), limits, d)
    [(c.name, c.answer) for c in control.checks]     # ("finite-response", "yes"), ...

Two spaces are gone through, both of the net that `verify.controller.running` makes of a cell. In that of the *cell*
the supervisor takes the first of its binding elements: there it is looked what the cell can come to, and there
properties are asked. In that of all *orders* it takes any: there it is looked whether the order matters. Where the
supervisor never has more than one to choose from the two are one, and it is gone through once. Which questions are
asked, and what the answers mean, is here; the graphs are gone through by cnative/src/explore/query/explore_control.c
and explore_running.c. That no owner touches what is not its own is seen in the net itself.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

from pn2code.base.deadline import NEVER
from pn2code.cell.partition import OwnerKind, Partition
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import ArcKind
from pn2code.properties import meaning as m
from pn2code.properties.questions import Questions
from pn2code.verify.controller import by_counts, by_turns
from pn2code.verify.controller.by_turns import Looked, OutOfReachError, validity
from pn2code.verify.controller.control_answers import (
    ORDERS,
    STILL,
    Keeper,
    can_more,
    capacities_check,
    cell_answers,
    channels_check,
    drawn,
    hesitating,
    is_short,
    known,
    order_answers,
    refusal,
    seen_in_turns,
    settled,
    silent,
    unknown,
)
from pn2code.verify.controller.control_messages import formats, memory
from pn2code.verify.controller.control_types import (
    BLOCKING,
    BOUNDED,
    CONFLUENT,
    FINITE,
    MAX_FIRINGS,
    MOST_WRITTEN,
    OWNERSHIP,
    CellProgram,
    Check,
    Control,
    Plan,
    WrittenGraph,
)
from pn2code.verify.controller.crowd import Crowd, crowd
from pn2code.verify.controller.equals import NoPatternError
from pn2code.verify.controller.hunts import hunt
from pn2code.verify.controller.kept_silence import kept_silence
from pn2code.verify.controller.not_modelled import NotModelledError
from pn2code.verify.controller.poses import Bad, Poses
from pn2code.verify.controller.reach_check import reach, suspects, told_poses
from pn2code.verify.controller.running import Running
from pn2code.verify.controller.stated import Stated, ways
from pn2code.verify.exploring import nondeterminism
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import REACHED, Limits, Reduction
from pn2code.verify.exploring.programs import Generated, Sizes
from pn2code.verify.exploring.result import Exploration

DOUBT = (
    "a condition of a script that waits for a message raises an exception in a state of the cell, and whether the "
    "script comes to it is not known"
)

NO_BOUNDS: Mapping[int, int] = MappingProxyType({})
FEW = 60_000
"""States before tokens are counted up to a limit where they are in the closed net."""
ORDERS_FROM = 20_000
"""States among which it is looked first whether the order of firings matters, where not all states are looked at."""
CELL_PART = 0.8
"""Of the time, what the exploration may take that most answers come from."""
HUNT_PART = 0.8
"""Of what is left then, what the search for runs may take; the rest is for what makes the states so many (`crowd`)."""

# --- questions -----------------------------------------------------------------------------------


def of_cell(
    running: Running, plan: Plan, *, in_turns: bool = False, conditions: Sequence[Stated] = ()
) -> str:
    """The lines for the explorer about the cell: first properties, then what `cell_answers` understands.

    Args:
        running: its net.
        plan: what is asked.
        in_turns: in a space that is seen in turns (`by_turns`).
        conditions: what is asked there of states instead of the properties.
    """
    asked = Questions()
    resting = None if in_turns else running.resting
    for x in conditions:
        x.ask(asked)
    for p in () if in_turns else plan.properties.properties:
        asked.ask(_with_programs(p.asked, running))
    end = "-"
    if running.partition.final_places:
        end = str(asked.line(f"ef {asked.line(f'within {running.over} 1 -')}"))
    asked.asked += [
        f"? ends {end}",
        f"? bound {running.stopped} 0 0",
        *(f"? restless {i} {steps.most}" for i, steps in enumerate(running.moments.sets())),
        *(f"? invariant {kept_silence(asked, s, resting)}" for s in running.silences),
        *(f"? bound {c.place} 0 1" for c in running.partition.channels),
        *(f"? bound {place} 0 {most}" for place, most in plan.capacities.items()),
        *([] if running.unsure is None else [f"? bound {running.unsure} 0 0"]),
    ]
    lines = running.lines(first=True, at_once=in_turns)
    return "".join(f"{line}\n" for line in lines) + asked.text()


def _with_programs(asked: m.Asked, running: Running) -> m.Asked:
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
    return "".join(f"{line}\n" for line in lines) + _asked_of_orders(firings) + more


def _asked_of_orders(firings: int) -> str:
    """`ORDERS` questions."""
    asked = ["finite-response", f"bounded-response {firings}", "confluence 0", "confluence 1"]
    return "".join(f"? {question}\n" for question in asked)


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
    at_once = f"orders\n{_asked_of_orders(plan.firings)}" if is_asked_at_once else ""
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
        may_turn = _may_turn(partition, plan, part)
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
            orders_part = _part_of_orders(running, plan, counts_part, own, d)
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
            if in_counts is not None and _has_suspects(poses, in_counts.looked.found, limits):
                in_counts = None
            if in_counts is not None and in_counts.has_open:
                rows = _hunted(running, plan, part, soon, in_counts.answers)
                in_counts = replace(in_counts, answers=rows)
            if in_counts is None or in_counts.has_open:
                found = explore_all(first_part if in_counts is None else part, options)
                if in_counts is not None and found is not None:
                    in_counts = in_counts.with_more(found)
        if in_counts is None and may_turn and found is not None and found.why == "states":
            try:
                in_turns = _looked_in_turns(partition, plan, part, options, at_once, poses)
                if in_turns is not None:
                    turned = _told_in_turns(running, plan, part, options, found, in_turns)
                if in_turns is None or _is_open(plan, turned):
                    found = explore_all(part, options)
                    if found is not None and in_turns is not None:
                        turned = _with_part(turned, found)
                        in_turns = in_turns if turned else None
                if in_turns is not None and in_turns.running.meek and _has_runs(turned):
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
                found, why=plan.cut, answers=tuple(_cut(a, plan.cut) for a in found.answers)
            )
        # Fewer states than are permitted were to show whether all are needed; then the time was over.
        is_late = part.deadline.is_over() and not _is_full(found, limits)
        if is_late and found.why == "states":
            found = replace(found, why="seconds", answers=_late(found.answers))
        count = len(plan.properties.properties)
        answers = found.answers[:count] if in_counts is None else in_counts.answers
        if in_turns is not None:
            answers = turned
        if is_late:
            answers = _late(answers)
        if in_counts is None and found.why in REACHED:
            # What was seen may be too much to tell how it comes to what is wrong; a run to it need not be.
            hunted = replace(limits, deadline=limits.deadline.share(HUNT_PART))
            open_row = {"answer": "unknown", "why": found.why, "trace": None}
            known: Sequence[Mapping[str, Any]] = answers or [open_row] * count
            answers = _hunted(running, plan, hunted, options, known)
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
        said, asked = _parted(others, ORDERS if is_asked_at_once else 0)
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
                first = limits.counts_from if not moves and _may_reduce(partition, limits) else None
                some = limits if first is None else replace(limits, max_states=first)
                orders = explore(running.net, plan.storage, some, d, own)
                if first is not None and orders is not None and orders.why == "states":
                    other = _reduced_orders(partition, plan, part, options, found, orders, at_once)
                    if other is not None:
                        orders, asked, of_orders_run = other
                    elif limits.max_states != first:
                        orders = explore(running.net, plan.storage, limits, d, own)
        if orders is None:
            return None
        if is_late:
            said, asked = _late(said), _late(asked)
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


def _hunted(
    running: Running,
    plan: Plan,
    limits: Limits,
    options: ExploreOptions,
    rows: Sequence[Mapping[str, Any]],
) -> tuple[Mapping[str, Any], ...]:
    """What is known of properties, with what a search for runs finds, where not all states can be seen."""
    properties = [_with_programs(p.asked, running) for p in plan.properties.properties]
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


def _may_turn(partition: Partition, plan: Plan, limits: Limits) -> bool:
    """Whether the programs of a cell that is too large for the whole of it are looked at in turns."""
    most, least = limits.max_states, limits.turns_from
    if least is None or (most is not None and most <= least):
        return False
    return not plan.cut and not partition.net.timed


def _may_count(partition: Partition, plan: Plan, limits: Limits) -> bool:
    """Whether tokens are counted up to a limit only before more is looked at."""
    first, most = limits.counts_from, limits.max_states
    if first is None or limits.turns_from is None or first > limits.turns_from:
        return False
    is_enough = most is None or most >= first
    return is_enough and not partition.net.timed


def _may_reduce(partition: Partition, limits: Limits) -> bool:
    """Whether all orders of firing of a cell need not be looked at, where they are too many."""
    first, most = limits.counts_from, limits.max_states
    is_enough = first is not None and (most is None or most >= first)
    return is_enough and limits.turns_from is not None and not partition.net.timed


def _reduced_orders(
    partition: Partition,
    plan: Plan,
    limits: Limits,
    options: ExploreOptions,
    found: Exploration,
    orders: Exploration,
    at_once: str,
) -> tuple[Exploration, Sequence[Mapping[str, Any]], Running] | None:
    """What is said of the orders of firing with limits, or in turns, with the net of its evidence; None: nothing.

    Args:
        partition, plan, limits, options: as for `examine`.
        found: all states of the cell.
        orders: a part of those of all orders.
        at_once: questions about orders.
    """
    plan = replace(plan, properties=m.Properties(), cut="")
    options = replace(options, predicates=(), bindings=())
    whole = replace(found, answers=())
    counted = by_counts.look(
        partition, plan, limits, options, part=whole, order=orders.answers, in_order=at_once
    )
    if counted is not None:
        return counted.looked.found, counted.asked, Running.of(partition)
    with suppress(OutOfReachError):
        turned = _looked_in_turns(partition, plan, limits, options, at_once, None)
        if turned is not None and turned.orders is not None:
            return turned.orders, turned.orders.answers[:ORDERS], turned.running
    return None


def _part_of_orders(
    running: Running, plan: Plan, limits: Limits, options: ExploreOptions, d: Diagnostics
) -> Exploration | None:
    """A part of the space of all orders: a small one, where that shows that the order of firings matters."""
    few = min(limits.max_states or ORDERS_FROM, ORDERS_FROM)
    found = explore(running.net, plan.storage, replace(limits, max_states=few), d, options)
    if found is None or found.why != "states" or by_counts.is_decided(found.answers):
        return found
    if few == limits.max_states:
        return found  # that is all that may be looked at
    return explore(running.net, plan.storage, limits, d, options)


def _has_suspects(poses: Poses | None, found: Exploration, limits: Limits) -> bool:
    return bool(suspects(told_poses(poses, found, limits.deadline), found))


def _looked_in_turns(
    partition: Partition,
    plan: Plan,
    limits: Limits,
    options: ExploreOptions,
    at_once: str,
    poses: Poses | None,
) -> Looked | None:
    """What is seen in turns; None: it is not said."""
    over = Running.of(partition, loose=True).over
    properties = [x for _, x in _told_by_states(partition, plan, over)]
    loose = by_turns.loosened(partition, [x.places for x in properties])
    if loose is None:
        return None
    running, _ = loose

    def is_choiceless(found: Exploration) -> bool:
        _, asked = _parted(found.answers, ORDERS)
        return bool(at_once) and asked[0]["answer"] != "unknown"

    looked = by_turns.look(
        loose,
        plan,
        replace(limits, max_states=limits.most_in_turns or limits.max_states),
        options,
        Diagnostics(),  # what is wrong with this net the whole space tells
        cell=of_cell(running, plan, in_turns=True, conditions=properties) + at_once,
        orders=of_orders(running, plan.firings, in_turns=True),
        is_choiceless=is_choiceless,
        properties=len(properties),
    )
    if looked is None or _has_suspects(poses, looked.found, limits):
        return None
    return looked


def _told_in_turns(
    running: Running,
    plan: Plan,
    limits: Limits,
    options: ExploreOptions,
    part: Exploration,
    looked: Looked,
) -> tuple[Mapping[str, Any], ...]:
    """What is known of properties: what holds in turns, what a part of the cell's states says, and runs."""
    properties = plan.properties.properties
    rows: list[Mapping[str, Any]] = [
        {**row, "part": True} for row in part.answers[: len(properties)]
    ]
    told = _told_by_states(running.partition, plan, looked.running.over)
    for (i, x), mine in zip(told, looked.told, strict=True):
        if x.holds(mine):
            rows[i] = Stated.row(properties[i])
    return _hunted(running, plan, limits, options, rows)


def _told_by_states(partition: Partition, plan: Plan, over: int) -> list[tuple[int, Stated]]:
    """What is asked of states instead of the properties, by their numbers."""
    asked = plan.properties
    return [(i, x) for i, p in enumerate(asked.properties) for x in ways(p, over, asked, partition)]


def _is_open(plan: Plan, rows: Sequence[Mapping[str, Any]]) -> bool:
    """Whether something is asked of the cell that is not known."""
    told = zip(plan.properties.properties, rows, strict=False)
    return any(row["answer"] == "unknown" and not p.of_net for p, row in told)


def _has_runs(rows: Sequence[Mapping[str, Any]]) -> bool:
    return any(row.get("trace") for row in rows)


def _with_part(
    rows: Sequence[Mapping[str, Any]], whole: Exploration
) -> tuple[Mapping[str, Any], ...]:
    """With what more of the cell's states say; nothing: they say all."""
    if whole.why not in by_counts.CUT_SHORT:
        return ()
    # What a part said is said again, and its run has been written again.
    told = zip(rows, whole.answers, strict=False)
    return tuple(a if b["answer"] == "unknown" else {**b, "part": True} for a, b in told)


def _parted(
    rows: Sequence[Mapping[str, Any]], last: int
) -> tuple[Sequence[Mapping[str, Any]], Sequence[Mapping[str, Any]]]:
    """The answers about the cell, and so many about all orders, if there are any."""
    return (rows[: len(rows) - last], rows[len(rows) - last :]) if len(rows) >= last else (rows, ())


def _cut(answer: Mapping[str, Any], why: str) -> Mapping[str, Any]:
    """The answer, with the reason for which it is not known."""
    is_so = answer["answer"] == "unknown" and answer.get("why") == "states"
    return {**answer, "why": why} if is_so else answer


def _is_full(found: Exploration, limits: Limits) -> bool:
    """Whether as many states were seen as are permitted at all."""
    return limits.max_states is not None and found.nodes >= limits.max_states


def _late(answers: Sequence[Mapping[str, Any]]) -> tuple[Mapping[str, Any], ...]:
    """The answers, where the time was over before as many states were seen as are permitted."""
    return tuple(_cut(answer, "seconds") for answer in answers)


# --- the net itself ------------------------------------------------------------------------------


def ownership(partition: Partition) -> Check:
    """Each arc leads to a place of the transition's owner, or to a channel in its direction."""
    net = partition.net
    channels = {c.place: c for c in partition.channels}
    wrong: list[str] = []
    arcs = 0
    for t, owner in zip(net.transitions, partition.transition_owner, strict=True):
        who = partition.owners[owner]
        for arc in t.arcs:
            arcs += 1
            channel = channels.get(arc.place)
            if channel is None:
                is_fine = partition.place_owner[arc.place] == owner
            else:
                is_fine = (arc.kind is ArcKind.INPUT and channel.reader == owner) or (
                    arc.kind is ArcKind.OUTPUT and channel.writer == owner
                )
            if not is_fine:
                whose = "the supervisor" if who.kind is OwnerKind.SUPERVISOR else f"`{who.name}`"
                wrong.append(f"`{t.name}` of {whose} touches `{net.places[arc.place].name}`")
    if wrong:
        return Check(OWNERSHIP, "no", "; ".join(wrong[:5]), len(wrong), transitions=tuple(wrong))
    says = f"all {arcs:,} arcs keep to places of their owner and channels in their direction"
    return Check(OWNERSHIP, "yes", says, arcs)


def not_looked(
    why: str,
    partition: Partition,
    capacities: Mapping[int, int] | None = None,
    closed: Exploration | None = None,
    poses: Poses | None = None,
    bounds: Mapping[int, int] = NO_BOUNDS,
) -> Control:
    """When there is no space of the cell to look in."""
    nothing = {"answer": "unknown", "why": why}
    checks = [unknown(name, nothing) for name in (FINITE, BOUNDED, CONFLUENT, BLOCKING)]
    declared = capacities or {}
    open_rows = [nothing] * (len(partition.channels) + len(declared))
    rows = [*known(partition, declared, open_rows, closed, bounds)]
    keep = Keeper(Plan(), None)
    if partition.channels:
        checks.append(channels_check(partition, rows[: len(partition.channels)], keep))
    if declared:
        checks.append(capacities_check(partition, declared, rows[len(partition.channels) :], keep))
    seen = closed if closed is not None and can_more(partition) else None
    checks += formats(partition, seen, Plan(), Diagnostics(), why)
    checks.append(memory(seen, why, of_cell=False))
    checks += reach(told_poses(poses, seen, NEVER), partition, seen, None, keep, why)
    return Control(partition, (*checks, ownership(partition)), None, why=why)
