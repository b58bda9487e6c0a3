"""Cells that run with a live page, for tests."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from helpers.played import PATIENCE_S, Served
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
