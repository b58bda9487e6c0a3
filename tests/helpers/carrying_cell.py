"""A cell that carries parts: a feeder puts boxes on a table, a robot with a vacuum gripper sets them side by side."""

from __future__ import annotations

from pathlib import Path

from helpers.cell_texts import head
from helpers.netbuilder import cpn

NET = """
net carrying
  standard
  colset PART = int with 1..9;
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  val parts = 2;
  fun moveJoint (p : POSE) = ();
  fun moveLinear (p : POSE) = ();
  fun moveHome () = ();
  fun grip () = ();
  fun release () = ();
  fun feed () = ();
  fun at (x, y, z) : POSE = {x = x, y = y, z = z, rx = 180.0, ry = 0.0, rz = 0.0};
  fun slot n = at (1200.0 + 250.0 * Real.fromInt (n mod 2), 600.0 + 250.0 * Real.fromInt (n div 2), 150.0);
  fun up (p : POSE) = at (#x p, #y p, 900.0);
  fun go p = (moveJoint (up p); moveLinear p);
  val infeed = at (1500.0, ~600.0, 650.0);
  fun fetch () = (go infeed; grip (); moveLinear (up infeed));
  var n : PART;
  page Top
    place order : PART
    place placed : PART
    place wanted : PART
    place fed : PART
    subst Supervisor = Sup (order -> order, placed -> placed, wanted -> wanted, fed -> fed)
    subst Robot = Rob (order -> order, placed -> placed)
    subst Feeder = Fee (wanted -> wanted, fed -> fed)
  page Sup
    place order port out : PART
    place placed port in : PART
    place wanted port out : PART
    place fed port in : PART
    place Next : PART = 1`1
    place Feeding : PART
    place Placing : PART
    place Finished
    trans Want guard [n <= parts]
      in Next : n
      out wanted : n
      out Feeding : n
    trans Order
      in Feeding : n
      in fed : n
      out order : n
      out Placing : n
    trans Placed
      in Placing : n
      in placed : n
      out Next : n + 1
    trans Finish guard [n > parts]
      in Next : n
      out Finished : ()
  page Rob
    place order port in : PART
    place placed port out : PART
    place Waiting = 1
    place Told : PART
    place Done : PART
    trans Accept
      in Waiting : ()
      in order : n
      out Told : n
    trans Place code input (n) action (fetch (); go (slot n); release (); moveLinear (up (slot n)))
      in Told : n
      out Done : n
    trans Report
      in Done : n
      out placed : n
      out Waiting : ()
  page Fee
    place wanted port in : PART
    place fed port out : PART
    place Idle = 1
    place Busy : PART
    trans Begin
      in Idle : ()
      in wanted : n
      out Busy : n
    trans Feed code input (n) action (feed ())
      in Busy : n
      out fed : n
      out Idle : ()
"""

TOML = (
    head("order", "placed", "wanted", "fed")
    + """\
[primitives]
moveJoint = { command = "move_joint" }
moveLinear = { command = "move_linear", frame = "world" }
moveHome = { command = "move_home" }
grip = { command = "tool", action = "suck", duration_s = 0.5, takes = "box" }
release = { command = "tool", action = "blow", duration_s = 0.3, releases = "box" }
feed = { command = "tool", action = "feed", duration_s = 2.0, creates = "box", at = "infeed" }
[robots.robot]
instance = "Robot"
model = "kr120_r2500"
tool = "vacuum_gripper"
base = { x = 0.0, y = 0.0, z = 0.0 }
home = [0.0, -90.0, 90.0, 0.0, 90.0, 0.0]
[devices.feeder]
instance = "Feeder"
[motion]
linear_speed = 0.5
[parts.box]
kind = "box"
size = [0.2, 0.2, 0.15]
colour = [0.75, 0.55, 0.35]
grips = [{ z = 0.075, roll = 180.0 }]
[places.infeed]
x = 1.5
y = -0.6
z = 0.575
[scene]
objects = [{ name = "table", size = [0.4, 0.4, 0.5], pose = { x = 1.5, y = -0.6, z = 0.25 } }]
"""
)


def write(folder: Path, net: str = NET, toml: str = TOML) -> Path:
    """The cell as files; gives the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn(net))
    (folder / "cell.toml").write_text(toml)
    return folder
