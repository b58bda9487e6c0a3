"""A welding pair on tracks with a turntable, from cell.toml to the proofs and a run."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from e2e.test_check_geometry import looked
from helpers.welding_cell import NET, TOML, welding_cell
from pn2code.cli.main import app
from pn2code.conform.cell import ProgramComparison
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

WELD = "move $linear pose(100 mm, -60 mm, 15 mm, 180 deg, 0 deg, 90 deg) in seam with $track rail = 300 mm"


def changed(text: str, old: str, new: str) -> str:
    assert old in text, old
    return text.replace(old, new)


def test_scripts_move_external_axes_and_conform_compares_them(tmp_path: Path) -> None:
    d = Diagnostics()
    found = generate(welding_cell(tmp_path), d, checked=False)
    assert found is not None, [e.message for e in d.errors]
    text = next(f.text for f in found.files if f.path == "left.tdl")
    assert "move $external with $track rail = n * 100 mm" in text or "$track rail" in text
    assert WELD in text
    comparison = ProgramComparison(found)
    owner = found.partition.owners[1]
    for old, new, differs in (
        ("", "", False),
        ("$track rail = 300 mm", "$track rail = 310 mm", True),
        ("move $external with $turntable", "move $external with $track", True),
    ):
        told = Diagnostics()
        other = text if not old else changed(text, old, new)
        report = comparison.script(owner, other, told)
        assert (report is None or report.deviation is not None) is differs, (old, told.errors)


def test_a_tool_frame_goes_from_the_cell_to_the_script_and_the_run(tmp_path: Path) -> None:
    toml = changed(
        TOML,
        'weldStill = { command = "move_linear", frame = "world" }',
        'weldStill = { command = "move_linear", frame = "world", tcp = "torch", approach = 0.02 }',
    )
    none = Diagnostics()
    assert generate(welding_cell(tmp_path / "none", toml=toml), none, checked=False) is None
    assert any("no robot has a tool frame or tool `torch`" in e.message for e in none.errors)
    toml += "[robots.right.tcps.torch]\nz = 0.1\npitch = 10.0\n"
    cell = welding_cell(tmp_path / "cell", toml=toml)
    d = Diagnostics()
    found = generate(cell, d, checked=False)
    assert found is not None, [e.message for e in d.errors]
    text = next(f.text for f in found.files if f.path == "right.tdl")
    line = next(x for x in text.splitlines() if "move $linear" in x)
    assert line.endswith("in world with $tool torch")
    comparison = ProgramComparison(found)
    owner = next(o for o in found.partition.owners if o.name == "right")
    for other, differs in ((text, False), (changed(text, "with $tool torch", ""), True)):
        report = comparison.script(owner, other, d)
        assert report is not None and (report.deviation is not None) is differs
    wanted = RunOptions(tmp_path / "run", backend="fake", looks=False, checked=False)
    seen = run_cell(cell, wanted, d)
    assert seen is not None and seen.record.verdict == "finished", [e.message for e in d.errors]
    assert seen.record.accuracy["off the line on linear moves"] < 1e-6


def test_a_run_ends_where_the_check_says_that_it_does(tmp_path: Path) -> None:
    cell = welding_cell(tmp_path / "cell")
    d = Diagnostics()
    seen = run_cell(cell, RunOptions(tmp_path / "run", backend="fake", looks=False), d)
    assert seen is not None, [e.message for e in d.errors]
    assert seen.record.verdict == "finished", seen.record.reason
    assert not [x for x in d if x.code == "controller-unchecked"], [x.message for x in d]
    assert {a.label for a in seen.record.actions} >= {"external", "linear", "joint", "home"}
    assert seen.record.accuracy["off the line on linear moves"] < 1e-6
    done = CliRunner().invoke(app, ["time", str(cell), "--json"])
    assert done.exit_code == 0, done.output
    (layout,) = json.loads(done.stdout)["layouts"]
    assert layout["cycle"]["most_s"] == pytest.approx(seen.record.time, abs=0.01)


@pytest.mark.bullet
def test_all_moves_can_be_done_and_the_arms_keep_apart(tmp_path: Path) -> None:
    found = looked(welding_cell(tmp_path / "cell"), tmp_path / "runs")
    assert found.of_moves == "yes" and found.of_pairs == "yes", found.moves
    commands = {m.command for m in found.moves}
    assert "external with rail 200" in commands
    assert any(c.endswith("in seam with rail 300, plate 90") for c in commands)


@pytest.mark.bullet
@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("from = -0.5\nto = 0.8\n", "from = -0.5\nto = 0.25\n", "external axis `rail` would be at"),
        # Beyond the plate's edge the work piece comes into the arm's way as it turns.
        ("size = [0.4, 0.2, 0.05]", "size = [3.4, 0.6, 0.05]", "`left/plate`"),
    ],
)
def test_what_cannot_be_is_found(old: str, new: str, problem: str, tmp_path: Path) -> None:
    cell = welding_cell(tmp_path / "cell", toml=changed(TOML, old, new))
    found = looked(cell, tmp_path / "runs")
    bad = [m.problem for m in found.moves if m.answer == "no"]
    bad += [p.says for p in found.pairs if p.answer == "no"]
    assert any(problem in text for text in bad), bad
    d = Diagnostics()
    seen = run_cell(cell, RunOptions(tmp_path / "run", looks=False, checked=False), d)
    assert seen is not None and seen.record.verdict == "failed"
    assert problem in seen.record.reason


@pytest.mark.usefixtures("here")
def test_a_pose_that_is_reached_from_some_places_only_is_not_proved(tmp_path: Path) -> None:
    """Whoever does not tell the track where to go relies on where it was left."""
    for far, answer in ((0.8, "yes"), (6.0, "unknown")):
        toml = changed(TOML, "to = 0.8\n", f"to = {far}\n")
        net = changed(
            NET, "travel (100.0 * Real.fromInt n)", f"travel ({1000.0 * (far - 0.7):.1f})"
        )
        cell = welding_cell(tmp_path / str(far), net, toml)
        done = CliRunner().invoke(
            app, ["verify", str(cell), "--json", "--no-medium", "--most-traces", "0"]
        )
        checks = json.loads(done.stdout)["controller"]
        (found,) = [c for c in checks if c["check"] == "reach"]
        assert found["answer"] == answer, found


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('track = "rail"', 'track = "plate"', "no robot has a track `plate`"),
        ('turn = { command = "move_external", turntable = "plate" }',
         'turn = { command = "move_external" }', "`primitives.turn` names no external axis"),
        ('goToAlong = { command = "move_joint", track = "bench" }',
         'goToAlong = { command = "move_joint", track = "rail" }',
         "`goToAlong` moves track `rail`, which robot `right` does not have"),
        ('weldStill = { command = "move_linear", frame = "world" }',
         'weldStill = { command = "move_linear", frame = "seam" }',
         "`weldStill` moves in frame `seam`, which turns with `left.plate`"),
        ('weldStill = { command = "move_linear", frame = "world" }',
         'weldStill = { command = "move_linear", frame = "world", track = "bench" }',
         "has type `POSE * real -> unit` or `POSE * real * real -> unit`"),
        ('home = { command = "move_home" }', 'home = { command = "move_home", track = "rail" }',
         "unknown key `track`"),
    ],
)  # fmt: skip
def test_mistakes_in_the_entries(old: str, new: str, message: str, tmp_path: Path) -> None:
    d = Diagnostics()
    assert generate(welding_cell(tmp_path, toml=changed(TOML, old, new)), d, checked=False) is None
    assert any(message in e.message for e in d.errors), [e.message for e in d.errors]


def test_a_constant_position_outside_the_limits_is_an_error_of_check(tmp_path: Path) -> None:
    cell = welding_cell(
        tmp_path, toml=changed(TOML, "from = -0.5\nto = 0.5\n", "from = -0.1\nto = 0.1\n")
    )
    done = CliRunner().invoke(app, ["check", str(cell)])
    assert done.exit_code != 0
    said = " ".join(done.output.split())
    assert "external axis `bench` would be at 200.00 mm, outside -100.00 .. 100.00" in said
