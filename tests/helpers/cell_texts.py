"""Pieces of cell.toml that many cells of the tests have.

toml = head("order", "done") + "[robots.arm] ..."
toml = head("f1", "d1", page="Top.", order="documented")
"""

from __future__ import annotations


def head(*places: str, page: str = "", order: str = "") -> str:
    """The net, the supervisor and a channel for each of these places; `order`: of `[supervisor]`."""
    text = (
        '\n[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]\n'
    )
    if order:
        text += f'order = "{order}"\n'
    for place in places:
        text += f'[[channel]]\nplace = "{page}{place}"\nfile = "{place}.robcad"\n'
    return text


GOING = """\
goTo = { command = "move_joint" }
line = { command = "move_linear", frame = "world", speed = 0.25 }
home = { command = "move_home" }
grip = { command = "tool", action = "grip", duration_s = 0.5, takes = "blank" }
release = { command = "tool", action = "release", duration_s = 0.3, releases = "blank" }
"""
"""Primitives of an arm that brings blanks to a machine."""
ARM = """\
[robots.arm]
instance = "Arm"
model = "gp25"
tool = "vacuum_gripper"
base = { z = 0.3 }
home = [0.0, 0.0, 0.0, 0.0, -90.0, 0.0]
"""
