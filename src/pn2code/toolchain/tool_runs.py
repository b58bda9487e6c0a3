"""Running a compiler to its end, unless it is wished that the build ends."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

from pn2code.toolchain.orphans import tools_of_ours

LOOK_S = 0.1
"""So often it is looked whether a build is to end."""


class BuildInterruptedError(Exception):
    """It was wished that the build ends."""


def never() -> bool:
    """For builds that nothing interrupts."""
    return False


def run_tool(
    command: Sequence[str],
    folder: Path | None = None,
    interrupted: Callable[[], bool] = never,
) -> subprocess.CompletedProcess[str] | None:
    """Runs a tool to its end; None when it is not there.

    It does not hear the terminal's Ctrl-C, which would look like a failure of its own, and ends when this process is
    killed. Its temporary files lie in the folder, and go with it.

    Raises:
        BuildInterruptedError: it was wished, and the tool has been ended.
    """
    own = {"TMPDIR": str(folder)} if folder else {}
    with tools_of_ours() as group:
        try:
            process = subprocess.Popen(
                command,
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                errors="replace",
                process_group=group.number,
                env={**os.environ, **own, "LC_ALL": "C"},
            )
        except OSError:
            return None
        try:
            while True:
                with suppress(subprocess.TimeoutExpired):
                    said, errors = process.communicate(timeout=LOOK_S)
                    break
                if interrupted():
                    raise BuildInterruptedError
        except BaseException:
            group.end(process)
            process.communicate()
            raise
    return subprocess.CompletedProcess(command, process.returncode, said, errors)
