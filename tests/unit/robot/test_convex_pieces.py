"""Meshes as convex pieces: they cover the mesh, are always the same, and leave its pockets free."""

from __future__ import annotations

import tomllib
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest

from helpers.carrying_cell import TOML
from helpers.robot_cells import nowhere
from helpers.thorough import amount
from pn2code.diagnostics import Diagnostics
from pn2code.robot import convex_pieces
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.convex_pieces import COVERED, NoPieces, cover, pieces
from pn2code.robot.hulls import Hull
from pn2code.robot.mesh_files import read
from pn2code.robot.parts import Parts
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import Array

PROFILE = (
    *((-0.4, 0), (0.4, 0), (0.4, 0.9), (0.35, 0.9)),
    *((0.35, 0.5), (-0.35, 0.5), (-0.35, 0.9), (-0.4, 0.9)),
)
CAPS = ((0, 1, 4, 5), (1, 2, 3, 4), (0, 5, 6, 7))


@pytest.fixture
def fewer_tries(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pieces cover a mesh after any number of tries; with more they are less too large (`test_meshes_with_pockets`)."""
    monkeypatch.setattr(convex_pieces, "_TRIES", amount(2, 8))


def trough(folder: Path, lid: bool = True, top: float = 0.9) -> Path:
    """An upright U, 0.5 m long along x: its floor is at 0.5 m, its walls end at `top`."""
    n = len(PROFILE)
    profile = [(y, top if z > 0.5 else z) for y, z in PROFILE]
    points = [(x, y, z) for x in (-0.25, 0.25) for y, z in profile]
    faces = [(i, (i + 1) % n, (i + 1) % n + n) for i in range(n)]
    faces += [(i, (i + 1) % n + n, i + n) for i in range(n)]
    for a, b, c, d in CAPS if lid else CAPS[1:]:
        faces += [(a, c, b), (a, d, c), (a + n, b + n, c + n), (a + n, c + n, d + n)]
    lines = [f"v {x} {y} {z}" for x, y, z in points]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    file = folder / "trough.obj"
    file.write_text("\n".join(lines) + "\n")
    return file


def box(low: tuple[float, ...], high: tuple[float, ...]) -> Array:
    """The corners."""
    middle, size = (np.array(low) + high) / 2.0, np.array(high) - low
    return np.asarray(Hull.box((float(size[0]), float(size[1]), float(size[2]))).corners + middle)


def outside(points: Array, found: tuple[Array, ...]) -> float:
    """How far the worst of some points is outside of all pieces, m."""
    off = []
    for piece in found:
        own = convex_pieces._Piece.around(piece)
        off.append(own.off(points).max(axis=1))
    return float(np.min(off, axis=0).max())


def on_faces(file: Path, count: int = 3000) -> Array:
    """Points on all triangles, the corners among them."""
    points, triangles = read(file)
    weights = np.random.default_rng(1).dirichlet((0.5, 0.5, 0.5), count)
    spread = np.einsum("kc,tcx->tkx", weights, points[triangles]).reshape(-1, 3)
    return np.vstack([points, spread])


@pytest.mark.parametrize("most", [4, 2, 8][: amount(1, 3)])
def test_no_point_of_the_mesh_is_outside_of_all_pieces(
    most: int, tmp_path: Path, fewer_tries: None
) -> None:
    file = trough(tmp_path)
    found = pieces(file, most)
    assert 1 < len(found) <= most
    assert outside(on_faces(file), found) <= 2.0 * COVERED


def test_what_sticks_out_is_added() -> None:
    """Pieces with gaps, which leave a slot in the outside, a corner, and the inside uncovered."""
    folded = box((0, 0, 0), (1, 1, 1))
    from scipy.spatial import ConvexHull

    hull = ConvexHull(folded)
    turned = np.einsum(
        "ij,ij->i",
        np.cross(*(folded[hull.simplices[:, k]] - folded[hull.simplices[:, 0]] for k in (1, 2))),
        hull.equations[:, :3],
    )
    faces = np.where(turned[:, None] > 0, hull.simplices, hull.simplices[:, ::-1]).astype(np.int64)
    given = [box((0, 0, 0), (0.4, 1, 1)), box((0.45, 0, 0), (1, 0.95, 1))]
    inner = np.random.default_rng(2).random((4000, 3))
    assert outside(inner, tuple(given)) > 0.02
    assert outside(inner, cover(folded, faces, given)) <= 2.0 * COVERED
    # Of six slabs around a hollow, all faces are covered: it is looked inside.
    slabs = []
    for axis in range(3):
        for low, high in ((0.0, 0.2), (0.8, 1.0)):
            one, other = [0.0] * 3, [1.0] * 3
            one[axis], other[axis] = low, high
            slabs.append(box(tuple(one), tuple(other)))
    own = [convex_pieces._Piece.around(p) for p in slabs]
    assert not convex_pieces.uncovered(folded, faces, own, COVERED)
    assert outside(inner, tuple(slabs)) > 0.2
    assert outside(inner, cover(folded, faces, slabs)) <= 2.0 * COVERED


def test_pieces_are_kept_and_always_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fewer_tries: None
) -> None:
    file = trough(tmp_path)
    found = [pieces(file, 4)]  # of other tests
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "b"))
    pieces.cache_clear()
    found.append(pieces(file, 4))
    assert len(found[0]) > 1 and all(map(np.array_equal, *found))
    (kept,) = (tmp_path / "b" / "pn2code").glob("hulls-*.json")
    monkeypatch.setattr(convex_pieces, "_divided", lambda *_: pytest.fail("divided once more"))
    pieces.cache_clear()
    assert all(map(np.array_equal, found[0], pieces(file, 4)))
    whole = kept.read_text()
    smaller = whole.replace("[[[", "[[[0.0625, 0.0, 0.0], [", 1)
    for damaged in ("[[[0", whole[:-9], smaller, smaller.partition("\n")[2]):
        kept.write_text(damaged)
        pieces.cache_clear()
        with pytest.raises(pytest.fail.Exception):
            pieces(file, 4)
    pieces.cache_clear()


def test_what_is_not_closed_is_refused(tmp_path: Path) -> None:
    with pytest.raises(NoPieces, match="not closed"):
        pieces(trough(tmp_path, lid=False), 4)
    d = Diagnostics()
    data = tomllib.loads(TOML)
    thing = {"name": "u", "kind": "mesh", "file": "trough.obj", "hulls": 4}
    data["scene"]["objects"].append(thing)
    assert load(data, tmp_path, nowhere, d) is None
    (problem,) = d.errors
    assert "`hulls`" in problem.message and "not closed" in problem.message + problem.hint


@pytest.mark.bullet
@pytest.mark.parametrize("hulls", [1, 4])
def test_a_part_stands_in_a_pocket(hulls: int, tmp_path: Path, fewer_tries: None) -> None:
    """PyBullet measures to the pieces, and it stands on the floor of the pocket, also as a part or a link."""
    trough(tmp_path)
    data = tomllib.loads(TOML)
    mesh = {"kind": "mesh", "file": "trough.obj", "hulls": hulls}
    data["scene"]["objects"] = [{"name": "u", "pose": {"x": 1.5}, **mesh}]
    data["parts"]["box"]["at"] = [{"x": 1.5, "z": 0.575}, {"x": 1.5, "y": 3.0, "z": 0.575}]
    data["parts"]["trough"] = {**mesh, "at": [{"x": 1.5, "y": 3.0}]}
    d = Diagnostics()
    cell = load(data, tmp_path, nowhere, d)
    assert cell is not None, [e.message for e in d.errors]
    parts = Parts(cell)
    backend = BulletBackend(cell, looks=False)
    try:
        for part in parts.present.values():
            backend.set_part(part)
        beside = [backend.around(name, 0.2) or () for name in ("box.1", "box.2")]
    finally:
        backend.close()
    gaps = [x.distance for found in beside for x in found if x.name in ("u", "trough.1")]
    rests = [parts.rest(parts.present[n]) for n in ("box.1", "box.2")]
    on = [r.on if r is not None else () for r in rests]
    if hulls == 1:
        assert len(gaps) == 2 and max(gaps) < -0.05 and on == [(), ()]
    else:
        # PyBullet has a margin of 1 mm around hulls.
        assert len(gaps) == 2 and min(gaps) > -0.001 - 1e-5 and on == [("u",), ("trough.1",)]


TOOL = """<robot name="t"><link name="hand"><collision><origin xyz="0 0 0.1"/>
<geometry><mesh filename="trough.obj" hulls="{hulls}" scale="0.1 0.1 0.1"/></geometry></collision></link>
<link name="tcp"/>
<joint name="j" type="fixed"><parent link="hand"/><child link="tcp"/></joint></robot>
"""


def with_tool(folder: Path, hulls: str, d: Diagnostics) -> RobotCell | None:
    (folder / "hand.urdf").write_text(TOOL.format(hulls=hulls))
    data = tomllib.loads(TOML)
    data["robots"]["robot"]["tool"] = "hand.urdf"
    return load(data, folder, nowhere, d)


@pytest.mark.bullet
def test_a_link_of_several_pieces(tmp_path: Path, fewer_tries: None) -> None:
    """PyBullet measures to a collision mesh of a tool by its pieces: what is in its pocket is not in it."""
    trough(tmp_path)
    d = Diagnostics()
    depths = []
    for hulls in ("1", "4"):
        cell = with_tool(tmp_path, hulls, d)
        assert cell is not None, [e.message for e in d.errors]
        backend = BulletBackend(cell, looks=False)
        try:
            p, client, own = backend._p, backend._client, backend._robots["robot"]
            link = own.index["tool_hand"]
            place, turn = p.getLinkState(own.body, link, physicsClientId=client)[4:6]
            at, _ = p.multiplyTransforms(place, turn, (0.0, 0.0, 0.17), (0.0, 0.0, 0.0, 1.0))
            shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.01, physicsClientId=client)
            ball = p.createMultiBody(0, shape, -1, at, physicsClientId=client)
            found = p.getClosestPoints(ball, own.body, 0.1, -1, link, physicsClientId=client)
            depths.append(min(c[8] for c in found))
        finally:
            backend.close()
    assert depths[0] < 0.0 and depths[1] == pytest.approx(0.009, abs=0.0015)


@pytest.mark.parametrize("hulls", ["0", "257", "many", "2.5"])
def test_an_attribute_that_is_no_count_is_refused(hulls: str, tmp_path: Path) -> None:
    trough(tmp_path)
    d = Diagnostics()
    assert with_tool(tmp_path, hulls, d) is None
    assert any("no whole number from 1 to 256" in e.message for e in d.errors)


def test_a_link_that_cannot_be_divided_is_refused(tmp_path: Path) -> None:
    trough(tmp_path, lid=False)
    d = Diagnostics()
    assert with_tool(tmp_path, "4", d) is None
    assert any("not closed" in e.message for e in d.errors)


def test_without_coacd_it_is_said_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def missing(name: str) -> str:
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "version", missing)
    with pytest.raises(NoPieces, match="pn2code\\[hulls\\]"):
        pieces(trough(tmp_path), 5)
