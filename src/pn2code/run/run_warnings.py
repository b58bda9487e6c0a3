"""What a run warns of when it is over: arms close to singularities, and to each other."""

from __future__ import annotations

from pn2code.base.conditioning import condition_text
from pn2code.cell.config import CellConfig
from pn2code.robot.robot_cell import RobotCell
from pn2code.run.record import RunRecord, RunWarning


def warn(record: RunRecord, config: CellConfig, cell: RobotCell) -> None:
    """Conditioning above the configured bound, in one warning a robot: where it begins and how bad it gets."""
    limit = config.report.warn_condition
    for robot in config.robots:
        values = record.series.get(f"condition.{robot.name}", [])
        above = [i for i, v in enumerate(values) if v > limit]
        if above:
            worst = max(above, key=values.__getitem__)
            elbow = record.series[f"elbow.{robot.name}"][worst]
            wrist = record.series[f"wrist.{robot.name}"][worst]
            straight = cell.robot(robot.name).kinematics.straightness(elbow, wrist)
            record.warnings.append(
                RunWarning(
                    record.sample_t[above[0]],
                    robot.name,
                    "comes close to a singularity for the first time; it is closest at "
                    f"{record.sample_t[worst]:.2f} s: condition number {condition_text(values[worst])}"
                    f"{straight} (warning above {limit:g})",
                )
            )

    for (a, b), (gap, t) in sorted(record.near.items()):
        record.warnings.append(RunWarning(t, a.split("/")[0], _nearness(a, b, 1000 * gap)))


def _nearness(a: str, b: str, gap: float) -> str:
    """Of two parts and their distance in mm, negative where one is in the other."""
    if gap < 0:
        return f"`{a}` is {-gap:.1f} mm deep in `{b}`"
    return f"`{a}` comes within {gap:.1f} mm of `{b}`"
