"""What becomes of a "yes" whose premise measured durations contradict."""

from __future__ import annotations

from typing import Any

import pytest

from pn2code.timing.answers import Cycle, Layout
from pn2code.timing.contradicted import weighed
from pn2code.timing.doings import NS
from pn2code.timing.look import Times
from pn2code.verdict.whole import Said
from pn2code.verify.controller.control_types import (
    BLOCKING,
    CHANNELS,
    IN_TIME,
    Check,
    Control,
)
from pn2code.verify.controller.premises import Premises
from pn2code.verify.controller.replies import Replies

PREMISES = Premises(Replies("", "nobody is late"), moves=True)


@pytest.mark.parametrize(
    ("late", "stops", "blocking", "in_time"),
    [
        ((), (), "yes", "yes"),
        (("it is late",), (), "unknown", "unknown"),
        ((), ("it cannot move",), "unknown", "yes"),
    ],
)
def test_a_yes_whose_premise_does_not_hold(
    late: tuple[str, ...], stops: tuple[str, ...], blocking: str, in_time: str
) -> None:
    ends = Check(BLOCKING, "yes", "", assumes=PREMISES.of_check(BLOCKING, "yes"))
    nobody: Any = None
    control = Control(nobody, (ends, Check(CHANNELS, "yes", "")), None)
    cycle = Cycle((), "", (), None, None, (), 1, 2 * NS, late, stops)
    layouts = (
        Layout("a", (), (), Cycle((), "", (), None, None, (), 1, NS), 1, ""),
        Layout("b", (), (), cycle, 1, ""),
    )
    said = weighed(Said(nobody, {}, nobody, (), control, ()), PREMISES, Times(layouts, 5.0))
    assert said.control is not None
    found = {c.name: c for c in said.control.checks}
    assert {n: c.answer for n, c in found.items()} == {
        BLOCKING: blocking,
        CHANNELS: "yes",
        IN_TIME: in_time,
    }
    if blocking == "yes":
        assert "nobody is late" not in found[BLOCKING].assumes
        assert "2.001 s at most" in found[BLOCKING].assumes[0]
    else:
        assert "in layout `b`: " in found[BLOCKING].says and not found[BLOCKING].assumes
