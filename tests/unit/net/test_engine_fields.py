"""Fields in another order than in the colour set: the engine of CPN Tools misses tokens, and `check` warns."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose, flat
from pn2code.semantics.game.token_game import Game

NET = """
net Fields
  standard
  colset R = record a : INT * b : INT * c : INT;
  colset P = product INT * INT;
  colset Z = record z : INT * a : INT;
  var i, j, k : INT;
  page Top
    place A : {colset}
    place K : R
    trans T guard [{guard}]
      in A : {pattern}
      in K : {other}
"""


@pytest.mark.parametrize(
    ("colset", "pattern", "guard", "other", "fields"),
    [
        ("R", "{b = j, a = i, c = k}", "i = 1", "empty", "`a`"),
        ("R", "{b = j, a = i, c = k}", "i = 5, j = 1", "empty", "`b` and `a`"),
        ("R", "2`({b = j, a = i, c = k})", "1 = j", "empty", "`b`"),
        ("R", "{b = j, a = 1, c = k}", "true", "empty", "`a`"),
        ("R", "{b = j, a = i, c = k}", "true", "{a = i, b = 1, c = 1}", "`a`"),
        ("R", "{b = j, a = 1, c = 1}", "true", "{a = j, b = 1, c = 1}", "`b` and `a`"),
        ("P", "{2 = j, 1 = i}", "i = 1", "empty", "`1`"),
        ("Z", "{a = j, z = i}", "i = 1", "empty", "`z`"),
        ("R", "{a = i, b = j, c = k}", "i = 1", "empty", ""),
        ("R", "{b = j, a = i, c = k}", "k = 1", "empty", ""),  # it stands in its place
        ("R", "{b = j, a = i, c = k}", "i > 1", "empty", ""),  # a test gives it no value
        ("R", "{b = j, a = i, c = k}", "true", "empty", ""),
        ("R", "{b = j, a = i, c = k}", "i = 1, j = 2, k = 3", "empty", ""),  # a whole token
        ("P", "(i, j)", "j = 1", "empty", ""),
        ("Z", "{z = i, a = j}", "j = 1", "empty", ""),
    ],
)
def test_who_is_warned(colset: str, pattern: str, guard: str, other: str, fields: str) -> None:
    """As the state spaces of the engine were seen to be: those without a warning are complete."""
    text = NET.format(colset=colset, pattern=pattern, guard=guard, other=other)
    found = [x for x in diagnose(text).items if x.code == "engine-field-order"]
    assert len(found) == bool(fields)
    assert all(f"{fields} may be known before" in x.message for x in found)


def test_here_all_tokens_are_found() -> None:
    text = NET.format(
        colset="R = 1`{a = 1, b = 5, c = 1} ++ 1`{a = 2, b = 1, c = 1} ++ 1`{a = 1, b = 1, c = 2}",
        pattern="{b = j, a = i, c = k}",
        guard="i = 1",
        other="empty",
    )
    assert len(Game(flat(text)).enabled()) == 2
