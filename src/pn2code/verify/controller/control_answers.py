"""What the explorer's answers to the questions of `control` mean."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.base.whole_file import whole_file
from pn2code.cell.partition import OwnerKind, Partition
from pn2code.semantics.game.token_game import GameError
from pn2code.verify.answers.culprit import culprit
from pn2code.verify.answers.reasons import clause, raised_there
from pn2code.verify.controller.control_types import (
    BLOCKING,
    BOUNDED,
    CAPACITY,
    CHANNELS,
    CONFLUENT,
    FINITE,
    OF_ORDERS,
    OWNERSHIP,
    Check,
    Control,
    Evidence,
    Plan,
)
from pn2code.verify.controller.premises import COUNTED, IN_TURNS
from pn2code.verify.controller.running import Running
from pn2code.verify.controller.running_steps import OWING
from pn2code.verify.exploring.result import Exploration

ORDERS = 4
"""Questions about all orders."""
SCRIPTS, ALONE, MOVING, STILL = 2, 3, 4, 5
"""Rows of the answers about `Moments.sets`, after those about the end and about scripts that stop."""
OTHERS = 6
"""The row after these."""
STRUCTURE = "structure"
"""Why a bound is known: invariants of the net prove it, without any state."""
_MOST_NAMED = 60
"""Transitions of a run that are named."""


def has_own_priorities(partition: Partition) -> bool:
    """Whether priorities of one owner's transitions would hold back another's, as they do not in a cell."""
    return len({t.priority for t in partition.net.transitions}) > 1 and len(partition.owners) > 1


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
    keep: Keeper,
) -> Iterator[Check]:
    """What the explorer's answers to `of_orders` mean; traces that are wanted are moved to where they are kept."""
    finite, bounded, usual, other = _padded(found, rows, ORDERS)
    yield _finite(finite, keep)
    yield _bounded(bounded, keep, plan)
    yield _confluent(usual, other, keep, plan)


def cell_answers(
    partition: Partition,
    found: Exploration,
    rows: Sequence[Mapping[str, Any]],
    plan: Plan,
    keep: Keeper,
    closed: Exploration | None,
) -> Iterator[Check]:
    """The same of `of_cell`, without the properties."""
    channels = len(partition.channels)
    silences = len(keep.running.silences) if keep.running is not None else 0
    count = OTHERS + silences + channels + len(plan.capacities)
    all_rows = _padded(found, rows, count)
    ends, stops, restless, bounds = *all_rows[: SCRIPTS + 1], all_rows[OTHERS:]
    silent_rows, bounds = bounds[:silences], bounds[silences:]
    ending = _stopping(stops, keep) or _restless(restless, keep)
    ending = ending or _blocking(ends, keep, partition)
    shown = next((row for row in silent_rows if row["answer"] == "no"), None)
    if ending.answer == "yes" and shown is not None:  # `settled` says what it means
        ending = replace(ending, evidence=keep.all(shown, BLOCKING))
    yield ending
    bounds = [*known(partition, plan.capacities, bounds, closed, plan.bounds)]
    if partition.channels:
        yield channels_check(partition, bounds[:channels], keep)
    if plan.capacities:
        yield capacities_check(partition, plan.capacities, bounds[channels:], keep)


def known(
    partition: Partition,
    capacities: Mapping[int, int],
    rows: Sequence[Mapping[str, Any]],
    closed: Exploration | None,
    proven: Mapping[int, int],
) -> Iterator[Mapping[str, Any]]:
    """Bounds that are not known of the cell follow from those of a closed net that can do all that the cell can.

    What the structure proves (`proven`) is so of each sequence of firings, whatever priorities and time hold back.
    """
    most = [*((c.place, 1) for c in partition.channels), *capacities.items()]
    bounds = closed.bounds if closed and closed.seen.markings and can_more(partition) else None
    for row, (place, limit) in zip(rows, most, strict=True):
        if row["answer"] == "unknown" and place in proven and proven[place] <= limit:
            yield {"answer": "yes", "value": proven[place], "trace": None, "why": STRUCTURE}
        elif row["answer"] == "unknown" and bounds is not None and bounds[place].upper <= limit:
            yield {"answer": "yes", "value": bounds[place].upper, "trace": None}
        else:
            yield row


def can_more(partition: Partition) -> bool:
    """Whether the closed net can do all that the cell can: neither priorities nor time hold back what others may do."""
    return not has_own_priorities(partition) and not partition.net.timed


