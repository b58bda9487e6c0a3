"""Watching a cell that runs elsewhere: sessions come and go, and each look becomes an update when something is new.

    for update in Watching(cell, where, stop).updates(): ...

Nothing is written, locked or sent: the cell does not know of it.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.channels import specs_of
from pn2code.live.seen import Eye, Life, Seen
from pn2code.live.tails import Tails
from pn2code.live.waking import Waking
from pn2code.live.watched import Watched, WatchedCell, nothing_yet
from pn2code.replay import page as replay_page

Json = dict[str, Any]

UPDATE_S = 0.05
"""Between two updates."""
LOOK_S = 0.1
"""Between two looks at states and traces; at the files whenever one changes."""
_BEFORE_S = 0.02
"""Between two looks for a session that begins."""
SUMMARY = "summary.json"
"""What each run leaves in its folder when it has ended."""
LAST_S = 0.6
"""So long after the supervisor's last word traces and the other sides may say theirs."""


@frozen
class Where:
    """Where a cell runs: its shared folder, and its traces; `folder` whose traces count as well.

    Args:
        run: where the results of a `pn2code run` go, if it is one.
    """

    shared: Path
    traces: tuple[Path, ...] = ()
    folder: Path | None = None
    run: Path | None = None


class Watching:
    """Makes updates.

    Args:
        cell: what is watched.
        where: asked again and again: a new run may have another folder.
        is_over: asked again and again: whether to end.
    """

    def __init__(
        self, cell: WatchedCell, where: Callable[[], Where], is_over: Callable[[], bool]
    ) -> None:
        self._cell, self._ask, self._is_over = cell, where, is_over
        self._specs = specs_of(cell.partition)
        self._parties = tuple(o.name for o in cell.partition.owners)
        self._watched: Watched | None = None
        self._looked = False
        self._ended_at: float | None = None
        self._is_told = False

    def begin_again(self) -> None:
        """Too much has been told: the next update is a fresh one."""
        if self._watched is not None:
            self._watched.begin_again()

    def updates(self) -> Iterator[Json]:
        """As they come, until it is over."""
        where = self._ask()
        while not self._is_over():
            self._looked = False
            with Waking(where.shared) as waking:
                yield from self._of(where, waking)
            where = self._ask()
        if self._watched is not None:
            self._watched.close()

    def _of(self, where: Where, waking: Waking) -> Iterator[Json]:
        """As long as the cell is in this place."""
        eye = Eye(where.shared, self._specs, self._parties)
        tails = Tails(where.traces, where.folder)
        looked = told = 0.0
        seen = eye.look()
        is_first = True
        names = {spec.file: spec.name for spec in self._specs}
        while not self._is_over():
            now = time.monotonic()
            turns = (
                waking.drain()
            )  # first: what comes in between is seen, or counted with the next look
            pause = LOOK_S if self._watched is not None and not self._is_told else _BEFORE_S
            if now - looked >= pause:
                looked = now
                if self._ask() != where:
                    return
                seen = eye.look()
                if self._session(seen, tails):
                    turns = waking.drain()
                    seen = eye.look()
                texts = seen.texts
                if is_first and self._watched is None:
                    yield nothing_yet(self._cell, seen, _why(where, seen))
                is_first = False
                self._looked = True
            else:
                texts = eye.texts()
            watched = self._watched
            if watched is not None and not self._is_told:
                is_new = looked == now
                if is_new:
                    watched.take(list(tails.look()))
                    if watched.is_late:
                        watched = self._anew(watched, tails)
                t = self._time()
                changes = {names[n]: k for n, k in turns.items() if n in names}
                watched.see(t, texts, changes if waking.counts and "" not in turns else None)
                if now - told >= UPDATE_S and is_new:
                    told = now
                    yield from self._tell(watched, seen, t)
            waking.wait(LOOK_S)

    def _session(self, seen: Seen, tails: Tails) -> bool:
        """Whether another session has begun."""
        known = self._watched.session if self._watched is not None else ""
        if not seen.session or seen.session == known:
            return False
        if self._watched is not None:
            self._watched.close()
        tails.start_over()
        are_first = all(_is_first(text) for text in seen.texts.values())
        self._is_from_start = self._looked and are_first
        self._is_running = seen.sides[self._parties[0]].state is Life.RUNS
        self._began = seen.began
        # As journals count: whoever sets the clock later does not move what has happened.
        self._since = seen.began - (time.time() - time.monotonic())
        self._watched = self._begun(seen.session)
        self._ended_at, self._is_told = None, False
        return True

    def _anew(self, before: Watched, tails: Tails) -> Watched:
        """The same session from its beginning: a trace has come whose steps were inferred already."""
        before.close()
        tails.start_over()
        self._watched = watched = self._begun(before.session)
        watched.take(list(tails.look()))
        return watched

    def _begun(self, session: str) -> Watched:
        return Watched(self._cell, session, self._began, is_from_start=self._is_from_start)

    def _time(self) -> float:
        """Seconds since the session began; 0 where nobody knows: then the traces say it."""
        return max(time.monotonic() - self._since, 0.0) if self._is_running else 0.0

    def _tell(self, watched: Watched, seen: Seen, t: float) -> Iterator[Json]:
        now = time.monotonic()
        supervisor = seen.sides[self._parties[0]]
        if supervisor.state is Life.RUNS:
            self._ended_at = None
            yield watched.update(t, seen, None)
            return
        if self._ended_at is None:
            self._ended_at = now
            self._stood = t
        if now - self._ended_at < LAST_S:
            yield watched.update(self._stood, seen, None)
            return
        self._is_told = True
        yield watched.update(self._stood, seen, _verdict(watched, seen, supervisor.state))


def _is_first(text: str | None) -> bool:
    """Whether a channel is empty, or holds the first message of its session."""
    line = (text or "").partition("\n")[2].split()
    return text is not None and (text.strip() == "0" or line[:2] == ["#", "1"])


def _verdict(watched: Watched, seen: Seen, state: Life) -> Json:
    """How a session has ended."""
    last = watched.last_word
    reason = str(last.get("reason", ""))[:400]
    final = [str(p) for p in last.get("final", []) if isinstance(p, str)]
    finished = {"word": "finished", "reason": "", "final": final, "failed": watched.failed(final)}
    match state:
        case Life.FINISHED:
            return finished
        case Life.STOPPED:
            side = next(iter(seen.sides.values()))
            return {"word": "stopped", "reason": side.reason[:400] or reason, "final": []}
        case Life.DIED:
            text = "the supervisor has died: it says that it runs, but its process is gone"
            return {"word": "died", "reason": text, "final": []}
    if last.get("why") == "finished":
        return finished
    if last:
        return {"word": str(last.get("why", "ended"))[:40], "reason": reason, "final": []}
    text = "its shared files are gone, and nobody has said why"
    return {"word": "gone", "reason": text, "final": []}


def _why(where: Where, seen: Seen) -> str:
    """Why there is nothing to be seen."""
    if not seen.is_there and where.run is not None and (where.run / SUMMARY).exists():
        page = where.run / replay_page.NAME
        there = f"what it did is in {page}" if page.exists() else "its shared files are gone"
        return (
            f"the last run in {where.run} has ended, and {there}; the next one is shown by itself"
        )
    if not seen.is_there:
        return f"the folder {where.shared} does not exist yet; the page goes on by itself"
    return f"no supervisor has announced itself in {where.shared}; the page goes on by itself"
