"""Poses and rigid transforms.

A transform is named `T_a_b`: it takes coordinates in `b` to `a`, so
`T_world_tcp = T_world_base @ T_base_flange @ T_flange_tcp`. Transforms are 4x4 arrays of double,
lengths in m. A `Pose` has fixed-axis XYZ angles, R = Rz(rz) Ry(ry) Rx(rx), in rad.

    >>> pose_of(matrix_of(Pose(1.0, 2.0, 3.0, 0.1, 0.2, 0.3))).rz
    0.3
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pn2code.robot.commands import Pose

Array: TypeAlias = NDArray[np.float64]
Flags: TypeAlias = NDArray[np.bool_]
Numbers: TypeAlias = NDArray[np.intp]

# cos(ry) below this: rx and rz turn about the same axis and only their sum is defined.
_GIMBAL = 1e-9


def rotation_xyz(rx: float, ry: float, rz: float) -> Array:
    """R = Rz(rz) Ry(ry) Rx(rx), angles in rad."""
    cx, sx = math.cos(rx), math.sin(rx)
    cy, sy = math.cos(ry), math.sin(ry)
    cz, sz = math.cos(rz), math.sin(rz)
    return np.array(
        [
            [cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx],
            [sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx],
            [-sy, cy * sx, cy * cx],
        ]
    )


def angles_xyz(rotation: Array) -> tuple[float, float, float]:
    """The fixed-axis angles (rx, ry, rz) of a rotation matrix, ry in [-pi/2, pi/2].

    Where ry is +-90 degrees the answer is not unique; rz = 0 is chosen then.
    """
    cy = math.hypot(rotation[0, 0], rotation[1, 0])
    ry = math.atan2(-rotation[2, 0], cy)
    if cy < _GIMBAL:
        return math.atan2(-rotation[1, 2], rotation[1, 1]), ry, 0.0
    rx = math.atan2(rotation[2, 1], rotation[2, 2])
    return rx, ry, math.atan2(rotation[1, 0], rotation[0, 0])


def matrix_of(pose: Pose) -> Array:
    """The 4x4 transform of a pose."""
    out = np.eye(4)
    out[:3, :3] = rotation_xyz(pose.rx, pose.ry, pose.rz)
    out[:3, 3] = (pose.x, pose.y, pose.z)
    return out


def pose_of(matrix: Array) -> Pose:
    """The pose of a 4x4 transform."""
    x, y, z = matrix[:3, 3].tolist()
    return Pose(x, y, z, *angles_xyz(matrix[:3, :3]))


def translation(x: float, y: float, z: float) -> Array:
    """A pure translation, in m."""
    out = np.eye(4)
    out[:3, 3] = (x, y, z)
    return out


def inverse(matrix: Array) -> Array:
    """The inverse of a rigid transform: `T_b_a` of `T_a_b`."""
    out = np.eye(4)
    out[:3, :3] = matrix[:3, :3].T
    out[:3, 3] = -matrix[:3, :3].T @ matrix[:3, 3]
    return out


def skew(axis: ArrayLike) -> Array:
    """The matrix K with K v = axis x v."""
    x, y, z = np.asarray(axis, float).tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def rotation_about(axis: ArrayLike, angle: ArrayLike) -> Array:
    """Rodrigues' formula for a unit axis; `angle` may be an array of shape (n,), giving (n, 3, 3)."""
    k = skew(axis)
    a = np.asarray(angle, float)[..., None, None]
    return np.asarray(np.eye(3) + np.sin(a) * k + (1.0 - np.cos(a)) * (k @ k))


def rotation_vector(rotation: Array) -> Array:
    """Axis times angle (rad, in [0, pi]) of a rotation matrix: the inverse of `rotation_about`."""
    w = 0.5 * np.array(
        [
            rotation[2, 1] - rotation[1, 2],
            rotation[0, 2] - rotation[2, 0],
            rotation[1, 0] - rotation[0, 1],
        ]
    )
    sine = float(np.linalg.norm(w))
    cosine = 0.5 * (float(np.trace(rotation)) - 1.0)
    angle = math.atan2(sine, cosine)
    if cosine > -0.99:
        return np.asarray(w * (angle / sine)) if sine > 0.0 else w
    # Near half a turn the sine vanishes; the axis is the eigenvector to eigenvalue 1.
    b = 0.5 * (rotation + rotation.T) - cosine * np.eye(3)
    column = b[:, int(np.argmax(np.diag(b)))]
    axis = column / np.linalg.norm(column)
    return np.asarray(axis * (angle if float(axis @ w) >= 0.0 else -angle))


def difference(a: Array, b: Array) -> tuple[float, float]:
    """How far two transforms are apart: distance of the origins (m) and angle (rad)."""
    turn = rotation_vector(a[:3, :3].T @ b[:3, :3])
    return float(np.linalg.norm(a[:3, 3] - b[:3, 3])), float(np.linalg.norm(turn))


def describe(pose: Pose) -> str:
    """A pose as people read it: mm and degrees, as in scripts and shared files."""
    mm = ", ".join(_rounded(1000.0 * v) for v in (pose.x, pose.y, pose.z))
    deg = ", ".join(_rounded(math.degrees(v)) for v in (pose.rx, pose.ry, pose.rz))
    return f"({mm} mm; {deg} deg)"


def _rounded(value: float) -> str:
    """Two decimals, never a negative zero."""
    text = f"{value:.2f}"
    return "0.00" if text == "-0.00" else text
