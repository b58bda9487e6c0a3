"""Devices (scripts without an arm), sensors (what the net leaves open), and delays in scripts."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.robots import Cell
from helpers.scripts import MemoryFiles, checked, diagnosed
from pn2code.cell.load import load as load_cell
from pn2code.diagnostics import Diagnostics
from pn2code.robot.commands import MoveHome, ToolAction, Wait
from pn2code.robot.motion_fault import MotionFault
from pn2code.run.device import DeviceExecutor
from pn2code.run.sensors import Sensors
from pn2code.run.sensors import load as load_sensors
from pn2code.tdl.interpret import Interpreter
from pn2code.tdl.requests import Execute, Fault, Sense
from pn2code.tdl.types import Type

EXTRA = """
colset TIMED = unit timed;
colset GRIP = with held | lost;
colset SHORT = int with 2..5;
var g : GRIP;
var d : SHORT;
"""

GRIPPER = """
place Idle = 1
place Gripped : GRIP
trans Grip code action drill ()
  in Idle
  in x : n
  out Gripped : g
trans Held
  in Gripped : held
  out Idle
  out y : n0
trans Lost
  in Gripped : lost
  out Idle
  out y : 0
""".replace("n0", "1")

TIMER = """
place Idle : TIMED = 1`()
place Busy : TIMED
trans Start
  in Idle : ()
  in x : n
  out Busy : () @+ d
trans Answer delay @+ 3
  in Busy : ()
  out y : 1
  out Idle : ()
"""


def device(toml: str) -> str:
    """The cell description in which the script is a device's."""
    return toml.replace("[robots.robot1]", "[devices.robot1]")


# --- sensors -----------------------------------------------------------------------------------


def test_what_the_net_leaves_open_is_asked_of_a_sensor_after_the_command(tmp_path: Path) -> None:
    toml = '[sensors.grip]\nvariable = "g"\n'
    cell = Cell(tmp_path, GRIPPER, ("x in INT", "y out INT"), extra=EXTRA, toml=toml)
    lines = [x.strip() for x in cell.body.splitlines()]
    at = lines.index("tool drill for 3 s")
    assert lines[at + 1 : at + 3] == [
        "sense grip into g",
        "mark Top.Robot.Grip with g = g, n = n",
    ]
    assert lines[at + 3 : at + 5] == ["clear x", "gripped := g"]
    assert 'if gripped = "held" then' in lines
    cell.checked()


def test_a_guard_cannot_ask_a_sensor(tmp_path: Path) -> None:
    robot = "place A = 1\ntrans T guard [g = held]\n  both A\n  out y : if g = held then 1 else 2"
    toml = "[sensors.g]\n"
    cell = Cell(tmp_path, robot, ("y out INT",), extra=EXTRA, toml=toml)
    assert cell.ir is None or not cell.d.has_errors  # a guard that decides `g` is no choice
    robot = "place A = 1\ntrans T guard [g <> held]\n  both A\n  out y : if g = held then 1 else 2"
    cell = Cell(tmp_path, robot, ("y out INT",), extra=EXTRA, toml=toml)
    assert cell.ir is None
    assert "whether `T` is enabled depends on `g`, which sensor `g` decides" in cell.messages[0]


def test_a_sensor_that_nobody_asks_is_a_mistake(tmp_path: Path) -> None:
    toml = '[sensors.grip]\nvariable = "g"\n[sensors.other]\nvariable = "dd"\n'
    cell = Cell(tmp_path, GRIPPER, ("x in INT", "y out INT"), extra=EXTRA, toml=toml)
    assert cell.ir is None
    assert cell.messages == [
        "error[cell-value] no robot or device asks sensor `other`: none of them leaves variable "
        "`dd` open"
    ]


def test_the_interpreter_asks_and_checks_the_answer() -> None:
    program = checked("program t var k : int begin sense grip into k stop k end program")
    interpreter = Interpreter(program, MemoryFiles())
    assert interpreter.resume() == Sense("grip", Type.INT, 1)
    assert interpreter.resume(7) == Fault("7", 1)
    for answer, words in (
        (None, "sensor `grip` gave no value"),
        ("held", "sensor `grip` says `held`, but the script expects `int`"),
    ):
        interpreter = Interpreter(program, MemoryFiles())
        interpreter.resume()
        assert interpreter.resume(answer) == Fault(words, 1)


def test_a_sensor_may_have_the_name_of_a_key_word(tmp_path: Path) -> None:
    toml = '[sensors.tool]\nvariable = "g"\n'
    cell = Cell(tmp_path, GRIPPER, ("x in INT", "y out INT"), extra=EXTRA, toml=toml)
    assert 'sense "tool" into g' in cell.body
    cell.checked()


def test_a_sensor_gives_scalars_only() -> None:
    text = "program t\nvar p : pose begin sense grip into p stop p end program"
    assert diagnosed(text) == [
        "2:36 error[tdl-type] `p` is of type `pose`, but a sensor gives a number, a truth value or "
        "a text"
    ]


ONE = ("x in INT", "y out INT")


def loaded(tmp_path: Path, toml: str, seed: int | None = None) -> tuple[Sensors | None, list[str]]:
    cell = Cell(tmp_path, GRIPPER, ONE, extra=EXTRA, toml='[sensors.grip]\nvariable = "g"\n' + toml)
    assert cell.config is not None
    d = Diagnostics()
    found = load_sensors(cell.config, cell.partition.net, (tmp_path,), seed, d)
    return found, [f"{e.origin.line}:{e.origin.column} {e.message}" for e in d.errors]


def test_a_sensor_reads_its_file_over_and_over_for_each_who_asks(tmp_path: Path) -> None:
    (tmp_path / "grip.txt").write_text("# what the gripper says\nheld\n\nlost  # dropped\n")
    found, errors = loaded(tmp_path, 'file = "grip.txt"\n')
    assert found is not None and not errors
    assert [found.ask("robot1", "grip") for _ in range(5)] == [
        "held", "lost", "held", "lost", "held",
    ]  # fmt: skip
    assert found.ask("robot2", "grip") == "held"
    assert found.ask("robot1", "nose") is None


def test_a_sensor_without_file_draws_the_same_for_the_same_seed(tmp_path: Path) -> None:
    def drawn(seed: int | None) -> list[object]:
        found, errors = loaded(tmp_path, "seed = 3\n", seed)
        assert found is not None and not errors
        return [found.ask("robot1", "grip") for _ in range(40)]

    assert drawn(None) == drawn(3)
    assert drawn(None) != drawn(4)
    assert set(drawn(None)) == {"held", "lost"}


def test_a_sensor_says_its_default_where_there_is_no_file(tmp_path: Path) -> None:
    toml = 'file = "grip.txt"\ndefault = "held"\n'
    found, errors = loaded(tmp_path, toml, seed=7)
    assert found is not None and not errors
    assert [found.ask("robot1", "grip") for _ in range(3)] == ["held", "held", "held"]
    (tmp_path / "grip.txt").write_text("lost\nheld\n")
    found, errors = loaded(tmp_path, toml)
    assert found is not None and not errors
    assert [found.ask("robot1", "grip") for _ in range(3)] == ["lost", "held", "lost"]
    found, errors = loaded(tmp_path, 'default = "lost"\n')
    assert found is not None and found.ask("robot2", "grip") == "lost"


@pytest.mark.parametrize(
    ("default", "words"),
    [
        (
            '"hold"',
            "sensor `grip`: default: `hold` is not a value of colour set `GRIP`; its values are `held`, `lost`",
        ),
        ("1", "sensor `grip`: default: `1` is no value"),
        ("[1]", "`default` is `[1]`, but a value of the variable is expected"),
    ],
)
def test_a_default_must_be_a_value_of_the_variable(
    tmp_path: Path, default: str, words: str
) -> None:
    with_default = f"default = {default}\n"
    if default == "[1]":
        d = Diagnostics()
        (tmp_path / "cell.toml").write_text(f"[sensors.grip]\n{with_default}")
        load_cell(tmp_path / "cell.toml", d)
        assert words in [e.message for e in d.errors]
    else:
        found, errors = loaded(tmp_path, with_default)
        assert found is None
        assert words in errors[0]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "held\nhold\n",
            "2:1 `hold` is not a value of colour set `GRIP`; its values are `held`, `lost`",
        ),
        ("# nothing\n", "0:0 sensor `grip`: `"),
        (
            "held # as\u2028before\nhold\n",
            "2:1 `hold` is not a value of colour set `GRIP`; its values are `held`, `lost`",
        ),
        (None, "sensor `grip`: there is no file `grip.txt`"),
    ],
)
def test_mistakes_in_a_sensors_file_are_shown_at_their_line(
    tmp_path: Path, text: str | None, words: str
) -> None:
    if text is not None:
        (tmp_path / "grip.txt").write_text(text)
    found, errors = loaded(tmp_path, 'file = "grip.txt"\n')
    assert found is None
    assert words in errors[0]


