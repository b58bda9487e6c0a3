"""Cells that run with a live page, for tests."""

from __future__ import annotations

import json
import math
import os
import shutil
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from helpers.played import PATIENCE_S, Served, Talk
from helpers.processes import Child, Talking
from pn2code.live import server, tap, view

HOSTILE = "<img src=x onerror=alert(1)>"


class Running(Served):
    """`pn2code run --realtime --live` as a process of its own.

    Attributes:
        out: where its results go.
        stop_token: what the terminal has printed.
    """

    def __init__(self, process: Talking, out: Path) -> None:
        said = [process.stdout.readline() for _ in range(3)]
        assert all(said), process.communicate()
        super().__init__(process, said[0].split()[-1])
        self.out = out
        self.stop_token = said[2].split()[-1]
        assert said[1].split()[-1] == f"{self.url}#stop={self.stop_token}"

    def wait(self) -> tuple[int, str]:
        """Until it ends: exit code, and all that it has printed since."""
        output, errors = self.process.communicate(PATIENCE_S)
        return self.process.wait(), output + errors


class ForkedServer(Child):
    """The server of a live page as a fork of the run: what the run uses of `subprocess.Popen`.

    It goes as fast as the run. Behind all that a busy machine does it would take minutes to begin.
    """

    def __init__(
        self, command: Sequence[str], *, stdin: int, stdout: int, pass_fds: tuple[int]
    ) -> None:
        (number,) = pass_fds
        assert command[1:] == ["-P", "-m", "pn2code.live.server", str(number)]
        assert stdin == stdout == subprocess.PIPE
        (said, say), (hear, heard) = os.pipe(), os.pipe()

        def body() -> int:
            os.dup2(said, 0)
            os.closerange(3, number)
            os.closerange(number + 1, 1 << 16)
            sys.stdin = open(0, encoding="utf-8")  # noqa: SIM115 - for as long as the process lives
            server._NICE = 0
            server.main([str(number)])
            return 0

        super().__init__(body, heard)
        os.close(said)
        os.close(heard)
        self.stdin = open(say, "wb")  # noqa: SIM115, PTH123 - closed by the run
        self.stdout = open(hear, "rb")  # noqa: SIM115, PTH123

    def wait(self, timeout: float = PATIENCE_S) -> int:
        """The exit code."""
        try:
            return super().wait(timeout)
        except TimeoutError as problem:
            raise subprocess.TimeoutExpired("server", timeout) from problem


LAST_S = 60.0


def _patiently() -> None:
    """In the process of a run: its server and its pages may be slow."""
    view._BUILDING_S = view._END_S = server.LAST_S = tap.LAST_S = LAST_S


def _forking() -> None:
    _patiently()
    own = SimpleNamespace(
        Popen=ForkedServer, PIPE=subprocess.PIPE, TimeoutExpired=subprocess.TimeoutExpired
    )
    view.subprocess = own  # type: ignore[assignment]


@contextmanager
def running(cell: Path, out: Path, *arguments: str, is_forking: bool = True) -> Iterator[Running]:
    """A cell that runs, with the fake backend.

    Args:
        is_forking: the server is a fork of the run; otherwise it is what users have.
    """
    process = Talking(
        "run", cell, "--realtime", "--live", "--backend", "fake", "--no-pictures", "--unchecked", "-o", out, *arguments,
        environment={"COLUMNS": "200"}, prepare=_forking if is_forking else _patiently,
    )  # fmt: skip
    try:
        yield Running(process, out)
    finally:
        process.kill()
        process.communicate(PATIENCE_S)


def token_of(run: Running) -> str:
    """What the terminal has printed for those who take part."""
    line = run.process.stdout.readline()
    assert line.startswith(f"to play a robot or the fault: {run.url}#act="), line
    return line.split("#act=")[1].strip()


class Person(Talk):
    """A page of somebody who takes part."""

    def join(self, token: str) -> None:
        """Says that it takes part."""
        self.text(json.dumps({"do": "join", "token": token}))
        assert self.hear("act") == {"act": "joined"}

    @contextmanager
    def listening(self) -> Iterator[None]:
        """While the block lasts, all that is told is taken and forgotten."""
        thread = threading.Thread(target=self._forget, daemon=True)
        thread.start()
        try:
            yield
        finally:
            with suppress(OSError):
                self._socket.shutdown(socket.SHUT_RDWR)
            thread.join()

    def _forget(self) -> None:
        with suppress(OSError):  # the server has gone, or nobody listens any more
            while True:
                self._read(math.inf)

    def act(self, do: str, **more: Any) -> None:
        self.text(json.dumps({"do": "act", "wish": {"do": do, **more}}))

    def until(self, is_so: Callable[[dict[str, Any]], Any]) -> dict[str, Any]:
        """Waits until the hand is told to be so."""
        while True:
            for update in self.hear("updates")["updates"]:
                if is_so(update["hand"]):
                    return dict(update["hand"])

    def asked(self, sensor: str) -> dict[str, Any]:
        """Waits for a question."""
        told = self.until(lambda h: any(q["sensor"] == sensor for q in h["questions"]))
        return next(q for q in told["questions"] if q["sensor"] == sensor)


def hostile(example: Path, folder: Path) -> Path:
    """The smallest cell with names that would be markup, if they were not texts."""
    name = HOSTILE.replace("<", "&lt;").replace(">", "&gt;")
    return _changed(example, folder, "<text>Accept</text>", f"<text>{name}</text>")


def endless(example: Path, folder: Path) -> Path:
    """The smallest cell, which begins anew after its last part: it ends when it is ended, however long that takes."""
    return _changed(example, folder, ">n + 1</text>", ">n mod 3 + 1</text>")


def _changed(example: Path, folder: Path, old: str, new: str) -> Path:
    shutil.copytree(example, folder)
    net = folder / "cell.cpn"
    text = net.read_text(encoding="utf-8")
    assert text.count(old) == 1
    net.write_text(text.replace(old, new), encoding="utf-8")
    return folder
