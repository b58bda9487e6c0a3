"""The checks of a cell's channel model: docs/protocol.md, "The medium in the model"."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from pn2code.cell.partition import Partition
from pn2code.channel_model.by_cell import Shown
from pn2code.channel_model.check import WHOLE, Answer, Evidence, check_channel_model
from pn2code.channel_model.faults import SAYS
from pn2code.diagnostics import Diagnostics
from pn2code.verdict.controller import LEAST_STATES
from pn2code.verdict.opened import OpenNet
from pn2code.verify.answers import basis
from pn2code.verify.answers.properties import Verdict
from pn2code.verify.answers.reasons import clause
from pn2code.verify.codes import TIME_OVER
from pn2code.verify.controller.control_types import BLOCKING, MESSAGES, Control
from pn2code.verify.controller.premises import Premises
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import COUNTED, Exploration
from pn2code.verify.report import swarm_text

Answers = tuple[Answer, ...]


def look(
    opened: OpenNet,
    partition: Partition,
    found: Exploration,
    limits: Limits,
    options: ExploreOptions,
    d: Diagnostics,
    control: Control | None = None,
) -> Answers:
    """All checks; none for a cell that could not be explored to the end because of an error.

    Args:
        opened: the cell.
        partition: who runs what in it.
        found: its own state space. Where that is too large, that with the medium is as well, and a part is seen.
        limits: of each exploration.
        options: who is told of the progress, and who may interrupt.
        d: gets the errors.
        control: the checks of its supervisor; None: they were not asked.
    """
    assert opened.config is not None, "it has been divided"
    if found.why in ("interrupted", "error") or options.interrupted():
        return ()
    is_small = (
        limits.swarm is not None
        or found.complete
        or found.why in ("decided", "approximation", COUNTED)
    )
    is_open = not is_small and limits.deadline.is_over()
    own = Diagnostics()
    answers = tuple(
        check_channel_model(
            partition,
            opened.storage,
            limits,
            own,
            cell_states=None if is_open else found.nodes,
            # All of it will not be seen where the cell was not, but what is wrong in a part is wrong.
            most=None if is_small else max(found.nodes, LEAST_STATES),
            options=ExploreOptions(progress=options.progress, interrupted=options.interrupted),
            shown=_shown(control),
            running_states=0 if control is None or control.found is None else control.found.nodes,
        )
    )
    # Each answer says itself that the time was over.
    d.items += [i for i in own.items if i.code != TIME_OVER]
    premise = Premises.of(partition, opened.config).replies.premise
    return tuple(_ending(a, control, premise) if a.check == WHOLE else a for a in answers)


def _shown(control: Control | None) -> Shown | None:
    """What the checks of the supervisor say of the files already; None: nothing."""
    if control is None or not control.quiet or control.found is None or control.running is None:
        return None
    if any(c.answer != "yes" for c in control.checks if c.name == MESSAGES):
        return None
    return Shown.of(control.running.net, control.found)


_NOT_LOOKED = "whether programs stop or come too late is for the checks of the supervisor, which were left out"


def _ending(a: Answer, control: Control | None, premise: str) -> Answer:
    """That the cell can come to its end is also for the checks of the supervisor: they know when programs stop."""
    a = replace(a, assumes=f"{a.assumes}; {premise}" if premise else a.assumes)
    if a.answer == "no" or (a.answer != "yes" and a.swarm is None):
        return a
    if control is None:
        return a if a.swarm is not None else replace(a, answer="inconclusive", why=_NOT_LOOKED)
    ends = next(c for c in control.checks if c.name == BLOCKING)
    if ends.answer == "no":
        return replace(a, answer="no", why=f"`{BLOCKING}`: {ends.says}")
    if a.answer != "yes":
        return a
    if control.stops or (ends.answer == "unknown" and ends.why != "speeds"):
        return replace(a, answer="inconclusive", why=control.stops or clause(ends.why or ""))
    return a


def verdict(answers: Answers) -> Verdict:
    """As of properties: one "no" counts, then one that is not known; "yes" where there are none."""
    said = {a.answer for a in answers}
    return "no" if "no" in said else "inconclusive" if "inconclusive" in said else "yes"


def told(answers: Answers) -> str:
    """For people; "" without answers."""
    if not answers:
        return ""
    parts = [" Medium", "-" * 72]
    for a in answers:
        parts += _one(a)
    return "\n".join(parts)


def _one(a: Answer) -> list[str]:
    why = shown(a) if a.answer == "no" else a.why
    lines = [f"  {a.check}: {a.answer}{f' ({why})' if why else ''}", f"    asked: {a.says}"]
    if a.nodes:
        lines.append(f"    {_counts(a)}")
    lines += (f"    {more}" for more in _rests(a))
    lines.append(f"    if {a.assumes}; and what docs/protocol.md says of the file system")
    for e in a.evidence:
        lines.append(f"    {_run(e)}:")
        lines += [f"      {line}" for line in e.lines]
    return lines


def rows(answers: Answers) -> Iterator[dict[str, object]]:
    """For the page."""
    for a in answers:
        remarks = [f"not known: {a.why}"] if a.answer == "inconclusive" else []
        remarks += [f"what fails: {shown(a)}"] if a.answer == "no" else []
        if a.nodes:
            remarks.append(_counts(a))
        yield {
            "name": f"{a.check[:1].upper()}{a.check[1:]}",
            "said": f"{a.says[:1].upper()}{a.says[1:]}.",
            "remarks": [*remarks, *_rests(a), f"if {a.assumes}"],
            "answer": {"inconclusive": "not known"}.get(a.answer, a.answer),
            "kind": {"yes": "good", "no": "bad"}.get(a.answer, "open"),
            "runs": [(_run(e), *e.lines) for e in a.evidence],
        }


def _rests(a: Answer) -> Iterator[str]:
    if a.rests_on is not None:
        yield f"rests on this: {basis.SAYS[a.rests_on]}"


def _counts(a: Answer) -> str:
    if a.swarm is not None:
        return f"{swarm_text.seen(a.swarm)}, {a.seconds:.1f} s"
    space = " of the reduced space" * a.reduced
    return (
        f"{a.nodes:,} markings, {a.arcs:,} arcs{space} of a net with {a.places} places and "
        f"{a.transitions} transitions, {a.seconds:.1f} s"
    )


_NO_END = "a state can be reached from which the cell cannot come to its end"


def shown(a: Answer) -> str:
    """The parts of the question that fail, where the answer is no: by its runs, or by the check that knows of it."""
    found = [_NO_END if e.fault is None else SAYS[e.fault] for e in a.evidence]
    found += [a.why] if a.why else []
    return "; ".join(dict.fromkeys(found))


def _run(e: Evidence) -> str:
    """What a run shows."""
    return (
        "shortest run to a state from which the end cannot be reached"
        if e.fault is None
        else f"shortest run in which {SAYS[e.fault]}"
    )
