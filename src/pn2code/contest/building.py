"""The engine is compiled by a process that outlives the command which needs it.

    wait_until_built()
    with engine(d) as program:       # is there, or says why it is not

Compiling takes some seconds of a processor, once for a version of this tool, and many more where others keep it busy. A
command that ends at its limit would end its compilers too, and so would the next one, as long as none has the time that
one file takes. So another process compiles, and keeps what it has compiled; of several commands the others wait for the
first one's. Only who is interrupted (Ctrl-C) ends it.
"""

from __future__ import annotations

import fcntl
import os
import signal
import subprocess
import sys
from contextlib import suppress

from pn2code.base.deadline import is_command
from pn2code.base.private_folder import private_folder
from pn2code.contest.engine import HOST, engine
from pn2code.diagnostics import Diagnostics
from pn2code.toolchain.programs import is_kept

_LONGEST_S = 900
"""A compiler that hangs is not waited for longer, nor by other commands."""


def wait_until_built() -> None:
    """Has the engine compiled by another process, unless it is there, or cannot be kept.

    Within a larger program (a test) nothing is done: who wants the engine compiles it.
    """
    if not is_command() or private_folder() is None or is_kept(HOST, ()):
        return
    quiet = subprocess.DEVNULL
    process = subprocess.Popen(
        [sys.executable, "-P", "-m", __name__],
        stdin=quiet,
        stdout=quiet,
        stderr=quiet,
        start_new_session=True,
    )
    try:
        process.wait()
    except BaseException:
        process.kill()  # its compilers end with it
        process.wait()
        raise


def _build() -> None:
    """Compiles. The cache folder is locked meanwhile, so nothing is left in it, whatever ends the process."""
    signal.alarm(_LONGEST_S)
    folder = private_folder()
    if folder is None:
        return
    with suppress(OSError):  # of file systems that know no locks, where several may compile
        fd = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
        fcntl.flock(fd, fcntl.LOCK_EX)
    with engine(Diagnostics()):
        pass


if __name__ == "__main__":
    _build()
