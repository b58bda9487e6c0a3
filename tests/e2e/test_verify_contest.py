"""Nets of the Model Checking Contest: states, transitions, and most tokens, as its participants found them."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from helpers.explored import Explorers
from pn2code.diagnostics import Diagnostics
from pn2code.net import front

pytestmark = pytest.mark.cc

LARGEST = 5_000
"""States of the nets that are explored here."""


def test_contest_nets(explorers: Explorers, shared: Path) -> None:
    with (shared / "mcc" / "expected.tsv").open(encoding="utf-8") as table:
        rows = list(csv.DictReader(table, delimiter="\t"))
    small = [row for row in rows if int(row["states"]) <= LARGEST]
    assert len(small) > 5
    for row in small:
        d = Diagnostics()
        net = front.load(shared / "mcc" / f"{row['model']}.pnml", d)
        assert net is not None, [e.message for e in d.errors]
        report = explorers.explore(net).report
        assert report["complete"], row
        assert (report["nodes"], report["arcs"]) == (int(row["states"]), int(row["transitions"])), (
            row
        )
        most = max(b["upper"] for b in report["bounds"])
        per_place = int(row["max_tokens_in_a_place"])
        # The contest's places are ours with one colour each.
        counts = [count for b in report["bounds"] for count, _ in b["upper_multiset"]]
        assert most >= per_place and max(counts) == per_place, row
