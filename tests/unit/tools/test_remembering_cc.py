"""The compiler of the tests that remembers: it never gives an object that the compiler would not give now."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from helpers import remembering_cc
from pn2code.emission.c_flags import STANDARD
from pn2code.verify.exploring.programs import HOST

pytestmark = pytest.mark.cc

FLAGS = (STANDARD, "-O1", "-Iinclude", "-I.")


class Bench:
    """A folder with a source, and a compiler that counts how often it is called to compile something."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        usual = next(p for p in (shutil.which("gcc"), shutil.which("cc")) if p)
        self.at, self.calls = folder / "work", folder / "calls"
        self.store = folder / "store"
        compilers = folder / "compilers"
        for place in (self.at / "include", compilers):
            place.mkdir(parents=True)
        script = compilers / "gcc"
        script.write_text(
            f'#!/bin/sh\ncase " $* " in *" -c "*) echo "$*" >>{self.calls};; esac\nexec {usual} "$@"\n'
        )
        script.chmod(0o755)
        (compilers / "cc").symlink_to("gcc")
        monkeypatch.setenv("PATH", f"{compilers}:{os.environ['PATH']}")
        monkeypatch.setattr(remembering_cc, "_FLAGS", (STANDARD, "-O0"))  # for each test anew
        found = remembering_cc.made(folder / "front", self.store)
        assert found is not None
        self.compiler = found / "gcc"
        self.write("include/other.h", "#define N 1\n")
        self.write("a.c", '#include "other.h"\n#include <string.h>\nint a(void) { return N; }\n')

    def write(self, name: str, text: str) -> None:
        (self.at / name).write_text(text)

    def run(
        self, *arguments: str, at: Path | None = None, flags: Sequence[str] = FLAGS
    ) -> subprocess.CompletedProcess[str]:
        command = [str(self.compiler), *flags, *arguments]
        return subprocess.run(
            command, cwd=at or self.at, capture_output=True, text=True, check=False
        )

    def compiled(self, *arguments: str, made: str = "a.o", at: Path | None = None) -> bytes:
        """The object."""
        (self.at / made).unlink(missing_ok=True)
        done = self.run("-c", "a.c", *arguments, at=at)
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
        return ((at or self.at) / made).read_bytes()

    @property
    def count(self) -> int:
        return len(self.calls.read_text().splitlines()) if self.calls.exists() else 0


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Bench:
    return Bench(tmp_path, monkeypatch)


def test_the_second_time_it_is_a_copy(bench: Bench) -> None:
    first = bench.compiled()
    assert bench.compiled() == first
    assert bench.compiled("-o", "other.o", made="other.o") == first
    assert bench.count == 1


def test_in_another_folder_too(bench: Bench, tmp_path: Path) -> None:
    first = bench.compiled()
    elsewhere = tmp_path / "elsewhere"
    shutil.copytree(bench.at, elsewhere)
    (elsewhere / "a.o").unlink()
    assert bench.compiled(at=elsewhere) == first
    assert bench.count == 1


CHANGES: dict[str, Callable[[Bench], object]] = {
    "the source": lambda b: b.write("a.c", "int b(void) { return 3; }\n"),
    "a header": lambda b: b.write("include/other.h", "#define N 2\n"),
    "a header in front of it": lambda b: b.write("other.h", "#define N 2\n"),
}


@pytest.mark.parametrize("change", ["the source", "a header", "a header in front of it"])
def test_what_is_read_counts(bench: Bench, change: str) -> None:
    first = bench.compiled()
    CHANGES[change](bench)
    assert bench.compiled() != first
    bench.compiled()
    assert bench.count == 2


def test_what_was_before_is_known_again(bench: Bench) -> None:
    first = bench.compiled()
    bench.write("include/other.h", "#define N 2\n")
    bench.compiled()
    bench.write("include/other.h", "#define N 1\n")
    assert bench.compiled() == first
    assert bench.count == 2


def test_flags_count(bench: Bench) -> None:
    first = bench.compiled()
    assert bench.compiled("-O2") != first or bench.count == 2
    assert bench.compiled("-DN=1", "-Uother") and bench.count == 3
    assert bench.compiled("-g") != first
    assert bench.count == 4


