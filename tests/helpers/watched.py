"""A cell without programs, for tests of `pn2code watch`: both sides of the smallest cell, played step by step."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

from pn2code.channels import SharedDirectory, Status, specs_of
from pn2code.cli.watch import _cell
from pn2code.diagnostics import Diagnostics
from pn2code.live.watched import WatchedCell
from pn2code.run.journal import Journal


def minimal(root: Path) -> WatchedCell:
    """The smallest cell, as it is watched."""
    d = Diagnostics()
    found = _cell(root / "examples/minimal", None, {}, None, d)
    assert found is not None, [e.message for e in d.errors]
    return found[0]


class Played:
    """Supervisor and robot, with or without traces.

    Args:
        folder: the shared folder.
        cell: what they are sides of.
        traces: who writes one: "supervisor", "robot".
    """

    def __init__(self, folder: Path, cell: WatchedCell, *traces: str) -> None:
        folder.mkdir(exist_ok=True)
        specs = specs_of(cell.partition)
        self.folder = folder
        self.supervisor = SharedDirectory(folder, "supervisor", specs)
        self.session = self.supervisor.announce()
        self.robot = SharedDirectory(folder, "robot", specs)
        assert self.robot.await_supervisor(600.0)
        self.t = 0.0
        self._steps = 0
        self._trace = folder / "supervisor.trace.jsonl" if "supervisor" in traces else None
        if self._trace is not None:
            header = {"trace": 1, "net": "cell", "by": "supervisor", "initial": {}}
            self._trace.write_text(json.dumps(header) + "\n", encoding="utf-8")
        self.journal: Journal | None = None
        if "robot" in traces:
            path = folder / "robot.trace.jsonl"
            self.journal = Journal(path, "robot", session=self.session, began=self.supervisor.began)

    def line(self, text: str) -> None:
        """Text at the end of the supervisor's trace."""
        assert self._trace is not None
        with self._trace.open("a", encoding="utf-8") as stream:
            stream.write(text)

    def fires(self, transition: str, **binding: Any) -> None:
        """A step of the supervisor, in its trace."""
        self._steps += 1
        # The robot's journal has real times; a step long before them would be one that the net does not allow.
        self.t = max(self.t + 0.001, time.time() - self.supervisor.began)
        row = {
            "step": self._steps,
            "t": self.t,
            "transition": f"Cell.Supervisor.{transition}",
            "binding": binding,
            "origin": "",
        }
        if self._trace is not None:
            self.line(json.dumps(row) + "\n")

    def _marks(self, transition: str, n: int) -> None:
        if self.journal is not None:
            self.journal.mark(f"Cell.Robot.{transition}", {"n": n}, "")

    def order(self, n: int) -> None:
        """The supervisor orders."""
        self.supervisor.write("order", (n,))
        self.fires("Order", n=n)

    def accept(self, n: int) -> None:
        """The robot takes the order."""
        self.robot.read("order")
        self.robot.clear("order")
        self._marks("Accept", n)

    def report(self, n: int) -> None:
        """The robot has placed and says so."""
        self._marks("Place", n)
        self._marks("Report", n)
        self.robot.write("placed", (n,))

    def placed(self, n: int) -> None:
        """The supervisor hears of it."""
        self.supervisor.read("placed")
        self.supervisor.clear("placed")
        self.fires("Placed", n=n)

    def end(self, state: Status = Status.FINISHED, reason: str = "") -> None:
        """Both sides end."""
        if self._trace is not None and state is Status.FINISHED:
            self.fires("Finish")
        self.robot.set_status(state, reason)
        self.supervisor.set_status(state, reason)
        self.close()

    def close(self) -> None:
        """Nothing more is said: as if both had been killed."""
        self.robot.close()
        self.supervisor.close()
        if self.journal is not None:
            self.journal.close()
