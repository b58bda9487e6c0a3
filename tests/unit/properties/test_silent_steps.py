"""Formulas of linear time on paths with silent steps, and on the same ones without them."""

from __future__ import annotations

from random import Random

import pytest

from helpers.thorough import amount
from pn2code.properties import meaning as m
from pn2code.properties.silent import means_the_same

P, Q = m.Atom("pred", 0), m.Atom("pred", 1)
A, B = m.Atom("fires", 0), m.Atom("fires", 1)
ATOMS = (P, Q, A, B, m.DEAD, m.TRUE)

Place = tuple[frozenset[int], int]
"""A marking: which conditions are true; which transition comes next, -1: a silent step, -2: nothing ever."""


def holds(f: m.Formula, path: list[Place], at: int = 0) -> bool:
    """Whether a path, whose last marking is repeated for ever, makes a formula true; by its definition."""
    at = min(at, len(path) - 1)
    if isinstance(f, m.Atom):
        true, following = path[at]
        kinds = {"pred": f.number in true, "fires": f.number == following, "dead": following == -2}
        return kinds.get(f.kind, f.kind == "true")
    ahead = range(at, len(path))
    a = f.parts[0]
    match f.operator:
        case "not":
            return not holds(a, path, at)
        case "X":
            return holds(a, path, at + 1)
        case "F":
            return any(holds(a, path, i) for i in ahead)
        case "G":
            return all(holds(a, path, i) for i in ahead)
    b = f.parts[1]
    match f.operator:
        case "and":
            return holds(a, path, at) and holds(b, path, at)
        case "or":
            return holds(a, path, at) or holds(b, path, at)
        case "implies":
            return not holds(a, path, at) or holds(b, path, at)
        case "iff":
            return holds(a, path, at) == holds(b, path, at)
        case "R":
            until = m.Op("U", (m.Op("not", (a,)), m.Op("not", (b,))))
            return not holds(until, path, at)
    is_until = any(
        holds(b, path, i) and all(holds(a, path, k) for k in range(at, i)) for i in ahead
    )
    return is_until or (f.operator == "W" and all(holds(a, path, i) for i in ahead))


def formula(r: Random, depth: int) -> m.Formula:
    if depth == 0 or r.random() < 0.2:
        return r.choice(ATOMS)
    operator = r.choice(("not", "X", "F", "G", "and", "or", "implies", "iff", "U", "W", "R"))
    count = 1 if operator in ("not", "X", "F", "G") else 2
    return m.Op(operator, tuple(formula(r, depth - 1) for _ in range(count)))


def paths(r: Random) -> tuple[list[Place], list[Place]]:
    """One without silent steps, and with some."""
    own: list[Place] = []
    more: list[Place] = []
    steps = [*(r.choice((0, 1, 2)) for _ in range(r.randint(0, 4))), -2]
    for step in steps:
        true = frozenset(i for i in (0, 1) if r.random() < 0.5)
        own.append((true, step))
        more += [(true, -1)] * r.choice((0, 0, 1, 2))
        more.append((true, step))
    return own, more


@pytest.mark.parametrize("seed", range(amount(6, 20)))
def test_what_is_said_with_silent_steps_is_true_without_them(seed: int) -> None:
    r = Random(seed)
    for _ in range(300):
        asked = formula(r, r.choice((1, 2, 3)))
        for answer in ("yes", "no"):
            if not means_the_same(m.Linear(asked), answer):
                continue
            for _ in range(25):
                own, more = paths(r)
                if holds(asked, more) is (answer == "yes"):
                    assert holds(asked, own) is (answer == "yes"), (asked, answer, own, more)


NOT_A, NOT_B = m.Op("not", (A,)), m.Op("not", (B,))


@pytest.mark.parametrize(
    ("asked", "answers"),
    [
        (m.Op("G", (NOT_A,)), "yes no"),
        (m.Op("W", (NOT_B, A)), "yes no"),
        (m.Op("G", (m.Op("implies", (A, m.Op("F", (B,)))),)), "yes no"),
        (m.Op("G", (m.Op("implies", (A, m.Op("X", (P,)))),)), "yes no"),
        (m.Op("G", (m.Op("implies", (A, m.Op("X", (m.Op("U", (P, B)),)))),)), "yes"),
        (m.Op("U", (P, Q)), "yes no"),
        (m.Op("U", (P, A)), "yes"),
        (m.Op("not", (m.Op("U", (P, A)),)), "no"),
        (m.Op("R", (P, NOT_A)), "no"),
        (m.Op("X", (P,)), ""),
        (A, "yes"),
    ],
)
def test_which_answers_are_kept(asked: m.Formula, answers: str) -> None:
    kept = [x for x in ("yes", "no") if means_the_same(m.Linear(asked), x)]
    assert " ".join(kept) == answers


LINEAR = {f"{path}{x}": x for path in "AE" for x in "XFGUWR"}


def branching(r: Random, depth: int) -> m.Formula:
    if depth == 0 or r.random() < 0.2:
        return r.choice((P, Q, m.DEAD, m.TRUE))
    operator = r.choice(("not", "and", "or", "implies", "iff", *LINEAR))
    is_single = operator == "not" or operator[1:] in ("X", "F", "G")
    step = r.choice((0, 1)) if operator in ("AX", "EX") else -1
    parts = tuple(branching(r, depth - 1) for _ in range(1 if is_single else 2))
    return m.Op(operator, parts, step)


def on_a_path(f: m.Formula) -> m.Formula:
    """What a formula means where there is but one path."""
    if isinstance(f, m.Atom):
        return f
    own = m.Op(LINEAR.get(f.operator, f.operator), tuple(map(on_a_path, f.parts)))
    how = {"EX": "and", "AX": "implies"}.get(f.operator)
    return own if how is None else m.Op(how, (m.Atom("fires", f.step), own))


@pytest.mark.parametrize("seed", range(6))
def test_branching_time_where_there_is_one_path(seed: int) -> None:
    r = Random(seed)
    for _ in range(400):
        asked = branching(r, r.choice((1, 2, 3)))
        if not means_the_same(m.Branching(asked)):
            continue
        for _ in range(20):
            own, more = paths(r)
            found = holds(on_a_path(asked), own), holds(on_a_path(asked), more)
            assert found[0] == found[1], (asked, own, more)
