"""The application that the server runs: the page, a WebSocket for each page, and traces to be loaded and saved.

app = application(loaded, seats, port)

`/` is the page, `/ws?seat=NAME` its WebSocket, `/trace/NAME` the run of a seat: GET saves it, POST loads one.
"""

from __future__ import annotations

import asyncio
import json
import re
import threading
from collections.abc import AsyncIterator, Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.background import BackgroundTask
from starlette.requests import Request
from starlette.responses import (
    FileResponse,
    HTMLResponse,
    JSONResponse,
    PlainTextResponse,
    Response,
)
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from pn2code.base.page_json import page_json
from pn2code.play import saving
from pn2code.play.described import describe
from pn2code.play.letters import Letters
from pn2code.play.loading import Loaded
from pn2code.play.page import page
from pn2code.play.seats import MOST_WAITING, Full, Seat, Seats
from pn2code.play.trouble import Json, Trouble, of_game
from pn2code.play.with_arms import WithArms
from pn2code.semantics.game.errors import GameError
from pn2code.trace.json_text import is_deep
from pn2code.web.guard import HOSTS

MOST_TRACE = 200 << 20
"""Bytes of a trace that is loaded."""
MOST_QUESTIONS = 2
"""Properties that are explored at the same time, of all pages together."""


def application(
    loaded: Loaded, seats: Seats | None, port: int, arms: WithArms | None = None
) -> Starlette:
    """The application.

    Args:
        loaded: the net.
        seats: its games; None: it has errors, and is only shown.
        port: of the server.
        arms: runs the cell; None: it is none that can be run.
    """
    described = {**describe(loaded), "arms": arms is not None}
    made = page(described, tuple(f"{host}:{port}" for host in HOSTS))

    async def show(request: Request) -> Response:
        return HTMLResponse(made.html, headers={"content-security-policy": made.policy})

    routes: list[Any] = [Route("/", show)]
    if seats is not None:
        hall = _Hall(seats, arms)
        routes += [
            WebSocketRoute("/ws", hall.play),
            Route("/trace/{seat}", hall.save, methods=["GET"]),
            Route("/trace/{seat}", hall.load, methods=["POST"]),
        ]
    return Starlette(routes=routes)


