"""What the server is told of a run: pictures, each with all that is new since the last one that went through.

    tap = Tap(handing, robot_cell, count)
    run_cell(path, options, d, [tap])

An observer of the run on the wall clock. It looks into the records that the run keeps anyway, and remembers how far it
has told them; so a picture that is left out costs nothing and loses nothing. Nothing here waits.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from typing import Any

from pn2code.live.handing import Handing
from pn2code.replay import cell as cells
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import Array, inverse, matrix_of
from pn2code.run.command_words import kind_and_label
from pn2code.run.engine import Engine
from pn2code.run.realtime import RealtimeEngine
from pn2code.run.record import ActionRecord, PartRecord, RunRecord
from pn2code.run.runner import RobotRunner

Json = dict[str, Any]

PICTURE_S = 0.05
"""Between two pictures (s of the wall clock)."""
MOST = 2000
"""Entries of one kind in a picture; the rest comes with the next ones."""
LAST_S = 2.0
"""How long the last picture may take."""


class Tap:
    """An observer (`run.observer.Observer`).

    Args:
        handing: where pictures go.
        robot_cell: the arms.
        count: the tool actions that the cell counts, with their labels.
    """

    def __init__(self, handing: Handing, robot_cell: RobotCell, count: Mapping[str, str]) -> None:
        self._handing = handing
        self._cell = robot_cell
        self._arms = {r.name: r for r in robot_cell.robots}
        self._labels = {action: label for label, action in count.items()}
        self._told: dict[str, int] = {}
        self._joints: Mapping[str, Array] = {}
        self._sampled_at = 0.0
        self._next = 0.0
        self._left_out = 0
        self._frames: dict[tuple[str, int], Json | None] = {}
        self._seen = {"actions": 0, "parts": 0}
        self._first: Json = {}

    def begun(self, engine: Engine) -> None:
        """The header of the trace says with what the net begins."""
        self._first = {"header": {**engine.supervisor_trace.header, "by": "run"}}
        self.advanced(engine)

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None:
        """The arms stood like this."""
        self._joints = {name: q.copy() for name, q in joints.items()}
        self._sampled_at = t

    def advanced(self, engine: Engine) -> None:
        """Tells what is new, if it is time, and if the last picture has gone."""
        self._place(engine)
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + PICTURE_S
        if self._handing.is_free():
            self._picture(engine, {})
        else:
            self._left_out += 1

    def ended(self, engine: Engine) -> None:
        """The last words, for which the run may wait: nothing moves any more."""
        record = engine.record
        verdict = {
            "word": record.verdict,
            "reason": record.reason,
            "final": list(record.final),
            "failed": list(record.failed),
        }
        self._place(engine)
        while self._handing.finish(LAST_S):
            is_all = self._picture(engine, {})
            if is_all:
                break
        if self._handing.finish(LAST_S):
            self._picture(engine, {"verdict": verdict})
        self._handing.finish(LAST_S)

    # --- a picture -------------------------------------------------------------------------------

    def _picture(self, engine: Engine, more: Json) -> bool:
        """Hands a picture over; whether it has all that there is."""
        assert isinstance(engine, RealtimeEngine)
        first_of_all, self._first = self._first, {}
        record = engine.record
        lists: dict[str, Sequence[Any]] = {
            "fired": engine.fired,
            "noted": engine.noted,
            "actions": record.actions,
            "activities": record.activities,
            "traffic": record.traffic,
            "parts": record.parts,
            "warnings": record.warnings,
            "gaps": record.gaps,
        }
        new = {name: self._since(name, rows) for name, rows in lists.items()}
        first = {n: self._told.get(n, 0) - len(new[n]) for n in ("actions", "parts")}
        picture: Json = {
            **first_of_all,
            **new,
            "t": engine.now,
            "marks": self._framed("actions", first["actions"], len(new["actions"])),
            "places": self._framed("parts", first["parts"], len(new["parts"])),
            "joints": (self._sampled_at, {n: q.tolist() for n, q in self._joints.items()}),
            "series": {
                name: values[-1] if values and math.isfinite(values[-1]) else None
                for name, values in record.series.items()
            },
            "sides": [_supervisor(engine), *(_side(engine, r) for r in engine.robots)],
            "doing": [_doing(r) for r in engine.robots if r.motion is not None],
            "activity": engine.activity,
            "punctuality": engine.punctuality.described(),
            "left_out": self._left_out,
            "broken": _broken(record),
            "hand": None if engine.hand is None else engine.hand.told(),
            **more,
        }
        self._handing.give(picture)
        return all(self._told[name] >= len(rows) for name, rows in lists.items())

    def _since(self, name: str, rows: Sequence[Any]) -> list[Any]:
        told = self._told.get(name, 0)
        new = list(rows[told : told + MOST])
        self._told[name] = told + len(new)
        return new

    # --- frames that only the run knows ------------------------------------------------------------

    def _place(self, engine: Engine) -> None:
        """Where marks and parts are that have come since the last look: the arms still stand there."""
        record = engine.record
        for i in range(self._seen["actions"], len(record.actions)):
            self._frames["actions", i] = self._mark(record.actions[i], record.parts)
        for i in range(self._seen["parts"], len(record.parts)):
            self._frames["parts", i] = self._part(record.parts[i])
        self._seen = {"actions": len(record.actions), "parts": len(record.parts)}

    def _framed(self, kind: str, first: int, count: int) -> list[Json]:
        found = [self._frames.pop((kind, i), None) for i in range(first, first + count)]
        return [f for f in found if f is not None]

    def _tcp(self, robot: str) -> Array | None:
        arm, q = self._arms.get(robot), self._joints.get(robot)
        if arm is None or q is None:
            return None
        return arm.T_world_base @ arm.kinematics.forward(q)

    def _mark(self, action: ActionRecord, parts: Sequence[PartRecord]) -> Json | None:
        if action.kind != "tool" or action.label not in self._labels:
            return None
        tcp = self._tcp(action.robot)
        if tcp is None:
            return None
        arm = self._arms[action.robot]
        tcp = arm.of_tool(cells.tool_in_use(arm, parts, action.end), tcp)
        return {
            "t": action.end,
            "robot": action.robot,
            "label": self._labels[action.label],
            "frame": cells.frame(tcp),
        }

    def _part(self, entry: PartRecord) -> Json:
        change = entry.change
        state: Json = {"t": entry.t, **cells.put(self._cell, change, entry.robot)}
        tcp = self._tcp(entry.robot)
        if change.effect == "takes" and tcp is not None:
            state["frame"] = cells.frame(inverse(tcp) @ matrix_of(change.pose))
            state["holder"] = entry.robot
        elif change.effect == "removes":
            state["frame"] = None
        return {"name": change.part, "state": state}


def _broken(record: RunRecord) -> Json | None:
    """The zone in which something was too fast, by its name and as `run.json` has it."""
    found = record.too_fast
    return None if found is None else {"zone": found.zone, **found.described()}


def _supervisor(engine: RealtimeEngine) -> Json:
    state = "runs" if engine.supervisor.running else "has ended"
    text = engine.activity
    return {"name": "supervisor", "state": state, "text": text, "line": 0, "since": None}


def _side(engine: RealtimeEngine, robot: RobotRunner) -> Json:
    """What a robot or device is doing, in words."""
    if robot.finished:
        return {
            "name": robot.name,
            "state": "has ended",
            "text": "its script is at its end",
            "line": 0,
            "since": None,
        }
    is_held = engine.hand is not None and engine.hand.holds(robot.name)
    if robot.asking is not None:
        return {
            "name": robot.name,
            "state": "asks",
            "text": f"what sensor {robot.asking.sensor} sees",
            "line": robot.asking.line,
            "since": None,
        }
    if robot.motion is not None:
        text = kind_and_label(robot.motion.command)[1]
        return {
            "name": robot.name,
            "state": "is held" if is_held else "works",
            "text": text,
            "line": robot.line,
            "since": robot.motion.began,
        }
    waiting = robot.waiting
    text = f"for {' or '.join(waiting.names)}" if waiting else ""
    return {
        "name": robot.name,
        "state": "is held" if is_held else "waits",
        "text": text,
        "line": waiting.line if waiting else 0,
        "since": None,
    }


def _doing(robot: RobotRunner) -> Json:
    """A command under way, as a bar without an end."""
    motion = robot.motion
    assert motion is not None
    kind, label = kind_and_label(motion.command)
    return {
        "robot": robot.name,
        "kind": kind,
        "label": label,
        "start": motion.began,
        "line": robot.line,
        "transition": robot.element_at(robot.line),
        "activity": robot.activity,
    }
