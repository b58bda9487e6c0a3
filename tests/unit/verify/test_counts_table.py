"""Places whose tokens are counted up to a limit only: which these are, and what is left of the table of turns."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.structure.relations import relations
from pn2code.verify.exploring.counted import counted
from pn2code.verify.exploring.counts import Counts, Limit, counts
from pn2code.verify.exploring.turns import turns

NET = """
net trays
  standard
  colset KIND = int with 1..2;
  var n: INT;
  var k: KIND;
  page Top
    place Feeder = 5
    place Left : INT = 1`5
    place Free = 1
    place Busy : KIND
    place Tray : KIND
    place Good
    place Done
    trans Feed
      in Feeder : ()
      in Free : ()
      out Busy : k
    trans Put
      in Busy : k
      out Free : ()
      out Tray : k
    trans Pack
      in Tray : k
      in Left : n
      out Left : n - 1
      out Good : ()
    trans End
      in Left : 0
      out Done : ()
"""
FEEDER, LEFT, FREE, BUSY, TRAY, GOOD, DONE = range(7)
BOUNDS = {FEEDER: 5, LEFT: 1, FREE: 1, BUSY: 1, TRAY: 5, GOOD: 5, DONE: 1}


def made(text: str = NET, *, free: tuple[int, ...] = tuple(range(7))) -> Counts | None:
    """Of the net above, or of a version of it."""
    net = flat(text)
    return counts(net, relations(net), BOUNDS, free=free)


def test_parts_are_none_or_some_and_what_nobody_takes_is_forgotten() -> None:
    found = made()
    assert found is not None
    assert found.limits == (
        Limit(FEEDER, 1, is_value=False),
        Limit(LEFT, 1, is_value=True),
        Limit(TRAY, 1, is_value=False),
        Limit(GOOD, 0, is_value=False),
    )
    assert found.limited == {FEEDER, TRAY, GOOD}
    assert any(r.values for r in found.relations)


def test_a_limit_is_as_great_as_what_is_demanded() -> None:
    found = made(NET.replace("in Feeder : ()", "in Feeder : 2`()"))
    assert found is not None
    assert found.limits[0] == Limit(FEEDER, 2, is_value=False)
    found = made(NET.replace("in Left : 0", "in Left : 2"))
    assert found is not None
    assert Limit(LEFT, 3, is_value=True) in found.limits


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        (
            "    trans Feed\n",
            "    trans Feed guard [n > 2]\n      both Left : n\n",
            LEFT,
        ),  # compared
        ("in Left : 0", "in Left : n", LEFT),  # taken, whatever it is
        ("out Left : n - 1", "out Left : n div 2", LEFT),  # no relation tells how great it is
        ("    trans Feed\n", "    trans Feed\n      reset Tray\n", TRAY),  # what there is, is seen
        ("in Tray : k", "in Tray : (if k = 1 then 1`k else 2`k)", TRAY),  # how many, depends
    ],
)
def test_what_is_seen_in_another_way_is_counted(old: str, new: str, place: int) -> None:
    text = NET.replace(old, new)
    assert text != NET
    found = made(text)
    assert found is None or place not in {x.place for x in found.limits}


def test_what_is_asked_about_is_counted() -> None:
    found = made(free=(FEEDER, FREE))
    assert found is not None
    assert [x.place for x in found.limits] == [FEEDER]
    assert made(free=(FREE, BUSY)) is None


def test_turns_do_not_compare_what_is_left() -> None:
    net = flat(NET)
    table, found = turns(net, (0, 0, 1, 1)), made()
    assert found is not None
    assert (FEEDER, 1) in table.members[0].taken
    left = found.within(table).members[0].taken
    assert (FEEDER, 1) not in left
    assert (FREE, 1) in left


def test_counters_have_room_for_the_limit_and_what_a_firing_puts() -> None:
    net = flat(NET.replace("in Tray : k", "in Tray : 3`k").replace("Feeder = 5", "Feeder = 9"))
    found = counted(net, {}, turns(net, range(len(net.transitions))), range(len(net.places)))
    assert found is not None
    assert Limit(TRAY, 3, is_value=False) in found.counts.limits
    assert found.sizes.packing.of(net.places[TRAY].name) >= 3  # 3 tokens, and those that are put
