"""Messages that are lists of records, from the net to the run: a camera's defects, and a robot that goes to each."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers import record_list_cell
from pn2code.cli.main import app
from pn2code.conform.cell import conform_cell
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]


def test_from_end_to_end(tmp_path: Path) -> None:
    cell = record_list_cell.write(tmp_path / "cell")
    d = Diagnostics()
    assert generate(cell, d) is not None and not d.items, [str(i) for i in d]
    found = conform_cell(cell, d)
    assert found is not None and found.complete and not found.deviates, found
    out = tmp_path / "out"
    assert run_cell(cell, RunOptions(out=out, backend="fake"), d) is not None, [str(i) for i in d]
    lines = [json.loads(x) for x in (out / "cell.trace.jsonl").read_text().splitlines()]
    told = [x["binding"]["ds"] for x in lines if x.get("transition") == "Top.Camera.Tell"]
    scratch = {"spot": 1, "kind": "scratch", "area": {"wide": 0.5, "deep": 1}}
    burn = {"spot": 2, "kind": "burn", "area": {"wide": 1.0, "deep": 2}}
    assert told == [[], [scratch], [scratch, burn]]
    got = [x["binding"] for x in lines if str(x.get("transition")).endswith("Supervisor.Finish")]
    assert got == [{"i": 2, "m": [[0, True], [1, False]], "k": 3}]
    rows = [x.split("\t") for x in (out / "messages.tsv").read_text().splitlines()]
    seen = [row[5] for row in rows if row[1] == "found"]
    assert seen[0] == "0" and seen[-1] == "2 1 scratch 0.5000 1 2 burn 1.0000 2"


def test_verify_says_yes(tmp_path: Path) -> None:
    cell = record_list_cell.write(tmp_path / "cell")
    done = CliRunner().invoke(
        app, ["verify", str(cell), "--json", "--threads", "1", "--traces", str(tmp_path)]
    )
    assert done.exit_code == 0, done.output
    said = json.loads(done.stdout)
    assert {c["answer"] for c in said["controller"]} == {"yes"}
    assert {a["answer"] for a in said["medium"]} == {"yes"}


def test_conform_finds_a_column_that_is_a_list_of_its_own(tmp_path: Path) -> None:
    """`rows(int, bool), int` and `ints, bool, int` are the same kinds one after the other."""
    cell = record_list_cell.write(tmp_path / "cell")
    d = Diagnostics()
    made = generate(cell, d)
    assert made is not None
    folder = tmp_path / "generated"
    for file in made.files:
        path = folder / file.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(file.text, encoding="utf-8")
    script = folder / "robot1.tdl"
    text = script.read_text()
    assert ": rows(int, bool), int " in text
    text = text.replace(": rows(int, bool), int ", ": ints, bool, int ")
    text = text.replace("reversed(working_x2_2), k", "true, k")
    script.write_text(text)
    done = CliRunner().invoke(app, ["conform", str(cell), "--generated", str(folder)])
    assert done.exit_code == 1, done.output
    said = " ".join(done.output.split())
    assert said.count("`result.robcad` holds ints, bool, int according to the script") == 1, said


def test_a_code_segment_goes_along_a_list(tmp_path: Path) -> None:
    """All moves of a message in one transition: the script has a loop, and does what the net says."""
    net = record_list_cell.NET
    begin = net.index("    trans Go code")
    end = net.index("    trans Report", begin)
    does = (
        "List.app (fn (place, _) => moveJoint place) way; List.foldl (fn (_, sum) => sum + 1) 0 way"
    )
    go = f"""    trans Go code input (way) output (n); action ({does})
      in Working : (way, [])
      out Working : ([], [(length way, true)])
      in Count : k
      out Count : k + n
