"""The closed-form inverse of `py-opw-kinematics`, without what its package loads besides.

That package wraps its compiled module for poses as SciPy has them, and SciPy takes longer to load than the whole check
of a cell. Here poses are 4x4 arrays, so the compiled module is loaded by itself. What it answers is compared with the
forward kinematics of the URDF, first in `chain.derive` and then at each answer, so a release that counts otherwise
cannot go unnoticed.
"""

from __future__ import annotations

import importlib.util
import sys
from importlib.machinery import PathFinder
from types import ModuleType
from typing import Any

import numpy as np

from pn2code.robot.transforms import Array

_PACKAGE = "py_opw_kinematics"


def _compiled() -> ModuleType:
    """The compiled module; the package's own way to it is taken where it is not where it was in release 1.3."""
    name = f"{_PACKAGE}._internal"
    if name in sys.modules:
        return sys.modules[name]
    package = importlib.util.find_spec(_PACKAGE)
    if package is None:
        raise ModuleNotFoundError(f"No module named {_PACKAGE!r}", name=_PACKAGE)
    spec = PathFinder.find_spec(name, package.submodule_search_locations)
    if spec is None or spec.loader is None:
        return importlib.import_module(name)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    sys.modules[name] = module
    return module


_opw: Any = _compiled()
KinematicModel: Any = _opw.KinematicModel
"""Lengths, offsets and directions of an arm with parallel axes 2 and 3 and a spherical wrist."""


_NOWHERE = np.array([[1e9, -1e9]] * 6)
"""Limits (rad) between which no angle is: of what is outside, the library works out no conditioning, which takes five
times as long as the joint positions."""


class Robot:
    """An arm of the library; angles in rad, poses of its flange as 4x4 arrays."""

    def __init__(self, model: Any) -> None:
        self._robot = _opw.Robot(model, False)  # False: not in degrees

    def forward(self, q: tuple[float, ...]) -> Array:
        """The pose at a joint position: (4, 4)."""
        return np.asarray(self._robot.forward(q, None), float)

    def branches(self, poses: Array) -> Array:
        """Joint positions of n poses (n, 4, 4) by branch: (n, 8, 6). A row is NaN where there is no such branch."""
        rows = np.ascontiguousarray(poses.reshape(-1, 16), dtype=np.float64)
        return np.array(self._robot.reach(rows, _NOWHERE, None, 1)[0])
