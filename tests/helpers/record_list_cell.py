"""A cell whose messages are lists of records: a camera finds defects, and a robot goes to each of them."""

from __future__ import annotations

from pathlib import Path

from helpers import small_cell

NET = """
net cell
  standard
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  colset KIND = with scratch | burn;
  colset SPOT = int with 0..9;
  colset AREA = record wide : REAL * deep : INT;
  colset DEFECT = record spot : SPOT * kind : KIND * area : AREA;
  colset DEFECTS = list DEFECT with 0..3;
  colset SEEING = product SPOT * DEFECTS;
  colset STATION = product POSE * KIND;
  colset WAY = list STATION with 0..3;
  colset JOB = record name : STRING * way : WAY * fast : BOOL;
  colset MENDED = product SPOT * BOOL;
  colset ALL_MENDED = list MENDED with 0..3;
  colset RESULT = product ALL_MENDED * INT;
  colset WORK = product WAY * ALL_MENDED;
  fun moveJoint (p : POSE) = ();
  fun at n = {x = 1500.0 + 100.0 * Real.fromInt n, y = 0.5, z = 1500.0, rx = 0.0, ry = 90.0, rz = 0.0};
  fun station (d : DEFECT) = (at (#spot d), #kind d);
  var n, k : INT;
  var s : STRING;
  var b : BOOL;
  var p : POSE;
  var c : KIND;
  var i : SPOT;
  var w : REAL;
  var ds, rest : DEFECTS;
  var way, others : WAY;
  var m, mended : ALL_MENDED;
  page Top
    place look : SPOT
    place found : DEFECTS
    place job : JOB
    place result : RESULT
    subst Supervisor = Sup (look -> look, found -> found, job -> job, result -> result)
    subst Camera = Cam (look -> look, found -> found)
    subst Robot = Rob (job -> job, result -> result)
  page Sup
    place look port out : SPOT
    place found port in : DEFECTS
    place job port out : JOB
    place result port in : RESULT
    place Rounds : SPOT = 1`0
    place Looking : SPOT
    place Working : SPOT
    place Finished : RESULT
    trans Ask guard [i < 3]
      in Rounds : i
      out Looking : i
      out look : i
    trans Seen
      in Looking : i
      in found : ds
      out Working : i
      out job : {name = "job", way = List.map station ds, fast = length ds > 1}
    trans Again guard [i < 2, length m = i]
      in Working : i
      in result : (m, k)
      out Rounds : i + 1
    trans Finish guard [i >= 2]
      in Working : i
      in result : (m, k)
      out Finished : (m, k)
  page Cam
    place look port in : SPOT
    place found port out : DEFECTS
    place Waiting = 1
    place Seeing : SEEING
    trans Begin
      in Waiting : ()
      in look : i
      out Seeing : (i, [])
    trans More guard [i > 0]
      in Seeing : (i, ds)
      out Seeing : (i - 1, {spot = i, kind = if i > 1 then burn else scratch,
                            area = {wide = 0.5 * Real.fromInt i, deep = i}} :: ds)
    trans Tell
      in Seeing : (0, ds)
      out found : ds
      out Waiting : ()
  page Rob
    place job port in : JOB
    place result port out : RESULT
    place Waiting = 1
    place Working : WORK
    place Count : INT = 1`0
    trans Begin
      in Waiting : ()
      in job : {name = s, way = way, fast = b}
      out Working : (if b then rev way else way, [])
    trans Go code input (p); action moveJoint p
      in Working : ((p, c) :: others, m)
      out Working : (others, (length m, c = burn) :: m)
      in Count : k
      out Count : k + 1
    trans Report
      in Working : ([], m)
      in Count : k
      out Count : k
      out result : (rev m, k)
      out Waiting : ()
"""

TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "look"
file = "look.robcad"
[[channel]]
place = "found"
file = "found.robcad"
[[channel]]
place = "job"
file = "job.robcad"
[[channel]]
place = "result"
file = "result.robcad"
kind = "flag"
[primitives]
moveJoint = { command = "move_joint" }
[robots.robot1]
instance = "Robot"
model = "kr210_r2700"
base = { x = 0.0, y = 0.0, z = 0.0, roll = 0.0, pitch = 0.0, yaw = 0.0 }
[devices.camera]
instance = "Camera"
"""


def write(folder: Path, net: str = NET, toml: str = TOML) -> Path:
    """The cell as files; gives the folder."""
    return small_cell.write(folder, net, toml)
