"""The first page of a report, `index.html`: answers, assumptions, commands, runs, traceability, hashes."""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.base.frozen import frozen
from pn2code.dossier.findings import NO, NOTED, OPEN, YES, Chapter, worst
from pn2code.dossier.traceability import Element, by_line
from pn2code.verify.report.html import page

KINDS = {YES: "good", NO: "bad", OPEN: "open", NOTED: "noted"}


@frozen
class Facts:
    """What a report says besides its chapters.

    Args:
        title: name of the cell.
        written: when, as text.
        versions: pairs of what and which.
        subject: name and SHA-256 of each file that the cell consists of.
        results: the same of what was written.
        runs: folders of runs with a replay page.
        elements: of the net, with their code; (): no programs were made.
    """

    title: str
    written: str
    versions: Sequence[tuple[str, str]]
    subject: Sequence[tuple[str, str]]
    results: Sequence[tuple[str, str]]
    runs: Sequence[str]
    elements: Sequence[Element]


def index(chapters: Sequence[Chapter], facts: Facts) -> str:
    """The page as HTML; it leads to the other files of its folder."""
    answers = [f for c in chapters for f in c.findings if c.done.step.verb != "check"]
    assumed: dict[str, list[str]] = {}
    for finding in answers:
        for clause in finding.assumes:
            assumed.setdefault(clause, []).append(finding.about)
    transitions = [e for e in facts.elements if e.kind == "transition"]
    return page(
        "dossier.html.j2",
        ("report.css", "dossier.css"),
        title=facts.title,
        facts=facts,
        chapters=chapters,
        kinds=KINDS,
        verdict=worst([c.answer for c in chapters]),
        bad=_about(chapters, NO),
        unknown=_about(chapters, OPEN),
        assumed=assumed,
        idle=[e for e in transitions if e.occurred and not any(e.occurred)],
        transitions=len(transitions),
        by_line=by_line(facts.elements),
    )


def _about(chapters: Sequence[Chapter], answer: str) -> list[str]:
    """What has this answer: single questions, or a whole command where it has none of them."""
    found: list[str] = []
    for chapter in chapters:
        if chapter.answer in (answer, NO):
            own = [f.about for f in chapter.findings if f.answer == answer]
            name = chapter.done.step.name.lower()
            whole = name + (" (left out)" if chapter.done.code is None else "")
            found += own or ([whole] if chapter.answer == answer else [])
    return list(dict.fromkeys(found))
