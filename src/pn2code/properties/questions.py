"""Properties as the compiled explorer is asked them: the lines of its option `--queries`.

    0 pred 0            items: sets of nodes, numbered in order; operands stand before their use
    1 not 0
    ? invariant 1       questions, one for each property, in order

(The numbers of the items are not written.) cnative/src/explore/query/explore_query.c reads them.
"""

from __future__ import annotations

from dataclasses import field

from pn2code.base.frozen import record
from pn2code.properties import meaning as m
from pn2code.properties.ltl import Automaton, automaton

_UNARY = {"EX": "ex", "AX": "ax", "EF": "ef", "AF": "af", "EG": "eg", "AG": "ag"}


ENDLESS = 1_000_000_000
"""Steps: a run is that long, or goes on for ever; as good as no limit."""


@record
class Questions:
    """The lines in the making; equal items are one."""

    lines: list[str] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)
    _numbers: dict[str, int] = field(default_factory=dict)
    _items: dict[m.Formula, int] = field(default_factory=dict)

    def text(self) -> str:
        """The whole file."""
        return "".join(f"{line}\n" for line in (*self.lines, *self.asked))

    def ask(self, asked: m.Asked) -> None:
        """Adds the question of a property.

        Raises:
            TooLargeError: the automaton of its formula is too large.
        """
        match asked:
            case m.Invariant(condition):
                self.asked.append(f"? invariant {self.item(condition)}")
            case m.Bound(place, low, high):
                most = "-" if high is None else high
                self.asked.append(f"? bound {place} {low or 0} {most}")
            case m.Branching(formula):
                self.asked.append(f"? initially {self.item(formula)}")
            case m.Linear(formula, fair):
                found = automaton(formula, negated=True)
                self.asked.append("? lasso")
                self.asked += self._automaton(found, fair)
            case m.Response(
                first, second, _, _, True
            ):  # of a net without time nothing can be asked
                self.asked.append(
                    f"? within-firings {self._event(first)} {self._event(second)} {ENDLESS}"
                )
            case m.Response(first, second, firings):
                limit = f"firings {firings}" if firings is not None else f"time {asked.units}"
                word, value = limit.split(" ")
                events = f"{self._event(first)} {self._event(second)}"
                self.asked.append(f"? within-{word} {events} {value}")

    def _event(self, f: m.Formula) -> str:
        if m.looks_at_steps(f):
            return f"f{','.join(str(a.number) for a in m.atoms(f))}"
        return f"s{self.item(f)}"

    def _automaton(self, found: Automaton, fair: tuple[m.Fairness, ...]) -> list[str]:
        lines = [f"automaton {found.states} 0", " ".join(["accepting", *map(str, found.accepting)])]
        for arc in found.arcs:
            literals = ["+-"[not positive] + self._seen(what) for positive, what in arc.literals]
            lines.append(" ".join(["arc", f"{arc.source} {arc.target}", *literals]))
        for one in fair:
            lines.append(f"{'strong' if one.strong else 'weak'} {one.transition}")
        return [*lines, "end"]

    def _seen(self, f: m.Formula) -> str:
        if isinstance(f, m.Atom) and f.kind == "fires":
            return f"f{f.number}"
        return str(self.item(f))

    # --- items

    def item(self, f: m.Formula) -> int:
        """The number of the set of nodes where a formula holds."""
        if f not in self._items:
            self._items[f] = self._item(f)
        return self._items[f]

    def _item(self, f: m.Formula) -> int:
        if isinstance(f, m.Atom):
            return self.line(f.kind if f.number < 0 else f"{f.kind} {f.number}")
        if f.operator not in ("not", "and", "or", *_UNARY, "EU", "AU"):
            return self.item(expanded(f))
        if f.step >= 0:
            if f.operator == "AX":
                opposite = m.Op("EX", (m.negation(f.parts[0]),), f.step)
                return self.item(m.negation(opposite))
            return self.line(f"exa {f.step} {self.item(f.parts[0])}")
        parts = " ".join(str(self.item(x)) for x in f.parts)
        return self.line(f"{_UNARY.get(f.operator, f.operator.lower())} {parts}")

    def line(self, line: str) -> int:
        """The number of an item that is written already."""
        number = self._numbers.setdefault(line, len(self.lines))
        if number == len(self.lines):
            self.lines.append(line)
        return number


def expanded(f: m.Op) -> m.Formula:
    """By operators that the explorer knows."""
    a, b = f.parts
    no_a, no_b = m.negation(a), m.negation(b)
    match f.operator:
        case "implies":
            return m.disjunction(no_a, b)
        case "iff":
            return m.disjunction(m.conjunction(a, b), m.conjunction(no_a, no_b))
        case "AW":
            return m.negation(m.Op("EU", (no_b, m.conjunction(no_a, no_b))))
        case "EW":
            return m.disjunction(m.Op("EU", (a, b)), m.Op("EG", (a,)))
        case "AR":
            return m.negation(m.Op("EU", (no_a, no_b)))
        case "ER":
            return m.negation(m.Op("AU", (no_a, no_b)))
        case other:
            raise AssertionError(other)


def questions(properties: m.Properties) -> str:
    """The whole file for all properties.

    Raises:
        TooLargeError: the automaton of a formula is too large.
    """
    made = Questions()
    for p in properties.properties:
        made.ask(p.asked)
    return made.text()
