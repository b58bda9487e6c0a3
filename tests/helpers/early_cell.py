"""A robot that answers before it moves: the supervisor has finished then, and the robot begins nothing more."""

from __future__ import annotations

from pathlib import Path

from helpers.netbuilder import cpn

NET = """
net early
  standard
  colset T = unit timed;
  fun near () = ();
  fun grip () = ();
  fun far () = ();
  page Top
    place f1
    place d1
    subst Supervisor = Sup (f1 -> f1, d1 -> d1)
    subst Robot = Rob (f -> f1, d -> d1)
  page Sup
    place f1 port out
    place d1 port in
    place Ready = ()
    place Busy
    place Finished
    trans Start
      in Ready : ()
      out f1 : ()
      out Busy : ()
    trans Done
      in Busy : ()
      in d1 : ()
      out Finished : ()
  page Rob
    place f port in
    place d port out
    place Waiting = ()
    place Told : T
    place Held
    place Over
    trans Accept
      in Waiting : ()
      in f : ()
      out Told : ()
      out d : ()
    trans Near code action (near (); grip ())
      in Told : ()
      out Held : ()
    trans Far code action far ()
      in Held : ()
      out Over : ()
    trans Back
      in Over : ()
      out Waiting : ()
"""

TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "f1"
file = "f1.txt"
[[channel]]
place = "d1"
file = "d1.txt"
[primitives]
near = { command = "tool", action = "drill", duration_s = 2.0 }
grip = { command = "tool", action = "grip", duration_s = 3.0 }
far = { command = "tool", action = "far", duration_s = 7.0 }
[robots.robot1]
instance = "Robot"
model = "gp25"
base = { x = 0.0, y = 0.0, z = 0.0, yaw = 0.0 }
"""


def write(folder: Path, waits: int = 0) -> Path:
    """The cell as files; the robot `waits` so many seconds after its answer."""
    net = NET.replace("      out Told : ()\n", f"      out Told : ()@+{waits}\n") if waits else NET
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn(net))
    (folder / "cell.toml").write_text(TOML, encoding="utf-8")
    return folder
