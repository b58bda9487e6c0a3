"""Random cells in which sensors that see the scene decide: has a part come, is the door open, is the arm out?

net, toml = sighted_cell(Random(3))

A feeder brings blanks and takes one away, an arm puts them onto a rack and reaches into a machine, whose door opens
and closes. Each task waits for others, or asks a sensor, before what it does or in the same transition; or it does
neither. So some of these cells are right because of what sensors can say, and others race or run into something.
"""

from __future__ import annotations

from random import Random

from helpers.cell_texts import ARM, GOING, head
from helpers.task_nets import Task, task_net, told

_PARTIES = {"F": "Feeder", "M": "Mill", "A": "Arm"}
_EYE, _GATE, _INSIDE = ("eye", True), ("gate", True), ("inside", False)
_FETCH = (
    "goTo (at (0.0, ~900.0, 900.0)); line (at (0.0, ~900.0, 650.0)); grip (); line (at (0.0, ~900.0, 900.0)); "
    "goTo (over SLOT); line SLOT; release (); line (over SLOT); home ()"
)  # fmt: skip
_TASKS = (
    ("F", "feed ()", (), ("eye", False)),
    ("A", _FETCH.replace("SLOT", "(at (~400.0, ~900.0, 551.0))"), (0,), _EYE),
    ("M", "door DOOR", (), None),
    ("A", "goTo (at (600.0, 0.0, 900.0)); line (at (1000.0, 0.0, 900.0)); line (at (600.0, 0.0, 900.0))", (2,), _GATE),
    ("M", "door 0.0", (3,), _INSIDE),
    ("F", "feed ()", (1,), ("eye", False)),
    ("A", _FETCH.replace("SLOT", "(at (~700.0, ~900.0, 551.0))"), (5,), _EYE),
    ("F", "clear ()", (6,), _EYE),
)  # fmt: skip
_HEAD = """
net sighted
  standard
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  var eye, gate, inside : BOOL;
  fun feed () = ();
  fun clear () = ();
  fun door (mm : real) = ();
  fun goTo (p : POSE) = ();
  fun line (p : POSE) = ();
  fun home () = ();
  fun grip () = ();
  fun release () = ();
  fun pause () = ();
  fun at (x, y, z) : POSE = {x = x, y = y, z = z, rx = 180.0, ry = 0.0, rz = 0.0};
  fun over (p : POSE) = at (#x p, #y p, 900.0);
  page Top
"""
_TOML = (
    head(*(f"{c}{p}" for p in _PARTIES for c in "fd"), page="Top.", order="documented")
    + """[primitives]
feed = { command = "tool", action = "feed", duration_s = 0.5, creates = "blank", at = "infeed" }
clear = { command = "tool", action = "clear", duration_s = 0.5, removes = "blank", at = "infeed" }
door = { command = "move_external", axis = "door" }
pause = { command = "wait", duration_s = PAUSE }
"""
    + GOING
    + ARM
    + """[devices.feeder]
instance = "Feeder"
[devices.mill]
instance = "Mill"
[devices.mill.axes.door]
pose = { x = 0.7, z = 0.85 }
direction = [0.0, 1.0, 0.0]
from = 0.0
to = 0.9
home = HOME
speed = 0.6
objects = [{ name = "leaf", size = [0.02, 0.8, 0.6] }]
[zones.doorway]
pose = { x = 0.7, z = 0.85 }
size = [WIDE, 0.8, 0.8]
[parts.blank]
size = [0.1, 0.06, 0.15]
grips = [{ z = 0.075, roll = 180.0 }, { z = 0.075, roll = 180.0, yaw = 180.0 }]
at = [PARTS]
[places.infeed]
y = -0.9
z = 0.575
[scene]
objects = [
    { name = "stand", size = [0.3, 0.3, 0.5], pose = { y = -0.9, z = 0.25 } },
    { name = "rack", size = [0.8, 0.3, 0.4], pose = { x = -0.6, y = -0.9, z = 0.2 } },
]
"""
)
_SEES = {
    "eye": 'sees = "infeed"',
    "gate": 'sees = "mill.door"\nat = 0.9',
    "inside": 'sees = "doorway"',
}


def sighted_cell(random: Random) -> tuple[str, str]:
    """The net and the cell.toml."""
    tasks = _TASKS[: random.choice([5, 5, 7, len(_TASKS)])]
    edges: set[tuple[int, int]] = set()
    asked: set[str] = set()
    made: list[Task] = []
    door = f"{random.choice([900.0] * 5 + [700.0]):.1f}"
    for i, (party, does, waits, asks) in enumerate(tasks):
        # Whoever closes the door when the arm is out, and does not wait for that it stays out, races.
        often = [12, 1, 12, 1] if asks == _INSIDE else [4, 8, 20, 1]
        way = random.choices(["waits", "asks", "both", "neither"], often)[0]
        if way in ("waits", "both") or asks is None:
            edges |= {(j, i) for j in waits}
        is_asking = asks is not None and way in ("asks", "both")
        if asks is not None and is_asking:
            asked.add(asks[0])
        own = _task(i, does.replace("DOOR", door), asks if is_asking else None, random)
        made.append((party, own))
    toml = (
        _TOML.replace("PARTS", random.choice(["", "", "{ y = -0.9, z = 0.575 }"]))
        .replace("HOME", f"{random.choice([0.0, 0.9]):.1f}")
        .replace("PAUSE", f"{random.choice([0.1, 2.0]):.1f}")
        .replace("WIDE", f"{random.choice([0.2, 0.6, 1.4]):.1f}")
    )
    sensors = [f"[sensors.{x}]\n{_SEES[x]}\n" for x in sorted(asked)]
    return task_net(_HEAD, _PARTIES, made, edges), toml + "".join(sensors)


def _task(i: int, does: str, asks: tuple[str, bool] | None, random: Random) -> list[str]:
    """Its transitions: it does what it is told, or asks before that whether it may."""
    if asks is None:
        return told(i, does)
    sensor, wanted = asks
    if random.random() < 0.4:  # in one transition: the sensor is asked first
        yes, no = (f"({does})", "()") if wanted else ("()", f"({does})")
        return [
            f"    place Was{i} : BOOL",
            f"    trans Do{i} code input ({sensor}) action (if {sensor} then {yes} else {no})",
            *("      in Waiting : ()", f"      in f : {i}", "      out Waiting : ()"),
            *(f"      out d : {i}", f"      out Was{i} : {sensor}"),
        ]
    pause = random.choice(["", " code action (pause ())"])
    yes, no = ("true", "false") if wanted else ("false", "true")
    return [
        f"    place Said{i} : BOOL",
        f"    trans Look{i}{pause}",
        *("      in Waiting : ()", f"      in f : {i}", f"      out Said{i} : {sensor}"),
        f"    trans Do{i} code action ({does})",
        *(f"      in Said{i} : {yes}", "      out Waiting : ()", f"      out d : {i}"),
        f"    trans Skip{i}",
        *(f"      in Said{i} : {no}", "      out Waiting : ()", f"      out d : {i}"),
    ]
