"""Several methods side by side, in rounds that get longer: each is given what is still open.

    for name, value, techniques in answers(program, tables, asked, kinds, seconds=60.0): ...

A method that cannot answer a question leaves it to the others. Two that answer the same question must agree.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from pn2code.contest.diagrams import KINDS, METHOD, Diagrams
from pn2code.contest.engine import Answer, Space, Task, ask
from pn2code.contest.examinations import Asked, Part
from pn2code.contest.tables import Tables

METHODS = {
    "walk": ("reach", "bound"),
    "explore": ("reach", "bound"),
    "reach": ("reach", "bound"),
    "ctl": ("ctl",),
    "ltl": ("ltl",),
    METHOD: KINDS,
}
"""Method of the engine -> the kinds of questions that it can answer."""
_PLANS = {
    "reach": (("walk", "reach"), ("explore", "reach"), ("walk", "reach")),
    "bound": (("walk", "reach"), ("explore", "reach"), ("walk", "reach")),
    "ctl": (("ctl", "ctl"),),
    "ltl": (("ltl", "ltl"),),
}
"""By kind the pairs of methods of the rounds; the last one is repeated. Twice the same method: each gets a half."""
_ROUNDS_S = (1.0, 3.0, 8.0, 20.0)
_LEAST_S = 0.2
"""With less time left nothing is begun."""


@dataclass(frozen=True, slots=True)
class Result:
    """The answer to one line of an examination."""

    name: str
    value: bool | int
    techniques: str


@dataclass(slots=True)
class _Line:
    """A line with what is known of its parts."""

    asked: Asked
    known: dict[int, bool | int] = field(default_factory=dict)
    techniques: set[str] = field(default_factory=set)
    is_done: bool = False

    def result(self) -> Result | None:
        """The answer, once it is known."""
        a = self.asked
        value: bool | int
        if a.decides is None:
            if not self.known:
                return None
            value = next(iter(self.known.values()))
            value = not value if a.is_turned else value
        elif a.decides in self.known.values():
            value = a.value
        elif len(self.known) == len(a.parts):
            value = not a.value
        else:
            return None
        return Result(a.name, value, " ".join(sorted(self.techniques)))


def answers(
    program: Path,
    tables: Tables,
    asked: Sequence[Asked],
    *,
    seconds: float,
    mebibytes: int = 4096,
    only: str = "",
) -> Iterator[Result]:
    """The answers that can be had, in the order in which they come.

    Args:
        program: the engine.
        tables: the net.
        asked: the lines of the examination.
        seconds: for all of them together.
        mebibytes: of memory for all that runs side by side.
        only: a method, alone; "": all.

    Raises:
        RuntimeError: two methods contradict each other, or the engine did not understand its tables.
    """
    lines = [_Line(a) for a in asked]
    diagrams = Diagrams(tables)
    undone = sum(1 for line in lines if line.asked.parts)
    ends = time.monotonic() + seconds
    place: dict[int, tuple[_Line, int, Part]] = {}
    for line in lines:
        for i, part in enumerate(line.asked.parts):
            place[len(place)] = (line, i, part)
    for line in lines:  # without places or transitions nothing has to be asked
        result = line.result()
        if result is not None:
            line.is_done = True
            yield result
    for number in range(len(_ROUNDS_S) + 1):
        left = ends - time.monotonic()
        open_ = {
            n: p for n, (line, i, p) in place.items() if not line.is_done and i not in line.known
        }
        if not open_ or left < _LEAST_S:
            return
        length = min(left, _ROUNDS_S[number]) if number < len(_ROUNDS_S) else left
        tasks = _tasks(tables, diagrams, open_, number, length, mebibytes, only)
        for found in ask(program, _until(ends, tasks)):
            assert isinstance(found, Answer)
            if not found.is_final:
                continue
            line, which, _ = place[found.number]
            if line.known.setdefault(which, found.value) != found.value:
                raise RuntimeError(f"{line.asked.name}: {found.method} contradicts another method")
            line.techniques.add(found.method)
            result = None if line.is_done else line.result()
            if result is not None:
                line.is_done = True
                yield result
                undone -= 1
                if not undone:
                    return


def _tasks(
    tables: Tables,
    diagrams: Diagrams,
    open_: dict[int, Part],
    number: int,
    seconds: float,
    mebibytes: int,
    only: str,
) -> list[Task]:
    """What runs side by side in a round: for each kind of question two methods, or one method twice; diagrams."""
    drawn = {n: part.text for n, part in open_.items() if part.kind in KINDS}
    if only == METHOD:
        return diagrams.tasks(drawn, range(number, number + 2), seconds, mebibytes // 2)
    kinds = {part.kind for part in open_.values()}
    pairs = [_PLANS[kind][min(number, len(_PLANS[kind]) - 1)] for kind in sorted(kinds)]
    chosen: list[tuple[str, str]] = []
    for which in range(2):
        for method in dict.fromkeys(only or pair[which] for pair in pairs):
            mine = [n for n, part in open_.items() if part.kind in METHODS[method]]
            if only or all(pair[0] == pair[1] for pair in pairs if method in pair):
                mine = mine[which::2]
            if mine:
                chosen.append((method, tables.text([f"{n} {open_[n].text}" for n in mine])))
    is_drawn = not only and number > 0
    share = mebibytes // max(1, len(chosen) + is_drawn)
    tasks = [
        Task(method, text, seconds, share, seed=len(chosen) * number + i)
        for i, (method, text) in enumerate(chosen, 1)
    ]
    if is_drawn:
        tasks += diagrams.tasks(drawn, range(number - 1, number), seconds, share)
    return tasks


def _until(ends: float, tasks: list[Task]) -> list[Task]:
    """None of them goes on after the end, however long it took to make them."""
    left = max(0.0, ends - time.monotonic())
    return [replace(task, seconds=min(task.seconds, left)) for task in tasks]


def space(
    program: Path, tables: Tables, *, seconds: float, mebibytes: int, only: str = ""
) -> Space | None:
    """The sizes of the state space, if it can be seen to its end: counted, and with diagrams, side by side."""
    ends = time.monotonic() + seconds
    tasks = []
    if only in ("", "explore"):
        tasks.append(Task("count", tables.text([]), seconds, mebibytes // 3))
    if only in ("", METHOD):
        tasks += Diagrams(tables).sizes(seconds, mebibytes // 3)
    for found in ask(program, _until(ends, tasks)):
        if isinstance(found, Space):
            return found
    return None
