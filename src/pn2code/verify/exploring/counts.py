"""Numbers of tokens that need not be known exactly: parts on a tray are none, one, or many.

    known = relations(net)
    found = counts(net, known, bounds, free=places)         # None: there is no such place
    table = found.within(turns(net, owners, ...))           # the table of turns, as far as such numbers tell
    path.write_text(found.text())

The explorer (cnative/src/explore/search/explore_counts.c) makes each marking m a *state* a(m): in some places the
number of tokens of each colour is at most a limit, and the number that the token of a counter is (`Left : INT`, of
which `n` becomes `n - 1`), too. A state is explored as if it were a marking; what is taken from a number that is the
limit may leave the limit, or less, and all these are successors, except those that stand for no marking because of a
relation of the net (`structure.relations`). This is *counter abstraction* (A. Pnueli, J. Xu, L. Zuck, *Liveness with
(0, 1, infinity)-counter abstraction*, 2002; the idea of "many" is R. Karp's and R. Miller's, 1969).

What a limit is chosen for. Each question that is asked of a marking has the same answer in its state:

  enabled?  a transition demands of such a place constant numbers of tokens, which are no greater than the limit, or
            that there are none; of a counter nothing, or one constant that is smaller than the limit, and nothing in
            the transition depends on it otherwise (`updates`). Which colours there are is known, so the bindings are
            the same, and so is the first of them.
  reasons   the table of turns compares numbers of tokens with what a transition demands, which is no greater than the
            limit; numbers after something has been taken are not compared (`within`).

*Claim*: for each marking m of the reduced space of `turns` a(m) is a state, if the sets are chosen in this way: for m
the one that is chosen in a(m). It is closed in m, since it rests on the questions above. By induction let m lead to m'
by an occurrence that is explored in m. The same one is explored in a(m), and gives a state in which numbers below their
limits have changed as in m', and numbers that are limits stand for all that are greater: one of the successors is
a(m'). It is not left out, since m' fulfils each relation.

So **what holds in all states, and of all steps, holds in the reduced space of turns**: bounds of other places,
what places of one group hold, that certain places are never marked, and that each state in which nothing is enabled is
an end (a dead marking has a dead state). It is shown for runs without end in another way, as states have cycles where
markings have none: by weights (`ranking`), and what those leave over must have no cycle among the states. Then no run
of the reduced space goes on for ever, which is what turns need to keep all of this for the whole space.

A "no" is never said. A state may stand for markings that are never reached, and runs of states need not be runs.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType

from pn2code.base.frozen import frozen
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Kind
from pn2code.net.enumerable import size
from pn2code.net.flat import ArcKind, FlatArc, FlatNet, FlatTransition, Form
from pn2code.structure.relations import Relation, Relations
from pn2code.verify.exploring.table_rows import END, row
from pn2code.verify.exploring.turns import Member, Turns
from pn2code.verify.exploring.updates import How, accesses

MAGIC = "pn2code-counts 1"
MOST_COLOURS = 16
MOST_DEMANDED = 8
"""Tokens of a place by one transition."""
LEAST_TOKENS = 3
"""Of a place that is worth a limit."""
FARTHEST = 1 << 20
"""Counters that stay below it raise no exception: so far is nothing from the greatest number."""


@frozen
class Limit:
    """Of a place; `is_value`: of the number that its token is, else of the tokens of each colour."""

    place: int
    most: int
    is_value: bool


@frozen
class Counts:
    """The table.

    Args:
        places: their number.
        limits: for each place that has one.
        relations: those that tell something of their numbers.
    """

    places: int
    limits: tuple[Limit, ...]
    relations: tuple[Relation, ...]

    @property
    def limited(self) -> frozenset[int]:
        """Places of which the number of tokens is not known exactly."""
        return frozenset(x.place for x in self.limits if not x.is_value)

    def within(self, table: Turns) -> Turns:
        """The table of turns without what only exact numbers tell: what is left when something has been taken."""
        limited = self.limited

        def fitting(m: Member) -> Member:
            return replace(m, taken=tuple(x for x in m.taken if x[0] not in limited))

        return replace(table, members=tuple(map(fitting, table.members)))

    def text(self) -> str:
        """In the form that the explorer reads."""
        return "\n".join(self._lines()) + "\n"

    def _lines(self) -> Iterator[str]:
        yield MAGIC
        yield row(self.places, len(self.limits), len(self.relations))
        for x in self.limits:
            yield row(x.place, x.most, int(x.is_value))
        for r in self.relations:
            yield row(r.total)
            for summands in (r.tokens, r.values):
                yield row(len(summands), *(n for pair in sorted(summands.items()) for n in pair))
        yield END


def counts(
    net: FlatNet,
    known: Relations,
    bounds: Mapping[int, int],
    *,
    free: Collection[int],
    least: int = LEAST_TOKENS,
    demanded: Mapping[int, int] = MappingProxyType({}),
) -> Counts | None:
    """The limits of a net; None: there are none.

    Args:
        net: the net.
        known: its relations.
        bounds: by place, most tokens, where the structure proves it.
        free: places of which nobody asks how many tokens they hold.
        least: tokens that a place may hold to be worth a limit.
        demanded: by place, up to which number its tokens have to be known besides.
    """
    at: dict[int, list[FlatTransition]] = {}
    for t in net.transitions:
        for p in {a.place for a in t.arcs}:
            at.setdefault(p, []).append(t)
    limits: list[Limit] = []
    for p in sorted(free):
        touching = at.get(p, [])
        if bounds.get(p, 0) >= least:
            most = _most_demanded(net, p, touching)
            more = demanded.get(p, 0)
            limits += [] if most is None else [Limit(p, max(most, more), False)]
        elif p in known.single:
            is_near = any(_is_narrow(r, p, bounds) for r in known.found)
            most = _most_compared(net, known, p, touching) if is_near else None
            limits += [] if most is None else [Limit(p, most, True)]
    if not limits:
        return None
    tokens = {x.place for x in limits if not x.is_value}
    values = {x.place for x in limits if x.is_value}
    telling = (r for r in known.found if tokens & {*r.tokens} or values & {*r.values})
    return Counts(len(net.places), tuple(limits), tuple(telling))


def _most_demanded(net: FlatNet, place: int, touching: Collection[FlatTransition]) -> int | None:
    """How many tokens of a place a transition demands, at most; None: that is not constant, or too much is seen."""
    colset = net.places[place].colset
    if colset.timed or size(colset, MOST_COLOURS) is None:
        return None
    most = 0
    for t in touching:
        demanded = 0
        for arc in t.arcs:
            if arc.place != place or arc.kind is ArcKind.OUTPUT:
                continue
            if arc.kind is ArcKind.INHIBITOR:
                demanded = max(demanded, 1)
                continue
            own = demanded_by(arc) if arc.kind is not ArcKind.RESET else None
            if own is None:
                return None
            demanded += own
        most = max(most, demanded)
    return most if most <= MOST_DEMANDED else None


def demanded_by(arc: FlatArc) -> int | None:
    """Tokens that an arc demands; None: it depends on something."""
    if arc.inscription is None or arc.inscription.form not in (Form.TOKEN, Form.MULTISET):
        return None
    total = 0
    for term in arc.inscription.terms:
        n = term.coefficient
        if term.whole or term.delay is not None:
            return None
        if not (isinstance(n, core.Lit) and isinstance(n.value, int) and n.value > 0):
            return None
        total += n.value
    return total or None


def _is_narrow(relation: Relation, place: int, bounds: Mapping[int, int]) -> bool:
    """Whether a relation keeps the number that the token of a place is near 0."""
    if set(relation.values) != {place} or not all(p in bounds for p in relation.tokens):
        return False
    held = sum(w * bounds[p] for p, w in relation.tokens.items())
    return held + abs(relation.total) <= FARTHEST


def _most_compared(
    net: FlatNet, known: Relations, place: int, touching: Collection[FlatTransition]
) -> int | None:
    """A number that is greater than all with which a counter is compared; None: more depends on it."""
    colset = net.places[place].colset
    own = colset.resolved
    if colset.timed or own.kind is not Kind.INT or own.low is not None or own.high is not None:
        return None
    most = 0
    is_changed = False
    for t in touching:
        arcs = [a for a in t.arcs if a.place == place]
        if all(a.kind is ArcKind.INHIBITOR for a in arcs):
            continue
        demanded = known.constant[t.index].get(place)
        if demanded is not None:
            if len(arcs) != 1 or arcs[0].kind not in (ArcKind.INPUT, ArcKind.BOTH):
                return None
            if not (isinstance(demanded, core.Lit) and isinstance(demanded.value, int)):
                return None
            most = max(most, demanded.value + 1)
            continue
        uses = accesses(net, t, place)
        if uses is None or set(uses) != {""}:
            return None
        if uses[""].how not in (How.IDLE, How.GROWS, How.SHRINKS):
            return None
        is_changed = True
    return most if is_changed and most < (1 << 16) else None
