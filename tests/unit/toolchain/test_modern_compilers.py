"""What older compilers only warn of and gcc 14, clang 16 and `zig cc` refuse does not occur in the runtime."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from helpers.thorough import amount
from pn2code.emission import c_flags

REFUSED = (
    "implicit-function-declaration",
    "implicit-int",
    "int-conversion",
    "incompatible-pointer-types",
)


@pytest.mark.cc
@pytest.mark.parametrize("compiler", ["gcc", "clang"][: amount(1, 2)])
def test_each_file_declares_what_it_calls(compiler: str, root: Path) -> None:
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler}")
    runtime = root / "cnative"
    includes = [runtime / "include", *(p for p in (runtime / "src").rglob("*") if p.is_dir())]
    files = sorted((runtime / "src").rglob("*.c"))
    assert len(files) > 50
    files = files[:: amount(3, 1)]  # all are compiled in each run, with fewer errors
    done = subprocess.run(
        [
            compiler,
            c_flags.STANDARD,
            "-D_GNU_SOURCE",
            "-fsyntax-only",
            *(f"-Werror={x}" for x in REFUSED),
        ]
        + [f"-I{folder}" for folder in includes]
        + [str(file) for file in files],
        capture_output=True,
        text=True,
        check=False,
    )
    assert "error" not in done.stderr, done.stderr
