"""What `generate` wants to know of a net before it becomes a program: is its supervisor fine, how large are its places.

    found = prove(partition, config, d)      # None: the supervisor fails a check, or a place has no bound; reported
    found.place_capacities                   # for `place_capacity.with_place_capacities`
    found.verdicts                           # lines for the head of cell_config.c

Of a net without a cell.toml only the structure is looked at: it takes no compiler and little time.

The same cell gives the same program on every machine, however busy: how far is looked is a number of states. Where a
machine cannot look so far, nothing is generated.
"""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.cell.place_finder import PlaceFinder
from pn2code.diagnostics import Diagnostics, Note
from pn2code.net.flat import BindAll, BindRandom
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.structure import bounds_and_sums
from pn2code.toolchain.build import TOOL_MISSING
from pn2code.verify.answers.reasons import clause
from pn2code.verify.codes import BEYOND_ROOM, CONTROL_BEYOND, CONTROL_FAILED, CONTROL_OPEN
from pn2code.verify.controller import arena, control, control_types
from pn2code.verify.controller.control_types import MOST_IN_TURNS, MOST_STATES, Check, Control, Plan
from pn2code.verify.controller.not_looked import not_looked
from pn2code.verify.controller.poses import Arms, Poses
from pn2code.verify.controller.premises import NOTHING_GIVEN, Premises
from pn2code.verify.exploring import place_capacity
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits, cores

MOST_PROCESSOR_SECONDS = 900.0
"""For one exploration. `MOST_STATES` take a minute or two of it: only a net whose inscriptions compute for very long,
or for ever, comes to this end."""
_BEYOND = {
    "processor": f"the explorer has computed for {MOST_PROCESSOR_SECONDS:,.0f} s",
    "memory": "there is too little memory for them",
}
"""What keeps a machine from looking at the states, of which another one might see more."""
_WIDTH = 117
"""Of a line in the head of a generated file."""
UNCHECKED = "Not checked, since it was generated with --unchecked (docs/execution.md):"


@frozen
class Proofs:
    """What was found.

    Args:
        place_capacities: for each place.
        verdicts: lines for people, the same whenever the same is generated.
        control: the checks; None: they were not asked for.
        arena: bytes for the lists and strings of the program; None: not known.
    """

    place_capacities: tuple[place_capacity.PlaceCapacity, ...]
    verdicts: tuple[str, ...]
    control: Control | None
    arena: int | None = None


def prove(
    partition: Partition,
    config: CellConfig | None,
    d: Diagnostics,
    *,
    checked: bool = True,
    arms: Arms | None = None,
    tokens: Mapping[int, str] = NOTHING_GIVEN,
) -> Proofs | None:
    """Checks the supervisor of a cell, and finds the bounds of all places; None when an error was reported.

    Args:
        partition: the net as a run begins it (`input_files`), and its owners.
        config: the cell; None: a net that is one program, which is only warned about.
        d: gets the errors.
        checked: without, nothing is refused and the state space is not explored.
        arms: of its robots; None: nothing is known of them.
        tokens: by place, a clause that says which token a file gave it.
    """
    net = partition.net
    storage = config.storage if config else {}
    given = _given(partition, storage)
    structure = bounds_and_sums(net, storage=storage, given=given)
    structural = structure[0]
    capacities = declared(partition, config, d)
    if capacities is None:
        return None
    if config is None or not checked:
        found = place_capacity.place_capacities(partition, capacities, structural, None)
        if config is None:
            run = place_capacity.growing(net, storage, found, walks=place_capacity.FEW_WALKS)
            place_capacity.warn_assumed(net, found, d, run)
        place_capacity.refuse_large(net, found, d)
        if d.has_errors:
            return None
        poses = None
        if config is not None and arms is not None:
            poses = Poses(partition, config.primitives, arms, storage)
        return Proofs(found, tuple(_not_asked(partition, poses)) if config else (), None)
    plan = Plan(
        storage=storage,
        order_decides=config.supervisor.order_decides,
        capacities=capacities,
        premises=Premises.of(partition, config, tokens),
        bounds={k: b.bound for k, b in structural.items() if b.bound is not None},
        primitives=config.primitives,
        arms=arms,
    )
    looked = _look(partition, config, plan, d)
    if looked is None:
        return None
    for check in looked.failed:
        _refuse(check, partition, config, tokens, d)
    if looked.open and not looked.failed:
        _warn_open(looked, config, d)
    space = looked.found
    # From a marking that has other tokens than the net's own, more may be reached.
    found = place_capacity.place_capacities(
        partition, capacities, structural, None if given else space
    )
    why = looked.open[0].why if looked.open else None
    if why == "compiler":  # nobody can build it here, either: it will be checked where that is done
        place_capacity.warn_assumed(net, found, d)
    else:
        other = (
            f"`{given[0]}` has another number of tokens in the net than the one that its file brings, and the "
            "file is not there"
            if given
            else ""
        )
        if not any(
            c.why == "stopped" for c in looked.failed
        ):  # an exception is why nothing is known
            run = place_capacity.growing(net, storage, found)
            place_capacity.refuse(net, found, other or clause(why or ""), d, run)
    place_capacity.refuse_large(net, found, d)
    if d.has_errors:
        return None
    return Proofs(found, tuple(_verdicts(looked)), looked, arena.size(space))


