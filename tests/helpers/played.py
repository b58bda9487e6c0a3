"""Games of `pn2code play` for tests: sessions without a server, servers, and a client of its WebSocket."""

from __future__ import annotations

import http.client
import json
import os
import re
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Self

from wsproto import ConnectionType, WSConnection
from wsproto.events import (
    AcceptConnection,
    CloseConnection,
    Message,
    Ping,
    RejectConnection,
    Request,
    TextMessage,
)

from helpers import netbuilder
from helpers.processes import Talking
from pn2code.diagnostics import Diagnostics
from pn2code.play.loading import Loaded, load
from pn2code.play.session import MOST_BYTES, Session
from pn2code.play.typed_texts import Typist
from pn2code.semantics.game.report import places

PATIENCE_S = 600.0


def loaded(net: Path) -> Loaded:
    """A net that is free of errors."""
    d = Diagnostics()
    found = load(net, {}, d)
    assert found is not None and found.opened is not None, [e.message for e in d.errors]
    return found


def session(
    folder: Path, text: str | bytes, *, seed: int = 1, most_bytes: int = MOST_BYTES
) -> Session:
    """A game of a net in the short text form, or as a file."""
    net = folder / "net.cpn"
    if isinstance(text, bytes):
        net.write_bytes(text)
    else:
        netbuilder.write(text, net)
    return of(net, folder, seed=seed, most_bytes=most_bytes)


def of(net: Path, folder: Path, *, seed: int = 1, most_bytes: int = MOST_BYTES) -> Session:
    """A game of a net."""
    found = loaded(net)
    assert found.opened is not None and found.elaborator is not None
    typist = Typist(found.opened.flat, found.elaborator)
    own = folder / "session"
    own.mkdir(exist_ok=True)
    game = Session(found, typist, seed=seed, folder=own, most_bytes=most_bytes)
    _OPEN.append(game)
    return game


_OPEN: list[Session] = []
"""Games that hold files."""


def close_games() -> None:
    """After each test."""
    while _OPEN:
        _OPEN.pop().close()


def marking(game: Session) -> dict[str, str]:
    """What each place holds, by its path."""
    rows = {
        (row["id"], row["instance"]): str(row["marking"])
        for row in places(game.net, game.game.marking)
    }
    return {p.name: rows[p.id, p.instance_number] for p in game.net.places}


