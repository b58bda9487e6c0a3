"""The glTF of a cell: what other programs read of it."""

from __future__ import annotations

import io
import json
import struct
from typing import Any

import numpy as np
import pytest
import trimesh

from pn2code.replay.gltf import STEPS, Gltf

TRIANGLE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]])
FACES = np.array([[0, 1, 2]])
UNIT = np.eye(4).reshape(-1).tolist()
ONES = (1.0, 1.0, 1.0)


def contents(data: bytes) -> Any:
    """The description in a GLB, whose chunks are as the specification wants them."""
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON" and size % 4 == 0
    if len(data) > 20 + size:
        more, kind = struct.unpack_from("<I4s", data, 20 + size)
        assert kind == b"BIN\0" and more % 4 == 0 and 28 + size + more == len(data)
    return json.loads(data[20 : 20 + size])


def loaded(data: bytes) -> Any:
    return trimesh.load(io.BytesIO(data), file_type="glb")


def test_another_program_sees_the_scene_with_y_above() -> None:
    gltf = Gltf()
    geometry = gltf.geometry(TRIANGLE, FACES)
    away = [1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1]
    seen = gltf.shape(geometry, UNIT, (1.0, 0.5, 0.0, 1.0), (2.0, 2.0, 2.0))
    gltf.scene("cell", [gltf.node("body", [seen], away)])
    (mesh,) = loaded(gltf.glb()).dump()
    assert np.allclose(mesh.vertices, [[5, 7, -6], [7, 7, -6], [5, 7, -10]])
    assert mesh.faces.tolist() == [[0, 1, 2]]


def test_a_shape_in_two_colours_has_its_points_once() -> None:
    gltf = Gltf()
    geometry = gltf.geometry(TRIANGLE, FACES)
    colours = [(1.0, 0.5, 0.0, 1.0), (0.2, 0.2, 0.2, 0.25), (1.0, 0.5, 0.0, 1.0)]
    gltf.scene("cell", [gltf.shape(geometry, UNIT, colour, ONES) for colour in colours])
    found = contents(gltf.glb())
    assert len(found["accessors"]) == len(found["meshes"]) == len(found["materials"]) == 2
    assert [node.get("mesh") for node in found["nodes"]] == [0, 1, 0, None]
    solid, clear = found["materials"]
    assert solid["pbrMetallicRoughness"]["baseColorFactor"] == pytest.approx([1, 0.21404, 0, 1], abs=1e-5)  # fmt: skip
    assert "alphaMode" not in solid and clear["alphaMode"] == "BLEND"
    assert "extensionsRequired" not in found


@pytest.mark.parametrize("size", [1.0, 0.37, 30.0])
def test_points_are_where_they_are_to_the_two_hundredth_of_a_millimetre(size: float) -> None:
    points = np.random.default_rng(3).uniform(-size, size, (500, 3))
    gltf = Gltf()
    geometry = gltf.geometry(points, np.arange(498)[:, None] + np.arange(3))
    gltf.scene("cell", [gltf.shape(geometry, UNIT, (1, 1, 1, 1), ONES)])
    assert np.abs(gltf.points(geometry) - points).max() <= 0.5 / STEPS + 1e-12 < 5e-6
    (mesh,) = loaded(gltf.glb()).geometry.values()
    assert np.abs(mesh.vertices.max(axis=0) - points.max(axis=0)).max() < 5e-6


def test_many_points_have_wide_numbers() -> None:
    gltf = Gltf()
    points = np.zeros((70_000, 3))
    geometry = gltf.geometry(points, np.array([[0, 1, 69_999]]))
    assert gltf.triangles(geometry).tolist() == [[0, 1, 69_999]]


def test_nothing_to_see_is_a_scene_all_the_same() -> None:
    gltf = Gltf()
    gltf.scene("cell", [gltf.node("body", [])])
    found = contents(gltf.glb())
    assert "buffers" not in found and found["scenes"] == [{"name": "cell", "nodes": [1]}]
