"""Evidence for what is not reachable, as plain data: names, numbers, and what it is about."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

from pn2code.base.deadline import Deadline
from pn2code.contest.asking import Asking
from pn2code.contest.conditions import AtMost
from pn2code.contest.evidence import evidence, rests_on
from pn2code.contest.examinations import Asked, Part
from pn2code.contest.formulas import AtMost as Most
from pn2code.contest.formulas import Constant, Fireable, Op, Tokens
from pn2code.contest.lines import Result
from pn2code.contest.tables import Tables
from pn2code.verify.answers.certificates import lines

RING = Tables(
    (1, 0, 0),
    ({0: 1}, {1: 1}, {2: 1}),
    ({1: 1}, {2: 1}, {0: 1}),
    {"a": (0,), "b": (1, 2)},
    {"t": (0, 1), "u": (2,)},
)


def is_certificate(row: dict[str, Any]) -> bool:
    """By hand, in the ring: its only token goes from `a` to `b[0]` to `b[1]` and back."""
    for case in row["cases"]:
        w = [case["weights"].get(p, 0) for p in ("a", "b[0]", "b[1]")]
        if not (w[0] <= w[1] <= w[2] <= w[0] and w[0] == case["at_first"] > case["at_most"]):
            return False
    return bool(row["cases"])


def asking() -> Asking:
    return Asking(
        Path("engine"),
        "UpperBounds",
        Path("folder"),
        Deadline.after(60.0),
        mebibytes=64,
        only="",
        say=lambda _: None,
    )


def sought(asked: Asked, value: bool | int) -> Any:
    one = asking()
    one.note(asked, Result(asked.name, value, "STATE_EQUATION"), RING)
    return [what for _, what, _ in one.shown]


def test_what_an_answer_says_is_not_reachable() -> None:
    bound = Asked("b", (Part("bound", "bound sum 2 1 1 2 1 0"),))
    assert sought(bound, 1) == [AtMost(((1, -1), (2, -1)), -2)]
    dead = Asked("d", (Part("reach", "reach dead"),))
    assert sought(dead, False) == ["reach dead"] and sought(dead, True) == []
    safe = Asked("s", (Part("reach", "reach true"),), is_turned=True)
    assert sought(safe, True) == ["reach true"] and sought(safe, False) == []
    many = Most(Tokens(("b",)), Constant(1))
    always = Asked("a", formula=Op("A", (Op("G", (many,)),)), kind="ctl")
    (text,) = sought(always, True)
    assert text.startswith("reach not sum 2") and sought(always, False) == []
    never = Asked("n", formula=Op("E", (Op("F", (Fireable(("u",)),)),)), kind="ctl")
    assert sought(never, False) == ["reach enabled 1 2"] and sought(never, True) == []
    other = Asked("o", formula=Op("A", (Op("F", (many,)),)), kind="ctl")
    assert sought(other, True) == sought(other, False) == []
    several = Asked("m", (Part("reach", "reach dead"),), decides=False)
    assert sought(several, False) == []


def test_rows_of_evidence() -> None:
    one = asking()
    one.note(Asked("b", (Part("bound", "bound sum 2 1 1 2 1 0"),)), Result("b", 1, "X"), RING)
    one.note(Asked("d", (Part("reach", "reach dead"),)), Result("d", False, "X"), RING)
    wrong = Asked("w", (Part("reach", "reach sum 1 0 1 0"),))  # `a` can be empty
    one.note(wrong, Result("w", False, "DECISION_DIAGRAMS"), RING)
    bound, dead, nothing = one.evidence()
    assert bound["name"] == "b" and bound["rests_on"] is None
    assert is_certificate(bound["certificate"]) and is_certificate(dead["certificate"])
    assert nothing["certificate"] is None and "set of all markings" in nothing["rests_on"]


def test_words() -> None:
    found = evidence("reach sum 2 0 -1 1 -1 -2", RING, "pqr".__getitem__, time.monotonic() + 60.0)
    assert found is not None
    (line,) = lines(found)
    assert line.startswith("no step raises `p + q + r`, which is 1 at first; where `p + q >= 2`")
    assert line.endswith("it would be at least 2")
    never = evidence("reach and 2 false sum 1 0 1 0", RING, str, time.monotonic() + 60.0)
    assert never is not None and list(lines(never)) == [
        "no marking at all is what is looked for, reachable or not"
    ]
    assert "no time" in rests_on(("STATE_EQUATION",), is_late=True)
