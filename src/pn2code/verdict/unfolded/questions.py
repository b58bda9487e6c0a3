"""What is asked of an unfolded net: its properties, and what a report on a state space says of places and transitions.

made = Questions.of(game, unfolding, properties)
made.tables, made.properties                 # for `pn2code.contest.portfolio.answers`
made.refused["p"]                            # why a property cannot be asked, as a clause
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from pn2code.base.frozen import frozen, replace
from pn2code.contest.examinations import Asked, Part
from pn2code.contest.formulas import Formula, FormulaError, Op
from pn2code.contest.tables import Tables
from pn2code.properties import meaning as m
from pn2code.semantics.game.token_game import Game
from pn2code.unfold.net import Unfolding
from pn2code.verdict.unfolded.conditions import (
    Conditions,
    Counted,
    NotTranslatedError,
    joined,
    name,
    transition_name,
)

DEAD = "dead"
"""The name of the question whether there is a dead marking."""


@frozen
class Questions:
    """The tables of a net, and questions about them.

    Args:
        tables: the unfolded net; names are those of `conditions.name` and `conditions.transition_name`.
        properties: a question for each property that can be asked, by its name.
        shown: of those that a marking decides, what is looked for, as a question: where it is found a run shows the
            answer.
        refused: why others cannot be.
        counted: what their conditions compute from numbers of tokens, by name.
    """

    tables: Tables
    properties: tuple[Asked, ...]
    shown: Mapping[str, str]
    refused: Mapping[str, str]
    counted: Mapping[str, Counted]

    @staticmethod
    def of(game: Game, unfolding: Unfolding, properties: m.Properties) -> Questions:
        """Those about a net.

        Raises:
            ValueError: the net has something that is not in the tables.
        """
        conditions = Conditions(game, unfolding, properties.predicates)
        translated: list[tuple[m.Property, str, Formula]] = []
        refused: dict[str, str] = {}
        counted: dict[str, Counted] = {}
        for p in properties.properties:
            try:
                translated.append((p, *_translated(conditions, p.asked)))
                counted[p.name] = conditions.counted(p.asked)
            except NotTranslatedError as problem:
                refused[p.name] = str(problem)
        tables = _named(unfolding, conditions.used)
        questions: list[Asked] = []
        shown: dict[str, str] = {}
        for p, kind, formula in translated:
            try:
                if kind != "reach":
                    questions.append(Asked(p.name, formula=formula, kind=kind))
                    continue
                is_dead = p.asked == m.Invariant(m.negation(m.DEAD))
                text = "reach dead" if is_dead else f"reach {tables.formula(formula)}"
                is_turned = not isinstance(p.asked, m.Invariant) or p.asked.wanted
                questions.append(Asked(p.name, (Part("reach", text),), is_turned=is_turned))
                shown[p.name] = text
            except FormulaError as problem:
                refused[p.name] = str(problem)
        return Questions(tables, tuple(questions), shown, refused, counted)

    def dead(self) -> Asked:
        """Whether there is a dead marking."""
        return Asked(DEAD, (Part("reach", "reach dead"),))

    def transitions(self, which: Sequence[int]) -> list[Asked]:
        """Of each of some transitions, by index, whether it can occur."""
        found = []
        for i in which:
            own = self.tables.transitions[transition_name(i)]
            if own:
                text = f"reach enabled {len(own)} {' '.join(map(str, own))}"
                found.append(Asked(transition_name(i), (Part("reach", text),)))
        return found

    def bounds(self, which: Sequence[int]) -> list[Asked]:
        """Of each of some places, by index, how many tokens it holds at most."""
        found = []
        for i in which:
            own = self.tables.places[f"p{i}"]
            if own:
                text = f"bound {self.tables.sum(dict.fromkeys(own, 1), 0)}"
                found.append(Asked(f"p{i}", (Part("bound", text),)))
        return found


def _named(unfolding: Unfolding, used: Collection[int]) -> Tables:
    """The tables with our names: those of the file may stand for several instances of a page."""
    of: dict[int, list[int]] = {t.index: [] for t in unfolding.net.transitions}
    for t in unfolding.transitions:
        of[t.transition].append(t.index)
    single = {name(u): (u,) for u in sorted(used)}
    return replace(
        Tables.of(unfolding),
        places={**single, **{f"p{i}": own for i, own in enumerate(unfolding.of_place)}},
        transitions={transition_name(i): tuple(own) for i, own in of.items()},
    )


def _translated(conditions: Conditions, asked: m.Asked) -> tuple[str, Formula]:
    """The kind of a question, and what it asks: of "reach" what is looked for in a marking."""
    match asked:
        case m.Invariant(condition):
            return "reach", conditions.branching(m.negation(condition))
        case m.Bound(place, low, high):
            held = conditions.sum_of(place)
            wrong: list[Formula] = []
            if high is not None:
                wrong.append(Op("not", (conditions.at_most(held, high),)))
            if low:
                wrong.append(conditions.at_most(held, low - 1))
            return "reach", joined("or", wrong)
        case m.Branching(formula):
            return "ctl", conditions.branching(formula)
        case m.Linear(formula, ()):
            return "ltl", Op("A", (conditions.linear(formula),))
        case m.Linear():
            raise NotTranslatedError("it assumes fairness")
    raise NotTranslatedError("it counts steps or time")
