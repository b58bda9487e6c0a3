"""Random cells of two arms that face each other: each works through poses of its own, some of which both can reach.

net, toml = two_arm_cell(Random(3))

Whether the supervisor lets only one arm in at a time is left to chance, and so is whether it does so for all tasks.
"""

from __future__ import annotations

from random import Random

HEAD = """
net two
  standard
  val P_LOW = 900;
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  fun moveJoint (p : POSE) = ();
  fun moveLinear (p : POSE) = ();
  fun moveTool (p : POSE) = ();
  fun moveHome () = ();
  fun work () = ();
  fun pose (x, y, z, rz) : POSE = {x = x, y = y, z = z, rx = 180.0, ry = 0.0, rz = rz};
  fun down d : POSE = {x = 0.0, y = 0.0, z = d, rx = 0.0, ry = 0.0, rz = 0.0};
  var n : INT;
  page Top
"""


def two_arm_cell(random: Random, axes: Random | None = None) -> tuple[str, str]:
    """The net and the cell.toml.

    Args:
        axes: gives both arms tracks, and the first one a turntable between them; None: there are none.
    """
    apart = random.uniform(2.6, 4.2)
    retreats = random.random() < 0.6
    counts = [random.randint(1, 3), random.randint(1, 3)]
    lines = [HEAD.rstrip()]
    lines += [f"    place {c}{i} : INT" for i in (1, 2) for c in "fd"]
    lines.append("    subst Supervisor = Sup (f1 -> f1, d1 -> d1, f2 -> f2, d2 -> d2)")
    lines += [f"    subst Robot{i} = Rob{i} (f -> f{i}, d -> d{i})" for i in (1, 2)]
    lines += _supervisor(random, counts)
    for i in (1, 2):
        lines += _robot(random, i, counts[i - 1], apart, retreats)
    if axes is not None:
        return with_axes("\n".join(lines) + "\n", _toml(apart, random), apart, axes)
    return "\n".join(lines) + "\n", _toml(apart, random)


def with_axes(net: str, toml: str, apart: float, random: Random) -> tuple[str, str]:
    """The same with external axes: some tasks go along a track, turn the plate, or weld on it."""
    declared = """  fun travel1 (d : real) = ();
  fun travel2 (d : real) = ();
  fun turn (a : real) = ();
  fun along1 (p : POSE, d : real) = ();
  fun along2 (p : POSE, d : real) = ();
  fun seam (p : POSE, a : real) = ();
  fun overSeam (p : POSE) = ();
"""
    net = net.replace("  page Top\n", declared + "  page Top\n")
    out = []
    page = 0
    for line in net.splitlines():
        page = int(line[-1]) if line.startswith("  page Rob") else page
        if "    trans Go" in line and random.random() < 0.8:
            line = line.replace("action (", f"action ({_external(page, random)}", 1)
        if "moveLinear (pose" in line and "trans Back" in line and random.random() < 0.5:
            where = _number(random.choice([0.2, 1.0]) * random.uniform(-400.0, 400.0))
            at = line.index("moveLinear (pose") + len("moveLinear (")
            end = line.index(")", at) + 1
            old = f"moveLinear ({line[at:end]})"
            line = line.replace(old, f"along{page} ({line[at:end]}, {where})", 1)
        out.append(line)
    entries = """
travel1 = { command = "move_external", track = "rail1" }
travel2 = { command = "move_external", track = "rail2" }
turn = { command = "move_external", turntable = "plate" }
along1 = { command = "move_linear", frame = "world", track = "rail1" }
along2 = { command = "move_linear", frame = "world", track = "rail2" }
seam = { command = "move_linear", frame = "seam", turntable = "plate" }
overSeam = { command = "move_joint", frame = "seam" }
"""
    toml = toml.replace("[robots.robot1]", entries.strip() + "\n[robots.robot1]", 1)
    across = [random.choice(["[0.0, 1.0, 0.0]", "[1.0, 0.0, 0.0]"]) for _ in range(2)]
    for i in (1, 2):
        toml += (
            f"[robots.robot{i}.axes.rail{i}]\ndirection = {across[i - 1]}\nfrom = -0.5\nto = 0.5\n"
        )
    x, high = apart / 2.0, random.uniform(0.3, 0.6)
    y, radius = random.uniform(-0.4, 0.4), random.uniform(0.2, 0.45)
    toml += f"""[robots.robot1.axes.plate]
kind = "turntable"
pose = {{ x = {x:.3f}, y = {y:.3f}, z = {high:.3f} }}
from = -200.0
to = 200.0
radius = {radius:.3f}
objects = [{{ name = "work", size = [{random.uniform(0.2, 0.9):.3f}, 0.1, 0.1], pose = {{ z = 0.05 }} }}]
[frames.seam]
parent = "robot1.plate"
z = 0.25
"""
    if random.random() < 0.7:
        toml += _stack(x, y, high, radius, random)
    return "\n".join(out) + "\n", toml


