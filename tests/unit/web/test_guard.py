"""Who may ask a local server: pages of its own, and nobody else."""

from __future__ import annotations

import asyncio
from collections.abc import MutableMapping
from typing import Any

import pytest

from pn2code.web.guard import Guard, new_token

PORT, TOKEN = 8123, "t0ken"
OWN = {"host": f"127.0.0.1:{PORT}"}
PAGE = {**OWN, "origin": f"http://127.0.0.1:{PORT}"}


async def _inside(scope: Any, receive: Any, send: Any) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.accept"})
        return
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": scope["path"].encode()})


def asked(
    path: str, headers: dict[str, str], *, method: str = "GET", kind: str = "http"
) -> list[MutableMapping[str, Any]]:
    sent: list[MutableMapping[str, Any]] = []

    async def send(message: MutableMapping[str, Any]) -> None:
        sent.append(message)

    async def receive() -> MutableMapping[str, Any]:
        return {"type": "http.request"}

    pairs = [(k.split("#")[0].encode(), v.encode()) for k, v in headers.items()]
    scope = {"type": kind, "path": path, "method": method, "headers": pairs}
    asyncio.run(Guard(_inside, TOKEN, PORT)(scope, receive, send))
    return sent


def status(*how: Any, **more: Any) -> int:
    first = asked(*how, **more)[0]
    return int(first.get("status", 0))


def test_its_own_pages_are_answered() -> None:
    sent = asked(f"/{TOKEN}/trace/x", OWN)
    assert sent[0]["status"] == 200 and sent[1]["body"] == b"/trace/x"
    headers = dict(sent[0]["headers"])
    assert headers[b"x-content-type-options"] == b"nosniff"
    assert headers[b"x-frame-options"] == b"DENY" and headers[b"cache-control"] == b"no-store"
    assert status(f"/{TOKEN}/", {"host": f"localhost:{PORT}"}) == 200
    assert status(f"/{TOKEN}/trace/x", PAGE, method="POST") == 200
    assert asked(f"/{TOKEN}/ws", PAGE, kind="websocket")[0]["type"] == "websocket.accept"


@pytest.mark.parametrize(
    "path", ["/", "/other/", f"/{TOKEN}", f"/x/../{TOKEN}/", f"/{TOKEN}x/", f"/{TOKEN[:-1]}/", "//"]
)
def test_without_the_token_there_is_nothing(path: str) -> None:
    assert status(path, OWN) == 404
    assert asked(path, PAGE, kind="websocket")[0]["type"] == "websocket.close"


@pytest.mark.parametrize(
    "headers",
    [
        {},
        {"host": "evil.example"},
        {"host": f"evil.example:{PORT}"},
        {"host": "127.0.0.1"},
        {"host": f"127.0.0.1:{PORT + 1}"},
        {"host": f"127.0.0.1:{PORT}.evil.example"},
        {"host": f"127.0.0.1:{PORT}", "host#2": "evil.example"},
    ],
)
def test_another_name_is_refused(headers: dict[str, str]) -> None:
    assert status(f"/{TOKEN}/", headers) == 421
    answer = asked(f"/{TOKEN}/ws", {**headers, "origin": PAGE["origin"]}, kind="websocket")
    assert answer[0]["type"] == "websocket.close"


@pytest.mark.parametrize(
    "origin", ["", "null", "http://evil.example", f"https://127.0.0.1:{PORT}", "http://127.0.0.1"]
)
def test_pages_of_others_are_refused(origin: str) -> None:
    headers = {**OWN, "origin": origin}
    assert status(f"/{TOKEN}/", headers) == 403
    assert status(f"/{TOKEN}/trace/x", headers, method="POST") == 403
    assert asked(f"/{TOKEN}/ws", headers, kind="websocket")[0]["type"] == "websocket.close"


def test_what_changes_anything_needs_an_origin() -> None:
    assert status(f"/{TOKEN}/trace/x", OWN, method="POST") == 403
    assert asked(f"/{TOKEN}/ws", OWN, kind="websocket")[0]["type"] == "websocket.close"


def test_tokens_are_long_and_different() -> None:
    found = {new_token() for _ in range(50)}
    assert len(found) == 50 and all(len(t) >= 32 for t in found)
