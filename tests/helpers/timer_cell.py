"""A cell of two devices with a watchdog, pauses of the supervisor, and a device that waits as long as a sensor says."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from random import Random

from helpers.netbuilder import cpn

NET = """
net timers
  standard
  colset T = unit timed;
  colset LONG = int with 0..LONGEST;
  colset TRIES = int with 0..ROUNDS;
  fun drill () = ();
  fun press () = ();
  var c : LONG;
  var n : TRIES;
  page Top
    place f1
    place d1
    place f2
    place d2
    subst Supervisor = Sup (f1 -> f1, d1 -> d1, f2 -> f2, d2 -> d2)
    subst Drill = Drill (f -> f1, d -> d1)
    subst Press = Press (f -> f2, d -> d2)
  page Sup
    place f1 port out
    place d1 port in
    place f2 port out
    place d2 port in
    place Left : TRIES = ROUNDS
    place Ready = ()
    place Beside = ()
    place Asked
    place Owed
    place Watchdog : T
    place Pause : T
    place Busy2
    place Pause2 : T
    place Done1
    place Done2
    place Finished
    trans Start
      in Ready : ()
      out f1 : ()
      out Asked : ()
      out Watchdog : ()@+PATIENCE
    trans Drilled
      in Asked : ()
      in d1 : ()
      in Watchdog : ()@+PATIENCE
      out Pause : ()@+SHORT
    trans "Time Out"
      in Asked : ()
      in Watchdog : ()
      out Owed : ()
    trans Late
      in Owed : ()
      in d1 : ()
      out Pause : ()@+LATER
    trans Again guard [n > 0]
      in Pause : ()
      in Left : n
      out Left : n - 1
      out Ready : ()
    trans Enough
      in Pause : ()
      in Left : 0
      out Done1 : ()
    trans Ask
      in Beside : ()
      out f2 : ()
      out Busy2 : ()
    trans Pressed
      in Busy2 : ()
      in d2 : ()
      out Pause2 : ()@+BESIDE
    trans Rested
      in Pause2 : ()
      out Done2 : ()
    trans End
      in Done1 : ()
      in Done2 : ()
      out Finished : ()
  page Drill
    place f port in
    place d port out
    place Waiting = ()
    place Thinking : T
    place Told
    trans Accept
      in Waiting : ()
      in f : ()
      out Thinking : ()@+c
    trans Think
      in Thinking : ()
      out Told : ()
    trans Drill code action drill ()
      in Told : ()
      out Waiting : ()
      out d : ()
  page Press
    place f port in
    place d port out
    place Waiting = ()
    place Told
    place Cooling : T
    trans Accept
      in Waiting : ()
      in f : ()
      out Told : ()
    trans Press code action press ()
      in Told : ()
      out Cooling : ()
    trans Cool
      in Cooling : ()
      out d : ()
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
[[channel]]
place = "f2"
file = "f2.txt"
[[channel]]
place = "d2"
file = "d2.txt"
[primitives]
drill = { command = "tool", action = "drill", duration_s = DRILL }
press = { command = "tool", action = "press", duration_s = PRESS }
[devices.drill]
instance = "Drill"
[devices.press]
instance = "Press"
[sensors.gauge]
variable = "c"
file = "gauge.txt"
"""
USUAL = {
    "LONGEST": 3, "ROUNDS": 1, "PATIENCE": 4, "SHORT": 1, "LATER": 2, "BESIDE": 3,
    "DRILL": 2.3, "PRESS": 3.7,
}  # fmt: skip


def drawn(random: Random) -> dict[str, float]:
    """Numbers of a cell at random; whole seconds among them, in which ends and time stamps meet."""
    whole = {
        "LONGEST": random.randint(1, 3),
        "ROUNDS": random.randint(0, 2),
        "PATIENCE": random.randint(1, 6),
        "SHORT": random.randint(0, 3),
        "LATER": random.randint(0, 3),
        "BESIDE": random.randint(0, 9),
    }
    lasting = {
        name: random.choice([1.0, 2.0, 0.7, 2.3, 3.999, 1.0004, 2.5]) for name in ("DRILL", "PRESS")
    }
    return {**whole, **lasting}


def write(
    folder: Path,
    numbers: Mapping[str, float] = USUAL,
    said: str = "0",
    more: str = "",
    net: str = NET,
) -> Path:
    """The cell as files; `more` is added to cell.toml, and `net` is another one."""
    toml = TOML
    for name, value in numbers.items():
        net, toml = net.replace(name, str(value)), toml.replace(name, str(value))
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn(net))
    (folder / "cell.toml").write_text(toml + more, encoding="utf-8")
    (folder / "gauge.txt").write_text(f"{said}\n", encoding="utf-8")
    return folder
