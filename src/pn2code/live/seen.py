"""What can be seen of a cell in its shared folder, without touching anything there.

    eye = Eye(folder, specs, parties)
    seen = eye.look()
    seen.sides["robot1"].state     # Life.RUNS
    seen.texts["flag1_interno"]    # "1\\n# 4 9f3ac01d 5efc4210\\n"; None: the file is not there

Files are opened for reading only, and locks are not tried, as the sides of the cell do (I8): a lock that we held for a
moment could delay a side that starts. Whether a side lives is read from the system's list of locks and processes.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from enum import Enum
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.channels import ChannelSpec, StatusFile, read_at_once, read_status

_LOCKS = Path("/proc/locks")


class Life(Enum):
    """What is known of a side."""

    NOT_STARTED = "has not started"
    RUNS = "runs"
    FINISHED = "has finished"
    STOPPED = "has stopped"
    DIED = "has died"
    """it said `running`, but its process is gone"""


@frozen
class Side:
    """A side of the cell: state, in words why, process, session."""

    state: Life
    reason: str = ""
    pid: int | None = None
    session: str = ""


@frozen
class Seen:
    """One look.

    Args:
        is_there: whether the folder is.
        session: of the supervisor, "" if there is none.
        began: when its status was written last (s, as `time.time` counts).
        sides: by name.
        texts: the content of each channel by its name; None: no such file.
    """

    is_there: bool
    session: str
    began: float
    sides: Mapping[str, Side]
    texts: Mapping[str, str | None]


class Eye:
    """Looks.

    Args:
        folder: the shared folder.
        specs: the channels.
        parties: names of the sides, the supervisor's first.
    """

    def __init__(self, folder: Path, specs: Sequence[ChannelSpec], parties: Sequence[str]) -> None:
        self._folder, self._specs, self._parties = folder, tuple(specs), tuple(parties)
        self._had_lock: set[int] = set()
        """Inodes of status files whose lock the system has listed: when it lists it no more, the side has died."""

    def look(self) -> Seen:
        """How things are now."""
        supervisor = self._parties[0]
        status = self._status(supervisor)
        session = status.session if status is not None else ""
        locked = _locked()
        sides = {name: self._side(name, session, locked) for name in self._parties}
        texts = {spec.name: self._text(spec) for spec in self._specs}
        return Seen(self._folder.is_dir(), session, self._time(supervisor), sides, texts)

    def texts(self) -> dict[str, str | None]:
        """The channels alone: what can change quickest."""
        return {spec.name: self._text(spec) for spec in self._specs}

    def _time(self, side: str) -> float:
        try:
            return (self._folder / f"{side}.status").stat().st_mtime
        except OSError:
            return 0.0

    def _status(self, side: str) -> StatusFile | None:
        try:
            return read_status(self._folder / f"{side}.status")
        except OSError:
            return None

    def _side(self, name: str, session: str, locked: frozenset[int]) -> Side:
        status = self._status(name)
        if status is None or not session or status.session != session:
            return Side(Life.NOT_STARTED)
        state = {"running": Life.RUNS, "finished": Life.FINISHED, "stopped": Life.STOPPED}.get(
            status.state, Life.NOT_STARTED
        )
        if state is Life.RUNS and not self._is_alive(name, status, locked):
            again = self._status(name)  # it may have said its last word meanwhile
            if again == status:
                state = Life.DIED
            elif again is not None:
                return self._side(name, session, locked)
        return Side(state, status.reason, status.pid, status.session)

    def _is_alive(self, name: str, status: StatusFile, locked: frozenset[int]) -> bool:
        """Whether the file's lock is held, as far as the system lists it, or the process is there."""
        try:
            inode = (self._folder / f"{name}.status").stat().st_ino
        except OSError:
            return False
        if inode in locked:
            self._had_lock.add(inode)
            return True
        return inode not in self._had_lock and is_alive(status.pid)

    def _text(self, spec: ChannelSpec) -> str | None:
        """Twice as much is read as a message may have: one that is too long shows that it is."""
        try:
            return read_at_once(self._folder / spec.file, 2 * spec.max_bytes).decode("latin-1")
        except OSError:
            return None


def is_alive(pid: int | None) -> bool:
    """Whether a process runs; one that has ended and was not yet waited for does not."""
    if pid is None or pid <= 0:
        return False
    try:
        stat = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8", errors="replace")
    except OSError:
        try:
            os.kill(pid, 0)  # signal 0 asks only
        except ProcessLookupError:
            return False
        except OSError:
            return True
        return not Path("/proc/self/stat").is_file()
    return stat.rpartition(")")[2].split()[:1] not in (["Z"], ["X"])


def _locked() -> frozenset[int]:
    """The inodes of files with an exclusive lock."""
    try:
        text = _LOCKS.read_text(encoding="ascii", errors="replace")
    except OSError:
        return frozenset()
    found = re.findall(r"FLOCK\s+\S+\s+WRITE\s+\S+\s+[0-9a-f]+:[0-9a-f]+:(\d+)", text)
    return frozenset(map(int, found))
