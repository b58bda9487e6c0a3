"""What no robot can carry out raises an exception in the net of the running cell, however its function is declared."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.small_cell import NET, TOML, write
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatTransition
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.verdict.opened import read
from pn2code.verify.controller.refusals import refusing

WAIT = 'drill = { command = "wait" }'
TOOL = 'drill = { command = "tool", action = "drill", duration_s = 1.0 }'
CASES = {
    "real": ("fun drill (s : real) = ();", "Real.fromInt (k - 3)", WAIT),
    "whole": ("fun drill (s : int) = ();", "k - 3", WAIT),
    "value": ("val drill = fn (s : real) => ();", "Real.fromInt (k - 3)", WAIT),
    "another name": (
        "fun rest (s : int) = (); val drill = rest;",
        "k - 3",
        WAIT,
    ),
    "of a tuple": (
        "val (drill, _) = (fn (s : int) => (), 1);",
        "k - 3",
        WAIT,
    ),
    "of a record": (
        "val given as {drill, ...} = {drill = fn (s : int) => (), more = 1};",
        "k - 3",
        WAIT,
    ),
    "a pose that may be anything": (
        "fun drill p = ();",
        "{x = 1.0 / Real.fromInt (k - 2), y = 0.0, z = 0.0, rx = 0.0, ry = 0.0, rz = 0.0}",
        'drill = { command = "move_joint" }',
    ),
    "anything beside a speed": (
        "fun drill (p, s : real) = ();",
        "{x = 1.0 / Real.fromInt (k - 2), y = 0.0, z = 0.0, rx = 0.0, ry = 0.0, rz = 0.0}, 50.0",
        'drill = { command = "move_linear", frame = "world" }',
    ),
    "a speed": (
        "val drill = fn (p : POSE, s : int) => ();",
        "at 1, k - 3",
        'drill = { command = "move_joint" }',
    ),
}


def drilling(folder: Path, declared: str, given: str, entry: str) -> tuple[Game, FlatTransition]:
    """The net of a running cell, and the transition that calls the primitive with `given`, in which `k` is a number."""
    net = NET.replace("fun drill () = ();", "", 1)
    net = net.replace("  var n, k: INT;\n", f"  {declared}\n  var n, k: INT;\n", 1)
    net = net.replace("code action drill ()", f"code input (k); action drill ({given})", 1)
    d = Diagnostics()
    opened = read(write(folder, net, TOML.replace(TOOL, entry)), {}, d)
    assert opened is not None and opened.config is not None, [x.message for x in d.errors]
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None, [x.message for x in d.errors]
    # `Drill` has a guard on `k`, which does not matter to its code segment.
    game = Game(refusing(partition))
    return game, next(t for t in game.net.transitions if t.short == "Drill")


@pytest.mark.parametrize("what", CASES)
def test_what_no_robot_can_do_raises_an_exception(what: str, tmp_path: Path) -> None:
    game, t = drilling(tmp_path, *CASES[what])
    (k,) = (s for s in t.variables if s.name == "k")
    game.action(t, {k: 4})
    with pytest.raises(GameError, match="Match"):
        game.action(t, {k: 2})


def test_a_value_that_any_type_fits(tmp_path: Path) -> None:
    """A tool needs nothing; its function may be polymorphic, and is called as before."""
    game, t = drilling(tmp_path, "val drill = fn _ => ();", "()", TOOL)
    (k,) = (s for s in t.variables if s.name == "k")
    game.action(t, {k: 2})