def test_the_values_of_an_enumeration_are_named(tmp_path: Path) -> None:
    (tmp_path / "grip.txt").write_text("hold\n")
    cell = Cell(
        tmp_path,
        GRIPPER,
        ONE,
        extra=EXTRA,
        toml='[sensors.grip]\nvariable = "g"\nfile = "grip.txt"\n',
    )
    assert cell.config is not None
    d = Diagnostics()
    assert load_sensors(cell.config, cell.partition.net, (tmp_path,), None, d) is None
    (error,) = d.errors
    assert error.hint == "write one value of colour set `GRIP`, such as `held`, `lost`, a line"


def test_a_truth_value_is_written_as_in_the_net_or_as_in_a_message(tmp_path: Path) -> None:
    """Of a colour set of kind `bool`."""
    page = GRIPPER.replace(": GRIP", ": BOOL").replace("held", "true").replace("lost", "false")

    def of(toml: str, text: str) -> tuple[list[object], list[str]]:
        (tmp_path / "grip.txt").write_text(text)
        cell = Cell(
            tmp_path,
            page,
            ONE,
            extra=EXTRA.replace("var g : GRIP", "var g : BOOL"),
            toml='[sensors.grip]\nvariable = "g"\n' + toml,
        )
        assert cell.config is not None, cell.messages
        d = Diagnostics()
        found = load_sensors(cell.config, cell.partition.net, (tmp_path,), None, d)
        said = [] if found is None else [found.ask("robot1", "grip") for _ in range(4)]
        return said, [e.message for e in d.errors]

    assert of('file = "grip.txt"\n', "true\n0\n false # no\n1\n") == (
        [True, False, False, True],
        [],
    )
    assert of("default = true\n", "")[0] == [True] * 4
    assert of('default = "false"\n', "")[0] == [False] * 4
    assert "`yes` is neither" in of('file = "grip.txt"\n', "yes\n")[1][0]
    # A default is looked at even where the file is there.
    assert "`maybe` is neither" in of('file = "grip.txt"\ndefault = "maybe"\n', "true\n")[1][0]


