"""A device that may have to wait for another one while it owes an answer (I8), in states where it need not wait."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from pn2code.cli.main import app

pytestmark = pytest.mark.cc

_NET = """standard
fun work () = ();
var n : INT;
page Top
  place order : INT
  place done
  place help
  place other
  place please
  place hello
  subst Supervisor = Supervisor (order -> order, done -> done, please -> please, hello -> hello)
  subst First = First (order -> order, help -> help, other -> other, done -> done)
  subst Second = Second (help -> help, other -> other, please -> please, hello -> hello)
page Supervisor
  place order port out : INT
  place done port in
  place please port out
  place hello port in
  place Ready = ()
  place Sent
  place Finished
  trans Send
    in Ready : ()
    in hello : ()
    out order : ORDER
    out Sent : ()
    out please : ()
  trans Done
    in Sent : ()
    in done : ()
    out Finished : ()
page First
  place order port in : INT
  place help port in
  place other port in
  place done port out
  place Waiting = ()
  place Told : INT
  trans Take
    in Waiting : ()
    in order : n
    out Told : n
  trans Positive
    guard [n > 0]
    in Told : n
    POSITIVE
    out Waiting : ()
    out done : ()
  trans Others
    guard [n <= 0]
    in Told : n
    in other : ()
    out Waiting : ()
    out done : ()
page Second
  place help port out
  place other port out
  place please port in
  place hello port out
  place Idle = ()
  place Helped
  place Told
  trans Help
    in Idle : ()
    out help : ()
    out hello : ()
    out Helped : ()
  trans Take
    in Helped : ()
    in please : ()
    out Told : ()
  trans Other
    code action (work ())
    in Told : ()
    out other : ()
    out Helped : ()
"""
_TOML = """[net]
file = "cell.cpnt"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[primitives]
work = { command = "tool", action = "work", duration_s = 200.0 }
[devices.First]
instance = "First"
[devices.Second]
instance = "Second"
"""
_CHANNEL = '[[channel]]\nplace = "{0}"\nfile = "{0}.robcad"\n'


_TIMED = (
    ("var n : INT;", "var n : INT;\ncolset LATER = INT timed;"),
    ("place Told : INT", "place Told : LATER"),
    ("out Told : n", "out Told : n @+ 2"),
)


def _ends(folder: Path, order: str, positive: str, timed: bool = False) -> tuple[str, str, str]:
    net = _NET
    for old, new in _TIMED if timed else ():
        net = net.replace(old, new)
    net = net.replace("ORDER", order).replace("    POSITIVE\n", positive)
    channels = ("order", "done", "other", *(["help"] if positive else []), "hello", "please")
    toml = "".join(map(_CHANNEL.format, channels)) + 'kind = "data"\n'
    if not positive:  # nobody looks at `help`
        net = net.replace("  place help\n", "").replace("help -> help, ", "")
        net = net.replace("  place help port in\n", "").replace("    out help : ()\n", "")
        net = net.replace("  place help port out\n", "")
    (folder / "cell.cpnt").write_text(net, encoding="utf-8")
    (folder / "cell.toml").write_text(toml + _TOML, encoding="utf-8")
    done = CliRunner().invoke(app, ["verify", str(folder), "--no-medium", "--json"])
    found = json.loads(done.stdout)
    (end,) = (c for c in found["controller"] if c["check"] == "non-blocking")
    return end["answer"], end["why"] or "", end["says"]


@pytest.mark.parametrize("positive", ["", "    in help : ()\n"], ids=["no message", "is there"])
def test_its_guard_lets_it_wait_for_the_other_message(positive: str, tmp_path: Path) -> None:
    """`Positive` needs no message, or one that is there; but its guard is false, so `Others` is waited for."""
    answer, why, says = _ends(tmp_path, "0", positive)
    assert (answer, why) == ("unknown", "late")
    assert "`First` may have to wait for others (" in says


@pytest.mark.parametrize("timed", [False, True])
def test_it_waits_for_nothing_where_the_guard_is_true(timed: bool, tmp_path: Path) -> None:
    """It may wait for its time."""
    assert _ends(tmp_path, "1", "", timed)[0] == "yes"


def test_it_waits_when_its_time_has_come(tmp_path: Path) -> None:
    assert _ends(tmp_path, "0", "", True)[:2] == ("unknown", "late")