class _Hall:
    """Brings pages and seats together."""

    def __init__(self, seats: Seats, arms: WithArms | None) -> None:
        self._seats = seats
        self._arms = arms
        self._askers = ThreadPoolExecutor(MOST_QUESTIONS, thread_name_prefix="ask")

    # --- a page ----------------------------------------------------------------------------------

    async def play(self, socket: WebSocket) -> None:
        """One page, from its first word to its last."""
        await socket.accept()
        loop = asyncio.get_running_loop()
        try:
            take = partial(self._seats.take, socket.query_params.get("seat", ""))
            seat, is_new = await loop.run_in_executor(None, take)
        except Full:
            await _part(socket, {"broken": "there are too many pages already: close one of them"})
            return
        except GameError as error:
            trouble = of_game(error)
            await _part(socket, {"broken": trouble.message, "rows": trouble.rows})
            return
        except (Trouble, OSError) as problem:
            await _part(socket, {"broken": str(problem)})
            return
        try:
            await self._at(socket, seat, is_new)
        finally:
            self._seats.leave(seat)

    async def _at(self, socket: WebSocket, seat: Seat, is_new: bool) -> None:
        loop = asyncio.get_running_loop()
        letters = Letters(loop)
        seat.tell = tell = letters.put
        state = await loop.run_in_executor(seat.worker, seat.player.again)
        await socket.send_text(page_json({"seat": seat.name, "new": is_new, "state": state}))
        sending = asyncio.create_task(_send_all(socket, letters))
        over = asyncio.create_task(letters.over.wait())
        try:
            while True:
                hearing = asyncio.create_task(socket.receive_text())
                await asyncio.wait({hearing, over}, return_when=asyncio.FIRST_COMPLETED)
                if over.done():  # it asks, and does not read the answers
                    hearing.cancel()
                    await socket.close(1008)
                    break
                self._hear(hearing.result(), seat, tell)
        except (WebSocketDisconnect, KeyError):  # KeyError: a message of bytes
            pass
        finally:
            sending.cancel()
            over.cancel()

    def _hear(self, text: str, seat: Seat, tell: Callable[[Json], None]) -> None:
        """One message: long work is done elsewhere, so that the next one is heard."""
        try:
            said = None if is_deep(text) else json.loads(text)
        except (ValueError, RecursionError):
            said = None
        if not isinstance(said, dict):
            tell({"ok": False, "message": "a message is a JSON object", "rows": []})
            return
        number = said.get("id")
        match said.get("do"):
            case "stop":
                seat.session.stop.set()
            case "stop asking":
                if seat.asking is not None:
                    seat.asking.set()
            case "ask":
                tell({"id": number, **self._ask(seat, said, tell)})
            case "arms" if self._arms is not None:
                self._do(seat, number, partial(_run_with_arms, self._arms, seat), tell)
            case "open":
                trace = seat.answers.get(said["number"]) if _is_number(said.get("number")) else None
                if trace is None:
                    tell({"id": number, "ok": False, "message": "there is no such run", "rows": []})
                else:
                    self._do(seat, number, partial(seat.player.load, trace), tell)
            case _:
                self._do(seat, number, partial(seat.player.answer, said), tell)

    def _do(
        self, seat: Seat, number: Any, work: Callable[[], Json], tell: Callable[[Json], None]
    ) -> None:
        if seat.waiting >= MOST_WAITING:
            tell(
                {"id": number, "ok": False, "message": "too many commands are waiting", "rows": []}
            )
            return
        seat.waiting += 1

        def done() -> None:
            try:
                tell({"id": number, **work()})
            except Exception as bug:  # the page must not wait for ever
                tell({"id": number, "ok": False, "message": f"internal error: {bug!r}", "rows": []})
                raise
            finally:
                seat.waiting -= 1

        seat.worker.submit(done)

    def _ask(self, seat: Seat, said: Json, tell: Callable[[Json], None]) -> Json:
        if seat.asking is not None:
            return {"ok": False, "message": "one question at a time", "rows": []}
        seat.asking = threading.Event()
        number = seat.next_question()

        def work() -> None:
            seat.tell(seat.ask(self._seats.loaded, self._seats.typist, said, number))

        self._askers.submit(work)
        return {"ok": True, "result": {"number": number}}

    # --- traces ----------------------------------------------------------------------------------

    async def save(self, request: Request) -> Response:
        """The run of a seat as a trace."""
        seat = self._seats.find(request.path_params["seat"])
        if seat is None:
            return PlainTextResponse("there is no such game\n", 404)
        loop = asyncio.get_running_loop()
        file = seat.folder / "saved.trace.jsonl"
        try:
            await loop.run_in_executor(seat.worker, saving.save, seat.session, file)
        except Trouble as trouble:
            return PlainTextResponse(f"{trouble.message}\n", 409)
        except OSError as problem:
            return PlainTextResponse(f"the trace cannot be written: {problem}\n", 500)
        stem = re.sub(r"[^A-Za-z0-9_.-]+", "_", seat.session.net.name) or "net"
        return FileResponse(file, media_type="application/x-ndjson", filename=f"{stem}.trace.jsonl")

    async def load(self, request: Request) -> Response:
        """Loads a trace into a seat."""
        seat = self._seats.find(request.path_params["seat"])
        if seat is None:
            return PlainTextResponse("there is no such game\n", 404)
        file = seat.folder / "loaded.trace.jsonl"
        if not await _receive(request.stream(), file):
            file.unlink(missing_ok=True)
            said = f"a trace may have {MOST_TRACE >> 20} MB; `--trace FILE` reads longer ones"
            return JSONResponse({"ok": False, "message": said, "rows": []}, 413)
        loop = asyncio.get_running_loop()

        def work() -> Json:
            # The page is told by its WebSocket, in order with what else it is told.
            done = seat.player.load(file)
            seat.tell({"state": done.pop("state"), "isWhole": True})
            return done

        done = await loop.run_in_executor(seat.worker, work)
        remove = BackgroundTask(file.unlink, missing_ok=True)
        return Response(page_json(done), media_type="application/json", background=remove)


def _run_with_arms(arms: WithArms, seat: Seat) -> Json:
    try:
        address = arms.address(lambda said: seat.tell(said))
        return {"ok": True, "result": {"address": address}}
    except Trouble as trouble:
        return {"ok": False, "message": trouble.message, "rows": trouble.rows}


async def _receive(stream: AsyncIterator[bytes], file: Path) -> bool:
    """Writes what comes into a file; False: it is too much."""
    size = 0
    with file.open("wb") as out:
        async for part in stream:
            size += len(part)
            if size > MOST_TRACE:
                return False
            out.write(part)
    return True


async def _send_all(socket: WebSocket, letters: Letters) -> None:
    while True:
        text = await letters.next()
        try:
            await socket.send_text(text)
        except (RuntimeError, WebSocketDisconnect):
            return


async def _part(socket: WebSocket, said: Json) -> None:
    await socket.send_text(page_json(said))
    await socket.close()


def _is_number(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)
