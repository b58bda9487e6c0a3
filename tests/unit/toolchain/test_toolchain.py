"""Building: missing tools, and compiler errors told at the net element."""

from __future__ import annotations

import importlib.util
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from pn2code.cli.options import Exit, code_of
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.emission import c_flags
from pn2code.emission.output import Block, OutputFile
from pn2code.toolchain import programs
from pn2code.toolchain.build import build, find_compiler
from pn2code.toolchain.programs import Compiler, Host, program

HOST = Host("nothing", only=("pn_channel.c",))
MAIN = OutputFile("main.c", "int main(void) { return 0; }\n", ())
ORIGIN = Origin("cell.cpn", 12, 3, page="Robot", element="transition `Pick`", element_id="ID7")


def folder(tmp_path: Path, makefile: str, c: str = "") -> tuple[Path, tuple[OutputFile, ...]]:
    (tmp_path / "Makefile").write_text(makefile)
    (tmp_path / "net.c").write_text(c)
    return tmp_path, (OutputFile("net.c", c, (Block("Top.Pick", "transition", ORIGIN, 1, 3),)),)


@pytest.mark.cc
def test_builds(tmp_path: Path) -> None:
    path, files = folder(
        tmp_path, "supervisor: net.c\n\t$(CC) -o $@ net.c\n", "int main(void) { return 0; }\n"
    )
    d = Diagnostics()
    program = build(path, files, d)
    assert not d.items
    assert program is not None and program.is_file()


@pytest.mark.cc
def test_a_compiler_error_names_the_net_element(tmp_path: Path) -> None:
    path, files = folder(
        tmp_path, "supervisor: net.c\n\t$(CC) -o $@ net.c\n", "\nint main(void) { return x; }\n"
    )
    d = Diagnostics()
    assert build(path, files, d) is None
    assert d.errors[0].code == "c-error"
    assert "transition `Top.Pick`" in d.errors[0].message
    assert d.errors[0].origin == ORIGIN
    assert (path / "build.log").read_text()


@pytest.mark.cc
def test_a_failing_make_keeps_its_last_words(tmp_path: Path) -> None:
    path, files = folder(tmp_path, "supervisor:\n\t@echo disk on fire >&2; exit 1\n")
    d = Diagnostics()
    assert build(path, files, d) is None
    assert d.errors[0].code == "build-failed"
    assert any("disk on fire" in n.message for n in d.errors[0].notes)


def test_missing_tools_say_what_to_type(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setitem(sys.modules, "ziglang", None)  # not installed
    d = Diagnostics()
    assert build(tmp_path, (), d) is None
    assert d.errors[0].code == "tool-missing"
    assert "a C compiler and make are not installed" in d.errors[0].message
    assert code_of(d) == Exit.USAGE  # nothing is wrong with the net
    assert "apt-get install" in d.errors[0].hint
    assert "pip install 'pn2code[compiler]'" in d.errors[0].hint
    with program(HOST, (MAIN,), d) as path:
        assert path is None
    assert "pip install 'pn2code[compiler]'" in d.errors[1].hint


def test_only_what_is_missing_is_to_be_installed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "cc").write_text("#!/bin/sh\n")
    (tmp_path / "cc").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    d = Diagnostics()
    assert build(tmp_path, (), d) is None
    assert d.errors[0].message == "make is not installed"
    assert d.errors[0].hint == "on Debian or Ubuntu type: sudo apt-get install make"


ZIGLANG = """
import os, sys
os.environ["PATH"] = {path!r}
tool = {tools!r}[sys.argv[1]]
os.execv(tool, [tool, *sys.argv[2:]])
"""


