"""No compiler works on for a command that was killed, whatever it has started itself."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from helpers.played import PATIENCE_S

SLOW = '#!/bin/sh\nsleep 1000 & echo $! >"$SAYS.part" && mv "$SAYS.part" "$SAYS"\nwait\n'
"""A compiler driver: what works is a process that it has started."""
OF_A_NET = """
from pathlib import Path
from pn2code.toolchain.tool_runs import run_tool
run_tool([{tool!r}, "-c", "net.c"], Path({folder!r}))
"""
OF_MAKE = """
from pathlib import Path
from pn2code.diagnostics import Diagnostics
from pn2code.toolchain.build import build
build(Path({folder!r}), (), Diagnostics())
"""


def _works(pid: int) -> bool:
    """Not whether it is there: nobody may have asked yet how it ended."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8")
    except OSError:
        return False
    return stat.rpartition(")")[2].split()[0] not in "ZX"


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
@pytest.mark.parametrize("code", [OF_A_NET, OF_MAKE], ids=["net", "make"])
def test_what_a_compiler_has_started_ends_with_a_killed_command(code: str, tmp_path: Path) -> None:
    tool, says = tmp_path / "cc", tmp_path / "pid"
    tool.write_text(SLOW)
    tool.chmod(0o755)
    (tmp_path / "Makefile").write_text(f"supervisor:\n\t{tool} -c net.c\n")
    command = [sys.executable, "-c", code.format(tool=str(tool), folder=str(tmp_path))]
    process = subprocess.Popen(command, env={**os.environ, "SAYS": str(says)})
    until = time.monotonic() + PATIENCE_S
    try:
        while not says.is_file():
            assert process.poll() is None and time.monotonic() < until
            time.sleep(0.02)
    finally:
        process.kill()
        process.wait()
    worker = int(says.read_text())
    try:
        while _works(worker):
            assert time.monotonic() < until, "the compiler works on for nobody"
            time.sleep(0.02)
    finally:
        if _works(worker):
            os.kill(worker, signal.SIGKILL)
