"""Nets of the Model Checking Contest: states and firings are those that the contest's participants published."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from helpers.pnml_nets import flat, graph, load, unfolded_size
from pn2code.convert import pnml_symmetric
from pn2code.diagnostics import Diagnostics
from pn2code.semantics.values.multiset import MultiSet
from pn2code.unfold.unfold import unfold

PLAYED = (
    "DatabaseWithMutex-COL-02",
    "LamportFastMutEx-COL-2",
    "PhilosophersDyn-COL-03",
    "Sudoku-COL-AN02",
)
"""By the token game, which takes its time."""


@cache
def expected(folder: Path) -> dict[str, tuple[int, ...]]:
    """Name -> states, firings, most tokens of a colour in a place, most in a marking."""
    rows = (folder / "expected.tsv").read_text(encoding="utf-8").splitlines()[1:]
    return {name: tuple(map(int, row)) for name, *row in (r.split("\t") for r in rows)}


@pytest.fixture(scope="module")
def contest(shared: Path) -> Path:
    """The folder of the nets."""
    folder = shared / "mcc"
    if not folder.is_dir():
        pytest.skip(f"no nets of the Model Checking Contest at {folder}")
    return folder


@pytest.mark.parametrize("name", PLAYED)
def test_token_game(name: str, contest: Path) -> None:
    space = graph(load(contest / f"{name}.pnml"))
    assert space.complete
    places = [p for node in space.nodes for p in node.places if isinstance(p, MultiSet)]
    most = max(n for p in places for n in p.counts.values())
    whole = max(sum(len(p) for p in node.places) for node in space.nodes)
    assert (len(space.nodes), len(space.arcs), most, whole) == expected(contest)[name]


def test_all_unfolded(contest: Path) -> None:
    """Every net is read; the small ones have the right size when they are unfolded."""
    explored = 0
    for path in sorted(contest.glob("*.pnml")):
        u = unfold(load(path), Diagnostics())
        assert u is not None and not u.faults
        states, arcs, *_ = expected(contest)[path.stem]
        if arcs * len(u.transitions) < 300_000:
            explored += 1
            assert unfolded_size(u) == (states, arcs), path.stem
    assert explored >= 6


@pytest.mark.parametrize("name", [*PLAYED, "TokenRing-COL-005", "QuasiCertifProtocol-COL-02"])
def test_written_again(name: str, contest: Path, tmp_path: Path) -> None:
    """Successors, products, differences and comparisons survive the way through CPN ML."""
    d = Diagnostics()
    text = pnml_symmetric.emit(load(contest / f"{name}.pnml"), d, title=name)
    assert text is not None, [e.message for e in d.errors]
    u = unfold(flat(text, tmp_path), d)
    assert u is not None
    assert unfolded_size(u) == expected(contest)[name][:2]
