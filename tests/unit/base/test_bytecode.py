"""Compiled modules are kept in the user's cache where Python keeps none."""

from __future__ import annotations

import os
import py_compile
import subprocess
import sys
from pathlib import Path

import pytest

import pn2code

SOURCES = Path(pn2code.__file__).parents[1]
EVERY_FILE = 1_577_836_800
"""The time of all files."""


def version(cache: Path, **environment: str) -> str:
    """What `pn2code --version` prints with a cache of its own."""
    kept = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    done = subprocess.run(
        [sys.executable, "-m", "pn2code", "--version"],
        env={**kept, "XDG_CACHE_HOME": str(cache), **environment},
        capture_output=True,
        text=True,
        check=True,
    )
    assert not done.stderr
    return done.stdout


def modules(cache: Path) -> list[Path]:
    return sorted((cache / "pn2code" / "modules").rglob("pn2code/cli/main*.pyc"))


def test_kept_where_python_must_not_write(tmp_path: Path) -> None:
    first = version(tmp_path, PYTHONDONTWRITEBYTECODE="1")
    (kept,) = modules(tmp_path)
    compiled = kept.read_bytes()
    kept.write_bytes(compiled[:20])  # damaged: compiled again
    assert version(tmp_path, PYTHONDONTWRITEBYTECODE="1") == first
    assert kept.read_bytes() == compiled


def test_not_kept_where_others_may_write(tmp_path: Path) -> None:
    (tmp_path / "pn2code").mkdir()
    (tmp_path / "pn2code").chmod(0o777)
    assert version(tmp_path, PYTHONDONTWRITEBYTECODE="1")
    assert not modules(tmp_path)


def test_python_keeps_them_itself_where_it_may(tmp_path: Path, root: Path) -> None:
    if not os.access(root / "src" / "pn2code", os.W_OK):
        pytest.skip("the sources cannot be written to")
    assert version(tmp_path)
    assert not modules(tmp_path)


def import_library(cache: Path, answer: int = 42, **environment: str) -> int:
    """Imports a library of one module, beside the cache, as a verb does; gives its answer."""
    library = cache / "library.py"
    library.write_text(f"answer = {answer}\n")
    os.utime(library, (EVERY_FILE, EVERY_FILE))
    done = subprocess.run(
        [sys.executable, "-c", "import pn2code.cli, library; print(library.answer)"],
        env={
            **os.environ,
            "XDG_CACHE_HOME": str(cache),
            "PYTHONPATH": f"{cache}{os.pathsep}{SOURCES}",
            **environment,
        },
        stdout=subprocess.PIPE,
        check=True,
    )
    return int(done.stdout)


def test_libraries_that_nobody_has_compiled(tmp_path: Path) -> None:
    """`pip install --no-compile` of NumPy: compiling it took longer than checking a cell."""
    import_library(tmp_path, PYTHONDONTWRITEBYTECODE="1")
    assert list((tmp_path / "pn2code" / "modules").rglob("library*.pyc"))
    assert not (tmp_path / "__pycache__").exists()


def test_another_version_whose_file_is_as_long_and_has_the_same_time(tmp_path: Path) -> None:
    """Images (OSTree, `SOURCE_DATE_EPOCH`) give all their files one time, and versions differ in a digit."""
    assert import_library(tmp_path, 42, PYTHONDONTWRITEBYTECODE="1") == 42
    assert import_library(tmp_path, 43, PYTHONDONTWRITEBYTECODE="1") == 43


def test_compiled_libraries_are_taken_where_they_are(tmp_path: Path) -> None:
    (tmp_path / "library.py").write_text("answer = 42\n")
    py_compile.compile(str(tmp_path / "library.py"))
    import_library(tmp_path, PYTHONDONTWRITEBYTECODE="1")
    assert not list((tmp_path / "pn2code" / "modules").rglob("library*.pyc"))