def silent(running: Running, rows: Sequence[Mapping[str, Any]]) -> str:
    """Why somebody may owe an answer for too long, by the answers to `of_cell`: it waits for others meanwhile."""
    for silence, row in zip(running.silences, rows[OTHERS:], strict=False):
        if row["answer"] == "no" and silence.unanswered:
            return f"{silence.who} may give no answer: {silence.unanswered}"
        if row["answer"] == "no":
            whom = f" ({', '.join(silence.awaited)})" if silence.awaited else ""
            return (
                f"{silence.who} may have to wait for others{whom} while it owes an answer, and whoever owes one for "
                "longer than `reply_timeout_s` stops the cell; a message whose answer may wait for others, or never "
                'comes, is `kind = "data"` in cell.toml (docs/protocol.md, I8)'
            )
    return ""


def settled(control: Control) -> Control:
    """An end is no certainty where the supervisor stops; and each answer knows what it rests on besides."""
    checks = []
    for check in control.checks:
        if check.name == BLOCKING and check.answer == "yes" and control.stops:
            why = {control.late: "late", control.doubt: "error"}.get(control.stops, "stops")
            check = replace(check, answer="unknown", why=why, says=f"not known: {control.stops}")
        assumes = control.premises.of_check(check.name, check.answer)
        if control.reduced and check.answer == "yes" and check.name != OWNERSHIP:
            assumes = (*assumes, IN_TURNS, *([COUNTED] if control.is_counted else []))
        if control.reduced_orders and check.answer == "yes" and check.name in OF_ORDERS:
            assumes = (*assumes, IN_TURNS, *([COUNTED] if control.counted_orders else []))
        checks.append(replace(check, assumes=assumes))
    return replace(control, checks=tuple(checks))


def drawn(check: Check, why: str) -> Check:
    """What rests on random numbers, or on the number of steps, is one of many outcomes; `why` is the word for that."""
    if check.answer != "yes" or check.name == OWNERSHIP:
        return check
    return replace(unknown(check.name, {"why": why}), value=check.value)


def is_short(rows: Sequence[Mapping[str, Any]], number: int) -> bool:
    """Whether the runs of one of `Moments.sets` are known to be short enough."""
    return len(rows) > number and rows[number]["answer"] == "yes"


def hesitating(check: Check, rows: Sequence[Mapping[str, Any]], keep: Keeper) -> Check:
    """The check of the end, where a script may go round for ever, or the cell do too much in one moment."""
    if check.name != BLOCKING or check.answer != "yes":
        return check
    for number, why in ((ALONE, "commands"), (MOVING, "moments")):
        if not is_short(rows, number):
            open_ = unknown(BLOCKING, {"why": why})
            row = rows[number] if len(rows) > number else {"answer": "unknown"}
            return replace(open_, evidence=keep.all(row, BLOCKING) if row["answer"] == "no" else ())
    return check


def refusal(partition: Partition, found: Exploration, keep: Keeper) -> Check | None:
    """Where a transition raises an exception its program stops (of robots: `refusals`); None: none is known to."""
    index = found.error.get("transition") if found.error else None
    # What holds a robot back (`stops.waits`) may be worked out in the model before the script comes to it.
    if found.error is None or index is None or index >= len(partition.transition_owner):
        return None
    owner = partition.owners[partition.transition_owner[index]]
    trace = found.error_trace
    evidence = keep.all({"trace": trace and trace.file, "loop": None}, BLOCKING)
    by = ""
    if trace is not None:
        exact = keep.culprit(trace.file, index, found.error.get("binding"))
        by = f"`{' '.join(exact.span.text.split())}`" if exact and exact.span else ""
    after = f", {_steps(evidence[0].steps)} after the start" if evidence else ""
    where = f"`{partition.net.transitions[index].name}`{after}"
    if owner.kind is OwnerKind.SUPERVISOR:
        says = (
            f"the supervisor stops in {where}: {raised_there(str(found.error.get('message')), by)}"
        )
    else:
        says = (
            f"the script of {owner.phrase} stops in {where}: an exception, or what no robot can carry out (a time "
            "that is negative, a speed that is not possible, a number that is not finite)"
        )
    says += "; this stops the whole cell"
    t = (partition.net.transitions[index].name,)
    return Check(BLOCKING, "no", says, why="stopped", evidence=evidence, transitions=t)


