"""What the supervisor of the riveting cell must send, computed independently of the net.

In: the number of points between two references and their poses (mm, degrees). Out: for each robot
the rows of its `dadosroboN` in order, as the paper's Table 2 lists them:

    rows(5, first, last)[0][0]   (5750.0, 5802.2072..., 2160.9320..., -105.0, 0.0, 0.0)   approach, world
    rows(5, first, last)[0][1]   (0.0, 0.0, 100.0, 0.0, 0.0, 0.0)                         in, tool frame
    ...
    rows(5, first, last)[0][21]  (-833.3333..., 0.0, 0.0, 0.0, 0.0, 0.0)                  way back

Input numbers and the pitch are single precision, everything else is double: with any other choice
Table 2 does not come out digit for digit. Written with matrices, where the net has formulas.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Row = tuple[float, float, float, float, float, float]
Matrix = NDArray[np.float64]

STANDOFF_MM = 100.0


def rotation(rx_deg: float, ry_deg: float, rz_deg: float) -> Matrix:
    """Fixed-axis XYZ: about the world's x axis first, then y, then z."""

    def about(axis: int, degrees: float) -> Matrix:
        i, j = (axis + 1) % 3, (axis + 2) % 3
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        r = np.eye(3)
        r[i, i], r[i, j], r[j, i], r[j, j] = c, -s, s, c
        return r

    return about(2, rz_deg) @ about(1, ry_deg) @ about(0, rx_deg)


def turned(degrees: float) -> float:
    """The angle plus half a turn, in (-180, 180]."""
    angle = (degrees + 180.0) % 360.0
    return angle if angle <= 180.0 else angle - 360.0


def rows(
    n: int,
    first: Sequence[float],
    last: Sequence[float],
    *,
    safe_return: bool = False,
    measured: tuple[Sequence[float], Sequence[float]] | None = None,
) -> tuple[list[Row], list[Row]]:
    """The rows for robot 1 and robot 2.

    Args:
        n: points between the references, so n + 2 rivets.
        first, last: poses of the references: x y z (mm) rx ry rz (degrees).
        safe_return: go back by n + 1 pitches; the paper goes back by n.
        measured: what the vision system answers; None: the references are where they should be.
    """
    p, q = (np.asarray(np.asarray(v, dtype=np.float32), dtype=np.float64) for v in (first, last))
    a, b = p, q
    if measured is not None:
        a, b = (np.asarray(v, dtype=np.float64) for v in measured)
    offset = a[:3] - p[:3]
    start, end = p[:3] + offset, q[:3] + (b[:3] - q[:3])
    pitch = np.asarray(((end - start) / (n + 1)).astype(np.float32), dtype=np.float64)
    back = -(n + 1 if safe_return else n) * pitch

    outward = rotation(*p[3:]) @ np.array([0.0, 0.0, STANDOFF_MM])
    poses = (
        (*(p[:3] - outward), *p[3:]),
        (*(p[:3] + outward), turned(p[3]), p[4], p[5]),
    )
    result = []
    for pose in poses:
        to_tool = rotation(*pose[3:]).T

        def tool(v: Matrix, to_tool: Matrix = to_tool) -> Row:
            x, y, z = (float(c) for c in to_tool @ v)
            return (x, y, z, 0.0, 0.0, 0.0)

        out: list[Row] = [tuple(float(c) for c in pose)]  # type: ignore[list-item]
        if offset.any():
            out.append(tool(offset))
        for k in range(n + 2):
            out.append((0.0, 0.0, STANDOFF_MM, 0.0, 0.0, 0.0))
            out.append((0.0, 0.0, -STANDOFF_MM, 0.0, 0.0, 0.0))
            out.append(tool(pitch) if k < n + 1 else tool(back))
        result.append(out)
    return result[0], result[1]


def printed(row: Sequence[float]) -> str:
    """A row as Table 2 prints it: four decimals, never `-0.0000`."""
    return " ".join(
        f"{v:.4f}".replace("-0.0000", "0.0000") if abs(v) < 1 else f"{v:.4f}" for v in row
    )
