"""What stays known where the time is over while properties in seconds are answered."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from pn2code.base.deadline import NEVER, TimeIsOverError
from pn2code.diagnostics import Origin
from pn2code.properties.meaning import Atom, Property, Response
from pn2code.timing import verified
from pn2code.timing.look import Times
from pn2code.verdict.whole import Said
from pn2code.verify.answers.properties import Answer


@pytest.mark.parametrize("answered", [0, 1, 2])
def test_answers_that_were_found_before_stay(
    answered: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = Response(Atom("fires", 0), Atom("fires", 1), None, "2")
    open_ = [
        Answer(
            Property(name, "", "", "response", True, asked, (), Origin("cell.cpn")),
            "inconclusive",
            "nobody knows",
            cell=True,
        )
        for name in "abc"
    ]
    times = Times((), 5.0)

    def answer(_: Any, a: Answer) -> Answer:
        if a is open_[answered]:
            raise TimeIsOverError
        return replace(a, answer="yes", why="")

    monkeypatch.setattr(verified, "look", lambda *_, **__: times)
    monkeypatch.setattr(verified._Judge, "answer", answer)
    nobody: Any = None
    said = Said(nobody, {}, nobody, open_, None, ())
    limits: Any = SimpleNamespace(deadline=NEVER)
    found = verified.with_durations(said, None, nobody, limits, nobody, Path(), nobody)
    assert found is not None
    durations: Any = found.durations
    assert durations.times is times
    assert [a.answer for a in found.answers] == ["yes"] * answered + ["inconclusive"] * (
        3 - answered
    )
    assert all("nobody knows" not in a.why for a in found.answers)
