"""Looking for a covering run while the explorer works, in a thread of low priority.

with Meanwhile(net, {}) as search:
    search.note(12_000)             # so many markings were found: it begins
    search.found                    # a Covering, as soon as there is one

Whether one is found does not depend on who is quicker: after an exploration that came to a limit, the search goes on
until it has done its part.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from typing import Self

from pn2code.net.flat import FlatNet
from pn2code.semantics.game.errors import GameError
from pn2code.verify.exploring.covering import MOST_WORK, Covering, Search

FROM_STATES = 5_000
"""A smaller state space is explored before a walk would come upon anything."""
_STACK = 64 << 20
_NICE = 10
_LEAVE_S = 0.5
"""A walk looks at each step whether to end; one that computes for longer is left behind."""
_LOOK_S = 0.05


class Meanwhile:
    """A search for a covering run; a context manager, which ends it.

    Args:
        net, storage: as for `Game`.
        among: the places that may grow; None: all.
        is_limited: whether the exploration may come to a limit of its own. Else the search goes on for longer: without
            a limit there is no other end of an infinite state space.
        time_alone: whether a run counts in which nothing but the time is another.
    """

    def __init__(
        self,
        net: FlatNet,
        storage: Mapping[str, str],
        among: Collection[int] | None = None,
        *,
        is_limited: bool = True,
        time_alone: bool = False,
    ) -> None:
        self._net = net
        self._storage = storage
        self._among = among
        self._is_limited = is_limited
        self._time_alone = time_alone
        self._ends = threading.Event()
        self._is_waited_for = threading.Event()
        self._thread: threading.Thread | None = None
        self.found: Covering | None = None
        self.is_heard = False
        """whether the explorer that works now has said how far it is, and so listens to signals"""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def note(self, states: int) -> None:
        """So many markings are known: from some thousands on the search begins."""
        self.is_heard = True
        if states >= FROM_STATES:
            self._begin()

    def stop(self) -> None:
        """Ends the thread; it is waited for once."""
        has_ended = self._ends.is_set()
        self._ends.set()
        if self._thread is not None and not has_ended:
            self._thread.join(_LEAVE_S)

    def last(self, is_over: Callable[[], bool]) -> Covering | None:
        """What is known after an exploration that came to a limit: the search does its part first.

        Args:
            is_over: asked from time to time whether there is no time for that; if so at once, nothing begins.
        """
        if self._thread is None and is_over():
            return None
        self._is_waited_for.set()
        thread = self._begin()
        while thread.is_alive() and not is_over():
            thread.join(_LOOK_S)
        self.stop()
        return self.found

    def _begin(self) -> threading.Thread:
        if self._thread is None:
            before = threading.stack_size(_STACK)
            try:
                self._thread = threading.Thread(target=self._look, daemon=True)
                self._thread.start()
            finally:
                threading.stack_size(before)
        return self._thread

    def _look(self) -> None:
        if not self._is_waited_for.is_set():
            with suppress(OSError, AttributeError):  # a system without priorities of threads
                os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _NICE)
        with suppress(GameError):  # the explorer has said so
            search = Search(self._net, self._storage, self._among, time_alone=self._time_alone)

            def is_over() -> bool:
                has_done = self._is_limited or self._is_waited_for.is_set()
                return self._ends.is_set() or (has_done and search.work >= MOST_WORK)

            self.found = search.look(is_over)
