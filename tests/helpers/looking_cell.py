"""The cell that carries parts, with a robot that looks, by a sensor, whether there is one before it fetches it.

The feeder brings one box, and forgets the others.

net = changed(NET, *LOOKING)        # of `carrying_cell`
toml = TOML + SENSOR
"""

from __future__ import annotations

LOOKING = (
    ("  var n : PART;", "  colset ANSWER = product PART * BOOL;\n  var n : PART;\n  var there : BOOL;"),
    ("    place Done : PART\n    trans Accept", "    place Done : PART\n    place Asked : ANSWER\n    trans Accept"),
    ("    trans Place code", "    trans Look\n      in Told : n\n      out Asked : (n, there)\n"
     "    trans Skip\n      in Asked : (n, false)\n      out Done : n\n    trans Place code"),
    ("      in Told : n\n      out Done : n", "      in Asked : (n, true)\n      out Done : n"),
    ("    trans Feed code", "    trans Forget guard [n <> 1]\n      in Busy : n\n      out fed : n\n"
     "      out Idle : ()\n    trans Feed guard [n = 1] code"),
)  # fmt: skip
"""What is changed in the net."""
SENSOR = '[sensors.eye]\nvariable = "there"\nsees = "infeed"\npart = "box"\n'
"""What sees whether a box is there."""
ELSEWHERE = """
[zones.tip]
pose = { x = 1.35, z = 1.37 }
size = [0.2, 0.2, 0.2]
[zones.aside]
pose = { x = -2.0, z = 1.0 }
size = [0.2, 0.2, 0.2]
[devices.feeder.axes.flap]
kind = "swing"
pose = { x = 3.0 }
from = 0.0
to = 90.0
home = 30.0
objects = [{ name = "leaf", size = [0.2, 0.02, 0.2], pose = { z = 0.5 } }]
"""
"""What else can be seen: a zone in which the tool of the arm is at HOME, one far from it, and a flap at 30 degrees."""


def changed(net: str, *changes: tuple[str, str]) -> str:
    """The net with each of these texts, all of which are there, replaced once."""
    for old, new in changes:
        assert old in net, old
        net = net.replace(old, new, 1)
    return net
