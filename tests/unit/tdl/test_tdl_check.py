"""Each static mistake of a script, with its exact diagnostic."""

from __future__ import annotations

import pytest

from helpers.scripts import checked, diagnosed, parsed
from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.render import full
from pn2code.tdl import codes
from pn2code.tdl.check import check

HEAD = """program t
input flag "flag.robcad" : int
input where "where.robcad" : pose
input go "go.robcad" : signal
output done "done.robcad" : int
const JOINT = 1
var k : int := 0
var r : real := 0.5
var s : string := "s"
var b : bool := true
var p : pose := pose(0 mm, 0 mm, 0 mm, 0 deg, 0 deg, 0 deg)
var x : length := 1 mm
var w : time := 1 s
var v : speed := 1 mm/s
var a : angle := 1 deg
begin
"""
# Uses everything, so that only the mistake under test is reported.
FOOT = """
if filled(flag) then read flag into k end if
if filled(where) then read where into p end if
if filled(go) then clear go end if
write done k + JOINT
stop s, b, r, x, w, v, a, p.x
end program
"""

ERRORS = [
    # names
    ("q := 1", "17:1 error[tdl-unknown-name] variable `q` is not declared"),
    ("k := q", "17:6 error[tdl-unknown-name] variable `q` is not declared"),
    ("call q", "17:6 error[tdl-unknown-name] there is no procedure `q`"),
    ("JOINT := 2", "17:1 error[tdl-not-a-variable] `JOINT` is a constant and cannot be assigned"),
    ("flag := 2", "17:1 error[tdl-not-a-variable] `flag` is a file and cannot be assigned"),
    ("k := flag", "17:6 error[tdl-not-a-variable] `flag` is a file and has no value here"),
    ("k := sine(1)", "17:6 error[tdl-unknown-function] there is no function `sine`"),
    ("x := abs(1 mm, 2 mm)", "17:6 error[tdl-arguments] `abs` takes 1 arguments, but 2 are given"),
    ("x := p.w", "17:6 error[tdl-unknown-field] `pose` has no field `w`"),
    ("x := k.x", "17:6 error[tdl-unknown-field] `int` has no field `x`"),
    # types
    ("k := true", "17:6 error[tdl-type] `k` must be of type `int`, but this is `bool`"),
    ("k := 1.5", "17:6 error[tdl-type] `k` must be of type `int`, but this is `real`"),
    (
        "if k then end if",
        "17:4 error[tdl-type] the condition must be of type `bool`, but this is `int`",
    ),
    (
        "while p loop end loop",
        "17:7 error[tdl-type] the condition must be of type `bool`, but this is `pose`",
    ),
    ("k := k + true", "17:6 error[tdl-type] `+` cannot be applied: `int` and `bool`"),
    ("b := b < b", "17:6 error[tdl-type] `<` cannot be applied: `bool` and `bool`"),
    ("b := not k", "17:10 error[tdl-type] `not` needs `bool`, but this is `int`"),
    (
        "k := if b then 1 else s",
        "17:6 error[tdl-type] `then` and `else` give different types: `int` and `string`",
    ),
    ("move $joint k", "17:13 error[tdl-type] the target must be of type `pose`, but this is `int`"),
    (
        "measure p into k",
        "17:16 error[tdl-type] `k` is of type `int`, but a measurement gives `pose`",
    ),
    # units
    ("x := x + 100", "17:6 error[tdl-unit] `+` cannot be applied: `length` and `int`"),
    ("x := 100", "17:6 error[tdl-unit] `x` must be of type `length`, but this is `int`"),
    ("x := 90 deg", "17:6 error[tdl-unit] `x` must be of type `length`, but this is `angle`"),
    ("x := x * x", "17:6 error[tdl-unit] `*` cannot be applied: `length` and `length`"),
    ("b := x < w", "17:6 error[tdl-unit] `<` cannot be applied: `length` and `time`"),
    ("wait 2", "17:6 error[tdl-unit] the duration must be of type `time`, but this is `int`"),
    (
        "speed $linear 5",
        "17:15 error[tdl-unit] linear speed must be of type `speed`, but this is `int`",
    ),
    (
        "speed $joint 5 mm/s",
        "17:14 error[tdl-unit] joint speed must be of type `real`, but this is `speed`",
    ),
    (
        "r := sin(1.5)",
        "17:10 error[tdl-unit] the argument of `sin` must be of type `angle`, but this is `real`",
    ),
    (
        "p := pose(1, 0 mm, 0 mm, 0 deg, 0 deg, 0 deg)",
        "17:11 error[tdl-unit] `x` of a pose must be of type `length`, but this is `int`",
    ),
    ("x := min(1 mm, 2)", "17:6 error[tdl-unit] `min` cannot be applied: `length` and `int`"),
    # ill-typed inside what has a type: it has no value
    ("wait ceil()", "17:6 error[tdl-arguments] `ceil` takes 1 arguments, but 0 are given"),
    (
        'wait pose(0 mm, "a", 0 mm, 0 deg, 0 deg, 0 deg).y / 1 mm/s',
        "17:17 error[tdl-type] `y` of a pose must be of type `length`, but this is `string`",
    ),
    # files
    ("clear nothing", "17:7 error[tdl-unknown-file] file `nothing` is not declared"),
    ("wait until filled(nothing)", "17:19 error[tdl-unknown-file] file `nothing` is not declared"),
    ("wait until filled(1 + 1)", "17:19 error[tdl-unknown-file] `filled` takes the name of a file"),
    (
        "read done into k",
        "17:6 error[tdl-file-direction] file `done` cannot be read: it is an `output` file, which this script writes",
    ),
    (
        "clear done",
        "17:7 error[tdl-file-direction] file `done` cannot be cleared: "
        "it is an `output` file, which this script writes",
    ),
    (
        "write flag 1",
        "17:7 error[tdl-file-direction] file `flag` cannot be written: it is an `input` file, which this script reads",
    ),
    (
        "wait until filled(done)",
        "17:19 error[tdl-file-direction] file `done` cannot be waited for: "
        "it is an `output` file, which this script writes",
    ),
    (
        "read flag into k, r",
        "17:1 error[tdl-file-values] file `flag` takes 1 variable, but 2 are given",
    ),
    ("write done 1, 2", "17:1 error[tdl-file-values] file `done` takes 1 value, but 2 are given"),
    ("write done signal", "17:1 error[tdl-file-values] file `done` takes 1 value, but 0 are given"),
    ("read go into k", "17:1 error[tdl-file-values] file `go` takes `signal`, but 1 is given"),
    (
        "read where into k",
        "17:17 error[tdl-type] `k` is of type `int`, but file `where` holds `pose`",
    ),
    (
        "write done 1 mm",
        "17:12 error[tdl-unit] file `done` must be of type `int`, but this is `length`",
    ),
    (
        "wait until k = 1",
        "17:12 error[tdl-wait-nothing] this wait can never end: while the script waits only files change",
    ),
    # commands
    ("move $linear p in base", "17:19 error[tdl-unknown-frame] there is no frame `base`"),
    (
        "move $joint p in tool",
        "17:18 error[tdl-frame] a joint move goes to an absolute pose, it cannot be made in the tool frame",
    ),
    (
        "move $joint home in world",
        "17:21 error[tdl-frame] `home` is a joint position and has no frame",
    ),
    ("move $linear home", "17:1 error[tdl-frame] `home` is a joint position"),
    ("move $circular home via p", "17:1 error[tdl-frame] `home` is a joint position"),
    (
        "move $joint axes(a, a, a, a, a)",
        "17:13 error[tdl-arguments] `axes` takes 4, 6 or 7 numbers, one for each axis of the arm, but 5 are given",
    ),
    (
        "move $joint axes(a, a, x, a, a, a)",
        "17:24 error[tdl-unit] the angle of axis 3 must be of type `angle`, but this is `length`",
    ),
    (
        "move $joint axes(a, a, a, a, a, a) in world",
        "17:39 error[tdl-frame] `axes(...)` is a joint position and has no frame",
    ),
    (
        "move $linear axes(a, a, a, a, a, a)",
        "17:1 error[tdl-frame] `axes(...)` is a joint position",
    ),
    ("move $circular p", "17:1 error[tdl-via] a circular move needs a pose on the way"),
    (
        "move $joint home with $track rail = 1 mm",
        "17:23 error[tdl-external] on the way home external axes stand still",
    ),
    (
        "move $linear p via p",
        "17:20 error[tdl-via] a linear move by way of poses needs a zone in which its corners are rounded",
    ),
    (
        "move $linear p via p, p with $blend = 0 mm",
        "17:39 error[tdl-via] the zone of the corners must be above zero",
    ),
    (
        "move $linear p with $blend = 5 mm",
        "17:30 error[tdl-via] only a linear move by way of poses has a zone for its corners",
    ),
    (
        "move $joint p via p",
        "17:19 error[tdl-via] only circular and linear moves go by way of a pose",
    ),
    (
        "move $circular p via p, p",
        "17:25 error[tdl-via] a circular move needs one pose on the way",
    ),
    (
        "move $linear p via p with $blend = 5 mm, $track rail = 1 mm",
        "17:42 error[tdl-external] external axes stand still on a linear move by way of poses",
    ),
    (
        "move $linear p via p with $zone = 5 mm",
        "17:27 error[tdl-external] `$zone` says nothing of a move",
    ),
    (
        "move $circular p via x",
        "17:22 error[tdl-type] the pose on the way must be of type `pose`, but this is `length`",
    ),
    (
        "move $joint p acceleration 120 %",
        "17:28 error[tdl-speed] the acceleration must be above zero and at most 100 %",
    ),
    (
        "move $linear p acceleration v",
        "17:29 error[tdl-unit] acceleration must be of type `real`, but this is `speed`",
    ),
    (
        "speed $circular v",
        "17:1 error[tdl-speed] circular moves have the speed of linear moves",
    ),
    (
        "p := before(p, 3)",
        "17:16 error[tdl-unit] the distance of `before` must be of type `length`, but this is `int`",
    ),
    (
        "speed $joint 150 %",
        "17:14 error[tdl-speed] the joint speed must be above zero and at most 100 %",
    ),
    ("move $linear p at 0 mm/s", "17:19 error[tdl-speed] the linear speed must be above zero"),
    ("wait -1 s", "17:6 error[tdl-speed] the duration is negative"),
    # control
    ("goto nowhere", "17:6 error[tdl-unknown-label] there is no label `nowhere` in this body"),
    ("exit", "17:1 error[tdl-exit] `exit` stands outside a loop"),
    ("l: l: goto l", "17:4 error[tdl-duplicate] label `l` is set twice"),
    ("mark T with k = 1, k = 2", "17:1 error[tdl-duplicate] `k` is bound twice"),
    ("mark T with k = {z = [zz]}", "17:23 error[tdl-unknown-name] variable `zz` is not declared"),
]


