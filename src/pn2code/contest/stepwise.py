"""Nets reduced for one formula of branching or linear time, and the formula in their places.

    smaller = smaller_for(tables, "ltl", formula, until=deadline)      # None: hardly anything is gone

What a formula needs depends on whether it speaks of the next marking: with it the graph of all markings stays as it is,
without it steps that nobody sees may be joined.
"""

from __future__ import annotations

from pn2code.contest import conditions, linear
from pn2code.contest.conditions import TooLargeError
from pn2code.contest.formulas import Formula, FormulaError
from pn2code.contest.reduction.net import Goal
from pn2code.contest.reduction.reduce import reduced_for
from pn2code.contest.rewriting import has_next, leaves
from pn2code.contest.tables import Tables
from pn2code.properties import ltl_expansion

_GAIN = 0.9
"""A net that keeps more of its transitions and places than that is not worth a graph of its own."""


def smaller_for(
    tables: Tables, kind: str, formula: Formula, *, until: float
) -> tuple[Tables, str] | None:
    """A smaller net and the question about it, without its number.

    Args:
        tables: the net.
        kind: "ctl" or "ltl".
        formula: a formula of CTL, or one of LTL that speaks of all paths.
        until: when to stop, on the monotonic clock.
    """
    try:
        texts = {f: tables.formula(f) for f in leaves(formula)}
        if sum(map(len, texts.values())) > conditions.MOST_CHARACTERS:
            return None
        asked = {f: conditions.parsed(text, tables.pre) for f, text in texts.items()}
        reduced = reduced_for(tables, list(asked.values()), until=until, goal=_goal(kind, formula))
        made = reduced.tables
        if len(made.pre) > _GAIN * len(tables.pre) and len(made.initial) > _GAIN * len(
            tables.initial
        ):
            return None
        words = {f: conditions.text(reduced.condition(c)) for f, c in asked.items()}
        return made, question(tables, kind, formula, words)
    except (TooLargeError, FormulaError, ltl_expansion.TooLargeError):
        return None


def question(tables: Tables, kind: str, formula: Formula, leaves: dict[Formula, str]) -> str:
    """A formula as a question for the engine, without its number.

    Raises:
        FormulaError: it looks at too much.
        TooLargeError: its automaton is too large.
    """
    if kind == "ctl":
        return f"ctl {tables.formula(formula, leaves)}"
    return linear.question(tables, 0, formula, leaves).split(" ", 1)[1]


def _goal(kind: str, formula: Formula) -> Goal:
    if has_next(formula):
        return Goal.STEPS
    return Goal.LINEAR if kind == "ltl" else Goal.BRANCHING
