"""Object files that tests keep: those of the runtime, and only where nothing that goes into them is another."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from helpers.objects import Objects
from helpers.small_cell import write as small_cell
from pn2code.diagnostics import Diagnostics, render
from pn2code.emission import runtime
from pn2code.emission.write import write
from pn2code.pipeline import Generated, generate
from pn2code.toolchain import build

_INCLUDED = re.compile(r'^ *# *include +"([^"]+)"', re.MULTILINE)


def test_no_source_of_the_runtime_includes_what_is_generated() -> None:
    files = runtime.emit("supervisor", "simulate")
    names = {Path(f.path).name for f in files}
    included = {Path(name).name for f in files for name in _INCLUDED.findall(f.text)}
    assert included and included <= names


@pytest.fixture(scope="module")
def cell(tmp_path_factory: pytest.TempPathFactory) -> Generated:
    d = Diagnostics()
    made = generate(small_cell(tmp_path_factory.mktemp("cell")), d, checked=False)
    assert made is not None, render.report(d)
    return made


COMPILER = """#!/bin/sh
# Writes down what it is asked, and leaves an empty file.
echo "$@" >>{log}
while [ "$1" != -o ]; do shift; done
[ "$2" = /dev/null ] || : >"$2"
"""


@pytest.mark.cc
@pytest.mark.parametrize(
    ("target", "flags"),
    [
        ("supervisor.traced", "CFLAGS"),
        ("supervisor.monitor", "CFLAGS"),
        ("supervisor.sanitize", "SANITIZE"),
    ],
)
def test_the_runtime_is_compiled_once(
    cell: Generated, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, target: str, flags: str
) -> None:
    log, compiler = tmp_path / "log", tmp_path / "compiler"
    compiler.write_text(COMPILER.format(log=shlex.quote(str(log))))
    compiler.chmod(0o755)
    monkeypatch.setenv("CC", str(compiler))
    monkeypatch.setenv("CFLAGS", "-O0")
    (tmp_path / "kept").mkdir()
    objects = Objects(build.build, tmp_path / "kept")

    def compiled(name: str, change: str = "") -> set[str]:
        """What is compiled in a new folder."""
        folder = tmp_path / name
        write(folder, cell.files)
        header = folder / "runtime/include/pn/pn_num.h"
        header.write_text(header.read_text() + change)
        log.unlink(missing_ok=True)
        d = Diagnostics()
        assert objects(folder, cell.files, d, target=target), render.report(d)
        assert (folder / target).exists()
        calls = [shlex.split(line) for line in log.read_text().splitlines()]
        return {Path(words[-1]).name for words in calls if "-o" in words and "-c" in words}

    first = compiled("first")
    own = {"net.c", "cell_config.c"}
    assert {"pn_list.c", "supervisor.c"} | own <= first
    assert compiled("second") - {"null"} == own
    assert compiled("changed", "/* changed */\n") == first
    monkeypatch.setenv(flags, "-O0 -DOTHER")
    assert compiled("otherwise") == first