@pytest.mark.parametrize(("statement", "expected"), ERRORS)
def test_errors_in_statements(statement: str, expected: str) -> None:
    assert diagnosed(HEAD + statement + FOOT) == [expected]


def test_the_text_around_the_mistakes_is_right() -> None:
    assert diagnosed(HEAD + FOOT) == []


DECLARATIONS = [
    ("var k : int const k = 1", ["1:29 error[tdl-duplicate] `k` is declared twice"]),
    ("var abs : int", ["1:15 error[tdl-reserved] `abs` is a name of the language"]),
    ("var g : signal", ["1:19 error[tdl-type] only files can be of type `signal`"]),
    (
        'input f "f" : signal, int',
        ["1:25 error[tdl-type] `signal` cannot be combined with other types"],
    ),
    (
        'input f "f" : int output g "f" : int',
        ["1:36 error[tdl-duplicate] the file `f` is declared twice"],
    ),
    (
        "var n : int := 1 const c = n",
        ["1:38 error[tdl-constant] the value of constant `c` is not known: `n` is not a constant declared before"],
    ),
    (
        'const c = pose(0 mm, "a", 0 mm, 0 deg, 0 deg, 0 deg)',
        ["1:32 error[tdl-type] `y` of a pose must be of type `length`, but this is `string`"],
    ),
    ("const c = 1 div 0", ["1:21 error[tdl-constant] the value of constant `c` is not known: division by zero"]),
    ("var n : int := 1 mm", ["1:26 error[tdl-unit] the value of `n` must be of type `int`, but this is `length`"]),
    ("procedure q call q end procedure",
     ["1:28 error[tdl-recursion] procedure `q` calls itself, directly or through others"]),
    ("var n : int", ["1:15 warning[tdl-unused] variable `n` is never used"]),
    ("const c = 1", ["1:17 warning[tdl-unused] constant `c` is never used"]),
    ('input f "f" : int', ["1:17 warning[tdl-unused] file `f` is never used"]),
    ("procedure q wait 1 s end procedure", ["1:21 warning[tdl-unused] procedure `q` is never called"]),
]  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), DECLARATIONS)
def test_declarations(text: str, expected: list[str]) -> None:
    assert diagnosed(f"program t {text} begin wait 1 s end program") == expected


