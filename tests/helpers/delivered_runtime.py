"""Explorers of the tests have the runtime that users have, compiled for speed, whatever their net is compiled with.

It is compiled once a session, for tests, for those who use `as_delivered` and for commands in other processes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from helpers.compiled import DELIVERED
from pn2code.diagnostics import Diagnostics
from pn2code.emission.output import OutputFile
from pn2code.toolchain import programs
from pn2code.toolchain.programs import Compiler, Host

HOST = "explore"
QUICK = "-O0"


def use(changed: pytest.MonkeyPatch) -> None:
    """Patches the builder of programs."""
    begin, usual = programs._Builder.__init__, programs._Builder._compiler

    def begun(
        builder: programs._Builder,
        folder: Path,
        host: Host,
        compiler: Compiler,
        files: Sequence[OutputFile],
        interrupted: Callable[[], bool],
    ) -> None:
        begin(builder, folder, host, compiler, files, interrupted)
        if is_quick(builder):
            flags, programs.FLAGS = programs.FLAGS, DELIVERED
            try:
                users = object.__new__(programs._Builder)
                begin(users, folder, host, compiler, (), interrupted)
            finally:
                programs.FLAGS = flags
            builder.library = users.library

    def compiled(builder: programs._Builder, room: Path, *arguments: str, d: Diagnostics) -> bool:
        is_runtime = arguments[-1].startswith("runtime/src/")
        is_changed = is_quick(builder) and is_runtime
        return usual(builder, room, *(("-O2",) if is_changed else ()), *arguments, d=d)

    changed.setattr(programs._Builder, "__init__", begun)
    changed.setattr(programs._Builder, "_compiler", compiled)


def is_quick(builder: programs._Builder) -> bool:
    """Whether it is an explorer whose net is compiled without optimization."""
    return builder.host.name == HOST and QUICK in builder.flags
