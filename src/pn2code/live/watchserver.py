"""The server of `pn2code watch`: the live page of a cell that runs elsewhere, in this process.

    serve_watch(socket, port, token, cell, described, where)

It may be asked for the page and its updates, and for nothing else: there is no way from a page to the cell.
"""

from __future__ import annotations

import socket
import threading
import time
import traceback
from collections.abc import Callable
from typing import Any

from pn2code.live.app import Stopping, application
from pn2code.live.hall import Hall
from pn2code.live.page import page
from pn2code.live.watched import WatchedCell
from pn2code.live.watching import Watching, Where
from pn2code.replay.served import Served
from pn2code.web.guard import HOSTS, Guard
from pn2code.web.serving import serve

_LAST_S = 1.0


def serve_watch(
    on: socket.socket,
    port: int,
    token: str,
    cell: WatchedCell,
    described: dict[str, Any],
    where: Callable[[], Where],
    *,
    is_over: Callable[[], bool],
    begun: Callable[[], None],
) -> bool:
    """Serves until `is_over`; whether all went well.

    Args:
        on: a socket that listens.
        port, token: of the address.
        cell: what is watched.
        described: see `described`.
        where: see `Watching`.
        is_over: whether to end.
        begun: is called when pages can be opened.
    """
    hosts = tuple(f"{host}:{port}" for host in HOSTS)
    made: Served = page(described, hosts)
    hall = Hall()
    inner = application(lambda: made, hall, Stopping("", lambda: None))
    failed: list[BaseException] = []

    def feed(end: Callable[[], None]) -> None:
        watching = Watching(cell, where, is_over)
        try:
            for update in watching.updates():
                if hall.tell(update):
                    watching.begin_again()
        except Exception as problem:
            failed.append(problem)
            traceback.print_exc()
            hall.fail()
            while not is_over():
                time.sleep(0.1)
        finally:
            hall.end()
            until = time.monotonic() + _LAST_S
            while hall.pages and time.monotonic() < until:
                time.sleep(0.02)
            end()

    def fed(end: Callable[[], None]) -> None:
        hall.attach()
        threading.Thread(target=feed, args=(end,), daemon=True).start()
        begun()

    serve(Guard(inner, token, port), on, begun=lambda: None, fed=fed, ended=hall.leave)
    return not failed
