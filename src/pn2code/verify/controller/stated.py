"""Properties of a cell that follow from what holds in each state, so that reduced states tell (`by_counts`).

    made = stated(property, running.over, partition)      # None: it is not of that kind
    all_of_them = ways(property, ...)                     # that, and a formula about the supervisor's own places
    made.places, made.exact                               # what it looks at together; and of which all tokens count
    made.ask(questions)                                   # one question about all states; its "yes" is enough

Let all states be those of the net of turns, which does all that the cell does (docs/reductions.md). A condition that
holds in all of them holds in all states of the cell, as far as it says what places hold. Of the rest it is asked for
more than has to be so:

    dead          in a dead state of the cell the supervisor has finished, if no state of it is blocked, which has to be
                  known for everything that is said; so what is demanded of dead states is demanded wherever it has
                  finished
    enabled(T)    where T is what its program does next, the places that T takes tokens from, or tests, are marked; a
                  limit is no smaller than what T demands, so this is seen in a state, too
    ctl AF p, ctl AG EF p, ctl AG AF p, ltl F p, ltl G F p, with or without fairness
                  no run goes on for ever, so each path ends in a dead state: p is demanded there
    ctl AG (q -> AF p), ctl AG (q -> EF p), ltl G (q -> F p), every q is followed by p
                  the same, whatever q is: an end is repeated for ever, so p comes after each q

    every fires(T) is followed by p, within any number of firings
                  p holds in each state that T leads to. A place that T changes is looked at together with what p looks
                  at, so these states are those that T leads to in any order

    ltl f, without fairness, X, dead, enabled and fires, about places that only the supervisor touches (`is_own`)
                  turns keep what the places of a group hold one after the other, in each run to a dead state, and f
                  does not tell how long they hold it. A run of the cell is the beginning of one in the net of turns,
                  in which robots go on after the supervisor has finished, and change none of these places. So f holds
                  of all runs of the cell if it holds of all paths of states that come to a dead one; others, which go
                  round, stand for no run

Such atoms may stand only where more of them demands more: on the left of an implication, under one negation.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Partition
from pn2code.net.flat import ArcKind, Form
from pn2code.properties import meaning as m
from pn2code.properties.ltl import automaton
from pn2code.properties.ltl_expansion import TooLargeError
from pn2code.properties.questions import Questions, expanded


class _NotStatedError(Exception):
    """A formula says something of paths, or of programs."""


@frozen
class Stated:
    """A property as a condition on all states.

    Args:
        asked: what it asks: `Bound`, or a condition that has to hold in all states; `Linear`: a formula that has to
            hold on all maximal paths of states.
        is_of_ends: whether it has to hold in dead states only.
        steps: transitions; if there are any, it has to hold only where one of them leads to.
        places: what it looks at; `exact`: of these, those whose numbers of tokens have to be known.
    """

    asked: m.Bound | m.Linear | m.Formula
    is_of_ends: bool
    steps: tuple[int, ...]
    places: frozenset[int]
    exact: frozenset[int]
    over: int
    inputs: Mapping[int, tuple[int, ...]]
    """by transition that it asks about, places that hold a token where it is enabled"""

    def ask(self, asked: Questions) -> None:
        """Adds one question."""
        if isinstance(self.asked, m.Bound | m.Linear):
            asked.ask(self.asked)
            return
        found = self._item(asked, self.asked)
        if self.steps:
            wrong = asked.line(f"not {found}")
            after = [asked.line(f"exa {t} {wrong}") for t in self.steps]
            some = after[0]
            for item in after[1:]:
                some = asked.line(f"or {some} {item}")
            never = asked.line(f"not {asked.line(f'ef {some}')}")
            asked.asked.append(f"? initially {never}")
            return
        if self.is_of_ends:
            found = asked.line(
                f"or {asked.line(f'not {self._marked(asked, [self.over])}')} {found}"
            )
        asked.asked.append(f"? invariant {found}")

    @property
    def is_of_paths(self) -> bool:
        """Whether it is a formula about paths."""
        return isinstance(self.asked, m.Linear)

    def holds(self, row: Mapping[str, Any]) -> bool:
        """Whether the answer is that it is so; of a formula about paths it is asked for one that violates it."""
        return bool(row["answer"] == ("no" if self.is_of_paths else "yes"))

    @staticmethod
    def row(p: m.Property) -> Mapping[str, Any]:
        """What the explorer would say where it holds in all states."""
        answer = "no" if isinstance(p.asked, m.Linear) else "yes"  # a path that violates it
        return {"answer": answer, "value": None, "trace": None, "loop": None, "why": None}

    def _item(self, asked: Questions, f: m.Formula) -> int:
        if isinstance(f, m.Atom):
            if f.kind == "dead":
                return self._marked(asked, [self.over])
            if f.kind == "enabled":
                return self._marked(asked, self.inputs[f.number])
            return asked.item(f)
        if f.operator in ("implies", "iff"):
            return self._item(asked, expanded(f))
        parts = " ".join(str(self._item(asked, x)) for x in f.parts)
        return asked.line(f"{f.operator} {parts}")

    @staticmethod
    def _marked(asked: Questions, places: Sequence[int]) -> int:
        found = asked.item(m.TRUE)
        for place in places:
            found = asked.line(f"and {found} {asked.line(f'within {place} 1 -')}")
        return found


def stated(
    p: m.Property, over: int, properties: m.Properties, partition: Partition
) -> Stated | None:
    """What a property asks of all states; None: it asks something else.

    Args:
        p: the property.
        over: the place of the supervisor's end.
        properties: those that it belongs to.
        partition: the cell.
    """
    if isinstance(p.asked, m.Bound):
        place = frozenset({p.asked.place})
        return Stated(p.asked, False, (), place, place, over, {})
    found = _condition(p.asked)
    if found is None:
        return None
    condition, is_of_ends, steps = found
    changed = [_changed(partition, t) for t in steps]
    if not all(changed):
        return None
    try:
        atoms = list(_atoms(condition, True))
    except _NotStatedError:
        return None
    is_at_end = is_of_ends or any(a.kind == "dead" for a in atoms)
    exact = {
        place
        for a in atoms
        if a.kind == "pred"
        for _, place in properties.predicates[a.number].places
    }
    inputs = {a.number: _inputs(partition, a.number) for a in atoms if a.kind == "enabled"}
    places = exact.union(*inputs.values())
    places |= {over} if is_at_end else set()
    places |= {own[0] for own in changed}
    return Stated(condition, is_of_ends, steps, frozenset(places), frozenset(exact), over, inputs)


def ways(
    p: m.Property, over: int, properties: m.Properties, partition: Partition
) -> tuple[Stated, ...]:
    """All ways in which a property follows from reduced states; each is enough. The arguments: as for `stated`."""
    found = (
        None if p.of_net else stated(p, over, properties, partition),
        None if p.of_net else is_own(p, over, properties, partition),
    )
    return tuple(x for x in found if x is not None)


def is_own(
    p: m.Property, over: int, properties: m.Properties, partition: Partition
) -> Stated | None:
    """A formula about paths that looks at places of the supervisor only; None: it asks something else."""
    if not isinstance(p.asked, m.Linear) or p.asked.fair or not _is_lasting(p.asked.formula):
        return None
    numbers = {a.number for a in m.atoms(p.asked.formula) if a.kind == "pred"}
    places = frozenset(place for i in numbers for _, place in properties.predicates[i].places)
    channels = {c.place for c in partition.channels}
    if any(partition.place_owner[x] != 0 or x in channels for x in places):
        return None
    ending = m.Linear(m.Op("implies", (m.Op("F", (m.DEAD,)), p.asked.formula)))
    try:
        automaton(ending.formula, negated=True)
    except TooLargeError:
        return None
    return Stated(ending, False, (), places, places, over, {})


def _is_lasting(f: m.Formula) -> bool:
    """Whether it says what places hold one after the other, and not for how many steps."""
    if isinstance(f, m.Atom):
        return f.kind in ("true", "pred")
    return f.operator != "X" and f.step < 0 and all(map(_is_lasting, f.parts))


def _condition(asked: m.Asked) -> tuple[m.Formula, bool, tuple[int, ...]] | None:
    """What has to hold in all states, or in all ends, or after some transitions."""
    match asked:
        case m.Invariant(condition):
            return condition, False, ()
        case m.Branching(
            m.Op("AF", (p,)) | m.Op("AG", (m.Op("EF", (p,)),)) | m.Op("AG", (m.Op("AF", (p,)),))
        ) | m.Linear(m.Op("F", (p,)) | m.Op("G", (m.Op("F", (p,)),))) if m.is_of_nodes(p):
            return p, True, ()
        case m.Branching(m.Op("AG", (m.Op("implies", (_, m.Op("AF" | "EF", (p,)))),))) | m.Linear(
            m.Op("G", (m.Op("implies", (_, m.Op("F", (p,)))),))
        ) if m.is_of_nodes(p):
            return p, True, ()  # whatever it follows
        case m.Linear(m.Op("G", (m.Op("implies", (_, m.Op("X", (m.Op("F", (p,)),)))),))) if (
            m.is_of_nodes(p)
        ):
            return p, True, ()
        case m.Response(first, second, _, None, False) if m.is_of_nodes(second):
            steps = [a for a in m.atoms(first) if a.kind == "fires"]
            is_of_steps = m.looks_at_steps(first) and len(steps) == len([*m.atoms(first)])
            return (second, False, tuple(a.number for a in steps)) if is_of_steps else None
        case _:
            return None


def _changed(partition: Partition, transition: int) -> list[int]:
    """Places whose number of tokens a transition surely changes, its own ones first."""
    channels = {c.place for c in partition.channels}
    arcs = partition.net.transitions[transition].arcs
    alone = [a for a in arcs if sum(b.place == a.place for b in arcs) == 1]
    found = {
        a.place
        for a in alone
        if a.kind in (ArcKind.INPUT, ArcKind.OUTPUT)
        and a.inscription is not None
        and a.inscription.form is Form.TOKEN
    }
    return sorted(found, key=lambda place: (place in channels, place))


def _atoms(f: m.Formula, is_positive: bool) -> Iterable[m.Atom]:
    """Those of a condition.

    Raises:
        _NotStatedError: something in it is not known of states.
    """
    if isinstance(f, m.Atom):
        if f.kind not in ("true", "pred") and (is_positive or f.kind not in ("dead", "enabled")):
            raise _NotStatedError
        return [f]
    match f.operator:
        case "not":
            return _atoms(f.parts[0], not is_positive)
        case "and" | "or":
            return [a for part in f.parts for a in _atoms(part, is_positive)]
        case "implies" | "iff":
            return _atoms(expanded(f), is_positive)
        case _:
            raise _NotStatedError


def _inputs(partition: Partition, transition: int) -> tuple[int, ...]:
    """The places of its own that hold a token where a transition is enabled."""
    channels = {c.place for c in partition.channels}
    found = {
        a.place
        for a in partition.net.transitions[transition].arcs
        if a.kind in (ArcKind.INPUT, ArcKind.BOTH)
        and a.place not in channels
        and a.inscription is not None
        and a.inscription.form is Form.TOKEN
    }
    return tuple(sorted(found))
