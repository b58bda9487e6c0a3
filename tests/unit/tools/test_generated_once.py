"""What tests share when they run the same cell: nothing that another file or option would change."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest

from helpers.generated import Cached, Generate
from pn2code.cell.config import CellConfig
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.net.flat import FlatNet
from pn2code.pipeline import generate


@pytest.fixture
def cell(root: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(root / "examples" / "sorting", tmp_path / "cell"))


@pytest.fixture
def calls() -> list[dict[str, Any]]:
    return []


@pytest.fixture
def counted(calls: list[dict[str, Any]]) -> Generate:
    def generated(path: Path, d: Diagnostics, *, examine: Any = None, **options: Any) -> Any:
        calls.append(options)
        return generate(path, d, checked=False, examine=examine)

    return generated


@pytest.fixture
def cached(counted: Generate, tmp_path: Path) -> Cached:
    return Cached(counted, tmp_path)


def test_the_same_cell_is_generated_once(
    cell: Path, cached: Cached, calls: list[dict[str, Any]]
) -> None:
    first, second = Diagnostics(), Diagnostics()
    assert cached(cell, first, layout=None) is cached(cell, second, layout=None)
    assert second.items == first.items
    assert len(calls) == 1


def test_other_files_and_options_are_generated_anew(
    cell: Path, cached: Cached, calls: list[dict[str, Any]]
) -> None:
    cached(cell, Diagnostics(), layout=None)
    cached(cell, Diagnostics(), layout="other")
    toml = cell / "cell.toml"
    toml.write_text(toml.read_text() + "\n# changed\n")
    cached(cell, Diagnostics(), layout=None)
    assert len(calls) == 3


def test_what_fails_or_comes_with_errors_is_not_remembered(
    cell: Path, cached: Cached, calls: list[dict[str, Any]]
) -> None:
    for _ in range(2):
        d = Diagnostics()
        d.error("cell-value", "something else", Origin("elsewhere"))
        cached(cell, d, layout=None)
    (cell / "cell.toml").write_text("[nothing]\n")
    for _ in range(2):
        d = Diagnostics()
        assert cached(cell, d, layout=None) is None
        assert d.has_errors
    assert len(calls) == 4


def test_other_workers_get_the_same(
    cell: Path, counted: Generate, calls: list[dict[str, Any]], tmp_path: Path
) -> None:
    first, second = Diagnostics(), Diagnostics()
    one = Cached(counted, tmp_path)(cell, first)
    assert Cached(counted, tmp_path)(cell, second) == one
    assert second.items == first.items
    assert len(calls) == 1


def test_whoever_examines_is_asked_each_time(
    cell: Path, cached: Cached, calls: list[dict[str, Any]]
) -> None:
    asked: list[str] = []

    def content(net: FlatNet, config: CellConfig | None, d: Diagnostics) -> None:
        asked.append(net.name)

    def refuses(net: FlatNet, config: CellConfig | None, d: Diagnostics) -> None:
        d.error("cell-value", "no", Origin("input"))

    d = Diagnostics()
    assert cached(cell, d, examine=refuses) is None
    assert [i.message for i in d.items] == ["no"]
    for _ in range(2):
        assert cached(cell, Diagnostics(), examine=content) is not None
    assert (len(asked), len(calls)) == (2, 2)
    d = Diagnostics()
    assert cached(cell, d, examine=refuses) is None
    assert [i.message for i in d.items] == ["no"]
