"""A welding pair: two arms, each on a track of its own, and a turntable of the left one with the work piece.

folder = welding_cell(tmp_path / "cell")

For each seam the supervisor first lets the left arm weld, while the right one stands back, and then the other way
round. The left arm takes its track along and turns the plate while it welds; the right one works in the world.
"""

from __future__ import annotations

from pathlib import Path
from random import Random

from helpers.netbuilder import cpn

NET = """
net weld
  standard
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  fun travel (d : real) = ();
  fun turn (d : real, v : real) = ();
  fun goTo (p : POSE) = ();
  fun goToAlong (p : POSE, d : real) = ();
  fun weld (p : POSE, d : real, a : real, v : real) = ();
  fun weldStill (p : POSE) = ();
  fun home () = ();
  fun torch () = ();
  fun at (x, y, z) : POSE = {x = x, y = y, z = z, rx = 180.0, ry = 0.0, rz = 90.0};
  fun deg n = 30.0 * Real.fromInt n;
  fun toSeam n = (goTo (at (~100.0, ~60.0, 60.0)); weld (at (100.0, ~60.0, 15.0), 300.0, deg (n + 1), 30.0));
  fun toBench () = (goToAlong (at (0.0, 950.0, 1000.0), 200.0); weldStill (at (60.0, 950.0, 1000.0)));
  var n : INT;
  page Top
    place f1 : INT
    place d1 : INT
    place f2 : INT
    place d2 : INT
    subst Supervisor = Sup (f1 -> f1, d1 -> d1, f2 -> f2, d2 -> d2)
    subst Left = Left (f -> f1, d -> d1)
    subst Right = Right (f -> f2, d -> d2)
  page Sup
    place f1 port out : INT
    place d1 port in : INT
    place f2 port out : INT
    place d2 port in : INT
    place Next : INT = 1`1
    place First : INT
    place Second : INT
    place Finished
    trans SendLeft guard [n <= 2]
      in Next : n
      out f1 : n
      out First : n
    trans SendRight
      in First : n
      in d1 : n
      out f2 : n
      out Second : n
    trans Go
      in Second : n
      in d2 : n
      out Next : n + 1
    trans Finish guard [n > 2]
      in Next : n
      out Finished : ()
  page Left
    place f port in : INT
    place d port out : INT
    place Waiting = 1
    place Told : INT
    place There : INT
    place Welded : INT
    trans Accept
      in Waiting : ()
      in f : n
      out Told : n
    trans Prepare code input (n) action (travel (100.0 * Real.fromInt n); turn (deg n, 50.0))
      in Told : n
      out There : n
    trans Weld code input (n) action (toSeam n; torch ())
      in There : n
      out Welded : n
    trans Back code input (n) action (goTo (at (0.0, ~200.0, 300.0)); home ())
      in Welded : n
      out d : n
      out Waiting : ()
  page Right
    place f port in : INT
    place d port out : INT
    place Waiting = 1
    place Told : INT
    trans Accept
      in Waiting : ()
      in f : n
      out Told : n
    trans Work code input (n) action (toBench (); torch (); home ())
      in Told : n
      out d : n
      out Waiting : ()
"""

TOML = """
[net]
file = "cell.cpn"

[supervisor]
instance = "Supervisor"
final = ["Finished"]

[[channel]]
place = "Top.f1"
file = "f1.robcad"
kind = "flag"

[[channel]]
place = "Top.d1"
file = "d1.robcad"
kind = "flag"

[[channel]]
place = "Top.f2"
file = "f2.robcad"
kind = "flag"

[[channel]]
place = "Top.d2"
file = "d2.robcad"
kind = "flag"

[primitives]
travel = { command = "move_external", track = "rail" }
turn = { command = "move_external", turntable = "plate" }
goTo = { command = "move_joint", frame = "seam" }
goToAlong = { command = "move_joint", track = "bench" }
weld = { command = "move_linear", frame = "seam", track = "rail", turntable = "plate", approach = 0.05 }
weldStill = { command = "move_linear", frame = "world" }
home = { command = "move_home" }
torch = { command = "tool", action = "weld", duration_s = 1.0 }

[robots.left]
instance = "Left"
model = "gp25"
tool = "none"
base = { x = 0.0, y = -1.2, z = 0.3, yaw = 90.0 }
home = [0.0, 0.0, 0.0, 0.0, -90.0, 0.0]

[robots.left.axes.rail]
direction = [0.0, -1.0, 0.0]
from = -0.5
to = 0.8
home = 0.0
speed = 0.5

[robots.left.axes.plate]
kind = "turntable"
pose = { x = 0.0, y = 0.0, z = 0.7 }
from = -180.0
to = 180.0
speed = 45.0
radius = 0.35
objects = [{ name = "work", size = [0.4, 0.2, 0.05], pose = { z = 0.025 }, colour = [0.6, 0.62, 0.66] }]

[robots.right]
instance = "Right"
model = "gp25"
tool = "none"
base = { x = 0.0, y = 2.0, z = 0.3, yaw = -90.0 }
home = [0.0, 0.0, 0.0, 0.0, -90.0, 0.0]

[robots.right.axes.bench]
direction = [0.0, 1.0, 0.0]
from = -0.5
to = 0.5

[frames.seam]
parent = "left.plate"
z = 0.1

[motion]
joint_speed = 0.4
linear_speed = 0.1
"""


def varied(random: Random) -> tuple[str, str]:
    """The net and the cell.toml with other numbers; in some the arms work at the same time."""

    def real(low: float, high: float) -> str:
        return f"{random.uniform(low, high):.1f}".replace("-", "~")

    net = NET
    if random.random() < 0.6:
        net = net.replace("      out f1 : n\n", "      out f1 : n\n      out f2 : n\n", 1)
        net = net.replace("      in d1 : n\n      out f2 : n\n", "      in d1 : n\n", 1)
    net = net.replace("at (~100.0, ~60.0, 60.0)", f"at ({real(-160, 0)}, {real(-90, 90)}, 60.0)")
    seam = f"at ({real(0, 160)}, {real(-90, 90)}, {real(-30, 40)}), {real(-200, 500)}"
    net = net.replace("at (100.0, ~60.0, 15.0), 300.0", seam)
    net = net.replace("30.0 * Real.fromInt n", f"{real(-60, 60)} * Real.fromInt n")
    y, along = real(60, 700), real(-200, 400)
    net = net.replace("(at (0.0, 950.0, 1000.0), 200.0)", f"(at (0.0, {y}, 1000.0), {along})")
    net = net.replace("at (60.0, 950.0, 1000.0)", f"at ({real(-200, 200)}, {y}, {real(780, 1000)})")
    apart, long = random.uniform(1.5, 2.1), random.uniform(0.3, 1.6)
    toml = TOML.replace("y = 2.0, z = 0.3", f"y = {apart:.3f}, z = 0.3")
    return net, toml.replace("[0.4, 0.2, 0.05]", f"[{long:.3f}, 0.2, 0.05]")


def welding_cell(folder: Path, net: str = NET, toml: str = TOML) -> Path:
    """Writes the cell; its folder."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn(net))
    (folder / "cell.toml").write_text(toml, encoding="utf-8")
    return folder
