"""Random cells of devices that move beside each other: a belt, a turntable, a lift, a door, and an arm or an operator.

net, toml = moving_cell(Random(3))

Each has its own program, and most of them need not wait for each other. Gaps between what they sweep, with what stands
on them, are from far too little to wide; some waits that matter are left out at random.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from random import Random

from helpers.cell_texts import ARM, GOING, head
from helpers.task_nets import task_net, told

_PARTIES = {"F": "Feeder", "T": "Table", "L": "Lift", "D": "Door", "O": "Operator", "A": "Arm"}
_TASKS = (
    ("O", "put (); ()", ()),
    ("F", "feed (); bring ()", ()),
    ("T", "rotate FIRST", (0,)),
    ("O", "load (); ()", ()),
    ("L", "raise_ HIGH", (3,)),
    ("D", "door WIDE", ()),
    ("F", "feed (); bring ()", (1,)),
    ("T", "rotate 0.0", (2,)),
    ("O", "clear (); ()", (7,)),
    ("L", "raise_ 0.0", (4,)),
    ("D", "door 0.0", ()),
    ("O", "unload (); ()", (9,)),
    ("T", "rotate SECOND", (8,)),
)  # fmt: skip
_ARM = (
    ("A", "goTo (at (0.0, ~900.0, 900.0)); line (at (0.0, ~900.0, 650.0)); grip (); "
          "line (at (0.0, ~900.0, 900.0)); goTo (at (SPOT, 900.0))", (1,)),
    ("A", "line (at (SPOT, TOP)); release (); line (at (SPOT, 900.0)); home ()", (7, 8)),
)  # fmt: skip
_VERBS = {
    "F": ("bring", "feed"),
    "T": ("rotate",),
    "L": ("raise_",),
    "D": ("door",),
    "O": ("put", "clear", "load", "unload"),
}
_HEAD = """
net moving
  standard
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  fun feed () = ();
  fun bring () = ();
  fun put () = ();
  fun clear () = ();
  fun load () = ();
  fun unload () = ();
  fun door (mm : real) = ();
  fun raise_ (mm : real) = ();
  fun rotate (degrees : real) = ();
  fun goTo (p : POSE) = ();
  fun line (p : POSE) = ();
  fun home () = ();
  fun grip () = ();
  fun release () = ();
  fun at (x, y, z) : POSE = {x = x, y = y, z = z, rx = 180.0, ry = 0.0, rz = 0.0};
  page Top
