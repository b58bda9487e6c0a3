"""The critical path of made-up runs, waits and gains, next to all chains of causes written out."""

from __future__ import annotations

from random import Random

import pytest

from helpers.thorough import amount
from pn2code.timing.causes import Occurrence, Story
from pn2code.timing.critical import Study, Wait
from pn2code.timing.run_look import RunTimes, Side
from pn2code.timing.run_report import text


def story(rows: list[tuple[int, float, tuple[int, ...]]]) -> Story:
    """Of (owner, seconds, causes): each occurrence is a transition of its own."""
    out: list[Occurrence] = []
    for i, (owner, seconds, causes) in enumerate(rows):
        since = max((out[c].time for c in causes), default=0.0)
        out.append(Occurrence(i, owner, since + seconds, causes, since))
    return Story(tuple(out), "finished", max(o.time for o in out))


def chains(rows: list[tuple[int, float, tuple[int, ...]]], i: int) -> list[float]:
    """The length of each chain of causes that ends in an occurrence."""
    _, seconds, causes = rows[i]
    return [seconds + x for c in causes for x in chains(rows, c)] or [seconds]


@pytest.mark.parametrize("seed", range(amount(15, 40)))
def test_a_run_is_as_long_as_its_longest_chain(seed: int) -> None:
    r = Random(seed)
    rows = [
        (r.randrange(3), r.choice([0.0, 1.0, 2.5]), tuple(sorted(r.sample(range(i), min(i, r.randint(0, 2))))))
        for i in range(10)
    ]  # fmt: skip
    made = story(rows)
    study = Study(made, {0, 1, 2})

    def length(quick: set[int]) -> float:
        left = [(o, 0.0 if i in quick else s, c) for i, (o, s, c) in enumerate(rows)]
        return max(x for i in range(len(rows)) for x in chains(left, i))

    assert study.seconds == pytest.approx(length(set()))
    assert sum(made.occurrences[i].seconds for i in study.path) == pytest.approx(study.seconds)
    for i in range(len(rows)):
        assert study.gain({i}) == pytest.approx(length(set()) - length({i}))
    assert study.shortened({0: 100.0}) >= 100.0


def test_who_is_waited_for_is_who_worked_meanwhile() -> None:
    # Owner 1 works 2 s; for it owner 2 (5 s) and then owner 3 (1 s) work; then owner 1 goes on, for 1 s.
    rows: list[tuple[int, float, tuple[int, ...]]] = [
        (1, 2.0, ()), (0, 0.0, (0,)), (2, 5.0, (1,)), (3, 1.0, (2,)), (0, 0.0, (3,)), (1, 1.0, (0, 4)),
    ]  # fmt: skip
    study = Study(story(rows), {0, 1})
    assert study.waits(1) == [Wait(1, 2, 5.0), Wait(1, 3, 1.0)]
    assert study.waits(2) == [Wait(2, 0, 2.0)]
    assert study.busy(1) == 3.0 and study.seconds == 9.0
    assert study.path == (0, 1, 2, 3, 4, 5)


def test_only_the_supervisor_and_arms_end_a_run() -> None:
    rows: list[tuple[int, float, tuple[int, ...]]] = [(0, 1.0, ()), (2, 9.0, (0,))]
    study = Study(story(rows), {0, 1})
    assert study.seconds == 1.0 and study.path == (0,)
    assert study.gain({1}) == 0.0
    # A run that is stopped later: without what the device does, which nobody waits for, it would be no longer.
    assert study.busy(2) == 9.0 and study.needed(2) == 0.0 and study.last == 10.0


def test_a_report_of_a_run_in_which_a_device_goes_on() -> None:
    sides = (Side("arm", 1.0, 1.0, 0.1, ()), Side("oven", 9.0, 0.0, 0.9, ()))
    lines = text(RunTimes("run", "stopped", 1.0, 12.0, (), (), sides), full=True).splitlines()
    assert lines[0] == "run: 12.000 s, stopped"
    assert lines[1].startswith("The supervisor and the arms have done their last transition at 1.0")
    assert "No overlapping makes it shorter than 1.000 s: so long `arm` is at work." in lines
