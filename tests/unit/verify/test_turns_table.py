"""The table of turns: who comes with whom, and which nets have none."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.verify.exploring.elements import NotPossibleError
from pn2code.verify.exploring.turns import Turns, turns

NET = """
net pair
  standard
  page Top
    place Ready = 1
    place Sent
    place Box
    place Idle = 1
    place Got
    trans Send
      in Ready : ()
      out Sent : ()
      out Box : ()
    trans Take
      in Idle : ()
      in Box : ()
      out Got : ()
    trans Sleep priority 2000
      in Idle : ()
      out Got : ()
"""
OWNERS = (0, 1, 1)
SEND, TAKE, SLEEP = range(3)


def table(**options: list[int] | list[list[int]]) -> Turns:
    """Of the net above."""
    return turns(flat(NET), OWNERS, **options)  # type: ignore[arg-type]


def test_what_changes_a_place_comes_with_what_changes_it() -> None:
    made = table()
    assert made.members[SEND].rivals == (TAKE,)
    assert made.members[TAKE].rivals == (SEND,)
    assert made.members[SLEEP].rivals == ()


def test_what_is_enabled_may_hold_others_back() -> None:
    assert table().members[SEND].enables == (TAKE,)  # Sleep is less urgent
    net = flat(NET.replace(" priority 2000", ""))
    assert turns(net, OWNERS).members[SEND].enables == ()
    assert turns(net, OWNERS, chosen=[TAKE, SLEEP]).members[SEND].enables == (TAKE,)
    assert turns(net, OWNERS, firsts=[TAKE, SLEEP]).members[SEND].enables == (TAKE,)


def test_a_probe_changes_nothing() -> None:
    made = table(probes=[SLEEP])
    assert made.members[TAKE].taken == ((2, 1), (3, 1))
    assert made.members[SLEEP].taken == ()


def test_a_group_is_changed_in_one_order() -> None:
    names = [p.short for p in flat(NET).places]
    group = [names.index("Sent"), names.index("Got")]
    assert table(groups=[group]).members[SLEEP].rivals == (SEND,)


def test_reasons_are_places_that_lack_tokens() -> None:
    reasons = {r.place: r.helpers for r in table().members[TAKE].reasons}
    names = [p.short for p in flat(NET).places]
    assert reasons[names.index("Box")] == (SEND,)
    assert reasons[names.index("Idle")] == ()


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("place Sent", "place Sent : UNIT timed", "timed"),
        ("trans Send", "trans Send guard [discrete (0, 1) = 1]", "random"),
        ("trans Send", "trans Send code action counter := 1", "reference"),
    ],
)
def test_what_others_see_is_refused(old: str, new: str, why: str) -> None:
    text = NET.replace(old, new, 1)
    if "counter" in new:
        text = text.replace("  page Top", "  globref counter = 0;\n  page Top")
    if "timed" in new:
        text = text.replace("  page Top", "  colset T = unit timed;\n  page Top").replace(
            "UNIT timed", "T"
        )
    with pytest.raises(NotPossibleError, match=why):
        turns(flat(text), OWNERS)


def test_a_table_has_an_end() -> None:
    assert table().text().endswith("\nend\n")
