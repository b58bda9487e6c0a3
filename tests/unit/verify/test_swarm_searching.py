"""A swarm whose searches are told, not carried out: its report depends on their numbers alone."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from helpers.netbuilder import flat
from pn2code.base.deadline import Deadline
from pn2code.diagnostics import Diagnostics
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.programs import Generated
from pn2code.verify.swarm import searching
from pn2code.verify.swarm.merging import UNKNOWN
from pn2code.verify.swarm.plan import DEPTHS, Search
from pn2code.verify.swarm.pool import Swarm
from pn2code.verify.swarm.task import Job

NET = """
    net N
      colset U = unit;
      place P : U = 1`()
      trans T
        in P : ()
        out P : ()
"""
OPEN = {"answer": "unknown", "why": "states", "trace": None, "steps": None, "value": None}
SHOWN = {**OPEN, "answer": "no", "why": None, "trace": "query-0.trace.jsonl", "steps": 1}


def said(number: int, *answers: Mapping[str, Any], **more: Any) -> dict[str, Any]:
    """What a search says, with its number as what it has seen."""
    return {
        "said": {
            "error": None,
            "nodes": 10 + number,
            "expanded": 10 + number,
            "arcs": 20,
            "depth": number,
            "bytes_per_state": 1.0,
            "peak_mib": 5,
            "fired": [number],
            "bounds": [{"lower": 1 - number % 2, "upper": number}],
            "dead_count": 0,
            "reductions": [],
            "queries": list(answers),
            "swarm": {"sketch": [number, 1 << 60], "occupancy": 0.25, "dead_trace": None},
            **more,
        },
        "files": {
            f"query-{i}.trace.jsonl": b"run %d" % number for i, a in enumerate(answers) if a["trace"]
        },
    }  # fmt: skip


class Told:
    """A pool in which searches come to their end in a given order; those that are ended say nothing."""

    is_here = True
    workers = 3

    def __init__(self, found: Sequence[Mapping[str, Any]], order: Sequence[int]) -> None:
        self.found, self.order = found, order
        self.ended: list[tuple[int, bool]] = []

    def start(self, d: Diagnostics, deadline: Deadline) -> bool:
        return True

    def results(
        self, job: Job, searches: Sequence[tuple[str, ...]]
    ) -> Iterator[tuple[int, dict[str, Any]] | None]:
        for number in self.order:
            yield None
            is_wanted = all(number < first for first, _ in self.ended)
            yield number, dict(self.found[number]) if is_wanted else {"said": None, "problem": ""}

    def end(self, first: int, *, gently: bool) -> None:
        self.ended.append((first, gently))


def searched(
    pool: Told, folder: Path, d: Diagnostics | None = None, **options: Any
) -> dict[str, Any]:
    d = d or Diagnostics()
    own = ExploreOptions(stem="N", traces=folder, evidence=folder, ending=(0,), **options)
    found = searching.search(
        flat(NET), Path("program"), Generated(), [], own, Limits(), Swarm(len(pool.found), pool), d
    )
    assert found is not None, [e.message for e in d]
    found["seconds"] = 0.0
    return found


def test_each_order_gives_the_same(tmp_path: Path) -> None:
    """The violation with the least number counts, and nothing behind it, also where others were there before."""
    found = [said(0, OPEN), said(1, OPEN), said(2, SHOWN), said(3, SHOWN)]
    reports = []
    for order in itertools.permutations(range(4)):
        reports.append(searched(Told(found, order), tmp_path))
        assert (tmp_path / "N.query-0.trace.jsonl").read_bytes() == b"run 2"
        assert len(list(tmp_path.iterdir())) == 1
    assert all(r == reports[0] for r in reports)
    first = reports[0]
    assert (first["why"], first["nodes"], first["fired"]) == ("swarm", 12, [3])
    assert (first["queries"][0]["answer"], first["queries"][0]["steps"]) == ("no", 1)
    assert (first["swarm"]["searches"], first["swarm"]["counted"]) == (4, 3)
    assert first["bounds"][0]["lower"] == 0 and first["bounds"][0]["upper"] == 2


def test_those_behind_a_violation_are_ended(tmp_path: Path) -> None:
    pool = Told([said(i, SHOWN if i == 1 else OPEN) for i in range(4)], (1, 0, 2, 3))
    searched(pool, tmp_path)
    assert pool.ended[0] == (2, False)


@pytest.mark.parametrize("answer", ["yes", "no"])
def test_what_no_run_shows_is_not_known(tmp_path: Path, answer: str) -> None:
    """That nothing was found is no answer, whatever a search says; nor is a violation without its run."""
    claimed = {**OPEN, "answer": answer, "why": None}
    found = searched(Told([said(0, claimed), said(1, OPEN)], (1, 0)), tmp_path)
    assert found["queries"] == [UNKNOWN]
    assert not found["complete"] and found["swarm"]["counted"] == 2


def test_an_exception_ends_it_with_its_run(tmp_path: Path) -> None:
    trace = {"node": 0, "file": "error-0.trace.jsonl", "steps": 3}
    error = {"kind": "exception", "message": "Div", "node": None, "transition": 0, "trace": trace}
    raised = said(1, OPEN, error=error)
    raised["files"] = {"error-0.trace.jsonl": b"way"}
    found = searched(Told([said(0, OPEN), raised, said(2, SHOWN)], (2, 1, 0)), tmp_path)
    assert found["why"] == "error" and found["queries"][0]["answer"] == "unknown"
    assert Path(found["error"]["trace"]["file"]).read_bytes() == b"way"


def test_a_place_that_is_full_counts_by_its_number_too(tmp_path: Path) -> None:
    full = {"kind": "capacity", "place": 0, "message": "", "transition": None}
    for order in itertools.permutations(range(3)):
        found = searched(
            Told([said(0, OPEN), said(1, OPEN, error=full), said(2, SHOWN)], order), tmp_path
        )
        assert found["error"] == full


def test_interrupted(tmp_path: Path) -> None:
    """What was found until then is told."""
    pool = Told([said(0, OPEN), said(1, OPEN)], (0, 1))
    found = searched(pool, tmp_path, interrupted=lambda: True)
    assert found["why"] == "interrupted" and (0, True) in pool.ended
    assert found["nodes"] == 0


def test_a_search_that_fails_is_an_error(tmp_path: Path) -> None:
    d = Diagnostics()
    lost = {"said": None, "problem": "the explorer ended by signal 9"}
    options = ExploreOptions(stem="N", traces=tmp_path, evidence=tmp_path)
    pool = Told([said(0), lost], (1, 0))
    swarm = Swarm(2, pool)
    found = searching.search(flat(NET), Path("p"), Generated(), [], options, Limits(), swarm, d)
    assert found is None
    assert [e.code for e in d.errors] == ["explorer-failed"]
    assert "search 1 of the swarm" in d.errors[0].message


def test_a_violation_before_it_counts_all_the_same(tmp_path: Path) -> None:
    lost = {"said": None, "problem": "killed"}
    for order in itertools.permutations(range(3)):
        d = Diagnostics()
        found = searched(Told([said(0, OPEN), said(1, SHOWN), lost], order), tmp_path, d)
        assert found["queries"][0]["answer"] == "no" and not d.errors


def test_dead_markings_of_walks_are_counted_once(tmp_path: Path) -> None:
    found = searched(
        Told([said(0, OPEN, dead_count=2), said(1, OPEN, dead_count=9)], (0, 1)), tmp_path
    )
    assert found["dead_count"] == 2


def test_the_first_run_to_each_goal_is_kept(tmp_path: Path) -> None:
    told = [said(i, OPEN, dead_count=1) for i in range(3)]
    for number in (1, 2):
        trace = {"node": 0, "file": "dead-0.trace.jsonl", "steps": number}
        told[number]["said"]["swarm"]["dead_trace"] = trace
        told[number]["files"] = {"dead-0.trace.jsonl": b"dead %d" % number}
    found = searched(Told(told, (2, 1, 0)), tmp_path)
    (run,) = tmp_path.iterdir()
    assert found["traces"] == [{"node": 0, "file": str(run), "steps": 1}]
    assert (run.name, run.read_bytes()) == ("N.dead-0.trace.jsonl", b"dead 1")


def test_the_number_decides_all_about_a_search() -> None:
    many = [Search.of(i) for i in range(40)]
    assert len({s.seed for s in many}) == 40 and 0 not in {s.seed for s in many}
    assert {(s.is_walk, s.depth) for s in many[:8]} == {
        (w, d) for w in (True, False) for d in DEPTHS
    }
    assert many[3].arguments() == Search.of(3).arguments()
    # Successors as they are found, or the other way round, are no order by chance.
    assert all(int(s.arguments()[3]) > 1 for s in many if not s.is_walk)
