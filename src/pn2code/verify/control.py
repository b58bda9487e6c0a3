"""Whether a cell's supervisor may follow its execution scheme (docs/execution.md), looked up in the cell as it runs.

    control = examine(partition, Plan(), limits, d)
    [(c.name, c.answer) for c in control.checks]     # ("finite-response", "yes"), ...

Two spaces are gone through, both of the net that `verify.running` makes of a cell. In that of the *cell* the supervisor
takes the first of its binding elements: there it is looked what the cell can come to, and there properties are asked.
In that of all *orders* it takes any: there it is looked whether the order matters. Which questions are asked, and what
the answers mean, is here; the graphs are gone through by cnative/src/explore_control.c and explore_running.c. That no
owner touches what is not its own is seen in the net itself.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from pn2code.cell.partition import OwnerKind, Partition
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import ArcKind
from pn2code.properties import meaning as m
from pn2code.properties.questions import Questions
from pn2code.verify import basis, chance
from pn2code.verify.explore import Wishes, explore
from pn2code.verify.limits import Limits, Reduction
from pn2code.verify.programs import Sizes
from pn2code.verify.reasons import clause
from pn2code.verify.result import Exploration
from pn2code.verify.running import NotModelledError, Running
from pn2code.whole_file import whole_file

FINITE = "finite-response"
BOUNDED = "bounded-response"
CONFLUENT = "confluence"
BLOCKING = "non-blocking"
CHANNELS = "channels"
CAPACITY = "capacity"
OWNERSHIP = "ownership"

TITLES = {
    FINITE: "Finite response",
    BOUNDED: "Bounded response",
    CONFLUENT: "Confluence",
    BLOCKING: "Non-blocking under control",
    CHANNELS: "One message in flight",
    CAPACITY: "Declared capacities",
    OWNERSHIP: "Nothing touched that is another's",
}
MEANINGS = {
    FINITE: "the supervisor, left alone, always comes to rest",
    BOUNDED: "the most firings in one cycle",
    CONFLUENT: "the order in which the supervisor fires within a cycle does not matter",
    BLOCKING: "wherever the cell gets, it comes to its end, whichever of its programs are slow",
    CHANNELS: "no channel ever holds two messages",
    CAPACITY: "no place ever holds more tokens than `[capacity]` declares",
    OWNERSHIP: "transitions touch places of their owner, and channels in their direction",
}
KEPT = frozenset({FINITE, BOUNDED, CHANNELS, CAPACITY, OWNERSHIP})
"""Checks whose "yes" is kept when the programs do less than what was looked at."""
MAX_FIRINGS = 100_000
"""What `./supervisor` permits in one cycle unless it is told another number."""
_WAYS = 60
"""Transitions of a run that are named."""


@dataclass(frozen=True, slots=True)
class Evidence:
    """A run that shows an answer.

    Args:
        steps: its length; `loop`: the step (from 0) at which its cycle begins, None: it ends.
        node: its last marking.
        transitions: what occurs, by name, as far as it was read.
        file: the trace; None: it was not kept.
    """

    steps: int
    loop: int | None
    node: int | None
    transitions: tuple[str, ...]
    file: Path | None

    def row(self) -> dict[str, Any]:
        """For programs."""
        trace = None if self.file is None else str(self.file)
        return {"trace": trace, "steps": self.steps, "loop": self.loop, "node": self.node}


@dataclass(frozen=True, slots=True)
class Check:
    """A check and its answer.

    Args:
        name: one of those above.
        answer: "yes", "no" or "unknown".
        says: one line for people.
        value: the number that belongs to it, if there is one.
        why: of "unknown", as in `reasons`; of a blocked cell "deadlock" or "endless".
        is_accepted: cell.toml says that it need not be so.
        evidence: the run; of confluence a second one, which goes on in another way.
        transitions: the two whose order matters; those that touch what is another's.
        place: the channel, or the place with a capacity, by name.
    """

    name: str
    answer: str
    says: str
    value: int | None = None
    why: str | None = None
    is_accepted: bool = False
    evidence: tuple[Evidence, ...] = ()
    transitions: tuple[str, ...] = ()
    place: str | None = None

    @property
    def rests_on(self) -> str | None:
        """What has to be seen for this answer: a word of `basis`; None: there is no answer."""
        return basis.of_check(self.name, self.answer, self.why, has_run=bool(self.evidence))

    @property
    def fails(self) -> bool:
        """Whether the supervisor is wrong."""
        return self.answer == "no" and not self.is_accepted

    def row(self) -> dict[str, Any]:
        """For programs: docs/execution.md."""
        return {
            "check": self.name,
            "answer": self.answer,
            "value": self.value,
            "says": self.says,
            "why": self.why,
            "accepted": self.is_accepted,
            "kept": self.name in KEPT,
            "rests_on": self.rests_on,
            "transitions": list(self.transitions),
            "place": self.place,
            "evidence": [e.row() for e in self.evidence],
        }


@dataclass(frozen=True, slots=True)
class Plan:
    """How to look.

    Args:
        storage: as for `Game`.
        firings: the most firings in one cycle that are permitted.
        order_decides: cell.toml says that the documented order is meant to decide.
        folder: where traces are kept; None: nowhere.
        stem: what the names of their files begin with.
        capacities: place -> most tokens, as cell.toml declares.
        properties: what is asked about the cell besides.
        evidence: a folder for the runs that answer these; None: they are not kept.
        wishes: of the exploration. What it is asked, and the files it writes, are ours.
    """

    storage: Mapping[str, str] = field(default_factory=dict)
    firings: int = MAX_FIRINGS
    order_decides: bool = False
    folder: Path | None = None
    stem: str = "net"
    capacities: Mapping[int, int] = field(default_factory=dict)
    properties: m.Properties = m.Properties()
    evidence: Path | None = None
    wishes: Wishes = Wishes()


@dataclass(frozen=True, slots=True)
class Control:
    """All checks of a cell, and what they were looked up in.

    Args:
        checks: with their answers.
        found: the space of the cell as it runs; None: there is none.
        running: its net; None: the cell cannot be modelled so, and `why` says why.
        answers: what the explorer says of each property.
    """

    checks: tuple[Check, ...]
    found: Exploration | None
    running: Running | None = None
    why: str = ""
    answers: tuple[Mapping[str, Any], ...] = ()

    @property
    def failed(self) -> tuple[Check, ...]:
        """Those that say that the supervisor is wrong."""
        return tuple(c for c in self.checks if c.fails)

    @property
    def open(self) -> tuple[Check, ...]:
        """Those that are not known."""
        return tuple(c for c in self.checks if c.answer == "unknown")


# --- questions -----------------------------------------------------------------------------------


def has_own_priorities(partition: Partition) -> bool:
    """Whether priorities of one owner's transitions would hold back another's, as they do not in a cell."""
    return len({t.priority for t in partition.net.transitions}) > 1 and len(partition.owners) > 1


def of_cell(running: Running, plan: Plan) -> str:
    """The lines for the explorer about the cell: first properties, then what `cell_answers` understands."""
    asked = Questions()
    for p in plan.properties.properties:
        asked.ask(p.asked)
    end = "-"
    if running.partition.final_places:
        end = str(asked.line(f"ef {asked.line(f'within {running.over} 1 -')}"))
    asked.asked += [
        f"? ends {end}",
        f"? bound {running.stopped} 0 0",
        *(f"? bound {c.place} 0 1" for c in running.partition.channels),
        *(f"? bound {place} 0 {most}" for place, most in plan.capacities.items()),
    ]
    return "".join(f"{line}\n" for line in running.lines(first=True)) + asked.text()


def of_orders(running: Running, firings: int = MAX_FIRINGS) -> str:
    """The lines for the explorer about all orders, which `order_answers` understands."""
    lines = [
        *running.lines(first=False),
        "? finite-response",
        f"? bounded-response {firings}",
        "? confluence 0",
        "? confluence 1",
    ]
    return "".join(f"{line}\n" for line in lines)


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
    try:
        running = Running.of(partition)
    except NotModelledError as problem:
        why = f"the cell as it runs cannot be modelled: {problem}"
        return replace(not_looked(why, partition, plan.capacities, closed), why=why)
    limits = replace(
        limits,
        approximation=None,
        graph=True,
        reductions=(Reduction.TIME,) if partition.net.timed else (),
    )
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        wishes = replace(
            plan.wishes,
            sizes=Sizes.start(running.net, plan.storage),
            traces=None,
            graph=None,
            questions=of_cell(running, plan),
            predicates=plan.properties.predicates,
            evidence=plan.evidence or Path(name),
            stem="cell",
        )
        found = explore(running.net, plan.storage, limits, d, wishes)
        if found is None:
            return None
        count = len(plan.properties.properties)
        wishes = replace(wishes, questions=of_orders(running, plan.firings), stem="orders")
        wishes = replace(wishes, evidence=Path(name))
        orders: Exploration | None = found
        if found.complete or found.why == "decided":
            orders = explore(running.net, plan.storage, limits, d, wishes)
        if orders is None:
            return None
        keep = _Keeper(plan, running)
        asked = orders.answers if orders is not found else ()
        checks = (
            *order_answers(partition, orders, asked, plan, keep),
            *cell_answers(partition, found, found.answers[count:], plan, keep, closed),
            ownership(partition),
        )
        if chance.draws(partition.net):
            checks = tuple(_drawn(c) for c in checks)
        return Control(checks, found, running, answers=found.answers[:count])


# --- answers -------------------------------------------------------------------------------------


def _padded(
    found: Exploration, rows: Sequence[Mapping[str, Any]], count: int
) -> Sequence[Mapping[str, Any]]:
    """As many answers as there are questions: none were given where it was interrupted before it began."""
    if len(rows) == count:
        return rows
    why = None if found.complete else found.why
    return [{"answer": "unknown", "why": why}] * count


def order_answers(
    partition: Partition,
    found: Exploration,
    rows: Sequence[Mapping[str, Any]],
    plan: Plan,
    keep: _Keeper,
) -> Iterator[Check]:
    """What the explorer's answers to `of_orders` mean; traces that are wanted are moved to where they are kept."""
    finite, bounded, usual, other = _padded(found, rows, 4)
    yield _finite(finite, keep)
    yield _bounded(bounded, keep, plan)
    yield _confluent(usual, other, keep, plan)


