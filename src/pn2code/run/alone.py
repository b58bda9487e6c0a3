"""A folder of results that one run at a time writes.

with alone_in(folder):      # OutputFolderError: another run is at it
    ...
"""

from __future__ import annotations

import errno
import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from pn2code.emission.write import OutputFolderError, expect_writable

_WITHOUT_LOCKS = (errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS, errno.EINVAL)
"""Of file systems that know no locks, where nobody is kept out."""


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Makes the folder and keeps other runs out of it, until the end of this process at the latest.

    The folder itself is locked, so nothing is left in it, whatever ends the run. If nothing was written, it goes again.

    Raises:
        OutputFolderError: another run writes into it, or it cannot be written.
    """
    expect_writable(folder)
    made = [p for p in (folder, *folder.parents) if not p.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    fd = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        _lock(fd, folder)
        yield
    finally:
        os.close(fd)
        with suppress(OSError):  # something is in it
            for p in made:
                p.rmdir()


def _lock(fd: int, folder: Path) -> None:
    try:
        fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise OutputFolderError(
            f"another run is writing its results into `{folder}`; wait for its end, or give another folder with -o"
        ) from None
    except OSError as problem:
        if problem.errno not in _WITHOUT_LOCKS:
            raise
