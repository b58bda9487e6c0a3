"""What an answer about a cell rests on that no state of it shows."""

from __future__ import annotations

from pn2code.properties import meaning as m
from pn2code.verify.controller.premises import Premises
from pn2code.verify.controller.replies import Replies

CELL = Premises(Replies("", "in time"), ("measured",), durations=True, sensors=True)
TRUE = m.Atom("true")


def test_a_check_rests_on_what_it_says() -> None:
    assert CELL.of_check("channels", "yes") == ("measured",)
    assert CELL.of_check("ownership", "yes") == CELL.of_check("channels", "no") == ()
    measured, in_time, sensors = CELL.of_check("non-blocking", "yes")
    assert (measured, in_time) == ("measured", "in time") and "sensor" in sensors


def test_what_can_happen_does_so_for_some_durations() -> None:
    always, possibly = m.Invariant(TRUE), m.Invariant(TRUE, wanted=False)
    assert CELL.of_property(always, "yes", kept=True) == ("measured",)
    assert CELL.of_property(always, "yes", kept=False) == ("measured", "in time")
    assert "some durations" in CELL.of_property(possibly, "yes", kept=False)[-1]
    assert CELL.of_property(possibly, "no", kept=False) == ()
