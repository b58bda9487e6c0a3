"""When markings are forgotten, and what is said of an exploration that has done so."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
import typer

from helpers.netbuilder import flat
from pn2code.cli.verify_sweep import wanted_sweep
from pn2code.net.flat import FlatNet
from pn2code.verify.answers.basis import complete
from pn2code.verify.exploring import sweep
from pn2code.verify.exploring.explorer_process import nothing
from pn2code.verify.exploring.limits import Limits, Reduction
from pn2code.verify.exploring.result import Exploration
from pn2code.verify.exploring.result_rows import row
from pn2code.verify.report.sweep_text import known

SWEPT = {"layers": 4, "most_known": 25, "forgettings": 1, "runs_lost": False}
ANSWERS = ("yes", "no", "unknown")


@pytest.fixture(scope="module")
def net() -> FlatNet:
    return flat("net one\n  standard\n  place A = 1\n")


def found(net: FlatNet, *answers: str, why: str = "memory", **more: Any) -> Exploration:
    """What an exploration has found; it has seen all markings where nothing was in the way."""
    is_whole = why == "complete"
    said = {
        **nothing(net, Limits(), why),
        "complete": is_whole,
        "seen": {"markings": is_whole},
        "queries": [{"answer": a} for a in answers],
        "nodes": 100,
        "arcs": 300,
        **more,
    }
    return Exploration.of(net, said, 0.0)


def test_it_is_wanted_or_not_or_left_open_where_it_goes_with_the_other_options() -> None:
    assert wanted_sweep(None, (), ()) is None
    assert wanted_sweep(True, (Reduction.TIME,), (("--draw", False),)) is True
    assert wanted_sweep(False, (), ()) is False
    assert wanted_sweep(None, (Reduction.SYMMETRY,), ()) is False
    assert wanted_sweep(None, (), (("--draw", True),)) is False


@pytest.mark.parametrize(
    ("reductions", "others", "named"),
    [((Reduction.SYMMETRY,), (), "--reduce symmetry"), ((), (("--draw", True),), "--draw")],
)
def test_what_does_not_go_with_it_is_refused(
    reductions: tuple[Reduction, ...], others: tuple[tuple[str, bool], ...], named: str
) -> None:
    with pytest.raises(typer.BadParameter, match=named):
        wanted_sweep(True, reductions, others)


def test_it_helps_where_memory_alone_was_in_the_way(net: FlatNet) -> None:
    assert sweep.may_help(found(net))
    assert not sweep.may_help(found(net, why="states"))
    assert not sweep.may_help(found(net, seen={"markings": True}))  # the graph has no room
    assert not sweep.may_help(found(net, reductions=["symmetry"]))
    assert not sweep.may_help(found(net, approximate={"kind": "hash"}))


def test_what_a_part_of_the_graph_has_decided_stays(net: FlatNet) -> None:
    first = found(net, "unknown", "no", "unknown")
    again = found(net, "yes", "unknown", "unknown", why="complete", nodes=500, sweep=SWEPT)
    both = sweep.joined(first, again)
    assert (both.complete, both.nodes, both.sweep) == (True, 500, SWEPT)
    assert tuple(a["answer"] for a in both.answers) == ANSWERS
    # Neither has come to an end: what the first one has seen counts.
    less = sweep.joined(first, replace(again, complete=False, why="memory", seen=first.seen))
    assert (less.nodes, less.sweep) == (100, None)


def test_where_the_graph_is_needed_not_all_was_done(net: FlatNet) -> None:
    again = found(net, why="complete", sweep=SWEPT)
    both = sweep.joined(found(net), again, needs_graph=True)
    assert (both.complete, both.why, both.seen.markings) == (False, "memory", True)


def test_it_says_how_many_markings_were_known(net: FlatNet) -> None:
    own = replace(found(net, why="complete", sweep=SWEPT), measure="A + 2 * B")
    assert known(own) == (
        "25 markings (25%) were known at a time, in the order of 4 values of a measure that never becomes smaller "
        "(A + 2 * B); what needs the graph is not known"
    )
    lost = replace(own, sweep={**SWEPT, "runs_lost": True})
    assert "`--spill DIR`" in known(lost)
    long = replace(own, measure=" + ".join(f"Place{i}" for i in range(40)))
    assert known(long).count("Place") < 20
    assert dict(complete(own)) == {
        "Markings": "complete: 100",
        "Arcs": "complete: 300",
        "Components": "not known, since markings were forgotten",
    }
    assert row(net, own)["sweep"] == {**SWEPT, "measure": "A + 2 * B"}


def test_what_was_ended_before_it_said_anything_changes_nothing(net: FlatNet) -> None:
    first = found(net, *ANSWERS)
    late = Exploration.of(net, nothing(net, Limits(), "seconds"), 0.0)
    assert sweep.joined(first, late) is first
