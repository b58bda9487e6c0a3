"""The connections of a net to other programs, as Comms/CPN of CPN Tools makes them: TCP, in segments.

    connections = Connections(wait=10)
    connections.open("arm", "localhost", 9000)
    connections.send("arm", b"move")           # b"\\x04move"
    connections.receive("arm")                 # waits at most 10 seconds
    connections.close_all()

A message is sent as segments of a byte and at most 127 bytes of data: the byte is 255 if another segment follows,
otherwise the number of bytes. Whoever only simulates has no such object: then nothing is opened.
"""

from __future__ import annotations

import errno
import os
import select
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from pn2code.base.frozen import frozen
from pn2code.base.late import Late
from pn2code.semantics.values.data import MlUnavailable

if TYPE_CHECKING:
    import socket
else:
    socket = Late("socket")

SEGMENT = 127
"""Bytes of data in a segment."""
LONGEST_WAIT = 86_400
"""Most seconds that one may ask to wait."""
MORE = 255
"""The first byte of a segment that another one follows."""
_SLICE = 0.1
"""Seconds after which a wait asks whether it shall go on."""


@frozen
class ConnectionProblem(Exception):
    """What CPN Tools raises as an exception.

    Args:
        exception: its name.
        message: the text it has; None: none.
    """

    exception: str
    message: str | None = None


def _failed(error: OSError) -> ConnectionProblem:
    return ConnectionProblem("SysErr", os.strerror(error.errno) if error.errno else str(error))


def segments(data: bytes) -> bytes:
    """A message as it is sent."""
    parts = [data[at : at + SEGMENT] for at in range(0, len(data), SEGMENT)] or [b""]
    heads = [MORE] * (len(parts) - 1) + [len(parts[-1])]
    return b"".join(bytes([head]) + part for head, part in zip(heads, parts, strict=True))


class Connections:
    """The open ones, each with its name.

    Args:
        wait: seconds that opening, accepting, sending and receiving may take.
        interrupted: asked while something is waited for: shall the run end?
    """

    def __init__(self, wait: float, interrupted: Callable[[], bool] = lambda: False) -> None:
        self._wait = wait
        self._interrupted = interrupted
        self._open: dict[str, socket.socket] = {}
        self._is_once = False

    @contextmanager
    def computed_once(self) -> Iterator[None]:
        """While what is computed once for each occurrence runs, a code segment or a function of a monitor.

        Nothing else may use connections.
        """
        self._is_once = True
        try:
            yield
        finally:
            self._is_once = False

    # --- what a net does ---------------------------------------------------------------------------

    def open(self, name: str, host: str, port: int) -> None:
        """Connects to a server.

        Raises:
            ConnectionProblem: the name is in use, there is no such host, or nobody listens.
        """
        self._fresh(name)
        try:
            found = socket.getaddrinfo(host, port % 65536, socket.AF_INET, socket.SOCK_STREAM)
        except (OSError, ValueError):
            raise ConnectionProblem("BadAddr") from None
        opened = socket.socket()
        try:
            opened.setblocking(False)
            error = opened.connect_ex((str(found[0][4][0]), port % 65536))
            if error == errno.EINPROGRESS:
                what = f"`{name}` is not connected to {host}, port {port},"
                self._wait_for(opened, what, self._end(), select.POLLOUT)
                error = opened.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR)
            if error:
                raise ConnectionProblem("SysErr", os.strerror(error))
        except BaseException:
            opened.close()
            raise
        self._keep(name, opened)

    def accept(self, name: str, port: int) -> None:
        """Waits for a client, of any address of this machine.

        Raises:
            ConnectionProblem: the name is in use, or the port.
        """
        self._fresh(name)
        with socket.socket() as server:
            try:
                server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                server.bind(("", port % 65536))
                server.listen(1)
                what = f"nobody has connected to port {port}, `{name}`,"
                self._wait_for(server, what, self._end())
                opened, _ = server.accept()
            except OSError as error:
                raise _failed(error) from None
        self._keep(name, opened)

    def close(self, name: str) -> None:
        """Closes one."""
        self.known(name, "closing connection").close()
        del self._open[name]

    def send(self, name: str, data: bytes) -> None:
        """Sends a message."""
        connection = self.known(name, "sending data")
        end = self._end()
        left = memoryview(segments(data))
        while left:
            self._wait_for(
                connection, f"what is sent over `{name}` is not taken", end, select.POLLOUT
            )
            try:
                left = left[connection.send(left) :]
            except BlockingIOError:
                continue
            except OSError as error:
                raise _failed(error) from None

    def receive(self, name: str) -> bytes:
        """Waits for a message."""
        connection = self.known(name, "receiving data")
        end = self._end()
        found = bytearray()
        while True:
            (head,) = self._taken(connection, name, 1, end)
            found += self._taken(connection, name, min(head, SEGMENT), end)
            if head <= SEGMENT:
                return bytes(found)
            if time.monotonic() > end:
                raise self._late(f"a message over `{name}` has not come to its end")

    def can_receive(self, name: str) -> bool:
        """Whether something has come."""
        return self._is_ready(self.known(name, "receiving data"), 0)

    def close_all(self) -> None:
        """At the end of the run."""
        for connection in self._open.values():
            connection.close()
        self._open.clear()

    # --- parts -------------------------------------------------------------------------------------

    def known(self, name: str, doing: str) -> socket.socket:
        """The connection of that name."""
        self._asked()
        if name not in self._open:
            raise ConnectionProblem("ElementMissingExn", f"Failure {doing}: Connection not found.")
        return self._open[name]

    def _asked(self) -> None:
        if not self._is_once:
            raise MlUnavailable(
                "connections are for code segments and monitors: what else a net computes is computed more than once"
            )

    def _fresh(self, name: str) -> None:
        self._asked()
        if name in self._open:
            raise ConnectionProblem(
                "DupConnNameExn", "Failure opening connection: name already in use."
            )

    def _keep(self, name: str, opened: socket.socket) -> None:
        opened.setblocking(False)
        opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._open[name] = opened

    def _taken(self, connection: socket.socket, name: str, size: int, end: float) -> bytes:
        """So many bytes that have come."""
        found = b""
        while len(found) < size:
            self._wait_for(connection, f"nothing has come over connection `{name}`", end)
            try:
                part = connection.recv(size - len(found))
            except BlockingIOError:
                continue
            except OSError as error:
                raise _failed(error) from None
            if not part:
                raise ConnectionProblem("SysErr", "closed socket")
            found += part
        return found

    def _end(self) -> float:
        """When what begins now is late."""
        return time.monotonic() + max(self._wait, _SLICE)

    def _wait_for(
        self, connection: socket.socket, what: str, end: float, events: int = select.POLLIN
    ) -> None:
        """Until it is ready; also if it always is, the run may be ended meanwhile."""
        while True:
            if self._interrupted():
                raise MlUnavailable(f"{what} when the run was interrupted")
            if self._is_ready(connection, _SLICE, events):
                return
            if time.monotonic() > end:
                raise self._late(what)

    @staticmethod
    def _is_ready(connection: socket.socket, seconds: float, events: int = select.POLLIN) -> bool:
        """Asked of a socket with any number: `select` knows 1024."""
        asked = select.poll()
        asked.register(connection, events)
        return bool(asked.poll(1000 * seconds))

    def _late(self, what: str) -> MlUnavailable:
        return MlUnavailable(f"{what} within {self._wait:g} s (`--sockets`)")
