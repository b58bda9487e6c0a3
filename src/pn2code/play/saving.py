"""Traces of a session: saving its run, and loading one.

save(session, path)                  # `pn2code replay` accepts it
load(session, path)                  # sentences about what was loaded
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from pn2code.play.session import Session
from pn2code.play.trouble import Trouble, of_game
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.marking import BindingElement, Marking
from pn2code.semantics.game.token_game import Game
from pn2code.trace.parties import SIMULATORS, VERIFY
from pn2code.trace.replay import replay, replay_lines
from pn2code.trace.writing import json_text

MOST_LOADED = 100_000
"""Steps of a trace that are loaded."""


def save(session: Session, path: Path, *, is_checked: bool = True) -> None:
    """Writes the run that goes on.

    Args:
        session: the game.
        path: the file.
        is_checked: repeat it where it begins with a marking changed by hand, since not each of them can be a beginning.

    Raises:
        Trouble: it cannot be a trace.
        OSError: it cannot be written.
    """
    start, initial, obstacle = session.run
    if obstacle:
        raise Trouble(f"this run cannot be saved as a trace: {obstacle}")
    head = _header(session, initial)
    steps = session.game.steps
    with path.open("wb") as out:
        out.write(_line(head))
        session.tape.copy(out, start, session.history.position)
        out.write(_line({"t": session.game.marking.time, "event": "end", "why": _why(session)}))
    if is_checked and initial and steps and session.net.timed:
        result = replay(path, session.net, session.opened.storage, files=Files(None))
        if not result.ok:
            path.unlink()
            raise Trouble(
                f"this run cannot be saved as a trace: the marking was changed while the clock ran, "
                f"and a trace begins at time 0: {result.why}"
            )


def _header(session: Session, initial: Mapping[str, Any]) -> dict[str, Any]:
    net, stream = session.net, session.game.evaluator.random
    head: dict[str, Any] = {
        "trace": 1,
        "net": net.name,
        "source": net.file.replace("\\", "/").rsplit("/", 1)[-1],
        "digest": net.sha256,
        "by": "reference",
        "initial": dict(initial) or session.given(),
        "seed": stream.seed,
    }
    return {**head, "still": True} if stream.is_still else head


def _line(data: Mapping[str, Any]) -> bytes:
    return (json_text(dict(data)) + "\n").encode("utf-8", "surrogateescape")


def _why(session: Session) -> str:
    """The last word of the trace."""
    game = session.game
    if game.steps == 0:
        return "steps"
    now = game.marking.time
    try:
        later = game.advance_time(game.marking)
        if not game.enabled_transitions(later):
            return "finished"
        return "until" if later.time > now and session.history.is_time else "steps"
    except GameError:
        return "error"


class _Enough(Exception):
    """No more steps are wanted."""


class _Loading:
    """Takes over the steps of a trace while they are repeated.

    Attributes:
        game: that of the trace; None before its first line.
        is_known: whether the times of the trace are those of the token game.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._before: tuple[Marking, int] | None = None
        self._last = ""
        self.game: Game | None = None
        self.is_known = False

    def lines(self, lines: Iterable[str]) -> Iterator[str]:
        """The lines; the last one is noted."""
        for line in lines:
            self._last = line if line.strip() else self._last
            yield line

    def end(self) -> None:
        """All steps are repeated: the clock goes on to the time of the last line, where nothing occurs before."""
        last = json.loads(self._last)
        time = last.get("t") if last.get("event") == "end" and self.is_known else None
        now = self._session.game.marking.time
        if isinstance(time, int | float) and time > now and self._session.net.timed:
            with suppress(Trouble):
                self._session.advance(time if self._session.net.real_time else math.floor(time))

    def watch(self, game: Game, occurred: BindingElement | None, line: Mapping[str, Any]) -> None:
        """The game has come so far."""
        session = self._session
        if occurred is None:
            self.game = game
            initial = line.get("initial")
            known = str(line.get("by", "")) in (*SIMULATORS, VERIFY, "")
            self.is_known = known
            obstacle = "" if known else "its times are those of a run of a cell"
            session.adopt(game, initial if isinstance(initial, dict) else {}, obstacle)
        else:
            assert self._before is not None
            session.made(self._before, occurred)
        self._before = game.marking, game.steps
        if session.stop.is_set() or session.history.position >= MOST_LOADED:
            raise _Enough


def load(session: Session, path: Path) -> str:
    """Loads a trace: the game is at its end then, and can be walked back.

    Returns:
        A sentence about it.

    Raises:
        Trouble: the file is no trace of this net.
        OSError: it cannot be read.
    """
    loading = _Loading(session)
    is_cut, result = False, None
    _check_head(path)
    with path.open(encoding="utf-8", errors="replace") as lines:
        try:
            result = replay_lines(
                loading.lines(lines),
                session.net,
                session.opened.storage,
                files=Files(None),
                watch=loading.watch,
            )
        except _Enough:
            is_cut = True
        except GameError as error:
            raise of_game(error) from None
    if loading.game is None:
        raise Trouble(f"this is no trace of the net: {result.why if result else 'it is empty'}")
    count = session.history.position
    if result is not None and result.ok and result.ended is not None:
        loading.end()
    if is_cut:
        return f"{count:,} steps were loaded, and no more"
    if result is not None and not result.ok:
        name = f"`{result.transition}`: " if result.transition else ""
        return f"{count:,} steps were loaded; the next is not possible: {name}{result.why}"
    return f"{count:,} steps were loaded"


def _check_head(path: Path) -> None:
    """What is no trace is refused before the game of the session is given up."""
    with path.open(encoding="utf-8", errors="replace") as lines:
        try:
            head = json.loads(lines.readline(10_000_000))
        except (ValueError, RecursionError):
            head = None
    if not isinstance(head, dict) or head.get("trace") != 1:
        raise Trouble('this is no trace: its first line has no `"trace": 1`')


def leap_lines(path: Path, skipped: int) -> tuple[list[bytes], int]:
    """The lines of the steps in a trace after the first ones, and how many they are."""
    found: list[bytes] = []
    with path.open("rb") as lines:
        next(lines, b"")
        for number, line in enumerate(lines):
            if number >= skipped and not line.startswith(b'{"t"'):
                found.append(line)
    return found, len(found)
