"""Explorers of the tests are compiled by `tcc`, where it is there: ten times as fast as by gcc without optimization.

Only the net, and only where nothing but its answers is looked at. What `tcc` does not accept is compiled as usual,
which also says what is wrong with it. That C compiles without warnings is looked at elsewhere (`helpers.compiled`).
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from pn2code.diagnostics import Diagnostics
from pn2code.toolchain import programs

MARK = "-DPN_TESTED"
"""A flag that means nothing: programs made here are not taken for those that users have."""


def use(changed: pytest.MonkeyPatch) -> tuple[str, ...]:
    """Patches the builder of programs; gives the flags that its programs have then."""
    tiny = shutil.which("tcc")
    if tiny is None:
        return ()
    usual = programs._Builder._compiler

    def compiled(builder: programs._Builder, room: Path, *arguments: str, d: Diagnostics) -> bool:
        is_net = builder.host.name == "explore" and arguments[-2:] == ("-c", "net.c")
        if is_net and {"-O0", MARK} <= set(builder.flags) and not builder.interrupted():
            command = [tiny, "-w", *builder.flags, *arguments]
            done = subprocess.run(command, cwd=room, capture_output=True, check=False)
            if done.returncode == 0:
                return True
        return usual(builder, room, *arguments, d=d)

    changed.setattr(programs._Builder, "_compiler", compiled)
    return (MARK,)