class Keeper:
    """Reads traces, makes them runs of the cell's net, and moves them to the folder where they are kept."""

    def __init__(self, plan: Plan, running: Running | None) -> None:
        self._plan = plan
        self.running = running

    def last_step(self, row: Mapping[str, Any]) -> str:
        """The name of the last step of a trace, without its head; before it is read."""
        lines = Path(row["trace"]).read_text(encoding="utf-8", errors="surrogateescape").split("\n")
        steps = [x["transition"] for x in map(json.loads, filter(None, lines)) if "transition" in x]
        return str(steps[-1]).removeprefix("cell.")

    def before(self, row: Mapping[str, Any]) -> int:
        """How many of the first steps of a trace, as many as its number says, are occurrences; before it is read."""
        return self._occurrences(row, int(row["value"]))

    def length(self, row: Mapping[str, Any]) -> int:
        """How many steps of a trace are occurrences, before it is read; 0 where there is no trace."""
        is_there = row.get("trace") is not None and self.running is not None
        return self._occurrences(row, None) if is_there else 0

    def _occurrences(self, row: Mapping[str, Any], most: int | None) -> int:
        lines = Path(row["trace"]).read_text(encoding="utf-8", errors="surrogateescape").split("\n")
        steps = [x["transition"] for x in map(json.loads, filter(None, lines)) if "transition" in x]
        assert self.running is not None
        return sum(step in self.running.names for step in steps[:most])

    def evidence(self, row: Mapping[str, Any], name: str) -> Evidence | None:
        """The run of an answer; None: there is none."""
        if row.get("trace") is None or self.running is None:
            return None
        path = Path(row["trace"])
        length, loop = self.running.project(path, row["loop"])
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

    def culprit(
        self, trace: Path, transition: int, binding: Mapping[str, str] | None
    ) -> GameError | None:
        """What raises an exception after a run that has been read; None: the token game does not know."""
        assert self.running is not None
        net = self.running.partition.net
        return culprit(net, self._plan.storage, trace, transition, binding)

    def all(self, row: Mapping[str, Any], name: str) -> tuple[Evidence, ...]:
        """The run of an answer, if there is one."""
        found = self.evidence(row, name)
        return () if found is None else (found,)


def unknown(name: str, row: Mapping[str, Any]) -> Check:
    """A check that was not answered."""
    why = row.get("why")
    return Check(name, "unknown", f"not known: {clause(why or 'not asked')}", why=why)


def _finite(row: Mapping[str, Any], keep: Keeper) -> Check:
    if row["answer"] == "unknown":
        return unknown(FINITE, row)
    if row["answer"] == "yes":
        return Check(FINITE, "yes", "the supervisor always comes to rest")
    evidence = keep.all(row, FINITE)
    round_ = evidence[0].transitions[evidence[0].loop :] if evidence else ()
    ways = f" by repeating {_named(round_)}" if round_ else ""
    says = f"the supervisor can fire for ever{ways}"
    return Check(FINITE, "no", says, evidence=evidence, transitions=tuple(dict.fromkeys(round_)))


def _bounded(row: Mapping[str, Any], keep: Keeper, plan: Plan) -> Check:
    if row["answer"] == "unknown":
        return unknown(BOUNDED, row)
    most = int(row["value"])
    says = f"at most {most:,} firing{'s' * (most != 1)} in one cycle"
    if row["answer"] == "no":
        says += f", but no more than {plan.firings:,} are permitted"
    evidence = keep.all(row, BOUNDED) if row["answer"] == "no" else ()
    return Check(BOUNDED, row["answer"], says, most, evidence=evidence)


def _confluent(
    usual: Mapping[str, Any], other: Mapping[str, Any], keep: Keeper, plan: Plan
) -> Check:
    if usual["answer"] == "unknown":
        return unknown(CONFLUENT, usual)
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
    says = f"{what} {at} step{'s' * (at != 1)} after the start"
    if plan.order_decides:
        says += ', but the documented order is intended, since cell.toml has `order = "documented"`'
        return Check(CONFLUENT, "no", says, at, is_accepted=True, transitions=pair)
    return Check(
        CONFLUENT,
        "no",
        says,
        at,
        evidence=runs,
        transitions=pair,
    )


def _stopping(row: Mapping[str, Any], keep: Keeper) -> Check | None:
    """Whether a robot's script stops, and the cell with it; None: it does not, as far as is known."""
    if row["answer"] != "no":
        return None
    who = keep.last_step(row)
    evidence = keep.all(row, BLOCKING)
    steps = evidence[0].steps if evidence else 0
    after = f"{steps} step{'s' * (steps != 1)} after the start" if steps else "at the start"
    fits = "" if who.endswith(OWING) else ", because none of its transitions is possible there"
    says = f"{after} {who}{fits}; this stops the whole cell"
    return Check(BLOCKING, "no", says, why="stopped", evidence=evidence)


def _restless(row: Mapping[str, Any], keep: Keeper) -> Check | None:
    """Whether a script goes round for long without waiting, which stops it and the cell; None: as `_stopping`."""
    if row["answer"] != "no":
        return None
    evidence = keep.all(row, BLOCKING)
    loop = evidence[0].loop if evidence else None
    round_ = evidence[0].transitions[loop:] if loop is not None else ()
    ways = f" ({_named(round_)})" if round_ else ""
    how = "for ever" if row["value"] is None else f"for {int(row['value']):,} transitions"
    says = f"a script loops {how} without a command or a wait{ways}; this stops the whole cell"
    return Check(BLOCKING, "no", says, why="stopped", evidence=evidence)


