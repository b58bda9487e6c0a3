"""Sensors that look at a place where no part can ever stand: in a run they always say the same.

    blind(cell, config, " in layout `paper`", d)

A part comes into the cell at the start (`at`) or where a primitive creates it, and stays there unless a tool takes it
or something moves. Where tools put parts down is known only in a run, so nothing is said of kinds that are carried.
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.cell import codes
from pn2code.cell.config import CellConfig
from pn2code.diagnostics import Diagnostics
from pn2code.robot.commands import Pose
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import difference, matrix_of


def blind(cell: RobotCell, config: CellConfig, where: str, d: Diagnostics) -> None:
    """Warns of each of them.

    Args:
        cell: robots, parts and places in a layout.
        config: the cell.
        where: the layout in words.
        d: gets the warnings.
    """
    for sensor in config.sensors:
        if not sensor.sees or sensor.sees not in cell.places:
            continue
        kinds = [k for k in cell.parts if sensor.part in ("", k)]
        comes = {k: list(_entries(cell, config, k)) for k in kinds}
        what = f"part of kind `{sensor.part}`" if sensor.part else "part"
        at = config.locator.origin("sensors", sensor.name, "sees")
        if not any(comes.values()):
            d.warning(
                codes.SENSOR_BLIND,
                f"sensor `{sensor.name}` always says `false`{where}: no {what} ever comes into the cell",
                at,
                hint="let a tool action create one (`creates`, `at`), or give the kind of parts `at`",
            )
        elif not any(_may_be_moved(config, k) for k in kinds if comes[k]) and not any(
            _is_near(cell, sensor.sees, k, pose) for k in kinds for pose in comes[k]
        ):
            d.warning(
                codes.SENSOR_BLIND,
                f"sensor `{sensor.name}` always says `false`{where}: no {what} comes into the cell at `{sensor.sees}`, "
                "and no tool takes one there",
                at,
                hint="look where the parts come (`at` of `creates`, or of the kind of parts)",
            )


def _entries(cell: RobotCell, config: CellConfig, kind: str) -> Iterator[Pose]:
    """Where parts of a kind come into the cell."""
    yield from cell.parts[kind].at
    for primitive in config.primitives.values():
        h = primitive.handling
        if h is not None and (h.effect, h.part) == ("creates", kind) and h.place in cell.places:
            yield cell.places[h.place]


def _may_be_moved(config: CellConfig, kind: str) -> bool:
    return any(
        p.command == "move_external"
        or (p.handling is not None and (p.handling.effect, p.handling.part) == ("takes", kind))
        for p in config.primitives.values()
    )


def _is_near(cell: RobotCell, place: str, kind: str, pose: Pose) -> bool:
    apart, _ = difference(matrix_of(pose), matrix_of(cell.places[place]))
    return apart <= cell.parts[kind].tolerance
