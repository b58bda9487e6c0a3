"""The one run that is shown on one screen: its last steps, and why nothing can occur then."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from contextlib import suppress
from itertools import islice
from pathlib import Path

from pn2code.base.deadline import TimeIsOverError
from pn2code.cli.verify_answers import Item
from pn2code.cli.verify_ends import MOST_STEPS, after_that, why_all_disabled
from pn2code.cli.verify_rows import WIDTH, count_of
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.report import element
from pn2code.semantics.game.token_game import GameError
from pn2code.trace.script import Trace as Recorded
from pn2code.trace.script import TraceRefusedError
from pn2code.verdict.whole import Said
from pn2code.verify.answers.outcome import does, error_text, may_stop
from pn2code.verify.answers.path import Step, play

LAST_STEPS = 8
"""Of the run that is told on one screen the last ones: what they lead to is what matters."""
LEAST_STEPS = 3
"""Of it are always there, whatever else the screen has to say."""
LEAST_WHY = 6
"""Lines that tell why nothing can occur after it, if there is so much to tell."""


def run_lines(said: Said, wrong: Sequence[Item], room: int) -> list[str]:
    """The last steps of one run: of the exception, of the first failure, or to the first dead marking."""
    found = said.found
    # Where there is no room for the least of a run, the screen is longer.
    most = max(min(LAST_STEPS, room - 2), LEAST_STEPS)
    if found.error_trace is not None:
        lines = _last(said, found.error_trace.file, "to the exception", most - 1)
        return [*lines, f"  then {error_text(said.net, found)}"]
    orders = found.orders.raised if found.orders is not None and may_stop(found) else None
    if orders is not None and orders.trace is not None and all(i.kind != "bad" for i in wrong):
        lines = _last(said, orders.trace.file, "to where CPN Tools may stop", most - 1)
        return [
            *lines,
            f"  then `{orders.text}` {does(orders)}",
        ]
    for item in wrong:
        if item.file is not None:
            what = f"for `{item.name}`"
            return _last(said, item.file, what, most, item.loop, is_deadlock=item.is_deadlock)
        if item.lines:
            before = len(item.lines) - most
            cut = [f"  ... {count_of(before, 'line')} before; `--full` prints them all"]
            shown = [f"  {x}" for x in item.lines[-most:]]
            return [f"The run for `{item.name}`:", *(cut if before > 0 else ()), *shown]
    if found.traces and not wrong and not said.answers and said.control is None:
        trace = found.traces[0]
        return _last(said, trace.file, f"to {trace.dead}", most)
    return []


def _last(
    said: Said,
    file: Path,
    goal: str,
    most: int,
    loop: int | None = None,
    *,
    is_deadlock: bool = False,
) -> list[str]:
    """The last steps of a run, at least `LEAST_STEPS`, and why nothing can occur then: about `most` lines."""
    why: list[str] = []
    try:
        with said.deadline.enforced():
            game, played = play(said.net, said.storage, file)
            shown = [_step(step) for step, _ in islice(played, MOST_STEPS)]
            if len(shown) == MOST_STEPS:
                shown = _recorded(said, file)
            elif loop is None:
                with suppress(GameError):  # an inscription raises an exception there
                    why = why_all_disabled(
                        said, game, is_deadlock, max(most - LEAST_STEPS - 1, LEAST_WHY)
                    )
    except TimeIsOverError:
        return [f"The run {goal} is in {file}; there was no time to show it."]
    except (TraceRefusedError, GameError, OSError) as problem:
        return [f"The run {goal} is in {file}; it cannot be shown: {problem}"]
    lines = [f"The run {goal}, {count_of(len(shown), 'step')}, {file}:"]
    least = min(LEAST_STEPS, len(shown))
    after = [
        part
        for x in after_that(why)
        for part in textwrap.wrap(
            x, WIDTH, subsequent_indent="      ", break_long_words=False, break_on_hyphens=False
        )
    ]
    last = max(most - len(after), least)
    if len(shown) > last:
        lines.append(f"  ... {count_of(len(shown) - last, 'step')} before")
    lines += shown[-last:] if last else ()
    lines += after
    if loop is not None and loop < len(shown):
        lines.append(f"  The steps from step {loop + 1} on are repeated for ever.")
    return lines if len(lines) > 1 else []


def _step(step: Step) -> str:
    return _line(step.number, step.transition, step.binding)


def _line(number: int, transition: str, binding: Mapping[str, str]) -> str:
    values = ", ".join(f"{k} = {v}" for k, v in binding.items())
    return _cut(f"  {number:>3}  {transition}" + (f"  ({values})" if values else ""))


def _recorded(said: Said, file: Path) -> list[str]:
    """The steps of a run as the file has them, without playing it."""
    found = []
    for number, step in enumerate(Recorded.open(file, said.net, is_shown=True).steps(), 1):
        played = element(said.net, BindingElement.make(step.transition, step.bound))
        found.append(_line(number, step.transition.name, played["binding"]))
    return found


def _cut(line: str) -> str:
    return line if len(line) <= WIDTH else f"{line[: WIDTH - 3]}..."
