"""The engine for place/transition nets as tables (`cnative`: tables.c), as a process that can be ended at any time.

    with engine(d) as program:
        for answer in ask(program, tables.text(questions), "reach", seconds=10.0, mebibytes=2048):
            ...                                    # as soon as it is known

Several methods run side by side, each in a process of its own; none of them can take the answers of another with it.
A lane is one such place: its tasks run one after the other.
"""

from __future__ import annotations

import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import field, replace
from pathlib import Path
from queue import Empty, SimpleQueue

from pn2code.base.frozen import frozen
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
_LATE_S = 0.5
_LATE = 0.05
"""So much later than its time, but by no more than that part of it, a process may say what it knows."""


@frozen
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


@frozen
class Space:
    """Sizes of a state space that was seen to its end; `dead` is None where it was not asked for."""

    states: int
    arcs: int
    tokens_in_place: int
    tokens_in_marking: int
    dead: int | None
    method: str = "EXPLICIT"


@frozen
class Run:
    """Steps from the initial marking to one that a question looks for: indices of transitions of the tables."""

    number: int
    steps: tuple[int, ...]


def engine(d: Diagnostics) -> AbstractContextManager[Path | None]:
    """The compiled engine; None after a diagnostic."""
    return programs.program(HOST, (), d)


@frozen
class Task:
    """One method with some questions.

    Args:
        method: of the engine.
        text: the net with the questions.
        seconds: that it may take.
        mebibytes: of memory that it may use.
        seed: of what it draws.
        added: number of a question -> what has to be added to its bound, since the net was reduced.
        technique: put before the name of the method, if the net was reduced.
        patience: seconds after which diagrams are given up that are not whole; None: all that it may take.
        on_whole: called when they are whole.
    """

    method: str
    text: str
    seconds: float
    mebibytes: int
    seed: int = 1
    added: Mapping[int, int] = field(default_factory=dict)
    technique: str = ""
    patience: float | None = None
    on_whole: Callable[[], None] | None = None


Said = SimpleQueue[Answer | Space | Run | Exception | None]
"""What the lanes say, in the order in which they say it; None: one has come to its end."""


def ask(
    program: Path,
    lanes: Sequence[Task | Iterable[Task]],
    said: Said | None = None,
    *,
    until: float | None = None,
) -> Iterator[Answer | Space | Run]:
    """The answers of all lanes side by side, as they come; processes end with the iteration.

    Args:
        program: the engine.
        lanes: tasks, which may be made when the lane comes to them.
        said: where others say what they know meanwhile; their answers come, too.
        until: when to stop at the latest, on the monotonic clock, even if a lane is still making a task.

    Raises:
        RuntimeError: the engine did not understand its tables.
    """
    said = SimpleQueue() if said is None else said
    with tempfile.TemporaryDirectory(prefix="pn2code-", ignore_cleanup_errors=True) as folder:
        running = [
            _Lane(program, [x] if isinstance(x, Task) else x, said, Path(folder) / f"{i}.tables")
            for i, x in enumerate(lanes)
        ]
        try:
            for lane in running:
                lane.start()
            left = len(running)
            while left:
                try:
                    found = said.get(timeout=_time_left(until))
                except Empty:
                    return
                if found is None:
                    left -= 1
                elif isinstance(found, Exception):
                    raise RuntimeError(f"the engine for tables: {found}") from found
                else:
                    yield found
        finally:
            for lane in running:
                lane.end()
            patience = time.monotonic() + _GRACE_S / 4
            for lane in running:
                lane.join(max(0.0, patience - time.monotonic()))


def grace_of(seconds: float) -> float:
    """How long after the end of so much time a process is waited for."""
    return max(0.0, min(_LATE_S, _LATE * seconds))


def _time_left(until: float | None) -> float | None:
    return None if until is None else max(0.0, until - time.monotonic())


class _Lane(threading.Thread):
    """Tasks one after the other."""

    def __init__(self, program: Path, tasks: Iterable[Task], said: Said, path: Path) -> None:
        super().__init__(daemon=True)
        self.program = program
        self.tasks = tasks
        self.said = said
        self.path = path
        self.process: subprocess.Popen[str] | None = None
        self.lock = threading.Lock()
        self.is_over = False

    def run(self) -> None:
        """All tasks."""
        try:
            for task in self.tasks:
                if self.is_over:
                    return
                self._run(task)
        except Exception as error:  # it belongs to the one who waits
            self._say(error)
        finally:
            self._say(None)

    def _say(self, found: Answer | Space | Run | Exception | None) -> None:
        """Nothing any more when nobody waits: the queue may be that of others by then."""
        with self.lock:
            if not self.is_over:
                self.said.put(found)

    def _run(self, task: Task) -> None:
        self.path.write_text(task.text, encoding="ascii")
        with self.lock:
            if self.is_over:
                return
            self.process = _started(self.program, self.path, task)
        guard = threading.Timer(task.seconds + _GRACE_S, self.process.kill)
        guard.start()
        try:
            _read(self.process, task, self._say)
        finally:
            guard.cancel()

    def end(self) -> None:
        """Stop at once; a task that is being made is not waited for."""
        with self.lock:
            self.is_over = True
            if self.process is not None:
                self.process.kill()


def _started(program: Path, path: Path, task: Task) -> subprocess.Popen[str]:
    limits = [f"{task.seconds:.3f}", str(task.mebibytes), str(task.seed)]
    limits += [] if task.patience is None else [f"{task.patience:.3f}"]
    command = [str(program), str(path), task.method, *limits]
    return subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def _read(
    process: subprocess.Popen[str],
    task: Task,
    say: Callable[[Answer | Space | Run], None],
) -> None:
    with process:
        assert process.stdout is not None and process.stderr is not None
        for line in process.stdout:
            if line.startswith("seen ") and task.on_whole is not None:
                task.on_whole()
            found = _parsed(line)
            if isinstance(found, Answer):
                more = task.added.get(found.number, 0)
                value = found.value + more if more else found.value
                method = f"{task.technique} {found.method}".strip()
                found = replace(found, value=value, method=method)
            if found is not None:
                say(found)
        errors = process.stderr.read()
    if process.returncode == _WRONG:
        raise RuntimeError(errors.strip())


def _parsed(line: str) -> Answer | Space | Run | None:
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
        case ["run", number, count, *steps] if len(steps) == int(count):
            return Run(int(number), tuple(map(int, steps)))
    return None
