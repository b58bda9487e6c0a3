"""A conveyor brings boxes: each comes onto the beginning of the belt, which runs until the first one is at its stop.

folder = belt_cell(tmp_path / "cell")
"""

from __future__ import annotations

from pathlib import Path

from helpers import carrying_cell

NET = carrying_cell.NET.replace(
    "  fun feed () = ();\n", "  fun feed () = ();\n  fun run () = ();\n"
).replace("action (feed ())", "action (feed (); run ())")
_TABLE = '[scene]\nobjects = [{ name = "table", size = [0.4, 0.4, 0.5], pose = { x = 1.5, y = -0.6, z = 0.25 } }]\n'
_FEEDER = '[devices.feeder]\ninstance = "Feeder"\n'
assert _TABLE in carrying_cell.TOML and _FEEDER in carrying_cell.TOML
TOML = (
    carrying_cell.TOML.replace(_TABLE, "")
    .replace(
        _FEEDER,
        _FEEDER
        + """
[devices.feeder.axes.belt]
kind = "belt"
pose = { x = 1.5, y = -1.7, z = 0.5, yaw = 90.0 }
length = 1.3
width = 0.4
height = 0.3
speed = 0.25
stop = "infeed"
""",
    )
    .replace('at = "infeed" }', 'at = "entry" }')
    .replace(
        "[robots.robot]",
        'run = { command = "move_external", axis = "belt", to = 1.2 }\n[robots.robot]',
    )
    + "[places.entry]\nx = 1.5\ny = -1.5\nz = 0.575\n"
)


def belt_cell(folder: Path, net: str = NET, toml: str = TOML) -> Path:
    """The cell as files; gives the folder."""
    return carrying_cell.write(folder, net, toml)


LINE = TOML.replace("length = 1.3\n", 'length = 0.6\ndrives = ["away"]\n').replace(
    'stop = "infeed"\n',
    """
[devices.feeder.axes.away]
kind = "belt"
pose = { x = 1.5, y = -1.1, z = 0.5, yaw = 90.0 }
length = 0.7
width = 0.4
height = 0.3
stop = "infeed"
""",
)
"""The same with a belt of two pieces: the first one drives the second one, which has the stop."""
