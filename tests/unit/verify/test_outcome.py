"""The head of a report, its last line and the exit code come from the same answers, and never contradict each other."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import pytest

from helpers.netbuilder import flat
from pn2code.verify.answers import outcome
from pn2code.verify.answers.outcome import Counts
from pn2code.verify.exploring.explorer_process import nothing
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import COUNTED, Exploration, Known, Seen

NET = flat("net One\n  standard\n  place P = 1\n  trans T\n    in P : ()\n")
ENDS = (
    "complete", "decided", "states", "seconds", "memory", "infinite", "interrupted", "error", "approximation", COUNTED,
)  # fmt: skip
LAST = {"yes": ("YES", "COMPLETE"), "no": ("NO",), "inconclusive": ("NOT KNOWN", "NOT COMPLETE")}


def explored(why: str, *, markings: bool = False) -> Exploration:
    found = Exploration.of(NET, nothing(NET, Limits(), why), 0.0)
    error = {"message": "Div", "where": "T", "transition": 0} if why == "error" else None
    seen = Seen(markings=markings or why == "complete")
    known = Known(5, 6, 0.0, ends=True, never=()) if why == COUNTED else None
    return replace(found, complete=why == "complete", error=error, seen=seen, known=known)


@pytest.mark.parametrize("why", ENDS)
@pytest.mark.parametrize("errors", [0, 1])
def test_head_and_end_agree(why: str, errors: int) -> None:
    for good, bad, open_, asked, markings in product(
        (0, 1, 3), (0, 1, 2), (0, 1, 2), (0, 1), (0, 1)
    ):
        if asked and not good + bad + open_:
            continue
        found = explored(why, markings=bool(markings) and why == "seconds")
        counts = Counts(good, bad, open_, errors, asked=bool(asked))
        head = outcome.header(NET, found, counts)
        end = outcome.closing(NET, found, counts)
        word = outcome.verdict(found, counts)
        case = (good, bad, open_, asked, markings, head, end)
        assert end.removeprefix("Verdict: ").split(".")[0] in LAST[word], case
        assert bool(head) == (why != "complete"), case
        if "all properties were decided" in head + end:
            assert not open_, case
        if word == "yes":
            assert not bad and not open_ and not errors, case
            assert asked or why == "complete" or (why == COUNTED and counts.all), case
        if end.startswith("Verdict: COMPLETE"):
            assert why == "complete" and not counts.all, case
        if bad and why != "error":
            assert f"{bad} of {good + bad + open_} answers" in end, case
        elif open_ and word == "inconclusive":
            assert f"{open_} of {good + bad + open_} answers" in end, case
