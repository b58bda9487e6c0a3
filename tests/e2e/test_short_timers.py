"""A timer of the supervisor that is over before the answer can come: a warning, where that is certain."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.small_cell import write
from pn2code.cli.main import app

NET = """
net cell
  standard
  colset BOOL = bool;
  colset TIMER = unit timed;
  fun press () = ();
  fun rest (s : real) = ();
  fun twice () = (press (); press ())
  var wet: BOOL;
  page Top
    place ask
    place told
    place bell
    subst Supervisor = Sup (ask -> ask, told -> told, bell -> bell)
    subst Device = Dev (ask -> ask, told -> told)
    subst Ringer = Ring (bell -> bell)
  page Sup
    place ask port out
    place told port in
    place bell port in
    place Ready = 1
    place Waiting
    place Rung
    place Timer : TIMER
    place Finished
    trans Start
      in Ready
      out ask
      out Waiting
      out Timer : () @+ 3
    trans Answered
      in Waiting
      in Timer : () @+ 3
      in told
      out Finished
    trans Late
      in Waiting
      in Timer : ()
      out Finished
    trans Heard
      in bell
      out Rung
  page Dev
    place ask port in
    place told port out
    place Idle = 1
    place Asked : TIMER
    place Looked : BOOL
    trans Accept
      in Idle
      in ask
      out Asked : ()
    trans Work code action press ()
      in Asked : ()
      out Idle
      out told
  page Ring
    place bell port out
    place Watching = 1
    place Over
    trans Ring
      in Watching
      out Over
      out bell
"""
TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "ask"
file = "ask.robcad"
kind = "flag"
[[channel]]
place = "told"
file = "told.robcad"
kind = "flag"
[[channel]]
place = "bell"
file = "bell.robcad"
kind = "flag"
[primitives]
press = { command = "tool", action = "press", duration_s = 4.0 }
rest = { command = "wait" }
[devices.device]
instance = "Device"
[devices.ringer]
instance = "Ringer"
"""
WORK = "    trans Work code action press ()\n"
SKIP = "    trans Skip\n      in Asked : ()\n      out Idle\n      out told\n"
UNASKED = "    trans Offer\n      in Idle\n      out Asked : ()\n"
AGAIN = "    trans Again\n      in Rung\n      out ask\n"


def _check(folder: Path, *changes: tuple[str, str]) -> str:
    net = NET
    for old, new in changes:
        assert old in net
        net = net.replace(old, new, 1)
    done = CliRunner().invoke(app, ["check", str(write(folder, net, TOML))])
    assert done.exit_code == 0, done.output
    return done.output


@pytest.mark.parametrize(
    ("changes", "least"),
    [
        ((), "4 s (`press`)"),
        (((WORK, WORK.replace("press", "twice")),), "8 s (`press`)"),
        (((WORK, WORK.replace("press ()", "rest 3.5")),), "3.5 s (`rest`)"),
        (((WORK, "    trans Work\n"), ("out Asked : ()", "out Asked : () @+ 5")), "5 s"),
    ],
)
def test_a_timer_that_is_always_first(
    tmp_path: Path, changes: tuple[tuple[str, str], ...], least: str
) -> None:
    said = (
        "warning[short-timer]: the timer of 3 s that `Start` starts is over before the answer that it waits for can "
        f"come: device `device` takes at least {least} from `ask` to `told`\n"
    )
    assert said in _check(tmp_path, *changes)


@pytest.mark.parametrize(
    "changes",
    [
        pytest.param((("out Timer : () @+ 3", "out Timer : () @+ 4"),), id="long enough"),
        pytest.param(((WORK, WORK.replace("press ()", "rest 2.0")),), id="short work"),
        pytest.param(((WORK, SKIP + WORK),), id="another way to the answer"),
        pytest.param(((WORK, UNASKED + WORK),), id="an answer that nobody asked for"),
        pytest.param(
            (("      in bell\n", "      in Waiting\n      in bell\n"),), id="another message"
        ),
        pytest.param((("    trans Heard\n", AGAIN + "    trans Heard\n"),), id="asked before"),
        pytest.param(
            (
                ("      in told\n", "      in told\n      in Rung\n"),
                (
                    "      in Timer : ()\n      out Finished",
                    "      in Timer : ()\n      out Timer : () @+ 3\n      out Waiting",
                ),
            ),
            id="waits on",
        ),
    ],
)
def test_where_it_is_not_certain_nothing_is_said(
    tmp_path: Path, changes: tuple[tuple[str, str], ...]
) -> None:
    assert "short-timer" not in _check(tmp_path, *changes)
