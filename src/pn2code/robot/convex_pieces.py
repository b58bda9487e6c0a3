"""Meshes as several convex pieces, which together cover them.

    pieces(path, most=8)        # the points of each piece, (n, 3); NoPieces: there are none, and why

CoACD cuts a mesh into pieces that follow it to some hundredths of its size. What of the mesh sticks out of them, as
where it was cut with a gap, is added to the piece that grows least by it: each triangle is clipped at the faces of all
pieces, so no face of the mesh is outside of them by more than `COVERED` of its size. What is between pieces inside of
the mesh, which must be closed, is filled likewise. Pieces may be too large, never too small: a distance measured
to them is none too long.

They are kept in the user's cache folder, by a digest of the mesh.
"""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import tempfile
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.base.private_folder import private_folder, write_whole
from pn2code.base.sha256 import sealed, unsealed
from pn2code.robot.mesh_files import NoMesh, Points, Triangles, read
from pn2code.robot.transforms import Array

COVERED = 1e-7
"""Of the size of a mesh: so far a face of it may be outside of all pieces."""
_FOLLOWS = 0.01
"""How near the pieces come to the mesh if there may be enough of them, of half of its size."""
_TRIES = 8
"""How often CoACD divides it, for the best of these."""
_LITTLE = 0.002
"""Of the size of a mesh: by what a piece grows by no more is not divided among others."""
_HALVINGS = 8
_PATIENCE_S = 600.0
_ROUNDS = 8
_FORM = "2"
"""Of what is kept; another one is made anew."""


class NoPieces(ValueError):
    """A mesh could not be divided; the message says why, a clause."""


@lru_cache(maxsize=64)
def pieces(path: Path, most: int) -> tuple[Array, ...]:
    """The points of at most so many convex pieces that cover a mesh file."""
    from importlib import metadata  # as slow as reading a small net, and rarely needed

    try:
        points, triangles = read(path)
    except (OSError, NoMesh) as problem:
        raise NoPieces(str(getattr(problem, "strerror", None) or problem)) from None
    if not len(triangles):
        raise NoPieces("it has no triangles")
    if not _is_closed(points, triangles):
        raise NoPieces("it is not closed, so that nobody knows what is inside of it")
    try:
        version = metadata.version("coacd")
    except metadata.PackageNotFoundError:
        raise NoPieces(
            "package `coacd` is not installed; `pip install 'pn2code[hulls]'` brings it"
        ) from None
    said = f"{_FORM} {version} {_FOLLOWS} {_TRIES} {COVERED} {most}".encode()
    digest = hashlib.sha256(said + points.tobytes() + b"|" + triangles.tobytes()).hexdigest()[:40]
    folder = private_folder()
    kept = folder / f"hulls-{digest}.json" if folder is not None else None
    if kept is not None and (found := _kept(kept)):
        return found
    out = _best(points, triangles, _divided(points, triangles, most))
    if kept is not None:
        with suppress(OSError):  # it is made again
            write_whole(kept, sealed(json.dumps([p.tolist() for p in out]).encode()))
    return out


def _is_closed(points: Points, triangles: Triangles) -> bool:
    """Whether its triangles meet at each edge, as many one way as the other."""
    _, same = np.unique(points, axis=0, return_inverse=True)
    a, b, c = same.reshape(-1)[triangles].T
    ends = np.vstack([np.stack(pair, axis=1) for pair in ((a, b), (b, c), (c, a))])
    ends = ends[ends[:, 0] != ends[:, 1]]
    ways = np.where(ends[:, 0] < ends[:, 1], 1, -1)
    _, which = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
    return not np.bincount(which.reshape(-1), weights=ways).any()


def _kept(path: Path) -> tuple[Array, ...]:
    """What was kept; () if there is nothing, or it is not what was written: other pieces cover another thing."""
    try:
        body = unsealed(path.read_bytes())
        if body is None:
            return ()
        return tuple(np.array(p, float).reshape(-1, 3) for p in json.loads(body))
    except (OSError, ValueError):
        return ()


