"""What is claimed of random cells: which moment of a run contradicts it."""

from __future__ import annotations

import pytest
from tools.adversary import claims
from tools.adversary.claims import Claim, Moment

A, B = "Top.Supervisor.A", "Top.Supervisor.B"


def run(*rows: str) -> list[Moment]:
    """Moments: of each the tokens in A and in B, and what has occurred."""
    parts = [row.split() for row in rows]
    return [Moment({A: int(a), B: int(b)}, " ".join(t)) for a, b, *t in parts]


@pytest.mark.parametrize(
    ("claim", "moments", "over", "open_"),
    [
        (claims.at_most(A, 1), run("0 0", "1 0", "2 0"), 2, 2),
        (claims.at_most(A, 2), run("0 0", "1 0", "2 0"), None, None),
        (claims.never_both(A, B), run("1 0", "1 1"), 1, 1),
        (claims.reached(A, B), run("1 0", "1 1"), 1, 1),
        (claims.followed(A, B), run("1 0", "0 1", "1 0"), 2, None),
        (claims.followed(A, B), run("1 0", "0 1", "0 0"), None, None),
        (claims.followed_within(A, B, 1), run("1 0", "1 0", "0 1"), 0, 0),
        (claims.followed_within(A, B, 2), run("1 0", "1 0", "0 1"), None, None),
        (claims.followed_within(A, B, 9), run("1 0", "1 0"), 0, None),
        (claims.silent("T"), run("0 0", "0 0 S", "0 0 T"), 2, 2),
        (claims.not_before("T", "S"), run("0 0", "0 0 T", "0 0 S"), 1, 1),
        (claims.not_before("T", "S"), run("0 0", "0 0 S", "0 0 T"), None, None),
        (claims.ends_with(A), run("1 0", "0 1"), 1, None),
        (claims.ends_with(B), run("1 0", "0 1"), None, None),
    ],
)
def test_the_moment_that_contradicts(
    claim: Claim, moments: list[Moment], over: int | None, open_: int | None
) -> None:
    """With the whole run, and with one that goes on."""
    assert claim.broken(moments, is_over=True) == over
    assert claim.broken(moments, is_over=False) == open_


def test_a_place_of_a_fusion_set_is_named_by_its_page() -> None:
    assert claims.at_most("Fusion.Alarm", 1).text == "bound Sup'Alarm <= 1"