def _given(partition: Partition, storage: Mapping[str, str]) -> tuple[str, ...]:
    """Places that do not begin with as many tokens as the net says: a file that is not there yet gives one token."""
    names = [partition.net.places[i.place].name for i in partition.inputs]
    if not names:
        return ()
    try:
        marking = Game(partition.net, storage).marking
    except GameError:
        return tuple(names)
    counts = Counter({i.place: len(tuple(marking.places[i.place])) for i in partition.inputs})
    return tuple(partition.net.places[i].name for i, count in counts.items() if count != 1)


def declared(
    partition: Partition, config: CellConfig | None, d: Diagnostics
) -> dict[int, int] | None:
    """`[capacity]` by place; None when it names what is not there."""
    if config is None or not config.capacity:
        return {}
    find = PlaceFinder(partition.net, d)
    found = {}
    for name, bound in config.capacity.items():
        place = find(name, config.locator.origin("capacity", name), "capacity")
        if place is None:
            return None
        found[place.index] = bound
    return found


def _look(partition: Partition, config: CellConfig, plan: Plan, d: Diagnostics) -> Control | None:
    """The checks; open ones where the state space cannot be had. None after an error that has nothing to do with it."""
    own = Diagnostics()
    limits = Limits(
        max_states=MOST_STATES,
        processor_seconds=MOST_PROCESSOR_SECONDS,
        threads=cores(),
        traces=0,
        most_in_turns=MOST_IN_TURNS,
    )
    plan = replace(plan, options=ExploreOptions(quick=True))
    try:
        found = control.examine(partition, plan, limits, own)
        if found is not None and limits.threads > 1 and any(c.why == "states" for c in found.open):
            # Which states are the first is the same each time for one thread only.
            # That turns do not help is known.
            alone = replace(limits, threads=1, turns_from=None)
            found = control.examine(partition, plan, alone, own)
    except GameError as error:
        error.report(d)
        return None
    if found is None and any(i.code == TOOL_MISSING for i in own.errors):
        poses = plan.poses(partition)
        return not_looked("compiler", partition, plan.capacities, poses=poses, bounds=plan.bounds)
    # A place that grows without end is one without a bound, which is refused with a better hint.
    d.items += [i for i in own.items if i.code != BEYOND_ROOM]
    if found is not None and all(i.code != BEYOND_ROOM for i in own.items):
        beyond = next((why for c in found.open if (why := _BEYOND.get(c.why or ""))), None)
        if beyond is not None and not found.failed:
            d.error(
                CONTROL_BEYOND,
                f"the states of the cell cannot be looked at: {beyond}",
                config.supervisor.origin,
                hint="`--unchecked` generates it without looking at them; `pn2code verify` has no limits of its own",
            )
            return None
    return found


def _refuse(
    check: Check,
    partition: Partition,
    config: CellConfig,
    tokens: Mapping[int, str],
    d: Diagnostics,
) -> None:
    net = partition.net
    places = {p.name: p.origins[0] for p in net.places}
    transitions = {t.name: t.origin for t in net.transitions}
    at = [transitions[t] for t in check.transitions if t in transitions]
    if check.place is not None:
        at.insert(0, places[check.place])
    final = config.locator.origin("supervisor", "final")
    is_end = check.name == control_types.BLOCKING and bool(partition.final_places)
    notes: list[str | Note] = [f"checked: {control_types.MEANINGS[check.name]}"]
    notes += [
        Note("the other transition is here", other)
        for other in at[1:2]
        if other.describe() != at[0].describe()
    ]
    for run in check.evidence[:1]:
        notes.append(_last_steps(run))
    notes += tokens.values()
    d.error(
        CONTROL_FAILED,
        f"{check.name}: {check.says}",
        at[0] if at else final if is_end else config.supervisor.origin,
        notes=[n for n in notes if n],
        hint=_hint(check, partition),
    )


