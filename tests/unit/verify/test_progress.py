"""Weights of places by which no occurrence makes a marking smaller."""

from __future__ import annotations

from helpers.netbuilder import flat
from pn2code.verify.exploring.grown_values import Amount, changes
from pn2code.verify.exploring.progress import Change, Progress, rising_by

NET = """
net measured
  standard
  var n: INT;
  page Top
    place Parts = 5
    place Idle = 1
    place Busy
    place Box
    place Some : INT
    place Many : INT
    trans Take
      in Parts : ()
      in Idle : ()
      out Busy : ()
    trans Back
      in Busy : ()
      out Idle : ()
      out Box : ()
    trans Round
      both Idle : ()
      both Box : ()
    trans Turn
      in Some : n
      out Many : n`n
"""
PARTS, IDLE, BUSY, BOX, SOME, MANY = range(6)
TAKE, BACK, ROUND, TURN = range(4)


def measured(text: str = NET, *, timed: bool = False) -> Progress | None:
    """The measure of a net."""
    return Progress.of(flat(text), {}, timed=timed)


def added(found: Progress, *deltas: dict[int, int]) -> list[int]:
    """What each occurrence adds to the sum."""
    return [sum(found.weights.get(Amount(p), 0) * n for p, n in delta.items()) for delta in deltas]


def test_what_goes_on_makes_the_sum_greater_and_what_goes_round_does_not() -> None:
    found = measured()
    assert found is not None
    assert found.rising == {TAKE, BACK, TURN}
    take, back = added(found, {PARTS: -1, IDLE: -1, BUSY: 1}, {BUSY: -1, IDLE: 1, BOX: 1})
    assert take > 0
    assert back > 0


def test_a_number_of_tokens_that_a_binding_decides_does_not_count() -> None:
    found = measured()
    assert found is not None
    assert Amount(MANY) not in found.weights
    assert found.weights[Amount(SOME)] < 0  # it only loses tokens


def test_where_all_goes_round_there_is_no_measure() -> None:
    text = "net round\n  standard\n  place A = 1\n  place B\n"
    for name, a, b in (("Go", "A", "B"), ("Come", "B", "A")):
        text += f"  trans {name}\n    in {a} : ()\n    out {b} : ()\n"
    assert measured(text) is None
    assert measured(text, timed=True) is None


def test_time_goes_on_where_markings_have_it() -> None:
    text = "net clock\n  colset T = int timed;\n  var n: T;\n  place A : T = 1`0\n"
    text += "  trans Tick\n    in A : n\n    out A : n@+3\n"
    found = measured(text, timed=True)
    assert found is not None
    assert found.text() == "time\n"
    assert found.names(flat(text)) == "the time"
    assert measured(text) is None  # it is left out of markings


def test_the_table_and_the_sum_for_people_have_the_places_in_their_order() -> None:
    found = Progress(
        {Amount(PARTS): -2, Amount(BOX): 1, Amount(SOME, ""): 3, Amount(MANY, "k"): -1},
        frozenset({BACK}),
        by_time=True,
    )
    assert found.text() == f"{PARTS} -2\n{BOX} 1\n{SOME} 3 =\n{MANY} -1 k\ntime\n"
    said = "- 2 * Top.Parts + Top.Box + 3 * value of Top.Some - k of Top.Many + the time"
    assert found.names(flat(NET)) == said


def test_weights_that_make_a_sum_smaller_once_are_no_measure() -> None:
    box = Amount(BOX)
    up, down = (Change(t, {box: n}) for t, n in ((0, 1), (1, -1)))
    assert rising_by({box: 1}, [up]) == {0}
    assert rising_by({box: 1}, [up, down]) == frozenset()
    # A transition that makes it greater in one of its ways only is not counted.
    assert rising_by({box: 1}, [up, Change(0, {})]) == frozenset()


TALLY = """
net tally
  standard
  colset TALLY = record good: INT * bad: INT;
  colset PAIR = product INT * INT;
  var t: TALLY;
  var n, k: INT;
  page Top
    place Tally : TALLY = 1`{good = 0, bad = 0}
    place Left : INT = 1`3
    place Pair : PAIR = 1`(0, 0)
    place Odd : INT = 1`0
    trans Good
      in Tally : t
      in Left : n
      out Tally : {good = #good t + 1, bad = #bad t}
      out Left : n - 1
    trans Bad
      in Tally : {good = n, bad = k}
      out Tally : {good = n, bad = 2 + k}
    trans Swap
      in Pair : (n, k)
      out Pair : (n + 1 - 3, n)
    trans Reset
      in Left : 0
      out Left : 7
      both Tally : t
    trans End
      in Left : 9
    trans Double
      in Odd : n
      out Odd : n + n
"""


def test_numbers_in_tokens_that_change_by_constants_count() -> None:
    good, bad, swap, reset, end, _ = range(6)
    tally, left, pair = range(3)
    assert changes(flat(TALLY)) == {
        Amount(tally, "good"): {good: 1},
        Amount(tally, "bad"): {bad: 2},
        Amount(left, ""): {good: -1, reset: 7, end: -9},
        Amount(pair, "1"): {swap: -2},
    }


def test_a_counter_of_parts_makes_a_measure() -> None:
    found = measured(TALLY)
    assert found is not None
    assert found.rising >= {0, 1, 2}
