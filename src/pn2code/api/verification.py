"""State spaces and what they say."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from pn2code.api.errors import playing, refuse
from pn2code.base.deadline import Deadline
from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics
from pn2code.verdict import properties as own
from pn2code.verdict.opened import OpenNet
from pn2code.verdict.whole import MOST_COLOURS, Said, conclude, look, question, stem, trace_folder
from pn2code.verify.answers.properties import Answer, Verdict
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits, cores

INT_BITS = 31
"""Of `int` in the programs of a cell."""


@frozen
class PropertyAnswer:
    """What is known of a property.

    Args:
        name: as in the file of properties; "property 1", ... for those that were given as text.
        text: the property.
        answer: "yes", "no" or "inconclusive".
        is_expected: whether that is what its author expects.
        why: of "inconclusive": the reason.
        value: the number that decides, where there is one: most tokens of a place, the longest wait.
        trace: a run that shows the answer; None: there is none, or the runs are not kept.
        assumes: what a "yes" about a cell rests on besides its states.
    """

    name: str
    text: str
    answer: Verdict
    is_expected: bool
    why: str
    value: float | None
    trace: Path | None
    assumes: tuple[str, ...]


@frozen
class Verification:
    """What a state space says.

    Args:
        verdict: the worst of all answers: "no", "inconclusive" or "yes". Where nothing is asked it is "yes" if all
            markings were seen, and no order of conditions raises an exception.
        is_complete: whether all reachable markings were seen.
        nodes, arcs: of the state space; of an incomplete one those that were seen.
        dead: how many dead markings were seen.
        answers: to properties, in the order in which they were asked.
        report: all of it as plain data: what `pn2code verify --json` prints (docs/verify.md). Of a cell it has the
            checks of its supervisor ("controller") and of its shared files ("medium").
        errors: errors of the net that were met on the way, such as an exception in a reachable marking.
    """

    verdict: Verdict
    is_complete: bool
    nodes: int
    arcs: int
    dead: int
    answers: tuple[PropertyAnswer, ...]
    report: Mapping[str, Any]
    errors: tuple[str, ...]

    def __getitem__(self, name: str) -> PropertyAnswer:
        """The answer to a property, by its name or text.

        Raises:
            KeyError: this was not asked.
        """
        for answer in self.answers:
            if name in (answer.name, answer.text):
                return answer
        asked = ", ".join(f"`{a.name}`" for a in self.answers) or "nothing"
        raise KeyError(f"`{name}` was not asked; asked was {asked}")


def verify(
    opened: OpenNet,
    texts: Sequence[str],
    *,
    max_states: int | None,
    max_seconds: float | None,
    threads: int | None,
    unfold: bool,
    found: bool,
    traces: Path | None,
) -> Verification:
    """Explores and answers; see `Net.verify`."""
    if opened.config is not None and opened.flat.program.int_bits != INT_BITS:
        raise ValueError(
            f"the programs of a cell have integers of {INT_BITS} bits: load it without `int_bits`"
        )
    d = Diagnostics()
    asked = question(opened, texts, None, d, found=found)
    if d.has_errors:
        raise refuse(d)
    limits = Limits(
        max_states=max_states,
        deadline=Deadline.after(max_seconds),
        threads=threads or cores(),
        sweeps=None,
        unfolds=unfold,
    )
    with ExitStack() as stack:
        place = traces or Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="pn2code-")))
        folder = stack.enter_context(trace_folder(place, wanted=True, needed=True))
        options = ExploreOptions(
            traces=folder,
            stem=stem(opened),
            colours=MOST_COLOURS,
            questions=asked.questions,
            predicates=asked.properties.predicates,
            evidence=stack.enter_context(own.unnamed_runs(asked, folder)),
        )
        with playing():
            looked = look(opened, asked, limits, options, folder, d)
        if looked is None:
            raise refuse(d)
        return _told(conclude(looked, opened, asked, limits, folder, d), d, traces is not None)


def _told(said: Said, d: Diagnostics, are_kept: bool) -> Verification:
    return Verification(
        verdict=said.verdict,
        is_complete=said.found.complete,
        nodes=said.found.nodes,
        arcs=said.found.arcs,
        dead=said.found.dead_count,
        answers=tuple(_answer(a, are_kept) for a in said.answers),
        report=said.row(),
        errors=tuple(e.message for e in d.errors),
    )


def _answer(a: Answer, are_kept: bool) -> PropertyAnswer:
    return PropertyAnswer(
        name=a.about.name,
        text=a.about.holds,
        answer=a.answer,
        is_expected=a.is_expected,
        why=a.why,
        value=a.value,
        trace=a.evidence.trace if a.evidence is not None and are_kept else None,
        assumes=a.assumes,
    )
