"""What a run notes of robots that stood still, and of messages that were late or lost (docs/trace.md).

disturbed = Disturbed(config, partition)
disturbed.note({"t": 1.0, "event": "stand", "robot": "robot1", "duration": 22.5})
disturbed.step({"t": 9.0, ...}, t, before, after)     # "`robot1` stood until 23.5 s"

A robot that stood for some seconds in a command is not at its end before. A message that was lost is taken by nobody,
one that was late not before it came. A script marks its step and writes then, so that the note of a message follows
the step that sends it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from pathlib import PurePosixPath
from typing import Any

from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Channel, Partition
from pn2code.net.flat import FlatTransition
from pn2code.semantics.game.marking import Marking
from pn2code.trace.lines import SKEW_S

PERSON = "person"
"""Who holds robots and delays messages."""
_LATE, _LOST = "late", "lost"
_ROUNDING_S = 0.01


class Disturbed:
    """Follows the notes of one trace.

    Args:
        config: the cell.
        partition: who runs what, and which channels there are.
    """

    def __init__(self, config: CellConfig, partition: Partition) -> None:
        self._owner = partition.transition_owner
        self._names = [o.name for o in partition.owners]
        registers = {c.file for c in config.channels if c.is_register}
        self._registers = {PurePosixPath(file).stem for file in registers}
        self._channels = {c.name: c for c in partition.channels if c.file not in registers}
        self._sent: Counter[str] = Counter()
        self._taken: Counter[str] = Counter()
        self._just_sent: dict[str, set[str]] = {name: set() for name in self._names}
        self._due: dict[str, dict[int, float | None]] = {name: {} for name in self._channels}
        self._stood_at: dict[str, float] = {}
        self._stood_until: dict[str, float] = {}
        self._held: set[str] = set()

    def note(self, line: Mapping[str, Any]) -> str | None:
        """One more note of a robot or device that is known."""
        robot = str(line["robot"])
        if line.get("by", PERSON) != PERSON:
            return f"it says that `{line['by']}` has chosen it, but only a `{PERSON}` can"
        match line["event"]:
            case "hold":
                if robot in self._held:
                    return f"`{robot}` stands already"
                self._held.add(robot)
                return None
            case "stand":
                return self._stand(robot, line)
            case _:
                return self._message(robot, line)

    def _stand(self, robot: str, line: Mapping[str, Any]) -> str | None:
        begun, duration = float(line["t"]), float(line["duration"])
        if duration < 0.0:
            return f"`{robot}` stood for {duration:g} s"
        if "by" in line:
            if robot not in self._held:
                return f"`{robot}` stood, but nobody held it"
            self._held.discard(robot)
            return None
        same_command = self._stood_at.get(robot) == begun
        since = self._stood_until[robot] if same_command else begun
        if not same_command and begun < self._stood_until.get(robot, 0.0) - _ROUNDING_S:
            return self.stands(robot, begun)
        self._stood_at[robot], self._stood_until[robot] = begun, since + duration
        return None

    def left(self, robot: str) -> bool:
        """Whether there are notes of stops since the last step of a robot or device."""
        return robot in self._stood_at

    def held(self) -> str | None:
        """Whoever is held stands until the run ends, and a note says so."""
        return (
            f"`{min(self._held)}` was held, and no note says for how long" if self._held else None
        )

    def stands(self, robot: str, t: float) -> str | None:
        """Whether a robot or device cannot have come to the end of its command: it stood in it for longer."""
        until = self._stood_until.get(robot, 0.0)
        if t >= until - _ROUNDING_S:
            return None
        return f"`{robot}` stood in a command until {until:g} s at least, but this is at {t:g} s"

    def begins(self, robot: str, t: float) -> str | None:
        """The same of a command that begins: its own stops are noted before it, at the same time."""
        return None if self._stood_at.get(robot) == t else self.stands(robot, t)

    def _message(self, robot: str, line: Mapping[str, Any]) -> str | None:
        fate, name = line["fate"], str(line["channel"])
        if fate not in (_LATE, _LOST):
            return f"a message is `{_LATE}` or `{_LOST}`, not `{fate}`"
        if (fate == _LATE) != ("seconds" in line) or line.get("seconds", 0.0) < 0.0:
            return "it says how many seconds a message is late, if it is, and only then"
        if name in self._registers:
            return None
        channel = self._channels.get(name)
        if channel is None or self._names[channel.writer] != robot:
            return f"`{robot}` writes no channel `{name}`"
        if name not in self._just_sent[robot] or self._taken[name] >= self._sent[name]:
            return f"the last step of `{robot}` has sent no message on `{name}` of which this can be said"
        self._just_sent[robot].discard(name)
        comes = None if fate == _LOST else float(line["t"]) + float(line["seconds"])
        self._due[name][self._sent[name]] = comes
        return None

    def step(
        self, line: Mapping[str, Any], t: FlatTransition, before: Marking, after: Marking
    ) -> str | None:
        """A step, and the markings around it."""
        owner = self._owner[t.index]
        robot = self._names[owner]
        problem = self.stands(robot, line["t"])
        if problem is not None:
            return problem
        self._just_sent[robot] = set()
        self._stood_at.pop(robot, None)
        for channel in self._channels.values():
            more = len(after.places[channel.place]) - len(before.places[channel.place])
            if more > 0 and channel.writer == owner:
                self._sent[channel.name] += more
                self._just_sent[robot].add(channel.name)
            elif more < 0 and channel.reader == owner:
                problem = problem or self._take(channel, line["t"])
        return problem

    def _take(self, channel: Channel, t: float) -> str | None:
        """The next message that is not lost is taken."""
        due, name = self._due[channel.name], channel.name
        self._taken[name] += 1
        while self._taken[name] < self._sent[name] and due.get(self._taken[name], 0.0) is None:
            self._taken[name] += 1
        comes = due.get(self._taken[name], 0.0)
        if comes is None:
            return f"it takes the message on `{name}` that was lost"
        if t < comes - SKEW_S:
            return f"it takes the message on `{name}` at {t:g} s, but that came at {comes:g} s"
        return None
