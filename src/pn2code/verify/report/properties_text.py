"""The answers to properties as text: one line each, then the runs that show why, told step by step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pn2code.net.flat import FlatNet
from pn2code.semantics.game.token_game import GameError
from pn2code.trace.script import TraceRefusedError
from pn2code.verify.answers import basis, certificates
from pn2code.verify.answers.path import Step, steps, summary
from pn2code.verify.answers.properties import Answer, Evidence
from pn2code.verify.exploring.unfolded import in_words

_RULE = "-" * 72
_MARKS = {"yes": "yes", "no": "NO", "inconclusive": "?"}
_NAME = 28
"""Columns of a name; a longer one has a line of its own."""


def section(answers: Sequence[Answer]) -> str:
    """For the report: a line or two for each property."""
    lines = [" Properties", _RULE]
    for a in answers:
        name = a.about.name
        head = (
            f"     {name.ljust(_NAME)}" if len(name) < _NAME else f"     {name}\n     {'':{_NAME}}"
        )
        lines.append(f"{head}{_MARKS[a.answer]:<4}{said(a)}")
        lines += (f"     {'':{_NAME}}    {more}" for more in remarks(a))
    return "\n".join(lines)


def said(a: Answer) -> str:
    """What the property says: in plain words if there are any."""
    return a.about.says or a.about.holds


def remarks(a: Answer) -> list[str]:
    """What is to be known beside the answer."""
    found = []
    if a.about.says:
        found.append(a.about.holds)
    if a.about.fair and "assuming" not in a.about.holds:
        found.append(f"assuming {', '.join(a.about.fair)}")
    if a.value is not None:
        found.append(f"{_VALUES.get(a.about.kind, 'value')}: {number(a.value)}")
    if a.answer == "inconclusive" and a.why:
        found.append(f"not known: {a.why}")
    if a.about.of_net:
        found.append("about the closed net alone")
    if a.net is not None:
        found.append(f"net: {a.net}{net_run(a)}. {a.net_why}")
    if a.no_run:
        found.append(f"no run: {a.no_run}")
    if a.rests_on is not None:
        played = ", and the token game has played it" if a.evidence and a.evidence.confirmed else ""
        seen = f"{basis.SAYS[a.rests_on]}{played * (a.rests_on == basis.RUN)}"
        found.append(f"rests on this: {'; '.join((seen, *a.assumes))}")
    if a.methods:
        found.append(f"found by {in_words(a.methods)}")
    if a.certificate is not None:
        found.append("certificate, checked in integers:")
        found += (f"  {line}" for line in certificates.lines(a.certificate))
    elif a.rests:
        found.append(f"no certificate: {a.rests}")
    if not a.about.expect and a.answer != "inconclusive":
        found.append("as expected" if a.is_expected else "expected to be false")
    return found


def net_run(a: Answer) -> str:
    """Where the run of the closed net is that shows what is so of that, as it is said behind it."""
    return "" if a.net_evidence is None else f" (run: {a.net_evidence.trace})"


_VALUES = {"bound": "most tokens", "response": "longest wait"}


def number(value: float) -> str:
    """Whole numbers without a point."""
    return f"{value:.0f}" if value == int(value) else f"{value:g}"


def heading(a: Answer) -> str:
    """Of the run that shows an answer."""
    assert a.evidence is not None
    e = a.evidence
    what = "is true" if a.answer == "yes" else "is false"
    if a.answer == "inconclusive":
        what = "is not known"
    length = f"{e.steps} step{'s' * (e.steps != 1)}"
    if e.loop is not None and e.loop < e.steps:
        turns = e.steps - e.loop
        if e.loop == 0:
            length += ", repeated for ever"
        elif turns == 1:
            length += ", of which the last one is repeated for ever"
        else:
            length += f", of which the last {turns} are repeated for ever"
    return f"`{a.about.name}` {what}: {length}, {e.trace}"


def told(net: FlatNet, storage: Mapping[str, str], a: Answer, most: int) -> str:
    """The run, step by step; each step is checked by the token game."""
    assert a.evidence is not None
    try:
        shown = steps(net, storage, a.evidence.trace, most=most)
    except (TraceRefusedError, GameError, OSError) as problem:
        return f"{heading(a)}\n  (it cannot be shown: {problem})"
    return "\n".join([heading(a), *lines(shown, a.evidence)])


def lines(shown: Sequence[Step], evidence: Evidence) -> list[str]:
    """Steps, with the beginning and the end of the cycle."""
    found: list[str] = []
    loop = evidence.loop if evidence.loop is not None else evidence.steps
    for step in shown:
        if step.number == loop + 1:
            found.append("  >>>  the following steps are repeated for ever")
        values = ", ".join(f"{k} = {v}" for k, v in step.binding.items())
        at = f"  @{step.time}" if step.time else ""
        found.append(
            f"  {step.number:>3}  {step.transition}" + (f"  ({values})" if values else "") + at
        )
        found += (f"         {change.place}: {summary(change)}" for change in step.changes)
    if evidence.steps > len(shown):
        found.append(f"  ... {evidence.steps - len(shown)} more steps in the trace")
    elif loop < evidence.steps:
        found.append(f"  <<<  and so on from step {loop + 1}")
    return found
