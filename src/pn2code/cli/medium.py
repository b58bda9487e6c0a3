"""The checks of a cell's medium in `pn2code verify`: docs/protocol.md, "The medium in the model"."""

from __future__ import annotations

import html
from collections.abc import Sequence

from pn2code.cell.divide import divide
from pn2code.cli.nets import OpenNet
from pn2code.cli.options import Exit
from pn2code.diagnostics import Diagnostics
from pn2code.medium.check import Answer, medium
from pn2code.medium.faults import SAYS
from pn2code.verify.explore import Wishes
from pn2code.verify.limits import Limits
from pn2code.verify.result import Exploration

Answers = tuple[Answer, ...]


def look(
    opened: OpenNet,
    found: Exploration,
    limits: Limits,
    wishes: Wishes,
    d: Diagnostics,
) -> Answers:
    """All checks; none for a net that is no cell, or that could not be explored to the end because of an error.

    Args:
        opened: the net.
        found: its own state space. Where that is too large, that with the medium is as well.
        limits: of each exploration.
        wishes: who is told of the progress, and who may interrupt.
        d: gets the errors.
    """
    if opened.config is None or found.why in ("interrupted", "error") or wishes.interrupted():
        return ()
    partition = divide(opened.flat, opened.config, d)
    if partition is None:
        return ()
    is_small = found.complete or found.why == "decided"
    answers = medium(
        partition,
        opened.storage,
        limits,
        d,
        cell_states=found.nodes if is_small else None,
        wishes=Wishes(progress=wishes.progress, interrupted=wishes.interrupted),
    )
    return tuple(answers)


def code(answers: Answers) -> int:
    """As of properties: one "no" counts, then one that is not known."""
    said = {a.answer for a in answers}
    if "no" in said:
        return Exit.MODEL
    return Exit.INCONCLUSIVE if "inconclusive" in said else Exit.OK


def told(answers: Answers) -> str:
    """For people; "" without answers."""
    if not answers:
        return ""
    parts = [" Medium", "-" * 72]
    for a in answers:
        parts += _one(a)
    return "\n".join(parts)


def _one(a: Answer) -> list[str]:
    why = f" ({a.why})" if a.why else ""
    lines = [f"  {a.check}: {a.answer}{why}", f"    {a.says}"]
    if a.nodes:
        lines.append(
            f"    {a.nodes:,} markings, {a.arcs:,} arcs of a net with {a.places} places and "
            f"{a.transitions} transitions, {a.seconds:.1f} s"
        )
    lines.append(f"    if {a.assumes}; and what docs/protocol.md says of the file system")
    for e in a.evidence:
        what = "a deadlock" if e.fault is None else SAYS[e.fault]
        lines.append(
            f"    shortest run in which {what}:" if e.fault else f"    shortest run to {what}:"
        )
        lines += [f"      {line}" for line in e.lines]
    return lines


def added(body: str, page: bool, answers: Answers) -> str:
    """A report with the answers at its end."""
    text = told(answers)
    if not text:
        return body
    if not page:
        return f"{body.rstrip()}\n\n\n{text}\n"
    part = f"<h2>Medium</h2>\n{_table(answers)}"
    head, mark, tail = body.rpartition("</body>")
    return f"{head}{part}\n{mark}{tail}" if mark else f"{body}\n{part}"


def _table(answers: Sequence[Answer]) -> str:
    """The answers in HTML."""
    rows = ["<tr><th>check</th><th>answer</th><th>says</th><th>markings</th><th>assumes</th></tr>"]
    for a in answers:
        cells = (a.check, a.answer, a.says, f"{a.nodes:,}", a.assumes)
        rows.append("<tr>" + "".join(f"<td>{html.escape(c)}</td>" for c in cells) + "</tr>")
    runs = [f"<pre>{html.escape(chr(10).join(e.lines))}</pre>" for a in answers for e in a.evidence]
    return "<table>\n" + "\n".join(rows) + "\n</table>\n" + "\n".join(runs)
