"""What `pn2code verify` prints without `--full`: one screen with sizes, what failed and the way there, the verdict.

print(screen(said))      # at most about 40 lines
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from pn2code.cli.verify_answers import (
    counted_premises,
    counts_of,
    items_of,
    premises_of,
    wrong_lines,
)
from pn2code.cli.verify_closing import NOTE, closing, durations_of, in_space_of
from pn2code.cli.verify_rows import WIDTH
from pn2code.cli.verify_run import run_lines
from pn2code.cli.verify_sizes import as_it_runs, counted_remarks, crowd_of, sizes_of
from pn2code.verdict.whole import Said
from pn2code.verify.answers import outcome

MOST_LINES = 40
"""Of one screen."""
LEAST_REASONS = 16
"""Lines of what is wrong with arms in space that are shown in any case."""
LEAST_WAY = 12
"""Lines that a run gets before further failures do: its head, steps, and why it goes on no more."""
_MORE = "`--full` prints the whole report, `--report FILE` writes it (.html or .txt)."


def _cut(lines: Sequence[str], room: int) -> list[str]:
    """As many lines as there is room for; what is left out is said."""
    shown = [
        line
        for text_ in lines
        for line in (textwrap.wrap(text_, WIDTH, subsequent_indent="  ") or [""])
    ]
    if len(shown) <= room:
        return shown
    left = len(shown) - room + 1
    return [*shown[: room - 1], f"... and {left} lines more (`--full`)"]


def screen(said: Said) -> str:
    """The verdict, sizes, what failed, and the way there."""
    closed = ", as a closed net" if said.control is not None else ""
    lines = [f"State space of {said.net.file}{closed}", ""]
    head = outcome.header(said.net, said.found, said.counts)
    if head:
        lines += [*textwrap.wrap(f"PARTIAL: {head}", WIDTH), ""]
    lines += [*sizes_of(said), *crowd_of(said)]
    remarks = list(as_it_runs(said))
    items = tuple(items_of(said))
    wrong = sorted((i for i in items if i.kind != "good"), key=lambda i: i.kind != "bad")
    counts = ["", *counts_of(said)] if items else []
    premises, timed = list(premises_of(said)), [*durations_of(said), *in_space_of(said)]
    end = ["", *textwrap.wrap(_MORE, WIDTH)]
    for note in said.notes:
        end += textwrap.wrap(f"{NOTE}{note}", WIDTH, subsequent_indent="  ")
    end += textwrap.wrap(closing(said), WIDTH)
    has_run = any(i.file is not None or i.lines for i in wrong) or said.found.error_trace
    kept = LEAST_WAY + 1 if has_run else 0
    room = MOST_LINES - len(lines) - len(counts) - len(timed) - len(end) - 1 - kept
    if any(i.kind == "bad" for i in wrong):
        # What failed comes before what the other answers rest on, and before remarks.
        needed = len(wrong_lines(wrong, MOST_LINES))
        if needed > room - len(premises) - len(remarks):
            premises = list(counted_premises(said))
        if needed > room - len(premises) - len(remarks):
            remarks = list(counted_remarks(said))
    room -= len(premises) + len(remarks)
    lines += [*remarks, *counts, *premises, *timed]
    if wrong:
        lines += ["", *wrong_lines(wrong, room)]
    room = MOST_LINES - len(lines) - len(end) - 1
    path = run_lines(said, wrong, room)
    if path:
        lines += ["", *path]
    if said.geometry is not None:
        room = MOST_LINES - len(lines) - len(end) - 1
        lines += _cut(said.geometry.reasons, max(room, LEAST_REASONS))
    return "\n".join([*lines, *end])