@pytest.mark.cc
def test_without_a_compiler_that_of_ziglang_is_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With a package of that name whose tools are those of the machine."""
    tools = {"cc": shutil.which("gcc") or shutil.which("cc"), "ar": shutil.which("ar")}
    package = tmp_path / "site" / "ziglang"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    (package / "__main__.py").write_text(ZIGLANG.format(path=os.environ["PATH"], tools=tools))
    monkeypatch.delitem(sys.modules, "ziglang", raising=False)
    monkeypatch.syspath_prepend(package.parent)
    for name, value in (
        ("PYTHONPATH", package.parent),
        ("PATH", tmp_path),
        ("XDG_CACHE_HOME", tmp_path),
    ):
        monkeypatch.setenv(name, str(value))
    monkeypatch.delenv("CC", raising=False)
    assert shlex.split(find_compiler() or "") == [sys.executable, "-m", "ziglang", "cc"]
    d = Diagnostics()
    compiler = Compiler.find(HOST, d)
    assert compiler is not None and compiler.command[-1] == c_flags.ZIG
    with program(HOST, (MAIN,), d) as path:
        assert path is not None and os.access(path, os.X_OK), d.items
    assert not d.items


@pytest.mark.cc
@pytest.mark.parametrize("level", ["-O0", "-Og", "-O1", "-O2"])
def test_zig_links_a_net_compiled_less_than_its_host(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, level: str
) -> None:
    """Below -O2 it would check shifts and sums by calls of a library, which is not linked with -O2."""
    if importlib.util.find_spec("ziglang") is None:
        pytest.skip("there is no Python package `ziglang`")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("CC", f"{sys.executable} -m ziglang cc")
    files = (
        OutputFile("net.c", "int net(int n);\nint net(int n) { return (n << n) + n / (n - 1); }\n"),
        OutputFile(
            "other.c",
            "int net(int n);\nint main(int n, char **a) { (void)a; return net(n + 1); }\n",
        ),
    )
    d = Diagnostics()
    with program(Host("none", net=(level,), only=("none.c",)), files, d) as found:
        assert found is not None, list(d)
        assert subprocess.run([found], check=False).returncode == 10


@pytest.mark.parametrize(
    ("command", "flags"),
    [
        ("gcc", ()),
        ("clang -m64", ()),
        ("zig cc", (c_flags.ZIG,)),
        ("/usr/bin/python3 -m ziglang cc", (c_flags.ZIG,)),
        ("zig cc -fsanitize=undefined", ()),
    ],
)
def test_what_a_compiler_is_told_because_of_what_it_is(
    command: str, flags: tuple[str, ...]
) -> None:
    assert c_flags.for_compiler(command) == flags


@pytest.mark.cc
def test_a_large_net_is_compiled_quickly(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The net alone; and under a name of its own, so that the one is never taken for the other."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    commands: list[list[str]] = []
    run = programs.run_tool

    def told(command: list[str], *rest: object) -> object:
        commands.append(command)
        return run(command, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(programs, "run_tool", told)
    host = Host("none", net=("-DFOR_THE_NET",), only=("none.c",))
    files = (
        OutputFile("net.c", "int net(void);\nint net(void) { return 7; }\n"),
        OutputFile("other.c", "int net(void);\nint main(void) { return net(); }\n"),
    )
    built = []
    for limit in (1_000_000, 10):
        monkeypatch.setattr(c_flags, "LARGE", limit)
        d = Diagnostics()
        with program(host, files, d) as found:
            assert found is not None, list(d)
            assert subprocess.run([found], check=False).returncode == 7
            built.append(found)
    assert built[0] != built[1]
    of_net = [c for c in commands if c[-1] == "net.c"]
    assert [[f for f in c_flags.QUICKER if f in c] for c in of_net] == [[], [*c_flags.QUICKER]]
    for flag in programs.FLAGS:  # what comes later counts; and a host may have its own word
        assert (
            of_net[1].index(flag)
            < of_net[1].index(c_flags.QUICKER[0])
            < of_net[1].index("-DFOR_THE_NET")
        )


@pytest.mark.cc
def test_a_compiler_says_once_what_it_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = tmp_path / "asked"
    compiler = tmp_path / "cc"
    compiler.write_text(
        f'#!/bin/sh\n[ "$1" = --version ] && echo >> {asked}\n[ -e {tmp_path}/broken ] && exit 1\nexec cc "$@"\n'
    )
    compiler.chmod(0o755)
    monkeypatch.setenv("CC", str(compiler))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "broken").touch()
    for _ in range(2):
        assert programs.Compiler.find(HOST, Diagnostics()) is None
    assert asked.read_text() == "\n\n", "one that says nothing is asked again"
    (tmp_path / "broken").unlink()
    for number in range(2):
        text = MAIN.text.replace("0", str(number))
        with program(HOST, [OutputFile("main.c", text, ())], Diagnostics()) as found:
            assert found is not None and subprocess.run([found], check=False).returncode == number
    assert asked.read_text() == "\n\n\n"


def test_a_net_of_200_transitions_that_are_not_alike_is_large() -> None:
    """Its C has some 900,000 characters, and the compiler takes five times as long over it with `-O2` alone."""
    assert c_flags.for_net("x" * 890_000) == ("-Og", "-DPN_MANY", "-fno-inline")
    assert c_flags.for_net("x" * 225_000) == ()


def test_a_net_whose_tokens_are_moved_in_many_places_is_large() -> None:
    """However short it is: fifty transitions that are not alike take the compiler two seconds with `-O2` alone."""
    move = "(void)K_array_16_take(&m->P, &b->k, 1U) && K_array_16_add(cx, &m->P, &s_at_P, &b->k, 1U);\n"
    assert c_flags.for_net(50 * move) == ()
    assert c_flags.for_net(100 * move) == c_flags.QUICKER


@pytest.mark.parametrize(
    ("version", "flags"),
    [
        ("gcc 12.2.0\nCopyright (C) 2022 Free Software Foundation, Inc.", c_flags.QUICKER_GCC),
        ("Debian clang version 14.0.6", ()),
    ],
)
def test_only_gcc_is_told_what_only_gcc_knows(version: str, flags: tuple[str, ...]) -> None:
    assert c_flags.for_large_nets(version) == flags