def _best(points: Points, triangles: Triangles, tries: list[list[Array]]) -> tuple[Array, ...]:
    """Of some divisions, when they cover the mesh, the one that is least too large: CoACD cuts where chance has it."""
    best: tuple[Array, ...] = ()
    least, why = np.inf, NoPieces("CoACD finds no pieces of it")
    for found in tries:
        try:
            grown = cover(points, triangles, found)
        except NoPieces as problem:
            why = problem
            continue
        size = sum(_Piece.around(p).volume for p in grown)
        if size < least:
            least, best = size, grown
    if not best:
        raise why
    return best


def _divided(points: Points, triangles: Triangles, most: int) -> list[list[Array]]:
    """As CoACD divides it, `_TRIES` times, always in the same ways."""
    from pn2code.robot import coacd_child

    used, which = np.unique(triangles, return_inverse=True)
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        source, target = Path(name) / "in.npz", Path(name) / "out.npz"
        np.savez(
            source,
            points=points[used],
            triangles=which.reshape(-1, 3).astype(np.int32),
            most=most,
            threshold=_FOLLOWS,
            tries=_TRIES,
        )
        command = [sys.executable, "-P", str(coacd_child.__file__), str(source), str(target)]
        try:
            done = subprocess.run(
                command,
                capture_output=True,
                timeout=_PATIENCE_S,
                env={**os.environ, "OMP_NUM_THREADS": "1"},
            )
        except subprocess.TimeoutExpired:
            raise NoPieces(f"CoACD was not done after {_PATIENCE_S:g} s") from None
        if done.returncode or not target.is_file():
            last = done.stderr.decode(errors="replace").strip().splitlines()[-1:]
            raise NoPieces("CoACD cannot divide it" + "".join(f": {line}" for line in last))
        with np.load(target) as found:
            out: list[list[Array]] = [[] for _ in range(_TRIES)]
            for name in found.files:
                out[int(name.split("_")[0])].append(np.array(found[name], float))
    return [x for x in out if x]


# That nothing sticks out


@frozen(eq=False)
class _Piece:
    points: Array
    normals: Array
    offsets: Array
    faces: Array
    outwards: Array
    volume: float

    @staticmethod
    def around(points: Array) -> _Piece:
        from scipy.spatial import ConvexHull, QhullError  # takes a while

        try:
            hull: Any = ConvexHull(points)
        except (QhullError, ValueError):
            raise NoPieces("a piece of it is flat") from None
        planes = np.unique(hull.equations, axis=0)
        faces = points[hull.simplices]
        return _Piece(
            points[hull.vertices],
            planes[:, :3],
            planes[:, 3],
            faces,
            hull.equations[:, :3],
            float(hull.volume),
        )

    def off(self, points: Array) -> Array:
        """How far points are outside of each face, (points, faces)."""
        return np.asarray(points @ self.normals.T + self.offsets)


def cover(points: Points, triangles: Triangles, found: list[Array]) -> tuple[Array, ...]:
    """The pieces, grown until they cover the mesh: all triangles, lone points, and what is inside."""
    size = float(np.ptp(points, axis=0).max())
    near = COVERED * size
    own = [_Piece.around(p) for p in found]
    for _ in range(_ROUNDS):
        left = uncovered(points, triangles, own, near)
        if not left:
            break
        own = _grown(own, [(polygon, -1) for polygon in left], _LITTLE * size)
    else:
        raise NoPieces("its pieces do not cover it")
    for _ in range(_ROUNDS):
        hollow = _hollow(points[triangles], own, near)
        if not hollow:
            return tuple(p.points for p in own)
        own = _grown(own, hollow, _LITTLE * size)
    raise NoPieces("there is a hollow between its pieces")


def uncovered(points: Points, triangles: Triangles, own: list[_Piece], near: float) -> list[Array]:
    """Of the faces and lone points of a mesh what is outside of all pieces, by more than `near`: convex polygons."""
    within = [np.asarray((p.off(points) <= near).all(axis=1)) for p in own]
    whole = np.any([w[triangles].all(axis=1) for w in within], axis=0)
    lone = np.ones(len(points), bool)
    lone[triangles.ravel()] = False
    lone &= ~np.any(within, axis=0)
    out = [points[i : i + 1] for i in np.flatnonzero(lone)]
    for triangle in points[triangles[~whole]]:
        out += _outside_of_all(triangle, own, near)
    return out


