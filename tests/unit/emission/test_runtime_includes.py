"""The C runtime: headers include each other without circles, and each folder says in a README what it is for."""

from __future__ import annotations

import re
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def included(folder: Path) -> dict[str, set[str]]:
    """Header -> the headers that it includes, by their names, of which no two are equal."""
    found = sorted(folder.rglob("*.h"))
    names = {f.name for f in found}
    assert len(names) == len(found)
    texts = {f.name: f.read_text(encoding="utf-8") for f in found}
    return {
        name: {Path(part).name for part in INCLUDE.findall(text)} & names
        for name, text in texts.items()
    }


def test_no_header_includes_itself(root: Path) -> None:
    found = included(root / "cnative")
    assert len(found) > 50 and sum(map(len, found.values())) > 50
    TopologicalSorter(found).prepare()


def test_a_circle_is_found(tmp_path: Path) -> None:
    (tmp_path / "below").mkdir()
    (tmp_path / "a.h").write_text('#include "below/b.h"\n')
    (tmp_path / "below" / "b.h").write_text('#include <a.h>\n#include "a.h"\n')
    with pytest.raises(CycleError):
        TopologicalSorter(included(tmp_path)).prepare()


def test_each_folder_with_code_says_what_it_is_for(root: Path) -> None:
    folders = {f.parent for f in (root / "cnative").rglob("*.[ch]")}
    assert len(folders) > 12
    for folder in sorted(folders):
        lines = (folder / "README.md").read_text(encoding="utf-8").splitlines()
        assert lines[0].startswith("# ") and 3 <= len(lines) <= 6, folder
