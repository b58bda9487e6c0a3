"""A server of the live page that is ended while pages wait for it: they get an answer, and nobody gets a traceback."""

from __future__ import annotations

import signal
import socket
import subprocess
import sys

from pn2code.live.handing import Handing
from pn2code.live.server import Start

PATIENCE_S = 120.0


def asked(port: int) -> socket.socket:
    """A browser that has asked for a page which is not there yet."""
    page = socket.create_connection(("127.0.0.1", port), PATIENCE_S)
    page.sendall(f"GET /t/ HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
    return page


def whole(page: socket.socket) -> bytes:
    said = b""
    while part := page.recv(1 << 16):
        said += part
    return said


def test_pages_that_wait_are_let_go() -> None:
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        listening.listen()
        number = listening.fileno()
        port = listening.getsockname()[1]
        server = subprocess.Popen(
            [sys.executable, "-P", "-m", "pn2code.live.server", str(number)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, pass_fds=(number,),
        )  # fmt: skip
    assert server.stdin is not None
    handing = Handing(server.stdin.fileno())
    handing.give(Start(port, "t", "s"))
    assert handing.finish(PATIENCE_S)
    pages = [asked(port) for _ in range(3)]
    # One that is refused at once has been answered, so the others have been heard.
    with socket.create_connection(("127.0.0.1", port), PATIENCE_S) as other:
        other.sendall(b"GET / HTTP/1.1\r\nHost: elsewhere\r\nConnection: close\r\n\r\n")
        assert whole(other).startswith(b"HTTP/1.1 4")
    server.send_signal(signal.SIGTERM)
    for page in pages:
        with page:
            assert b"The cell is being built." in whole(page)
    _, errors = server.communicate(timeout=PATIENCE_S)
    assert (server.returncode, errors) == (0, b"")
