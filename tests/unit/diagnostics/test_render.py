"""Printing diagnostics: excerpts with caret, long lines, invisible characters, notes and hints."""

from __future__ import annotations

import json

from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.diagnostics.render import concise, count, full, report
from pn2code.reading.codes import CPN_ELEMENT

ORIGIN = Origin("net.cpn", 7, 3, "Top", "place `P`", "ID1", "initial marking")


def shown(text: str, start: int, end: int) -> list[str]:
    d = Diagnostics()
    d.error(CPN_ELEMENT, "this is wrong", SourceText(text, ORIGIN).span(start, end), label="here")
    return full(d.items[0]).splitlines()


def test_all_parts() -> None:
    assert shown("1`x ++ 2`y", 7, 10) == [
        "error[cpn-element]: this is wrong",
        "   --> net.cpn:7:10",
        "    |  page `Top`, place `P` (ID1), initial marking",
        "  7 |  1`x ++ 2`y",
        "    |         ^^^ here",
        "    = help: `pn2code explain cpn-element` says more",
    ]


def test_the_line_of_the_place_is_shown() -> None:
    assert shown("one\n\ttwo wrong\nthree", 9, 14)[3:5] == [
        "  8 |      two wrong",
        "    |          ^^^^^ here",
    ]


def test_a_place_over_several_lines_is_underlined_to_the_end_of_its_first() -> None:
    assert shown("if a\nthen b", 3, 11)[3:5] == ["  7 |  if a", "    |     ^ here"]


def test_long_lines_are_cut_around_the_place() -> None:
    text = "a" * 500 + "WRONG" + "b" * 500
    line, caret = shown(text, 500, 505)[3:5]
    assert len(line) < 190
    assert line.startswith("  7 |  ...aaa") and line.endswith("bbb...")
    assert line[caret.index("^") : caret.rindex("^") + 1] == "WRONG"


def test_the_end_of_a_long_line() -> None:
    text = "a" * 500 + "WRONG"
    line, caret = shown(text, 500, 505)[3:5]
    assert line.endswith("aWRONG")
    assert line[caret.index("^") : caret.rindex("^") + 1] == "WRONG"


def test_invisible_characters_take_one_column() -> None:
    assert shown("a\u200bb c", 4, 5)[3:5] == ["  7 |  a\ufffdb c", "    |      ^ here"]


def test_other_forms() -> None:
    d = Diagnostics()
    d.error(CPN_ELEMENT, "this is wrong", ORIGIN, hint="do it right")
    d.warning(CPN_ELEMENT, "this is strange", ORIGIN)
    assert concise(d.items[0]) == "net.cpn:7:3: error: this is wrong [cpn-element]"
    assert json.loads(report(d, "json").splitlines()[0])["hint"] == "do it right"
    assert count(d) == "1 error, 1 warning"


def test_the_place_in_a_very_long_line_is_shown() -> None:
    lines = shown("a" * 100_000 + " BAD " + "b" * 100_000, 100_001, 100_004)
    at = next(i for i, line in enumerate(lines) if "BAD" in line)
    assert lines[at].index("BAD") == lines[at + 1].index("^^^")
    assert "...aaa" in lines[at]
    assert lines[at].endswith("bbb...")
