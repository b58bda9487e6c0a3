"""Random cells of an arm, a belt, a machine with a door and a clamp, and a table that turns, each with its own program.

net, toml = machine_cell(Random(3))

An arm takes a blank from the stop of a belt, puts it into the clamp, and then onto the table, on which another one may
stand already. Some of the waits between the programs are left out at random, and numbers are a little, or far, off.
"""

from __future__ import annotations

from random import Random

from helpers.cell_texts import ARM, GOING, head
from helpers.task_nets import task_net, told

_PARTIES = {"F": "Feeder", "M": "Mill", "A": "Arm", "T": "Table"}
_TASKS = (
    ("T", "rotate FIRST", ()),
    ("F", "bring (); ()", ()),
    ("M", "vice 120.0; door DOOR", ()),
    ("A", "goTo (at (0.0, ~900.0, 900.0)); line (at (0.0, ~900.0, 650.0)); grip (); "
          "line (at (0.0, ~900.0, 900.0))", (1,)),
    ("F", "bring (); ()", (3,)),
    ("A", "goTo (at (600.0, 0.0, 900.0)); line (at (1000.0, 0.0, 900.0)); line (at (1000.0, 0.0, 750.0))", (2, 3)),
    ("M", "vice GAP", (5,)),
    ("A", "release (); line (at (1000.0, 0.0, 900.0)); line (at (600.0, 0.0, 900.0))", (6,)),
    ("M", "door 0.0; door DOOR", (7,)),
    ("A", "line (at (1000.0, 0.0, 900.0)); line (at (1000.0, 0.0, 750.0)); grip ()", (8,)),
    ("M", "vice 120.0", (9,)),
    ("A", "line (at (1000.0, 0.0, 900.0)); line (at (600.0, 0.0, 900.0)); goTo (over SLOT); line SLOT; release (); "
          "line (over SLOT); home ()", (0, 10)),
    ("T", "rotate SECOND", (11,)),
)  # fmt: skip
_HEAD = """
net machine
  standard
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  fun bring () = ();
  fun door (mm : real) = ();
  fun vice (mm : real) = ();
  fun rotate (degrees : real) = ();
  fun goTo (p : POSE) = ();
  fun line (p : POSE) = ();
  fun home () = ();
  fun grip () = ();
  fun release () = ();
  fun at (x, y, z) : POSE = {x = x, y = y, z = z, rx = 180.0, ry = 0.0, rz = 0.0};
  fun over (p : POSE) = at (#x p, #y p, 900.0);
  page Top
"""
_TOML = (
    head(*(f"{c}{p}" for p in _PARTIES for c in "fd"), page="Top.", order="documented")
    + """[primitives]
bring = { command = "move_external", axis = "belt", to = 0.9 }
door = { command = "move_external", axis = "door" }
vice = { command = "move_external", axis = "vice" }
rotate = { command = "move_external", axis = "plate" }
"""
    + GOING
    + ARM
    + """[devices.feeder]
instance = "Feeder"
[devices.feeder.axes.belt]
kind = "belt"
pose = { x = -1.0, y = -0.9, z = 0.5 }
length = 1.3
width = 0.3
height = 0.2
stop = "infeed"
[devices.mill]
instance = "Mill"
[devices.mill.axes.door]
pose = { x = LEAF, z = 0.85 }
direction = [0.0, 1.0, 0.0]
from = 0.0
to = 0.9
home = 0.0
speed = 0.6
objects = [{ name = "leaf", size = [0.02, 0.8, 0.6] }]
[devices.mill.axes.vice]
kind = "clamp"
pose = { x = 1.0, z = 0.62, yaw = 90.0 }
from = 0.02
to = 0.12
home = 0.12
speed = 0.05
jaw = [0.04, 0.1, 0.06]
holds = "inVice"
[devices.table]
instance = "Table"
[devices.table.axes.plate]
kind = "swing"
pose = { x = 0.0, y = 1.0, z = 0.4 }
from = -180.0
to = 180.0
objects = [{ name = "top", kind = "cylinder", radius = 0.3, length = 0.02, pose = { z = -0.01 } }]
[parts.blank]
size = [0.1, 0.06, 0.15]
grips = [{ z = 0.075, roll = 180.0 }, { z = 0.075, roll = 180.0, yaw = 180.0 }]
at = [PARTS]
[places.infeed]
y = -0.9
z = 0.575
[places.inVice]
x = 1.0
z = 0.675
[scene]
objects = [
    { name = "bed", size = [0.3, 0.3, 0.58], pose = { x = 1.0, z = 0.29 } },
    { name = "block", size = [0.06, 0.03, 0.02], pose = { x = 1.0, z = 0.59 } },
]
"""
)


def machine_cell(random: Random) -> tuple[str, str]:
    """The net and the cell.toml."""
    careless = random.choice([0.0, 0.1, 0.3])
    count = random.choice([6, 10, len(_TASKS)])
    tasks = _TASKS[:count]
    edges = {(i, j) for j, (_, _, waits) in enumerate(tasks) for i in waits}
    edges = {e for e in sorted(edges) if random.random() >= careless}
    is_stacked = random.random() < 0.5
    numbers = {
        "DOOR": f"{random.choice([900.0, 900.0, 700.0, 500.0]):.1f}",
        "GAP": f"{random.choice([59.8, 59.8, 62.0, 119.0, 40.0]):.1f}",
        "FIRST": f"{random.choice([0.0, 90.0, 180.0]):.1f}",
        "SECOND": f"{random.choice([0.0, 90.0, 180.0]):.1f}",
        "SLOT": f"(at (0.0, {random.choice([850.0, 850.0, 760.0, 700.0, 690.0]):.1f}, "
        f"{551.0 + 150.0 * is_stacked + random.choice([0.0, 0.0, 3.0, 6.0]):.1f}))",
    }
    made = []
    for i, (party, does, _) in enumerate(tasks):
        for key, value in numbers.items():
            does = does.replace(key, value)
        made.append((party, told(i, does)))
    parts = [f"{{ x = {x:.3f}, y = -0.9, z = 0.575 }}" for x in _on_belt(random)]
    if is_stacked:
        parts.append("{ x = 0.0, y = 0.85, z = 0.475 }")
    toml = _TOML.replace("PARTS", ", ".join(parts))
    net = task_net(_HEAD, _PARTIES, made, edges)
    return net, toml.replace("LEAF", f"{random.uniform(0.6, 0.8):.3f}")


def _on_belt(random: Random) -> list[float]:
    first = random.choice([0.0, random.uniform(-0.6, 0.0)])
    return [first, first - random.uniform(0.105, 0.3)][: random.choice([1, 2, 2])]
