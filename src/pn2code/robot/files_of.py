"""The files that a cell in space was read from, and those that its shapes are in.

files_of(cell)      # {.../models/kr210_r2700.urdf, .../meshes/kr210_r2700/link_1.obj, ...}
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from pathlib import Path

from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.urdf import Urdf, mesh_file


def files_of(cell: RobotCell) -> frozenset[Path]:
    """Models of arms and tools with their meshes, and the meshes of things and parts; cell.toml is not among them."""
    return frozenset(_paths(cell))


def _paths(value: object) -> Iterator[Path]:
    """Every path anywhere in a value."""
    if isinstance(value, Path):
        yield value
    elif isinstance(value, Urdf):
        folder = value.path.parent
        if value.path.suffix == ".urdf":  # trees of devices are made, not read
            yield value.path
        yield from (mesh_file(mesh, folder) for mesh in value.xml.iter("mesh"))
    elif dataclasses.is_dataclass(value):
        for field in dataclasses.fields(value):
            yield from _paths(getattr(value, field.name))
    elif isinstance(value, Mapping):
        for own in value.values():
            yield from _paths(own)
    elif isinstance(value, tuple | list | frozenset):
        for own in value:
            yield from _paths(own)
