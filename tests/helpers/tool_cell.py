"""A cell whose arm changes tools: a job says whether it carries a part or drives a screw, and with which tool.

folder = tool_cell(tmp_path / "cell")
folder = tool_cell(tmp_path / "cell", NET.replace(...), TOML.replace(...))
cell = placed()                     # its geometry, without the net
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from helpers.cell_texts import head
from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load

_NET = """
net tools
  standard
  colset JOB = with carry | drive;
  colset NUM = int with 0..9;
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  fun toRack (p : POSE) = ();
  fun inRack (p : POSE) = ();
  fun goTo (p : POSE) = ();
  fun line (p : POSE) = ();
  fun home () = ();
  fun takeGripper () = ();
  fun leaveGripper () = ();
  fun takeDriver () = ();
  fun leaveDriver () = ();
  fun grip () = ();
  fun release () = ();
  fun driveIt () = ();
  fun at (x, y, z) : POSE = {x = x, y = y, z = z, rx = 180.0, ry = 0.0, rz = 0.0};
  val gripperAt = at (300.0, ~900.0, 750.0);
  val driverAt = at (~300.0, ~900.0, 750.0);
  fun over (p : POSE) = at (#x p, #y p, 1150.0);
  fun into p = (toRack (over p); inRack p);
  fun outOf p = inRack (over p);
  fun pick p = (goTo (at (#x p, #y p, 700.0)); line p; grip (); line (at (#x p, #y p, 700.0)));
  fun put p = (goTo (at (#x p, #y p, 700.0)); line p; release (); line (at (#x p, #y p, 700.0)));
  fun screw p = (goTo (at (#x p, #y p, 700.0)); line p; driveIt (); line (at (#x p, #y p, 700.0)));
  val jobs = [JOBS];
  var j, k : JOB;
  var n : NUM;
  page Top
    place order : JOB
    place done : JOB
    subst Supervisor = Sup (order -> order, done -> done)
    subst Arm = Arm (order -> order, done -> done)
  page Sup
    place order port out : JOB
    place done port in : JOB
    place Next : NUM = 1`0
    place Doing : NUM
    place Finished
    trans Order guard [n < length jobs]
      in Next : n
      out order : List.nth (jobs, n)
      out Doing : n
    trans Done
      in Doing : n
      in done : j
      out Next : n + 1
    trans Finish guard [n >= length jobs]
      in Next : n
      out Finished : ()
  page Arm
    place order port in : JOB
    place done port out : JOB
    place Waiting = 1
    place Told : JOB
    place Did : JOB
    trans Accept
      in Waiting : ()
      in order : j
      out Told : j
    trans Carry guard [j = carry] code action (CARRY)
      in Told : j
      out Did : j
    trans Drive guard [j = drive] code action (DRIVE)
      in Told : j
      out Did : j
    trans Report code action (REPORT)
      in Did : j
      out done : j
      out Waiting : ()
"""
CARRY = (
    "into gripperAt; takeGripper (); outOf gripperAt; home (); pick (at (1000.0, 300.0, 500.0)); "
    "put (at (1000.0, ~300.0, 500.0)); home (); into gripperAt; leaveGripper (); outOf gripperAt"
)
DRIVE = (
    "into driverAt; takeDriver (); outOf driverAt; home (); screw (at (1000.0, 0.0, 450.0)); home (); "
    "into driverAt; leaveDriver (); outOf driverAt"
)
"""Between the rack and the stand the arm goes by HOME, where it is above what lies in the rack."""
TOML = (
    head("order", "done")
    + """
[primitives]
toRack = { command = "move_joint", tcp = "coupling" }
inRack = { command = "move_linear", frame = "world", tcp = "coupling", speed = 0.25 }
goTo = { command = "move_joint" }
line = { command = "move_linear", frame = "world", speed = 0.25 }
home = { command = "move_home" }
takeGripper = { command = "tool", action = "lock", duration_s = 1.0, couples = "gripper" }
leaveGripper = { command = "tool", action = "unlock", duration_s = 1.0, uncouples = "gripper" }
takeDriver = { command = "tool", action = "lock", duration_s = 1.0, couples = "driver" }
leaveDriver = { command = "tool", action = "unlock", duration_s = 1.0, uncouples = "driver" }
grip = { command = "tool", action = "grip", duration_s = 0.5, takes = "blank" }
release = { command = "tool", action = "release", duration_s = 0.3, releases = "blank" }
driveIt = { command = "tool", action = "drive", duration_s = 2.0 }

[tools.gripper]
model = "vacuum_gripper"
rack = "rackLeft"
holders = ["rack"]
takes = ["blank"]

[tools.driver]
model = "driver.urdf"
rack = "rackRight"
does = ["drive"]

[robots.arm]
instance = "Arm"
model = "gp25"
base = { z = 0.3 }
home = [0.0, 0.0, 0.0, 0.0, -90.0, 0.0]
tools = ["gripper", "driver"]

[robots.arm.tcps.coupling]

[parts.blank]
size = [0.1, 0.1, 0.1]
mass = 2.0
at = [{ x = 1.0, y = 0.3, z = 0.45 }]
grips = [{ z = 0.05, roll = 180.0 }]

[places.rackLeft]
x = 0.3
y = -0.9
z = 0.75
roll = 180.0

[places.rackRight]
x = -0.3
y = -0.9
z = 0.75
roll = 180.0

[scene]
objects = [
    { name = "rack", size = [1.0, 0.3, 0.4], pose = { y = -0.9, z = 0.2 } },
    { name = "stand", size = [0.5, 1.0, 0.4], pose = { x = 1.0, z = 0.2 } },
]
"""
)
DRIVER = """\
<robot name="driver">
  <link name="body">
    <inertial><origin xyz="0 0 0.08"/><mass value="5"/></inertial>
    <visual><origin xyz="0 0 0.08"/><geometry><box size="0.1 0.1 0.16"/></geometry></visual>
    <collision><origin xyz="0 0 0.08"/><geometry><box size="0.1 0.1 0.16"/></geometry></collision>
  </link>
  <link name="bit">
    <visual><origin xyz="0 0 0.06"/><geometry><cylinder radius="0.01" length="0.12"/></geometry></visual>
    <collision><origin xyz="0 0 0.06"/><geometry><cylinder radius="0.01" length="0.12"/></geometry></collision>
  </link>
  <link name="tcp"/>
  <joint name="a" type="fixed"><origin xyz="0 0 0.16"/><parent link="body"/><child link="bit"/></joint>
  <joint name="b" type="fixed"><origin xyz="0 0 0.12"/><parent link="bit"/><child link="tcp"/></joint>
</robot>
"""
"""A screw driver of 5 kg, 0.28 m long."""


def net(
    jobs: str = "carry, drive", carry: str = CARRY, drive: str = DRIVE, report: str = "home ()"
) -> str:
    """What the arm does on each job, and when it reports; and which jobs there are."""
    return (
        _NET.replace("[JOBS]", f"[{jobs}]")
        .replace("(CARRY)", f"({carry})")
        .replace("(DRIVE)", f"({drive})")
        .replace("(REPORT)", f"({report})")
    )


def asking(text: str) -> str:
    """The same net, in which the arm does not do as it is told, but asks a sensor."""
    return text.replace("in order : j\n      out Told : j", "in order : k\n      out Told : j")


def tool_cell(folder: Path, text: str = "", toml: str = TOML) -> Path:
    """Writes the cell; its folder."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn(text or net()))
    (folder / "cell.toml").write_text(toml, encoding="utf-8")
    (folder / "driver.urdf").write_text(DRIVER, encoding="utf-8")
    return folder


def placed(folder: Path, toml: str = TOML) -> tuple[RobotCell | None, Diagnostics]:
    """What stands in it, and what is wrong with it."""
    (folder / "driver.urdf").write_text(DRIVER, encoding="utf-8")
    data: dict[str, Any] = tomllib.loads(toml)
    d = Diagnostics()
    return load(data, folder, lambda *_: Origin("cell.toml"), d), d
