"""Cells that run with a live page, for tests."""

from __future__ import annotations

import json
import math
import re
import shutil
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from helpers.played import PATIENCE_S, Served, Talk
from helpers.processes import Talking

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


@contextmanager
def running(cell: Path, out: Path, *arguments: str) -> Iterator[Running]:
    """A cell that runs, with the fake backend."""
    process = Talking(
        "run", cell, "--realtime", "--live", "--backend", "fake", "--no-pictures", "--unchecked", "-o", out, *arguments,
        environment={"COLUMNS": "200"},
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
    shutil.copytree(example, folder)
    net = folder / "cell.cpn"
    text = net.read_text(encoding="utf-8")
    name = HOSTILE.replace("<", "&lt;").replace(">", "&gt;")
    changed = re.sub(r"<text>Accept</text>", f"<text>{name}</text>", text)
    assert changed != text
    net.write_text(changed, encoding="utf-8")
    return folder
