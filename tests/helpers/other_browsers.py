"""Firefox and WebKit for tests, by their own protocols; without them tests skip, and say why.

    with firefox() as browser:
        browser.open(file.as_uri())
        browser.ask("return document.title")

Playwright drives only browsers of its own builds of these two. Those of Debian (`firefox-esr`; `webkit2gtk-driver` and
`xvfb`) are driven here: Firefox by Marionette, over a socket, WebKit by WebDriver, over HTTP.
"""

from __future__ import annotations

import base64
import contextlib
import json
import os
import re
import shutil
import socket
import subprocess
import tempfile
import time
import urllib.error
import urllib.request
from abc import ABC, abstractmethod
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

PATIENCE_S = 60.0
SIZE = (1280, 720)
_MINI_BROWSERS = "/usr/lib/*/webkit2gtk-4.*/MiniBrowser"
_WINDOW = "return [outerWidth - innerWidth, outerHeight - innerHeight]"
_SCRIPT = "const f = %s; return f(...arguments);"
_FIREFOX_ERRORS = """
return Services.console.getMessageArray()
  .filter((m) => m instanceof Ci.nsIScriptError && !(m.flags & Ci.nsIScriptError.warningFlag)
                 && /^(file:|http:..127[.])/.test(m.sourceName || ""))
  .map((m) => m.errorMessage);
"""
_FIREFOX_CONSOLE = """
return Cc["@mozilla.org/consoleAPI-storage;1"].getService(Ci.nsIConsoleAPIStorage).getEvents()
  .filter((e) => e.level === "error" && /^(file:|http:..127[.])/.test(e.filename || ""))
  .map((e) => String(e.arguments[0]));
"""
_PREFERENCES = {
    "marionette.port": 0,
    "browser.shell.checkDefaultBrowser": False,
    "browser.aboutwelcome.enabled": False,
    "datareporting.policy.dataSubmissionEnabled": False,
    "app.normandy.enabled": False,
    "network.captive-portal-service.enabled": False,
    "network.connectivity-service.enabled": False,
    "services.settings.server": "data:,",
    "toolkit.telemetry.enabled": False,
}


class Other(ABC):
    """A browser with one page."""

    name: str

    @abstractmethod
    def command(self, name: str, path: str, body: dict[str, Any] | None = None) -> Any:
        """Sends a command of WebDriver: its name, and its path and body over HTTP."""

    @abstractmethod
    def errors(self) -> list[str]:
        """What pages have complained of."""

    def open(self, address: str) -> None:
        """Goes to an address, until it is loaded."""
        self.command("Navigate", "url", {"url": address})

    def ask(self, script: str, *values: Any) -> Any:
        """The value of a function in JavaScript."""
        body = {"script": _SCRIPT % script, "args": list(values)}
        return self.command("ExecuteScript", "execute/sync", body)

    def wait(self, condition: str) -> None:
        """Until a condition holds; an error if it does not."""
        end = time.monotonic() + PATIENCE_S
        while not self.ask(f"() => Boolean({condition})"):
            if time.monotonic() > end:
                raise AssertionError(
                    f"{self.name}: not in {PATIENCE_S:g} s: {condition}; {self.errors()}"
                )
            time.sleep(0.1)

    def size(self, width: int, height: int) -> None:
        """How large the page is (a window has a least width: Firefox 450, so it may be larger)."""
        for _ in range(2):
            dx, dy = self.ask("() => [outerWidth - innerWidth, outerHeight - innerHeight]")
            body = {"x": 0, "y": 0, "width": width + dx, "height": height + dy}
            self.command("SetWindowRect", "window/rect", body)

    def pointer(self, *steps: dict[str, Any]) -> None:
        """Moves, presses and releases the mouse, as WebDriver writes it."""
        hand = {"type": "pointer", "id": "hand", "parameters": {"pointerType": "mouse"}}
        self.command("PerformActions", "actions", {"actions": [{**hand, "actions": list(steps)}]})

    def click(self, x: float, y: float) -> None:
        """Clicks at a point of the page."""
        down, up = ({"type": kind, "button": 0} for kind in ("pointerDown", "pointerUp"))
        self.pointer(_to(x, y), down, up)

    def drag(self, x: float, y: float, to_x: float, to_y: float) -> None:
        """Drags from a point to another."""
        down, up = ({"type": kind, "button": 0} for kind in ("pointerDown", "pointerUp"))
        half = _to((x + to_x) / 2, (y + to_y) / 2)
        self.pointer(_to(x, y), down, half, _to(to_x, to_y), up)

    def press(self, *keys: str) -> None:
        """Presses keys, one after the other."""
        steps = [{"type": kind, "value": key} for key in keys for kind in ("keyDown", "keyUp")]
        keyboard = {"type": "key", "id": "keyboard", "actions": steps}
        self.command("PerformActions", "actions", {"actions": [keyboard]})

    def picture(self) -> bytes:
        """The page as PNG."""
        body = {"full": False}
        return base64.b64decode(self.command("TakeScreenshot", "screenshot", body))