def cell_answers(
    partition: Partition,
    found: Exploration,
    rows: Sequence[Mapping[str, Any]],
    plan: Plan,
    keep: _Keeper,
    closed: Exploration | None,
) -> Iterator[Check]:
    """The same of `of_cell`, without the properties."""
    channels = len(partition.channels)
    ends, stops, *bounds = _padded(found, rows, 2 + channels + len(plan.capacities))
    yield _stopping(stops, keep) or _blocking(ends, keep, partition)
    bounds = [*_known(partition, plan.capacities, bounds, closed)]
    if partition.channels:
        yield _channels(partition, bounds[:channels], keep)
    if plan.capacities:
        yield _capacities(partition, plan.capacities, bounds[channels:], keep)


def _known(
    partition: Partition,
    capacities: Mapping[int, int],
    rows: Sequence[Mapping[str, Any]],
    closed: Exploration | None,
) -> Iterator[Mapping[str, Any]]:
    """Bounds that are not known of the cell follow from those of a closed net that can do all that the cell can."""
    most = [*((c.place, 1) for c in partition.channels), *capacities.items()]
    bounds = (
        closed.bounds if closed is not None and closed.complete and can_more(partition) else None
    )
    for row, (place, limit) in zip(rows, most, strict=True):
        if row["answer"] == "unknown" and bounds is not None and bounds[place].upper <= limit:
            yield {"answer": "yes", "value": bounds[place].upper, "trace": None}
        else:
            yield row