"""
_DEVICES = """[devices.feeder]
instance = "Feeder"
[devices.feeder.axes.belt]
kind = "belt"
pose = { x = -1.0, y = -0.9, z = 0.5 }
length = LONG
width = 0.2
height = 0.05
STOP
[devices.table]
instance = "Table"
[devices.table.axes.plate]
kind = "swing"
pose = { x = TX, y = TY, z = TZ }
from = -360.0
to = 360.0
objects = [{ name = "top", kind = "cylinder", radius = TR, length = 0.02, pose = { z = -0.01 } }]
[devices.lift]
instance = "Lift"
[devices.lift.axes.platform]
pose = { x = LX, y = LY, z = LZ }
direction = [0.0, 0.0, 1.0]
from = 0.0
to = 0.8
objects = [{ name = "top", size = [0.24, 0.24, 0.02], pose = { z = -0.01 } }]
[devices.door]
instance = "Door"
[devices.door.axes.leaf]
pose = { x = DX, y = -0.3, z = DZ }
direction = [0.0, -1.0, 0.0]
from = 0.0
to = 1.2
objects = [{ name = "leaf", size = [0.02, 0.5, 0.3] }]
[devices.operator]
instance = "Operator"
[parts.blank]
size = [0.1, 0.06, 0.15]
grips = [{ z = 0.075, roll = 180.0 }, { z = 0.075, roll = 180.0, yaw = 180.0 }]
[places.entry]
x = EX
y = -0.9
z = 0.576
[places.infeed]
x = 0.0
y = -0.9
z = 0.576
[places.onTable]
x = OX
y = OY
z = OZ
[places.onLift]
x = LX
y = LY
z = LTOP
"""
_MOVES = """[primitives]
bring = { command = "move_external", axis = "belt", to = RUN }
door = { command = "move_external", axis = "leaf" }
raise_ = { command = "move_external", axis = "platform" }
rotate = { command = "move_external", axis = "plate" }
feed = { command = "tool", action = "feed", duration_s = 1.0, creates = "blank", at = "entry" }
put = { command = "tool", action = "put", duration_s = 1.0, creates = "blank", at = "onTable" }
clear = { command = "tool", action = "clear", duration_s = 1.0, removes = "blank", at = "onTable" }
load = { command = "tool", action = "load", duration_s = 1.0, creates = "blank", at = "onLift" }
unload = { command = "tool", action = "unload", duration_s = 1.0, removes = "blank", at = "onLift" }
"""


def moving_cell(random: Random) -> tuple[str, str]:
    """The net and the cell.toml."""
    with_arm = random.random() < 0.25
    careless = random.choice([0.0, 0.0, 0.0, 0.15])
    count = random.choice([5, 7, 9, 11])
    chosen = [t for t in _TASKS[:count] if random.random() < 0.93 or t[2] or t[0] == "F"]
    tasks = [*chosen, *(_ARM if with_arm else ())]
    number = {_TASKS.index(t) if t in _TASKS else -1: i for i, t in enumerate(tasks)}
    edges = {(number[i], j) for j, t in enumerate(tasks) for i in t[2] if i in number}
    edges = {e for e in sorted(edges) if random.random() >= careless}
    together = random.choice([0.1, 0.4, 0.7])
    for j, (party, _, _) in enumerate(tasks):
        edges |= {(i, j) for i in range(j) if tasks[i][0] != party and random.random() < together}
    return cell_of(tasks, edges, numbers_of(random))


def cell_of(
    tasks: Sequence[tuple[str, str, tuple[int, ...]]],
    edges: Iterable[tuple[int, int]],
    texts: Mapping[str, str],
) -> tuple[str, str]:
    """The net and the cell.toml; `texts`: what is put in for the words in capital letters."""
    with_arm = any(party == "A" for party, _, _ in tasks)
    made = []
    for i, (party, does, _) in enumerate(tasks):
        for key in ("FIRST", "SECOND", "HIGH", "WIDE", "SPOT", "TOP"):
            does = does.replace(key, texts[key])
        made.append((party, told(i, does)))
    used = {p: name for p, name in _PARTIES.items() if any(p == own for own, _ in made)}
    names = [f"{c}{p}" for p in used for c in "fd"]
    toml = head(*names, page="Top.", order="documented") + _MOVES + GOING
    toml += (ARM if with_arm else "") + _DEVICES
    for key in sorted(texts.keys() - {"STOP"}, key=len, reverse=True):
        toml = toml.replace(f"= {key}", f"= {texts[key]}")
    toml = toml.replace("\nSTOP\n", texts["STOP"])
    for p, name in _PARTIES.items():
        if p not in used:
            toml = _without(toml, name.lower())
            for verb in _VERBS.get(p, ()):
                toml = re.sub(rf"(?m)^{verb} = .*\n", "", toml)
    return task_net(_HEAD, used, made, edges), toml


def _without(toml: str, device: str) -> str:
    """The cell without a device that has nothing to do."""
    blocks = toml.split("[")
    out, skips = [blocks[0]], False
    for block in blocks[1:]:
        if block.startswith(("devices.", "parts.", "places.", "robots.", "primitives")):
            skips = block.startswith((f"devices.{device}]", f"devices.{device}."))
        if not skips:
            out.append(block)
    return "[".join(out)


def numbers_of(random: Random) -> dict[str, str]:
    """Where everything is: the table behind the end of the belt, the lift beside both, the door between them."""
    stops = random.random() < 0.6
    long = random.uniform(1.05, 1.2)
    radius = random.choice([0.15, 0.2, 0.25])
    gap = random.choice([0.004, 0.03, 0.09, 0.15, 0.25])
    tx, ty = long - 1.0 + radius + gap, -0.9 + random.choice([0.0, 0.1, -0.15])
    tz = random.choice([0.5, 0.5, 0.46, 0.36, 0.33, 0.675])
    out = random.uniform(0.0, radius - 0.03)
    far = random.choice([0.03, 0.08, 0.15, 0.3])
    beside = random.random() < 0.5  # the lift beside the table, or beside the belt
    lx = tx if beside else random.uniform(-0.4, 0.1)
    ly = ty + radius + 0.12 + far if beside else -0.9 + 0.1 + 0.12 + far
    lz = random.choice([0.3, 0.4, 0.5])
    run = 0.9 if stops else random.uniform(0.4, 0.8)
    values = {
        "LONG": long, "TX": tx, "TY": ty, "TZ": tz, "TR": radius, "LX": lx, "LY": ly, "LZ": lz,
        "DX": random.choice([long - 1.0 + gap / 2.0, random.uniform(-0.5, 0.6), 1.5]),
        "DZ": random.choice([0.65, 0.82, 0.9]), "EX": random.uniform(-0.95, -0.8),
        "OX": tx + out, "OY": ty, "OZ": tz + 0.076, "LTOP": lz + 0.076, "RUN": run,
        "FIRST": random.choice([45.0, 90.0, 180.0, 360.0, -90.0]),
        "SECOND": random.choice([30.0, 120.0, -180.0]),
        "HIGH": random.uniform(50.0, 600.0), "WIDE": random.choice([200.0, 450.0, 700.0, 1100.0]),
        "TOP": 1000.0 * (tz + 0.151),
    }  # fmt: skip
    texts = {key: f"{value:.4f}" for key, value in values.items()}
    texts = {
        key: value.replace("-", "~") if key in ("FIRST", "SECOND") else value
        for key, value in texts.items()
    }
    spot = f"{1000.0 * tx:.1f}, {1000.0 * ty:.1f}".replace("-", "~")
    return texts | {"SPOT": spot, "STOP": '\nstop = "infeed"\n' if stops else "\n"}
