"""Initial markings that count in a reference: the engine of CPN Tools begins with other tokens than pn2code."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose

NET = """
net Counting
  standard
  globref counter = 0;
  fun tick () = (inc counter; !counter);
  fun both () = (tick (), tick ());
  fun sum n = let val total = ref 0 in List.app (fn x => total := !total + x) [1, n]; !total end;
  val table = Array.array (3, 0);
  fun note i = (Array.update (table, i, 1); i);
  val first = tick ();
  page A
    place P {place} = {marking}
"""


@pytest.mark.parametrize(
    ("marking", "reference"),
    [
        ("1`(tick ())", "counter"),
        ("tick ()", "counter"),
        ("1`(#1 (both ()))", "counter"),
        ("1`(note 2)", "table"),
    ],
)
def test_a_marking_that_changes_a_reference(marking: str, reference: str) -> None:
    [warning] = diagnose(NET.format(place=": INT", marking=marking)).items
    assert warning.code == "initial-marking-effect"
    assert f"may change the reference `{reference}`" in warning.message


@pytest.mark.parametrize(
    "marking", ["1`(sum 3)", "1`first", "1`(!counter)", "1`(Array.sub (table, 1))"]
)
def test_other_markings(marking: str) -> None:
    """References of their own, values that were computed before, references that are only read."""
    assert not diagnose(NET.format(place="fusion F : INT", marking=marking)).items
