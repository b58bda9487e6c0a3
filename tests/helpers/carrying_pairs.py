"""Random cells of two arms that both carry boxes, each from one place to another and perhaps back.

net, toml = carrying_pair(Random(3))

Ways may cross, boxes may be put down beside each other, half of the cells have a zone where people may be, and whether
only one arm is let in at a time is left to chance.
"""

from __future__ import annotations

import math
from random import Random

from helpers import meeting_cell

Place = tuple[float, float]
"""mm on the floor."""
SIZES = ((0.2, 0.2, 0.15), (0.5, 0.2, 0.15), (0.25, 0.25, 0.3))
APART = 3000.0
"""mm between the bases."""
LONGEST = 600.0
"""mm: boxes that are no nearer than this at the start do not touch."""
DECLARED = """\
  fun grip () = ();
  fun release () = ();
  fun pt (x, y, z, rz) : POSE = {x = x, y = y, z = z, rx = 180.0, ry = 0.0, rz = rz};
"""
PRIMITIVES = """\
grip = { command = "tool", action = "suck", duration_s = 0.5, takes = "box" }
release = { command = "tool", action = "blow", duration_s = 0.3, releases = "box" }
"""
WORK = 'work = { command = "tool", action = "work", duration_s = 1.0 }\n'


def carrying_pair(random: Random) -> tuple[str, str]:
    """The net and the cell.toml."""
    size = random.choice(SIZES)
    top = 1000.0 * size[2]
    places = {side: [_place(random, side), _place(random, side)] for side in (1, 2)}
    while math.dist(places[1][0], places[2][0]) < LONGEST:
        places[2][0] = _place(random, 2)
    if random.random() < 0.4:
        x, y = places[1][1]
        places[2][1] = (x + random.choice([220.0, 260.0, 530.0]), y)
    visits = "".join(_visit(random, side, places[side], top) for side in (1, 2))
    net = meeting_cell.NET.replace("  fun work () = ();\n", DECLARED)
    first, last = net.index("  fun at (z"), net.index("  var n : INT")
    net = net[:first] + visits + net[last:]
    for side, turn in ((1, "0.0"), (2, "180.0")):
        net = net.replace(f"action (visit {turn})", f"action (visit{side} n)")
    if random.random() < 0.5:  # there, and not back
        net = net.replace("guard [n > 0]", "guard [n > 1]").replace(
            "guard [n = 0]", "guard [n = 1]"
        )
    is_guarded = random.random() < 0.35
    take, give = ("in Free : ()", "out Free : ()") if is_guarded else ("", "")
    return net.replace("TAKE", take).replace("GIVE", give), _toml(random, size, places)


def _place(random: Random, side: int) -> Place:
    x = random.uniform(1000.0, 1750.0)
    return (x if side == 1 else APART - x), random.uniform(-700.0, 700.0)


def _visit(random: Random, side: int, places: list[Place], top: float) -> str:
    """What a robot does at each of its commands: the first one takes the box there, the second one back."""
    up = random.uniform(400.0, 700.0)
    between = ""
    height = random.uniform(350.0, 900.0)
    for move in random.choice([(), ("moveJoint",), ("moveJoint", "moveLinear")]):
        between += f"{move} ({_pose(_place(random, side), height, side)}); "
    home = "; moveHome ()" if random.random() < 0.5 else ""

    def job(start: Place, end: Place) -> str:
        over, on = _pose(start, up, side), _pose(start, top, side)
        there, down = _pose(end, up, side), _pose(end, top, side)
        return (
            f"(moveJoint ({over}); moveLinear ({on}); grip (); moveLinear ({over}); {between}"
            f"moveJoint ({there}); moveLinear ({down}); release (); moveLinear ({there}){home})"
        )

    one, other = places
    return f"  fun visit{side} n = if n = 2 then {job(one, other)} else {job(other, one)};\n"


def _pose(place: Place, z: float, side: int) -> str:
    numbers = (*place, z, 0.0 if side == 1 else 180.0)
    return f"pt ({', '.join(f'{v:.1f}'.replace('-', '~') for v in numbers)})"


def _toml(random: Random, size: tuple[float, ...], places: dict[int, list[Place]]) -> str:
    half = size[2] / 2.0
    at = ", ".join(
        f"{{ x = {x / 1000.0:.4f}, y = {y / 1000.0:.4f}, z = {half} }}"
        for (x, y), _ in places.values()
    )
    grips = ", ".join(f"{{ z = {half}, roll = 180.0, yaw = {yaw} }}" for yaw in (0.0, 180.0))
    toml = meeting_cell.TOML.replace('tool = "counterpoint"', 'tool = "vacuum_gripper"')
    toml = toml.replace(WORK, PRIMITIVES) + (
        f'[parts.box]\nkind = "box"\nsize = {list(size)}\ngrips = [{grips}]\nat = [{at}]\n'
    )
    if random.random() < 0.5:
        toml += (
            "[zones.people]\nsize = [0.8, 1.2, 1.0]\n"
            f"pose = {{ x = 1.5, y = {random.uniform(-0.5, 0.5):.2f}, z = 0.5 }}\n"
            f"max_speed = {random.choice([0.8, 1.5, 2.5])}\n"
        )
    return toml
