"""What robots and devices do, written while they do it: a trace that grows, for whoever watches.

    journal = Journal(path, "robot1", session="9f3ac01d", began=shared.began, speed=1.0)
    journal.mark("Cell.Robot1.Accept", {"c": 1}, "ID1412311125")
    journal.command("robot1", "linear", "linear", line=18, lasts=2.5)
    journal.arm("robot1", q)
    journal.did(...)
    journal.end("finished")

Its lines are those of docs/trace.md, with notes that only `pn2code watch` reads (`command`, `did`, `arm`, `said`).
Times are seconds of the wall clock since the supervisor has announced itself, so that they fit those of its own trace.
"""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

ARM_S = 0.05
"""Between two lines about the same arm."""
_DIGITS = 5
"""Of angles (rad): 0.06 mm at the end of an arm of three metres."""


class Journal:
    """A file to which lines are added, each at once. A disk that is full ends the journal, not the robot.

    Args:
        path: the file; what was in it is gone.
        by: who writes.
        session: of the supervisor; "": not known.
        began: when the supervisor announced itself (s, as `time.time` counts).
        speed: seconds of the caller's clock in a second of the wall clock.
    """

    def __init__(
        self, path: Path, by: str, *, session: str, began: float, speed: float = 1.0
    ) -> None:
        self._speed = speed
        self._steps = 0
        self._since = began - (time.time() - time.monotonic())
        self._stood: dict[str, tuple[float, list[float]]] = {}
        self._file = path.open("w", encoding="utf-8")
        self.is_broken = False
        self._line({"trace": 1, "by": by, "session": session, "began": began})

    @property
    def now(self) -> float:
        """Seconds since the supervisor announced itself."""
        return max(time.monotonic() - self._since, 0.0)

    def mark(self, transition: str, binding: dict[str, Any], origin: str) -> None:
        """A transition of the net has occurred."""
        self._steps += 1
        self._line(
            {
                "step": self._steps,
                "t": round(self.now, 4),
                "transition": transition,
                "binding": binding,
                "origin": origin,
            }
        )

    def command(self, robot: str, kind: str, label: str, line: int, lasts: float) -> None:
        """A command begins, and is expected to last so long."""
        self._note("command", robot=robot, kind=kind, label=label, line=line, lasts=round(lasts, 4))

    def did(self, robot: str, kind: str, label: str, line: int, began: float) -> None:
        """A command has ended; `began` as `now` said it."""
        self._note("did", robot=robot, kind=kind, label=label, line=line, start=round(began, 4))

    def sensed(self, robot: str, sensor: str, value: object, by: str = "") -> None:
        """What a sensor has said, and who has chosen it."""
        more = {"by": by} if by else {}
        self._note("sense", robot=robot, sensor=sensor, value=value, **more)

    def arm(self, robot: str, q: Sequence[float]) -> None:
        """How an arm stands (rad): not too often, and not where it stood already."""
        now = self.now
        at, before = self._stood.get(robot, (-ARM_S, []))
        joints = [round(float(v), _DIGITS) for v in q]
        if now - at < ARM_S or joints == before:
            return
        self._stood[robot] = (now, joints)
        self._note("arm", robot=robot, q=joints)

    def zone(self, name: str, link: str, speed: float, point: Sequence[float]) -> None:
        """Something was too fast in a zone: which link, how fast (m/s), and the point of it (m)."""
        place = [round(v, 6) for v in point]
        self._note("zone", zone=name, link=link, speed=round(speed, 6), point=place)

    def end(self, robot: str, why: str, reason: str = "") -> None:
        """This is how it ended."""
        self._note("said", robot=robot, why=why, reason=reason)

    def close(self) -> None:
        """No more lines."""
        with suppress(OSError):
            self._file.close()

    def _note(self, event: str, **more: Any) -> None:
        self._line({"t": round(self.now, 4), "event": event, **more})

    def _line(self, line: dict[str, Any]) -> None:
        if self.is_broken:
            return
        try:
            self._file.write(json.dumps(line, ensure_ascii=False) + "\n")
            self._file.flush()
        except OSError:
            self.is_broken = True
