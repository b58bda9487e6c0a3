"""Durations for people: a table of commands, and the cycle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.timing.answers import Command, Cycle, Layout, seconds_down, seconds_up
from pn2code.timing.doings import NS

MOST_COMMANDS = 25
"""Commands of a table that is not full: those that take longest."""
MOST_NEVER = 8
"""Transitions that are named because they never occur."""
HEAD = ("transition", "command", "least", "most", "slowest from")


def text(layouts: Sequence[Layout], timeout: float, *, full: bool) -> str:
    """The whole report."""
    return "\n".join(line for layout in layouts for line in _lines(layout, timeout, full))


def _lines(layout: Layout, timeout: float, full: bool) -> Iterator[str]:
    where = f"Layout `{layout.name}`: " if layout.name else ""
    yield (
        f"{where}{layout.states:,} states of the cell, {layout.cycle.situations:,} situations with times; "
        f"{len(layout.commands):,} commands"
    )
    if layout.open:
        yield f"  there may be more commands: {layout.open}"
    yield ""
    yield from _table(layout, full)
    yield ""
    for fault in layout.faults:
        yield f"`{fault.transition}` cannot be done from everywhere: {fault.why}"
    yield from _cycle(layout.cycle, timeout)
    yield ""


def _table(layout: Layout, full: bool) -> Iterator[str]:
    commands = layout.commands
    shown: Sequence[Command] = commands
    who = "robot or device" if layout.devices else "robot"
    if not full and len(commands) > MOST_COMMANDS:
        shown = sorted(commands, key=lambda c: -c.most)[:MOST_COMMANDS]
    rows: list[tuple[str, ...]] = [(who, *HEAD), *map(_cells, shown)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        yield "  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)).rstrip()
    if len(shown) < len(commands):
        yield f"... and {len(commands) - len(shown):,} shorter ones (`--full` shows all)"


def _cells(c: Command) -> tuple[str, ...]:
    is_one = c.most == c.least
    return (
        c.robot,
        c.transition.removeprefix("Cell."),
        c.command,
        f"{c.least / NS:.3f} s",
        "" if is_one else f"{c.most / NS:.3f} s",
        "" if is_one else c.most_from,
    )


def _cycle(cycle: Cycle, timeout: float) -> Iterator[str]:
    yield (
        "Cycle, if each command takes its planned time, and messages, sensors, people and the supervisor's "
        "cycles take none (as in `pn2code run`),"
    )
    yield "over all orders that the net permits and all values of sensors:"
    for ending in cycle.endings:
        where = " and ".join(p.rpartition(".")[2] for p in ending.places)
        best = "not known" if ending.least is None else f"{seconds_down(ending.least)} s"
        if ending.most is not None:
            worst = f"{seconds_up(ending.most)} s"
        else:
            worst = "no upper bound" if cycle.repeats else "not known"
        yield f"  to `{where}`: best {best}, worst {worst}"
        for run, which in ((ending.fastest, "a fastest"), (ending.slowest, "a slowest")):
            if run is not None:
                yield f"    {which} run: {run.file or 'it could not be written'}"
    if cycle.why:
        yield f"  not known: {cycle.why}"
    if cycle.repeats:
        yield f"  the cell can repeat {', '.join(f'`{t}`' for t in cycle.repeats)} as often as it likes"
    for other in cycle.others:
        yield f"  not counted: {other}"
    if cycle.never:
        shown = [f"`{name.removeprefix('Cell.')}`" for name in cycle.never[:MOST_NEVER]]
        more = f" and {len(cycle.never) - len(shown)} more" if len(shown) < len(cycle.never) else ""
        yield f"  occurs in none of these runs: {', '.join(shown)}{more}"
    if cycle.at_least is not None:
        stops = " (a belt with a stop may take none)" if cycle.has_stops else ""
        yield (
            f"Whoever comes late: no cycle takes less than {seconds_down(cycle.at_least)} s, if no command takes less "
            f"than its planned time{stops}."
        )
    if cycle.at_most is not None:
        yield (
            f"In whatever order things end: no cycle takes more than {seconds_up(cycle.at_most)} s, if no command "
            "takes more than its planned time, and messages, sensors, people and the supervisor none."
        )
    yield (
        f"A run that a fault stops is no cycle: a collision, a move that cannot be done, an answer later than "
        f"reply_timeout_s ({timeout:g} s)."
    )