def seen_in_turns(check: Check) -> Check:
    """The check of the end says of which states it is."""
    says = check.says.replace("states of the cell", "states of the cell that are seen in turns")
    return replace(check, says=says) if check.name == BLOCKING else check


def _blocking(row: Mapping[str, Any], keep: Keeper, partition: Partition) -> Check:
    if row["answer"] == "unknown" and row.get("why") != "speeds":
        return unknown(BLOCKING, row)
    names = [partition.net.places[p].short for p in partition.final_places]
    final = " or ".join(f"`{n}`" for n in names)
    size = int(row["value"])
    if row["answer"] == "yes":
        how = (
            f"a token in {final} is reached from each of the {size:,} states of the cell, however slow its programs are"
            if names
            else f"something can always happen in the {size:,} states of the cell (no place is final)"
        )
        return Check(BLOCKING, "yes", how, size)
    evidence = keep.all(row, BLOCKING)
    steps = evidence[0].steps if evidence else 0
    after = f"{steps} step{'s' * (steps != 1)} after the start" if steps else "at the start"
    if row["why"] == "speeds":
        says = (
            f"not known: a token in {final} can be reached from each of the {size:,} states of the cell, but from the "
            f"state {after} on, an order of events that depends on durations can keep the cell from it for ever"
        )
        return Check(BLOCKING, "unknown", says, size, "speeds", evidence=evidence)
    if row["why"] == "deadlock":
        without = f", and there is no token in {final}" if names else ""
        says = f"there is a deadlock {after}: nothing can happen{without}"
    else:
        says = f"{after} a token in {final} can no longer be reached, although the cell goes on"
    return Check(BLOCKING, "no", says, size, row["why"], evidence=evidence)


def channels_check(partition: Partition, rows: Sequence[Mapping[str, Any]], keep: Keeper) -> Check:
    """Of the answers for each channel."""
    pairs = list(zip(partition.channels, rows, strict=True))
    wrong = [pair for pair in pairs if pair[1]["answer"] == "no"]
    if wrong:
        # What happens first is the cause: after an overrun the cell would have stopped.
        channel, row = min(wrong, key=lambda pair: keep.length(pair[1]))
        place = partition.net.places[channel.place].name
        most = int(row["value"])
        evidence = keep.all(row, CHANNELS)
        after = f" {_steps(evidence[0].steps)} after the start" if evidence else ""
        says = f"channel `{channel.name}` holds {most} messages{after}"
        return Check(CHANNELS, "no", says, most, evidence=evidence, place=place)
    for _, row in pairs:
        if row["answer"] == "unknown":
            return unknown(CHANNELS, row)
    most = max(int(row["value"]) for _, row in pairs)
    count = len(pairs)
    says = f"at most {most} message in {'each of ' if count > 1 else ''}{count} channel{'s' * (count > 1)}"
    return _bounded_by(CHANNELS, says, most, rows)


def _bounded_by(name: str, says: str, most: int, rows: Sequence[Mapping[str, Any]]) -> Check:
    """A "yes", which may rest on the structure of the net alone."""
    if all(row.get("why") == STRUCTURE for row in rows):
        return Check(name, "yes", f"{says}, by the structure of the net", most, STRUCTURE)
    return Check(name, "yes", says, most)


def capacities_check(
    partition: Partition,
    capacities: Mapping[int, int],
    rows: Sequence[Mapping[str, Any]],
    keep: Keeper,
) -> Check:
    """Of the answers for each place with a capacity."""
    places = partition.net.places
    for (index, bound), row in zip(capacities.items(), rows, strict=True):
        if row["answer"] == "no":
            most = int(row["value"])
            evidence = keep.all(row, CAPACITY)
            after = f" {_steps(evidence[0].steps)} after the start" if evidence else ""
            says = f"place `{places[index].short}` holds {most} tokens{after}, but `[capacity]` declares {bound}"
            return Check(CAPACITY, "no", says, most, evidence=evidence, place=places[index].name)
    for row in rows:
        if row["answer"] == "unknown":
            return unknown(CAPACITY, row)
    most = max(int(row["value"]) for row in rows)
    count = len(rows)
    says = (
        f"all {count} declared capacities are enough"
        if count > 1
        else "the declared capacity is enough"
    )
    return _bounded_by(CAPACITY, says, most, rows)


def _steps(count: int) -> str:
    return f"{count} step{'s' * (count != 1)}"


def _named(transitions: Sequence[str]) -> str:
    some = [f"`{t}`" for t in transitions[:_MOST_NAMED]]
    return ", ".join(some) + (", ..." if len(transitions) > _MOST_NAMED else "")
