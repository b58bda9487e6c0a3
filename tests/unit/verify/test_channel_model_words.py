"""What is said of a medium that is not as it should be: the parts that fail, and no others."""

from __future__ import annotations

import pytest

from pn2code.channel_model.check import Answer, Evidence, _and_alike
from pn2code.channel_model.faults import Fault
from pn2code.verdict.channel_model import rows, shown, told

ASKED = "no message is lost or torn, and the cell can come to its end"


def answer(why: str, *evidence: Evidence) -> Answer:
    return Answer(
        "the cell with its medium", ASKED, "no", why, 5, 4, 3, 2, 0.1, "no side crashes", evidence
    )


@pytest.mark.parametrize(
    ("given", "says"),
    [
        (answer("`non-blocking`: a script stops"), "`non-blocking`: a script stops"),
        (
            answer("", Evidence(Fault.TORN, 3, ("a",))),
            "half a message is taken",
        ),
    ],
)
def test_what_fails_is_named(given: Answer, says: str) -> None:
    assert shown(given) == says
    assert f"the cell with its medium: no ({says})" in told((given,))
    (row,) = rows((given,))
    assert f"what fails: {says}" in row["remarks"]
    assert not any("not known" in str(r) for r in row["remarks"])


@pytest.mark.parametrize(
    ("names", "told"),
    [
        ([], ""),
        (["belt"], " (and with belt, whose messages are of the same kinds)"),
        (["belt", "eye"], " (and with belt and eye, whose messages are of the same kinds)"),
        (
            [f"r{i}" for i in range(8)],
            " (and with r0, r1, r2, r3, r4, r5 and 2 more, whose messages are of the same kinds)",
        ),
    ],
)
def test_an_exchange_names_those_for_which_it_stands(names: list[str], told: str) -> None:
    assert _and_alike(names) == told