def can_more(partition: Partition) -> bool:
    """Whether the closed net can do all that the cell can: neither priorities nor time hold back what others may do."""
    return not has_own_priorities(partition) and not partition.net.timed


def _drawn(check: Check) -> Check:
    """What rests on random numbers is one of many outcomes."""
    if check.answer != "yes" or check.name == OWNERSHIP:
        return check
    return replace(_open(check.name, {"why": "chance"}), value=check.value)


class _Keeper:
    """Reads traces, makes them runs of the cell's net, and moves them to the folder where they are kept."""

    def __init__(self, plan: Plan, running: Running | None) -> None:
        self._plan = plan
        self._running = running

    def last_step(self, row: Mapping[str, Any]) -> str:
        """The name of the last step of a trace, without its head; before it is read."""
        lines = Path(row["trace"]).read_text(encoding="utf-8", errors="surrogateescape").split("\n")
        steps = [x["transition"] for x in map(json.loads, filter(None, lines)) if "transition" in x]
        return str(steps[-1]).removeprefix("cell.")

    def before(self, row: Mapping[str, Any]) -> int:
        """How many of the first steps of a trace, as many as its number says, are occurrences; before it is read."""
        lines = Path(row["trace"]).read_text(encoding="utf-8", errors="surrogateescape").split("\n")
        steps = [x["transition"] for x in map(json.loads, filter(None, lines)) if "transition" in x]
        assert self._running is not None
        return sum(step in self._running.names for step in steps[: int(row["value"])])

    def evidence(self, row: Mapping[str, Any], name: str) -> Evidence | None:
        if row.get("trace") is None or self._running is None:
            return None
        path = Path(row["trace"])
        length, loop = self._running.project(path, row["loop"])
        trace = path.read_bytes()
        steps = map(json.loads, trace.decode("utf-8", "surrogateescape").rstrip("\n").split("\n"))
        named = [step["transition"] for step in steps if "transition" in step]
        kept = None
        if self._plan.folder is not None:
            kept = self._plan.folder / f"{self._plan.stem}.controller-{name}.trace.jsonl"
            try:
                with whole_file(kept) as beside:
                    beside.write_bytes(trace)
            except OSError:
                kept = None
        return Evidence(length, loop, None, tuple(named), kept)

    def all(self, row: Mapping[str, Any], name: str) -> tuple[Evidence, ...]:
        found = self.evidence(row, name)
        return () if found is None else (found,)


