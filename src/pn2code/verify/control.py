"""Whether a cell's supervisor may follow its execution scheme (docs/execution.md), looked up in the state space.

    control = examine(partition, Plan(), limits, d)
    [(c.name, c.answer) for c in control.checks]     # ("finite-response", "yes"), ...

Which questions are asked, and what the answers mean; the graph is gone through by cnative/src/explore_control.c. That
no owner touches what is not its own is seen in the net itself.
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
from pn2code.verify import basis
from pn2code.verify.explore import Wishes, explore
from pn2code.verify.limits import Limits, Reduction
from pn2code.verify.reasons import clause
from pn2code.verify.reductions import OBSTACLES
from pn2code.verify.result import Exploration
from pn2code.whole_file import whole_file

FINITE = "finite-response"
BOUNDED = "bounded-response"
CONFLUENT = "confluence"
BLOCKING = "non-blocking"
CHANNELS = "channels"
OWNERSHIP = "ownership"

TITLES = {
    FINITE: "Finite response",
    BOUNDED: "Bounded response",
    CONFLUENT: "Confluence",
    BLOCKING: "Non-blocking under control",
    CHANNELS: "One message in flight",
    OWNERSHIP: "Nothing touched that is another's",
}
MEANINGS = {
    FINITE: "the supervisor, left alone, always comes to rest",
    BOUNDED: "the most firings in one cycle",
    CONFLUENT: "the order in which the supervisor fires within a cycle does not matter",
    BLOCKING: "from every marking that the controlled cell can reach, a final marking can still be reached",
    CHANNELS: "no channel ever holds two messages",
    OWNERSHIP: "transitions touch places of their owner, and channels in their direction",
}
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
        place: the channel, by name.
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
        wishes: of the exploration: with the predicates and sizes with which the net has been compiled already, it need
            not be once more. What it is asked, and the files it writes, are ours.
    """

    storage: Mapping[str, str] = field(default_factory=dict)
    firings: int = MAX_FIRINGS
    order_decides: bool = False
    folder: Path | None = None
    stem: str = "net"
    wishes: Wishes = Wishes()


@dataclass(frozen=True, slots=True)
class Control:
    """All checks of a supervisor, and the state space in which they were looked up (None: there is none)."""

    checks: tuple[Check, ...]
    found: Exploration | None

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


def questions(partition: Partition, firings: int = MAX_FIRINGS) -> str:
    """The lines for the explorer, which `answers` understands."""
    lines = []
    for owner in partition.owners:
        own = [str(i) for i, o in enumerate(partition.transition_owner) if o == owner.index]
        lines += [
            " ".join(["owner", str(owner.index), *own[i : i + 200]])
            for i in range(0, len(own), 200)
        ]
    if has_own_priorities(partition):
        lines.append("priorities own")
    final = "-"
    for number, place in enumerate(partition.final_places):
        lines.append(f"within {place} 1 -")
        if number:
            lines.append(f"or {final} {2 * number - 1}")
        final = str(2 * number)
    lines += [
        "? finite-response",
        f"? bounded-response {firings}",
        "? confluence 0",
        "? confluence 1",
        f"? non-blocking {final}",
        *(f"? bound {c.place} 0 1" for c in partition.channels),
    ]
    return "".join(f"{line}\n" for line in lines)


def examine(partition: Partition, plan: Plan, limits: Limits, d: Diagnostics) -> Control | None:
    """Explores the closed net and answers all checks; None after an error that was reported.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    net = partition.net
    is_shorter = net.timed and OBSTACLES[Reduction.TIME](net) is None
    limits = replace(
        limits,
        approximation=None,
        graph=True,
        reductions=(Reduction.TIME,) if is_shorter else (),
    )
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        wishes = replace(
            plan.wishes,
            traces=None,
            graph=None,
            questions=questions(partition, plan.firings),
            evidence=Path(name),
            stem="run",
        )
        found = explore(net, plan.storage, limits, d, wishes)
        if found is None:
            return None
        return Control((*answers(partition, found, plan), ownership(partition)), found)


# --- answers -------------------------------------------------------------------------------------


def answers(partition: Partition, found: Exploration, plan: Plan) -> Iterator[Check]:
    """What the explorer's answers to `questions` mean; traces that are wanted are moved to where they are kept."""
    rows = found.answers
    if len(rows) != 5 + len(partition.channels):  # it was interrupted before it began
        why = None if found.complete else found.why
        rows = tuple({"answer": "unknown", "why": why} for _ in range(5 + len(partition.channels)))
    finite, bounded, usual, other, blocking, *channels = rows
    keep = _Keeper(plan)
    yield _finite(finite, keep)
    yield _bounded(bounded, keep, plan)
    yield _confluent(usual, other, keep, plan)
    yield _blocking(blocking, keep, partition)
    if partition.channels:
        yield _channels(partition, channels, keep)


class _Keeper:
    """Reads traces, and moves them to the folder where they are kept."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan

    def evidence(self, row: Mapping[str, Any], name: str) -> Evidence | None:
        if row.get("trace") is None or row["answer"] != "no":
            return None
        path = Path(row["trace"])
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
        return Evidence(row["steps"], row["loop"], row["node"], tuple(named), kept)

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
    return Check(BOUNDED, row["answer"], says, most, evidence=keep.all(row, BOUNDED))


def _confluent(
    usual: Mapping[str, Any], other: Mapping[str, Any], keep: _Keeper, plan: Plan
) -> Check:
    if usual["answer"] == "unknown":
        return _open(CONFLUENT, usual)
    if usual["answer"] == "yes":
        return Check(CONFLUENT, "yes", "the order of firing does not matter")
    at = int(usual["value"])
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


def _blocking(row: Mapping[str, Any], keep: _Keeper, partition: Partition) -> Check:
    if row["answer"] == "unknown":
        return _open(BLOCKING, row)
    names = [partition.net.places[p].short for p in partition.final_places]
    final = " or ".join(f"`{n}`" for n in names)
    size = int(row["value"])
    if row["answer"] == "yes":
        how = (
            f"a token in {final} can be reached from each of the {size:,} markings under control"
            if names
            else f"something can always happen in the {size:,} markings under control (no place is final)"
        )
        return Check(BLOCKING, "yes", how, size)
    evidence = keep.all(row, BLOCKING)
    steps = evidence[0].steps if evidence else 0
    after = f"{steps} step{'s' * (steps != 1)} after the start" if steps else "at the start"
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


def not_looked(why: str, partition: Partition, found: Exploration | None = None) -> Control:
    """When there is no graph to look in.

    Args:
        why: the reason, as in `reasons`.
        partition: the cell.
        found: what was explored. Where all its markings were seen, and the cell has no others (its priorities are
            those of the net), they say what the channels hold.
    """
    looked = [_open(name, {"why": why}) for name in (FINITE, BOUNDED, CONFLUENT, BLOCKING)]
    bounds = found.bounds if found is not None and found.seen.markings else None
    if partition.channels and bounds is not None and not has_own_priorities(partition):
        most = [bounds[c.place].upper for c in partition.channels]
        rows = [{"answer": "yes" if n <= 1 else "no", "value": n} for n in most]
        looked.append(_channels(partition, rows, _Keeper(Plan())))
    elif partition.channels:
        looked.append(_open(CHANNELS, {"why": why}))
    return Control((*looked, ownership(partition)), None)
