"""Two arms that face each other and work at the same point between them, one after the other or not."""

from __future__ import annotations

from pathlib import Path

from helpers.netbuilder import cpn

NET = """
net meeting
  standard
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  fun moveJoint (p : POSE) = ();
  fun moveLinear (p : POSE) = ();
  fun moveHome () = ();
  fun work () = ();
  fun at (z, rz) : POSE = {x = 1500.0, y = 0.0, z = z, rx = 180.0, ry = 0.0, rz = rz};
  fun come rz = (moveJoint (at (1100.0, rz)); moveLinear (at (700.0, rz)));
  fun visit rz = (come rz; work (); moveLinear (at (1100.0, rz)); moveHome ());
  var n : INT;
  page Top
    place f1 : INT
    place d1 : INT
    place f2 : INT
    place d2 : INT
    subst Supervisor = Sup (f1 -> f1, d1 -> d1, f2 -> f2, d2 -> d2)
    subst Robot1 = Rob1 (f -> f1, d -> d1)
    subst Robot2 = Rob2 (f -> f2, d -> d2)
  page Sup
    place f1 port out : INT
    place d1 port in : INT
    place f2 port out : INT
    place d2 port in : INT
    place Left1 : INT = 1`2
    place Left2 : INT = 1`2
    place Busy1 : INT
    place Busy2 : INT
    place Done1
    place Done2
    place Free = 1
    place Finished
    trans Send1 guard [n > 0]
      in Left1 : n
      TAKE
      out f1 : n
      out Busy1 : n
    trans Got1
      in Busy1 : n
      in d1 : n
      GIVE
      out Left1 : n - 1
    trans Send2 guard [n > 0]
      in Left2 : n
      TAKE
      out f2 : n
      out Busy2 : n
    trans Got2
      in Busy2 : n
      in d2 : n
      GIVE
      out Left2 : n - 1
    trans End1 guard [n = 0]
      in Left1 : n
      out Done1 : ()
    trans End2 guard [n = 0]
      in Left2 : n
      out Done2 : ()
    trans Finish
      in Done1 : ()
      in Done2 : ()
      out Finished : ()
  page Rob1
    place f port in : INT
    place d port out : INT
    place Waiting = 1
    trans Visit1 code input (n) action (visit 0.0)
      in Waiting : ()
      in f : n
      out d : n
      out Waiting : ()
  page Rob2
    place f port in : INT
    place d port out : INT
    place Waiting = 1
    trans Visit2 code input (n) action (visit 180.0)
      in Waiting : ()
      in f : n
      out d : n
      out Waiting : ()
"""

TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
order = "documented"
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
moveJoint = { command = "move_joint" }
moveLinear = { command = "move_linear", frame = "world" }
moveHome = { command = "move_home" }
work = { command = "tool", action = "work", duration_s = 1.0 }
[robots.robot1]
instance = "Robot1"
model = "kr120_r2500"
tool = "counterpoint"
base = { x = 0.0, y = 0.0, z = 0.0, yaw = 0.0 }
home = [0.0, -120.0, 125.0, 0.0, 85.0, 0.0]
[robots.robot2]
instance = "Robot2"
model = "kr120_r2500"
tool = "counterpoint"
base = { x = 3.0, y = 0.0, z = 0.0, yaw = 180.0 }
home = [0.0, -120.0, 125.0, 0.0, 85.0, 0.0]
[motion]
joint_speed = 0.5
linear_speed = 0.4
"""


def meeting_cell(folder: Path, *, guarded: bool, net: str = NET, toml: str = TOML) -> Path:
    """Writes the cell: with `guarded` the supervisor lets one arm in at a time."""
    folder.mkdir(parents=True, exist_ok=True)
    take, give = ("in Free : ()", "out Free : ()") if guarded else ("", "")
    (folder / "cell.cpn").write_bytes(cpn(net.replace("TAKE", take).replace("GIVE", give)))
    (folder / "cell.toml").write_text(toml)
    return folder