def _open(name: str, row: Mapping[str, Any]) -> Check:
    why = row.get("why")
    return Check(name, "unknown", f"not known: {clause(why or 'not asked')}", why=why)


def _finite(row: Mapping[str, Any], keep: _Keeper) -> Check:
    if row["answer"] == "unknown":
        return _open(FINITE, row)
    if row["answer"] == "yes":
        return Check(FINITE, "yes", "the supervisor always comes to rest")
    evidence = keep.all(row, FINITE)
    round_ = evidence[0].transitions[evidence[0].loop :] if evidence else ()
    ways = f" by repeating {_named(round_)}" if round_ else ""
    says = f"the supervisor can fire for ever{ways}"
    return Check(FINITE, "no", says, evidence=evidence, transitions=tuple(dict.fromkeys(round_)))


def _bounded(row: Mapping[str, Any], keep: _Keeper, plan: Plan) -> Check:
    if row["answer"] == "unknown":
        return _open(BOUNDED, row)
    most = int(row["value"])
    says = f"at most {most:,} firing{'s' * (most != 1)} in one cycle"
    if row["answer"] == "no":
        says += f", but no more than {plan.firings:,} are permitted"
    evidence = keep.all(row, BOUNDED) if row["answer"] == "no" else ()
    return Check(BOUNDED, row["answer"], says, most, evidence=evidence)


def _confluent(
    usual: Mapping[str, Any], other: Mapping[str, Any], keep: _Keeper, plan: Plan
) -> Check:
    if usual["answer"] == "unknown":
        return _open(CONFLUENT, usual)
    if usual["answer"] == "yes":
        return Check(CONFLUENT, "yes", "the order of firing does not matter")
    at = keep.before(usual) if usual.get("trace") else int(usual["value"])
    runs = (
        *keep.all(usual, CONFLUENT),
        *keep.all(other, f"{CONFLUENT}.other"),
    )
    pair = tuple(run.transitions[at] for run in runs if at < len(run.transitions))
    if len(set(pair)) == 1:
        what = f"which binding of `{pair[0]}` comes first matters"
    elif len(pair) == 2:
        what = f"whether `{pair[0]}` or `{pair[1]}` comes first matters"
    else:
        what = "the order of firing matters"
    says = f"{what}, {at} step{'s' * (at != 1)} after the start"
    if plan.order_decides:
        says += '; the documented order decides, as `order = "documented"` in cell.toml says'
        return Check(CONFLUENT, "no", says, at, is_accepted=True, transitions=pair)
    return Check(
        CONFLUENT,
        "no",
        says,
        at,
        evidence=runs,
        transitions=pair,
    )


def _stopping(row: Mapping[str, Any], keep: _Keeper) -> Check | None:
    """Whether a robot's script stops, and the cell with it; None: it does not, as far as is known."""
    if row["answer"] != "no":
        return None
    who = keep.last_step(row)
    evidence = keep.all(row, BLOCKING)
    steps = evidence[0].steps if evidence else 0
    after = f"{steps} step{'s' * (steps != 1)} after the start" if steps else "at the start"
    says = f"{after} {who}, where no transition fits: that stops the whole cell"
    return Check(BLOCKING, "no", says, why="stopped", evidence=evidence)


