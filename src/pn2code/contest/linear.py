"""Formulas of linear temporal logic of the contest as automata for the engine.

    question(tables, 3, formula)   # "3 ltl ATOMS STATES ..."

The engine is asked whether a run is accepted by the automaton of the negation: yes means that the formula is false.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from pn2code.contest.formulas import Formula, FormulaError, Op, Truth
from pn2code.contest.tables import Tables
from pn2code.properties import meaning
from pn2code.properties.ltl import Automaton, Literal, automaton

MOST_ATOMS = 63
"""What a word of the engine has room for."""


def question(
    tables: Tables,
    number: int,
    formula: Formula,
    leaves: Mapping[Formula, str] = MappingProxyType({}),
) -> str:
    """The question whether a run does not satisfy a formula, which is one of all paths.

    Args:
        tables: the net.
        number: of the question.
        formula: of all paths.
        leaves: parts about one marking for which there are words.

    Raises:
        FormulaError: it is none, or it looks at too much.
        TooLargeError: the automaton is too large.
    """
    if not isinstance(formula, Op) or formula.operator != "A":
        raise FormulaError("a formula of LTL speaks of all paths")
    written = _Written(tables, leaves)
    made = automaton(written.of(formula.parts[0]), negated=True)
    states = written.states(made)
    if len(written.looked_at) > MOST_ATOMS:
        raise FormulaError(f"it looks at {len(written.looked_at)} things, more than {MOST_ATOMS}")
    return " ".join([f"{number} ltl {len(written.looked_at)}", *written.looked_at, states])


class _Written:
    """A formula on its way to an automaton.

    Args:
        looked_at: what the automaton looks at, in the engine's own words: its number.
    """

    def __init__(self, tables: Tables, leaves: Mapping[Formula, str]) -> None:
        self.tables = tables
        self.leaves = leaves
        self.texts: dict[str, int] = {}
        self.looked_at: dict[str, int] = {}

    def of(self, f: Formula) -> meaning.Formula:
        """The formula, in which everything without operators of time is an atom."""
        if not _is_temporal(f):
            if isinstance(f, Truth):
                return meaning.TRUE if f.value else meaning.negation(meaning.TRUE)
            text = self.tables.formula(f, self.leaves)
            return meaning.Atom("pred", self.texts.setdefault(text, len(self.texts)))
        assert isinstance(f, Op)
        parts = tuple(map(self.of, f.parts))
        match f.operator:
            case "and":
                return meaning.conjunction(*parts)
            case "or":
                return meaning.disjunction(*parts)
            case "not" | "X" | "F" | "G" | "U":
                return meaning.Op(f.operator, parts)
        raise FormulaError(f"`{f.operator}` inside a formula of LTL")

    def states(self, a: Automaton) -> str:
        """The states with their moves, first those that lead on: a search that stays where it is may do so for ever."""
        words = [str(a.states)]
        distance = _distances(a)
        for state in range(a.states):
            arcs = [arc for arc in a.arcs if arc.source == state]
            arcs.sort(key=lambda arc: distance[arc.target])
            words += [str(int(state in a.accepting)), str(len(arcs))]
            words += [f"{arc.target} {self._bits(arc.literals)}" for arc in arcs]
        return " ".join(words)

    def _bits(self, literals: tuple[Literal, ...]) -> str:
        """Those that must be true, and those that must be false."""
        masks = [0, 0]
        for wanted, said in literals:
            number = self.looked_at.setdefault(self._text(said), len(self.looked_at))
            masks[not wanted] |= 1 << number
        return f"{masks[0]} {masks[1]}"

    def _text(self, f: meaning.Formula) -> str:
        if isinstance(f, meaning.Atom):
            return "true" if f.kind == "true" else list(self.texts)[f.number]
        parts = [self._text(p) for p in f.parts]
        return (
            f"not {parts[0]}"
            if f.operator == "not"
            else f"{f.operator} {len(parts)} {' '.join(parts)}"
        )


def _distances(a: Automaton) -> list[int]:
    """By state: moves to an accepting one; all lead to one."""
    sources: dict[int, list[int]] = {}
    for arc in a.arcs:
        sources.setdefault(arc.target, []).append(arc.source)
    found = [a.states] * a.states
    order = list(a.accepting)
    for state in order:
        found[state] = 0
    for state in order:
        for source in sources.get(state, ()):
            if found[source] == a.states:
                found[source] = found[state] + 1
                order.append(source)
    return found


def _is_temporal(f: Formula) -> bool:
    return isinstance(f, Op) and (f.operator in "AEXFGU" or any(map(_is_temporal, f.parts)))
