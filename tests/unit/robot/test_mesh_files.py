"""Mesh files: those of the usual form are read at once, and as the reader of every form reads them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pn2code.robot import mesh_files

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1e0 0\nv 0 1 0.5\n"
LINES = [
    "v 0 0 0", "v 1 -2.5 1e-3", "v 1 2", "v 1 2 3 1", "v  1 2 3", "v 1\t2 3", "v 1 2 x", " v 1 2 3", "v",
    "f 1 2 3", "f 1/4/2 2//1 3/", "f 1 2 3 4", "f 1 2", "f -1 -2 -3", "f 0 1 2", "f 1 2 9", "f a b c", "\tf 1 2 3", "f",
    "vn 0 0 1", "vt 0 0", "# v 1 2 3", "", "usemtl a b c", "o v", "\u00a0v 1 2 3", "f 1 2 3 ", "f /1 2 3", "v_ 1 2 3",
]  # fmt: skip


@given(st.lists(st.sampled_from(LINES), max_size=9))
def test_as_the_reader_of_every_form(lines: list[str]) -> None:
    text = SQUARE + "\n".join(lines)
    found = mesh_files._plain_obj(text)
    if found is not None:
        points, triangles = mesh_files._any_obj(text)
        assert np.array_equal(found[0], points)
        assert np.array_equal(found[1], triangles)
        assert (found[0].dtype, found[1].dtype) == (points.dtype, triangles.dtype)


@pytest.mark.parametrize("line", LINES)
def test_one_odd_line(line: str) -> None:
    text = f"{SQUARE}f 1 2 3\n{line}\n"
    found = mesh_files._plain_obj(text)
    if found is not None:
        points, triangles = mesh_files._any_obj(text)
        assert np.array_equal(found[0], points)
        assert np.array_equal(found[1], triangles)


def test_the_arms_are_of_the_usual_form(root: Path) -> None:
    files = sorted((root / "src/pn2code/robot/models/meshes").glob("*.obj"))
    assert len(files) > 20
    for file in files:
        text = file.read_text(encoding="utf-8")
        found = mesh_files._plain_obj(text)
        assert found is not None, file
        for own, other in zip(found, mesh_files._any_obj(text), strict=True):
            assert np.array_equal(own, other), file