def _blocking(row: Mapping[str, Any], keep: _Keeper, partition: Partition) -> Check:
    if row["answer"] == "unknown" and row.get("why") != "speeds":
        return _open(BLOCKING, row)
    names = [partition.net.places[p].short for p in partition.final_places]
    final = " or ".join(f"`{n}`" for n in names)
    size = int(row["value"])
    if row["answer"] == "yes":
        how = (
            f"a token in {final} is reached from each of the {size:,} states of the cell, whoever is slow"
            if names
            else f"something can always happen in the {size:,} states of the cell (no place is final)"
        )
        return Check(BLOCKING, "yes", how, size)
    evidence = keep.all(row, BLOCKING)
    steps = evidence[0].steps if evidence else 0
    after = f"{steps} step{'s' * (steps != 1)} after the start" if steps else "at the start"
    if row["why"] == "speeds":
        says = (
            f"not known: a token in {final} can be reached from each of the {size:,} states of the cell, but {after} "
            "the order of events, which durations decide, can keep the cell from it for ever"
        )
        return Check(BLOCKING, "unknown", says, size, "speeds", evidence=evidence)
    if row["why"] == "deadlock":
        without = f", without a token in {final}" if names else ""
        says = f"a deadlock {after}: nothing can happen{without}"
    else:
        says = f"{after} a token in {final} can no longer be reached, though the cell goes on"
    return Check(BLOCKING, "no", says, size, row["why"], evidence=evidence)


def _channels(partition: Partition, rows: Sequence[Mapping[str, Any]], keep: _Keeper) -> Check:
    pairs = list(zip(partition.channels, rows, strict=True))
    for channel, row in pairs:
        if row["answer"] == "no":
            place = partition.net.places[channel.place].name
            most = int(row["value"])
            evidence = keep.all(row, CHANNELS)
            after = f", {evidence[0].steps} steps after the start" if evidence else ""
            says = f"channel `{channel.name}` gets {most} messages at a time{after}"
            return Check(CHANNELS, "no", says, most, evidence=evidence, place=place)
    for _, row in pairs:
        if row["answer"] == "unknown":
            return _open(CHANNELS, row)
    most = max(int(row["value"]) for _, row in pairs)
    count = len(pairs)
    says = f"at most {most} message in {'each of ' if count > 1 else ''}{count} channel{'s' * (count > 1)}"
    return Check(CHANNELS, "yes", says, most)


def _capacities(
    partition: Partition,
    capacities: Mapping[int, int],
    rows: Sequence[Mapping[str, Any]],
    keep: _Keeper,
) -> Check:
    places = partition.net.places
    for (index, bound), row in zip(capacities.items(), rows, strict=True):
        if row["answer"] == "no":
            most = int(row["value"])
            evidence = keep.all(row, CAPACITY)
            after = f", {evidence[0].steps} steps after the start" if evidence else ""
            says = f"place `{places[index].short}` gets {most} tokens{after}, but `[capacity]` declares {bound}"
            return Check(CAPACITY, "no", says, most, evidence=evidence, place=places[index].name)
    for row in rows:
        if row["answer"] == "unknown":
            return _open(CAPACITY, row)
    most = max(int(row["value"]) for row in rows)
    count = len(rows)
    says = (
        f"all {count} declared capacities are enough"
        if count > 1
        else "the declared capacity is enough"
    )
    return Check(CAPACITY, "yes", says, most)


def _named(transitions: Sequence[str]) -> str:
    some = [f"`{t}`" for t in transitions[:_WAYS]]
    return ", ".join(some) + (", ..." if len(transitions) > _WAYS else "")


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
) -> Control:
    """When there is no space of the cell to look in."""
    unknown = {"answer": "unknown", "why": why}
    checks = [_open(name, unknown) for name in (FINITE, BOUNDED, CONFLUENT, BLOCKING)]
    declared = capacities or {}
    open_rows = [unknown] * (len(partition.channels) + len(declared))
    rows = [*_known(partition, declared, open_rows, closed)]
    keep = _Keeper(Plan(), None)
    if partition.channels:
        checks.append(_channels(partition, rows[: len(partition.channels)], keep))
    if declared:
        checks.append(_capacities(partition, declared, rows[len(partition.channels) :], keep))
    return Control((*checks, ownership(partition)), None, why=why)
