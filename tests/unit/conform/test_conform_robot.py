"""Robot scripts compared with their pages, without a supervisor: what sensors may say, when messages come."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from helpers import small_cell
from helpers.robots import Cell
from helpers.scripts import checked
from pn2code.cell.divide import divide
from pn2code.conform.observations import observed
from pn2code.conform.robot import explore
from pn2code.conform.scheme import Scheme
from pn2code.conform.script_state import RobotReport
from pn2code.diagnostics import Diagnostics
from pn2code.emission.tdl import emit
from pn2code.robot_scripts.translate import lower_robots
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.multiset import MultiSet
from pn2code.verdict.opened import read

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


def compared(folder: Path, *changes: tuple[str, str], page: str = PAGE) -> RobotReport:
    cell = Cell(folder, page, ("y out COLOUR",), extra=EXTRA, toml=SENSOR)
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
    assert found.idle == ()


def test_transitions_that_never_occur_are_named(tmp_path: Path) -> None:
    found = compared(tmp_path, page=PAGE.replace("trans Lost", "trans Lost guard [1 > 2]"))
    assert found.deviation is None and found.complete
    assert found.idle == ("Top.Robot.Lost",)


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


IDLE_WORK = """
    place Idle = 1
    trans Told
      both Idle
      in x : n
    trans Works priority 10000 code action drill ()
      both Idle
"""


def sent(page: str, folder: Path, text: str = "") -> RobotReport:
    """The script of a page to which one message comes, `x`; `text`: another script."""
    cell = Cell(folder, page, ("x in INT",))
    place = "Top.Supervisor.Source_x"
    game = Game(cell.partition.net, initial={place: MultiSet.of([1])}, files=Files(None))
    return explore(cell.partition, cell.config, 1, checked(text or cell.text), game)


def test_a_message_that_comes_after_the_choice(tmp_path: Path) -> None:
    """It may come while the robot carries out what it has chosen before, though it would have been preferred."""
    found = sent(IDLE_WORK, tmp_path)
    assert found.deviation is None and found.complete
    assert found.transitions == 2


def test_a_message_that_was_there_before_the_choice(tmp_path: Path) -> None:
    script = Cell(tmp_path, IDLE_WORK, ("x in INT",)).text
    blind = script.replace("if filled(x) then", "if filled(x) and 1 > 2 then")
    assert blind != script
    found = sent(IDLE_WORK, tmp_path, blind)
    assert found.deviation is not None
    assert "announces `Top.Robot.Works` with {}, which is not enabled" in found.deviation


def test_a_wait_for_no_time(tmp_path: Path) -> None:
    """A command of the net that takes no time, like a delay that does not."""
    page = """
    place Idle = 1
    trans Told code action pause (0.0 * 2.0)
      both Idle
      in x : n
    """
    found = sent(page, tmp_path)
    assert found.deviation is None and found.complete and found.marks == 1
    text = Cell(tmp_path, page, ("x in INT",)).text
    longer = text.replace("0.0 * 2.0", "1.0 * 2.0")
    assert longer != text
    found = sent(page, tmp_path, longer)
    assert found.deviation is not None and "the script has commanded Wait" in found.deviation


def test_a_message_that_comes_after_a_choice_of_no_time(tmp_path: Path) -> None:
    page = IDLE_WORK.replace("action drill ()", "action pause (0.0 * 2.0)")
    found = sent(page.replace("priority 10000 ", ""), tmp_path)
    assert found.deviation is None, found
    found = sent(page, tmp_path)
    assert found.deviation is None, found


def test_two_messages_of_one_occurrence_while_the_robot_works(tmp_path: Path) -> None:
    """The second one may come later than a command after the first: a script that does not wait for it is found out."""
    first = small_cell.TOML.index('[[channel]]\nplace = "data"')
    second = small_cell.TOML.index('[[channel]]\nplace = "flag"')
    data = small_cell.TOML[first:second].replace('kind = "data"', 'kind = "flag"')
    toml = small_cell.TOML[:first] + small_cell.TOML[second:]
    toml = toml.replace("[primitives]", f"{data}[primitives]")
    net = small_cell.NET.replace("trans Accept\n", "trans Accept code action drill ()\n")
    d = Diagnostics()
    opened = read(small_cell.write(tmp_path, net, toml), {}, d)
    assert opened is not None and opened.config is not None, [x.message for x in d.errors]
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None, [x.message for x in d.errors]
    (ir,) = lower_robots(partition, opened.config, d)
    (file,) = emit([ir], source="cell.cpn", digest="0" * 64, version="1")
    waiting = "wait until filled(data)"
    assert waiting in file.text
    hasty = file.text.replace(waiting, 'if not filled(data) then\nstop "no data"\nend if')

    def compared_with(text: str) -> RobotReport:
        game = Game(partition.net, files=Files(None))
        return explore(partition, opened.config, 1, checked(text), game)  # type: ignore[arg-type]

    assert compared_with(file.text).deviation is None
    found = compared_with(hasty)
    assert found.deviation is not None and "(no data)" in found.deviation


WAITING = """
    place Idle = 1
    trans Told code action drill ()
      both Idle
      in x : n
"""


def test_a_script_that_stops_where_it_is_to_wait(tmp_path: Path) -> None:
    """Nothing else comes, so that nothing is enabled; but a script that stops stops the cell."""
    cell = Cell(tmp_path, WAITING, ("x in INT",))
    assert sent(WAITING, tmp_path).deviation is None
    assert cell.text.count("  end loop") == 1
    edited = cell.text.replace(
        "  end loop", '    if n > 0 then\n      stop "n"\n    end if\n  end loop'
    )
    found = sent(WAITING, tmp_path, edited)
    assert found.deviation is not None
    assert "where its page waits for x" in found.deviation
