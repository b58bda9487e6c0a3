"""What a test session makes once, also when several workers share it."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest


def common(factory: pytest.TempPathFactory) -> Path:
    """The folder of the session, which all workers have in common."""
    base = factory.getbasetemp()
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base


@contextmanager
def alone(folder: Path, name: str) -> Iterator[Path]:
    """The path of that name in a folder of all workers, for one of them at a time."""
    with (folder / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield folder / name


def once(factory: pytest.TempPathFactory, name: str, make: Callable[[Path], object]) -> Path:
    """A folder that was filled by the first worker who wanted it. Only read it.

    Args:
        factory: the fixture `tmp_path_factory`.
        name: of the folder.
        make: makes the folder, and what is in it.
    """
    base = common(factory)
    done = base / f"{name}.done"
    with alone(base, name) as folder:
        if not done.exists():
            make(folder)
            done.touch()
    return folder