WARNINGS = [
    ("var n : int begin n := 1", ["1:15 warning[tdl-unused] variable `n` is assigned but never read"]),
    ("begin return wait 1 s", ["1:24 warning[tdl-unreachable] this statement can never be reached"]),
    ("begin loop wait 1 s end loop wait 2 s wait 3 s",
     ["1:40 warning[tdl-unreachable] this statement can never be reached"]),
    ("begin stop \"x\" wait 2 s", ["1:26 warning[tdl-unreachable] this statement can never be reached"]),
    ("begin loop exit wait 2 s end loop", ["1:27 warning[tdl-unreachable] this statement can never be reached"]),
    ("begin goto l wait 2 s l: wait 1 s", ["1:24 warning[tdl-unreachable] this statement can never be reached"]),
    ("begin while false loop wait 1 s end loop", ["1:34 warning[tdl-unreachable] this statement can never be reached"]),
    ("begin l: wait 1 s", ["1:17 warning[tdl-unused-label] no `goto` leads to label `l`"]),
    ("var n : int begin stop n", ["1:34 warning[tdl-unassigned] variable `n` may have no value here"]),
    (
        "var n, i : int begin loop exit when 0 < i i := 1 end loop stop n",
        [
            "1:51 warning[tdl-unassigned] variable `i` may have no value here",
            "1:74 warning[tdl-unassigned] variable `n` may have no value here",
        ],
    ),
    ("var b : bool := true var n : int begin if b then n := 1 end if stop n",
     ["1:79 warning[tdl-unassigned] variable `n` may have no value here"]),
    ("var b : bool := true var n : int begin if b then n := 1 else n := 2 end if stop n", []),
    ("var n : int procedure q n := 1 end procedure begin call q stop n", []),
    ("var n : int procedure q stop n end procedure begin n := 1 call q", []),
    ("var n : int procedure q stop n end procedure begin call q",
     ["1:40 warning[tdl-unassigned] variable `n` may have no value here"]),
    ("begin l: wait 1 s goto l", []),
    ("begin loop wait 1 s end loop", []),
]  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), WARNINGS)
def test_warnings(text: str, expected: list[str]) -> None:
    assert diagnosed(f"program t {text} end program") == expected


