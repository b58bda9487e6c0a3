"""Weights that show that transitions occur only so often, and how often at most."""

from __future__ import annotations

from helpers.netbuilder import flat
from pn2code.verify.exploring.ranking import Ranking

NET = """
net ranked
  standard
  page Top
    place Parts = 5
    place Idle = 1
    place Busy
    place Seen
    place Box
    trans Take
      in Parts : ()
      in Idle : ()
      out Busy : ()
      out Box : ()
    trans Back
      in Busy : ()
      out Idle : ()
    trans See
      both Box : ()
      inhibit Seen
      out Seen : ()
    trans Empty
      in Box : ()
      in Seen : ()
"""
PARTS, IDLE, BUSY, SEEN, BOX = range(5)
BOUNDS = {PARTS: 5, IDLE: 1, BUSY: 1, SEEN: 1, BOX: 5}
TAKE, BACK, SEE, EMPTY = range(4)


def ranking(text: str = NET, bounds: dict[int, int] = BOUNDS) -> Ranking:
    """Of the net above, or of a version of it."""
    return Ranking.of(flat(text), {}, bounds)


def test_what_uses_something_up_occurs_only_so_often() -> None:
    assert ranking().rising() == frozenset()


def test_without_a_bound_a_weight_is_not_negative() -> None:
    # See would need that what has been seen counts less than what has not.
    bounds = {p: n for p, n in BOUNDS.items() if p != SEEN}
    assert ranking(bounds=bounds).rising() == {SEE}


def test_what_goes_round_is_left_over() -> None:
    text = NET.replace("      in Parts : ()\n", "      both Parts : ()\n")
    text = text.replace("      out Box : ()\n", "")
    left = ranking(text).rising()
    assert {TAKE, BACK} <= left


def test_what_is_never_enabled_does_not_count() -> None:
    text = f"{NET}    trans Round\n      both Idle : ()\n"
    assert ranking(text).rising() == {4}
    assert Ranking.of(flat(text), {}, BOUNDS, never=[4]).rising() == frozenset()


def test_the_longest_run_is_no_shorter_than_the_longest_that_there_is() -> None:
    made = ranking()
    assert made.longest({TAKE, BACK}, {TAKE}) == 5
    assert made.longest({TAKE, BACK}, {TAKE, BACK}) == 11  # it may begin while it is busy
    assert made.longest({BACK}, {BACK}) == 1
    assert made.longest({TAKE, BACK}, {SEE}) == 0


def test_the_length_of_what_goes_round_is_not_known() -> None:
    text = NET.replace("      in Parts : ()\n", "      both Parts : ()\n")
    text = text.replace("      out Box : ()\n", "")
    assert ranking(text).longest({TAKE, BACK}, {TAKE}) is None
    bounds = {IDLE: 1, BUSY: 1}
    assert ranking(bounds=bounds).longest({TAKE, BACK}, {TAKE}) is None  # any number of parts
