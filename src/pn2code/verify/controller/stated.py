"""Properties of a cell that follow from what holds in each state, so that reduced states tell (`by_counts`).

    made = stated(property, running.over, partition)      # None: it is not of that kind
    made.places                                           # what it looks at: known together, and exactly
    made.ask(questions)                                   # one question about all states; its "yes" is enough

Let all states be those of the net of turns, which does all that the cell does (docs/reductions.md). A condition that
holds in all of them holds in all states of the cell, as far as it says what places hold. Of the rest it is asked for
more than has to be so:

    dead          in a dead state of the cell the supervisor has finished, if no state of it is blocked, which has to be
                  known for everything that is said; so what is demanded of dead states is demanded wherever it has
                  finished
    enabled(T)    where T is what its program does next, the places that T takes tokens from, or tests, are marked
    ctl AF p, ctl AG EF p, ctl AG AF p, ltl F p, ltl G F p, with or without fairness
                  no run goes on for ever, so each path ends in a dead state: p is demanded there

Such atoms may stand only where more of them demands more: on the left of an implication, under one negation.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Partition
from pn2code.net.flat import ArcKind, Form
from pn2code.properties import meaning as m
from pn2code.properties.questions import Questions, expanded


class _NotStatedError(Exception):
    """A formula says something of paths, or of programs."""


@frozen
class Stated:
    """A property as a condition on all states.

    Args:
        asked: what it asks: `Bound`, or a condition that has to hold in all states.
        is_of_ends: whether it has to hold in dead states only.
        places: what it looks at.
    """

    asked: m.Bound | m.Formula
    is_of_ends: bool
    places: frozenset[int]
    over: int
    inputs: tuple[tuple[int, ...], ...]
    """by transition, places that hold a token where it is enabled"""

    def ask(self, asked: Questions) -> None:
        """Adds one question."""
        if isinstance(self.asked, m.Bound):
            asked.ask(self.asked)
            return
        found = self._item(asked, self.asked)
        if self.is_of_ends:
            found = asked.line(
                f"or {asked.line(f'not {self._marked(asked, [self.over])}')} {found}"
            )
        asked.asked.append(f"? invariant {found}")

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
    inputs = tuple(_inputs(partition))
    if isinstance(p.asked, m.Bound):
        return Stated(p.asked, False, frozenset({p.asked.place}), over, inputs)
    found = _condition(p.asked)
    if found is None:
        return None
    condition, is_of_ends = found
    try:
        places = set(_places(condition, True, over, properties, inputs))
    except _NotStatedError:
        return None
    places |= {over} if is_of_ends else set()
    return Stated(condition, is_of_ends, frozenset(places), over, inputs)


def all_stated(properties: m.Properties, partition: Partition) -> bool:
    """Whether all properties of a cell are of that kind, and none is about its closed net alone."""
    return all(
        not p.of_net and stated(p, 0, properties, partition) is not None
        for p in properties.properties
    )


def _condition(asked: m.Asked) -> tuple[m.Formula, bool] | None:
    """What has to hold in all states, or in all ends."""
    match asked:
        case m.Invariant(condition):
            return condition, False
        case m.Branching(
            m.Op("AF", (p,)) | m.Op("AG", (m.Op("EF", (p,)),)) | m.Op("AG", (m.Op("AF", (p,)),))
        ) | m.Linear(m.Op("F", (p,)) | m.Op("G", (m.Op("F", (p,)),))) if m.is_of_nodes(p):
            return p, True
        case _:
            return None


def _places(
    f: m.Formula,
    is_positive: bool,
    over: int,
    properties: m.Properties,
    inputs: Sequence[Sequence[int]],
) -> Iterable[int]:
    """What a condition looks at.

    Raises:
        _NotStatedError: something in it is not known of states.
    """
    if isinstance(f, m.Atom):
        if f.kind == "true":
            return ()
        if f.kind == "pred":
            return [place for _, place in properties.predicates[f.number].places]
        if f.kind == "dead" and not is_positive:
            return (over,)
        if f.kind == "enabled" and not is_positive:
            return inputs[f.number]
        raise _NotStatedError
    match f.operator:
        case "not":
            signs: tuple[bool, ...] = (not is_positive,)
        case "and" | "or":
            signs = (is_positive,) * len(f.parts)
        case "implies" | "iff":
            return _places(expanded(f), is_positive, over, properties, inputs)
        case _:
            raise _NotStatedError
    return [
        place
        for part, sign in zip(f.parts, signs, strict=True)
        for place in _places(part, sign, over, properties, inputs)
    ]


def _inputs(partition: Partition) -> Iterable[tuple[int, ...]]:
    """By transition, those of its own places that hold a token where it is enabled."""
    channels = {c.place for c in partition.channels}
    for t in partition.net.transitions:
        yield tuple(
            sorted(
                {
                    a.place
                    for a in t.arcs
                    if a.kind in (ArcKind.INPUT, ArcKind.BOTH)
                    and a.place not in channels
                    and a.inscription is not None
                    and a.inscription.form is Form.TOKEN
                }
            )
        )
