"""Random cells in which two arms change tools of one rack: who has which depends on order, branches and sensors.

net, toml = changing_cell(Random(3))

Each arm takes a tool, works with it, and leaves it; a sensor that nobody has seen may decide which one, or whether it
is left. Now and then a step is left out, a tool is left elsewhere, a height fits the short tools alone, or an arm does
not wait for the other one, so that some of these cells are right and others run into something, or have the wrong tool.
"""

from __future__ import annotations

from random import Random

from helpers.cell_texts import head
from helpers.task_nets import Task, task_net

_PARTIES = {"A": "Left", "B": "Right"}
_TOOLS = {"gripper": -350.0, "spare": 0.0, "punch": 350.0}
_HEAD = """
net changing
  standard
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  var coin : BOOL;
  fun toRack (p : POSE) = ();
  fun inRack (p : POSE) = ();
  fun goTo (p : POSE) = ();
  fun line (p : POSE) = ();
  fun home () = ();
  fun pressIt () = ();
FUNCTIONS
  fun at (x, y, z) : POSE = {x = x, y = y, z = z, rx = 180.0, ry = 0.0, rz = 0.0};
  fun over (p : POSE) = at (#x p, #y p, 1300.0);
  page Top
"""
_TOML = (
    head(*(f"{c}{p}" for p in _PARTIES for c in "fd"), page="Top.", order="documented")
    + """[primitives]
toRack = { command = "move_joint", tcp = "coupling" }
inRack = { command = "move_linear", frame = "world", tcp = "coupling", speed = 0.25 }
goTo = { command = "move_joint" }
line = { command = "move_linear", frame = "world", speed = 0.25 }
home = { command = "move_home" }
pressIt = { command = "tool", action = "press", duration_s = 1.0 }
PRIMITIVES
[tools.gripper]
model = "vacuum_gripper"
rack = "gripperAt"
[tools.spare]
model = "vacuum_gripper"
rack = "spareAt"
[tools.punch]
model = "counterpoint"
rack = "punchAt"
does = ["press"]
[scene]
objects = [
    { name = "stand", size = [0.3, 0.3, 0.4], pose = { x = 1.0, z = 0.2 } },
    { name = "bench", size = [0.3, 0.3, 0.4], pose = { x = 1.0, y = -1.8, z = 0.2 } },
]
"""
)


def changing_cell(random: Random) -> tuple[str, str]:
    """The net and the cell.toml."""
    tasks: list[Task] = []
    edges: set[tuple[int, int]] = set()
    for party, y in (("A", 0.0), ("B", -1800.0)):
        first = len(tasks)
        for does in _plan(random, y):
            tasks.append((party, _task(len(tasks), does)))
        if party == "B" and random.random() < 0.85:  # one after the other
            edges.add((first - 1, first))
    functions, primitives, places = "", "", ""
    for tool, x in _TOOLS.items():
        name = tool.title()
        functions += f"  fun take{name} () = ();\n  fun leave{name} () = ();\n"
        for does, effect in (("take", "couples"), ("leave", "uncouples")):
            primitives += (
                f'{does}{name} = {{ command = "tool", action = "{does}", duration_s = 0.5, {effect} = "{tool}" }}\n'
            )  # fmt: skip
        places += f"[places.{tool}At]\nx = {x / 1000.0}\ny = -0.9\nz = 1.0\nroll = 180.0\n"
    begins = random.choice(["", "", 'begins_with = "punch"\n'])
    robots = "".join(
        f'[robots.{name.lower()}]\ninstance = "{name}"\nmodel = "gp25"\nbase = {{ y = {y}, z = 0.3 }}\n'
        'home = [0.0, 0.0, 0.0, 0.0, -90.0, 0.0]\ntools = ["gripper", "spare", "punch"]\n'
        f"{begins if name == 'Left' else ''}[robots.{name.lower()}.tcps.coupling]\n"
        for name, y in (("Left", 0.0), ("Right", -1.8))
    )
    sensor = "[sensors.coin]\n" if any("coin" in x for _, does in tasks for x in does) else ""
    toml = _TOML.replace("PRIMITIVES", primitives) + places + robots + sensor
    return task_net(_HEAD.replace("FUNCTIONS\n", functions), _PARTIES, tasks, edges), toml


def _plan(random: Random, y: float) -> list[tuple[str, str]]:
    """What an arm does, each task with what it does if a coin that is thrown then falls otherwise; "": none is."""
    tool, other = random.sample(sorted(_TOOLS), 2)
    low = random.choice([950.0, 950.0, 700.0])
    works = random.choice(
        [
            f"toRack (at (1000.0, {_ml(y)}, 1000.0)); inRack (at (1000.0, {_ml(y)}, {low})); home ()",
            f"goTo (at (1000.0, {_ml(y)}, 700.0)); line (at (1000.0, {_ml(y)}, 450.0)); home ()",
            f"goTo (at (1000.0, {_ml(y)}, 600.0)); pressIt (); home ()"
            if tool == "punch"
            else "home ()",
        ]
    )
    is_thrown = random.random() < 0.4
    out = [
        (_change(random, "take", tool), _change(random, "take", other) if is_thrown else ""),
        (works, ""),
        (
            _change(random, "leave", tool),
            "()" if random.random() < 0.2 else "",
        ),
    ]
    if is_thrown and random.random() < 0.7:
        out.pop()  # which one it has is not known
    if random.random() < 0.15:
        out.pop(random.randrange(len(out)))
    return out


def _change(random: Random, does: str, tool: str) -> str:
    where = tool if random.random() < 0.95 else random.choice(sorted(_TOOLS))
    at = f"at ({_ml(_TOOLS[where])}, ~900.0, 1000.0)"
    after = "" if random.random() < 0.1 else "; home ()"
    return f"home (); toRack (over ({at})); inRack ({at}); {does}{tool.title()} (); inRack (over ({at})){after}"


def _task(i: int, does: tuple[str, str]) -> list[str]:
    one, other = does
    code = (
        f"input (coin) action (if coin then ({one}) else ({other}))" if other else f"action ({one})"
    )
    keeps = [f"    place Fell{i} : BOOL"] if other else []
    puts = [f"      out Fell{i} : coin"] if other else []
    return [
        *keeps,
        f"    trans Do{i} code {code}",
        *("      in Waiting : ()", f"      in f : {i}", "      out Waiting : ()"),
        f"      out d : {i}",
        *puts,
    ]


def _ml(number: float) -> str:
    return f"{number}".replace("-", "~")
