"""Mesh files of users: OBJ and STL, sound, damaged, and too large."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from pn2code.replay import meshes
from pn2code.replay.gltf import Gltf
from pn2code.replay.meshes import Meshes

SQUARE = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\n"
STL_TEXT = """solid a
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 2 0 0
vertex 2 1 0
endloop
endfacet
endsolid
"""


def points(store: Meshes, mesh: int) -> set[tuple[float, ...]]:
    return {tuple(round(float(v), 4) for v in p) for p in store.gltf.points(mesh)}


@pytest.mark.parametrize(
    "faces", ["f 1 2 3 4\n", "f 1//1 2//1 3//2\nf -4 -2 -1\n", "f 1/1/1 2/2/1 3/3/1 4/4/1\n"]
)
def test_an_obj_file(faces: str, tmp_path: Path) -> None:
    file = tmp_path / "a.obj"
    file.write_text(SQUARE + "vn 0 0 1\n" + faces)
    store = Meshes(Gltf())
    mesh = store.file(file)
    assert store.file(file) == mesh
    assert points(store, mesh) == {(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)}
    assert store.gltf.triangles(mesh).tolist() == [[0, 1, 2], [0, 2, 3]]


def test_an_stl_file_of_either_kind(tmp_path: Path) -> None:
    (tmp_path / "text.stl").write_text(STL_TEXT)
    corners = (0, 0, 0, 2, 0, 0, 2, 1, 0)
    binary = bytes(80) + struct.pack("<I12fH", 1, 0, 0, 1, *corners, 0)
    (tmp_path / "binary.stl").write_bytes(binary)
    store = Meshes(Gltf())
    found = [points(store, store.file(tmp_path / name)) for name in ("text.stl", "binary.stl")]
    assert found[0] == found[1] == {(0, 0, 0), (2, 0, 0), (2, 1, 0)}


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.obj", SQUARE + "f 1 2 9\n"),
        ("a.obj", "v 1 x 2\n"),
        ("a.stl", "solid a vertex 1 2\n"),
        ("a.stl", ""),
    ],
)
def test_a_damaged_file_is_nothing_to_see_and_is_named(
    name: str, text: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_text(text)
    store = Meshes(Gltf())
    mesh = store.file(tmp_path / name)
    assert mesh == -1
    assert len(store.simplified) == 1 and name in store.simplified[0]


def test_a_mesh_that_is_too_large_becomes_a_box(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(meshes, "MOST_TRIANGLES", 1)
    (tmp_path / "a.obj").write_text(SQUARE + "v 0 0 1\nf 1 2 3 4\nf 1 2 5\n")
    store = Meshes(Gltf())
    mesh = store.file(tmp_path / "a.obj")
    assert np.ptp(store.gltf.points(mesh), axis=0) == pytest.approx([2.0, 1.0, 1.0], abs=1e-4)
    assert "3 triangles" in store.simplified[0]


def test_a_capsule_is_longer_than_it_says_by_its_round_ends() -> None:
    store = Meshes(Gltf())
    found = np.array(sorted(points(store, store.capsule(0.1, 0.5))))
    assert found[:, 2].min() == pytest.approx(-0.35) and found[:, 2].max() == pytest.approx(0.35)
    across = np.hypot(found[:, 0], found[:, 1])
    assert np.abs(across[np.abs(found[:, 2]) <= 0.2501] - 0.1).max() < 1e-3
    past = np.maximum(np.abs(found[:, 2]) - 0.25, 0.0)
    assert np.abs(np.hypot(across, past) - 0.1).max() < 1e-3
    assert store.capsule(0.1, 0.5) == 0
