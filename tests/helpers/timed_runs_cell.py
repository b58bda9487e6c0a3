"""A cell of two devices whose cycle depends on a sensor: a drill that may have to drill again, and a press."""

from __future__ import annotations

from pathlib import Path

from helpers.netbuilder import cpn

NET = """
net times
  standard
  colset VERDICT = with good | bad;
  colset TRIES = int with 0..1;
  fun drill () = ();
  fun press () = ();
  var v : VERDICT;
  var n : TRIES;
  page Top
    place f1
    place d1 : VERDICT
    place f2
    place d2
    subst Supervisor = Sup (f1 -> f1, d1 -> d1, f2 -> f2, d2 -> d2)
    subst Drill = Drill (f -> f1, d -> d1)
    subst Press = Press (f -> f2, d -> d2)
  page Sup
    place f1 port out
    place d1 port in : VERDICT
    place f2 port out
    place d2 port in
    place Ready = ()
    place Busy1 : TRIES
    place Busy2
    place Done1
    place Done2
    place Finished
    trans Start
      in Ready : ()
      out f1 : ()
      out f2 : ()
      out Busy1 : 0
      out Busy2 : ()
    trans Good
      in Busy1 : n
      in d1 : good
      out Done1 : ()
    trans Again guard [n < 1]
      in Busy1 : n
      in d1 : bad
      out f1 : ()
      out Busy1 : AGAIN
    trans "Give Up" guard [n >= 1]
      in Busy1 : n
      in d1 : bad
      out Done1 : ()
    trans Pressed
      in Busy2 : ()
      in d2 : ()
      out Done2 : ()
    trans End
      in Done1 : ()
      in Done2 : ()
      out Finished : ()
  page Drill
    place f port in
    place d port out : VERDICT
    place Waiting = ()
    place Told
    place Drilled
    trans Accept
      in Waiting : ()
      in f : ()
      out Told : ()
    trans Drill code action drill ()
      in Told : ()
      out Drilled : ()
    trans Inspect
      in Drilled : ()
      out d : v
      out Waiting : ()
  page Press
    place f port in
    place d port out
    place Waiting = ()
    place Told
    trans Accept
      in Waiting : ()
      in f : ()
      out Told : ()
    trans Press code action press ()
      in Told : ()
      out Waiting : ()
      out d : ()
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
[[channel]]
place = "f2"
file = "f2.txt"
[[channel]]
place = "d2"
file = "d2.txt"
[primitives]
drill = { command = "tool", action = "drill", duration_s = 2.0 }
press = { command = "tool", action = "press", duration_s = 3.0 }
[devices.drill]
instance = "Drill"
[devices.press]
instance = "Press"
[sensors.gauge]
variable = "v"
file = "gauge.txt"
"""


def write(folder: Path, *, said: str = "good", again: str = "n + 1") -> Path:
    """The cell as files; `again` is what the counter of tries becomes."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn(NET.replace("AGAIN", again)))
    (folder / "cell.toml").write_text(TOML, encoding="utf-8")
    (folder / "gauge.txt").write_text(f"{said}\n", encoding="utf-8")
    return folder
