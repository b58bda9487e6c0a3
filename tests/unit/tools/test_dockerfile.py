"""The container has what cells need: arms in 3D, and meshes with pockets."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path


def test_its_extras_are_there_and_enough(root: Path) -> None:
    text = (root / "Dockerfile").read_text(encoding="utf-8")
    found = re.search(r"pip install --no-cache-dir '\.\[([\w,]+)\]'", text)
    assert found is not None
    extras = set(found[1].split(","))
    known = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert {"cell", "hulls"} <= extras <= known["optional-dependencies"].keys()
