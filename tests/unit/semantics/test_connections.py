"""Connections to programs that do not what they should: no wait is longer than was asked, and Ctrl-C ends each."""

from __future__ import annotations

import resource
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import pytest

from pn2code.semantics.evaluation.connections import ConnectionProblem, Connections
from pn2code.semantics.values.data import MlUnavailable

SEGMENTS = 1000 * (b"\xff" + 127 * b"x")
"""Of a message that does not end."""


@contextmanager
def peer(data: bytes) -> Iterator[int]:
    """Sends that again and again, and reads nothing: its port."""
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        server.listen()

        def served() -> None:
            connection, _ = server.accept()
            with connection, suppress(OSError):
                while data:
                    connection.sendall(data)
                over.wait(60)

        over = threading.Event()
        thread = threading.Thread(target=served, daemon=True)
        thread.start()
        try:
            yield server.getsockname()[1]
        finally:
            over.set()
        thread.join(60)


def after(times: int) -> Iterator[bool]:
    """Asked so often, somebody wants the run to end."""
    yield from [False] * times
    while True:
        yield True


@pytest.mark.parametrize("doing", ["receive", "send"])
@pytest.mark.parametrize("is_interrupted", [False, True])
def test_a_wait_ends(doing: str, is_interrupted: bool) -> None:
    asked = after(20)
    connections = Connections(
        60 if is_interrupted else 0.3, (lambda: next(asked)) if is_interrupted else bool
    )
    with peer(SEGMENTS if doing == "receive" else b"") as port, connections.computed_once():
        connections.open("c", "127.0.0.1", port)
        why = "when the run was interrupted" if is_interrupted else r"within 0.3 s \(`--sockets`\)"
        with pytest.raises(MlUnavailable, match=why):
            if doing == "receive":
                connections.receive("c")
            else:
                connections.send("c", bytes(50_000_000))
        connections.close_all()


def test_a_host_that_is_none() -> None:
    connections = Connections(1)
    for host in ("a\0b", "x" * 300):
        with connections.computed_once(), pytest.raises(ConnectionProblem) as problem:
            connections.open("c", host, 9)
        assert problem.value.exception == "BadAddr"


def test_more_files_than_select_knows() -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if hard < 1100:
        pytest.skip("fewer files may be open")
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, 1100), hard))
    held = [socket.socket() for _ in range(1030)]
    connections = Connections(10)
    try:
        with peer(b"\x02hi") as port, connections.computed_once():
            connections.open("c", "127.0.0.1", port)
            assert connections.receive("c") == b"hi"
            connections.close_all()
    finally:
        for x in held:
            x.close()
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
