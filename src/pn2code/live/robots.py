"""Robots and devices as their journals show them (`run.journal`): commands, arms, sensors, what is counted."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.emission.output import Block
from pn2code.replay import cell as cells
from pn2code.replay import happenings
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import Array
from pn2code.run.command_words import KINDS

Json = dict[str, Any]


class Robots:
    """Takes lines of journals. Lines that are not as they should be raise ValueError, TypeError or KeyError."""

    def __init__(
        self,
        config: CellConfig,
        robot_cell: RobotCell,
        partition: Partition,
        blocks: Mapping[str, tuple[Block, ...]],
    ) -> None:
        self._party = {o.name: o.index for o in partition.owners if o.index}
        self._arms = {r.name: r for r in robot_cell.moving}
        self._number = {t.name: t.index for t in partition.net.transitions}
        self._blocks = blocks
        self._labels = {action: label for label, action in dict(config.report.count).items()}
        self._counts = dict.fromkeys(dict(config.report.count), 0)
        self._doing: dict[int, Json] = {}
        self._recorded: set[int] = set()
        self._joints: dict[str, list[float]] = {}
        self._at = 0.0
        self._bars: list[Json] = []
        self._marks: list[Json] = []
        self._all_marks: list[Json] = []

    def take(self, line: Json) -> Json | None:
        """A note of a journal; what is an event for the page."""
        event = line["event"]
        if event not in ("command", "did", "arm", "sense", "said"):
            return None
        t, party = float(line["t"]), self._party[line["robot"]]
        if not math.isfinite(t):
            raise ValueError(t)
        self._recorded.add(party)
        match event:
            case "command":
                self._doing[party] = self._bar(line, party, t)
            case "did":
                self._doing.pop(party, None)
                self._done(line, party, t)
            case "arm":
                self._stand(line["robot"], line["q"], t)
            case "said":
                self._doing.pop(party, None)
            case _:
                return happenings.noted(
                    {**line, "sensor": str(line["sensor"]), "value": line["value"]}
                )
        return None

    def _bar(self, line: Json, party: int, start: float) -> Json:
        if line["kind"] not in KINDS:
            raise ValueError(line["kind"])
        at = int(line["line"])
        transition = self._number.get(self._element(line["robot"], at), -1)
        label = str(line["label"])[:200]
        return {
            "party": party,
            "kind": line["kind"],
            "label": label,
            "start": start,
            "line": at,
            "transition": transition,
            "activity": "",
        }

    def _done(self, line: Json, party: int, t: float) -> None:
        start = float(line["start"])
        if not 0.0 <= start <= t + 1.0:
            raise ValueError(start)
        bar = self._bar(line, party, min(start, t))
        self._bars.append({**bar, "end": t})
        label = self._labels.get(bar["label"]) if bar["kind"] == "tool" else None
        if label is not None:
            self._counts[label] += 1
            tcp = self._tcp(line["robot"])
            if tcp is not None:
                frame = cells.frame(tcp)
                self._marks.append({"t": t, "robot": line["robot"], "label": label, "frame": frame})

    def _stand(self, robot: str, q: Any, t: float) -> None:
        joints = [float(v) for v in q]
        if robot not in self._arms or len(joints) != len(self._arms[robot].home):
            raise ValueError(robot)
        if not all(math.isfinite(v) for v in joints):
            raise ValueError(robot)
        self._joints[robot] = joints
        self._at = max(self._at, t)

    def _tcp(self, robot: str) -> Array | None:
        arm, q = self._arms.get(robot), self._joints.get(robot)
        if arm is None or q is None:
            return None
        return arm.T_world_base @ arm.kinematics.forward(q)

    def _element(self, robot: str, line: int) -> str:
        """The net transition that a script line implements, "" if none."""
        rows = self._blocks.get(robot, ())
        inside = [b for b in rows if b.kind == "transition" and b.first <= line <= b.last]
        return min(inside, key=lambda b: b.last - b.first).element if inside else ""

    # --- what is told ----------------------------------------------------------------------------

    def is_recorded(self, party: int) -> bool:
        """Whether there is a journal of it."""
        return party in self._recorded

    def has_moved(self, party: int) -> bool:
        """Whether the journal says how its arm stands."""
        return any(self._party[name] == party for name in self._joints)

    def doing(self, party: int) -> Json | None:
        """The command under way, for the state of the side."""
        bar = self._doing.get(party)
        return bar and {"text": bar["label"], "line": bar["line"], "since": bar["start"]}

    def news(self, t: float) -> Json:
        """What has come since the last call."""
        bars, self._bars = self._bars, []
        marks, self._marks = self._marks, []
        self._all_marks = [*self._all_marks, *marks][-2000:]
        return {
            "bars": bars,
            "marks": marks,
            "doing": list(self._doing.values()),
            "joints": (min(self._at, t), dict(self._joints)),
            "series": {
                f"condition.{name}": self._condition(name)
                for name in self._joints
                if not self._arms[name].is_device
            },
            "counts": dict(self._counts),
        }

    def _condition(self, robot: str) -> float | None:
        found = self._arms[robot].kinematics.conditioning(self._joints[robot]).condition
        return float(found) if math.isfinite(found) else None

    def begin_again(self) -> None:
        """The next news are for pages that know nothing."""
        self._marks = [*self._all_marks, *self._marks]
        self._all_marks = []
