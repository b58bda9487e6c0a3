"""The C runtime by itself: its own tests, and reals written as Python writes them."""

from __future__ import annotations

import random
import shutil
import struct
import subprocess
from pathlib import Path

import pytest

from helpers.compiled import RUNTIME, WARNINGS, Workshop
from helpers.thorough import amount
from pn2code.base.resources import cnative_folder

pytestmark = pytest.mark.cc


@pytest.fixture(scope="module")
def program(workshop: Workshop, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runtime-tests")
    source = cnative_folder() / "tests" / "runtime.c"
    workshop.compile(source, folder / "runtime.o", folder)
    return workshop.link(folder / "runtime", folder / "runtime.o")


def test_runtime(program: Path) -> None:
    done = subprocess.run([program], capture_output=True, text=True, check=False)
    assert done.stderr == ""
    assert done.stdout == "ok\n"
    assert done.returncode == 0


def test_reals_are_written_as_python_writes_them(program: Path) -> None:
    r = random.Random(7)
    values = [
        0.0,
        -0.0,
        0.1,
        1e16,
        1e-4,
        1e-5,
        123456.789,
        5e-324,
        2.0**53,
        1e22,
        9007199254740993.0,
    ]
    values += [r.uniform(-10000, 10000) for _ in range(500)]
    values += [round(r.uniform(-10000, 10000), 4) for _ in range(500)]
    values += [struct.unpack("d", r.randbytes(8))[0] for _ in range(1000)]
    values += [struct.unpack("f", r.randbytes(4))[0] for _ in range(500)]
    patterns = "".join(f"{struct.unpack('Q', struct.pack('d', v))[0]:x}\n" for v in values)
    done = subprocess.run(
        [program, "--repr"], input=patterns, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == [repr(v) for v in values]


def test_static_analysis_of_the_runtime_finds_nothing(tmp_path: Path) -> None:
    compiler = shutil.which("gcc")
    if compiler is None:
        pytest.skip("no gcc")
    include = f"-I{cnative_folder() / 'include'}"
    for name in RUNTIME[
        :: amount(6, 1)
    ]:  # one by one: what has not changed since the last run is remembered
        source = str(next(cnative_folder().rglob(f"src/*/pn_{name}.c")))
        done = subprocess.run(
            [compiler, *WARNINGS, "-fanalyzer", "-O1", include, "-c", source, "-o", "x.o"],
            capture_output=True, text=True, check=False, cwd=tmp_path,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr


def test_no_line_is_longer_than_120_columns() -> None:
    """The formatter leaves comments as they are, so that tables in them stay tables."""
    long = [
        f"{path.name}:{number}"
        for path in sorted(cnative_folder().rglob("*.[ch]"))
        for number, line in enumerate(path.read_text().splitlines(), 1)
        if len(line) > 120
    ]
    assert long == []
