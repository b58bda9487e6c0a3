"""Who plays: each page has a seat with a game of its own, and a thread that carries out its commands one by one.

seats = Seats(loaded, seed=1)
seat = seats.take("", tell)               # a new game; with the name of a seat whose page has gone, that one
"""

from __future__ import annotations

import secrets
import shutil
import tempfile
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from pn2code.play import saving
from pn2code.play.commands import Player, Tell
from pn2code.play.loading import Loaded
from pn2code.play.questions import Question, ask
from pn2code.play.session import Session
from pn2code.play.trouble import Json, Trouble
from pn2code.play.typed_texts import Typist

MOST_SEATS = 24
KEPT_S = 900.0
"""Seconds for which the game of a page is kept that has gone: it may be loaded again."""
MOST_WAITING = 200
"""Commands of a page that wait for those before them."""


class Full(Exception):
    """All seats are taken."""


class Seat:
    """A page and its game.

    Args:
        name: nobody guesses it.
        session: the game.
        folder: of its files.
    """

    def __init__(self, name: str, session: Session, folder: Path) -> None:
        self.name = name
        self.session = session
        self.folder = folder
        self.worker = ThreadPoolExecutor(max_workers=1, thread_name_prefix="play")
        self.tell: Tell = _nobody
        self.player = Player(session, lambda said: self.tell(said))
        self.is_taken = False
        self.left_at = 0.0
        self.waiting = 0
        self.asking: threading.Event | None = None
        self.answers: dict[int, Path] = {}
        self._asked = 0

    def ask(self, loaded: Loaded, typist: Typist, said: Json, number: int) -> Json:
        """Answers a question about the net; is called in a thread of its own."""
        stop = self.asking
        assert stop is not None
        folder = self.folder / f"asked-{number}"
        text = said.get("property")
        try:
            if not isinstance(text, str) or not text.strip():
                raise Trouble("a property is expected, e.g. `deadlock free`")

            def tell(nodes: int, arcs: int, what: str) -> None:
                self.tell({"asking": number, "nodes": nodes, "arcs": arcs, "what": what})

            done = ask(loaded, typist, Question(text), folder, tell, stop.is_set)
            trace = done.pop("trace")
            if trace:
                self.answers[number] = Path(trace)
            return {"answer": number, "ok": True, **done, "shown": bool(trace)}
        except Trouble as trouble:
            return {"answer": number, "ok": False, "message": trouble.message, "rows": trouble.rows}
        finally:
            self.asking = None

    def next_question(self) -> int:
        """The number of a question."""
        self._asked += 1
        return self._asked

    def close(self) -> None:
        """Nobody comes back."""
        self.session.close()
        if self.asking is not None:
            self.asking.set()
        self.worker.shutdown(wait=False, cancel_futures=True)
        shutil.rmtree(self.folder, ignore_errors=True)


def _nobody(said: Json) -> None:
    """There is no page."""


class Seats:
    """All games of a net.

    Args:
        loaded: the net, free of errors.
        seed: with which each begins.
        trace: a trace that each begins with; None: the initial marking.
        most: how many there are at most.
    """

    def __init__(
        self, loaded: Loaded, *, seed: int, trace: Path | None = None, most: int = MOST_SEATS
    ) -> None:
        assert loaded.opened is not None and loaded.elaborator is not None
        self.loaded = loaded
        self.typist = Typist(loaded.opened.flat, loaded.elaborator)
        self.folder = Path(tempfile.mkdtemp(prefix="pn2code-play-"))
        self._seed = seed
        self._trace = trace
        self._most = most
        self._seats: dict[str, Seat] = {}
        self._ready: list[Seat] = []
        self._lock = threading.Lock()

    def take(self, name: str, clock: Callable[[], float] = time.monotonic) -> tuple[Seat, bool]:
        """The seat of a page: that of this name, if nobody is on it, or a new one; and whether it is new.

        Raises:
            Full: there are too many.
            GameError: the net cannot be started.
            Trouble: the trace that all begin with cannot be loaded.
        """
        with self._lock:
            self._tidy(clock())
            known = self._seats.get(name)
            if known is not None and not known.is_taken:
                known.is_taken = True
                return known, False
            if len(self._seats) >= self._most and not self._free_one():
                raise Full
            seat = self._ready.pop() if self._ready else self._new()
            seat.is_taken = True
            self._seats[seat.name] = seat
            return seat, True

    def prepare(self) -> Seat:
        """A game for the first page, so that what is wrong is known before there is one.

        Raises:
            GameError, Trouble, OSError: as `take`.
        """
        seat = self._new()
        self._ready.append(seat)
        return seat

    def _new(self) -> Seat:
        name = secrets.token_urlsafe(16)
        folder = self.folder / name
        folder.mkdir()
        session = Session(self.loaded, self.typist, seed=self._seed, folder=folder)
        if self._trace is not None:
            session.notices.append(saving.load(session, self._trace))
        return Seat(name, session, folder)

    def find(self, name: str) -> Seat | None:
        """The seat of this name."""
        return self._seats.get(name)

    def leave(self, seat: Seat, clock: Callable[[], float] = time.monotonic) -> None:
        """The page of a seat has gone; it may come back."""
        with self._lock:
            seat.is_taken = False
            seat.left_at = clock()
            seat.tell = _nobody
            seat.session.stop.set()

    def _tidy(self, now: float) -> None:
        for seat in list(self._seats.values()):
            if not seat.is_taken and now - seat.left_at > KEPT_S:
                self._drop(seat)

    def _free_one(self) -> bool:
        """Gives up the game whose page has been away for the longest time."""
        away = [s for s in self._seats.values() if not s.is_taken]
        if not away:
            return False
        self._drop(min(away, key=lambda s: s.left_at))
        return True

    def _drop(self, seat: Seat) -> None:
        del self._seats[seat.name]
        seat.close()

    def close(self) -> None:
        """The end of all games."""
        with self._lock:
            for seat in list(self._seats.values()):
                self._drop(seat)
            for seat in self._ready:
                seat.close()
        shutil.rmtree(self.folder, ignore_errors=True)