"""
    net = (net[:begin] + go + net[end:]).replace(", length m = i]", "]")
    net = net.replace("in Working : ([], m)", "in Working : ([], [(i, b)])")
    net = net.replace("out result : (rev m, k)", "out result : ([(i, b)], k)")
    cell = record_list_cell.write(tmp_path / "cell", net)
    d = Diagnostics()
    made = generate(cell, d)
    assert made is not None, [str(i) for i in d]
    text = next(f.text for f in made.files if f.path == "robot1.tdl")
    assert text.count("while count_of(todo_x1) <> 0 loop") == 1 and "so_far := so_far + 1" in text
    found = conform_cell(cell, d)
    assert found is not None and found.complete and not found.deviates, found
    out = tmp_path / "out"
    assert run_cell(cell, RunOptions(out=out, backend="fake"), d) is not None, [str(i) for i in d]
    lines = [json.loads(x) for x in (out / "cell.trace.jsonl").read_text().splitlines()]
    (end_,) = [x for x in lines if str(x.get("transition")).endswith("Supervisor.Finish")]
    assert end_["binding"]["k"] == 3


def test_lists_of_twenty(tmp_path: Path) -> None:
    """Messages have room for them, with 143 values the largest one, and they come back as they were sent."""
    net = record_list_cell.NET.replace("with 0..3;", "with 0..20;")
    net = net.replace("SPOT = int with 0..9", "SPOT = int with 0..20")
    net = net.replace("Rounds : SPOT = 1`0", "Rounds : SPOT = 1`20").replace("guard [i < 3]", "")
    net = net.replace("1500.0 + 100.0 * Real", "1500.0 + 10.0 * Real")
    cell = record_list_cell.write(tmp_path / "cell", net)
    d, out = Diagnostics(), tmp_path / "out"
    made = generate(cell, d)
    assert made is not None, [str(i) for i in d]
    makefile = next(f.text for f in made.files if f.path == "Makefile")
    assert "-DPN_CHANNEL_SCALARS=143U" in makefile
    assert run_cell(cell, RunOptions(out=out, backend="fake"), d) is not None, [str(i) for i in d]
    lines = [json.loads(x) for x in (out / "cell.trace.jsonl").read_text().splitlines()]
    (seen,) = [x["binding"]["ds"] for x in lines if str(x.get("transition")).endswith(".Seen")]
    assert [x["spot"] for x in seen] == list(range(1, 21))
    (done,) = [x["binding"] for x in lines if str(x.get("transition")).endswith(".Finish")]
    assert done["k"] == 20
    # The robot goes along them from the last one to the first.
    assert done["m"] == [[i, i < 19] for i in range(20)]


def test_commands_of_no_time_along_a_list(tmp_path: Path) -> None:
    """12,100 waits in one moment, of one transition, stop a run in lock-step: `verify` said that the cell ends."""
    net = record_list_cell.NET.replace(
        "  fun at n =",
        "  colset LONG = list SPOT with 0..110;\n  var l : LONG;\n  fun pause (t : REAL) = ();\n  fun at n =",
    )
    many = ", ".join(["1"] * 110)
    net = net.replace("    place Seeing", f"    place Long : LONG = 1`[{many}]\n    place Seeing")
    does = "List.app (fn _ => List.app (fn _ => pause 0.0) l) l"
    net = net.replace(
        "    trans Tell\n",
        f"    trans Tell code input (l); action {does}\n      both Long : l\n",
    )
    toml = record_list_cell.TOML.replace(
        "[robots.robot1]", 'pause = { command = "wait" }\n[robots.robot1]'
    )
    for file in ("look", "job"):  # nobody owes an answer
        toml = toml.replace(f'"{file}.robcad"', f'"{file}.robcad"\nkind = "data"')
    cell = record_list_cell.write(tmp_path / "cell", net, toml)
    options = ["--json", "--threads", "1", "--no-medium", "--traces", str(tmp_path)]
    said = json.loads(CliRunner().invoke(app, ["verify", str(cell), *options]).stdout)
    (ends,) = [c for c in said["controller"] if c["check"] == "non-blocking"]
    assert (ends["answer"], ends["why"]) == ("unknown", "commands")
