"""One random net or cell: asked in many ways, next to the token game, and to runs of its programs."""

from __future__ import annotations

import shutil
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from random import Random

import pytest
from tools.combinations.asked import KNOWN, Answers, Case
from tools.combinations.runs import contradicted
from tools.combinations.subjects import ANYHOW, PARTS, make, of_parts, questions
from tools.combinations.ways import WHOLE, Way, ways

from pn2code.diagnostics import Diagnostics
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.verdict.opened import read
from pn2code.verify.controller import hunts

REFERENCE = "the token game"
SEARCHES = 1
"""By chance, for each question that a limit leaves open; there are 14 of them else, which takes most of the time."""


@dataclass
class Verdict:
    """What came of it: what is wrong, and counts."""

    wrong: list[str] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)


@dataclass
class Known:
    """What is known of each question, and which way has said it first."""

    said: dict[str, dict[str, str]] = field(default_factory=dict)

    def add(self, name: str, rows: Mapping[str, str]) -> Iterator[str]:
        """Takes answers of a way; gives those that contradict others."""
        for asked, answer in rows.items():
            if answer not in KNOWN:
                continue
            of = self.said.setdefault(asked.replace(ANYHOW, ""), {})
            other = next((a for a in of if a != answer), None)
            if other is not None and answer not in of:
                yield f"`{asked}`: {answer} with {name}, {other} with {of[other]}"
            of.setdefault(answer, name)

    @property
    def answers(self) -> dict[str, str]:
        """By question, what has been said, if it is one thing."""
        return {asked: next(iter(of)) for asked, of in self.said.items() if len(of) == 1}


def judge(family: str, seed: int, folder: Path, *, number: int, runs: int = 0) -> Verdict:
    """Makes it, asks, compares.

    Args:
        family: of `subjects.FAMILIES`.
        seed: of it, and of what is drawn otherwise.
        folder: for its files.
        number: of the ways in which it is asked.
        runs: of the programs of a cell.
    """
    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(hunts, "FURTHER", SEARCHES)
        return _judged(family, seed, folder, number, runs)


def _judged(family: str, seed: int, folder: Path, number: int, runs: int) -> Verdict:
    verdict, r = Verdict(), Random(f"{family} {seed}")
    subject = make(family, seed, folder)
    opened = read(subject.path, {}, Diagnostics())
    about = of_parts if family == PARTS else questions
    texts = [] if opened is None else about(r, opened.flat)
    own = [c.text for c in subject.cell.claims] if subject.cell is not None else []
    case = None if opened is None else Case.read(subject.path, [*own, *texts])
    if case is None or not _begins(case):
        verdict.counts["refused"] += 1
        return verdict
    verdict.counts[family] += 1
    known = Known()
    whole = _ask(case, WHOLE, verdict, known)
    if whole is None:
        verdict.counts["wrong"] += bool(verdict.wrong)
        return verdict
    verdict.counts["questions"] += len(whole.rows)
    reference = case.reference()
    verdict.counts["answers of the token game"] += len(reference)
    verdict.wrong += known.add(REFERENCE, reference)
    timed = case.opened.flat.timed
    for way in ways(r, is_cell=case.is_cell, is_timed=timed, number=number):
        found = _ask(case, way, verdict, known)
        more = [x for x in found.rows if found.rows[x] in KNOWN] if found is not None else []
        verdict.counts["more than of the whole"] += sum(
            whole.rows.get(x) not in KNOWN for x in more
        )
    if subject.cell is not None and runs:
        verdict.wrong += contradicted(subject, case, known.answers, r, runs, verdict.counts)
    verdict.counts["wrong"] += bool(verdict.wrong)
    return verdict


def _begins(case: Case) -> bool:
    """Whether the net has an initial marking: `verify` says of others what is wrong with it."""
    try:
        Game(case.opened.flat, case.opened.storage)
    except GameError:
        return False
    return True


def _ask(case: Case, way: Way, verdict: Verdict, known: Known) -> Answers | None:
    try:
        found = case.ask(way)
    except Exception as error:  # whatever it is, it is to be shown
        verdict.wrong.append(f"{way.name}: {type(error).__name__}: {error}")
        return None
    if found is None:
        verdict.counts["nothing answered"] += 1
        return None
    verdict.counts["asked"] += 1
    verdict.counts["answers"] += len(found.rows)
    verdict.counts.update(f"answer {x}" for x in found.rows.values())
    verdict.wrong += known.add(way.name, found.rows)
    verdict.wrong += (f"{way.name}: {x}" for x in found.errors)
    return found


def keep(folder: Path, to: Path, verdict: Verdict) -> None:
    """The files, with what is wrong."""
    shutil.copytree(folder, to, dirs_exist_ok=True)
    (to / "wrong.txt").write_text("\n".join([*verdict.wrong, ""]), encoding="utf-8")
