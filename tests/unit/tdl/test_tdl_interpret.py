"""Running scripts: what they ask for, what they tell, how they fail."""

from __future__ import annotations

import math

import pytest

from helpers.scripts import MemoryFiles, checked, run
from pn2code.robot.commands import Measure, MoveHome, MoveJoint, MoveLinear, Pose, ToolAction, Wait
from pn2code.tdl.interpret import Interpreter
from pn2code.tdl.requests import (
    AwaitFile,
    Execute,
    Fault,
    Finished,
    Marked,
    MessageConsumed,
    MessageRead,
    MessageWritten,
)

FILES = """
input flag "flag.robcad" : int
input data "my-data.robcad" : pose
output done "done.robcad" : int
"""


def script(body: str, declarations: str = "") -> str:
    return f"program t {declarations}\nbegin\n{body}\nend program"


def value(expression: str, kind: str, declarations: str = "") -> object:
    """The value of an expression, as a variable of a type holds it."""
    result = run(checked(script(f"z := {expression} stop z", f"{declarations} var z : {kind}")))
    return result.variables["z"]


def fault(body: str, declarations: str = "", **options: object) -> Fault:
    end = run(checked(script(body, declarations)), **options).end  # type: ignore[arg-type]
    assert isinstance(end, Fault)
    return end


# --- commands ----------------------------------------------------------------------------------


def test_commands_leave_in_si_units() -> None:
    pose = "pose(1000 mm, -2 m, 30 cm, 180 deg, 0 deg, -90 deg)"
    result = run(
        checked(
            script(f"move $joint {pose} move $linear {pose} move $linear {pose} in tool at 50 mm/s "
                   "move $joint home tool drill for 1500 ms wait 1 min")
        )
    )  # fmt: skip
    si = Pose(1.0, -2.0, 0.3, math.pi, 0.0, -math.pi / 2)
    assert result.commands == [
        MoveJoint(si, 1.0),
        MoveLinear(si, "world", None),
        MoveLinear(si, "tool", 0.05),
        MoveHome(1.0),
        ToolAction("drill", 1.5),
        Wait(60.0),
    ]
    assert result.end == Finished()


def test_speed_settings_hold_until_they_are_changed_and_a_move_can_have_its_own() -> None:
    pose = "pose(0 mm, 0 mm, 0 mm, 0 deg, 0 deg, 0 deg)"
    result = run(
        checked(
            script(f"speed $joint 50 % speed $linear 250 mm/s move $joint home move $joint home at 10 % "
                   f"move $linear {pose} move $linear {pose} at 1 m/s speed $joint default speed $linear default "
                   f"move $joint home move $linear {pose}")
        )
    )  # fmt: skip
    assert [c.speed for c in result.commands if not isinstance(c, Wait)] == [  # type: ignore[union-attr]
        0.5, 0.1, 0.25, 1.0, 1.0, None,
    ]  # fmt: skip


def test_requests_name_the_line() -> None:
    interpreter = Interpreter(
        checked("program t\nbegin\n\n  wait 1 s\n  wait 2 s\nend program"), MemoryFiles()
    )
    assert interpreter.resume() == Execute(Wait(1.0), 4)
    assert interpreter.resume() == Execute(Wait(2.0), 5)
    assert interpreter.resume() == Finished()
    assert interpreter.resume() == Finished()


def test_what_comes_back_from_a_measurement_as_it_went_out_keeps_every_bit() -> None:
    """5898.8 mm is 5.8988 m is 5898.8 mm: no rounding on the way there and back."""
    declarations = "var p : pose := pose(5898.7998046875 mm, 0.1 mm, 2135.05 mm, -105 deg, 0.3 deg, 0 deg) var q : pose"
    program = checked(script("measure p into q stop q", declarations))
    same = run(program)
    assert same.variables["q"] == same.variables["p"]
    (command,) = same.commands
    assert isinstance(command, Measure)
    moved = run(program, measured=Pose(1.0, command.nominal.y, 3.0, 0.5, command.nominal.ry, 0.0))
    q = moved.variables["q"]
    assert (q.x, q.y, q.z, q.ry) == (1000.0, 0.1, 3000.0, 0.3)
    assert q.rx == math.degrees(0.5)


