"""Evidence that nothing is reachable: weights of the places of a net, which anybody can check.

    found = evidence("reach sum 1 0 1 3", tables, name, until)
    found["cases"][0]["weights"]                 # {"P[a]": 1, "Q": 2}

It is worked out afresh for the net as it is, not for a reduced one, and checked in integers before it is said
(`proofs`). What is looked for is in none of its cases: each says which comparisons would hold (`if`), and which
weighted sum of tokens would then be smaller (`at_most`) than it is at first (`at_first`), though no step lowers it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from pn2code.contest import conditions
from pn2code.contest.conditions import AtMost, Condition, TooLargeError
from pn2code.contest.equation import StateEquation
from pn2code.contest.proofs import Leaf, is_proof, leaves
from pn2code.contest.tables import Tables

MOST_PLACES = 20_000
"""Of a net with more nothing is looked for."""
Name = Callable[[int], str]
"""Names a place; numbers after those of the places are the numbers of steps of transitions."""


def evidence(text: str, tables: Tables, name: Name, until: float) -> Mapping[str, Any] | None:
    """Why no reachable marking is one that is looked for, as plain data; None: no such evidence was found.

    Args:
        text: what is looked for, as a question in the engine's own words: `reach ..`.
        tables: the net.
        name: of its places.
        until: when to stop, on the monotonic clock.
    """
    words = text.removeprefix("reach ")
    if len(words) > conditions.MOST_CHARACTERS:
        return None
    try:
        return of_condition(conditions.parsed(words, tables.pre), tables, name, until)
    except TooLargeError:
        return None


def of_condition(
    condition: Condition, tables: Tables, name: Name, until: float
) -> Mapping[str, Any] | None:
    """The same of a condition."""
    if len(tables.initial) > MOST_PLACES or not tables.pre or not tables.initial:
        return None
    proof = StateEquation(tables).proof(condition, until)
    if proof is None or not is_proof(proof, condition, tables):
        return None
    return {"cases": [_case(leaf, tables, name) for leaf in leaves(proof)]}


def rests_on(methods: tuple[str, ...], *, is_late: bool) -> str:
    """What an answer without such evidence rests on, as a clause."""
    if {"DECISION_DIAGRAMS", "EXPLICIT"} & {*methods}:
        return "it rests on the set of all markings"
    why = "there was no time to look for one" if is_late else "none was found"
    return (
        f"{why}, and it rests on steps of structural reductions, of searches or of the state equation, of which each "
        "is checked where it is made (docs/contest.md)"
    )


def _case(leaf: Leaf, tables: Tables, name: Name) -> dict[str, Any]:
    initial = (*tables.initial, *([0] * len(tables.pre)))
    return {
        "if": [_row(row, name) for row in leaf.rows],
        "traps": [[name(p) for p in trap] for trap in leaf.traps],
        "factors": list(leaf.factors),
        "weights": {name(p): w for p, w in leaf.weight.items()},
        "at_first": sum(w * initial[p] for p, w in leaf.weight.items()),
        "at_most": leaf.limit,
    }


def _row(row: AtMost, name: Name) -> dict[str, Any]:
    """A comparison: a sum is at most that."""
    return {"sum": {name(p): n for p, n in row.factors}, "at_most": row.limit}
