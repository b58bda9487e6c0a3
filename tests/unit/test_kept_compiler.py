"""The tests' compiler gives what the compiler gives, and compiles once what is the same."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from helpers.kept_compiler import as_it_stands, kept

pytestmark = [
    pytest.mark.cc,
    pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc"),
]


@pytest.fixture(params=[1, 2], ids=["alone", "within another"])
def folder(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Path]:
    with ExitStack() as blocks:
        if request.param == 2:
            blocks.enter_context(kept(tmp_path / "outer"))
        blocks.enter_context(kept(tmp_path / "kept"))
        yield tmp_path


def gcc(folder: Path, *arguments: object, code: int = 0) -> subprocess.CompletedProcess[str]:
    command = ["gcc", *map(str, arguments)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == code, done.stderr
    return done


def objects(folder: Path) -> set[str]:
    return {p.name for p in (folder / "kept" / "objects").iterdir() if not p.suffix}


def test_the_same_object_file(folder: Path) -> None:
    (folder / "a.h").write_text("#define N 7\n")
    (folder / "a.c").write_text('#include "a.h"\nint main(void) { return N; }\n')
    gcc(folder, "-O2", "-c", "a.c", "-o", "one.o")
    assert len(objects(folder)) == 1
    gcc(folder, "-O2", "-c", "a.c", "-o", "two.o")
    gcc(folder, "-O2", "-c", "a.c")
    assert len(objects(folder)) == 1
    with as_it_stands():
        gcc(folder, "-O2", "-c", "a.c", "-o", "real.o")
    same = [(folder / name).read_bytes() for name in ("one.o", "two.o", "a.o", "real.o")]
    assert len(set(same)) == 1
    # Other flags, another definition, another header: another object file.
    gcc(folder, "-O0", "-c", "a.c")
    gcc(folder, "-O2", "-DM", "-c", "a.c")
    (folder / "a.h").write_text("#define N 8\n")
    gcc(folder, "-O2", "-c", "a.c", "-o", "other.o")
    assert (folder / "other.o").read_bytes() != same[0]
    assert len(objects(folder)) == 4


def test_compiled_and_linked_in_one_call(folder: Path) -> None:
    (folder / "main.c").write_text("int f(void);\nint main(void) { return f(); }\n")
    (folder / "f.c").write_text("int f(void) { return VALUE; }\n")
    for value in (3, 4, 3):
        gcc(folder, f"-DVALUE={value}", "main.c", "f.c", "-o", "program", "-lm")
        assert subprocess.run([folder / "program"], check=False).returncode == value
    assert len(objects(folder)) == 4
    gcc(folder, "-c", "-DVALUE=1", "main.c", "f.c")
    gcc(folder, "main.o", "f.o", "-o", "program")
    assert subprocess.run([folder / "program"], check=False).returncode == 1
    gcc(folder, "-DVALUE=5", "-fPIC", "-shared", "f.c", "-o", "libf.so")
    gcc(folder, "main.c", "libf.so", "-o", "program")
    own = {**os.environ, "LD_LIBRARY_PATH": str(folder)}
    assert subprocess.run([folder / "program"], check=False, env=own).returncode == 5


def test_what_it_says_is_said_each_time(folder: Path) -> None:
    (folder / "w.c").write_text("int main(void) { int unused; return 0; }\n")
    for _ in range(2):
        done = gcc(folder, "-Wall", "-c", "w.c")
        assert "unused variable" in done.stderr
    for _ in range(2):
        assert "unused variable" in gcc(folder, "-Wall", "-Werror", "-c", "w.c", code=1).stderr
    (folder / "e.c").write_text('#include "nowhere.h"\n')
    for _ in range(2):
        assert "nowhere.h" in gcc(folder, "-c", "e.c", code=1).stderr
    assert not objects(folder)


def test_other_modes_are_the_compilers_own(folder: Path) -> None:
    (folder / "a.c").write_text("int x;\n")
    assert "int x;" in gcc(folder, "-E", "a.c").stdout
    gcc(folder, "-S", "a.c")
    assert (folder / "a.s").exists()
    assert "gcc" in gcc(folder, "--version").stdout.lower()
    gcc(folder, "-fsyntax-only", "a.c")
    gcc(folder, "-x", "c", "-c", "a.c", "-o", "a.o")
    assert not objects(folder)