def test_a_measurement_without_result_is_a_fault() -> None:
    program = checked(
        script(
            "measure p into p stop p", "var p : pose := pose(0 mm, 0 mm, 0 mm, 0 deg, 0 deg, 0 deg)"
        )
    )
    interpreter = Interpreter(program, MemoryFiles())
    assert isinstance(interpreter.resume(), Execute)
    assert interpreter.resume(None) == Fault("the measurement gave no pose", 3)


# --- files -------------------------------------------------------------------------------------


def test_reading_copies_and_clearing_consumes() -> None:
    files = MemoryFiles({"flag": (7,)})
    program = checked(
        script("read flag into k read flag into k clear flag write done k", f"{FILES} var k : int")
    )
    result = run(program, files)
    assert files.messages == {"done": (7,)}
    assert result.end == Finished()
    assert result.events == [
        MessageRead("flag", (7,), 7),
        MessageRead("flag", (7,), 7),
        MessageConsumed("flag", (7,), 7),
        MessageWritten("done", (7,), 7),
    ]


def test_files_are_named_as_in_the_shared_directory_and_poses_are_six_numbers() -> None:
    files = MemoryFiles({"my-data": (1.0, 2, 3.0, 4.0, 5.0, 6.5)})
    result = run(checked(script("read data into p stop p", f"{FILES} var p : pose")), files)
    assert isinstance(result.end, Fault)
    assert result.end.message == "pose(1, 2, 3, 4, 5, 6.5)"


def test_waiting_names_the_empty_files_only_and_looks_again() -> None:
    program = checked(
        script(
            "wait until filled(flag) and filled(data) or filled(go)",
            f'{FILES} input go "go.robcad" : signal',
        )
    )
    files = MemoryFiles()
    interpreter = Interpreter(program, files)
    assert interpreter.resume() == AwaitFile(("flag", "my-data", "go"), 7)
    files.messages["flag"] = (1,)
    assert interpreter.resume() == AwaitFile(("my-data", "go"), 7)
    files.messages["go"] = (1,)
    assert interpreter.resume() == Finished()


def test_a_wait_that_cannot_end_any_more_is_a_fault() -> None:
    end = fault(
        "k := 2 wait until filled(flag) and k = 1",
        f"{FILES} var k : int",
        files=MemoryFiles({"flag": (1,)}),
    )
    assert end.message == "this wait can never end: all its files hold messages"


@pytest.mark.parametrize(
    ("message", "text"),
    [
        ((1.5,), "file `flag` holds `1.5`, but the script expects int"),
        ((1, 2), "file `flag` holds `1 2`, but the script expects int"),
        ((), "file `flag` holds ``, but the script expects int"),
        (("x",), "file `flag` holds `x`, but the script expects int"),
        ((True,), "file `flag` holds `True`, but the script expects int"),
    ],
)
def test_messages_of_the_wrong_type_are_refused(message: tuple[float, ...], text: str) -> None:
    end = fault(
        "read flag into k stop k", f"{FILES} var k : int", files=MemoryFiles({"flag": message})
    )
    assert end == Fault(text, 7)


def test_messages_of_several_values_and_signals() -> None:
    declarations = """
    input many "many.robcad" : int, real, bool, string, pose
    output back "back.robcad" : bool, pose, real
    output bell "bell.robcad" : signal
    var i : int var r : real var b : bool var s : string var p : pose
    """
    files = MemoryFiles({"many": (1, 2, 1, "red", 1.0, 2.0, 3.0, 4.0, 5.0, 6.0)})
    result = run(
        checked(
            script(
                "read many into i, r, b, s, p write back b, p, i write bell signal stop s",
                declarations,
            )
        ),
        files,
    )
    assert result.variables["r"] == 2.0 and isinstance(result.variables["r"], float)
    assert files.messages["back"] == (True, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 1.0)
    assert files.messages["bell"] == (1,)


