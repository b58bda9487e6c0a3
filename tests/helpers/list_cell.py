"""A cell whose messages are lists: a robot goes along the route that it gets, and answers with what it has done."""

from __future__ import annotations

from pathlib import Path

from helpers import small_cell

NET = """
net cell
  standard
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  colset ROUTE = list POSE;
  colset GRADE = with fine | poor;
  colset ITEM = int with 0..9;
  colset ITEMS = list ITEM with 0..3;
  colset JOB = record name : STRING * items : ITEMS * bonus : BOOL;
  colset GRADES = list GRADE;
  colset SEEN = product GRADES * INT;
  colset WORK = product ITEMS * GRADES;
  fun moveJoint (p : POSE) = ();
  fun at n = {x = 1500.0 + 100.0 * Real.fromInt n, y = 0.5, z = 1500.0, rx = 0.0, ry = 90.0, rz = 0.0};
  fun items 0 = [] | items 1 = [1, 2, 9] | items _ = [7];
  var n, k: INT;
  var s: STRING;
  var b: BOOL;
  var p: POSE;
  var i: ITEM;
  var route, way: ROUTE;
  var l, m: ITEMS;
  var g: GRADES;
  page Top
    place route : ROUTE
    place job : JOB
    place seen : SEEN
    subst Supervisor = Sup (route -> route, job -> job, seen -> seen)
    subst Robot = Rob (route -> route, job -> job, seen -> seen)
  page Sup
    place route port out : ROUTE
    place job port out : JOB
    place seen port in : SEEN
    place Rounds : INT = 1`0
    place Asked : INT
    place Finished : SEEN
    trans Ask guard [n < 3]
      in Rounds : n
      out Asked : n
      out route : List.tabulate (n, at)
      out job : {name = "job", items = items n, bonus = n > 0}
    trans Again guard [n < 2, length g = length (items n)]
      in Asked : n
      in seen : (g, k)
      out Rounds : n + 1
    trans Finish guard [n >= 2]
      in Asked : n
      in seen : (g, k)
      out Finished : (g, k)
  page Rob
    place route port in : ROUTE
    place job port in : JOB
    place seen port out : SEEN
    place Waiting = 1
    place Way : ROUTE
    place Working : WORK
    place Count : INT = 1`0
    trans Accept
      in Waiting : ()
      in route : route
      out Way : route
    trans Go code input (p); action moveJoint p
      in Way : p :: way
      out Way : way
      in Count : k
      out Count : k + 1
    trans Begin
      in Way : []
      in job : {name = s, items = l, bonus = b}
      out Working : (if b then l else rev l, [])
    trans Work guard [l <> []]
      in Working : (l, g)
      out Working : (tl l, (if hd l > 5 then poor else fine) :: g)
    trans Report guard [l = []]
      in Working : (l, g)
      in Count : k
      out Count : k
      out seen : (rev g, k)
      out Waiting : ()
"""

TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "route"
file = "route.robcad"
[[channel]]
place = "job"
file = "job.robcad"
[[channel]]
place = "seen"
file = "seen.robcad"
kind = "flag"
[primitives]
moveJoint = { command = "move_joint" }
[robots.robot1]
instance = "Robot"
model = "kr210_r2700"
base = { x = 0.0, y = 0.0, z = 0.0, roll = 0.0, pitch = 0.0, yaw = 0.0 }
"""


def write(folder: Path, net: str = NET, toml: str = TOML) -> Path:
    """The cell as files; gives the folder."""
    return small_cell.write(folder, net, toml)
