"""`SharedDirectory`: one party's view of the shared files (docs/protocol.md; the invariants I1..I10 are cited).

    with SharedDirectory(path, "robot1", specs) as shared:
        if not shared.await_supervisor(10.0):
            ...                                   # nobody there
        command = shared.read("flag1_interno")    # Message, None (empty) or Refused
        shared.clear("flag1_interno")             # consumed
        shared.write("flag1_externo", (1,))       # the answer
        shared.set_status(Status.FINISHED)

Content that cannot be taken is a result (`Refused`), never an exception. `OSError` is raised when the directory itself
fails (removed, full, read-only); nothing is left half-written then.
"""

from __future__ import annotations

import errno
import fcntl
import os
import re
import secrets
import stat
import time
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from enum import Enum
from pathlib import Path

from pn2code.base.closing import Closing
from pn2code.base.frozen import frozen, record
from pn2code.channels.message import (
    EMPTY,
    ChannelSpec,
    Message,
    Reason,
    Refused,
    compose,
    is_empty,
    parse,
)
from pn2code.channels.scalars import ScalarValue, quote

GRACE_S = 0.5
"""I6: how long (wall time) a refused file may stay as it is before the side stops."""

LOOK_S = 0.1
"""I8: how often the other side's lock and status are looked at."""

_AWAIT_S = 0.005

_STATUS_BYTES = 4096
"""Of a status file that are read."""

_PID = re.compile(r"[0-9]{1,18}")


class Status(Enum):
    """What a side says of itself (I9)."""

    RUNNING = "running"
    FINISHED = "finished"
    STOPPED = "stopped"


class PeerState(Enum):
    """What is known of the other side."""

    ABSENT = "absent"
    """has not announced itself"""
    RUNNING = "running"
    FINISHED = "finished"
    STOPPED = "stopped"
    DEAD = "dead"
    """it said `running`, but nobody holds the lock: the process has died"""
    REPLACED = "replaced"
    """a new session has begun: the supervisor that this side knew is gone"""


@frozen
class Peer:
    """State of the other side; `reason` in words for STOPPED."""

    state: PeerState
    reason: str = ""
    pid: int | None = None


@frozen
class Written:
    """The message was published with this seq."""

    seq: int


@frozen
class NotWritten:
    """The message was not published: `channel-overrun` (I3) or `channel-value` (it does not fit the channel)."""

    channel: str
    file: str
    code: str
    text: str


@record
class _ChannelState:
    """What this side remembers of one channel."""

    consumed: int = 0
    sent: int = 0
    content: str | None = None
    """the file's content while its message is taken and not cleared"""
    message: Message | None = None
    reported: str | None = None


@frozen
class StatusFile:
    """What a status file says (I9): `running`, `finished` or `stopped`, session, process, and in words why."""

    state: str
    session: str
    pid: int | None
    reason: str