@pytest.mark.parametrize("statement", ["read flag into k", "clear flag"])
def test_an_empty_file_cannot_be_read_or_consumed(statement: str) -> None:
    end = fault(f"{statement} read flag into k stop k", f"{FILES} var k : int")
    assert end.message.startswith("file `flag` is empty, there is nothing to ")


def test_failures_of_the_files_are_faults_with_their_line() -> None:
    end = fault("wait until filled(flag)", FILES, files=MemoryFiles(broken={"flag"}))
    assert end == Fault("file `flag` cannot be read: disk full of bees", 7)


def test_single_precision_when_stored() -> None:
    declarations = """input f "f.robcad" : pose single
    output g "g.robcad" : real single
    var p : pose var q : real single := 0.1"""
    files = MemoryFiles({"f": (5898.8, 0.1, 0.0, -105.0, 0.0, 0.0)})
    result = run(checked(script("read f into p write g 0.3 stop p, q", declarations)), files)
    assert result.variables["p"].x == 5898.7998046875
    assert result.variables["q"] == 0.10000000149011612
    assert files.messages["g"] == (0.30000001192092896,)


# --- marks -------------------------------------------------------------------------------------


def test_marks_carry_bindings_in_the_form_of_traces() -> None:
    declarations = "var p : pose := pose(1 mm, 2 mm, 3 mm, 4 deg, 5 deg, 6 deg) var k : int := 3"
    result = run(
        checked(
            script('mark Top.R.T with k = k, p = p, u = null, t = [k, true], r = {A = p.x, b = "red"}, x = 0.5 '
                   'mark "Top.R.two words"', declarations)
        )
    )  # fmt: skip
    pose = {"x": 1.0, "y": 2.0, "z": 3.0, "rx": 4.0, "ry": 5.0, "rz": 6.0}
    assert result.events == [
        Marked(
            "Top.R.T",
            {"k": 3, "p": pose, "u": None, "t": [3, True], "r": {"A": 1.0, "b": "red"}, "x": 0.5},
            3,
        ),
        Marked("Top.R.two words", {}, 3),
    ]


# --- expressions -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("expression", "kind", "expected"),
    [
        ("7 div 2", "int", 3),
        ("-7 div 2", "int", -4),
        ("-7 mod 2", "int", 1),
        ("7 / 2", "real", 3.5),
        ("1", "real", 1.0),
        ("round(2.5)", "int", 2),
        ("round(3.5)", "int", 4),
        ("trunc(-2.5)", "int", -2),
        ("floor(-2.5)", "int", -3),
        ("ceil(-2.5)", "int", -2),
        ("1 m + 1 mm", "length", 1001.0),
        ("90 deg / 2", "angle", 45.0),
        ("250 mm/s * 2 s", "length", 500.0),
        ("1 m / 250 mm/s", "time", 4.0),
        ("100 mm / 1 cm", "real", 10.0),
        ("sin(90 deg)", "real", 1.0),
        ("if 1 < 2 then 3 else 1 div 0", "int", 3),
        ("true or 1 div 0 = 1", "bool", True),
        ("false and 1 div 0 = 1", "bool", False),
        ("not true or true", "bool", True),
        ('text(1) & " " & text(1.5) & " " & text(true)', "string", "1 1.5 true"),
        ("max(1, 2.5)", "real", 2.5),
        ("min(3 mm, 2 mm)", "length", 2.0),
        ('"a" < "b"', "bool", True),
        ("1 = 1.0", "bool", True),
        ("50 %", "real", 0.5),
    ],
)
def test_expressions(expression: str, kind: str, expected: object) -> None:
    found = value(expression, kind)
    assert found == expected and type(found) is type(expected)


