"""The branches of the supervisor, its channels and its port: situations that take them, and figures that stay.

Which branches no situation takes, and why, docs/execution.md says; a further one, or a file that falls under its figure
there, is a mistake. Each situation is also a test of what the supervisor does in it (`tests/situations`).
"""

from __future__ import annotations

import importlib
import os
import re
from pathlib import Path

import pytest

pytest.register_assert_rewrite("helpers.counted", "situations")

from tools.coverage import sums, table, untaken  # noqa: E402

from helpers.counted import Lab  # noqa: E402
from situations import SITUATIONS  # noqa: E402

pytestmark = [
    pytest.mark.cc,
    pytest.mark.skipif(os.uname().sysname != "Linux", reason="preloads a library"),
]

for _module in (
    "alone", "channels", "codec", "command_line", "failing", "inputs", "lockstep", "peers", "playing", "starting",
    "whole_runs",
):  # fmt: skip
    importlib.import_module(f"situations.{_module}")

PAGE = "docs/execution.md"
_FIGURE = re.compile(r"^\| `(\w+/\w+\.c)` \| (\d+) % \|", re.MULTILINE)
_ROW = re.compile(r"^\| `(\w+/\w+\.c)` \| `` (.+?) `` \| (.+) \|$", re.MULTILINE)


class Runs:
    """Runs each situation once, whoever asks first."""

    def __init__(self, lab: Lab) -> None:
        self.lab = lab
        self._done: dict[str, Exception | None] = {}

    def once(self, name: str) -> None:
        if name not in self._done:
            try:
                SITUATIONS[name](self.lab)
                self._done[name] = None
            except Exception as wrong:  # its own test reports it
                self._done[name] = wrong
        if (wrong := self._done[name]) is not None:
            raise wrong

    def has_passed(self, name: str) -> bool:
        return name in self._done and self._done[name] is None


@pytest.fixture(scope="module")
def runs(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Runs:
    return Runs(Lab(root, tmp_path_factory.mktemp("branches")))


@pytest.mark.parametrize("name", SITUATIONS)
def test_a_situation(runs: Runs, name: str) -> None:
    runs.once(name)
    assert runs.has_passed(name)


def test_no_file_falls_under_its_figure(runs: Runs, root: Path) -> None:
    if os.environ.get("PN2CODE_COUNTING"):
        pytest.skip("`./dev coverage` counts itself")
    for name in SITUATIONS:
        runs.once(name)
    page = (root / PAGE).read_text(encoding="utf-8")
    figures, rows = dict(_FIGURE.findall(page)), _ROW.findall(page)
    files = {name: lines for name, lines in runs.lab.taken().items() if name in figures}
    print("\n".join(table(files)))
    assert figures.keys() == files.keys() and len(figures) > 8
    for name, lines in files.items():
        _, _, taken, branches = sums(lines)
        assert 100 * taken >= int(figures[name]) * branches, (name, taken, branches)
        assert int(figures[name]) >= 95 or "trace" in name
    unnamed = [
        (name, number, code)
        for name, number, code in untaken(files)
        if not any(name == file and part in code for file, part, _ in rows)
    ]
    assert unnamed == [], f"no situation takes a branch there, and no row of {PAGE} names it"
    for file, part, _ in rows:
        assert part in (root / "cnative" / "src" / file).read_text(encoding="utf-8"), (file, part)
