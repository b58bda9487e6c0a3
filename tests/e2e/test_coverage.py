"""`make coverage` of a generated supervisor: lines and branches of net.c that its runs come to."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from pn2code.emission.write import write
from pn2code.pipeline import Generated

pytestmark = pytest.mark.cc


@pytest.fixture(scope="module")
def sorting(
    of_example: Callable[[str], Generated], tmp_path_factory: pytest.TempPathFactory
) -> Path:
    folder = tmp_path_factory.mktemp("coverage")
    write(folder, of_example("sorting").files)
    return folder


def _make(folder: Path, *options: str, path: str | None = None) -> subprocess.CompletedProcess[str]:
    env = {k: v for k, v in os.environ.items() if not k.startswith(("MAKE", "CFLAGS"))}
    env["PATH"] = path or env["PATH"]
    command = ["make", "coverage", "CC=gcc", *options]
    return subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, check=False)


def _without_gcovr(folder: Path) -> str:
    """A path on which there is all but gcovr."""
    tools = folder / "tools"
    tools.mkdir(exist_ok=True)
    for entry in os.environ["PATH"].split(os.pathsep):
        for tool in Path(entry).iterdir() if Path(entry).is_dir() else ():
            link = tools / tool.name
            if tool.name != "gcovr" and not link.exists() and os.access(tool, os.X_OK):
                link.symlink_to(tool)
    return str(tools)


def test_the_sorting_cell(sorting: Path, tmp_path: Path) -> None:
    assert shutil.which("gcc") and shutil.which("gcov"), "gcov comes with gcc"
    bare = _without_gcovr(tmp_path)
    few = _make(sorting, "RUNS=0", path=bare)
    assert few.returncode == 0, few.stderr
    assert "dry run: exit code 0" in few.stdout
    more = _make(sorting, "RUNS=20", path=bare)
    assert more.returncode == 0, more.stderr
    assert "warning" not in few.stderr + more.stderr

    lines, branches = zip(_figures(few.stdout), _figures(more.stdout), strict=True)
    assert 50.0 < lines[0] <= lines[1] and 40.0 < branches[0] < branches[1]
    listing = (sorting / "build" / "coverage" / "net.c.gcov").read_text()
    assert "#####" in listing  # faults that do not happen
    assert not [f.name for f in sorting.iterdir() if ".gc" in f.name]


def _figures(said: str) -> tuple[float, float]:
    found = re.search(
        r"Lines executed:([\d.]+)% of \d+\n.*\nTaken at least once:([\d.]+)% of \d+", said
    )
    assert found is not None, said
    return float(found[1]), float(found[2])


def test_without_gcov_it_says_so(sorting: Path) -> None:
    done = _make(sorting, "GCOV=no-such-gcov")
    assert done.returncode != 0
    assert "there is no program no-such-gcov; it comes with gcc" in done.stderr
