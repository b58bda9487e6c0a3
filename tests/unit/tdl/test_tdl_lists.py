"""Lists in scripts: what can be done with them, how they come from files and go into them, what stops a script."""

from __future__ import annotations

import pytest

from helpers.scripts import MemoryFiles, checked, diagnosed, run
from pn2code.tdl.evaluate import ScriptPose
from pn2code.tdl.requests import Fault, Marked, MessageWritten

FILES = """
input  batch "batch.txt" : int, ints, string
input  way   "way.txt" : poses
input  names "names.txt" : words
output done  "done.txt" : ints, bool
output said  "said.txt" : words
"""
POSE = "pose(1 mm, 2 mm, 3 mm, 4 deg, 5 deg, 6 deg)"


def script(body: str, declarations: str = "") -> str:
    return f"program t {declarations}\nbegin\n{body}\nend program"


@pytest.mark.parametrize(
    ("expression", "kind", "expected"),
    [
        ("ints()", "ints", ()),
        ("ints(3, 1, 2)", "ints", (3, 1, 2)),
        ("reals(1, 2.5)", "reals", (1.0, 2.5)),
        ("with_first(ints(2), 1)", "ints", (1, 2)),
        ("joined(strings(\"a\"), strings(\"b\", \"c\"))", "strings", ("a", "b", "c")),
        ("reversed(bools(true, false, false))", "bools", (False, False, True)),
        ("rest_of(ints(1, 2, 3))", "ints", (2, 3)),
        ("first_of(strings(\"x\", \"y\"))", "string", "x"),
        ("item_of(ints(5, 6, 7), 2)", "int", 7),
        ("count_of(poses())", "int", 0),
        (f"first_of(poses({POSE}))", "pose", ScriptPose(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)),
        (f"first_of(poses({POSE})).y / 1 mm", "real", 2.0),
        ("ints(1, 2) = with_first(ints(2), 1)", "bool", True),
        ("ints() <> ints()", "bool", False),
        ("if 1 < 2 then ints(1) else ints()", "ints", (1,)),
        ("text(ints(1, 2))", "string", "[1, 2]"),
        ("single(reals(0.1))", "reals", (0.10000000149011612,)),
    ],
)  # fmt: skip
def test_expressions(expression: str, kind: str, expected: object) -> None:
    result = run(checked(script(f"z := {expression} stop z", f"var z : {kind}")))
    assert result.variables["z"] == expected
    assert type(result.variables["z"]) is type(expected)


@pytest.mark.parametrize(
    ("expression", "words"),
    [
        ("first_of(ints())", "`first_of` of an empty list"),
        ("rest_of(poses())", "`rest_of` of an empty list"),
        ("item_of(ints(1, 2), 2)", "`item_of` of a list of 2, which has no item 2"),
        ("item_of(ints(1, 2), -1)", "`item_of` of a list of 2, which has no item -1"),
    ],
)
def test_what_is_not_there_stops_the_script(expression: str, words: str) -> None:
    end = run(checked(script(f"compute {expression}"))).end
    assert isinstance(end, Fault) and words in end.message


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("k := ints(1.5)", "an item of `ints` must be of type `int`, but this is `real`"),
        ("k := with_first(ints(), 1.5)", "the second argument of `with_first` must be of type"),
        ("k := joined(ints(), reals())", "the second argument of `joined` must be of type"),
        ("k := item_of(ints(1), 0)", "`k` must be of type `ints`, but this is `int`"),
        ("compute count_of(3)", "the argument of `count_of` must be a list, but this is `int`"),
        ("compute item_of(ints(1), 0.5)", "the number of an item must be of type `int`"),
        ("compute ints(1) < ints(2)", "`<` cannot be applied"),
        ("compute words()", "there is no function `words`"),
        ("sense eye into k", "a sensor gives a number"),
    ],
)
def test_mistakes(body: str, words: str) -> None:
    found = "\n".join(map(str, diagnosed(script(f"{body} stop k", "var k : ints := ints()"))))
    assert words in found


def test_only_files_hold_words() -> None:
    found = "\n".join(map(str, diagnosed(script("stop 1", "var k : words"))))
    assert "only files can be of type `words`" in found


def test_messages() -> None:
    files = MemoryFiles(
        {
            "batch": (7, 2, 4, 5, "x"),
            "way": (2, *map(float, range(12))),
            "names": (3, "a", "b", "a"),
        }
    )
    body = """
  wait until filled(batch) read batch into n, l, s clear batch
  wait until filled(way) read way into w clear way
  wait until filled(names) read names into g clear names
  mark T with l = l, w = w, g = g, e = rest_of(rest_of(l))
  while count_of(w) <> 0 loop move $joint first_of(w) w := rest_of(w) end loop
  write done with_first(l, n), count_of(w) = 0
  write said reversed(rest_of(g))
  stop s
"""
    own = "var n : int var l : ints var s : string var w : poses var g : strings"
    result = run(checked(script(body, FILES + own)), files=files)
    assert len(result.commands) == 2
    (mark,) = [e for e in result.events if isinstance(e, Marked)]
    labels = ("x", "y", "z", "rx", "ry", "rz")
    assert mark.binding == {
        "l": [4, 5],
        "w": [
            dict(zip(labels, map(float, range(6)), strict=True)),
            dict(zip(labels, map(float, range(6, 12)), strict=True)),
        ],
        "g": ["a", "b", "a"],
        "e": [],
    }
    written = [e.values for e in result.events if isinstance(e, MessageWritten)]
    assert written == [(3, 7, 4, 5, True), (2, "a", "b")]


@pytest.mark.parametrize("message", [(7, 2, 4, "x"), (7, 1, 4, 5, "x"), (7, True, 4, "x"), (7, 0)])
def test_a_message_of_another_shape_stops_the_script(message: tuple[object, ...]) -> None:
    files = MemoryFiles({"batch": message})
    own = "var n : int var l : ints var s : string"
    body = "wait until filled(batch) read batch into n, l, s stop text(n) & text(l) & s"
    end = run(checked(script(body, FILES.split("input  way")[0] + own)), files=files).end
    assert isinstance(end, Fault) and "but the script expects int, ints, string" in end.message
