"""Looking for a covering run while the explorer works, in a thread of low priority.

with Meanwhile(net, {}) as search:
    search.note(12_000)             # so many markings were found: it begins
    search.found                    # a Covering, as soon as there is one
"""

from __future__ import annotations

import os
import threading
from collections.abc import Collection, Mapping
from contextlib import suppress
from typing import Self

from pn2code.base.deadline import Deadline
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.enabling import GameError
from pn2code.verify.exploring.covering import Covering, Search

FROM_STATES = 5_000
"""A smaller state space is explored before a walk would come upon anything."""
LAST_SECONDS = 5.0
"""Of the search after an exploration that came to a limit."""
_STACK = 64 << 20
_NICE = 10
_LEAVE_S = 2.0
"""A walk looks at each step whether to end; one that computes for longer is left behind."""


class Meanwhile:
    """A search for a covering run; a context manager, which ends it.

    Args:
        net, storage: as for `Game`.
        among: the places that may grow; None: all.
    """

    def __init__(
        self, net: FlatNet, storage: Mapping[str, str], among: Collection[int] | None = None
    ) -> None:
        self._net = net
        self._storage = storage
        self._among = among
        self._ends = threading.Event()
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
        if states < FROM_STATES or self._thread is not None:
            return
        before = threading.stack_size(_STACK)
        try:
            self._thread = threading.Thread(target=self._look, daemon=True)
            self._thread.start()
        finally:
            threading.stack_size(before)

    def stop(self) -> None:
        """Ends the thread."""
        self._ends.set()
        if self._thread is not None:
            self._thread.join(_LEAVE_S)

    def last(self, deadline: Deadline) -> Covering | None:
        """What is known after an exploration that came to a limit; a search that has not begun is made now."""
        if self._thread is None:
            own = Deadline.after(LAST_SECONDS)
            with suppress(GameError):  # the explorer has said so
                self.found = self._search().look(lambda: own.is_over() or deadline.is_over())
        else:
            self.stop()
        return self.found

    def _look(self) -> None:
        with suppress(OSError, AttributeError):  # a system without priorities of threads
            os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _NICE)
        with suppress(GameError):  # the explorer has said so
            self.found = self._search().look(self._ends.is_set)

    def _search(self) -> Search:
        return Search(self._net, self._storage, self._among)
