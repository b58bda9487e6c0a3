"""The description of a cell that has run (`pn2code run`).

described = describe(result, motion, document)
"""

from __future__ import annotations

import json

from pn2code.reading.document import Document
from pn2code.replay import cell, happenings, net, programs
from pn2code.replay.arrays import packed, packed_reals
from pn2code.replay.description import VERSION, Json, facts
from pn2code.replay.motion import Motion
from pn2code.replay.trace import follow
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import inverse, matrix_of
from pn2code.run.record import NEAR, RunRecord
from pn2code.run.results import RunResult


def describe(result: RunResult, motion: Motion, document: Document) -> Json:
    """Everything about a run.

    Args:
        result: what `run_cell` gave.
        motion: the observer that was there.
        document: the net as its author drew it.
    """
    record, prepared = result.record, result.prepared
    partition, config = prepared.generated.partition, prepared.config
    flat = partition.net
    lines = [json.dumps(line) for line in (record.header, *record.events)]
    course, refused = follow(lines, flat, config.storage)
    robot_cell = prepared.robot_cell
    described: Json = {
        "pn2code": {"run": VERSION},
        "kind": "run",
        "title": flat.name,
        "clock": "seconds",
        "end": record.time,
        "verdict": {
            "word": record.verdict,
            "reason": record.reason,
            "final": list(record.final),
            "failed": list(record.failed),
        },
        "facts": facts(result.summary),
        "net": net.describe(document, flat),
        "course": {**course.described(), "refused": refused, "loop": None},
        "happenings": happenings.describe(
            record, partition, config, robot_cell.scene.warning_clearance
        ),
        "programs": programs.describe(prepared.generated.files, flat),
        "cell": None,
        "motion": None,
    }
    if robot_cell.moving:
        described["cell"] = {
            **cell.describe(robot_cell),
            "parts": _parts(record, robot_cell, motion),
            "gaps": _gaps(record, robot_cell.motion.sample),
            "marks": _marks(record, robot_cell, motion, dict(config.report.count)),
        }
        for zone in described["cell"]["zones"]:
            if record.too_fast is not None and record.too_fast.zone == zone["name"]:
                zone["broken"] = record.too_fast.described()
        described["motion"] = motion.described()
    return described


def _parts(record: RunRecord, robot_cell: RobotCell, motion: Motion) -> list[Json]:
    """Of each part where it is from when on: in the world, in the tool of a robot, on a turntable, or nowhere."""
    arms = {r.name for r in robot_cell.robots}
    states = {name: [state] for name, state in cell.at_start(robot_cell).items()}
    for entry in record.parts:
        change = entry.change
        state: Json = {"t": entry.t, **cell.put(robot_cell, change, entry.robot)}
        if change.effect == "takes" and entry.robot in arms:
            arm = robot_cell.robot(entry.robot)
            tcp = arm.T_world_base @ arm.kinematics.forward(motion.at(entry.robot, entry.t))
            state["frame"] = cell.frame(inverse(tcp) @ matrix_of(change.pose))
            state["holder"] = entry.robot
        elif change.effect == "removes":
            state["frame"] = None
        states.setdefault(change.part, []).append(state)
    return [
        {"name": name, "kind": name.split(".")[0], "states": rows} for name, rows in states.items()
    ]


def _gaps(record: RunRecord, step: float) -> Json:
    """What was near to what, from when on: the pair, the distance (m), and the nearest points of both."""
    pairs = {(g.a, g.b): 0 for _, g in record.gaps}
    number = {pair: i for i, pair in enumerate(pairs)}
    return {
        "pairs": [list(pair) for pair in pairs],
        "step": step,
        "near": NEAR,
        "t": packed_reals((t for t, _ in record.gaps), double=True),
        "pair": packed(number[g.a, g.b] for _, g in record.gaps),
        "distance": packed_reals(g.distance for _, g in record.gaps),
        "points": packed_reals(v for _, g in record.gaps for v in (*g.point, *g.other)),
    }


def _marks(
    record: RunRecord, robot_cell: RobotCell, motion: Motion, count: dict[str, str]
) -> list[Json]:
    """A mark where the TCP was whenever a tool action ended that the cell counts (`[report] count`)."""
    labels = {action: label for label, action in count.items()}
    arms = {r.name: r for r in robot_cell.robots}
    rows = []
    for action in record.actions:
        if action.kind == "tool" and action.label in labels and action.robot in arms:
            arm = arms[action.robot]
            tool = cell.tool_in_use(arm, record.parts, action.end)
            own = arm.kinematics.forward(motion.at(action.robot, action.end))
            tcp = arm.T_world_base @ arm.of_tool(tool, own)
            rows.append(
                {
                    "t": action.end,
                    "robot": action.robot,
                    "label": labels[action.label],
                    "frame": cell.frame(tcp),
                }
            )
    return rows