def _to(x: float, y: float) -> dict[str, Any]:
    return {"type": "pointerMove", "duration": 0, "x": round(x), "y": round(y)}


class _Firefox(Other):
    name = "Firefox"

    def __init__(self, port: int) -> None:
        self._socket = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S)
        self._file = self._socket.makefile("rb")
        self._number = 0
        self._message()
        made = self._send("WebDriver:NewSession", {})
        self.version = made["capabilities"]["browserVersion"]

    def end(self) -> None:
        """No more commands."""
        self._file.close()
        self._socket.close()

    def _message(self) -> Any:
        digits = b""
        while (byte := self._file.read(1)) != b":":
            if not byte:
                raise AssertionError("Firefox has ended")
            digits += byte
        return json.loads(self._file.read(int(digits)))

    def _send(self, name: str, body: dict[str, Any]) -> Any:
        self._number += 1
        text = json.dumps([0, self._number, name, body]).encode()
        self._socket.sendall(b"%d:%s" % (len(text), text))
        _, _, error, result = self._message()
        if error:
            raise AssertionError(f"Firefox, {name}: {error['error']}: {error['message']}")
        return result

    def command(self, name: str, path: str, body: dict[str, Any] | None = None) -> Any:
        result = self._send(f"WebDriver:{name}", {"sandbox": None, **(body or {})})
        return result.get("value") if isinstance(result, dict) and "value" in result else result

    def errors(self) -> list[str]:
        self._send("Marionette:SetContext", {"value": "chrome"})
        try:
            scripts = (_FIREFOX_ERRORS, _FIREFOX_CONSOLE)
            return [
                e
                for s in scripts
                for e in self.command("ExecuteScript", "", {"script": s, "args": []})
            ]
        finally:
            self._send("Marionette:SetContext", {"value": "content"})


class _WebKit(Other):
    name = "WebKit"

    def __init__(self, port: int, binary: str, log: Path) -> None:
        self._address = f"http://127.0.0.1:{port}/session"
        self._log = log
        options = {
            "binary": binary,
            "args": ["--automation", "--enable-write-console-messages-to-stdout=true"],
        }
        asked = {"alwaysMatch": {"webkitgtk:browserOptions": options}}
        made = self._send("POST", "", {"capabilities": asked})
        self._address += f"/{made['sessionId']}"
        self.version = made["capabilities"]["browserVersion"]

    def _send(self, method: str, path: str, body: dict[str, Any] | None) -> Any:
        data = None if method != "POST" else json.dumps(body or {}).encode()
        request = urllib.request.Request(
            self._address + path, data, {"Content-Type": "application/json"}, method=method
        )
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise AssertionError(f"WebKit, {path}: {error.read().decode()}") from error

    def command(self, name: str, path: str, body: dict[str, Any] | None = None) -> Any:
        return self._send("GET" if path == "screenshot" else "POST", f"/{path}", body)

    def end(self) -> None:
        """Ends the session, and with it the browser."""
        with contextlib.suppress(AssertionError, OSError):
            self._send("DELETE", "", None)

    def errors(self) -> list[str]:
        text = self._log.read_text(encoding="utf-8", errors="replace")
        return re.findall(r"^CONSOLE (?:\w+ )?ERROR.*$", text, re.MULTILINE)


