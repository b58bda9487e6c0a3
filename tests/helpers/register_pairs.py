"""Small cells in which a supervisor sets a register and two devices look at it."""

from __future__ import annotations

from pathlib import Path

_HEAD = """standard
fun work () = ();
var n, k : INT;
"""
_TOML = """[net]
file = "cell.cpnt"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "limit"
file = "limit.robcad"
kind = "register"
CHANNELS
[primitives]
work = { command = "tool", action = "work", duration_s = 1.0 }
[devices.first]
instance = "First"
[devices.second]
instance = "Second"
"""
FREE = """page Top
  place limit : INT = 1`1
  place end1
  place end2
  subst Supervisor = Supervisor (limit -> limit, end1 -> end1, end2 -> end2)
  subst First = Reader (limit -> limit, done -> end1)
  subst Second = Reader (limit -> limit, done -> end2)
page Supervisor
  place limit port io : INT
  place end1 port in
  place end2 port in
  place Running = ()
  place Stopping
  place Finished
  trans Set
    in Running : ()
    in limit : n
    out limit : n - 1
    out Stopping : ()
  trans Done
    in Stopping : ()
    in end1 : ()
    in end2 : ()
    out Finished : ()
page Reader
  place limit port io : INT
  place done port out
  place Idle = ()
  place Working
  place Ended
  trans Enter
    guard [k > 0]
    in Idle : ()
    both limit : k
    out Working : ()
  trans Work
    code action (work ())
    in Working : ()
    out Idle : ()
  trans Stop
    guard [k = 0]
    in Idle : ()
    both limit : k
    out Ended : ()
    out done : ()
"""
"""Devices that work until they see that they are not to; nobody tells them to look."""
TOLD = """page Top
  place limit : INT = 1`3
  place go1
  place go2
  place done1
  place done2
  subst Supervisor = Supervisor (limit -> limit, go1 -> go1, go2 -> go2, done1 -> done1, done2 -> done2)
  subst First = Reader (limit -> limit, go -> go1, done -> done1)
  subst Second = Reader (limit -> limit, go -> go2, done -> done2)
page Supervisor
  place limit port io : INT
  place go1 port out
  place go2 port out
  place done1 port in
  place done2 port in
  place Ready = ()
  place Wait1
  place Wait2
  place Finished
  trans Set
    guard [n > 0]
    in Ready : ()
    in limit : n
    out limit : n - 1
    out go1 : ()
    out go2 : ()
    out Wait1 : ()
    out Wait2 : ()
  trans Both
    in Wait1 : ()
    in Wait2 : ()
    in done1 : ()
    in done2 : ()
    out Ready : ()
  trans Done
    in Ready : ()
    both limit : 0
    out Finished : ()
page Reader
  place limit port io : INT
  place go port in
  place done port out
  place Idle = ()
  place Told
  place Odd
  place Even
  trans Take
    in Idle : ()
    in go : ()
    out Told : ()
  trans IsOdd
    guard [k mod 2 = 1]
    in Told : ()
    both limit : k
    out Odd : ()
  trans IsEven
    guard [k mod 2 = 0]
    in Told : ()
    both limit : k
    out Even : ()
  trans OddDone
    code action (work ())
    in Odd : ()
    out Idle : ()
    out done : ()
  trans EvenDone
    code action (work ())
    in Even : ()
    out Idle : ()
    out done : ()
"""
"""Devices that look when they are told to, after the value was set."""
FLAGS = {FREE: ("end1", "end2"), TOLD: ("go1", "go2", "done1", "done2")}


def write(folder: Path, pages: str, **changed: str) -> Path:
    """Writes a cell into a folder; `changed`: texts of its net by others."""
    text = _HEAD + pages
    for old, new in changed.items():
        assert old in text
        text = text.replace(old, new)
    return written(folder, text, FLAGS[pages])


def written(folder: Path, net: str, flags: tuple[str, ...]) -> Path:
    """Writes a net, and a cell with its register and these flags."""
    folder.mkdir(parents=True, exist_ok=True)
    channels = "\n".join(f'[[channel]]\nplace = "{c}"\nfile = "{c}.robcad"' for c in flags)
    (folder / "cell.cpnt").write_text(net, encoding="utf-8")
    (folder / "cell.toml").write_text(_TOML.replace("CHANNELS", channels), encoding="utf-8")
    return folder


def text(pages: str) -> str:
    """The net of a cell."""
    return _HEAD + pages
