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
    """

    method: str
    text: str
    seconds: float
    mebibytes: int
    seed: int = 1


def ask(program: Path, tasks: Sequence[Task]) -> Iterator[Answer | Space]:
    """The answers of all tasks side by side, as they come; processes end with the iteration.

    Raises:
        RuntimeError: the engine did not understand its tables.
    """
    said: SimpleQueue[Answer | Space | str | None] = SimpleQueue()
    with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
        running: list[tuple[subprocess.Popen[str], threading.Thread]] = []
        try:
            for n, task in enumerate(tasks):
                path = Path(folder) / f"{n}.tables"
                path.write_text(task.text, encoding="ascii")
                process = _started(program, path, task)
                reader = threading.Thread(target=_read, args=(process, said), daemon=True)
                reader.start()
                running.append((process, reader))
            longest = max((t.seconds for t in tasks), default=0.0) + _GRACE_S
            yield from _until_all_ended(said, len(running), time.monotonic() + longest)
        finally:
            for process, reader in running:
                process.kill()
                reader.join()


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
    said.put(None)


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
