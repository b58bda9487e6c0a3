"""What `pn2code verify --full` prints: the report of CPN Tools, all answers, all runs step by step."""

from __future__ import annotations

from contextlib import suppress

from pn2code.base.deadline import TimeIsOverError
from pn2code.cli.verify_closing import durations_of, ending
from pn2code.cli.verify_ends import why_it_ends
from pn2code.cli.verify_sizes import growing_lines
from pn2code.semantics.game.token_game import GameError
from pn2code.trace.script import TraceRefusedError
from pn2code.verdict import channel_model
from pn2code.verdict.whole import Said
from pn2code.verify.answers.outcome import does, error_text
from pn2code.verify.answers.path import steps, text
from pn2code.verify.exploring.result import Exploration, Trace
from pn2code.verify.report import control_text
from pn2code.verify.report.properties_text import told
from pn2code.verify.report.text import report

SHOWN_STEPS = 40
"""Of a longer run only the first steps are printed with `--full`."""


def full(said: Said) -> str:
    """The report, then all runs."""
    net, found = said.net, said.found
    is_explored = found.unfolded is None or not found.unfolded.is_alone
    parts = [
        report(net, found, None, said.answers, said.control, said.counts).rstrip(),
        *([_figures(found)] if is_explored else ()),
        *(f"Perhaps {line}" for line in growing_lines(net, found)),
    ]
    with suppress(TimeIsOverError), said.deadline.enforced():
        for a in said.answers:
            if a.evidence is not None:
                is_deadlock, e = a.about.kind == "deadlock", a.evidence
                end = [] if e.loop is not None else why_it_ends(said, e.trace, is_deadlock)
                parts.append("\n".join([told(net, said.storage, a, SHOWN_STEPS), *end]))
        if said.control is not None:
            texts = control_text.told(net, said.storage, said.control, most=SHOWN_STEPS)
            for (check, run, _), text_ in zip(control_text.runs(said.control), texts, strict=True):
                assert run.file is not None
                is_deadlock = check.why == "deadlock"
                end = [] if run.loop is not None else why_it_ends(said, run.file, is_deadlock)
                parts.append("\n".join([text_, *end]))
        for trace in found.traces:
            parts.append(_told(said, trace, trace.dead))
        if found.error_trace is not None:
            goal = found.error_trace.raising
            path = _told(said, found.error_trace, goal)
            parts.append(f"{path}\n  then {error_text(net, found)}")
        orders = found.orders.raised if found.orders is not None else None
        if orders is not None and orders.trace is not None:
            path = _told(said, orders.trace, f"marking {orders.node}, where CPN Tools may stop")
            parts.append(f"{path}\n  then `{orders.text}` {does(orders)}")
    if said.channel_model:
        parts.append(channel_model.told(said.channel_model))
    timed = "\n".join(durations_of(said)).strip("\n")
    if said.geometry is not None:
        parts.append(f"Arms in space\n\n{said.geometry.text.rstrip()}")
    return "\n\n\n".join([*parts, *([timed] if timed else ()), ending(said)])


def _told(said: Said, trace: Trace, goal: str) -> str:
    head = f"{'Shortest run' if trace.node else 'Run'} to {goal}: {trace.steps} steps, {trace.file}"
    try:
        shown = steps(said.net, said.storage, trace.file, most=SHOWN_STEPS)
    except (TraceRefusedError, GameError, OSError) as problem:
        return f"{head}\n  (it cannot be shown: {problem})"
    end = [] if trace not in said.found.traces else why_it_ends(said, trace.file, False)
    return "\n".join([head, *([text(shown, trace.steps)] if trace.steps else ()), *end])


def _figures(found: Exploration) -> str:
    partial = "" if found.complete else " TRUNCATED, see above."
    if found.why == "decided":
        partial = " Ended early, see above."
    return (
        f"{found.nodes:,} markings and {found.arcs:,} arcs{' of the reduced space' * found.is_reduced} "
        f"in {found.seconds:.2f} s "
        f"({found.states_per_second:,.0f} markings/s, {found.threads} thread{'s' * (found.threads > 1)}), "
        f"{found.bytes_per_state:.1f} bytes a marking, {found.peak_mib:.0f} MiB at most; "
        f"compiled in {found.compile_seconds:.1f} s.{partial}"
    )