def _stack(x: float, y: float, high: float, radius: float, random: Random) -> str:
    """Blocks on the plate, one on the other, which turn with it; and often a pillar on the floor beside it."""
    tall, side = random.uniform(0.03, 0.12), random.choice([-1.0, 1.0])
    at = [(x + random.uniform(-0.1, 0.1), y + side * 0.13, high + tall / 2.0)]
    if random.random() < 0.5:
        at.append((at[0][0], at[0][1], at[0][2] + tall))
    places = ", ".join(f"{{ x = {a:.4f}, y = {b:.4f}, z = {c:.4f} }}" for a, b, c in at)
    text = f'[parts.block]\nkind = "box"\nsize = [0.12, 0.12, {tall:.4f}]\nat = [{places}]\n'
    if random.random() < 0.6:
        length = random.uniform(0.2, high + 0.2)
        beside = y - side * (radius + random.uniform(0.06, 0.4))
        place = f"{{ x = {x:.4f}, y = {beside:.4f}, z = {length / 2.0:.4f} }}"
        text += f'[parts.pillar]\nkind = "cylinder"\nradius = 0.04\nlength = {length:.4f}\nat = [{place}]\n'
    return text


def _external(robot: int, random: Random) -> str:
    """What goes before a task."""
    wide = random.choice([0.2, 1.0])
    where = _number(wide * random.uniform(-450.0, 450.0))
    turned, more = (_number(wide * random.uniform(-150.0, 150.0)) for _ in range(2))
    if robot == 2 or random.random() < 0.4:
        return f"travel{robot} ({where}); "
    a, b = (_number(random.uniform(-150.0, 150.0)) for _ in range(2))
    return (
        f"turn ({turned}); overSeam (pose ({a}, {b}, 100.0, 0.0)); "
        f"seam (pose ({b}, {a}, 0.0, 0.0), {more}); overSeam (pose ({b}, {a}, 300.0, 0.0)); "
    )


def _supervisor(random: Random, counts: list[int]) -> list[str]:
    is_guarded = random.random() < 0.5
    careless = random.choice([0, 0, 1, 2])  # whoever does not ask
    lines = ["  page Sup"]
    for i in (1, 2):
        lines += [f"    place f{i} port out : INT", f"    place d{i} port in : INT"]
        lines += [
            f"    place Next{i} : INT = 1`1",
            f"    place Busy{i} : INT",
            f"    place Done{i}",
        ]
    lines += ["    place Zone = 1", "    place Finished"]
    for i in (1, 2):
        asks = is_guarded and careless != i
        lines += [f"    trans Send{i} guard [n <= {counts[i - 1]}]"]
        lines += [f"      in Next{i} : n", f"      out f{i} : n", f"      out Busy{i} : n"]
        lines += ["      in Zone : ()"] * asks
        lines += [
            f"    trans Got{i}",
            f"      in Busy{i} : n",
            f"      in d{i} : n",
            f"      out Next{i} : n + 1",
        ]
        lines += ["      out Zone : ()"] * asks
        lines += [
            f"    trans End{i} guard [n > {counts[i - 1]}]",
            f"      in Next{i} : n",
            f"      out Done{i} : ()",
        ]
    lines += [
        "    trans Finish",
        "      in Done1 : ()",
        "      in Done2 : ()",
        "      out Finished : ()",
    ]
    return lines