@pytest.mark.parametrize(
    ("expression", "kind", "message"),
    [
        ("1 div zero", "int", "division by zero"),
        ("1 mod zero", "int", "division by zero"),
        ("1073741823 + 1", "int", "the integer 1073741824 is out of range (31 bits)"),
        ("-1073741823 - 2", "int", "the integer -1073741825 is out of range (31 bits)"),
        ("floor(1 / zero)", "int", "`floor` of inf, which is not a finite number"),
        ("single(1e300)", "real", "1e+300 is too large for single precision"),
    ],
)
def test_expressions_that_fail(expression: str, kind: str, message: str) -> None:
    end = fault(f"z := {expression} stop z, zero", f"var z : {kind} var zero : int := 0")
    assert end == Fault(message, 3)


@pytest.mark.parametrize(
    ("expression", "says"),
    [
        ("1 / zero", "inf"),
        ("-1 / zero", "-inf"),
        ("zero / zero", "nan"),
        ("1e300 * 1e300", "inf"),
        ("sqrt(-1)", "nan"),
        ("min(zero / zero, 2.0)", "2"),
        ("max(2.0, zero / zero)", "2"),
    ],
)
def test_reals_are_those_of_nets(expression: str, says: str) -> None:
    """A script goes on as the net does; only what is carried out has to be finite."""
    declarations = "var z : real var zero : int := 0"
    assert fault(f"z := {expression} stop z, zero", declarations).message == f"{says} 0"
    if says != "2":
        stopped = fault(f"z := {expression} wait z * 1 s", declarations)
        assert stopped.message == f"{says} is not a finite number"


# --- control -----------------------------------------------------------------------------------


def test_loops_branches_procedures_and_jumps() -> None:
    declarations = """var n : int := 0 var log : string := ""
    procedure add log := log & text(n) if n = 4 then return end if log := log & "," end procedure"""
    body = """
    while n < 3 loop n := n + 1 call add end loop
    loop n := n + 1 call add exit when n >= 5 end loop
    again: n := n + 1
    if n = 6 then goto again elsif n = 7 then log := log & "seven" else log := "wrong" end if
    stop log"""
    assert fault(body, declarations).message == "1,2,3,45,seven"


def test_a_jump_may_lead_into_a_block() -> None:
    assert (
        fault("goto inside if n = 1 then inside: n := 5 end if stop n", "var n : int := 0").message
        == "5"
    )


def test_return_ends_the_program() -> None:
    assert run(checked(script("loop return end loop"))).end == Finished()


def test_an_endless_loop_is_a_fault_naming_the_line() -> None:
    program = checked(
        "program t\nvar n : int := 0\nbegin\n  loop\n    n := 1 - n\n  end loop\nend program"
    )
    end = run(program, step_limit=500).end
    assert isinstance(end, Fault)
    assert end.message == "endless loop: 500 statements without a command or a wait"
    assert end.line in (4, 5)


def test_long_rounds_are_those_of_many_transitions() -> None:
    """As many transitions as are permitted, then one more; what they are made of does not count."""
    text = """program t
var n : int := 0
begin
  loop
    mark Turn
    n := n + 1
    exit when n = {}
  end loop
  stop n
end program"""
    assert run(checked(text.format(7)), step_limit=9, occurrences=7).end == Fault("7", 9)
    end = run(checked(text.format(8)), step_limit=9, occurrences=7).end
    assert isinstance(end, Fault)
    assert end.message == "endless loop: more than 7 transitions without a command or a wait"


ALONG = """program t
var l, m : ints
var n : int := 0
begin
  l := ints(1, 2, 3, 4, 5, 6)
  {outer}
    m := ints(1, 2, 3, 4, 5, 6)
    while count_of(m) <> 0 loop
      n := n + first_of(l) * first_of(m)
      {inner}
      m := rest_of(m)
    end loop
    l := {after}
  end loop
  stop n
end program"""


def test_statements_along_lists_do_not_count() -> None:
    """They come to an end, however many there are: a code segment may go along lists within lists."""
    along = "while count_of(l) <> 0 loop"
    text = ALONG.format(outer=along, inner="", after="rest_of(l)")
    assert run(checked(text), step_limit=10).end == Fault("441", 15)


