"""A cell whose robot stacks boxes, on the floor and on its turntable; what it does with each is said by the caller."""

from __future__ import annotations

from pathlib import Path

from helpers import carrying_cell

TOML = (
    carrying_cell.TOML.replace(
        "[devices.feeder]",
        """[robots.robot.axes.plate]
kind = "turntable"
pose = { x = 1.5, y = 0.6, z = 0.4 }
from = -180.0
to = 180.0
radius = 0.4
[devices.feeder]""",
    )
    .replace(
        "grips = [{ z = 0.075, roll = 180.0 }]",
        "grips = [{ z = 0.075, roll = 180.0 }, { z = 0.075, roll = 180.0, yaw = 90.0 }, "
        "{ z = 0.075, roll = 180.0, yaw = -90.0 }]",
    )
    .replace(
        'moveHome = { command = "move_home" }',
        'moveHome = { command = "move_home" }\n'
        'turn = { command = "move_external", turntable = "plate" }',
    )
    .replace('takes = "box"', 'takes = "box"')
)
PRIMITIVES = "fun moveHome () = ();\n  fun turn (degrees : real) = ();"


def stacking_cell(folder: Path, actions: list[str], parts: int = 2) -> Path:
    """The cell, in which the robot fetches each box and then does what the action of its number says."""
    cases = " else ".join(f"if n = {i + 1} then ({act})" for i, act in enumerate(actions))
    net = carrying_cell.NET.replace("fun moveHome () = ();", PRIMITIVES)
    net = net.replace(
        "  var n : PART;",
        f"""  fun put (x, y, z) = (go (at (x, y, z)); release (); moveLinear (up (at (x, y, z))));
  fun pick (x, y, z) = (go (at (x, y, z)); grip (); moveLinear (up (at (x, y, z))));
  fun act n = {cases} else ();
  var n : PART;""",
    )
    net = net.replace(
        "(fetch (); go (slot n); release (); moveLinear (up (slot n)))", "(fetch (); act n)"
    ).replace("val parts = 2;", f"val parts = {parts};")
    return carrying_cell.write(folder, net, TOML)
