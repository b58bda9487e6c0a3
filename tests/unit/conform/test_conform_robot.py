"""Robot scripts compared with their pages, without a supervisor: what sensors may say."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from helpers.robots import Cell
from helpers.scripts import checked
from pn2code.conform.observations import observed
from pn2code.conform.robot import RobotReport, explore
from pn2code.conform.scheme import Scheme
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.multiset import MultiSet

EXTRA = """
colset GRIP = with held | lost;
var grip : GRIP;
"""
PAGE = """
place Idle : COLOUR = 1`red
place Gripped : GRIP
place Over
trans Grip code action drill ()
  in Idle : e
  out Gripped : grip
  out y : e
trans Held
  in Gripped : held
  out Over
trans Lost
  in Gripped : lost
  out Over
"""
SENSOR = """
[sensors.gripper]
variable = "grip"
"""


def compared(folder: Path, *changes: tuple[str, str]) -> RobotReport:
    cell = Cell(folder, PAGE, ("y out COLOUR",), extra=EXTRA, toml=SENSOR)
    assert not cell.messages
    text = cell.text
    for before, after in changes:
        assert before in text
        text = text.replace(before, after)
    game = Game(cell.partition.net, files=Files(None))
    return explore(cell.partition, cell.config, 1, checked(text), game)


def test_a_sensor_says_what_its_own_variable_may_be(tmp_path: Path) -> None:
    found = compared(tmp_path)
    assert found.deviation is None and found.complete
    assert found.transitions == found.all_transitions == 3


def test_what_a_sensor_says_is_not_made_up(tmp_path: Path) -> None:
    """Not even if it may be so."""
    found = compared(tmp_path, ("sense gripper into grip", 'grip := "held"'))
    assert found.deviation is not None
    assert "with grip = held, but has not asked the sensor `gripper`" in found.deviation
    lie = 'sense gripper into grip\ngrip := "held"'
    found = compared(tmp_path, ("sense gripper into grip", lie))
    assert found.deviation is not None
    assert "with grip = held, but the sensor `gripper` has said lost" in found.deviation
    found = compared(tmp_path, ("sense gripper into grip", 'grip := "red"'))
    assert found.deviation is not None
    assert "Grip` with {'e': 'red', 'grip': 'red'}" in found.deviation


def test_zeros_of_both_signs_are_two_states(tmp_path: Path) -> None:
    page = """
    place Told : REAL = 1`0.0
    place Over
    trans Minus guard [1.0 / w < 0.0]
      in Told : w
      out Over
    trans Plus guard [not (1.0 / w < 0.0)]
      in Told : w
      out Over
    """
    net = Cell(tmp_path, page).partition
    game = Game(net.net, files=Files(None))
    scheme = Scheme(net, game)
    told = next(p.index for p in net.net.places if p.name == "Top.Robot.Told")
    markings = [
        replace(
            game.marking,
            places=tuple(
                MultiSet.of([zero]) if i == told else x for i, x in enumerate(game.marking.places)
            ),
        )
        for zero in (0.0, -0.0)
    ]
    plus, minus = (scheme.steps(1, m).steps[0].text for m in markings)
    assert "Plus" in plus and "Minus" in minus
    assert len({observed(scheme, m, frozenset()) for m in markings}) == 2
