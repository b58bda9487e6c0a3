"""What a person should look at, while a cell runs: each matter once, when it begins."""

from __future__ import annotations

from typing import Any

from pn2code.base.conditioning import condition_text
from pn2code.run.record import APART

Json = dict[str, Any]

_OVER = 0.9
"""A matter is over when its value is better than the limit by this factor."""


class Alarms:
    """Notices what is beyond its limit.

    Args:
        condition: condition numbers above this are warned of.
        near: clearances below this are warned of (m).
    """

    def __init__(self, condition: float, near: float) -> None:
        self.condition, self.near = condition, near
        self.count = 0
        self._open: set[str] = set()
        self._new: list[Json] = []
        self._said: set[str] = set()

    def ended(self, t: float, verdict: Json) -> None:
        """How the cell has come to its end, unless that is what is wanted."""
        if verdict["word"] != "finished":
            self.fault(t, "", verdict["reason"] or verdict["word"])
        elif verdict.get("failed"):
            names = [x for x in verdict["failed"] if x in verdict.get("final", ())]
            where = f" in {', '.join(names)}" if names else ""
            others = [x for x in verdict["failed"] if x not in names]
            why = f", a failure: {'; '.join(others)}" if others else ""
            self.fault(t, "", f"the cell has ended{where}{why}")

    def fault(self, t: float, party: str, text: str) -> None:
        """Something that stops the cell, or must not be."""
        if text not in self._said:
            self._said.add(text)
            self._add(t, "fault", party, text)

    def look(self, t: float, picture: Json) -> None:
        """Looks at a picture."""
        for name, value in picture["series"].items():
            kind, _, robot = name.partition(".")
            if kind != "condition":
                continue
            if value is not None and value > self.condition:
                words = (
                    f"comes close to a singularity: condition number {condition_text(value)} "
                    f"(warning above {self.condition:g})"
                )
                self._once(name, t, robot, words)
            elif value is not None and value < _OVER * self.condition:
                self._open.discard(name)
        for at, gap in picture["gaps"]:
            key = f"{gap.a} {gap.b}"
            if gap.distance < self.near:
                words = (
                    f"{gap.a} and {gap.b} are {1000 * gap.distance:.1f} mm apart "
                    f"(warning below {1000 * self.near:g} mm)"
                )
                self._once(key, at, gap.robot or "", words)
            elif APART > gap.distance > self.near / _OVER:  # what is nearest may change to and fro
                self._open.discard(key)
        for warning in picture["warnings"]:
            self._add(warning.t, "warning", warning.robot, warning.text)

    def news(self) -> list[Json]:
        """What has come since the last call."""
        new, self._new = self._new, []
        return new

    def _once(self, key: str, t: float, party: str, text: str) -> None:
        if key not in self._open:
            self._open.add(key)
            self._add(t, "warning", party, text)

    def _add(self, t: float, kind: str, party: str, text: str) -> None:
        self.count += 1
        self._new.append({"t": t, "kind": kind, "party": party, "text": text})
