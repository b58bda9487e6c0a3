"""What is said of two that do not surely keep apart: what moves is under way, what rests stands."""

from __future__ import annotations

from pathlib import Path

import pytest

from pn2code.geometry.answers import Layout, Pair
from pn2code.geometry.report import text
from pn2code.geometry.runs import Run


@pytest.mark.parametrize(
    ("transitions", "robots", "steps", "says"),
    [
        (("A", "B"), ("r", "s"), 2, "`A` and `B` may be under way at once"),
        (("A", ""), ("r", "s"), 1, "`A` may be under way while s stands there"),
        (("", "B"), ("r", "s"), 1, "`B` may be under way while r stands there"),
        (("A", ""), ("r", ""), 1, "`A` may be under way while a part stands there"),
        (("", ""), ("r", "s"), 0, "r at rest and s at rest may stand there at once"),
        (("", ""), ("r", ""), 0, "r at rest and a part may stand there at once"),
    ],
)
def test_what_rests_is_not_under_way(
    transitions: tuple[str, str], robots: tuple[str, str], steps: int, says: str
) -> None:
    run = Run(steps, steps, transitions, Path("x.trace.jsonl"))
    pair = Pair(robots, transitions, ("", ""), "no", "they overlap", run=run)
    said = text([Layout("", 3, 3, (), (pair,), 1, 1, 0.0)], full=True)
    assert f"NO: {says}\n" in said
    assert ("it is so at the start: x.trace.jsonl" in said) == (not steps)
    assert ("a run of" in said) == bool(steps)
