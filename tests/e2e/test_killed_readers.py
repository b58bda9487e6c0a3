"""Readers of a register, or the supervisor that sets it, are killed at any moment: what is read is whole, and is fresh.

Each reader is a process of its own, which runs its script on the real files and writes down what it reads and uses. The
property that `verify` proves of this cell (`test_registers`), that who is told to look sees what was set before, has to
be true of all that was written down until the kill.
"""

from __future__ import annotations

import json
import os
import signal
import time
from functools import partial
from pathlib import Path
from random import Random
from typing import Any

import pytest

from helpers import register_pairs
from helpers.processes import Child
from helpers.thorough import amount
from pn2code import pipeline
from pn2code.channels import PeerState, SharedDirectory, specs_of
from pn2code.diagnostics import Diagnostics
from pn2code.emission.write import write
from pn2code.run.files import RobotFiles
from pn2code.run.prepare import scripts_of
from pn2code.run.supervisor import SupervisorProcess
from pn2code.tdl.interpret import Interpreter
from pn2code.tdl.requests import AwaitFile, Event, Fault, Finished, Marked, MessageRead
from pn2code.toolchain import build

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

TOP = 100_000
"""What the register begins with: more than there is time for."""
ROUNDS = amount(3, 60)
ENOUGH_S = 120.0


def reads(generated: pipeline.Generated, script: Any, folder: Path, name: str, into: Path) -> int:
    """A reader: runs its script until the supervisor is gone; 0 if nothing was wrong."""
    log = os.open(into, os.O_WRONLY | os.O_CREAT | os.O_APPEND)

    def note(row: dict[str, Any]) -> None:
        os.write(log, (json.dumps(row) + "\n").encode())

    def hear(event: Event) -> None:
        if isinstance(event, Marked) and "k" in event.binding:
            note({"used": event.binding["k"]})
        elif isinstance(event, MessageRead) and event.file.startswith("limit"):
            note({"read": [repr(x) for x in event.values]})

    side = SharedDirectory(folder, name, specs_of(generated.partition))
    if not side.await_supervisor(30.0):
        return 3
    files = RobotFiles(side, 0.0)  # whatever is refused is a fault at once
    interpreter = Interpreter(script, files, hear)
    while True:
        request = interpreter.resume()
        if isinstance(request, Fault | Finished):
            note({"fault": str(request)})
            return 4
        while isinstance(request, AwaitFile) and not files.any_holds(request.names):
            if side.peer().state is not PeerState.RUNNING:
                return 0
            time.sleep(0.0005)


def rows(path: Path) -> list[dict[str, Any]]:
    return [json.loads(x) for x in path.read_text().splitlines()] if path.exists() else []


@pytest.mark.parametrize("host", ["supervisor", "supervisor.traced"])
def test_what_is_read_is_whole_and_fresh(host: str, tmp_path: Path) -> None:
    cell = register_pairs.write(tmp_path / "cell", register_pairs.TOLD, **{"1`3": f"1`{TOP}"})
    d = Diagnostics()
    generated = pipeline.generate(cell, d, checked=False)
    assert generated is not None and generated.config is not None, [str(i) for i in d]
    scripts = scripts_of(generated, generated.config, d)
    assert scripts is not None
    write(tmp_path / "program", generated.files)
    program = build.build(tmp_path / "program", generated.files, d, target=host)
    assert program is not None, [str(i) for i in d]
    shared = tmp_path / "shared"
    shared.mkdir()
    r, used = Random(host), 0
    for number in range(ROUNDS):
        victim = ("first", "second", "supervisor")[number % 3]
        logs = {name: tmp_path / f"{number}.{name}" for name in ("first", "second")}
        with SupervisorProcess(program, shared, cell) as supervisor:
            readers = {
                name: Child(partial(reads, generated, scripts[name][1], shared, name, into))
                for name, into in logs.items()
            }
            until = time.monotonic() + ENOUGH_S
            least = r.randint(1, 60)
            while any(len(rows(x)) < least for x in logs.values()) and time.monotonic() < until:
                time.sleep(0.002)
            time.sleep(r.random() * 0.005)
            if victim == "supervisor":
                os.kill(supervisor.pid, signal.SIGKILL)
            else:
                readers[victim].kill()
            end = supervisor.wait(ENOUGH_S)
            codes = {name: child.wait() for name, child in readers.items() if name != victim}
        if victim != "supervisor":
            assert victim in end.reason, end
        assert set(codes.values()) == {0}, (codes, [rows(x)[-1:] for x in logs.values()])
        for path in logs.values():
            found = rows(path)
            assert not any("fault" in row for row in found), found[-1]
            values = [row["used"] for row in found if "used" in row]
            assert values == list(range(TOP - 1, TOP - 1 - len(values), -1))
            used += len(values)
    assert used > ROUNDS