def _robot(random: Random, i: int, count: int, apart: float, retreats: bool) -> list[str]:
    lines = [f"  page Rob{i}", "    place f port in : INT", "    place d port out : INT"]
    lines += ["    place Waiting = 1", "    place Told : INT", "    place There : INT"]
    lines += ["    trans Accept", "      in Waiting : ()", "      in f : n", "      out Told : n"]
    for n in range(1, count + 1):
        x = (apart / 2.0 + random.uniform(-0.25, 0.35)) * (1 if i == 1 else -1)
        # In the world the first arm stands at 0 and looks along x, the other one at `apart` and looks back.
        x = x if i == 1 else apart + x
        y, z = random.uniform(-0.45, 0.45), random.uniform(0.55, 1.0)
        turn = 0.0 if i == 1 else 180.0
        pose = f"pose ({_number(1000 * x)}, {_number(1000 * y)}, {_number(1000 * z)}, {turn})"
        up = f"pose ({_number(1000 * x)}, {_number(1000 * y)}, {_number(1000 * z + 400)}, {turn})"
        go = f"moveJoint ({up}); moveLinear ({pose})"
        if random.random() < 0.4:
            go = f"moveJoint ({up}); moveTool (down 400.0)"
        back = random.choice(
            [f"moveLinear ({up})", "moveTool (down (~400.0))", f"moveLinear ({up}); moveHome ()"]
        )
        back = f"moveLinear ({up}); moveHome ()" if retreats else back
        lines += [f"    trans Go{n} guard [n = {n}] code input (n) action ({go}; work ())"]
        lines += ["      in Told : n", "      out There : n"]
        lines += [f"    trans Back{n} guard [n = {n}] code input (n) action ({back})"]
        lines += ["      in There : n", "      out d : n", "      out Waiting : ()"]
    return lines


def _number(value: float) -> str:
    return f"{value:.1f}".replace("-", "~")


def _toml(apart: float, random: Random) -> str:
    channels = "".join(
        f'[[channel]]\nplace = "Top.{c}{i}"\nfile = "{c}{i}.robcad"\nkind = "flag"\n'
        for i in (1, 2)
        for c in "fd"
    )
    speed = random.choice([0.15, 0.4, 0.8])
    return f"""
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
order = "documented"
{channels}
[primitives]
moveJoint = {{ command = "move_joint" }}
moveLinear = {{ command = "move_linear", frame = "world" }}
moveTool = {{ command = "move_linear", frame = "tool" }}
moveHome = {{ command = "move_home" }}
work = {{ command = "tool", action = "work", duration_s = {random.choice([0.5, 3.0])} }}
[robots.robot1]
instance = "Robot1"
model = "kr120_r2500"
tool = "counterpoint"
base = {{ x = 0.0, y = 0.0, z = 0.0, yaw = 0.0 }}
home = [0.0, -120.0, 125.0, 0.0, 85.0, 0.0]
[robots.robot2]
instance = "Robot2"
model = "kr120_r2500"
tool = "counterpoint"
base = {{ x = {apart:.3f}, y = 0.0, z = 0.0, yaw = 180.0 }}
home = [0.0, -120.0, 125.0, 0.0, 85.0, 0.0]
[motion]
joint_speed = {speed}
linear_speed = {random.choice([0.1, 0.4])}
[scene]
floor = true
"""