@pytest.mark.parametrize(
    ("outer", "inner", "after"),
    [
        ("while count_of(l) <> 0 loop", "", "with_first(rest_of(l), 1)"),
        ("while count_of(l) <> 0 loop", "l := with_first(l, 1)", "rest_of(l)"),
        ("while count_of(l) <> 0 loop", "m := with_first(m, 1)", "rest_of(l)"),
        ("while count_of(l) <> 0 loop", "loop n := 1 end loop", "rest_of(l)"),
        ("loop", "", "ints(1)"),
    ],
)
def test_loops_along_lists_that_do_not_end(outer: str, inner: str, after: str) -> None:
    text = ALONG.format(outer=outer, inner=inner, after=after)
    end = run(checked(text), step_limit=500).end
    assert isinstance(end, Fault) and "endless loop: 500 statements" in end.message


def test_a_loop_that_takes_time_is_not_endless() -> None:
    result = run(checked(script("loop wait 1 ms end loop")), step_limit=3, requests=50)
    assert len(result.commands) == 50 and result.end is None


def test_stop_joins_its_values() -> None:
    end = fault('stop "k =", k, 1.5, true', "var k : int := 3")
    assert end == Fault("k = 3 1.5 true", 3)


def test_after_a_fault_nothing_happens_any_more() -> None:
    interpreter = Interpreter(checked(script('stop "no" ')), MemoryFiles())
    first = interpreter.resume()
    assert interpreter.resume() == first == Fault("no", 3)


def test_a_variable_without_value_is_a_fault() -> None:
    assert fault("stop n", "var n : int") == Fault("variable `n` has no value yet", 3)


def test_negative_speeds_and_durations_that_only_show_when_running() -> None:
    assert fault("wait w", "var w : time := -2 s").message == "the duration -2 s is negative"
    assert fault("move $joint home at r", "var r : real := 1.5").message == (
        "joint speed 150 % is not above zero and at most 100 %"
    )


def test_a_file_filled_between_two_looks_ends_the_wait() -> None:
    """In real time the writer does not wait for our look at the files to end."""

    class LateFiles:
        """Empty at the first look, filled at all later ones."""

        looks = 0

        def read(self, name: str) -> tuple[int, ...] | None:
            self.looks += 1
            return None if self.looks == 1 else (7,)

        def clear(self, name: str) -> None: ...

        def write(self, name: str, values: tuple[object, ...]) -> None: ...

    program = checked(
        script("wait until filled(f) read f into k stop k", 'input f "f.txt" : int var k : int')
    )
    request = Interpreter(program, LateFiles()).resume()
    assert isinstance(request, Fault)
    assert request.message == "7"


@pytest.mark.parametrize("looks", range(8))
@pytest.mark.parametrize(
    "condition", ["filled(f) or filled(g)", "filled(f) and filled(f) or filled(g)"]
)
def test_a_file_filled_while_the_wait_begins_is_never_waited_past(
    condition: str, looks: int
) -> None:
    """After any look: the script goes on, or is woken by the file, although the other one stays empty for ever."""

    class LateFiles:
        """`f` is filled after some looks at files."""

        seen = 0

        def read(self, name: str) -> tuple[int, ...] | None:
            self.seen += 1
            return (7,) if name == "f" and self.seen > looks else None

        def clear(self, name: str) -> None: ...

        def write(self, name: str, values: tuple[object, ...]) -> None: ...

    declared = 'input f "f.txt" : int input g "g.txt" : int var k : int'
    program = checked(script(f"wait until {condition} read f into k stop k", declared))
    files = LateFiles()
    interpreter = Interpreter(program, files)
    request = interpreter.resume()
    if isinstance(request, AwaitFile):
        assert "f" in request.names
        files.seen = looks  # it is filled now at the latest
        request = interpreter.resume()
    assert isinstance(request, Fault)
    assert request.message == "7"
