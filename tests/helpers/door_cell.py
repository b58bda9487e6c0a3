"""A mill with a sliding door and a clamp: an arm brings a blank, the mill holds it, and the door closes.

folder = door_cell(tmp_path / "cell")
folder = door_cell(tmp_path / "cell", NET.replace(...), TOML.replace(...))
"""

from __future__ import annotations

from pathlib import Path

from helpers.cell_texts import ARM, GOING, head
from helpers.netbuilder import cpn


def _ports(*names: str) -> str:
    return ", ".join(f"{name} -> {name}" for name in names)


_MILL = ("open", "opened", "work", "worked", "clamp", "clamped")
_ARM = ("load", "loaded", "leave", "left")
_NET = """
net mill
  standard
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  fun openDoor () = ();
  fun closeDoor () = ();
  fun openVice () = ();
  fun clampTo (mm : real) = ();
  fun mill () = ();
  fun goTo (p : POSE) = ();
  fun line (p : POSE) = ();
  fun home () = ();
  fun grip () = ();
  fun release () = ();
  fun at (x, y, z) : POSE = {x = x, y = y, z = z, rx = 180.0, ry = 0.0, rz = 0.0};
  val rack = at (0.0, ~900.0, 650.0);
  val bed = at (1000.0, 0.0, 750.0);
  val above = at (1000.0, 0.0, 900.0);
  val front = at (600.0, 0.0, 900.0);
  fun fetch () = (goTo (at (0.0, ~900.0, 750.0)); line rack; grip (); line (at (0.0, ~900.0, 750.0)));
  page Top
    place open
    place opened
    place load
    place loaded
    place leave
    place left
    place work
    place worked
    place clamp
    place clamped
    subst Supervisor = Sup (SUPERVISOR)
    subst Mill = Mill (MILL)
    subst Arm = Arm (ARM)
  page Sup
    place open port out
    place opened port in
    place load port out
    place loaded port in
    place leave port out
    place left port in
    place work port out
    place worked port in
    place clamp port out
    place clamped port in
    place Ready = 1
    place Opening
    place Loading
    place Clamping
    place Leaving
    place Working
    place Finished
    trans Open
      in Ready
      out open
      out Opening
    trans Load
      in Opening
      in opened
      out load
      out Loading
    trans Clamp
      in Loading
      in loaded
      out clamp
      out Clamping
    trans Leave
      in Clamping
      in clamped
      out leave
      out Leaving
    trans Work
      in Leaving
      in left
      out work
      out Working
    trans Finish
      in Working
      in worked
      out Finished
  page Mill
    place open port in
    place opened port out
    place work port in
    place worked port out
    place clamp port in
    place clamped port out
    place Closed = 1
    place Opening
    place Open
    place Clamping
    place Clamped
    place Working
    trans BeginOpening
      in Closed
      in open
      out Opening
    trans OpenIt code action (openVice (); openDoor ())
      in Opening
      out opened
      out Open
    trans BeginClamping
      in Open
      in clamp
      out Clamping
    trans ClampIt code action (clampTo 59.8)
      in Clamping
      out clamped
      out Clamped
    trans BeginWork
      in Clamped
      in work
      out Working
    trans MillIt code action (closeDoor (); mill ())
      in Working
      out worked
      out Closed
  page Arm
    place load port in
    place loaded port out
    place leave port in
    place left port out
    place Waiting = 1
    place Told
    place There
    place Going
    trans Accept
      in Waiting
      in load
      out Told
    trans Bring code action (fetch (); goTo front; line above; line bed)
      in Told
      out loaded
      out There
    trans Accept2
      in There
      in leave
      out Going
    trans Away code action (release (); line above; line front; home ())
      in Going
      out left
      out Waiting
"""

NET = (
    _NET.replace("(SUPERVISOR)", f"({_ports(*_MILL, *_ARM)})")
    .replace("(MILL)", f"({_ports(*_MILL)})")
    .replace("(ARM)", f"({_ports(*_ARM)})")
)
TOML = (
    head("open", "opened", "load", "loaded", "leave", "left", "work", "worked", "clamp", "clamped")
    + """
[primitives]
openDoor = { command = "move_external", axis = "door", to = 0.9 }
closeDoor = { command = "move_external", axis = "door", to = 0.0, speed = 0.5 }
openVice = { command = "move_external", axis = "vice", to = 0.12 }
clampTo = { command = "move_external", axis = "vice" }
mill = { command = "tool", action = "mill", duration_s = 2.0 }
"""
    + f"{GOING}\n{ARM}"
    + """
[devices.mill]
instance = "Mill"

[devices.mill.axes.door]
kind = "slide"
pose = { x = 0.78, z = 0.85 }
direction = [0.0, 1.0, 0.0]
from = 0.0
to = 0.9
speed = 0.6
objects = [{ name = "leaf", size = [0.02, 0.8, 0.6], colour = [0.4, 0.55, 0.7, 0.5] }]

[devices.mill.axes.vice]
kind = "clamp"
pose = { x = 1.0, z = 0.62, yaw = 90.0 }
from = 0.02
to = 0.12
home = 0.04
speed = 0.05
jaw = [0.04, 0.1, 0.06]
holds = "inVice"

[parts.blank]
size = [0.1, 0.06, 0.15]
colour = [0.75, 0.75, 0.78]
at = [{ y = -0.9, z = 0.575 }]
grips = [{ z = 0.075, roll = 180.0 }]

[places.inVice]
x = 1.0
z = 0.675

[scene]
objects = [
    { name = "rack", size = [0.3, 0.3, 0.5], pose = { y = -0.9, z = 0.25 } },
    { name = "bed", size = [0.3, 0.3, 0.58], pose = { x = 1.0, z = 0.29 } },
    { name = "block", size = [0.06, 0.03, 0.02], pose = { x = 1.0, z = 0.59 } },
]
"""
)


def door_cell(folder: Path, net: str = NET, toml: str = TOML) -> Path:
    """Writes the cell; its folder."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn(net))
    (folder / "cell.toml").write_text(toml, encoding="utf-8")
    return folder
