"""Linear moves through poses from the net to the arm: the script, `conform`, runs, `check --geometry`, and `time`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from e2e.test_check_geometry import looked
from e2e.test_moves_in_cells import AT, _deviation, cell, changed, made, moves
from helpers.robot_cells import pose_mm
from pn2code.cell.load import load
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.legs import Leg, Planner
from pn2code.pipeline import generate
from pn2code.robot import scene
from pn2code.robot.commands import MoveLinear
from pn2code.robot.transforms import Array
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build", "here")]

ENTRY = '{ command = "move_linear", frame = "world", blend = 0.1 }'
BESIDE = """  fun beside (p : POSE) = {x = #x p - 300.0, y = #y p, z = #z p, rx = #rx p, ry = #ry p, rz = #rz p}
"""
LOW = AT.replace("500.0 + 50.0 * Real.fromInt n", "700.0").replace("1200.0", "1100.0")
LOW = LOW.replace("ry = 90.0", "ry = 135.0")
WRITTEN = "move $linear p via pose(p.x - 300 mm, p.y, p.z, p.rx, p.ry, p.rz) in world with $blend = 100 mm"
VIA, END = (pose_mm(x, 0.5, 1100.0, 0, 135.0, 0) for x in (400.0, 700.0))


def blended(folder: Path, entry: str = ENTRY) -> Path:
    """HOME, then down to a pose that is passed, and across to the last."""
    return cell(folder, entry, f"{LOW}\n{BESIDE}", "(beside p, p)", "q : POSE, p : POSE")


def test_the_script_moves_as_the_net_and_the_cell_say(tmp_path: Path) -> None:
    """And `conform` sees another zone, and another pose on the way."""
    found = made(blended(tmp_path))
    text = next(f.text for f in found.files if f.path == "robot1.tdl")
    assert moves(text) == [WRITTEN]
    owner = found.partition.owners[1]
    assert _deviation(found, owner, text) is None
    for old, new in (
        ("$blend = 100 mm", "$blend = 90 mm"),
        ("p.x - 300 mm", "p.x - 301 mm"),
        (" via pose(p.x - 300 mm, p.y, p.z, p.rx, p.ry, p.rz)", " via p, p"),
        (WRITTEN, "move $linear p in world"),
        (WRITTEN, WRITTEN + " at 50 mm/s"),
    ):
        assert _deviation(found, owner, changed(text, old, new)), new


def test_several_poses_and_a_speed(tmp_path: Path) -> None:
    entry = ENTRY.replace("blend = 0.1", "blend = 0.02, via = 2, acceleration = 0.5")
    takes = "r : POSE, q : POSE, p : POSE, v : real"
    where = cell(
        tmp_path, entry, f"{LOW}\n{BESIDE}", "(beside p, beside (beside p), p, 40.0)", takes
    )
    found = made(where)
    text = next(f.text for f in found.files if f.path == "robot1.tdl")
    (line,) = moves(text)
    assert line.startswith(
        "move $linear p via pose(p.x - 300 mm, p.y, p.z, p.rx, p.ry, p.rz), pose("
    )
    assert line.endswith("in world with $blend = 20 mm at 40 mm/s acceleration 50 %")
    assert _deviation(found, found.partition.owners[1], text) is None
    order = "p via pose(p.x - 300 mm, p.y, p.z, p.rx, p.ry, p.rz), "
    first = order.removeprefix("p via ").removesuffix(", ")
    second = line[line.index(order) + len(order) : line.index(" in world")]
    swapped = changed(text, f"via {first}, {second}", f"via {second}, {first}")
    assert _deviation(found, found.partition.owners[1], swapped)


def _leg(folder: Path) -> tuple[Planner, Leg]:
    d = Diagnostics()
    config = load(folder / "cell.toml", d)
    assert config is not None
    loaded = scene.load(config.geometry, config.folder, config.locator.origin, d)
    assert loaded is not None, [e.message for e in d.errors]
    planner = Planner(loaded)
    leg = planner.leg(planner.home("robot1"), MoveLinear(END, via=(VIA,), blend=0.1))
    assert leg.path is not None, leg.fault
    return planner, leg


def _places(planner: Planner, leg: Leg) -> Array:
    arm = planner.cell.robot("robot1")
    assert leg.path is not None
    q = leg.path.on_way(np.linspace(0.0, 1.0, 400))
    return np.asarray((arm.T_world_base @ arm.kinematics.forward_many(q))[:, :3, 3])


def _with_stone(folder: Path, place: Array) -> Path:
    x, y, z = (round(float(v), 4) for v in place)
    toml = folder / "cell.toml"
    toml.write_text(
        toml.read_text() + f'[scene]\nobjects = [{{ name = "stone", pose = {{ x = {x}, y = {y}, '
        f"z = {z} }}, size = [0.006, 0.006, 0.006] }}]\n"
    )
    return folder


def _run(folder: Path, out: Path, backend: str = "bullet") -> tuple[str, str, float]:
    d = Diagnostics()
    seen = run_cell(folder, RunOptions(out, backend=backend, looks=False, checked=False), d)
    assert seen is not None, [e.message for e in d.errors]
    lengths = [a.end - a.start for a in seen.record.actions if a.label == "linear"]
    return seen.record.verdict, seen.record.reason, lengths[0] if lengths else 0.0


def test_the_rounded_way_is_swept_and_run(tmp_path: Path) -> None:
    free = blended(tmp_path / "free")
    found = looked(free, tmp_path / "a")
    own = [m for m in found.moves if m.kind == "blend"]
    assert own and all(m.answer == "yes" for m in own), found.moves
    assert " via 400 0.5 1100, 0 135 0, blend 100 mm" in own[0].command
    _, leg = _leg(free)
    assert leg.path is not None
    verdict, reason, seconds = _run(free, tmp_path / "run")
    assert verdict == "finished", reason
    assert seconds == pytest.approx(leg.path.duration, abs=1e-6)


def test_a_stone_on_the_rounded_way_is_hit(tmp_path: Path) -> None:
    planner, leg = _leg(blended(tmp_path / "free"))
    places = _places(planner, leg)
    corner = np.array([VIA.x, VIA.y, VIA.z])
    near = places[int(np.argmin(np.linalg.norm(places - corner, axis=1)))]
    stony = _with_stone(blended(tmp_path / "stony"), near)
    found = looked(stony, tmp_path / "b")
    bad = [m for m in found.moves if m.answer == "no"]
    assert bad and bad[0].kind == "blend" and "stone" in bad[0].problem, found.moves
    verdict, reason, _ = _run(stony, tmp_path / "run")
    assert verdict != "finished" and "stone" in reason


def test_verify_and_check_look_at_its_end(tmp_path: Path) -> None:
    where = str(blended(tmp_path / "cell"))
    done = CliRunner().invoke(app, ["verify", where, "--json", "--no-medium", "--most-traces", "0"])
    (found,) = [c for c in json.loads(done.stdout)["controller"] if c["check"] == "non-blocking"]
    assert found["answer"] == "yes"
    assert any("on the way, poses passed, increments" in x for x in found["assumes"])


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        (
            '{ command = "move_linear", frame = "world", via = 2 }',
            "a linear move by way of poses needs a zone in which its corners are rounded",
        ),
        (
            '{ command = "move_linear", frame = "world", blend = 0.02, via = 2 }',
            "but a function for `move_linear` has type `POSE * POSE * POSE -> unit` or `POSE * POSE * POSE * real -> ",
        ),
        (
            '{ command = "move_linear", frame = "world", blend = 0.02, approach = 0.1 }',
            "`approach` does not go with a linear move by way of poses (`blend`)",
        ),
        (
            '{ command = "move_linear", frame = "world", blend = 0.0 }',
            "`blend` is 0.0, but must be at least 0.0001, at most 10, and finite",
        ),
        (
            '{ command = "move_circular", frame = "world", blend = 0.02 }',
            "unknown key `blend`",
        ),
    ],
)
def test_mistakes_in_the_entry(entry: str, message: str, tmp_path: Path) -> None:
    d = Diagnostics()
    assert generate(blended(tmp_path, entry), d, checked=False) is None
    assert any(message in e.message for e in d.errors), [e.message for e in d.errors]
