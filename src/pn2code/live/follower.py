"""The token game follows the traces of a cell that runs elsewhere, as far as there are traces.

    follower = Follower(partition, config.storage, occurred)
    follower.begin({"trace": 1, "by": "supervisor", ...}, t)
    follower.add({"t": 1.25, "transition": "Cell.Robot1.Accept", "binding": {...}})
    follower.advance(1.3)

Lines of different programs come in any order. A line is played when the net allows it; what a program without a trace
must have done before is inferred (`inferred`), and counted. A line that stays impossible is played nevertheless: then
the token game says what is wrong.
"""

from __future__ import annotations

import json
import math
from collections import deque
from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from typing import Any

from pn2code.base.closing import Closing
from pn2code.cell.partition import Partition
from pn2code.live.inferred import InferredStep, explain
from pn2code.live.player import Player
from pn2code.net.flat import FlatTransition
from pn2code.semantics.game.marking import BindingElement, Marking, binding_to_json
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.colour_json import JsonError, from_json
from pn2code.trace.replay import replay_lines
from pn2code.trace.replay_result import ReplayResult

PATIENCE_S = 2.0
"""A line that is not possible waits so long for others that come before it."""
MOST_WAITING = 100_000

Line = dict[str, Any]
Occurred = Callable[[Game, BindingElement | None, Mapping[str, Any]], None]


class Follower(Closing):
    """Plays lines.

    Args:
        partition: the cell.
        storage: how colour sets of reals are stored.
        occurred: sees the game at its beginning (without an element) and after each step, with the line.

    Attributes:
        traced: the owners that write traces.
        inferred: how many steps were inferred.
        wrong: what the net does not allow; "" as long as there is nothing.
        game: once it has begun.
    """

    def __init__(
        self, partition: Partition, storage: Mapping[str, str], occurred: Occurred
    ) -> None:
        self._partition = partition
        self._occurred = occurred
        self._transitions = {t.name: t for t in partition.net.transitions}
        self._waiting: list[deque[Line]] = [deque() for _ in partition.owners]
        self._stuck_since: float | None = None
        self._unexplained: tuple[int, str] | None = None
        self.traced: set[int] = set()
        self.inferred = 0
        self.wrong = ""
        self.game: Game | None = None
        net = partition.net
        self._player: Player[ReplayResult] = Player(
            lambda lines: replay_lines(lines, net, storage, watch=self._watch)
        )

    def _watch(self, game: Game, occurred: BindingElement | None, line: Mapping[str, Any]) -> None:
        self.game = game
        self._occurred(game, occurred, line)

    def begin(self, header: Line) -> None:
        """The first line says with what the net begins."""
        self._play({**header, "by": "run"})

    def add(self, line: Line) -> bool:
        """A line of a trace; False: it is none of this net, or there are too many."""
        t = self._transitions.get(str(line.get("transition")))
        number = line.get("t")
        if t is None or isinstance(number, bool) or not isinstance(number, int | float):
            return False
        row = self._waiting[self._partition.transition_owner[t.index]]
        if not math.isfinite(number) or len(row) >= MOST_WAITING:
            return False
        row.append({**line, "t": float(number), "origin": t.id})
        return True

    def advance(self, now: float) -> None:
        """Plays what can have happened; `now` is any clock that goes on (s)."""
        while self.game is not None and not self.wrong and (heads := self._heads()):
            line = next((line for line in heads if self._is_possible(line)), None)
            if line is None and not self._explain(heads[0]):
                self._stuck_since = now if self._stuck_since is None else self._stuck_since
                if now - self._stuck_since < PATIENCE_S:
                    return
                line = heads[0]
            self._stuck_since = None
            if line is not None:
                self._waiting[self._owner(line)].popleft()
                self._play(line)

    def infer(
        self, t: float, is_goal: Callable[[Marking], bool], arrivals: Mapping[int, int]
    ) -> bool:
        """Plays a shortest run of all parties to a marking that is a goal; whether there is one.

        Args:
            t: when.
            is_goal: says so of a marking.
            arrivals: how many messages must come on the way, by place.
        """
        assert self.game is not None
        transitions = self._partition.net.transitions
        path = explain(self.game, self._at(t), transitions, is_goal, arrivals=arrivals)
        self._follow(path or [], t)
        return path is not None

    # --- lines -----------------------------------------------------------------------------------

    def _heads(self) -> list[Line]:
        return sorted((row[0] for row in self._waiting if row), key=lambda line: float(line["t"]))

    def _owner(self, line: Line) -> int:
        return self._partition.transition_owner[self._transitions[line["transition"]].index]

    def _is_possible(self, line: Line) -> bool:
        assert self.game is not None
        element = self._element(line)
        return element is None or self._allows(self._at(line["t"]), element)

    def _allows(self, marking: Marking, element: BindingElement) -> bool:
        assert self.game is not None
        try:
            return self.game.why_disabled(marking, element, priorities=False) is None
        except GameError:
            return False

    def _element(self, line: Line) -> BindingElement | None:
        """None: the token game will say what is wrong with it."""
        t = self._transitions[line["transition"]]
        given = line.get("binding")
        outputs = t.code.outputs if t.code else ()
        found = {}
        for s in t.variables:
            if s in outputs:
                continue
            if not isinstance(given, dict) or s.name not in given or s.colset is None:
                return None
            try:
                found[s] = from_json(s.colset, given[s.name])
            except JsonError:
                return None
        return BindingElement.make(t, found)

    def _at(self, t: float) -> Marking:
        """The current marking, with the clock of the line."""
        assert self.game is not None
        marking = self.game.marking
        if not self._partition.net.timed:
            return marking
        time = t if self._partition.net.real_time else math.floor(t + 1e-9)
        return replace(marking, time=max(marking.time, time))

    def _explain(self, line: Line) -> bool:
        """Plays what parties without traces must have done so that a line is possible; whether that is known."""
        transitions = self._untraced()
        element = self._element(line)
        assert self.game is not None
        asked = (self.game.steps, json.dumps(line))
        if not transitions or element is None or asked == self._unexplained:
            return False
        at = self._at(line["t"])
        path = explain(self.game, at, transitions, lambda marking: self._allows(marking, element))
        if not path:
            self._unexplained = asked
            return False
        self._follow(path, line["t"])
        return True

    def _untraced(self) -> list[FlatTransition]:
        owner = self._partition.transition_owner
        return [t for t in self._partition.net.transitions if owner[t.index] not in self.traced]

    def _follow(self, path: Collection[InferredStep], t: float) -> None:
        for step in path:
            of = self._partition.net.transitions[step.element.transition]
            self.inferred += 1
            binding = binding_to_json(step.element)
            line = {"t": t, "transition": of.name, "binding": binding, "origin": of.id}
            self._play({**line, "inferred": True})

    def _play(self, line: Line) -> None:
        plain = {k: v for k, v in line.items() if k != "step"}
        result = self._player.play(json.dumps(plain))
        if result is not None and not result.ok and not self.wrong:
            at = f"step {result.steps + 1}, {result.transition}: " if result.transition else ""
            self.wrong = f"{at}the net does not allow it: {result.why}"

    def close(self) -> None:
        """No more lines."""
        self._player.close()
