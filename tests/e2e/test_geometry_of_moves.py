"""`check --geometry` of arcs, joint positions, frames, and approaches: the true way of each is swept."""

from __future__ import annotations

from pathlib import Path

import pytest

from e2e.test_check_geometry import looked
from e2e.test_moves_in_cells import AXES, KINDS, cell
from pn2code.cell.load import load
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.legs import Planner
from pn2code.robot import scene
from pn2code.robot.commands import MoveCircular
from pn2code.robot.transforms import Array

pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build")]


def test_an_arc_is_swept_not_its_chord(tmp_path: Path) -> None:
    """A small box beside the chord, on the arc that the net commands."""
    entry, options, _ = KINDS["arc"]
    free = cell(tmp_path / "free", entry, **options)
    moves = [m for m in looked(free, tmp_path / "a").moves if m.kind == "circ"]
    assert len(moves) == 3 and all(m.answer == "yes" for m in moves)
    assert all(m.command.startswith("circular ") and " via " in m.command for m in moves)
    place = _off_the_chord(free)
    x, y, z = (round(float(v), 4) for v in place)
    box = (
        f'[scene]\nobjects = [{{ name = "stone", pose = {{ x = {x}, y = {y}, z = {z} }}, '
        "size = [0.01, 0.01, 0.01] }]\n"
    )
    toml = free / "cell.toml"
    toml.write_text(toml.read_text() + box)
    found = looked(free, tmp_path / "b")
    bad = [m for m in found.moves if m.answer == "no"]
    assert bad and bad[0].kind == "circ" and "stone" in bad[0].problem, found.moves


def _off_the_chord(folder: Path) -> Array:
    """The place of the flange on the first arc that is furthest from the straight way."""
    d = Diagnostics()
    config = load(folder / "cell.toml", d)
    assert config is not None
    loaded = scene.load(config.geometry, config.folder, config.locator.origin, d)
    assert loaded is not None, [e.message for e in d.errors]
    planner = Planner(loaded)
    from helpers.robot_cells import pose_mm

    told = MoveCircular(
        pose_mm(500.0, 0.5, 1240.0, 0, 135.0, 0), pose_mm(550.0, 0.5, 1200.0, 0, 135.0, 0)
    )
    leg = planner.leg(planner.home("robot1"), told)
    assert leg.path is not None
    import numpy as np

    arm = loaded.robot("robot1")
    q = leg.path.on_way(np.linspace(0.0, 1.0, 200))
    places = (arm.T_world_base @ arm.kinematics.forward_many(q))[:, :3, 3]
    chord = places[-1] - places[0]
    off = np.linalg.norm(np.cross(places - places[0], chord), axis=1) / np.linalg.norm(chord)
    assert off.max() > 0.1
    return np.asarray(places[int(np.argmax(off))])


@pytest.mark.parametrize(
    ("entry", "at", "kinds"),
    [
        ('{ command = "move_axes" }', AXES, {"ptp": "axes 10 -90 90 0 45 0"}),
        (
            '{ command = "move_linear", frame = "bench", approach = 0.1, speed = 0.2 }',
            "",
            {"ptp": "joint ", "lin": "linear 550 0.5 1200, 0 90 0 in bench"},
        ),
    ],
)
def test_moves_of_each_kind_are_in_the_table(
    entry: str, at: str, kinds: dict[str, str], tmp_path: Path
) -> None:
    where = cell(tmp_path / "cell", entry, at) if at else cell(tmp_path / "cell", entry)
    found = looked(where, tmp_path / "runs")
    assert found.of_moves == "yes", found.moves
    for kind, command in kinds.items():
        assert any(m.kind == kind and m.command.startswith(command) for m in found.moves)


def test_a_joint_position_beyond_the_limits_is_no_move(tmp_path: Path) -> None:
    where = cell(
        tmp_path / "cell", '{ command = "move_axes" }', AXES.replace("10.0 * Real", "70.0 * Real")
    )
    found = looked(where, tmp_path / "runs")
    assert found.of_moves == "no"
    (bad,) = [m for m in found.moves if m.answer == "no"]
    assert "axis 1 (`joint_1`) would be at 210.00 deg" in bad.problem and bad.run is not None