# --- devices and delays ------------------------------------------------------------------------


def test_a_delay_of_the_control_token_is_a_wait(tmp_path: Path) -> None:
    cell = Cell(
        tmp_path, TIMER, ("x in INT", "y out INT"), extra=EXTRA, toml="[sensors.d]\n"
    )  # fmt: skip
    lines = [x.strip() for x in cell.body.splitlines()]
    assert lines == [
        "loop",
        "wait until filled(x)",
        "read x into n",
        "sense d into d",
        "mark Top.Robot.Start with d = d, n = n",
        "clear x",
        "wait d * 1 s",
        "mark Top.Robot.Answer",
        "write y 1",
        "wait 3 s",
        "end loop",
    ]
    cell.checked()


def test_a_device_waits_and_acts_but_does_not_move() -> None:
    executor = DeviceExecutor("belt")
    motion = executor.begin(ToolAction("advance", 2.0), 5.0)
    assert (motion.kind, motion.ends) == ("tool", 7.0)
    executor.finish()
    assert executor.begin(Wait(1.0), 7.0).kind == "wait"
    executor.stop(7.5)
    assert executor.motion is None
    with pytest.raises(MotionFault, match="device `belt` has no arm"):
        executor.begin(MoveHome(), 8.0)
    with pytest.raises(MotionFault, match="is not possible"):
        executor.begin(Wait(-1.0), 8.0)


def test_a_device_whose_page_moves_is_refused(tmp_path: Path, monkeypatch: object) -> None:
    import helpers.robots

    assert isinstance(monkeypatch, pytest.MonkeyPatch)
    monkeypatch.setattr(helpers.robots, "TOML", device(helpers.robots.TOML))
    moving = "place A = 1\ntrans T code action moveHome ()\n  both A"
    assert Cell(tmp_path, moving).messages == [
        "error[robot-primitive] `moveHome` is a `move_home`, but device `robot1` has no arm"
    ]
    acting = "place A = 1\ntrans T code action drill ()\n  both A"
    cell = Cell(tmp_path, acting)
    assert "-- Device `robot1`: page `Rob`" in cell.text
    assert not cell.messages
    interpreter = Interpreter(cell.checked(), MemoryFiles())
    request = interpreter.resume()
    assert isinstance(request, Execute) and request.command == ToolAction("drill", 3.0)


def test_a_value_of_the_net_that_two_transitions_use_is_one_constant(tmp_path: Path) -> None:
    robot = """
    place A = 1
    place B
    trans T code action pause lift
      in A
      out B
    trans U code action pause lift
      in B
      out A
    """
    cell = Cell(tmp_path, robot, extra="val lift = 2.5;")
    assert cell.text.count("const lift") == 1
    assert "const lift_2" not in cell.text
    cell.checked()
