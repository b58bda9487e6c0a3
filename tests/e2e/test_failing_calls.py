"""The deployed supervisor where one call of the operating system fails: it says which, or does without."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [
    pytest.mark.cc,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="preloads a library"),
]

USAGE, PEER, IO = 2, 3, 5
"""An input file; robots that are silent (there are none); the shared directory."""
MOST = 8
"""Calls of each name that fail, one in each run."""


@pytest.fixture(scope="module")
def failing(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    library = tmp_path_factory.mktemp("failing") / "failing.so"
    source = root / "cnative" / "tests" / "failing.c"
    flags = ["-shared", "-fPIC", "-O1", "-fno-builtin", "-Wall", "-Werror"]
    subprocess.run(["gcc", *flags, source, "-o", library, "-ldl"], check=True)
    return library


@pytest.mark.parametrize(
    ("name", "error", "ends"),
    [
        ("pipe", errno.EMFILE, True),
        ("fcntl", errno.EINVAL, True),
        ("sigaction", errno.EINVAL, True),
        ("mkdir", errno.EACCES, True),
        ("open", errno.EMFILE, True),
        ("openat", errno.ENFILE, True),
        ("flock", errno.EIO, True),
        ("ftruncate", errno.EIO, True),
        ("pwrite", errno.ENOSPC, True),
        ("write", errno.ENOSPC, True),
        ("read", errno.EIO, True),
        ("close", errno.EIO, True),
        ("renameat", errno.EDQUOT, True),
        ("read", errno.EINTR, False),
        ("write", errno.EINTR, False),
        ("fstat", errno.EIO, False),
        ("unlinkat", errno.EACCES, False),
        ("inotify_init1", errno.EMFILE, False),
        ("inotify_add_watch", errno.ENOSPC, False),
    ],
)
def test_a_call_that_fails(
    riveting_program: Path, failing: Path, tmp_path: Path, name: str, error: int, ends: bool
) -> None:
    codes = []
    for number in range(1, MOST + 1):
        shared = tmp_path / f"shared{number}"
        command = [riveting_program / "supervisor", "--dir", shared, "--input", riveting_program]
        done = subprocess.run(
            [*command, "--reply-timeout", "0.05", "-q"],
            env={**os.environ, "LD_PRELOAD": str(failing), "FAILING": f"{name}:{number}:{error}"},
            capture_output=True, text=True, timeout=600, check=False,
        )  # fmt: skip
        said = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
        assert len(said) == 1, (number, done.returncode, done.stderr)
        if done.returncode == PEER:
            assert "has not answered" in said[0], (number, said)
        else:
            assert done.returncode in (USAGE, IO), (number, done.returncode, said)
            assert os.strerror(error) in said[0], (number, said)
        codes.append(done.returncode)
    assert (set(codes) != {PEER}) is ends, codes
