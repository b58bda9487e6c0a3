"""Devices that move beside each other, over all that their nets permit: what is said of them, next to their runs."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest
from tools.geometry.__main__ import looked, strolled

from helpers.geometry_told import Told, tell
from helpers.moving_cells import cell_of, moving_cell, numbers_of
from helpers.netbuilder import cpn
from helpers.thorough import amount

pytestmark = pytest.mark.bullet
FINE, TURNING = 5, 7
"""Random cells: one in which all is well, and one of which that is not known."""
NUMBERS = numbers_of(Random(3)) | {
    "LONG": "1.2", "TX": "0.9", "TY": "-0.3", "TZ": "0.5", "TR": "0.2", "OX": "0.9", "OY": "-0.3", "OZ": "0.576",
    "SPOT": "900.0, ~300.0", "TOP": "653.0", "FIRST": "90.0", "STOP": '\nstop = "infeed"\n', "EX": "-0.9",
}  # fmt: skip


def written(folder: Path, net: str, toml: str) -> Path:
    folder.mkdir()
    (folder / "cell.cpn").write_bytes(cpn(net))
    (folder / "cell.toml").write_text(toml)
    return folder


@pytest.mark.parametrize("seed", [FINE, *range(200, 200 + amount(0, 150))])
def test_no_walk_contradicts_a_yes(seed: int, tmp_path: Path) -> None:
    cell = written(tmp_path / "cell", *moving_cell(Random(seed)))
    found = looked(cell, tmp_path / "runs")
    assert found.answer == "yes" or seed != FINE
    if found.answer == "yes":
        assert not strolled(cell, found.layouts[0][1], seed, amount(1, 8))


def test_what_is_not_known_says_who_and_where(tmp_path: Path) -> None:
    told = tell(written(tmp_path / "cell", *moving_cell(Random(TURNING))), tmp_path / "runs")
    layout = told.layout
    assert layout["answer"] == "unknown" and layout["open"]
    for where in layout["open_at"]:
        assert len(where["owners"]) == len(where["transitions"]) == where["run"]["under_way"]
        assert Path(where["run"]["trace"]).is_file() and "at (" in where["says"] and where["do"]
    said = told.command().stdout
    transitions = [" and ".join(f"`{t}`" for t in x["transitions"]) for x in layout["open_at"]]
    assert transitions and all(f"\nnot known: {names} (" in said for names in transitions)


@pytest.fixture(scope="module")
def beside(tmp_path_factory: pytest.TempPathFactory) -> Told:
    """The arm comes with a part where the operator puts one and takes it away again: nobody waits for the other one."""
    away = "line (at (SPOT, 900.0))"
    tasks = (
        ("F", "feed (); bring ()", ()),
        ("O", "put (); ()", ()),
        ("O", "clear (); ()", ()),
        ("A", "goTo (at (0.0, ~900.0, 900.0)); line (at (0.0, ~900.0, 652.0)); grip (); "
              "line (at (0.0, ~900.0, 900.0)); goTo (at (SPOT, 900.0))", ()),
        ("A", f"line (at (SPOT, TOP)); {away}", ()),
        ("T", "rotate 0.0", ()),
    )  # fmt: skip
    net, toml = cell_of(tasks, {(0, 3)}, NUMBERS)
    folder = tmp_path_factory.mktemp("beside")
    return tell(written(folder / "cell", net, toml), folder / "runs")


def test_what_rests_on_a_plate_is_named_once_and_not_its_owner(beside: Told) -> None:
    layout, said = beside.layout, beside.command().stdout
    resting = [p for p in layout["pairs"] if p["things"][1] or p["things"][0]]
    assert resting and {x for p in resting for x in p["things"]} == {
        None,
        "`blank.1` on `table/plate`",
    }
    assert "while `blank.1` on `table/plate` stands there\n" in said
    assert "`blank.1` on `table/plate`: stands at 900 -300 576\n" in said
    assert "`arm/blank.1` and `blank.1` on `table/plate` overlap by" in said
    told = [(p["transitions"], p["doing"], p["links"]) for p in layout["pairs"]]
    assert len(told) == len({str(x) for x in told})


def test_a_place_that_keeps_a_plate_for_one_part_is_proposed(beside: Told) -> None:
    (proposal,) = beside.layout["proposals"]
    assert [r["thing"] for r in proposal["rests"]] == ["blank on table/plate"]
    assert proposal["works"], proposal["says"]
    sends, gots = (
        [f"Top.Supervisor.{x}" for x in some] for some in (("Send1", "Send4"), ("Got2", "Got4"))
    )
    assert (sorted(proposal["takes"]), sorted(proposal["gives"])) == (sends, gots)
    said = beside.command().stdout
    assert "comes to where blank on table/plate rests" in said or "come to where blank" in said
    assert "where it has been put: nobody may come there until it is taken away" in said


def test_nobody_puts_a_part_onto_a_plate_that_turns(tmp_path: Path) -> None:
    tasks = (("O", "put (); ()", ()), ("T", "rotate FIRST", ()))
    told = tell(written(tmp_path / "cell", *cell_of(tasks, set(), NUMBERS)), tmp_path / "runs")
    (pair,) = told.layout["pairs"]
    assert pair["answer"] == "no" and pair["robots"] == ["operator", "table"]
    assert (
        pair["says"]
        == "`operator` creates `blank.1` on `table/plate` while that moves, at (900, -300, 576) mm"
    )
    assert pair["run"]["under_way"] == 2 and not told.layout["open_at"]
    assert (
        "let the net command one of them only when the other one has answered"
        in told.command().stdout
    )
    (proposal,) = told.layout["proposals"]
    assert proposal["works"], proposal["says"]
