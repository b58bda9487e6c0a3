"""Poses and transforms; the laws over random values are in tests/property/test_geometry.py."""

import math

import numpy as np
import pytest

from pn2code.robot.commands import Pose
from pn2code.robot.transforms import (
    angles_xyz,
    describe,
    difference,
    inverse,
    matrix_of,
    pose_of,
    rotation_about,
    rotation_vector,
    rotation_xyz,
    translation,
)


def test_angles_are_about_fixed_axes():
    """First about x, then about the world's y, then about the world's z."""
    a, b, c = 0.3, -0.4, 0.5
    expected = (
        rotation_about([0, 0, 1], c) @ rotation_about([0, 1, 0], b) @ rotation_about([1, 0, 0], a)
    )
    assert np.allclose(rotation_xyz(a, b, c), expected, atol=1e-15)


def test_quarter_turn_about_x_takes_z_to_minus_y():
    t = matrix_of(Pose(0, 0, 0, math.pi / 2, 0, 0))
    assert np.allclose(t[:3, 2], [0, -1, 0], atol=1e-15)


def test_paper_reference_orientation():
    """Table 2, row 1: 100 mm along -z of the tool at rX = -105 degrees."""
    t = matrix_of(Pose(5.75, 5.8988, 2.13505, math.radians(-105), 0, 0)) @ translation(0, 0, -0.1)
    assert 1000 * t[:3, 3] == pytest.approx([5750.0, 5802.2074, 2160.9319], abs=1e-4)


@pytest.mark.parametrize("ry", [math.pi / 2, -math.pi / 2])
def test_gimbal_lock_gives_the_same_rotation_with_rz_zero(ry):
    r = rotation_xyz(0.7, ry, 0.2)
    rx, ry2, rz = angles_xyz(r)
    assert rz == 0.0
    assert np.allclose(rotation_xyz(rx, ry2, rz), r, atol=1e-12)


@pytest.mark.parametrize("angle", [0.0, 1e-12, 0.1, 3.0, math.pi - 1e-9, math.pi])
@pytest.mark.parametrize("axis", [(1, 0, 0), (0, -1, 0), (0.6, 0.0, 0.8), (1 / 3, -2 / 3, 2 / 3)])
def test_rotation_vector_is_the_inverse_of_rotation_about(axis, angle):
    r = rotation_about(axis, angle)
    v = rotation_vector(r)
    size = float(np.linalg.norm(v))
    assert size == pytest.approx(angle, abs=1e-9)
    back = rotation_about(v / size, size) if size > 0 else np.eye(3)
    assert np.allclose(back, r, atol=1e-9)


def test_inverse_and_difference():
    a = matrix_of(Pose(1, 2, 3, 0.1, 0.2, 0.3))
    assert np.allclose(inverse(a) @ a, np.eye(4), atol=1e-15)
    away, turn = difference(a, a @ matrix_of(Pose(0, 0.003, 0.004, 0, 0, 0.25)))
    assert (away, turn) == (pytest.approx(0.005), pytest.approx(0.25))


def test_pose_of_is_the_inverse_of_matrix_of():
    p = Pose(-1.5, 2.5, 0.25, -1.8, 0.3, 2.9)
    q = pose_of(matrix_of(p))
    for name in Pose.__dataclass_fields__:
        assert getattr(q, name) == pytest.approx(getattr(p, name), abs=1e-14)


def test_describe_uses_the_units_of_scripts():
    text = describe(Pose(5.75, 0.0, 0.1, math.radians(-105), 0, 0))
    assert text == "(5750.00, 0.00, 100.00 mm; -105.00, 0.00, 0.00 deg)"
