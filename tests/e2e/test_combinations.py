"""A few random nets and cells, asked in combinations of options. `./dev combinations` has them by the hundred."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path
from random import Random

import pytest
from tools.combinations import asked, bed
from tools.combinations.asked import Case
from tools.combinations.bed import Known, judge
from tools.combinations.runs import contradicted
from tools.combinations.subjects import make
from tools.combinations.ways import WHOLE, Way, ways

from helpers.thorough import amount

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]
NET_SEEDS = tuple(range(3, 3 + amount(2, 60)))
CELL_SEEDS = tuple(range(5, 5 + amount(1, 30)))
WORKING = 5
"""A cell whose runs come to their end."""
WITHOUT_START = 7310020
"""A net whose initial marking has a token that is not in its colour set."""


@pytest.mark.parametrize("seed", NET_SEEDS)
def test_all_ways_and_the_token_game_agree_of_nets(seed: int, tmp_path: Path) -> None:
    verdict = judge("small", seed, tmp_path, number=5)
    assert not verdict.wrong
    assert verdict.counts["asked"] == 6


@pytest.mark.parametrize("seed", CELL_SEEDS)
def test_all_ways_and_runs_agree_of_cells(seed: int, tmp_path: Path) -> None:
    verdict = judge("shapes", seed, tmp_path, number=amount(1, 3), runs=amount(1, 2))
    assert not verdict.wrong
    assert verdict.counts["answer yes"] > 0


def test_a_way_that_says_otherwise_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever a limit leaves open is said to be so."""
    ask = Case.ask

    def rash(case: Case, way: Way) -> asked.Answers | None:
        found = ask(case, way)
        if found is None or way is WHOLE:
            return found
        return replace(found, rows=dict.fromkeys(found.rows, "yes"))

    monkeypatch.setattr(Case, "ask", rash)
    verdict = judge("small", NET_SEEDS[0], tmp_path, number=1)
    assert "yes with" in "\n".join(verdict.wrong)


def test_a_net_without_an_initial_marking_is_refused(tmp_path: Path) -> None:
    verdict = judge("anything", WITHOUT_START, tmp_path, number=1)
    assert not verdict.wrong and verdict.counts["refused"] == 1


def test_the_whole_that_breaks_off_is_wrong(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(case: Case, way: Way) -> asked.Answers | None:
        raise RuntimeError(way.name)

    monkeypatch.setattr(Case, "ask", broken)
    verdict = judge("small", NET_SEEDS[0], tmp_path, number=1)
    assert verdict.wrong and verdict.counts["wrong"] == 1


def test_a_false_yes_of_a_cell_is_told_by_its_runs(tmp_path: Path) -> None:
    subject = make("shapes", WORKING, tmp_path)
    told = 'never tokens("Top.Supervisor.Finished") = 1'
    case = Case.read(subject.path, [told, f"ltl {told.replace('never', 'G !')}"])
    assert case is not None
    said = {p.holds: "yes" for p in case.asked.properties.properties}
    counts: Counter[str] = Counter()
    wrong = "\n".join(contradicted(subject, case, said, Random(1), 3, counts))
    assert counts["run finished"] > 0
    assert wrong.count("is yes, but not in a run") == len(said)


def test_what_contradicts() -> None:
    known = Known()
    assert not list(known.add("first", {"a": "yes", "b": "inconclusive", "c": "accepted"}))
    assert not list(known.add("second", {"a": "yes", "b": "no", "c": "no"}))
    assert list(known.add("third", {"a": "no"})) == ["`a`: no with third, yes with first"]
    assert known.answers == {"b": "no", "c": "no"}
    assert list(known.add("fourth", {"ltl G !fires(T, { true })": "yes", "ltl G !fires(T)": "no"}))


def test_ways_are_different() -> None:
    for is_cell in (False, True):
        for is_timed in (False, True):
            names = [
                w.name for w in ways(Random(1), is_cell=is_cell, is_timed=is_timed, number=9999)
            ]
            assert len(set(names)) == len(names) > 20
    assert bed.REFERENCE not in names
