"""Messages that are lists, from the net to the run: what is verified of the cell is what runs."""

from __future__ import annotations

import json
from pathlib import Path
from random import Random

import pytest
from typer.testing import CliRunner

from helpers import list_cell, random_lists, small_cell
from helpers.netbuilder import cpn
from helpers.thorough import amount
from pn2code.cell.divide import divide
from pn2code.cell.load import load
from pn2code.cli.main import app
from pn2code.conform.cell import conform_cell
from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.pipeline import generate
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]


def test_lists_from_end_to_end(tmp_path: Path) -> None:
    cell = list_cell.write(tmp_path / "cell")
    d = Diagnostics()
    made = generate(cell, d)
    assert made is not None and not d.items, [str(i) for i in d]
    found = conform_cell(cell, d)
    assert found is not None and found.complete and not found.deviates, found
    out = tmp_path / "out"
    result = run_cell(cell, RunOptions(out=out, backend="fake"), d)
    assert result is not None, [str(i) for i in d]
    lines = [json.loads(x) for x in (out / "cell.trace.jsonl").read_text().splitlines()]
    got = [x["binding"] for x in lines if str(x.get("transition")).endswith("Supervisor.Finish")]
    assert [b["g"] for b in got] == [["poor"]]
    assert lines[-1]["why"] == "finished"
    rows = [x.split("\t") for x in (out / "messages.tsv").read_text().splitlines()]
    seen = [row[5] for row in rows if row[1] == "seen"]
    assert seen == ["0 0", "3 fine fine poor 1", "1 poor 3"]
    assert [row[5] for row in rows if row[1] == "route"][0] == "0"  # an empty list is a message


def test_verify_says_yes(tmp_path: Path) -> None:
    cell = list_cell.write(tmp_path / "cell")
    done = CliRunner().invoke(
        app, ["verify", str(cell), "--json", "--threads", "1", "--traces", str(tmp_path)]
    )
    assert done.exit_code == 0, done.output
    said = json.loads(done.stdout)
    checks = {c["check"]: c for c in said["controller"]}
    # Lists of reals and those without a longest one are sent and read; `JOB` has a string.
    assert checks["messages"]["answer"] == "yes" and checks["messages"]["value"] == 9
    assert {a["answer"] for a in said["medium"]} == {"yes"}


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("List.tabulate (63, fn i => i)", ""),
        ("List.tabulate (64, fn i => i)", "it has 65 values, but at most 64 are possible"),
        ("[1.0 / 0.0]", "is not a finite number"),
        ("List.tabulate (60, fn i => long)", "bytes, but at most 4,055 are possible"),
    ],
)
def test_a_list_that_cannot_be_sent_is_found_out(value: str, words: str, tmp_path: Path) -> None:
    of = "REAL" if "/" in value else "STRING" if "long" in value else "INT"
    net = random_lists.ONE.replace("ELEMENT", of).replace("VALUE", value)
    cell = small_cell.write(tmp_path / "cell", net, random_lists.ONE_TOML)
    d = Diagnostics()
    made = generate(cell, d)
    if not words:
        assert made is not None, [str(i) for i in d]
        return
    assert made is None
    (error,) = d.errors
    assert error.code == "controller-check"
    assert error.message.startswith("messages: the message ") and words in error.message


@pytest.mark.parametrize(("length", "words"), [(600, ""), (601, "not in the colour set")])
def test_a_longest_length_makes_room(length: int, words: str, tmp_path: Path) -> None:
    net = random_lists.ONE.replace("list ELEMENT", "list INT with 0..600")
    net = net.replace("VALUE", f"List.tabulate ({length}, fn i => 1000000000 + i)")
    cell = small_cell.write(tmp_path / "cell", net, random_lists.ONE_TOML)
    d, out = Diagnostics(), tmp_path / "out"
    made = generate(cell, d)
    if words:
        assert made is None and any(words in e.message for e in d.errors), [str(i) for i in d]
        return
    assert made is not None, [str(i) for i in d]
    makefile = next(f.text for f in made.files if f.path == "Makefile")
    assert "-DPN_CHANNEL_SCALARS=601U" in makefile
    assert f"FRAME_MAX ?= {16_384 + 104 * (601 - 64)}\n" in makefile  # no warnings of frames
    found = conform_cell(cell, d)
    assert found is not None and found.complete and not found.deviates, found
    assert run_cell(cell, RunOptions(out=out, backend="fake"), d) is not None, [str(i) for i in d]
    rows = [x.split("\t") for x in (out / "messages.tsv").read_text().splitlines()]
    sent = {row[5] for row in rows if row[1] == "batch"}
    assert sent == {f"{length} " + " ".join(str(10**9 + i) for i in range(length))}


def test_lists_of_lists_are_refused(tmp_path: Path) -> None:
    net = random_lists.ONE.replace("ELEMENT", "ROW").replace("VALUE", "[[1]]")
    folder = small_cell.write(tmp_path / "cell", net, random_lists.ONE_TOML)
    d = Diagnostics()
    config, flat = load(folder / "cell.toml", d), front.load(folder / "cell.cpn", d)
    assert config is not None and flat is not None
    assert divide(flat, config, d) is None
    (error,) = [e for e in d.errors if e.code == "unsupported-channel-colset"]
    assert "colour set `BATCH`, which no message can hold" in error.message
    assert cpn(net)


@pytest.mark.parametrize("seed", range(amount(1, 40)))
def test_what_is_verified_of_random_cells_runs(seed: int, tmp_path: Path) -> None:
    """Cells that pass lists of all kinds on and back: what comes back is what was sent."""
    net, toml, rounds = random_lists.cell(Random(seed))
    cell = small_cell.write(tmp_path / "cell", net, toml)
    d = Diagnostics()
    done = CliRunner().invoke(
        app, ["verify", str(cell), "--json", "--threads", "1", "--traces", str(tmp_path)]
    )
    assert done.exit_code == 0, done.output
    found = conform_cell(cell, d)
    assert found is not None and found.complete and not found.deviates, found
    out = tmp_path / "out"
    assert run_cell(cell, RunOptions(out=out, backend="fake"), d) is not None, [str(i) for i in d]
    lines = [json.loads(x) for x in (out / "cell.trace.jsonl").read_text().splitlines()]
    assert lines[-1]["why"] == "finished"
    # The guards of `Again` and `Finish` ask that the lists have come back as they were sent, the other way round.
    told = [str(x.get("transition")).rpartition(".")[2] for x in lines if x.get("transition")]
    assert told.count("Again") + told.count("Finish") == rounds
