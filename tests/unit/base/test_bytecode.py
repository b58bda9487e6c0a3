"""Compiled modules are kept in the user's cache where Python keeps none."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest


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
    return sorted((cache / "pn2code" / "modules").rglob("main*.pyc"))


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
