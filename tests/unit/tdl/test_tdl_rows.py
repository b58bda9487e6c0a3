"""Lists of records in scripts: a list for each field, which come from files and go into them item by item."""

from __future__ import annotations

import pytest

from helpers.scripts import MemoryFiles, checked, diagnosed, parsed, run
from pn2code.tdl import tree as t
from pn2code.tdl.pretty import declaration
from pn2code.tdl.requests import Fault, Marked, MessageWritten
from pn2code.tdl.types import Type

FILES = """
input  found "found.txt" : string, rows(int, word, pose single), ints, rows(bool)
output done  "done.txt" : rows(word, int), real
var s : string var spots : ints var kinds : strings var places : poses var l : ints var b : bools
"""
PLACE = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)


def script(body: str, declarations: str = FILES) -> str:
    return f"program t {declarations}\nbegin\n{body}\nend program"


def test_what_files_hold_is_written_as_it_is_read() -> None:
    files = [x for x in parsed(script("")).declarations if isinstance(x, t.File)]
    kinds = [(k.type, k.single, k.row) for k in files[0].types]
    assert kinds == [
        (Type.STRING, False, 0),
        (Type.INTS, False, 1),
        (Type.WORDS, False, 1),
        (Type.POSES, True, 1),
        (Type.INTS, False, 0),
        (Type.BOOLS, False, 2),
    ]
    texts = [declaration(x) for x in files]
    assert (
        texts[0]
        == 'input found "found.txt" : string, rows(int, word, pose single), ints, rows(bool)'
    )
    again = parsed(script("", "\n".join(texts)))
    assert list(again.declarations) == files


def test_messages() -> None:
    message = ("x", 2, 7, "burn", *PLACE, 8, "scratch", *PLACE, 1, 5, 1, True)
    body = """
  wait until filled(found) read found into s, spots, kinds, places, l, b clear found
  mark T with d = each {spot = spots, more = {kind = kinds, place = places}}, e = each [kinds, b], l = l
  write done rest_of(kinds), with_first(ints(), first_of(l)), 1.5
"""
    # Columns of different lengths are no list of records.
    result = run(checked(script(body)), files=MemoryFiles({"found": message}))
    assert isinstance(result.end, Fault)
    assert result.end.message == "columns of one list of records have 1 and 2 items"

    result = run(
        checked(script(body.replace(", e = each [kinds, b]", "") + " stop s")),
        files=MemoryFiles({"found": message}),
    )
    (mark,) = [e for e in result.events if isinstance(e, Marked)]
    place = dict(zip(("x", "y", "z", "rx", "ry", "rz"), PLACE, strict=True))
    assert mark.binding == {
        "d": [
            {"spot": 7, "more": {"kind": "burn", "place": place}},
            {"spot": 8, "more": {"kind": "scratch", "place": place}},
        ],
        "l": [5],
    }
    written = [e.values for e in result.events if isinstance(e, MessageWritten)]
    assert written == [(1, "scratch", 5, 1.5)]


def test_columns_of_different_lengths_are_not_written() -> None:
    body = 'write done strings("a", "b"), ints(1), 0.5'
    only = 'output done "done.txt" : rows(word, int), real'
    result = run(checked(script(body, only)))
    assert isinstance(result.end, Fault)
    assert result.end.message == "columns of one list of records have 1 and 2 items"
    assert not [e for e in result.events if isinstance(e, MessageWritten)]


@pytest.mark.parametrize(
    "message",
    [("x", 2, 7, "burn", *PLACE, 8, "scratch", 0, 0), ("x", 1, 7, 8, *PLACE, 0, 0), ("x", 0, 0)],
)
def test_a_message_of_another_shape_stops_the_script(message: tuple[object, ...]) -> None:
    body = "wait until filled(found) read found into s, spots, kinds, places, l, b stop s"
    own = FILES.replace('output done  "done.txt" : rows(word, int), real', "")
    end = run(checked(script(body, own)), files=MemoryFiles({"found": message})).end
    assert isinstance(end, Fault)
    assert "but the script expects string, rows(int, word, pose single), ints, rows(bool)" in (
        end.message
    )


@pytest.mark.parametrize(
    ("declarations", "words"),
    [
        ('input f "f" : columns(int)', "there is no type `columns(...)`"),
        ('input f "f" : rows(ints)', "`ints` cannot be a part of an item of a list"),
        ('input f "f" : rows(length)', "`length` cannot be a part of an item of a list"),
        ('input f "f" : signal, rows(int)', "`signal` cannot be combined with other types"),
    ],
)
def test_mistakes_in_declarations(declarations: str, words: str) -> None:
    assert words in "\n".join(diagnosed(script("stop 1", declarations)))


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("mark T with d = each {a = 1}", "`each` makes records of the items of lists"),
        ("mark T with d = each {a = null}", "`each` has no list"),
        ("mark T with d = each {a = x}", "variable `x` is not declared"),
    ],
)
def test_mistakes_in_marks(body: str, words: str) -> None:
    found = diagnosed(script(body, ""))
    assert len(found) == 1 and words in found[0]
