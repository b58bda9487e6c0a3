"""No tool works on for nobody: when this process is killed, its compilers end with it, and all that they have started.

with tools_of_ours() as group:
    process = subprocess.Popen(command, process_group=group.number)
    ...
    group.end(process)      # if it is to end earlier

A compiler driver is not all of a compiler: what it has started would go on if it alone were ended. So the tools are in
the process group of a shell, which was there before them and waits at a pipe to which nobody writes. Whatever ends this
process, the system closes the pipe; then the shell ends its group.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

from pn2code.base.frozen import frozen

_WAIT = "read -r _ || kill -KILL 0"
"""`read` says no at the end of the pipe; 0 is the shell's own group."""


@frozen
class Group:
    """A process group of tools.

    Args:
        number: for `subprocess.Popen(process_group=...)`; 0: each process leads a group of its own.
    """

    number: int

    def end(self, process: subprocess.Popen[Any]) -> None:
        """Ends a tool with all that it has started."""
        with suppress(OSError):
            os.killpg(self.number or process.pid, signal.SIGKILL)


@contextmanager
def tools_of_ours() -> Iterator[Group]:
    """A group that ends with this process; where there is no shell, only one that does not hear the terminal."""
    shell = shutil.which("sh")
    if shell is None:
        yield Group(0)
        return
    theirs, ours = os.pipe()
    try:
        waiting = subprocess.Popen([shell, "-c", _WAIT], stdin=theirs, process_group=0)
    except OSError:
        os.close(ours)
        yield Group(0)
        return
    finally:
        os.close(theirs)
    try:
        yield Group(waiting.pid)
    finally:
        waiting.kill()
        waiting.wait()
        os.close(ours)
