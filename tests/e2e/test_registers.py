"""Values that many read: a reader sees them late, in the proofs as in the cell."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers import register_cells, register_pairs
from helpers.thorough import amount
from pn2code.cli.main import app
from pn2code.conform.cell import conform_cell
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]


def verified(cell: Path, *properties: str, medium: bool = True) -> dict[str, Any]:
    asked = [word for p in properties for word in ("--property", p)]
    options = ["--threads", "1", "--traces", str(cell.parent / "traces")]
    options += [] if medium else ["--no-medium"]
    done = CliRunner().invoke(app, ["verify", str(cell), "--json", *options, *asked])
    assert done.exit_code in (0, 1, 3), done.output
    said: dict[str, Any] = json.loads(done.stdout)
    return said


def replayed(trace: Path, cell: Path) -> None:
    done = CliRunner().invoke(app, ["replay", str(trace), str(cell)])
    assert done.exit_code == 0, done.output


def test_what_is_true_at_once_is_false_where_it_is_seen_late(tmp_path: Path) -> None:
    cell = register_pairs.write(tmp_path / "cell", register_pairs.FREE)
    never_again = "ltl G ({Mark.Supervisor'limit 1 == 1`0} -> G !fires(Reader'Enter 1))"
    said = verified(cell, never_again)
    (answer,) = said["properties"]
    assert answer["answer"] == "no" and answer["net"]["answer"] == "yes", answer
    replayed(Path(answer["evidence"]["trace"]), cell)
    # Once the value has been published, each device sees it the next time that it looks.
    assert {c["answer"] for c in said["controller"]} == {"yes"}
    assert {c["answer"] for c in said["medium"]} == {"yes"}


def test_who_is_told_to_look_sees_what_was_set_before(tmp_path: Path) -> None:
    cell = register_pairs.write(tmp_path / "cell", register_pairs.TOLD)
    said = verified(
        cell,
        "mutex Reader'Odd 1, Reader'Even 2",
        "never {Mark.Reader'limit 1 <> Mark.Supervisor'limit 1}",
    )
    assert [a["answer"] for a in said["properties"]] == ["yes", "no"]
    assert {c["answer"] for c in (*said["controller"], *said["medium"])} == {"yes"}


def test_messages_that_are_never_needed_are_no_note(tmp_path: Path) -> None:
    """Nobody has drawn `Again` and `See again`, and nobody can do anything about them."""
    cell = register_pairs.write(tmp_path / "cell", register_pairs.TOLD)
    said = verified(cell, medium=False)
    assert any("See_again" in name for name in said["cell"]["dead_transitions"])
    assert said["notes"] == []


@pytest.mark.parametrize("realtime", [False, True])
def test_a_run_is_one_of_the_net(realtime: bool, tmp_path: Path) -> None:
    cell = register_pairs.write(tmp_path / "cell", register_pairs.TOLD)
    d = Diagnostics()
    out = tmp_path / "out"
    result = run_cell(cell, RunOptions(out=out, backend="fake", realtime=realtime), d)
    assert result is not None, [str(i) for i in d]
    rows = [json.loads(x) for x in (out / "cell.trace.jsonl").read_text().splitlines()]
    assert rows[-1]["why"] == "finished"
    seen = [r["binding"]["v"] for r in rows if ".First.See limit" in str(r.get("transition"))]
    assert seen == [2, 1, 0]
    replayed(out / "cell.trace.jsonl", cell)


def test_the_programs_are_those_of_the_net(tmp_path: Path) -> None:
    cell = register_pairs.write(tmp_path / "cell", register_pairs.FREE)
    found = conform_cell(cell, Diagnostics())
    assert found is not None and found.complete and not found.deviates, found


def test_a_script_that_does_not_look_first_is_found(tmp_path: Path) -> None:
    cell = register_pairs.write(tmp_path / "cell", register_pairs.FREE)
    d = Diagnostics()
    made = generate(cell, d)
    assert made is not None, [str(i) for i in d]
    folder = tmp_path / "made"
    for file in made.files:
        path = folder / file.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(file.text, encoding="utf-8")
    script = folder / "first.tdl"
    text = script.read_text()
    asks = "if filled(limit_first) then"
    assert asks in text
    script.write_text(text.replace(asks, asks.replace(" then", " and limit_seen > 9 then"), 1))
    found = conform_cell(cell, d, generated=folder)
    assert found is not None and found.deviates
    (deviation,) = [r.deviation for r in found.robots if r.deviation]
    assert "`Top.First.Enter` with {'k': 1}, which is not enabled according to the net" in deviation


@pytest.mark.parametrize("seed", [3, 8][: amount(1, 2)])
def test_random_cells_are_verified_and_run(seed: int, tmp_path: Path) -> None:
    cell = tmp_path / "cell"
    holds = register_cells.write(cell, seed)
    said = verified(cell, *([holds] if holds else []))
    answers = [*said.get("properties", ()), *said["controller"], *said["medium"]]
    assert {a["answer"] for a in answers} == {"yes"}, answers
    d = Diagnostics()
    assert run_cell(cell, RunOptions(out=tmp_path / "out", backend="fake"), d) is not None
    replayed(tmp_path / "out" / "cell.trace.jsonl", cell)