def test_a_name_that_the_object_also_has_keeps_what_it_had(bench: Bench) -> None:
    first = bench.compiled()
    bench.compiled("-O0")
    (bench.at / "name.o").hardlink_to(bench.at / "a.o")
    second = (bench.at / "name.o").read_bytes()
    assert bench.run("-c", "a.c").returncode == 0
    assert (bench.at / "a.o").read_bytes() == first
    assert (bench.at / "name.o").read_bytes() == second != first


def test_warnings_are_said_each_time(bench: Bench) -> None:
    bench.write("a.c", "int a(void) { int n = 3; return 1; }\n")
    said = [bench.run("-Wall", "-c", "a.c") for _ in range(2)]
    assert all("unused variable" in s.stderr and s.returncode == 0 for s in said)
    assert bench.count == 2


def test_errors_are_said_each_time(bench: Bench) -> None:
    bench.compiled()
    bench.write("a.c", "int a(void) { return b; }\n")
    said = [bench.run("-c", "a.c") for _ in range(2)]
    assert all("undeclared" in s.stderr and s.returncode == 1 for s in said)
    assert bench.run("-c", "nothing.c").returncode == 1


@pytest.mark.parametrize("more", ["-MD", "--coverage", "-fstack-usage", "-save-temps"])
def test_what_is_not_plain_the_compiler_does(bench: Bench, more: str) -> None:
    for _ in range(2):
        bench.compiled(more)
    assert bench.count == 2


def test_the_date_is_not_remembered(bench: Bench) -> None:
    bench.write("a.c", "const char *a = __TIME__;\n")
    for _ in range(2):
        bench.compiled()
    assert bench.count == 2


def test_two_sources_and_programs(bench: Bench) -> None:
    bench.write("b.c", "int a(void); int main(void) { return a() - 1; }\n")
    for _ in range(2):
        assert bench.run("-c", "a.c", "b.c").returncode == 0
    assert bench.count == 2
    assert bench.run("a.o", "b.o", "-o", "program").returncode == 0
    assert subprocess.run([bench.at / "program"], check=False).returncode == 0
    assert "gcc" in bench.run("--version").stdout


def test_without_room_for_what_is_kept_all_is_compiled(bench: Bench) -> None:
    bench.compiled()
    shutil.rmtree(bench.store)
    for _ in range(2):
        bench.compiled()
    assert bench.count == 3


def test_what_was_not_used_for_long_goes_first(tmp_path: Path) -> None:
    for age, name in enumerate(("new.o", "old.o", "older.files", "rule-x")):
        (tmp_path / name).write_bytes(b"x" * 10)
        os.utime(tmp_path / name, (10_000 - age, 10_000 - age))
    remembering_cc.prune(tmp_path, most=25)
    assert {p.name for p in tmp_path.iterdir()} == {"new.o", "old.o"}


def test_what_one_compiler_has_made_is_not_anothers(bench: Bench) -> None:
    clang = bench.compiler.with_name("clang")
    if not clang.exists():
        pytest.skip("no clang")
    first = bench.compiled()
    made = []
    for _ in range(2):
        (bench.at / "a.o").unlink()
        subprocess.run([clang, *FLAGS, "-c", "a.c"], cwd=bench.at, check=True)
        made.append((bench.at / "a.o").read_bytes())
    assert made[0] == made[1] != first
    assert len(list(bench.store.glob("*.o"))) == 2  # of each compiler one, which is copied


def test_another_name_of_the_same_compiler_is_not_another_compiler(bench: Bench) -> None:
    first = bench.compiled()
    bench.compiler = bench.compiler.with_name("cc")
    assert bench.compiled() == first
    assert bench.count == 1


def test_a_program_that_does_as_it_is_called_is_several_compilers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script = tmp_path / "gcc"
    script.write_text('#!/bin/sh\necho "${0##*/} version of ${0##*/}"\n')
    script.chmod(0o755)
    (tmp_path / "cc").symlink_to(script)
    both = [str(tmp_path / name) for name in ("cc", "gcc")]
    assert [remembering_cc._same(path, both) for path in both] == both


def test_what_is_for_this_machine_is_remembered_on_it(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = bench.compiled(*HOST.own)
    assert bench.compiled(*HOST.own) == first
    assert bench.count == 1
    compiler = os.fspath(shutil.which("gcc") or shutil.which("cc"))
    here = remembering_cc._version([compiler])
    monkeypatch.setattr(
        remembering_cc, "_NATIVE", ("-march=x86-64-v2", *remembering_cc._NATIVE[1:])
    )
    assert remembering_cc._version([compiler]) != here