def test_consequences_are_not_reported() -> None:
    """One mistake in an expression gives one message."""
    assert (
        len(diagnosed(HEAD + "x := (q + 1) * 2 + sin(q) " + FOOT)) == 2
    )  # each unknown name, nothing else


def test_independent_mistakes_are_all_reported() -> None:
    assert len(diagnosed(HEAD + "k := true wait 2 clear nothing goto l" + FOOT)) >= 4


def test_a_mistake_is_shown_with_line_and_caret() -> None:
    d = Diagnostics()
    check(
        parsed(
            "program t\nvar p : pose\nvar z : length\nbegin\n  z := p.z + 100\n  stop z\nend program"
        ),
        d,
    )
    assert full(d.errors[0]) == (
        "error[tdl-unit]: `+` cannot be applied: `length` and `int`\n"
        "   --> s.tdl:5:8\n"
        "  5 |    z := p.z + 100\n"
        "    |         ^^^^^^^^^\n"
        "    = help: give the plain number a unit: `1 mm`"
    )


def test_near_names_are_suggested() -> None:
    d = Diagnostics()
    check(parsed("program t var counter : int begin conter := 1 stop counter end program"), d)
    assert d.errors[0].hint == "did you mean `counter`?"


def test_units_that_do_fit() -> None:
    checked(
        HEAD
        + "x := v * w v := x / w w := x / v r := x / 1 mm x := x * k x := 2 * x\na := a / 2\nb := x < 1 m\n"
        + "x := abs(-x) r := k r := min(k, r) r := single(r) k := round(r) s := text(x) & s b := p = p"
        + FOOT
    )


def test_every_code_of_the_language_is_tested_here_or_with_the_parser() -> None:
    tested = " ".join([e for _, e in ERRORS] + [e for _, es in DECLARATIONS + WARNINGS for e in es])
    with_the_parser = {
        codes.SYNTAX,
        codes.NESTING,
        codes.UNKNOWN_UNIT,
        codes.UNKNOWN_TYPE,
        codes.UNKNOWN_MOTION,
    }
    ours = {v for k, v in vars(codes).items() if k.isupper()}
    assert {c for c in ours - with_the_parser if f"[{c}]" not in tested} == set()
