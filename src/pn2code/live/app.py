"""The application of the live view: the page, and a WebSocket for each page.

    app = application(show, hall, stopping, acting)

`/` is the page. `/ws?at=N` gives all updates after the first N as lists of JSON objects, as they come. Pages say
`{"do": "stop", "token": ...}`, which stops the cell if the token is the one that the terminal has printed, and, where a
person may interfere with the run, `{"do": "join", "token": ...}` and then `{"do": "act", "wish": {...}}`.
"""

from __future__ import annotations

import asyncio
import json
import secrets
import time
from collections.abc import Callable
from typing import Any

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import HTMLResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from pn2code.base.page_json import page_json
from pn2code.live.hall import Hall
from pn2code.replay.page import hashed
from pn2code.replay.served import Served

MOST_PAGES = 64
MOST_WISH = 2000
"""Characters: with what is around it, it goes through a pipe in one piece."""
_AGAIN = "setTimeout(() => location.reload(), 1000);"
"""What `<meta http-equiv="refresh">` does not do where the address has a token behind its `#`."""
PREPARING = (
    '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>pn2code</title></head>'
    "<body><p>The cell is being built. This page comes by itself.</p>"
    f"<script>{_AGAIN}</script></body></html>"
)
PATIENCE_S = 2.0
"""A page that is asked for before it is there waits so long."""
_LOOK_S = 0.1
BEAT_S = 2.0
"""After a silence of so long a page is told that the server is there (`QUIET_MS` in livelink.js)."""
_CLOSED = (
    f"default-src 'none'; script-src {hashed(_AGAIN)}; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'"
)
_WRONG_S = 0.5
"""After a wrong token."""


class Stopping:
    """Who may stop the cell: whoever has the token.

    Args:
        token: what the terminal has printed; "": nobody may.
        stop: does it.
    """

    def __init__(self, token: str, stop: Callable[[], None]) -> None:
        self._token = token
        self._stop = stop
        self.is_wanted = False

    def ask(self, token: object) -> bool:
        """Stops the cell; False: the token is another one."""
        if not _is_same(token, self._token):
            return False
        if not self.is_wanted:
            self.is_wanted = True
            self._stop()
        return True


class Acting:
    """Who may interfere with the run: whoever has the token.

    Args:
        token: what the terminal has printed; "": nobody may.
        say: hands an object to the run: `{"present": 2}` or `{"wish": {...}}`.
    """

    def __init__(self, token: str, say: Callable[[dict[str, Any]], None]) -> None:
        self._token, self._say = token, say
        self.present = 0

    def join(self, token: object) -> bool:
        """One more is there; False: the token is another one."""
        if not _is_same(token, self._token):
            return False
        self._count(1)
        return True

    def leave(self) -> None:
        """One fewer."""
        self._count(-1)

    def _count(self, by: int) -> None:
        self.present += by
        self._say({"present": self.present})

    def act(self, wish: object) -> bool:
        """Passes a wish on; False: it is none."""
        if not isinstance(wish, dict) or len(json.dumps(wish)) > MOST_WISH:
            return False
        self._say({"wish": wish})
        return True


def _is_same(given: object, token: str) -> bool:
    if not token or not isinstance(given, str):
        return False
    return secrets.compare_digest(given.encode("utf-8", "replace"), token.encode())


def application(
    show: Callable[[], Served | None], hall: Hall, stopping: Stopping, acting: Acting | None = None
) -> Starlette:
    """The application.

    Args:
        show: the page; None while it is not known yet.
        hall: what is told.
        stopping: who may stop the cell.
        acting: who may interfere with it; None: nobody.
    """
    desk = _Desk(hall, stopping, acting or Acting("", lambda said: None))

    async def index(request: Request) -> Response:
        until = time.monotonic() + PATIENCE_S
        while (made := show()) is None and time.monotonic() < until:
            if hall.is_over or hall.is_leaving:
                break
            await asyncio.sleep(_LOOK_S)
        if made is None:
            return HTMLResponse(PREPARING, headers={"content-security-policy": _CLOSED})
        return HTMLResponse(made.html, headers={"content-security-policy": made.policy})

    return Starlette(routes=[Route("/", index), WebSocketRoute("/ws", desk.serve)])


class _Desk:
    """The pages that are open."""

    def __init__(self, hall: Hall, stopping: Stopping, acting: Acting) -> None:
        self._hall, self._stopping, self._acting = hall, stopping, acting

    async def serve(self, socket: WebSocket) -> None:
        """One page, from its first word to its last."""
        await socket.accept()
        if self._hall.pages >= MOST_PAGES:
            await socket.send_text(page_json({"broken": "there are too many pages already"}))
            await socket.close()
            return
        self._hall.pages += 1
        telling = asyncio.create_task(self._tell(socket, _number(socket.query_params.get("at"))))
        hearing = asyncio.create_task(self._hear(socket))
        try:
            await asyncio.wait((telling, hearing), return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._hall.pages -= 1
            for task in (telling, hearing):
                task.cancel()
            await asyncio.gather(telling, hearing, return_exceptions=True)

    async def _tell(self, socket: WebSocket, at: int) -> None:
        while True:
            try:
                rows, at = await asyncio.wait_for(self._hall.after(at), BEAT_S)
            except TimeoutError:
                await socket.send_text('{"alive":true}')
                continue
            if not rows and self._hall.has_failed and not self._hall.is_over:
                await socket.send_text(page_json({"failed": True}))
                await self._hall.ended()
            if not rows:
                await socket.send_text(page_json({"over": True}))
                await socket.close()
                return
            await socket.send_text(
                f'{{"at":{at},"pages":{self._hall.pages},"updates":[{",".join(rows)}]}}'
            )

    async def _hear(self, socket: WebSocket) -> None:
        has_joined = False
        try:
            while True:
                try:
                    text = await socket.receive_text()
                except (WebSocketDisconnect, KeyError, RuntimeError):  # KeyError: bytes
                    return
                said = _object(text)
                match said.get("do"):
                    case "stop" if self._stopping.ask(said.get("token")):
                        answer = {"stop": "stopping"}
                    case "join" if has_joined or self._acting.join(said.get("token")):
                        has_joined = True
                        answer = {"act": "joined"}
                    case "act" if has_joined and self._acting.act(said.get("wish")):
                        answer = {"act": "passed on"}
                    case "act":
                        answer = {"act": "not understood" if has_joined else "not joined"}
                    case "stop" | "join" as what:
                        await asyncio.sleep(_WRONG_S)
                        answer = {"stop" if what == "stop" else "act": "wrong token"}
                    case _:
                        answer = {"stop": "what is not understood is not done"}
                await socket.send_text(page_json(answer))
        finally:
            if has_joined:
                self._acting.leave()


def _object(text: str) -> dict[str, Any]:
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        return {}
    return data if isinstance(data, dict) else {}


def _number(text: str | None) -> int:
    return (
        int(text)
        if text is not None and text.isascii() and text.isdigit() and len(text) < 12
        else 0
    )
