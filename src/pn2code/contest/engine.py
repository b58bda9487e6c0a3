"""The engine for place/transition nets as tables (`cnative`: tables.c), as a process that can be ended at any time.

    with engine(d) as program:
        for answer in ask(program, tables.text(questions), "reach", seconds=10.0, mebibytes=2048):
            ...                                    # as soon as it is known

Several methods run side by side, each in a process of its own; none of them can take the answers of another with it.
"""

from __future__ import annotations

import subprocess
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from queue import Empty, SimpleQueue

from pn2code.diagnostics import Diagnostics
from pn2code.toolchain import programs
from pn2code.toolchain.programs import Host

HOST = Host(
    "tables",
    flags=("-pthread",),
    libraries=("-pthread", "-lm"),
    also=("symbolic",),
    only=("tables*.c", "symbolic*.c"),
)
_WRONG = 2
"""Exit code: the tables are wrong."""
_GRACE_S = 1.0
"""After its time a process is ended."""


@dataclass(frozen=True, slots=True)
class Answer:
    """What a method has found out.

    Args:
        number: of the question.
        value: True or False; of a bound a number.
        is_final: False: the bound is at least that.
        method: its name in the contest's list of techniques.
    """

    number: int
    value: bool | int
    is_final: bool
    method: str


@dataclass(frozen=True, slots=True)
class Space:
    """Sizes of a state space that was seen to its end; `dead` is None where it was not asked for."""

    states: int
    arcs: int
    tokens_in_place: int
    tokens_in_marking: int
    dead: int | None
    method: str = "EXPLICIT"


def engine(d: Diagnostics) -> AbstractContextManager[Path | None]:
    """The compiled engine; None after a diagnostic."""
    return programs.program(HOST, (), d)


@dataclass(frozen=True, slots=True)
class Task:
    """One method with some questions.

    Args:
        method: of the engine.
        text: the net with the questions.
        seconds: that it may take.
        mebibytes: of memory that it may use.
        seed: of what it draws.
        then: what is begun when this one has ended, whatever it said.
    """

    method: str
    text: str
    seconds: float
    mebibytes: int
    seed: int = 1
    then: Task | None = None

    def until_all_ended(self) -> float:
        """Seconds that it may take with all that follow."""
        return self.seconds + (self.then.until_all_ended() if self.then else 0.0)


def ask(program: Path, tasks: Sequence[Task]) -> Iterator[Answer | Space]:
    """The answers of all tasks side by side, as they come; processes end with the iteration.

    Raises:
        RuntimeError: the engine did not understand its tables.
    """
    said: SimpleQueue[Answer | Space | str | None] = SimpleQueue()
    with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
        running = [
            _Row(program, Path(folder) / f"{n}.tables", t, said) for n, t in enumerate(tasks)
        ]
        try:
            for row in running:
                row.start()
            longest = max((t.until_all_ended() for t in tasks), default=0.0) + _GRACE_S
            yield from _until_all_ended(said, len(running), time.monotonic() + longest)
        finally:
            for row in running:
                row.stop()


class _Row(threading.Thread):
    """Processes one after the other, and what they say."""

    def __init__(
        self,
        program: Path,
        path: Path,
        first: Task,
        said: SimpleQueue[Answer | Space | str | None],
    ) -> None:
        super().__init__(daemon=True)
        self.program, self.path, self.first, self.said = program, path, first, said
        self.guard = threading.Lock()
        self.process: subprocess.Popen[str] | None = None
        self.is_stopped = False

    def run(self) -> None:
        task: Task | None = self.first
        try:
            while task is not None:
                self.path.write_text(task.text, encoding="ascii")
                with self.guard:
                    if self.is_stopped:
                        return
                    self.process = _started(self.program, self.path, task)
                _read(self.process, self.said)
                task = task.then
        finally:
            self.said.put(None)

    def stop(self) -> None:
        """End what runs; nothing is begun any more."""
        with self.guard:
            self.is_stopped = True
            if self.process is not None:
                self.process.kill()
        if self.ident is not None:
            self.join()


def _started(program: Path, path: Path, task: Task) -> subprocess.Popen[str]:
    limits = [f"{task.seconds:.3f}", str(task.mebibytes), str(task.seed)]
    command = [str(program), str(path), task.method, *limits]
    return subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def _read(process: subprocess.Popen[str], said: SimpleQueue[Answer | Space | str | None]) -> None:
    with process:
        assert process.stdout is not None and process.stderr is not None
        for line in process.stdout:
            found = _parsed(line)
            if found is not None:
                said.put(found)
        errors = process.stderr.read()
    if process.returncode == _WRONG:
        said.put(errors.strip())


def _parsed(line: str) -> Answer | Space | None:
    words = line.split()
    match words:
        case ["answer", number, value, method]:
            return Answer(int(number), value == "yes", True, method)
        case ["bound", number, value, how, method]:
            return Answer(int(number), int(value), how == "exact", method)
        case ["space", states, arcs, place, marking, dead]:
            return Space(int(states), int(arcs), int(place), int(marking), int(dead))
        case ["sizes", states, arcs, place, marking]:
            sizes = int(states), int(arcs), int(place), int(marking)
            return Space(*sizes, None, "DECISION_DIAGRAMS")
    return None


def _until_all_ended(
    said: SimpleQueue[Answer | Space | str | None], running: int, ends: float
) -> Iterator[Answer | Space]:
    while running:
        try:
            found = said.get(timeout=max(0.0, ends - time.monotonic()))
        except Empty:
            return
        if found is None:
            running -= 1
        elif isinstance(found, str):
            raise RuntimeError(f"the engine for tables: {found}")
        else:
            yield found
