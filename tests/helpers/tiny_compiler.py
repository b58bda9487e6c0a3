"""What need not be quick is compiled by `tcc`, where it is there: ten times as fast as by gcc without optimization.

Only what is generated, and only where nothing but its answers is looked at: nets of explorers and simulators, and what
`make` builds with `CFLAGS=-O0`; the runtime is compiled by gcc. What `tcc` does not accept is compiled as usual, which
also says what is wrong with it. That C compiles without warnings is looked at elsewhere (`helpers.compiled`). They are
linked by `helpers.linker`.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from helpers import linker
from pn2code.diagnostics import Diagnostics
from pn2code.emission.output import OutputFile
from pn2code.toolchain import programs

MARK = "-DPN_TESTED"
"""A flag that means nothing: programs made here are not taken for those that users have."""

SUPPORT = "libtcc1.a"
"""What its objects call where gcc has instructions of its own, as for a double of an unsigned number."""
HOSTS = ("explore", "simulate")
"""Whose nets it compiles: alone, also where users have them in one piece with a source of the host."""
STRICT = ("-Werror", "-Wimplicit-function-declaration")
"""Functions of gcc that it does not have are refused, instead of being missed when all is linked."""
WHOLE = '-DPN_NET_SOURCE="net.c"'
SCRIPT_NAME = "quick-cc"
SCRIPT = """#!/bin/sh
case " $* " in
    *" -fsanitize"* | *" --coverage "*) ;;
    *" -c "*" net.c " | *" -c "*" cell_config.c ") {tiny} {strict} "$@" 2>/dev/null && exit 0 ;;
    *" -o "*) exec {usual} "$@" {support} {linker} ;;
esac
exec {usual} "$@"
"""


def support(tiny: str) -> str | None:
    """The library that comes with it."""
    command = [tiny, "-print-search-dirs"]
    said = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    found = [line.split()[1] for line in said.splitlines() if line.startswith("install:")]
    library = Path(found[0]) / SUPPORT if found else None
    return str(library) if library is not None and library.is_file() else None


class QuickMake:
    """`toolchain.build.build`, whose `make` compiles with `tcc` where it is told not to optimize.

    Args:
        build: what builds.
        folder: where the compiler's script is written, for all workers.
    """

    def __init__(self, build: Callable[..., Path | None], folder: Path) -> None:
        self._build, self._folder = build, folder
        script_at = folder / SCRIPT_NAME
        tiny, usual = shutil.which("tcc"), shutil.which("gcc") or shutil.which("cc")
        library = support(tiny) if tiny else None
        if library is not None and usual is not None and not script_at.exists():
            with tempfile.NamedTemporaryFile("w", dir=folder, delete=False) as script:
                script.write(
                    SCRIPT.format(
                        tiny=tiny,
                        strict=" ".join(STRICT),
                        usual=usual,
                        support=library,
                        linker=" ".join(linker.QUICK),
                    )
                )
            Path(script.name).chmod(0o755)
            Path(script.name).replace(script_at)

    def __call__(
        self, folder: Path, files: Iterable[OutputFile], d: Diagnostics, **options: str
    ) -> Path | None:
        with quick_compiler(self._folder):
            return self._build(folder, files, d, **options)


@contextmanager
def quick_compiler(folder: Path) -> Iterator[None]:
    """The C compiler is the script of that folder, where it is there and nothing is to be optimized."""
    script = folder / SCRIPT_NAME
    with pytest.MonkeyPatch.context() as changed:
        if os.environ.get("CFLAGS") == "-O0" and not os.environ.get("CC") and script.exists():
            changed.setenv("CC", str(script))
        yield


def use(changed: pytest.MonkeyPatch) -> tuple[str, ...]:
    """Patches the builder of programs; gives the flags that its programs have then."""
    tiny = shutil.which("tcc")
    library = support(tiny) if tiny else None
    if tiny is None or library is None:
        return ()
    usual = programs._Builder._compiler

    def compiled(builder: programs._Builder, room: Path, *arguments: str, d: Diagnostics) -> bool:
        is_net = arguments[-2:] == ("-c", "net.c") and builder.host.name in HOSTS
        is_quick = {"-O0", MARK} <= set(builder.flags) and not builder.interrupted()
        if is_quick and WHOLE in arguments and builder.host.name in HOSTS:
            return False
        if is_quick and is_net:
            command = [tiny, *STRICT, *builder.flags, *arguments]
            done = subprocess.run(command, cwd=room, capture_output=True, check=False)
            if done.returncode == 0:
                return True
        if MARK in builder.flags and "-c" not in arguments:
            arguments = (*arguments, library, *linker.QUICK)
        return usual(builder, room, *arguments, d=d)

    changed.setattr(programs._Builder, "_compiler", compiled)
    return (MARK,)