class Served:
    """A server at work: `pn2code play` as a process of its own.

    Attributes:
        url: of its page.
        said: what it has printed before.
    """

    def __init__(self, process: Talking, url: str) -> None:
        self.process = process
        self.url = url
        found = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/([\w-]+)/", url)
        assert found is not None, url
        self.port = int(found[1])
        self.token = found[2]

    def get(
        self, path: str, *, method: str = "GET", body: bytes | None = None, **headers: str
    ) -> tuple[int, dict[str, str], bytes]:
        """An answer: status, headers, body. `headers` with `_` for `-`; None of the usual ones is added but Host."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_S)
        try:
            connection.putrequest(method, path, skip_host="host" in headers)
            for name, value in headers.items():
                connection.putheader(name.replace("_", "-"), value)
            if body is not None:
                connection.putheader("content-length", str(len(body)))
            connection.endheaders(body)
            answer = connection.getresponse()
            return answer.status, {k.lower(): v for k, v in answer.getheaders()}, answer.read()
        finally:
            connection.close()

    def end(self) -> int:
        """Ctrl-C; the exit code."""
        if self.process.poll() is None:
            os.kill(self.process.pid, signal.SIGINT)
        self.process.communicate(timeout=PATIENCE_S)
        return self.process.wait()


@contextmanager
def served(*arguments: str | Path) -> Iterator[Served]:
    """A server, as long as the block lasts."""
    process = start(*arguments)
    try:
        line = process.stdout.readline()
        assert "http://" in line, line + process.stderr.read()
        yield Served(process, line.split()[-1])
    finally:
        process.signal(signal.SIGINT)
        process.communicate(PATIENCE_S)


def start(*arguments: str | Path) -> Talking:
    """The command, without a browser."""
    return Talking("play", "--no-browser", *arguments)


class Refused(Exception):
    """The server does not talk with us: the status of its answer."""


class Talk:
    """A page without a browser.

    Attributes:
        seat: its name.
        state: what was told last, places collected.
        heard: what was said without being asked for.
    """

    def __init__(
        self, server: Served, *, seat: str = "", token: str | None = None, **headers: str
    ) -> None:
        self.marking: dict[str, Any] = {}
        self.state: dict[str, Any] = {}
        self.heard: list[dict[str, Any]] = []
        self._number = 0
        self._texts: list[str] = []
        self._part = ""
        self.is_closed = False
        self._why = ""
        self._socket = socket.create_connection(("127.0.0.1", server.port), timeout=PATIENCE_S)
        self._connection = WSConnection(ConnectionType.CLIENT)
        host = headers.get("host", f"127.0.0.1:{server.port}")
        origin = headers.get("origin", f"http://127.0.0.1:{server.port}")
        extra = [(b"Origin", origin.encode())] if origin else []
        target = f"/{token or server.token}/ws?seat={seat}"
        try:
            self._send(Request(host=host, target=target, extra_headers=extra))
            first = self._read(time.monotonic() + PATIENCE_S)
        except BaseException:
            self._socket.close()
            raise
        self.first = first
        self.seat = str(first.get("seat", ""))
        if "state" in first:
            self._take(first["state"])

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self._socket.close()

    def _send(self, event: Any) -> None:
        self._socket.sendall(self._connection.send(event))

    def _read(self, until: float) -> dict[str, Any]:
        """The next message."""
        if time.monotonic() > until:
            raise TimeoutError(f"not heard in time; heard was {self.heard[-3:]}")
        while not self._texts:
            if self.is_closed:
                raise ConnectionError(self._why)
            data = self._socket.recv(1 << 16)
            self._connection.receive_data(data or None)
            for event in self._connection.events():
                match event:
                    case RejectConnection(status_code=status):
                        raise Refused(status)
                    case TextMessage(data=text, message_finished=done):
                        self._part += text
                        if done:
                            self._texts.append(self._part)
                            self._part = ""
                    case CloseConnection():
                        self.is_closed = (
                            True  # after what has been said before, maybe in the same breath
                        )
                        self._why = event.reason or str(event.code)
                    case Ping():
                        self._send(event.response())
                    case AcceptConnection() | Message():
                        pass
            if not data and not self._texts and not self.is_closed:
                raise ConnectionError("the server has gone")
        return dict(json.loads(self._texts.pop(0)))

    def _take(self, state: dict[str, Any]) -> None:
        told, known = state["enabled"], set(self.state.get("enabled", ()))
        if isinstance(told, dict):
            assert not known & set(told["more"]) and known >= set(told["less"]), "only what changes"
            told = sorted((known | set(told["more"])) - set(told["less"]))
        self.state = {**state, "enabled": told}
        self.marking.update(state["places"])

    def text(self, text: str) -> None:
        """Says something that need not be right."""
        self._send(Message(data=text))

    def start(self, what: str, **more: Any) -> int:
        """Asks; the number of the answer."""
        self._number += 1
        self.text(json.dumps({"do": what, "id": self._number, **more}))
        return self._number

    def ask(self, what: str, **more: Any) -> dict[str, Any]:
        """Asks, and waits for the answer."""
        return self.answer(self.start(what, **more))

    def answer(self, number: int) -> dict[str, Any]:
        """Waits for an answer."""
        until = time.monotonic() + PATIENCE_S
        while True:
            said = self._read(until)
            if "state" in said:
                self._take(said["state"])
            if said.get("id") == number:
                return said
            self.heard.append(said)

    def hear(self, name: str) -> dict[str, Any]:
        """Waits for something that is said without being asked for."""
        until = time.monotonic() + PATIENCE_S
        while True:
            found = next((said for said in self.heard if name in said), None)
            if found is not None:
                self.heard.remove(found)
                return found
            self.heard.append(self._read(until))


def first_page(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """The command, ended when its first page has been told the marking, which is the last line of the output."""
    process = start(*arguments)
    line = process.stdout.readline()
    told = ""
    if "http://" in line:
        with Talk(Served(process, line.split()[-1])) as talk:
            told = json.dumps(talk.marking) + "\n"
        process.signal(signal.SIGINT)
    output, errors = process.communicate(timeout=PATIENCE_S)
    return subprocess.CompletedProcess(arguments, process.wait(), line + output + told, errors)
