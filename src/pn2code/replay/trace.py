"""The description of any trace: simulations, counterexamples and lassos, and runs of a cell without its geometry.

described = describe(Path("net.dead-40.trace.jsonl"), document, net, storage)
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from pn2code.net.flat import FlatNet
from pn2code.reading.document import Document
from pn2code.replay import net as nets
from pn2code.replay.course import Course
from pn2code.replay.description import VERSION, Json
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.token_game import Game
from pn2code.trace.lines import is_number
from pn2code.trace.markings import ALL, claimed_loop
from pn2code.trace.parties import RUN, SIMULATORS, VERIFY
from pn2code.trace.replay import replay_lines
from pn2code.trace.replay_result import ReplayResult
from pn2code.trace.whole_lines import whole_lines

MOST_STEPS = 1_000_000
MOST_TOLD = 4_000
"""So many characters are told of what is wrong with a trace."""
_TOLD_STEPS = 500

Progress = Callable[[int, float], None]
"""Is called now and then with how many steps have been read, and which share of the file."""


def _nothing(steps: int, share: float) -> None:
    return None


def describe(
    trace: Path,
    document: Document,
    net: FlatNet,
    storage: Mapping[str, str],
    *,
    most: int = MOST_STEPS,
    files: Files | None = None,
    failed: Container[str] = (),
    failing: Callable[[Game], list[str]] = lambda _game: [],
    progress: Progress = _nothing,
) -> Json:
    """The description of a trace file.

    Args:
        trace: the file.
        document, net: its net, as drawn and as played.
        storage: as for `Game`.
        most: how many steps are shown; the rest is left out, and the page says so.
        files: what the net can do with files.
        failed: final places that mean that the cell has failed.
        failing: says which other conditions at the end mean so.
        progress: how far it is.

    Raises:
        OSError: it cannot be read.
    """
    with trace.open(encoding="utf-8", errors="replace") as lines:
        reader = _Lines(whole_lines(lines), most, max(trace.stat().st_size, 1), progress)
        by = reader.by
        counts = by in SIMULATORS or by == VERIFY or by == ""
        course, refused, game = _followed(
            reader, net, storage, by_steps=counts, files=files, loop=claimed_loop(trace)
        )
    end = reader.end or {}
    has_finished = bool(end.get("final")) and not reader.is_cut and game is not None
    others = failing(game) if has_finished and game is not None else []
    return {
        "pn2code": {"run": VERSION},
        "kind": "trace",
        "title": net.name,
        "clock": "steps" if counts else "seconds",
        "end": float(course.steps) if counts else max(reader.latest, 0.0),
        "verdict": {
            "word": "cut" if reader.is_cut else _word(end),
            "reason": str(end.get("reason", "")),
            "final": [str(p) for p in end.get("final", ())],
            "failed": [*(str(p) for p in end.get("final", ()) if p in failed), *others],
        },
        "facts": [["trace", trace.name], ["by", by], ["steps", f"{course.steps:,}"]],
        "net": nets.describe(document, net),
        "course": {
            **course.described(),
            "refused": refused,
            "loop": end.get("loop") if isinstance(end.get("loop"), int) else None,
        },
        "happenings": None,
        "programs": None,
        "cell": None,
        "motion": None,
    }


def follow(
    lines: Iterable[str],
    net: FlatNet,
    storage: Mapping[str, str],
    *,
    by_steps: bool = False,
    files: Files | None = None,
    loop: int | str | None = ALL,
) -> tuple[Course, Json | None]:
    """The course of a trace through its net, as the token game repeats it, and where that ends before the trace does.

    Args:
        by_steps: the axis counts steps; else it is that of the times in the trace.
        loop: as for `replay_lines`.
    """
    return _followed(lines, net, storage, by_steps=by_steps, files=files, loop=loop)[:2]


def _followed(
    lines: Iterable[str],
    net: FlatNet,
    storage: Mapping[str, str],
    *,
    by_steps: bool,
    files: Files | None,
    loop: int | str | None,
) -> tuple[Course, Json | None, Game | None]:
    """The same, and the game at its end if the whole trace was repeated."""
    course = Course(net)
    latest = 0.0

    def watch(game: Game, occurred: BindingElement | None, line: Mapping[str, Any]) -> None:
        nonlocal latest
        if occurred is None:
            course.begin(game)
            return
        latest = max(latest, _moment(line))
        course.step(game, occurred, float(course.steps + 1) if by_steps else latest)

    result = replay_lines(lines, net, storage, watch=watch, files=files, loop=loop)
    return course, _refusal(result), result.game if result.ok else None


def _refusal(result: ReplayResult) -> Json | None:
    if result.ok:
        return None
    transition, why = (_cut(text) for text in (result.transition, result.why))
    return {"step": result.steps + 1, "transition": transition, "why": why}


def _cut(text: str) -> str:
    return text if len(text) <= MOST_TOLD else f"{text[:MOST_TOLD]}..."


def _word(end: Json) -> str:
    """Why a trace says that it ended; that steps are left out is for us to say."""
    why = str(end.get("why", ""))
    return '"cut"' if why == "cut" else why


class _Lines:
    """The lines of a trace, as far as they are wanted; knows afterwards what its head and its end said.

    Attributes:
        by: who wrote it.
        end: its last line, if it has one.
        latest: the greatest time.
        is_cut: whether steps were left out.
    """

    def __init__(self, lines: Iterable[str], most: int, size: int, progress: Progress) -> None:
        self._size, self._progress = size, progress
        self._lines = iter(lines)
        self._first = next(self._lines, "")
        self._most = most
        self.by = str(_object(self._first).get("by", ""))
        self.end: Json | None = None
        self.latest = 0.0
        self.is_cut = False

    def __iter__(self) -> Iterator[str]:
        yield self._first
        steps, read = 0, len(self._first)
        for text in self._lines:
            read += len(text)
            if '"event"' in text:
                line = _object(text)
                self._note(line)
                if line.get("event") == "end":
                    self.end = line
                    yield text
                    continue
            elif text.strip():
                steps += 1
                if steps % _TOLD_STEPS == 0:
                    self._progress(steps, max(read / self._size, steps / self._most))
                if steps > self._most:
                    self.is_cut = True
                    return
                if self.by == RUN or self.by not in (*SIMULATORS, VERIFY):
                    self._note(_object(text))
            yield text

    def _note(self, line: Json) -> None:
        self.latest = max(self.latest, _moment(line))


def _moment(line: Mapping[str, Any]) -> float:
    """The time of a line; 0 where it has none, or one that no axis has."""
    t = line.get("t")
    if not is_number(t):
        return 0.0
    try:
        return float(t) if math.isfinite(t) else 0.0
    except OverflowError:  # a whole number that is too large
        return 0.0


def _object(text: str) -> Json:
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        return {}
    return data if isinstance(data, dict) else {}
