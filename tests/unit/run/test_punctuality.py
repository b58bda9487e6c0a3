"""Answers are counted from a message to the next one that is taken, by each party for itself."""

from __future__ import annotations

from pn2code.run.punctuality import Punctuality


def test_answers() -> None:
    p = Punctuality({"a1": "robot1", "q1": "robot1", "a2": "robot2", "q2": "robot2"})
    assert p.described() == {"answers": 0, "answer": None, "longest": None, "noticed": 0.0}
    p.answered("a1")  # the first command: nobody has asked
    p.asked("q1")
    p.answered("a2")
    assert p.answers == []
    p.answered("a1")
    p.answered("a1")
    p.asked("unknown")
    p.noticed(0.25)
    p.noticed(0.125)
    found = p.described()
    assert found["answers"] == 1 and found["answer"] == found["longest"] == p.answers[0] >= 0.0
    assert found["noticed"] == 0.25
