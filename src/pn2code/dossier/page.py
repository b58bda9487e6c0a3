"""The first page of a report, `index.html`: answers, assumptions, commands, runs, traceability, hashes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.dossier.findings import NO, NOTED, OPEN, YES, Chapter, worst
from pn2code.dossier.listing import LISTING
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
        pictures: of each run, file and what it shows.
        drawn: anchors in the drawing of the net, by ids.
        elements: of the net, with their code; (): no programs were made.
        left_out: what was not looked at, as it was asked for, and why.
        changed: files of the cell that were changed while the report was made.
    """

    title: str
    written: str
    versions: Sequence[tuple[str, str]]
    subject: Sequence[tuple[str, str]]
    results: Sequence[tuple[str, str]]
    runs: Sequence[str]
    pictures: Mapping[str, Sequence[tuple[str, str]]]
    drawn: Mapping[str, str]
    elements: Sequence[Element]
    left_out: str = ""
    changed: Sequence[str] = ()

    @property
    def leads(self) -> dict[str, str]:
        """Where a link to a result leads: of a folder, to the first of its files in the table of them."""
        found: dict[str, str] = {}
        for name, _ in self.results:
            folder = name
            while "/" in folder:
                folder = folder.rpartition("/")[0]
                found.setdefault(folder, f"#f{self.firsts[name]}")
        return found

    @property
    def firsts(self) -> dict[str, int]:
        """The position of each file in the table of them."""
        return {name: i for i, (name, _) in enumerate(self.results)}


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
        verdict=worst([*(c.answer for c in chapters), *([OPEN] if facts.changed else [])]),
        bad=_about(chapters, NO),
        unknown=_about(chapters, OPEN),
        assumed=assumed,
        moves=any(c.done.step.is_geometry and c.done.code is not None for c in chapters),
        idle=[e for e in transitions if e.occurred and not any(e.occurred)],
        transitions=len(transitions),
        by_line=by_line(facts.elements),
        number={e: i for i, e in enumerate(facts.elements)},
        listing=LISTING,
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
