"""What the parser's loop makes of the parts of a rule."""

from __future__ import annotations

from pn2code.ml.parsing.lalr import _callback
from pn2code.ml.parsing.tables import Rule


class Builder:
    """Gives what it gets."""

    @staticmethod
    def pair(children: list[object]) -> tuple[str, list[object]]:
        return "pair", children


def test_a_repetition_grows_without_being_copied() -> None:
    """A list of a hundred thousand elements is made element by element."""
    make = _callback(Rule("__more", 3, "", False, [0]), Builder())
    assert make is not None
    before: list[object] = [1]
    assert make([before, ",", 2]) is before
    assert before == [1, ",", 2]


def test_parts_of_repetitions_become_parts_of_the_node() -> None:
    make = _callback(Rule("pair", 3, "pair", False, [1]), Builder())
    assert make is not None
    assert make(["(", [1, 2], ")"]) == ("pair", ["(", 1, 2, ")"])


def test_a_single_part_stands_for_its_node_where_the_grammar_says_so() -> None:
    assert _callback(Rule("item", 1, "item", True, []), Builder()) is None
    make = _callback(Rule("pair", 1, "pair", True, [0]), Builder())
    assert make is not None
    assert make([[1]]) == 1
    assert make([[1, 2]]) == ("pair", [1, 2])
