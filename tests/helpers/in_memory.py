"""The temporary files of the tests lie in memory, where there is room: a disk writes down each file that is exchanged.

A file that is written anew, or takes the place of another one, is written to the disk at once by ext4, so cells that
exchange messages, and tests that write one cell after the other, waited for it most of the time. In memory they do not,
and a run takes a seventh less processor time.

It is left to the disk where there is no such file system, little room in it or in memory, or programs in it cannot be
run; and where somebody says where temporary files lie (`--basetemp`, TMPDIR, PYTEST_DEBUG_TEMPROOT). What a run leaves
is removed at its end, unless tests have failed, then at the beginning of the next one.

Where nothing is kept for a next run (`PN2CODE_TEST_FORGETS=1`, as in `.ci/run`), what `./dev test` would keep on the
disk lies there, too: programs of nets, in folders of hundreds of files that are made and removed, and objects.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from contextlib import suppress
from pathlib import Path

import pytest

from helpers.remembering_cc import KEPT

SHARED_MEMORY = Path("/dev/shm")
PREFIX = "pn-"
"""Then the process comes."""
ROOM = 6 << 30
"""Bytes that have to be free there: a run of all tests needs a third of it."""
MEMORY = 10 << 30
"""Bytes of memory that have to be available: they hold these files, and processes work in the rest."""
SAID = ("TMPDIR", "PYTEST_DEBUG_TEMPROOT")
FORGETS = "PN2CODE_TEST_FORGETS"
"""The variable that says that there is no next run."""
_KEPT = {"XDG_CACHE_HOME": "cache", KEPT: "objects"}
"""Variables for what is kept from one run to the next -> the folder in memory that takes its place."""
_MADE = pytest.StashKey[Path]()


def begin(config: pytest.Config) -> None:
    """Called when a session is configured; other processes that run tests inherit what the first one has chosen."""
    is_said = config.getoption("basetemp") or any(name in os.environ for name in SAID)
    if is_said or hasattr(config, "workerinput"):
        return
    made = room()
    if made is not None:
        config.stash[_MADE] = made
        os.environ.update(dict.fromkeys(SAID, str(made)))
        tempfile.tempdir = None  # it has been looked up
        if os.environ.get(FORGETS):
            os.environ.update(instead(made))


def instead(made: Path) -> dict[str, str]:
    """Variables that say that what is kept otherwise lies in folders there, which are made."""
    folders = {name: made / folder for name, folder in _KEPT.items()}
    for folder in folders.values():
        folder.mkdir(mode=0o700)
    return {name: str(folder) for name, folder in folders.items()}


def end(config: pytest.Config, status: int) -> None:
    """Called when the session ends."""
    made = config.stash.get(_MADE, None)
    if made is not None and status != pytest.ExitCode.TESTS_FAILED:
        shutil.rmtree(made, ignore_errors=True)


def room(shared: Path = SHARED_MEMORY, needed: int = ROOM, memory: int = MEMORY) -> Path | None:
    """A new folder in memory; None where files had better lie on a disk."""
    try:
        forget(shared)
        if shutil.disk_usage(shared).free < needed or available() < memory:
            return None
        made = shared / f"{PREFIX}{os.getpid()}"
        made.mkdir()
        made.chmod(0o711)  # programs that tests run as another user lie within
    except OSError:
        return None
    if not can_run(made):
        shutil.rmtree(made, ignore_errors=True)
        return None
    return made


def available(about: Path = Path("/proc/meminfo")) -> int:
    """Bytes of memory that processes can have.

    Raises:
        OSError: nobody says so.
    """
    for line in about.read_text().splitlines():
        if line.startswith("MemAvailable:"):
            return int(line.split()[1]) << 10
    return 0


def can_run(folder: Path) -> bool:
    """Whether programs that lie there can be run."""
    program = folder / "program"
    program.write_text("#!/bin/sh\nexit 7\n")
    program.chmod(0o700)
    with suppress(OSError):
        return subprocess.run([program], check=False).returncode == 7
    return False


def forget(shared: Path) -> None:
    """Removes what is left of runs that have ended."""
    for left in shared.glob(f"{PREFIX}[0-9]*"):
        number = left.name.removeprefix(PREFIX)
        if number.isdigit() and not Path("/proc", number).exists():
            shutil.rmtree(left, ignore_errors=True)
