"""What does not change while a cell runs: net, programs, arms, parties. The rest of a description comes in updates."""

from __future__ import annotations

from typing import Any

from pn2code.pipeline import Generated
from pn2code.reading.document import Document
from pn2code.replay import cell, net, programs
from pn2code.replay.description import VERSION
from pn2code.robot.robot_cell import RobotCell
from pn2code.run.record import NEAR

Json = dict[str, Any]


def describe(generated: Generated, robot_cell: RobotCell, document: Document, speed: float) -> Json:
    """A description (docs/replay.md) of a run in which nothing has happened yet.

    Args:
        generated: the programs of a cell.
        robot_cell: its arms.
        document: its net as drawn.
        speed: seconds of the run in a second of the wall clock.
    """
    partition, config = generated.partition, generated.config
    described: Json = {
        "pn2code": {"run": VERSION},
        "kind": "run",
        "title": partition.net.name,
        "clock": "seconds",
        "speed": speed,
        "end": 0.0,
        "verdict": {"word": "", "reason": "", "final": [], "failed": []},
        "facts": [["layout", config.layout if config else ""]],
        "net": net.describe(document, partition.net),
        "happenings": {
            "parties": [{"name": o.name, "kind": o.kind.value} for o in partition.owners],
            "owners": list(partition.transition_owner),
            "bars": [],
            "activities": [],
            "messages": [],
            "events": [],
            "curves": [],
        },
        "programs": programs.describe(generated.files, partition.net),
        "cell": None,
        "motion": None,
    }
    if robot_cell.moving:
        described["cell"] = {
            **cell.describe(robot_cell),
            "parts": [
                {
                    "name": name,
                    "kind": name.split(".")[0],
                    "states": [state],
                }
                for name, state in cell.at_start(robot_cell).items()
            ],
            "gaps": {
                "pairs": [],
                "step": robot_cell.motion.sample,
                "near": NEAR,
                "t": [],
                "pair": [],
                "distance": [],
                "points": [],
            },
            "marks": [],
        }
        described["motion"] = {
            r.name: {"t": [0.0], "q": [float(v) for v in r.home]} for r in robot_cell.moving
        }
    return described
