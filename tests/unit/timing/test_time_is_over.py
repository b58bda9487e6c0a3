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


def asked(name: str) -> Answer:
    response = Response(Atom("fires", 0), Atom("fires", 1), None, "2")
    about = Property(name, "", "", "response", True, response, (), Origin("cell.cpn"))
    return Answer(about, "inconclusive", "nobody knows", cell=True)


def with_durations(answers: list[Answer]) -> Any:
    nobody: Any = None
    said = Said(nobody, {}, nobody, answers, None, ())
    limits: Any = SimpleNamespace(deadline=NEVER)
    config = SimpleNamespace(supervisor=SimpleNamespace(reply_timeout_s=5.0))
    opened: Any = SimpleNamespace(config=config)
    return verified.with_durations(said, None, opened, limits, nobody, Path(), nobody)


@pytest.mark.parametrize("answered", [0, 1, 2])
def test_answers_that_were_found_before_stay(
    answered: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    open_ = [asked(name) for name in "abc"]
    times = Times((), 5.0)

    def answer(_: Any, a: Answer) -> Answer:
        if a is open_[answered]:
            raise TimeIsOverError
        return replace(a, answer="yes", why="")

    monkeypatch.setattr(verified, "look", lambda *_, **__: times)
    monkeypatch.setattr(verified._Judge, "answer", answer)
    found = with_durations(open_)
    assert found.durations.times is times
    assert [a.answer for a in found.answers] == ["yes"] * answered + ["inconclusive"] * (
        3 - answered
    )
    assert all("nobody knows" not in a.why for a in found.answers)


def test_what_was_not_measured_is_not_known(monkeypatch: pytest.MonkeyPatch) -> None:
    def looks(*_: Any, **__: Any) -> Times:
        raise TimeIsOverError

    monkeypatch.setattr(verified, "look", looks)
    found = with_durations([asked("a")])
    assert [a.answer for a in found.answers] == ["inconclusive"]
    row = found.durations.row()
    assert row["why"] and row["reply_timeout_s"] == 5.0 and not row["layouts"]
