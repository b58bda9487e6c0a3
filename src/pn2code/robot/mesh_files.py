"""Points and triangles of mesh files: Wavefront OBJ and STL, binary or text.

points, triangles = read(Path("link_1.obj"))      # NoMesh, or OSError, if it cannot be read
"""

from __future__ import annotations

import re
import struct
from io import StringIO
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Points: TypeAlias = NDArray[np.float64]
Triangles: TypeAlias = NDArray[np.int64]

_KINDS = frozenset("vf")
_MORE = re.compile("/[^ ]*")
"""What a face says of a corner besides its point."""
_STL_HEAD, _STL_ROW = 84, 50


class NoMesh(ValueError):
    """A file is not a mesh that can be read; the message says why."""


def read(path: Path) -> tuple[Points, Triangles]:
    """An OBJ or STL file."""
    return _stl(path) if path.suffix.lower() == ".stl" else _obj(path)


def merged(corners: Points) -> tuple[Points, Triangles]:
    """Corners of triangles, three after each other, with those at the same place made one; flat triangles go."""
    rows, which = np.unique(np.round(corners * 1e5).astype(np.int64), axis=0, return_inverse=True)
    triangles = which.reshape(-1, 3)
    a, b, c = triangles.T
    return rows / 1e5, triangles[(a != b) & (b != c) & (c != a)]


def _obj(path: Path) -> tuple[Points, Triangles]:
    """Points and faces of a Wavefront file; all else (normals, textures, materials) is passed over."""
    text = path.read_text(encoding="utf-8", errors="replace")
    return _plain_obj(text) or _any_obj(text)


def _plain_obj(text: str) -> tuple[Points, Triangles] | None:
    """Those of a file as most programs write them: points of three numbers, then triangles that count from 1.

    None: it is not of that kind, or something is wrong with it, of which the reader of every form knows more.
    """
    corners: list[str] = []
    faces: list[str] = []
    for line in text.split("\n"):
        kind = line[:2]
        if kind in ("v ", "f ") and line.count(" ") == 3:
            (corners if kind == "v " else faces).append(line[2:])
        elif kind[:1].isspace() or (kind[:1] in _KINDS and (len(kind) < 2 or kind[1].isspace())):
            return None
    try:
        points = np.array([float(w) for w in " ".join(corners).split(" ")]).reshape(-1, 3)
        numbers = [int(w) - 1 for w in _MORE.sub("", " ".join(faces)).split(" ")]
    except ValueError:
        return None
    if min(numbers) < 0 or max(numbers) >= len(points):
        return None
    return points, np.array(numbers, np.int64).reshape(-1, 3)


def _any_obj(text: str) -> tuple[Points, Triangles]:
    points: list[list[float]] = []
    triangles: list[tuple[int, int, int]] = []
    with StringIO(text) as lines:
        for number, line in enumerate(lines, 1):
            words = line.split()
            try:
                if words[:1] == ["v"]:
                    points.append([float(w) for w in words[1:4]])
                elif words[:1] == ["f"]:
                    at = [int(w.split("/")[0]) for w in words[1:]]
                    at = [i - 1 if i > 0 else len(points) + i for i in at]
                    triangles += [(at[0], b, c) for b, c in zip(at[1:], at[2:], strict=False)]
            except (ValueError, IndexError):
                raise NoMesh(f"line {number} is not of the OBJ format") from None
    found = np.array(triangles, np.int64).reshape(-1, 3)
    if any(len(p) != 3 for p in points) or (
        found.size and not 0 <= int(found.min()) <= int(found.max()) < len(points)
    ):
        raise NoMesh("its points or faces are incomplete")
    return np.array(points, float).reshape(-1, 3), found


def is_binary_stl(path: Path) -> bool:
    """Whether an STL file is binary: as long as the number of its triangles says."""
    return _count(path.read_bytes()) is not None


def _count(data: bytes) -> int | None:
    if len(data) < _STL_HEAD:
        return None
    count: int = struct.unpack_from("<I", data, 80)[0]
    return count if len(data) == _STL_HEAD + count * _STL_ROW else None


def _stl(path: Path) -> tuple[Points, Triangles]:
    """Triangles of an STL file, binary or text."""
    data = path.read_bytes()
    count = _count(data)
    if count is not None:
        row = np.dtype([("normal", "<f4", 3), ("corners", "<f4", 9), ("more", "<u2")])
        rows = np.frombuffer(data, row, count, _STL_HEAD)
        return merged(rows["corners"].reshape(-1, 3).astype(float))
    words = data.decode("utf-8", "replace").split()
    at = [i for i, w in enumerate(words) if w.lower() == "vertex"]
    try:
        corners = np.array([[float(w) for w in words[i + 1 : i + 4]] for i in at], float)
    except ValueError:
        raise NoMesh("it is not of the STL format") from None
    if not at or len(at) % 3 or corners.shape != (len(at), 3):
        raise NoMesh("it is not of the STL format")
    return merged(corners)
