"""A scene as glTF 2.0 in its binary form (GLB), which three.js and other programs read.

    scene = Gltf()
    cube = scene.geometry(points, triangles)            # a number; the same one for any colour and size
    seen = scene.shape(cube, frame, (0.8, 0.4, 0.1, 1), (1, 1, 1))
    group = scene.node("body", [seen])
    scene.scene("cell", [group])
    data = scene.glb()

Points are single-precision numbers rounded to steps of 1/131,072 m: 0.004 mm beside those that were given (from 128 m
on single precision has larger steps), with zeros at their ends that pack well. No extension is used. glTF has y above,
so each scene turns what is in it: below its root z is above, as in a cell. Colours are linear there, those of a cell
as a screen has them.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.replay.arrays import Numbers

Json = dict[str, Any]

STEPS = 131_072
"""Of a point, in a metre: a power of two, so that rounded numbers have zeros at their ends."""

_FLOAT, _U16, _U32 = 5126, 5123, 5125
_OF_POINTS, _OF_TRIANGLES = 34962, 34963
_Z_ABOVE = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]
_MAGIC, _JSON, _BIN = 0x46546C67, 0x4E4F534A, 0x004E4942


@frozen
class _Geometry:
    """The accessors of its points and triangles."""

    points: int
    triangles: int


class Gltf:
    """What is to be written: nodes by number, from the leaves to the scenes."""

    def __init__(self) -> None:
        self.nodes: list[Json] = []
        self._data = bytearray()
        self._views: list[Json] = []
        self._accessors: list[Json] = []
        self._scenes: list[Json] = []
        self._geometries: list[_Geometry] = []
        self._materials: dict[tuple[float, ...], int] = {}
        self._meshes: dict[tuple[int, int], int] = {}

    def geometry(self, points: Numbers, triangles: Numbers) -> int:
        """Points (m) and triangles (numbers of points), at least one of each."""
        rounded = (np.round(points * STEPS) / STEPS).astype("<f4")
        box = {"min": rounded.min(axis=0).tolist(), "max": rounded.max(axis=0).tolist()}
        kind, code = ("<u2", _U16) if len(points) <= 0xFFFF else ("<u4", _U32)
        self._geometries.append(
            _Geometry(
                self._accessor(rounded, len(rounded), _FLOAT, "VEC3", _OF_POINTS, **box),
                self._accessor(
                    triangles.reshape(-1).astype(kind),
                    triangles.size,
                    code,
                    "SCALAR",
                    _OF_TRIANGLES,
                ),
            )
        )
        return len(self._geometries) - 1

    def points(self, geometry: int) -> Numbers:
        """The points of a geometry as they are written."""
        return self._numbers(self._geometries[geometry].points, "<f4").reshape(-1, 3)

    def triangles(self, geometry: int) -> Numbers:
        """Its triangles."""
        accessor = self._geometries[geometry].triangles
        kind = "<u2" if self._accessors[accessor]["componentType"] == _U16 else "<u4"
        return self._numbers(accessor, kind).reshape(-1, 3)

    def shape(
        self, geometry: int, frame: Sequence[float], colour: Sequence[float], scale: Sequence[float]
    ) -> int:
        """A node: a geometry at a frame (by rows), in a colour (red, green, blue, opacity), so much larger."""
        key = (geometry, self._material(colour))
        mesh = self._meshes.setdefault(key, len(self._meshes))
        matrix = np.asarray(frame, float).reshape(4, 4) @ np.diag([*scale, 1.0])
        return self._node({"mesh": mesh, **_placed(matrix)})

    def node(
        self, name: str, children: Sequence[int], frame: Sequence[float] | Numbers | None = None
    ) -> int:
        """A node with others in it, at a frame (by rows)."""
        found: Json = {"name": name}
        if children:
            found["children"] = list(children)
        if frame is not None:
            found |= _placed(np.asarray(frame, float).reshape(4, 4))
        return self._node(found)

    def scene(self, name: str, nodes: Sequence[int]) -> None:
        """A scene; the first one is what is shown."""
        root = self.node(name, nodes)
        self.nodes[root]["rotation"] = _Z_ABOVE
        self._scenes.append({"name": name, "nodes": [root]})

    def glb(self) -> bytes:
        """The file."""
        by_number = sorted(self._meshes, key=lambda key: self._meshes[key])
        lists: Json = {
            "scenes": self._scenes,
            "nodes": self.nodes,
            "meshes": [{"primitives": [self._primitive(*key)]} for key in by_number],
            "materials": [_material(colour) for colour in self._materials],
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._data)}] if self._data else [],
        }
        head = {"asset": {"version": "2.0", "generator": "pn2code"}, "scene": 0}
        written = head | {name: rows for name, rows in lists.items() if rows}
        text = json.dumps(written, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
        chunks = _chunk(_JSON, text.encode("utf-8", "replace"), b" ")
        if self._data:
            chunks += _chunk(_BIN, bytes(self._data), b"\0")
        return struct.pack("<III", _MAGIC, 2, 12 + len(chunks)) + chunks

    def _primitive(self, geometry: int, material: int) -> Json:
        found = self._geometries[geometry]
        return {
            "attributes": {"POSITION": found.points},
            "indices": found.triangles,
            "material": material,
        }

    def _material(self, colour: Sequence[float]) -> int:
        return self._materials.setdefault(tuple(colour), len(self._materials))

    def _node(self, row: Json) -> int:
        self.nodes.append(row)
        return len(self.nodes) - 1

    def _accessor(
        self, array: Numbers, count: int, code: int, kind: str, target: int, **box: Any
    ) -> int:
        raw = array.tobytes()
        view = {
            "buffer": 0,
            "byteOffset": len(self._data),
            "byteLength": len(raw),
            "target": target,
        }
        self._data += raw + bytes(-len(raw) % 4)
        self._views.append(view)
        row = {"bufferView": len(self._views) - 1, "componentType": code, "count": count}
        self._accessors.append({**row, "type": kind, **box})
        return len(self._accessors) - 1

    def _numbers(self, accessor: int, kind: str) -> Numbers:
        view = self._views[self._accessors[accessor]["bufferView"]]
        start, size = view["byteOffset"], view["byteLength"]
        return np.frombuffer(bytes(self._data[start : start + size]), kind)


def _placed(matrix: Numbers) -> Json:
    """glTF has matrices by columns."""
    if np.array_equal(matrix, np.eye(4)):
        return {}
    return {"matrix": [round(float(v), 9) for v in matrix.T.reshape(-1)]}


def _material(colour: tuple[float, ...]) -> Json:
    *rgb, opacity = (min(max(v, 0.0), 1.0) for v in colour)
    linear = [round(_linear(v), 7) for v in rgb]
    shine = {"metallicFactor": 0.0, "roughnessFactor": 0.6}
    found: Json = {"pbrMetallicRoughness": {"baseColorFactor": [*linear, opacity], **shine}}
    return found | ({"alphaMode": "BLEND", "doubleSided": True} if opacity < 1 else {})


def _linear(value: float) -> float:
    """Of a colour as a screen has it (sRGB), how much light it is."""
    return float(value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4)


def _chunk(kind: int, data: bytes, filler: bytes) -> bytes:
    padded = data + filler * (-len(data) % 4)
    return struct.pack("<II", len(padded), kind) + padded
