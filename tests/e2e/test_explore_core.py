"""The explorer's tables against plain ones: the store of states and the numbers of things, with sanitizers."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from helpers.compiled import WARNINGS
from pn2code.resources import cnative_folder

pytestmark = pytest.mark.cc

PARTS = ("memory", "intern", "store")


def _built(folder: Path, *sanitizers: str) -> Path:
    compiler = shutil.which("gcc") or shutil.which("cc")
    assert compiler is not None
    root = cnative_folder()
    sources = [root / "tests" / "explore_core.c"]
    sources += [root / "src" / f"explore_{part}.c" for part in PARTS]
    program = folder / "explore_core"
    command = [compiler, *WARNINGS, "-O1", "-g", *sanitizers, "-pthread"]
    command += [
        f"-I{root / 'include'}",
        f"-I{root / 'src'}",
        *map(str, sources),
        "-o",
        str(program),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return program


@pytest.fixture(scope="module")
def checked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With checks of addresses and of undefined behaviour."""
    return _built(
        tmp_path_factory.mktemp("core"), "-fsanitize=address,undefined", "-fno-sanitize-recover=all"
    )


def _says(program: Path, part: str, seed: int) -> str:
    done = subprocess.run(
        [program, part, str(seed)], capture_output=True, text=True, check=False, timeout=120
    )
    return done.stdout + done.stderr


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("part", ["store", "numbers", "memory", "threads"])
def test_against_plain_tables(checked: Path, part: str, seed: int) -> None:
    assert _says(checked, part, seed) == "fine\n"


def test_threads_do_not_race(tmp_path: Path) -> None:
    assert _says(_built(tmp_path, "-fsanitize=thread"), "threads", 1) == "fine\n"
