"""What `check` says of `[primitives]`: no command of a robot vanishes from its script without a word."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.small_cell import NET, TOML, write
from pn2code.cell.load import load
from pn2code.diagnostics import Diagnostic, Diagnostics, Severity
from pn2code.division import divided
from pn2code.net import front


def said(folder: Path, net: str = NET, toml: str = TOML) -> list[Diagnostic]:
    """All errors and warnings of a cell, without exploring it."""
    cell = write(folder, net, toml)
    d = Diagnostics()
    config = load(cell, d)
    if config is not None:
        flat = front.load(config.net_path, d, config.values)
        assert flat is not None, list(d)
        divided(flat, config, d)
    return d.sorted()


def errors(folder: Path, net: str = NET, toml: str = TOML) -> list[tuple[str, str]]:
    return [(x.code, x.message) for x in said(folder, net, toml) if x.severity is Severity.ERROR]


def changed(text: str, old: str, new: str) -> str:
    assert text.count(old) >= 1, old
    return text.replace(old, new, 1)


BLOCK = """  fun moveJoint (p : POSE) = ();
  fun moveHome () = ();
  fun drill () = ();
"""
IN_BLOCK = (
    '  block "Robot primitives"\n'
    + "".join(f"  {x}\n" for x in BLOCK.splitlines())
    + "    fun measure (p : POSE) = p;\n    fun park () = ();\n"
)


def test_the_cell_itself_is_right(tmp_path: Path) -> None:
    assert not said(tmp_path)


# --- entries ---------------------------------------------------------------------------------------

ENTRIES = {
    "misspelt": ("moveHome = {", "moveHom = {", "primitive-entry", "the net has no function `moveHom`"),
    "a constant": ("moveHome = {", "MOVE = {", "primitive-entry", "`MOVE` has type `int`"),
    "deleted": ('moveHome = { command = "move_home" }', "", "primitive-unnamed", "`moveHome` is no primitive"),
    "another command": ('moveHome = { command = "move_home" }', 'moveHome = { command = "move_joint" }',
                        "primitive-entry", "`moveHome` has type `unit -> unit`"),
    "a tool that takes a pose": ('moveJoint = { command = "move_joint" }',
                                 'moveJoint = { command = "tool", action = "a", duration_s = 1 }',
                                 "primitive-entry", "a function for `tool` has type `unit -> unit`"),
    "a wait of no time": ('moveHome = { command = "move_home" }', 'moveHome = { command = "wait" }',
                          "primitive-entry", "`moveHome` takes no number of seconds"),
    "a frame for no reason": ('"move_home"', '"move_home", frame = "tool"', "cell-key", "unknown key `frame`"),
    "linear without a frame": ('"move_joint"', '"move_linear"', "primitive-entry", "`primitives.moveJoint.frame`"),
    "unknown command": ('"move_home"', '"move_hom"', "cell-value", "unknown robot command `move_hom`"),
}  # fmt: skip


@pytest.mark.parametrize("what", ENTRIES)
def test_entries(what: str, tmp_path: Path) -> None:
    old, new, code, words = ENTRIES[what]
    found = errors(tmp_path, toml=changed(TOML, old, new))
    assert any(c == code and words in m for c, m in found), found


def test_a_wait_has_its_seconds_once(tmp_path: Path) -> None:
    """What stood in the entry would have no effect."""
    net = changed(NET, "fun moveHome () = ();", "fun moveHome (s : real) = ();")
    net = net.replace("moveHome ()", "moveHome 1.0")
    toml = changed(TOML, '"move_home"', '"wait", duration_s = 2.0')
    assert [m for _, m in errors(tmp_path, net, toml)] == [
        "`moveHome` takes a number of seconds, and the entry has one, too"
    ]


def test_a_misspelt_entry_is_told_the_function(tmp_path: Path) -> None:
    found = said(tmp_path, toml=changed(TOML, "moveHome = {", "moveHom = {"))
    (entry,) = (x for x in found if x.code == "primitive-entry")
    assert entry.hint == "did you mean `moveHome`?"
    assert (
        entry.origin.file.endswith("cell.toml")
        and entry.origin.line == TOML[: TOML.index("moveHome")].count("\n") + 1
    )


def test_a_duration_with_its_unit_is_told_to_leave_it_out(tmp_path: Path) -> None:
    with_unit = '{ command = "tool", action = "a", duration_s = "1.5 s" }'
    found = said(tmp_path, toml=changed(TOML, '{ command = "move_home" }', with_unit))
    (entry,) = (x for x in found if "`duration_s` is `1.5 s`" in x.message)
    assert entry.hint == "write the number without quotes and unit: `1.5`"


# --- calls of robots -------------------------------------------------------------------------------

HOME = "code action moveHome ()"
LOST = {
    "a function that does nothing": (
        "  fun note () = ();\n",
        "code action (note (); moveHome ())",
        "`note` is no primitive",
    ),
    "through another function": (
        "  fun note () = ();\n  fun home () = (note (); moveHome ());\n",
        "code action home ()",
        "`note` is no primitive",
    ),
    "in a let": (
        "",
        "code action let fun note () = () in (note (); moveHome ()) end",
        "`note` is no primitive",
    ),
    "curried": (
        "  fun note (a : int) (b : int) = ();\n",
        "code action (note 1 2; moveHome ())",
        "`note` is no primitive",
    ),
    "a value that nobody wants": (
        "",
        "code action (at 3; moveHome ())",
        "the result of this call is not used",
    ),
    "a value that is thrown away": (
        "",
        "code action let val _ = at 3 in moveHome () end",
        "the result of this call",
    ),
    "a value that is kept for nothing": (
        "",
        "code action let val x = at 3 in moveHome () end",
        "the result of this call",
    ),
    "it gives back what it gets, as a value": (
        "  val measure = fn (p : POSE) => p;\n",
        "code action moveJoint (measure (at 3))",
        "`measure` stands among the primitives",
    ),
    "it gives back what it gets": (
        "  fun measure (p : POSE) = p;\n",
        "code action moveJoint (measure (at 3))",
        "`measure` stands among the primitives",
    ),
}


@pytest.mark.parametrize("what", LOST)
def test_a_call_that_no_script_carries_out(what: str, tmp_path: Path) -> None:
    functions, code, words = LOST[what]
    net = changed(changed(NET, "  var n, k: INT;\n", f"{functions}  var n, k: INT;\n"), HOME, code)
    found = errors(tmp_path, net)
    assert found and {c for c, _ in found} == {"primitive-unnamed"}, found
    assert words in found[0][1]


KEPT = {
    "made of primitives": (
        "  fun home () = (moveJoint (at 3); moveHome ());\n",
        "code action home ()",
    ),
    "a value that is used": ("", "code action let val x = at 3 in (moveJoint x; moveHome ()) end"),
    "a choice": ("  fun home b = if b then moveHome () else ();\n", "code action home (1 < 2)"),
    "another name": ("  val home = moveHome;\n", "code action home ()"),
    "nothing": ("", "code action ()"),
}


@pytest.mark.parametrize("what", KEPT)
def test_calls_that_scripts_carry_out(what: str, tmp_path: Path) -> None:
    functions, code = KEPT[what]
    net = changed(changed(NET, "  var n, k: INT;\n", f"{functions}  var n, k: INT;\n"), HOME, code)
    assert not errors(tmp_path, net)


def test_a_hidden_function_of_the_same_name_is_no_primitive(tmp_path: Path) -> None:
    net = changed(
        NET,
        "  fun drill () = ();\n",
        "  fun drill () = ();\n  fun first () = drill ();\n  fun drill () = ();\n",
    )
    assert not errors(tmp_path / "a", net)
    found = errors(
        tmp_path / "b", changed(net, "code action drill ()", "code action (first (); drill ())")
    )
    assert {c for c, _ in found} == {"primitive-unnamed"}


def test_a_function_among_the_primitives(tmp_path: Path) -> None:
    """Where nobody calls it, nothing is missing from a script: a warning. Where somebody does, an error."""
    net = changed(NET, BLOCK, IN_BLOCK)
    found = said(tmp_path / "a", net)
    assert [(x.severity, x.code) for x in found] == [(Severity.WARNING, "primitive-unnamed")] * 2
    assert "`measure` is declared among the primitives" in found[0].message
    called = changed(net, "action moveJoint p", "action moveJoint (measure p)")
    found = said(tmp_path / "b", called)
    assert [(x.severity, x.code) for x in found] == [
        (Severity.WARNING, "primitive-unnamed"),
        (Severity.ERROR, "primitive-unnamed"),
    ]
    assert "its call would be missing from the script" in found[1].message


# --- elsewhere -------------------------------------------------------------------------------------

SEND = "    trans End\n"
MISPLACED = {
    "code segment": (SEND, "    trans End code action moveHome ()\n", "code segment of transition `End`"),
    "guard": (SEND, "    trans End guard [moveHome () = ()]\n", "guard of transition `End`"),
    "arc": ("out Finished : k", "out Finished : (moveHome (); k)", "arc inscription of transition `End`"),
    "delay": (SEND, "    trans End delay @+(moveHome (); 0)\n", "delay of transition `End`"),
    "initial marking": ("place Pieces : INT = 1`1", "place Pieces : INT = 1`(moveHome (); 1)",
                        "initial marking of place `Pieces`"),
}  # fmt: skip


@pytest.mark.parametrize("what", MISPLACED)
@pytest.mark.parametrize("through", [False, True])
def test_a_primitive_in_the_supervisor(what: str, through: bool, tmp_path: Path) -> None:
    old, new, words = MISPLACED[what]
    net = NET
    if through:
        net = changed(net, "  var n, k: INT;\n", "  fun park () = moveHome ();\n  var n, k: INT;\n")
        new = new.replace("moveHome", "park")
    found = [x for x in said(tmp_path, changed(net, old, new)) if x.severity is Severity.ERROR]
    assert [x.code for x in found] == ["primitive-misplaced"], found
    assert words in found[0].message and "`moveHome`" in found[0].message
    assert ("through `park`" in found[0].message) == through
    if "transition" in words:
        assert "on page `Sup`" in found[0].message and "on page `Rob`" in found[0].hint


def test_a_primitive_in_a_constant(tmp_path: Path) -> None:
    net = changed(NET, "  var n, k: INT;\n", "  val x = (drill (); 1);\n  var n, k: INT;\n")
    assert [c for c, _ in errors(tmp_path, net)] == ["primitive-misplaced"]


def test_a_primitive_in_a_guard_of_a_robot(tmp_path: Path) -> None:
    net = changed(NET, "trans Report\n", "trans Report guard [drill () = ()]\n")
    ((code, message),) = errors(tmp_path, net)
    assert code == "primitive-misplaced"
    assert "in the guard of transition `Report` on page `Rob` of the robot `robot1`" in message


ANY = (
    "  fun moveJoint p = ();\n"
    "  fun flat ({x, y, ...} : POSE) = {X = x, Y = y, Z = 0.0, RX = 0.0, RY = 0.0, RZ = 0.0};\n"
)


def test_a_primitive_that_takes_anything_is_told_one_type_of_poses(tmp_path: Path) -> None:
    """Else it is not known of what it has to be finite."""
    one = changed(NET, "  fun moveJoint (p : POSE) = ();\n", "  fun moveJoint p = ();\n")
    assert not said(tmp_path / "one", one)
    two = changed(NET, "  fun moveJoint (p : POSE) = ();\n", ANY)
    two = changed(two, "action moveJoint p", "action moveJoint (flat p)")
    ((code, message),) = errors(tmp_path / "two", two)
    assert code == "primitive-entry"
    assert message.startswith(
        "`moveJoint` takes a value of any type, and the net has poses of 2 types"
    )
