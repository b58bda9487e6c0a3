"""The files in `models/` are what `build` makes today."""

from pn2code.robot.model import MODELS, known_arms, known_tools
from pn2code.robot.models.build import files
from pn2code.robot.models.shapes import block, lathe


def test_files_are_up_to_date():
    made = files()
    for name, text in made.items():
        assert (MODELS / name).read_text(encoding="utf-8") == text, (
            f"{name}: run python -m pn2code.robot.models.build"
        )
    present = {
        p.relative_to(MODELS).as_posix() for p in MODELS.rglob("*") if p.suffix in (".obj", ".urdf")
    }
    assert present == set(made)


def test_library_names():
    assert known_arms() == (
        "cobra_s600",
        "gantry_3000",
        "gp25",
        "iiwa14_r820",
        "irb6700_200_260",
        "kr120_r2500",
        "kr210_r2700",
        "lrmate200id",
        "tx2_90",
        "ur10e",
        "ur5e",
    )
    assert known_tools() == ("counterpoint", "drill_riveter", "vacuum_gripper")


def volume(mesh):
    """Signed: positive only when all faces look outwards."""
    import numpy as np

    return sum(float(np.dot(a, np.cross(b, c))) for a, b, c in mesh.triangles) / 6.0


def test_solids_are_closed_and_face_outwards():
    import math

    assert volume(block((0, 0, 0), (1, 2, 3), 0.001, 0.0005)) > 5.9
    for axis in "xyz":
        v = volume(lathe(axis, [(0.0, 1.0), (2.0, 1.0)]))
        assert 0.98 * 2 * math.pi < v < 2 * math.pi
