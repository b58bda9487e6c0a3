"""Texts of multi-set bounds are made within a deadline, once for all that prints them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from helpers.netbuilder import flat
from pn2code.base.deadline import Deadline
from pn2code.verify.exploring import result
from pn2code.verify.exploring.explorer_process import nothing
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import Bounds, Exploration
from pn2code.verify.exploring.result_rows import bounds_rows, written

NET = """
net N
  standard
  page Top
    place A : INT = 1`0
"""
COLOURS = tuple((1, i) for i in range(5_000))


def explored() -> Exploration:
    net = flat(NET)
    found = Exploration.of(net, nothing(net, Limits(), "complete"), 0.0)
    return replace(found, bounds=(Bounds(0, 5_000, (), COLOURS),))


def ticking() -> Deadline:
    """Over after ten looks at the clock."""
    looks = iter(range(1_000))
    return Deadline(10.0, 10.0, lambda: float(next(looks)))


def test_the_clock_is_looked_at_while_texts_are_made() -> None:
    net = flat(NET)
    (row,) = bounds_rows(net, written(net, explored(), ticking(), 200))
    assert row["upper_multiset"].count("`") == 200 and row["upper_cut"] == 5_000


def test_texts_are_made_once(monkeypatch: pytest.MonkeyPatch) -> None:
    net = flat(NET)
    told = written(net, explored(), Deadline.after(None), 200)
    monkeypatch.setattr(result, "multiset_text", lambda *_: pytest.fail("made again"))
    (row,) = bounds_rows(net, told)
    assert row["upper_multiset"].count("`") == 5_000 and row["upper_cut"] is None