class SharedDirectory(Closing):
    """One party's side of all its channels. Not for use by several threads at once."""

    def __init__(
        self,
        path: Path,
        side: str,
        specs: Iterable[ChannelSpec],
        *,
        supervisor: str = "supervisor",
    ) -> None:
        """Touches nothing yet: a robot waits for the supervisor first (I7).

        Args:
            path: the shared directory.
            side: this party's name, "robot1".
            specs: the cell's channels; those of other parties are ignored.
            supervisor: name of the party that begins the session.
        """
        self.path = path
        self.side = side
        self.session: str | None = None
        self.was_here = False
        """Whether another process has been this side in the session that runs."""
        self._supervisor = supervisor
        self._specs: dict[str, ChannelSpec] = {}
        self._state: dict[str, _ChannelState] = {}
        self._lock: int | None = None
        for spec in specs:
            if side in (spec.writer, spec.reader):
                self._specs[spec.name] = spec
                self._specs[spec.file] = spec
                self._state[spec.name] = _ChannelState()

    # --- session and liveness (I7, I8, I9) ---

    def announce(self) -> str:
        """Begins a session, as the supervisor's side: takes the lock, empties this side's channels, says `running`.

        Returns the session. BlockingIOError: another process holds the lock.
        """
        self._take_lock()
        self.session = secrets.token_hex(4)
        for spec in set(self._specs.values()):
            self._publish(spec.file, EMPTY)
        self.set_status(Status.RUNNING)
        return self.session

    def await_supervisor(self, timeout: float) -> bool:
        """Waits until the supervisor runs, then joins its session: takes this side's lock and says `running`.

        False when none has appeared after `timeout` seconds; `was_here` tells why. A session in which another process
        has been this side is not joined: what that process has taken, and whether it was carried out, nobody knows.
        """
        end = time.monotonic() + timeout
        while True:
            session = self._running_session()
            if session is not None and self._join(session):
                return True
            if time.monotonic() >= end:
                return False
            time.sleep(_AWAIT_S)

    def _running_session(self) -> str | None:
        """The session of the supervisor that runs now."""
        before = self._read_status(self._supervisor)
        alive = self._is_locked(self._supervisor)
        after = self._read_status(self._supervisor)
        runs = alive and before == after and after is not None and after.state == "running"
        return after.session if runs and after is not None else None

    def _join(self, session: str) -> bool:
        """Looks again once this side's lock is taken: a new supervisor asks for it before it touches the channels."""
        if self._lock is None:
            self._lock = self._open_locked()
            old = self._read_status(self.side)
            self.was_here = old is not None and old.session == session
            if self.was_here:
                self.close()  # and leave the status as it is: it tells the supervisor
                return False
            os.ftruncate(self._lock, 0)
            if self._running_session() != session:
                self.close()
                return False
        self.session = session
        for state in self._state.values():
            state.consumed = state.sent = 0
        self.set_status(Status.RUNNING)
        return True

    @property
    def began(self) -> float:
        """When the supervisor announced itself (s, as `time.time` counts); now, where that is not known."""
        try:
            return self._status_path(self._supervisor).stat().st_mtime
        except OSError:
            return time.time()

    def peer(self, name: str | None = None) -> Peer:
        """What is known of another party (by default the supervisor)."""
        name = name if name is not None else self._supervisor
        locked = self._is_locked(name)  # the lock first: who gives it up has said why before
        status = self._read_status(name)
        if status is None or self.session is None:
            return Peer(PeerState.ABSENT)
        if status.session != self.session:
            state = PeerState.REPLACED if name == self._supervisor else PeerState.ABSENT
            return Peer(state, status.reason, status.pid)
        if status.state == "running" and not locked:
            return Peer(PeerState.DEAD, "", status.pid)
        try:
            return Peer(PeerState(status.state), status.reason, status.pid)
        except ValueError:
            return Peer(PeerState.ABSENT)

    def peer_alive(self) -> bool:
        """Whether the supervisor runs, in the session that this side joined."""
        return self.peer().state is PeerState.RUNNING

    def set_status(self, state: Status, reason: str = "") -> None:
        """Says what has become of this side (I9): written in place, under the lock."""
        if self._lock is None or self.session is None:
            return  # never joined: there is nobody who could be waiting for this
        line = " ".join(reason.split())
        text = f"{state.value}\n{self.session} {os.getpid()}\n{line}\n".encode()
        os.pwrite(self._lock, text, 0)
        os.ftruncate(self._lock, len(text))

    def close(self) -> None:
        """Gives up the lock. Say `finished` or `stopped` before, or the other side takes this one for dead."""
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    # --- channels (I1..I6) ---

    def read(self, channel: str) -> Message | None | Refused:
        """What the channel (name or file name) holds; the same message until `clear`."""
        spec, state = self._channel(channel)
        content = self._content(spec)
        if isinstance(content, Refused):
            return self._once(state, content)
        if state.message is not None:
            if content == state.content:
                return state.message
            text = f"changed to {quote(content)} before its message was consumed (channel-overrun)"
            refusal = Refused(spec.name, spec.file, Reason.OVERWRITTEN, content, text)
            return self._once(state, refusal)
        found = parse(spec, content, session=self.session or "-", consumed=state.consumed)
        if isinstance(found, Message):
            state.content, state.message = content, found
        if isinstance(found, Refused):
            return self._once(state, found)
        state.reported = None
        return found

    def clear(self, channel: str) -> None:
        """The message that `read` gave has been consumed: empties the file (I4)."""
        spec, state = self._channel(channel)
        self._publish(spec.file, EMPTY)
        if state.message is not None and state.message.seq is not None:
            state.consumed = state.message.seq
        state.message = state.content = None

    def write(self, channel: str, scalars: Sequence[ScalarValue]) -> Written | NotWritten:
        """Publishes a message (I2); not over one that has not been taken (I3)."""
        spec, state = self._channel(channel)
        content = self._content(spec)
        held = content.found if isinstance(content, Refused) else content
        if not is_empty(held):
            text = f"{spec.file} still holds {quote(held)}, which {spec.reader} has not taken"
            return NotWritten(spec.name, spec.file, "channel-overrun", text)
        message = compose(spec, scalars, seq=state.sent + 1, session=self.session or "-")
        if message is None:
            shown = ", ".join(quote(repr(s)) for s in scalars)
            why = f"no token of its colour set, not finite, or more than {spec.max_payload:,} bytes"
            text = f"{shown} cannot be written to {spec.file}: {why}"
            return NotWritten(spec.name, spec.file, "channel-value", text)
        self._publish(spec.file, message)
        state.sent += 1
        return Written(state.sent)

    def is_taken(self, channel: str) -> bool:
        """Whether the reader has emptied the channel."""
        spec, _ = self._channel(channel)
        content = self._content(spec)
        return not isinstance(content, Refused) and is_empty(content)

    # --- files ---

    def _channel(self, name: str) -> tuple[ChannelSpec, _ChannelState]:
        spec = self._specs[name]
        return spec, self._state[spec.name]

    def _content(self, spec: ChannelSpec) -> str | Refused:
        try:
            data = read_at_once(self.path / spec.file, spec.max_bytes)
        except FileNotFoundError:
            if not self.path.is_dir():
                raise
            text = "the file is missing; an empty channel is a file that holds `0`"
            return Refused(spec.name, spec.file, Reason.MISSING, "", text)
        return data.decode("latin-1")

    @staticmethod
    def _once(state: _ChannelState, refusal: Refused) -> Refused:
        first = state.reported != refusal.text
        state.reported = refusal.text
        return replace(refusal, first=first)

    def _publish(self, file: str, text: str) -> None:
        temporary = self.path / f".{file}.{self.side}.tmp"
        try:
            _write_new(temporary, text.encode("latin-1"))
            temporary.replace(self.path / file)
        except OSError as problem:
            with suppress(OSError):
                temporary.unlink()
            if problem.filename is None:  # a full disk is found when the file is open
                problem.filename = str(self.path / file)
            raise

    def _take_lock(self) -> None:
        if self._lock is None:
            self._lock = self._open_locked(empty=True)

    def _open_locked(self, *, empty: bool = False) -> int:
        """The status file of this side, locked. `empty`: nobody finds it locked before it is empty (I7).

        Raises:
            BlockingIOError: another process holds the lock.
        """
        fd = _open(self._status_path(self.side), os.O_RDWR | os.O_CREAT)
        try:
            for attempt in range(20):  # somebody may just be probing it
                try:
                    if empty:  # whoever holds the exclusive lock denies us the shared one
                        fcntl.flock(fd, fcntl.LOCK_SH | fcntl.LOCK_NB)
                        os.ftruncate(fd, 0)
                    fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
                except BlockingIOError:
                    if attempt == 19:
                        raise
                    time.sleep(_AWAIT_S)
                else:
                    return fd
        except BaseException:
            os.close(fd)
            raise
        raise AssertionError

    def _status_path(self, side: str) -> Path:
        return self.path / f"{side}.status"

    def _is_locked(self, side: str) -> bool:
        try:
            fd = _open(self._status_path(side), os.O_RDONLY)
        except FileNotFoundError:
            return False
        try:
            fcntl.flock(fd, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        finally:
            os.close(fd)
        return False

    def _read_status(self, side: str) -> StatusFile | None:
        return read_status(self._status_path(side))


def read_at_once(path: Path, most: int) -> bytes:
    """The first bytes of a file, without waiting: a pipe in its place holds nobody up, and no link is followed.

    Raises:
        OSError: it cannot be read, or is no file.
    """
    fd = _open(path, os.O_RDONLY)
    try:
        return os.read(fd, most)
    finally:
        os.close(fd)


def _open(path: Path, flags: int) -> int:
    """Opens a file as the supervisor does (port_posix.c): without waiting, following no link.

    Raises:
        OSError: it cannot be opened, or is no file.
    """
    not_a_file = "it is a link, a pipe, a folder or the like, not a file"
    try:
        fd = os.open(path, flags | os.O_NONBLOCK | os.O_NOFOLLOW | os.O_CLOEXEC, 0o644)
    except OSError as problem:
        if problem.errno in (errno.ELOOP, errno.ENXIO, errno.EISDIR):
            raise OSError(problem.errno, not_a_file, str(path)) from None
        raise
    if not stat.S_ISREG(os.fstat(fd).st_mode):
        os.close(fd)
        raise OSError(errno.EINVAL, not_a_file, str(path))
    return fd


def _write_new(path: Path, data: bytes) -> None:
    """As `read_at_once`."""
    fd = _open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    with os.fdopen(fd, "wb", buffering=0) as stream:
        while data:
            data = data[stream.write(data) :]


def read_status(path: Path) -> StatusFile | None:
    """What a status file says; None: it is not there, is being written, or is none."""
    try:
        text = read_at_once(path, _STATUS_BYTES).decode("utf-8", errors="replace")
    except FileNotFoundError:
        return None
    lines = [*text.split("\n"), "", "", ""]
    words = lines[1].split()
    if len(words) != 2:
        return None  # being written, or not ours
    pid = int(words[1]) if _PID.fullmatch(words[1]) else None
    return StatusFile(lines[0], words[0], pid, lines[2])
