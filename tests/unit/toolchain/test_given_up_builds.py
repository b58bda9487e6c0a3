"""What a build leaves to the next one: a build that is given up, what it has compiled; any other, the runtime."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

from pn2code.diagnostics import Diagnostics
from pn2code.emission.output import OutputFile
from pn2code.toolchain import programs
from pn2code.toolchain.programs import Host, program
from pn2code.toolchain.tool_runs import BuildInterruptedError

FILES = (OutputFile("net.c", "int net;\n"),)


def test_the_next_build_gets_further(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """However short the limit is: whoever tries often enough comes to his program."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    compiled: list[str] = []
    tried = 0

    def compile_(_self: Any, room: Path, *arguments: str, d: Diagnostics) -> bool:
        """Stands for the compiler; it gives up at the third file of the runtime."""
        nonlocal tried
        if "-c" not in arguments:
            (room / "program").write_text("#!/bin/sh\n")
            (room / "program").chmod(0o755)
            return True
        source = Path(arguments[arguments.index("-c") + 1])
        if source.name != "net.c":
            tried += 1
            if tried == 3:
                raise BuildInterruptedError
            compiled.append(source.name)
        (room / f"{source.stem}.o").write_text("object")
        return True

    monkeypatch.setattr(programs._Builder, "_compiler", compile_)
    host = Host("simulate")
    sources = [Path(f.path).name for f in host.runtime() if f.path.endswith(".c")]
    times = 0
    while True:
        tried, times = 0, times + 1
        with program(host, FILES, Diagnostics()) as path:
            if path is not None:
                break
        assert times <= len(sources)
    assert times > 1
    assert sorted(compiled) == sorted(sources), "none of them twice"
    left = [p.name for p in path.parent.iterdir() if p.is_dir()]
    assert left == []


def test_the_runtime_is_written_where_it_is_compiled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of the program after it only what is compiled with the net."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    there: list[set[str]] = []

    def compile_(_self: Any, room: Path, *arguments: str, d: Diagnostics) -> bool:
        if "-c" in arguments:
            (room / f"{Path(arguments[arguments.index('-c') + 1]).stem}.o").write_text("object")
            return True
        there.append({p.relative_to(room).as_posix() for p in room.rglob("*.[ch]")})
        (room / "program").write_text("#!/bin/sh\n")
        (room / "program").chmod(0o755)
        return True

    monkeypatch.setattr(programs._Builder, "_compiler", compile_)
    host = Host("simulate", whole="simulate/simulate_play.c")
    runtime = {f.path for f in host.runtime()}
    for number in range(2):
        files = (OutputFile("net.c", f"int net{number};\n"),)
        with program(host, files, Diagnostics()) as path:
            assert path is not None
    headers = {name for name in runtime if name.endswith(".h")}
    whole = f"runtime/src/{host.whole}"
    assert there == [{*runtime, "net.c"}, {*headers, whole, "net.c"}]
