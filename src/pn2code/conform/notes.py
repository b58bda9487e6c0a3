"""What a run notes of its robots and devices (docs/trace.md), beside what the net makes them do.

notes = RunNotes(config, partition)
replay(trace, net, parties=parties, notes=notes)

Between two steps of a robot stand its tools' actions and what its sensors said. The actions have to be those that the
net orders in the later step; of each variable that the net leaves open there, a sensor must have said the value.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.conform.disturbed import Disturbed
from pn2code.net.flat import BindAll, BindRandom, FlatTransition
from pn2code.primitive_calls import Calls, Listener
from pn2code.robot.commands import ToolAction
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.trace.parties import RUN

_Action = tuple[str, float]
_ROUNDING_S = 0.01
"""Times in a trace are rounded; a robot's own notes and steps are by one clock."""


class RunNotes:
    """Follows the notes of one trace.

    Args:
        config: the cell.
        partition: who runs what.
    """

    def __init__(self, config: CellConfig, partition: Partition) -> None:
        self._primitives = config.primitives
        self._variables = {s.name: s.variable for s in config.sensors}
        self._owner = partition.transition_owner
        self._names = [o.name for o in partition.owners]
        self._actions: dict[str, list[_Action]] = {name: [] for name in self._names[1:]}
        self._handled: dict[str, list[tuple[str, str]]] = {name: [] for name in self._names[1:]}
        self._created = Counter(config.parts_at_start)
        self._holder = {
            f"{kind}.{i + 1}": "" for kind, count in self._created.items() for i in range(count)
        }
        self._holder |= config.tools_at_start
        self._busy_until = dict.fromkeys(self._names[1:], 0.0)
        self._said: dict[str, dict[str, Any]] = {name: {} for name in self._names[1:]}
        self._disturbed = Disturbed(config, partition)
        self._calls = Calls()
        self._listener: Listener | None = None

    def begin(self, game: Game, by: str) -> None:
        """Only the traces of whole runs have notes."""
        if by == RUN:
            self._listener = Listener(game, self._primitives)

    def note(self, line: Mapping[str, Any]) -> str | None:
        """One more note; whose it is must be known."""
        if self._listener is None:
            return None
        robot = str(line.get("robot"))
        if robot not in self._actions:
            return f"there is no robot or device `{robot}`"
        if line["event"] in ("hold", "stand", "message"):
            return self._disturbed.note(line)
        if line["event"] == "tool":
            begun, duration = float(line["t"]), float(line["duration"])
            stands = self._disturbed.begins(robot, begun)
            if stands is not None:
                return stands
            if begun < self._busy_until[robot] - _ROUNDING_S:
                return f"`{robot}` is still at its tool's action before, until {self._busy_until[robot]:g} s"
            self._busy_until[robot] = begun + duration
            self._actions[robot].append((str(line.get("action")), duration))
            return None
        if line["event"] == "part":
            return self._part(robot, str(line["effect"]), str(line["part"]))
        variable = self._variables.get(str(line.get("sensor")))
        if variable is None:
            return f"there is no sensor `{line.get('sensor')}`"
        if variable in self._said[robot]:
            return f"sensor `{line['sensor']}` gave two values for one step of `{robot}`"
        self._said[robot][variable] = line.get("value")
        return None

    def _part(self, robot: str, effect: str, part: str) -> str | None:
        """What has become of a part: it has the next number of its kind, and one holder at most."""
        kind = part.rpartition(".")[0] or part  # of a tool there is one
        if effect == "creates":
            self._created[kind] += 1
            if part != f"{kind}.{self._created[kind]}":
                return f"the next part `{kind}` is `{kind}.{self._created[kind]}`, not `{part}`"
        elif part not in self._holder:
            return f"`{robot}` {effect} part `{part}`, which is not there"
        holder = self._holder.pop(part, "")
        if holder != (robot if effect in ("releases", "uncouples") else ""):
            return f"`{robot}` {effect} part `{part}`, which {f'`{holder}`' if holder else 'nobody'} holds"
        if effect != "removes":
            self._holder[part] = robot if effect in ("takes", "couples") else ""
        self._handled[robot].append((effect, kind))
        return None

    @contextmanager
    def occurring(self) -> Iterator[None]:
        """Hears what is ordered."""
        self._calls = Calls()
        if self._listener is None:
            yield
            return
        with self._listener.noting(self._calls):
            yield

    def step(
        self, line: Mapping[str, Any], t: FlatTransition, before: Marking, after: Marking
    ) -> str | None:
        """The notes since the last step of the same robot are those of this one."""
        owner = self._owner[t.index]
        if self._listener is None:
            return None
        problem = self._disturbed.step(line, t, before, after)
        if problem is not None or owner == 0:
            return problem
        robot = self._names[owner]
        ordered = [(c.action, c.duration) for c in self._calls if isinstance(c, ToolAction)]
        noted, self._actions[robot] = self._actions[robot], []
        if noted != ordered:
            return f"the net makes `{robot}` do {_text(ordered)}, the notes before it say {_text(noted)}"
        handled, self._handled[robot] = self._handled[robot], []
        wanted = [
            (c.handling.effect, c.handling.part)
            for c in self._calls
            if isinstance(c, ToolAction) and c.handling
        ]
        if handled != wanted:
            return (
                f"the net makes `{robot}` do this to parts: {_parts_text(wanted)}; the notes before it say: "
                f"{_parts_text(handled)}"
            )
        if ordered and line["t"] < self._busy_until[robot] - _ROUNDING_S:
            return (
                f"it ends at {line['t']:g} s, but the last action of the tool of `{robot}` in it only at "
                f"{self._busy_until[robot]:g} s"
            )
        said, self._said[robot] = self._said[robot], {}
        binding = line["binding"]
        chosen = {s.symbol.name for s in t.plan if isinstance(s, BindAll | BindRandom)}
        for variable in sorted(chosen & {*self._variables.values()} | said.keys()):
            if variable not in said:
                return f"`{variable}` is left to a sensor, but none gave a value"
            if variable not in binding:
                return (
                    f"a sensor gave a value for `{variable}`, which is not a variable of the step"
                )
            if not _equal(said[variable], binding[variable]):
                return f"a sensor has said {said[variable]!r}, but `{variable}` is {binding[variable]!r}"
        return None

    def end(self, game: Game, why: str) -> str | None:
        """Nothing is left over when a run has finished, but of a robot that had not come to its end."""
        if self._listener is None or why != "finished":
            return None
        for robot, owner in zip(self._names[1:], range(1, len(self._names)), strict=True):
            left = self._actions[robot] or self._said[robot] or self._disturbed.left(robot)
            if left and not self._goes_on(game, owner):
                return f"the notes of `{robot}` at the end belong to no step"
        return self._disturbed.held()

    def _goes_on(self, game: Game, owner: int) -> bool:
        try:
            enabled = game.enabled_in(game.advance_time(game.marking))
            return any(self._owner[e.transition] == owner for e in enabled)
        except GameError:
            return True


def _equal(a: object, b: object) -> bool:
    return a == b and isinstance(a, bool) == isinstance(b, bool)


def _parts_text(handled: Sequence[tuple[str, str]]) -> str:
    return ", ".join(f"it {effect} a `{kind}`" for effect, kind in handled) or "nothing"


def _text(actions: list[_Action]) -> str:
    return ", ".join(f"`{name}` for {seconds:g} s" for name, seconds in actions) or "nothing"
