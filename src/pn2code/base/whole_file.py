"""Files that appear as a whole or not at all: written beside, then renamed.

    with whole_file(Path("report.html")) as beside:
        beside.write_text(text)

So a full disk or the end of the process leaves what was there before, and a reader never sees half of it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A file to write, with the same ending; it becomes `path` when the block ends well, and is removed otherwise.

    What is no ordinary file (`/dev/stdout`, a pipe) is given as it is.

    Raises:
        OSError: it cannot be written.
    """
    target = path.resolve()
    if target.exists() and not target.is_file():
        yield path
        return
    beside = target.with_name(f"{target.stem}.{os.getpid()}.part{target.suffix}")
    try:
        yield beside
        beside.replace(target)
    except BaseException:
        with suppress(OSError):
            beside.unlink()
        raise
