"""What is near to what: noted when it begins, changes and ends, so that a page shows what is so at each moment."""

from __future__ import annotations

import random
from types import SimpleNamespace
from typing import Any

from pn2code.robot.backend import Clearance
from pn2code.run.record import APART, NEAR, SAME, RunRecord


def gap(distance: float, b: str = "table", x: float = 0.0) -> Clearance:
    return Clearance("scene", "arm", "arm/link_6", b, distance, None, (x, 0.0, 0.0))


def verdict(t: float, *gaps: Clearance) -> Any:
    return SimpleNamespace(t=t, samples=(), clearances=gaps, warnings=())


def shown(record: RunRecord, t: float) -> dict[str, float]:
    """What a reader of the notes says of a moment."""
    last = {g.b: g.distance for at, g in record.gaps if at <= t}
    return {b: distance for b, distance in last.items() if distance <= NEAR}


def test_at_each_sample_the_notes_say_what_was_measured() -> None:
    """Also of what comes and goes from one sample to the next, and of what has become the nearest."""
    chance = random.Random(1)
    record = RunRecord("cell", "", "bullet")
    measured = []
    distance = 0.2
    for k in range(500):
        distance = max(distance + chance.uniform(-0.02, 0.02), -0.01)
        b = chance.choice(("table", "table", "rack"))
        measured.append((k * 0.02, b, distance))
        record.sample(verdict(k * 0.02, gap(distance, b)))
    for t, b, d in measured:
        found = shown(record, t)
        assert set(found) == ({b} if d <= NEAR else set())
        assert all(abs(x - d) <= SAME for x in found.values())


def test_what_stays_is_noted_once() -> None:
    record = RunRecord("cell", "", "bullet")
    for k in range(100):
        record.sample(verdict(k * 0.02, gap(0.05 + 1e-6 * (k % 2))))
    assert len(record.gaps) == 1
    record.sample(verdict(2.0, gap(0.05, x=0.1)))
    assert len(record.gaps) == 2, "its ends have moved"


def test_what_goes_is_noted() -> None:
    record = RunRecord("cell", "", "bullet")
    record.sample(verdict(0.0, gap(0.05)))
    record.sample(verdict(0.02))
    assert [(t, g.distance) for t, g in record.gaps] == [(0.0, 0.05), (0.02, APART)]
