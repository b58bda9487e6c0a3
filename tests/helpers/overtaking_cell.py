"""A cell that is right as a net, where priorities are global, and not as its programs run, where each knows its own.

Two devices are told to begin at once. In the net the first one's answer always comes first; in the cell the second one
may be quicker, and then the supervisor has nothing more to do.
"""

from __future__ import annotations

from pathlib import Path

NET = """\
standard
val P_HIGH = 100;
val P_NORMAL = 1000;
fun act () = ();
page Top
  place fa
  place fb
  place da
  place db
  subst Supervisor = Sup (fa -> fa, fb -> fb, da -> da, db -> db)
  subst A = Quick (flag -> fa, done -> da)
  subst B = Slow (flag -> fb, done -> db)
page Sup
  place fa port out
  place fb port out
  place da port in
  place db port in
  place Start = ()
  place Both
  place First
  place Late
  place Finished
  trans Ask
    in Start : ()
    out fa : ()
    out fb : ()
    out Both : ()
  trans Got
    priority P_HIGH
    in Both : ()
    in da : ()
    out First : ()
  trans Overtaken
    in Both : ()
    in db : ()
    out Late : ()
  trans End
    in First : ()
    in db : ()
    out Finished : ()
"""
DEVICE = """\
page {name}
  place flag port in
  place done port out
  place Waiting = ()
  place Over
  trans Accept{priority}
    in Waiting : ()
    in flag : ()
    out Over : ()
  trans Report{priority}
    code action act ()
    in Over : ()
    out Waiting : ()
    out done : ()
"""
GOES_ON = """\
  trans Again
    in Late : ()
    out fb : ()
    out Waiting : ()
  trans Back
    in Waiting : ()
    in db : ()
    out Late : ()
"""
"""The supervisor has something to do for ever, and does not come to its end either."""
TOML = """\
[net]
file = "cell.cpnt"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[primitives]
act = { command = "tool", action = "drill", duration_s = 1.0 }
[devices.a]
instance = "A"
[devices.b]
instance = "B"
"""
NEVER = "never { size (Mark.Sup'Late 1) > 0 }"
"""True of the net, and false of the cell."""


def write(folder: Path, *, goes_on: bool = False) -> Path:
    """The cell as files; `goes_on`: where it cannot come to its end it does something for ever."""
    devices = (
        DEVICE.format(name="Quick", priority="\n    priority P_HIGH"),
        DEVICE.format(name="Slow", priority=""),
    )
    channels = (
        f'[[channel]]\nplace = "{place}"\nfile = "{place}.txt"\n'
        for place in ("fa", "fb", "da", "db")
    )
    folder.mkdir(parents=True, exist_ok=True)
    net = NET.replace("  place Late\n", "  place Late\n  place Waiting\n") if goes_on else NET
    more = GOES_ON if goes_on else ""
    (folder / "cell.cpnt").write_text("".join((net, more, *devices)), encoding="utf-8")
    (folder / "cell.toml").write_text("".join((TOML, *channels)), encoding="utf-8")
    return folder
