"""What stands in sentences about why something is not known."""

from __future__ import annotations

from pathlib import Path

import pytest

from pn2code.verify.answers.reasons import _NO_EXCEPTIONS, raised, raised_there, raises


@pytest.mark.parametrize(
    ("message", "said"), [("Div", "`Div`"), ("`hd` of an empty list", "`hd` of an empty list")]
)
def test_there_are_no_back_ticks_within_back_ticks(message: str, said: str) -> None:
    assert raised(message) == said


@pytest.mark.parametrize(
    ("message", "said"),
    [
        ("Div", "raises `Div`"),
        ("`hd` of an empty list", "raises `hd` of an empty list"),
        ("colour outside its colour set", "gives a value that is not in its colour set"),
        (
            "illegal colour (~3): it is not in the colour set `SMALL`",
            "gives the illegal colour (~3), which is not in the colour set `SMALL`",
        ),
    ],
)
def test_what_is_no_exception_is_not_said_to_be_raised(message: str, said: str) -> None:
    assert raises(message) == said


def test_the_words_are_those_of_the_compiled_net(root: Path) -> None:
    names = (root / "cnative/src/value/pn_num.c").read_text(encoding="utf-8")
    assert all(f'return "{message}";' in names for message in _NO_EXCEPTIONS)


@pytest.mark.parametrize(
    ("message", "by", "said"),
    [
        ("Div", "", "`Div` is raised there"),
        ("Div", "`10 div k`", "`Div` is raised there by `10 div k`"),
        ("colour outside its colour set", "", "it gives a value that is not in its colour set"),
        (
            "illegal colour 7: it is not in the colour set `SMALL`",
            "`f n`",
            "`f n` gives the illegal colour 7, which is not in the colour set `SMALL`",
        ),
        ("recursion too deep", "`f n`", "`f n` calls functions too deep within each other"),
    ],
)
def test_what_happens_in_a_transition_that_has_been_named(message: str, by: str, said: str) -> None:
    assert raised_there(message, by) == said
