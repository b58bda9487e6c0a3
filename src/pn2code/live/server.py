"""The server of the live view, as a process of its own: `python -m pn2code.live.server SOCKET`.

SOCKET is the number of a socket that listens already. Standard input brings things that the run hands over
(`handing`): first `Start`, then `Cell`, then pictures. On standard output it writes lines: `stop` if somebody may and
wants to stop the cell, and what those say who interfere with it (`hearing`). It ends when its standard input does,
after the pages have got the last update.
"""

from __future__ import annotations

import json
import os
import signal
import socket
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.live.app import Acting, Stopping, application
from pn2code.live.hall import Hall
from pn2code.live.handing import taken
from pn2code.live.news import News
from pn2code.live.page import page
from pn2code.replay.served import Served
from pn2code.web.guard import HOSTS, Guard
from pn2code.web.serving import serve

_NICE = 10
"""Supervisor and robots go first."""
LAST_S = 5.0
"""How long pages may take for the last update."""
LEAST_S = 0.2
"""A page that has just lost its connection may come back."""


@frozen
class Start:
    """What the server needs to listen: its port, the token of its address, that of the Stop button, and that of those
    who may interfere with the run ("": nobody may)."""

    port: int
    token: str
    stop_token: str
    act_token: str = ""


@frozen
class Cell:
    """What runs.

    Args:
        partition, config: the cell.
        near: clearances below this are warned of (m).
        described: see `described`.
    """

    partition: Partition
    config: CellConfig
    near: float
    described: dict[str, Any]


class Server:
    """The application, and the thread that feeds it."""

    def __init__(
        self,
        start: Start,
        things: Iterator[Any],
        stop: Callable[[], None],
        rest: Callable[[], object],
        say: Callable[[dict[str, Any]], None] = lambda said: None,
    ) -> None:
        self._things = things
        self._rest = rest
        self._hosts = tuple(f"{host}:{start.port}" for host in HOSTS)
        self._page: Served | None = None
        self.hall = Hall()
        acting = Acting(start.act_token, say)
        stopping = Stopping(start.stop_token, stop)
        inner = application(lambda: self._page, self.hall, stopping, acting)
        self.app = Guard(inner, start.token, start.port)

    def begin(self, end: Callable[[], None]) -> None:
        """The server listens: from now on it is fed."""
        self.hall.attach()
        threading.Thread(target=self._feed, args=(end,), daemon=True).start()

    def _feed(self, end: Callable[[], None]) -> None:
        try:
            cell = next(self._things, None)
            if isinstance(cell, Cell):
                self._page = page(cell.described, self._hosts)
                news = News(cell.partition, cell.config, cell.near)
                for update in news.updates(self._things):
                    if self.hall.tell(update):
                        news.begin_again()
        except Exception:
            # The run goes on, and so does the way to stop it, until the run has ended.
            traceback.print_exc()
            self.hall.fail()
            self._rest()
        finally:
            self.hall.end()
            until = time.monotonic() + LAST_S
            time.sleep(LEAST_S)
            while self.hall.pages and time.monotonic() < until:
                time.sleep(0.02)
            end()


def main(arguments: list[str]) -> None:
    """Serves until standard input ends. Ctrl-C is the run's business."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.nice(_NICE)
    stream = sys.stdin.buffer
    start = taken(stream)
    if not isinstance(start, Start):
        return

    def things() -> Iterator[Any]:
        while (thing := taken(stream)) is not None:
            yield thing

    def stop() -> None:
        os.write(1, b"stop\n")

    def say(said: dict[str, Any]) -> None:
        with suppress(OSError):  # the run has ended
            os.write(1, json.dumps(said).encode() + b"\n")

    def rest() -> None:
        while stream.read(1 << 16):
            pass

    server = Server(start, things(), stop, rest, say)
    with socket.socket(fileno=int(arguments[0])) as listening:
        serve(server.app, listening, begun=lambda: None, fed=server.begin, ended=server.hall.leave)
    # After SIGTERM the thread that feeds it still waits for input, which the end of an interpreter takes for a fault.
    os._exit(0)


if __name__ == "__main__":
    from pn2code.live import server as module  # what is handed over names its classes so

    module.main(sys.argv[1:])