@contextlib.contextmanager
def firefox(*, with_webgl: bool = True, is_dark: bool = False) -> Iterator[Other]:
    """Firefox, in a window on a screen that nobody sees: without a screen it has no WebGL.

    Args:
        with_webgl: whether it may draw in 3D, if it can.
        is_dark: whether the system wants dark colours.
    """
    program = next((p for n in ("firefox-esr", "firefox") if (p := shutil.which(n))), None)
    lacks = [] if program else ["Firefox"]
    if shutil.which("Xvfb") is None:
        lacks.append("Xvfb")
    if program is None or lacks:
        pytest.skip(f"there is no {', no '.join(lacks)}")
    with contextlib.ExitStack() as stack:
        name = tempfile.TemporaryDirectory(prefix="pn2code-firefox-", ignore_cleanup_errors=True)
        folder = Path(stack.enter_context(name))
        own = {
            **_PREFERENCES,
            "webgl.disabled": not with_webgl,
            "webgl.force-enabled": with_webgl,
            "layout.css.prefers-color-scheme.content-override": 0 if is_dark else 1,
        }
        rows = [f"user_pref({json.dumps(k)}, {json.dumps(v)});\n" for k, v in own.items()]
        (folder / "user.js").write_text("".join(rows), encoding="utf-8")
        command = [
            program,
            "--marionette",
            "--remote-allow-system-access",
            "--no-remote",
            "--profile",
            str(folder),
        ]
        environment = {
            **os.environ,
            "HOME": str(folder),
            "DISPLAY": _screen(stack),
            "GDK_BACKEND": "x11",
        }
        environment.pop("WAYLAND_DISPLAY", None)
        quiet = subprocess.DEVNULL
        process = subprocess.Popen(command, env=environment, stdout=quiet, stderr=quiet)
        stack.callback(_end, process)
        browser = _Firefox(int(_appears(folder / "MarionetteActivePort", process)))
        stack.callback(browser.end)
        browser.size(*SIZE)
        yield browser


@contextlib.contextmanager
def webkit() -> Iterator[Other]:
    """WebKit (its small browser), in a window on a screen that nobody sees."""
    binary = next((str(p) for p in sorted(Path("/").glob(_MINI_BROWSERS[1:]))), None)
    lacks = [n for n in ("WebKitWebDriver", "Xvfb") if shutil.which(n) is None]
    if binary is None or lacks:
        pytest.skip(f"there is no {', no '.join(lacks or ['MiniBrowser of WebKit'])}")
    with contextlib.ExitStack() as stack:
        name = tempfile.TemporaryDirectory(prefix="pn2code-webkit-", ignore_cleanup_errors=True)
        folder = Path(stack.enter_context(name))
        screen = _screen(stack)
        environment = {**os.environ, "HOME": str(folder), "DISPLAY": screen, "GDK_BACKEND": "x11"}
        environment.pop("WAYLAND_DISPLAY", None)
        port = _free_port()
        log = stack.enter_context((folder / "log").open("wb"))
        process = subprocess.Popen(
            ["WebKitWebDriver", f"--port={port}"], env=environment, stdout=log, stderr=log
        )
        stack.callback(_end, process)
        _listens(port, process)
        browser = _WebKit(port, binary, folder / "log")
        stack.callback(browser.end)
        browser.size(*SIZE)
        yield browser


def _screen(stack: contextlib.ExitStack) -> str:
    """A screen of X, that X numbers itself."""
    reads, writes = os.pipe()
    command = [
        "Xvfb",
        "-displayfd",
        str(writes),
        "-screen",
        "0",
        "1600x1200x24",
        "-nolisten",
        "tcp",
    ]
    quiet = subprocess.DEVNULL
    process = subprocess.Popen(command, pass_fds=[writes], stdout=quiet, stderr=quiet)
    stack.callback(_end, process)
    os.close(writes)
    with os.fdopen(reads) as file:
        number = file.readline().strip()
    assert number, "Xvfb has not begun"
    return f":{number}"


def _free_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


def _appears(file: Path, process: subprocess.Popen[bytes]) -> str:
    """What a file holds, as soon as it holds something."""
    end = time.monotonic() + PATIENCE_S
    while not (file.exists() and (text := file.read_text().strip())):
        assert process.poll() is None and time.monotonic() < end, f"no {file.name}"
        time.sleep(0.05)
    return text


def _listens(port: int, process: subprocess.Popen[bytes]) -> None:
    end = time.monotonic() + PATIENCE_S
    while True:
        assert process.poll() is None and time.monotonic() < end, "WebKitWebDriver has not begun"
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), timeout=1):
            return
        time.sleep(0.05)


def _end(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(20)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