def _hint(check: Check, partition: Partition) -> str:
    """What to do; priorities choose between transitions, not between the bindings of one."""
    if check.name != control_types.CONFLUENT or len(set(check.transitions)) != 1:
        return _HINTS.get(check.name, _HINT)
    t = next(t for t in partition.net.transitions if t.name == check.transitions[0])
    free = [x.symbol.name for x in t.plan if isinstance(x, BindAll | BindRandom)]
    if free:
        listed = " and ".join(f"`{name}`" for name in free)
        which = f"{listed} is bound by no arc: put it on an input arc, or write a guard `{free[0]} = ...`"
    else:
        which = "let a guard, or what its input arcs take, leave one binding only"
    return f"{which}; {_INTENDED}"


_HINT = "`pn2code verify` on the cell writes the run that shows it; `--unchecked` goes on without these checks"
_INTENDED = (
    'or say in cell.toml that the documented order is intended: `order = "documented"` in [supervisor]; '
    "`--unchecked` goes on without these checks"
)
_HINTS = {
    control_types.CONFLUENT: f"give the transitions different priorities, {_INTENDED}",
}
_SHOWN = 4


def _last_steps(run: control_types.Evidence) -> str:
    last = run.transitions[-_SHOWN:]
    if not last:
        return ""
    before = "... " if len(run.transitions) > len(last) else ""
    return f"the run that shows it ends with {before}{', '.join(f'`{t}`' for t in last)}"


def _warn_open(looked: Control, config: CellConfig, d: Diagnostics) -> None:
    names = ", ".join(c.name for c in looked.open)
    d.warning(
        CONTROL_OPEN,
        f"it is not known whether the supervisor keeps to its execution scheme: {looked.open[0].says}",
        config.supervisor.origin,
        notes=[f"not checked: {names}"],
        hint=_OPEN_HINTS.get(looked.open[0].why or "", _OPEN_HINT),
    )


_OPEN_HINT = (
    "`pn2code verify` on the cell has no limits of its own; the generated files say `unchecked`"
)
_OPEN_HINTS = {
    "late": (
        "let the answer come in time, or make `reply_timeout_s` longer; what is never answered is `data`, "
        "not a flag (docs/protocol.md, I8)"
    ),
    "speeds": "`pn2code verify` writes the run; the generated files say `unchecked`",
}


def _not_asked(partition: Partition, poses: Poses | None) -> Iterator[str]:
    """What nothing is known of, and what is seen without exploring."""
    yield UNCHECKED
    for check in not_looked("", partition, poses=poses).checks:
        yield (
            f"  {check.name}: unchecked ({control_types.MEANINGS[check.name]})"
            if check.answer == "unknown"
            else _verdict(check)
        )


def _verdicts(looked: Control) -> Iterator[str]:
    if looked.open:
        yield "Not checked completely (docs/execution.md):"
    else:
        assert looked.found is not None
        yield _where(looked.found.nodes, reduced=looked.reduced, counted=looked.is_counted)
    for check in looked.checks:
        yield from textwrap.wrap(_verdict(check), _WIDTH, subsequent_indent="    ")
    assumed = dict.fromkeys(x for check in looked.checks for x in check.assumes)
    if assumed:
        yield "Assumed:"
    for premise in assumed:
        yield from textwrap.wrap(f"  {premise}", _WIDTH, subsequent_indent="    ")


def _where(states: int, *, reduced: bool, counted: bool) -> str:
    """What was looked at."""
    if counted:
        return (
            f"Checked in {states:,} states that stand for all of the cell, its programs looked at in turns "
            "(docs/reductions.md):"
        )
    if reduced:
        return f"Checked in {states:,} states of the cell, its programs looked at in turns (docs/reductions.md):"
    return f"Checked in all {states:,} states of the cell as it runs (docs/execution.md):"


def _verdict(check: Check) -> str:
    answer = {"unknown": "unchecked"}.get(check.answer, check.answer)
    return f"  {check.name}: {answer}; {check.says}"
