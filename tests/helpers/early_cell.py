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


POLLING = """    trans Poll
      in Asked : ()
      out Asked : ()@+1
"""
UNREACHED = "far {x = 9000.0, y = 0.0, z = 0.0, rx = 0.0, ry = 0.0, rz = 0.0}"


def unreached() -> tuple[str, str]:
    """Another one, as net and cell.toml: the robot is told what it cannot do, while its supervisor looks each second.

    It answers afterwards.
    """
    net = NET.replace(
        "  fun far () = ();\n",
        "  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;\n"
        "  fun far (p : POSE) = ();\n",
    ).replace("action far ()", f"action {UNREACHED}")
    net = net.replace("      out Told : ()\n      out d : ()\n", "      out Told : ()\n")
    net = net.replace("      out Waiting : ()\n", "      out Waiting : ()\n      out d : ()\n")
    net = net.replace("    place Busy\n", "    place Busy\n    place Asked : T\n")
    net = net.replace("      out Busy : ()\n", "      out Busy : ()\n      out Asked : ()@+1\n")
    net = net.replace("    trans Done\n", POLLING + "    trans Done\n")
    toml = TOML.replace(
        'far = { command = "tool", action = "far", duration_s = 7.0 }',
        'far = { command = "move_joint" }',
    )
    return net, toml


def write(folder: Path, waits: int = 0, net: str = NET, toml: str = TOML) -> Path:
    """The cell as files; the robot `waits` so many seconds after its answer."""
    if waits:
        net = net.replace("      out Told : ()\n", f"      out Told : ()@+{waits}\n")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn(net))
    (folder / "cell.toml").write_text(toml, encoding="utf-8")
    return folder