def _outside_of_all(polygon: Array, own: list[_Piece], near: float) -> list[Array]:
    left = [polygon]
    for piece in own:
        left = [part for one in left for part in _outside(one, piece, near)]
        if not left:
            break
    return left


def _outside(polygon: Array, piece: _Piece, near: float) -> list[Array]:
    """What of a convex polygon is outside of a piece by more than `near`."""
    off = piece.off(polygon) - near
    if (off.min(axis=0) > 0.0).any():
        return [polygon]
    out, rest = [], polygon
    for i in np.flatnonzero(off.max(axis=0) > 0.0):
        values = rest @ piece.normals[i] + piece.offsets[i] - near
        if values.max() > 0.1 * near:
            out.append(_side(rest, values))
        rest = _side(rest, -values)
        if not len(rest):
            return [polygon]
    return out


def _side(polygon: Array, values: Array) -> Array:
    """The part of a polygon where values at its corners are not negative."""
    after = np.roll(np.arange(len(polygon)), -1)
    out = []
    for i, j in enumerate(after):
        a, b = values[i], values[j]
        if a >= 0.0:
            out.append(polygon[i])
        if (a < 0.0 < b) or (b < 0.0 < a):
            out.append(polygon[i] + (polygon[j] - polygon[i]) * (a / (a - b)))
    return np.array(out).reshape(-1, 3)


def _grown(own: list[_Piece], more: list[tuple[Array, int]], little: float) -> list[_Piece]:
    """The pieces with polygons, each in the one that grows least by it, but not in the one of that number.

    A polygon by which every piece would grow by more than `little` is divided.
    """
    added: dict[int, list[Array]] = {}

    def add(polygon: Array, but: int, halvings: int) -> None:
        far = [
            float(p.off(polygon).max()) if i != but or len(own) == 1 else np.inf
            for i, p in enumerate(own)
        ]
        best = int(np.argmin(far))
        along = np.roll(polygon, -1, axis=0) - polygon
        lengths = np.linalg.norm(along, axis=1)
        i = int(np.argmax(lengths))
        if far[best] <= little or not halvings or lengths[i] <= little:
            added.setdefault(best, []).append(polygon)
            return
        values = (polygon - polygon[i] - along[i] / 2.0) @ along[i]
        for half in (_side(polygon, values), _side(polygon, -values)):
            if len(half):
                add(half, but, halvings - 1)

    for polygon, but in more:
        add(polygon, but, _HALVINGS)
    return [
        _Piece.around(np.vstack([p.points, *added[i]])) if i in added else p
        for i, p in enumerate(own)
    ]


def _hollow(mesh: Array, own: list[_Piece], near: float) -> list[tuple[Array, int]]:
    """The faces of pieces before which, inside of a closed mesh, there is no piece; and whose they are."""
    step = 3.0 * near
    out = []
    for i, piece in enumerate(own):
        others = [p for j, p in enumerate(own) if j != i]
        for face, outwards in zip(piece.faces, piece.outwards, strict=True):
            for part in _outside_of_all(face, others, 2.0 * step):
                middle = part.mean(axis=0)
                looked = np.vstack([middle, 0.9 * part + 0.1 * middle]) + step * outwards
                if _is_wide(part, 2.0 * step) and (_winding(mesh, looked) > 0.5).any():
                    out.append((part, i))
    return out


def _is_wide(polygon: Array, least: float) -> bool:
    along = np.roll(polygon, -1, axis=0) - polygon
    area = np.linalg.norm(np.cross(polygon - polygon[0], along).sum(axis=0)) / 2.0
    return bool(area > least * np.linalg.norm(along, axis=1).sum())


def _winding(mesh: Array, points: Array) -> Array:
    """How often a mesh goes around points, either way: above one half, they are inside."""
    out = []
    for point in points:
        a, b, c = (mesh - point).transpose(1, 0, 2)
        la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
        up = np.einsum("ij,ij->i", a, np.cross(b, c))
        dot = np.einsum("ij,ij->i", a, b) * lc + np.einsum("ij,ij->i", b, c) * la
        down = la * lb * lc + dot + np.einsum("ij,ij->i", c, a) * lb
        out.append(abs(np.arctan2(up, down).sum()) / (2.0 * np.pi))
    return np.array(out)
