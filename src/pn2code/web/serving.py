"""The server itself: a port of the loopback interface, until somebody presses Ctrl-C.

with listening(0) as (socket, port):
    serve(app, socket, begun=lambda: print(url(port, token)))
"""

from __future__ import annotations

import asyncio
import errno
import os
import signal
import socket
import sys
import threading
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from pn2code.base.os_reason import os_reason

HOST = "127.0.0.1"
MOST_MESSAGE = 1 << 20
"""Bytes of a message of a page."""
_GRACE_S = 2


class PortTaken(Exception):
    """The port cannot be had; the message says why (a user's matter)."""


@contextmanager
def listening(port: int) -> Iterator[tuple[socket.socket, int]]:
    """A socket that listens on the loopback interface, and its port; 0 takes any that is free.

    Raises:
        PortTaken: the port cannot be had.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as found:
        found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            found.bind((HOST, port))
            found.listen(128)
        except OSError as problem:
            why = (
                "another program uses it"
                if problem.errno == errno.EADDRINUSE
                else os_reason(problem)
            )
            raise PortTaken(f"cannot listen on port {port}: {why}") from None
        yield found, found.getsockname()[1]


def url(port: int, token: str) -> str:
    """The address of the page."""
    return f"http://{HOST}:{port}/{token}/"


def serve(
    app: Any,
    on: socket.socket,
    *,
    begun: Callable[[], None],
    fed: Callable[[Callable[[], None]], None] | None = None,
    ended: Callable[[], None] = lambda: None,
) -> None:
    """Answers until SIGINT or SIGTERM comes; a second one does not wait for what is going on.

    Args:
        app: an ASGI application.
        on: from `listening`.
        begun: is called when pages can be opened.
        fed: for a server that ends when somebody says so, and not by SIGINT: is called with what ends it (from any
            thread) when pages can be opened.
        ended: is called when it begins to end: whoever keeps requests waiting lets them go then.
    """
    import uvicorn

    config = uvicorn.Config(
        app,
        ws="wsproto",
        http="h11",
        loop="asyncio",
        lifespan="off",
        log_config=None,
        access_log=False,
        server_header=False,
        ws_max_size=MOST_MESSAGE,
        timeout_graceful_shutdown=_GRACE_S,
    )
    server = _Server(config)
    server.begun = begun
    server.fed = fed
    server.ended = ended
    asyncio.run(server.play(on))


def _server_class() -> Any:
    import uvicorn

    class Server(uvicorn.Server):
        """Leaves signals to us: Ctrl-C is how it ends."""

        begun: Callable[[], None]
        fed: Callable[[Callable[[], None]], None] | None
        ended: Callable[[], None]

        @contextmanager
        def capture_signals(self) -> Iterator[None]:
            yield

        async def play(self, on: socket.socket) -> None:
            loop = asyncio.get_running_loop()
            self._loop = loop
            for number in (signal.SIGTERM,) if self.fed else (signal.SIGINT, signal.SIGTERM):
                loop.add_signal_handler(number, self._end)
            await self.serve(sockets=[on])

        def _end(self) -> None:
            self.force_exit = self.should_exit
            self.should_exit = True
            self.ended()

        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets)
            self.begun()
            if self.fed is not None:
                self.fed(self._end_from_elsewhere)

        def _end_from_elsewhere(self) -> None:
            self._loop.call_soon_threadsafe(self._end)

    return Server


def _Server(config: Any) -> Any:  # noqa: N802 - uvicorn is loaded when it is needed
    return _server_class()(config)


def open_browser(address: str) -> None:
    """Shows the page, where there is a screen; a browser in the terminal is not what is wanted."""
    has_screen = sys.platform in ("darwin", "win32") or any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY")
    )
    if has_screen:
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
