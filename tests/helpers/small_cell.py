"""A cell that fits on a page: a supervisor that has pieces drilled by one robot, with a choice and a count."""

from __future__ import annotations

from pathlib import Path

from helpers.netbuilder import cpn

NET = """
net cell
  standard
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  val MOVE = 1; val DRILL = 2; val HOME = 3;
  fun moveJoint (p : POSE) = ();
  fun moveHome () = ();
  fun drill () = ();
  fun at n = {x = 100.0 * Real.fromInt n, y = 0.5, z = 0.0, rx = 0.0, ry = 0.0, rz = 90.0}
  var n, k: INT;
  var p: POSE;
  page Top
    place data : POSE
    place flag : INT
    place done : INT
    subst Supervisor = Sup (data -> data, flag -> flag, done -> done)
    subst Robot = Rob (data -> data, flag -> flag, done -> done)
  page Sup
    place data port out : POSE
    place flag port out : INT
    place done port in : INT
    place Pieces : INT = 1`1
    place Ready = 1
    place Moving : INT
    place Drilling : INT
    place Going = 0
    place Finished : INT
    trans Next guard [n <= 3]
      in Pieces : n
      out Pieces : n + 1
      in Ready : ()
      out data : at n
      out flag : MOVE
      out Moving : n
    trans Arrived guard [n <> 2]
      in Moving : n
      in done : 1
      out flag : DRILL
      out Drilling : n
    trans Skipped guard [n = 2]
      in Moving : n
      in done : 1
      out Ready : ()
    trans Drilled guard [n < 3]
      in Drilling : n
      in done : k
      out Ready : ()
    trans Last guard [n >= 3]
      in Drilling : n
      in done : k
      out flag : HOME
      out Going : ()
    trans End
      in Going : ()
      in done : k
      out Finished : k
  page Rob
    place data port in : POSE
    place flag port in : INT
    place done port out : INT
    place Waiting = 1
    place Told : INT
    place Over
    trans Accept
      in Waiting : ()
      in flag : k
      out Told : k
    trans Move guard [k = MOVE] code input (p); action moveJoint p
      in Told : k
      in data : p
      out Over : ()
    trans Drill guard [k = DRILL] code action drill ()
      in Told : k
      out Over : ()
    trans GoHome guard [k = HOME] code action moveHome ()
      in Told : k
      out Over : ()
    trans Report
      in Over : ()
      out Waiting : ()
      out done : 1
"""

TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "data"
file = "data.robcad"
kind = "data"
[[channel]]
place = "flag"
file = "flag.robcad"
kind = "flag"
[[channel]]
place = "done"
file = "done.robcad"
kind = "flag"
[primitives]
moveJoint = { command = "move_joint" }
moveHome = { command = "move_home" }
drill = { command = "tool", action = "drill", duration_s = 1.0 }
[robots.robot1]
instance = "Robot"
"""


def write(folder: Path, net: str = NET, toml: str = TOML) -> Path:
    """The cell as files; gives the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn(net))
    (folder / "cell.toml").write_text(toml, encoding="utf-8")
    return folder
