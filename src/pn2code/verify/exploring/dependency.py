"""Which transitions depend on which: what partial order rests on where the binding elements of a net cannot be listed.

    table = dependency(net)    # raises NotPossibleError with the transition that stands in the way
    path.write_text(table.text())

The explorer (cnative/src/explore/search/explore_dependency.c) closes *strong stubborn sets* of transitions with it: a
set of which some transition is enabled, such that, whatever transitions outside of it occur before the first of the
set does,

    D1  that first one could just as well occur at once, with the same binding, and the others after it;
    D2  each enabled transition of the set remains enabled, and can as well occur before them.

Then every dead marking is still found (A. Valmari, *Stubborn sets for reduced state space generation*, 1990), and every
run that goes on for ever leaves one in what is explored. Here a transition stands for all its bindings. Why the rules
below are enough for D1 and D2:

* What is enabled of a transition, and what each binding does, depends on the tokens of the places that it takes from,
  tests or inhibits, and on the references that its inscriptions read. A *code segment* belongs to the binding: it
  computes outputs from inputs. What commands of robots do is not seen in the net.
* An *enabled* transition t has as rivals all that take from, test, or clear what it takes, or take or clear what it
  tests (else they could disable each other; not where both demand constants, and different ones), all that put
  tokens where it takes or tests (else it could get other bindings; not where t demands known numbers of constants, or
  the place has one colour: more tokens are nothing new), all that put tokens where it must find none, or the other
  way round, all at a place that one of the two clears, and all that change a reference that it reads or changes, or
  the other way round. Two that put tokens into the same place, or test one there, commute; but not where tokens have
  reals, since of 0.0 and ~0.0, which are one token, a place keeps the sign of what was there first: at such a place all
  that change it are rivals. What puts the very tokens that it takes only tests them.
* *Updates* of the only token of a place that commute (`updates`) make nobody a rival there. A binding then stands for
  all that differ in variables on which nothing else depends, in D1 and D2 too: after the others t occurs with another
  value of such a variable, and all comes to the same marking.
* Two that are *never both enabled* in a reachable marking (`structure.relations`) are no rivals: as long as nothing of
  the set has occurred, t remains enabled, step by step, so the other one does not occur. Nor does it matter that it
  raises an exception, if its search raises none. Of two that need a token of a place, and need it to be empty, only
  one is ever enabled, too.
* A *disabled* transition remains disabled as long as an input place lacks tokens, or an inhibiting one has some. So it
  is enough to have with it what increases the number of tokens on one such place, or takes from it. If this is not why
  it is disabled, with it come all that put tokens into any of its input places (not what changes a part of the only
  token that it does not look at), take from the inhibiting ones, or change references that it reads.
* An *exception* in an inscription is looked at as an occurrence after which nothing happens. It may be raised while
  bindings are searched for, although an input place lacks tokens. So a transition whose guards and input inscriptions
  are not certain to raise nothing has no such reason. Nor must an exception be put off for ever, because what is
  explored goes round without the transition that raises it: each cycle has a state in which all that is enabled is
  explored. `recurring` gives transitions of which one occurs in each cycle; where one of these is enabled in a set,
  that set is not used.
* *Priorities*: all that occurs before the first of the set is as urgent as what is enabled now, if nothing outside
  makes something more urgent enabled. The more urgent transitions, which are all disabled now, belong to the set
  for this. If an occurrence of the set itself might enable a more urgent one, the others would have to wait:
  `spoiling`. Then everything that is enabled is explored. What is less urgent cannot be the first of the set.

Random numbers, files and the number of steps are seen by all transitions that use them, and time by all of a timed net:
these nets are refused.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import field

from pn2code.base.frozen import frozen, record
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Kind
from pn2code.ml.core.reals import may_hold_reals
from pn2code.net.flat import (
    ArcKind,
    BindAll,
    BindEquation,
    BindRandom,
    FlatArc,
    FlatNet,
    FlatTransition,
)
from pn2code.semantics.evaluation.effects import Effect, Effects, effects_of
from pn2code.semantics.evaluation.references import occurring
from pn2code.structure.relations import Relations, relations
from pn2code.verify.controller.unsure import is_total
from pn2code.verify.exploring.elements import NotPossibleError, colours
from pn2code.verify.exploring.table_rows import END, Reason, listed, reason_rows, row
from pn2code.verify.exploring.updates import Accesses, accesses, commute, is_moved_by

MAGIC = "pn2code-dependency 1"
MOST_TRANSITIONS = 3000
OUTSIDE = (Effect.DRAW, Effect.LOOK, Effect.COUNT)
_LISTED = frozenset({Kind.UNIT, Kind.BOOL, Kind.ENUM, Kind.INT, Kind.INDEX})
_TAKING = (ArcKind.INPUT, ArcKind.BOTH)


@record
class Use:
    """What the arcs between a transition and a place do.

    Args:
        least: tokens without which it is disabled. `consumes`: it surely takes some.
        is_plain: with so many tokens it is not disabled, if all are equal.
        constants: all the tokens that it demands; None: these depend on its variables.
    """

    takes: bool = False
    tests: bool = False
    puts: bool = False
    inhibits: bool = False
    clears: bool = False
    least: int = 0
    consumes: bool = False
    is_plain: bool = True
    constants: frozenset[core.Exp] | None = frozenset()

    @property
    def demands(self) -> bool:
        """Whether tokens of the place are needed."""
        return self.takes or self.tests

    @property
    def changes(self) -> bool:
        """Whether the place may hold something else afterwards."""
        return self.takes or self.puts or self.clears

    def keep(self) -> None:
        """It puts what it takes: it only tests it."""
        self.tests = True
        self.takes = self.puts = self.consumes = False

    def add(self, arc: FlatArc) -> None:
        """One more arc."""
        self.takes |= arc.kind is ArcKind.INPUT
        self.tests |= arc.kind is ArcKind.BOTH
        self.puts |= arc.kind is ArcKind.OUTPUT
        self.inhibits |= arc.kind is ArcKind.INHIBITOR
        self.clears |= arc.kind is ArcKind.RESET
        if arc.kind not in _TAKING:
            return
        own = _taken_constants(arc)
        self.constants = None if own is None or self.constants is None else self.constants | own
        counts = [
            _count(arc, i) for i in range(len(arc.inscription.terms if arc.inscription else ()))
        ]
        self.is_plain &= bool(counts) and None not in counts
        least = sum(n or 0 for n in counts)
        self.least = max(self.least, least)
        self.consumes |= arc.kind is ArcKind.INPUT and least > 0


def _taken_constants(arc: FlatArc) -> frozenset[core.Exp] | None:
    assert arc.inscription is not None
    terms = arc.inscription.terms
    if not terms or any(t.whole or not _is_constant(t.value) for t in terms):
        return None
    return frozenset(t.value for t in terms)


def _is_constant(e: core.Exp) -> bool:
    """Whether two of these are the same value only if they are equal."""
    if isinstance(e, core.Con):
        return not e.constructor.has_argument
    return isinstance(e, core.Lit) and isinstance(e.value, int | str)


def _count(arc: FlatArc, index: int) -> int | None:
    """How many tokens a term takes; None: that depends."""
    assert arc.inscription is not None
    term = arc.inscription.terms[index]
    coefficient = term.coefficient
    if (
        term.whole
        or not isinstance(coefficient, core.Lit)
        or not isinstance(coefficient.value, int)
    ):
        return None
    return max(coefficient.value, 0)


@frozen
class Member:
    """A transition in a stubborn set, and what belongs to the set with it.

    Args:
        is_spoiling: its occurrence may enable a more urgent transition, or close a cycle: where it is enabled, the set
            is not used.
        rivals: when it is enabled.
        helpers: when it is disabled, and none of the `reasons` is known to be why.
    """

    is_spoiling: bool
    rivals: tuple[int, ...]
    helpers: tuple[int, ...]
    reasons: tuple[Reason, ...]


@frozen
class Dependency:
    """The table.

    Args:
        places: their number.
        members: by transition.
    """

    places: int
    members: tuple[Member, ...]

    def text(self) -> str:
        """In the form that the explorer reads: numbers, in lines for people."""
        return "\n".join(self._lines()) + "\n"

    def _lines(self) -> Iterator[str]:
        yield MAGIC
        yield row(self.places, len(self.members))
        for m in self.members:
            yield row(int(m.is_spoiling), *listed(m.rivals))
            yield row(*listed(m.helpers))
            yield from reason_rows(m.reasons)
        yield END


def dependency(net: FlatNet) -> Dependency:
    """The table of a net.

    Raises:
        NotPossibleError: something stands in the way.
    """
    effects = effects_of(net.program)
    check(net, effects)
    found = _Relation(net, effects, relations(net))
    return Dependency(len(net.places), tuple(map(found.member, net.transitions)))


def check(net: FlatNet, effects: Effects) -> None:
    """Refuses nets of which the transitions see more than their places and references.

    Raises:
        NotPossibleError: something stands in the way.
    """
    if net.timed:
        raise NotPossibleError("the net is timed")
    if len(net.transitions) > MOST_TRANSITIONS:
        raise NotPossibleError(f"the net has more than {MOST_TRANSITIONS:,} transitions")
    for t in net.transitions:
        own = effects.of(t.guards, *occurring(t))
        why = next((e for e in OUTSIDE if e in own), None)
        if why is not None:
            raise NotPossibleError(f"transition `{t.name}` {why.value}")


@record
class _Reach:
    """What a transition does with references."""

    searches: bool
    reads: bool
    writes: bool


@record
class Touching:
    """The transitions at a place, each with what it does there."""

    uses: dict[int, Use] = field(default_factory=dict)

    def putting(self) -> Iterator[int]:
        """Those that put tokens."""
        return (t for t, u in self.uses.items() if u.puts)

    def removing(self) -> Iterator[int]:
        """Those that take tokens, or clear the place."""
        return (t for t, u in self.uses.items() if u.takes or u.clears)

    def changing(self) -> Iterator[int]:
        """Those after which it may hold something else."""
        return (t for t, u in self.uses.items() if u.changes)


class _Relation:
    def __init__(self, net: FlatNet, effects: Effects, known: Relations) -> None:
        self.net = net
        self.known = known
        self.single = [colours(p.colset) == 1 for p in net.places]
        datatypes = net.program.datatypes
        self.signed = [may_hold_reals(p.colset.type, datatypes) for p in net.places]
        self.uses: list[dict[int, Use]] = []
        self.at = [Touching() for _ in net.places]
        self.reach = [_reach(t, effects) for t in net.transitions]
        self.writers = [i for i, r in enumerate(self.reach) if r.writes]
        for t in net.transitions:
            own: dict[int, Use] = {}
            for arc in t.arcs:
                own.setdefault(arc.place, Use()).add(arc)
            for p in known.kept[t.index]:
                own[p].keep()
            self.uses.append(own)
            for p, use in own.items():
                self.at[p].uses[t.index] = use
        self.accesses: list[dict[int, Accesses]] = [self._accesses(t) for t in net.transitions]
        self.raises_nothing = [raises_nothing(t) for t in net.transitions]
        self.recurring = recurring(self.consumed(), len(net.transitions))

    def consumed(self) -> list[list[frozenset[int]]]:
        """Of each transition, for each place from which it surely takes tokens, those that put some there."""
        return [
            [frozenset(self.at[p].putting()) for p, use in own.items() if use.consumes]
            for own in self.uses
        ]

    def member(self, t: FlatTransition) -> Member:
        """What belongs to a set with a transition."""
        i = t.index
        return Member(
            self._spoils(t) or i in self.recurring,
            _sorted(self._rivals(i), i),
            _sorted(self._helpers(i), i),
            tuple(self._reasons(t)) if self.raises_nothing[i] else (),
        )

    def _accesses(self, t: FlatTransition) -> dict[int, Accesses]:
        places = self.known.single.intersection(self.uses[t.index])
        found = {p: accesses(self.net, t, p) for p in sorted(places)}
        return {p: a for p, a in found.items() if a is not None}

    def _rivals(self, i: int) -> Iterator[int]:
        for j in set(self._dependent(i)):
            # An exception in a search is raised although not all that is demanded is there.
            if not (self.raises_nothing[j] and self.known.exclude(i, j)):
                yield j

    def _dependent(self, i: int) -> Iterator[int]:
        """Those with which an enabled one does not commute, as far as arcs and references tell."""
        for p, use in self.uses[i].items():
            for j, other in self.at[p].uses.items():
                is_order_kept = self.signed[p] and (use.changes or other.changes)
                conflicts = self._conflicts(use, other, is_single=self.single[p])
                if is_order_kept or (conflicts and not self._updates(i, j, p)):
                    yield j
        if self.reach[i].writes:
            yield from (j for j, r in enumerate(self.reach) if r.reads or r.writes)
        elif self.reach[i].reads:
            yield from self.writers

    def _updates(self, i: int, j: int, place: int) -> bool:
        """Whether both replace or test the only token of a place, and commute there."""
        one, other = self.accesses[i].get(place), self.accesses[j].get(place)
        return one is not None and other is not None and commute(one, other)

    @staticmethod
    def _conflicts(mine: Use, other: Use, *, is_single: bool) -> bool:
        """Whether another one belongs to the set of an enabled one because of a place."""
        if mine.clears or other.clears:
            return True
        if (mine.inhibits and other.puts) or (other.inhibits and mine.puts):
            return True  # what inhibits one and is taken by the other never lets both be enabled
        if (mine.takes and other.demands) or (mine.tests and other.takes):
            asked, wanted = mine.constants, other.constants
            if asked is None or wanted is None or asked & wanted:
                return True
        return (
            mine.demands
            and other.puts
            and not (mine.is_plain and (is_single or mine.constants is not None))
        )

    def _helpers(self, i: int) -> Iterator[int]:
        for p, use in self.uses[i].items():
            if use.demands:
                yield from (j for j in self.at[p].putting() if self._may_help(i, j, p))
            if use.inhibits:
                yield from self.at[p].removing()
        if self.reach[i].searches:
            yield from self.writers

    def _may_help(self, i: int, j: int, place: int) -> bool:
        """Whether what the second one does at a place may enable the first."""
        one, other = self.accesses[i].get(place), self.accesses[j].get(place)
        return one is None or other is None or is_moved_by(one, other)

    def _reasons(self, t: FlatTransition) -> Iterator[Reason]:
        for p, use in self.uses[t.index].items():
            if use.demands and use.least > 0:
                more = (j for j in self.at[p].putting() if p in self.known.growing[j])
                yield Reason(p, use.least, _sorted(more, t.index))
            if use.inhibits:
                yield Reason(p, 0, _sorted(self.at[p].removing(), t.index))

    def _spoils(self, t: FlatTransition) -> bool:
        """Whether something more urgent may come to be enabled by an occurrence."""
        for p, mine in self.uses[t.index].items():
            for j, other in self.at[p].uses.items():
                is_urgent = self.net.transitions[j].priority < t.priority
                helps = (mine.puts and other.demands) or (
                    (mine.takes or mine.clears) and other.inhibits
                )
                if is_urgent and helps:
                    return True
        return self.reach[t.index].writes and any(
            r.searches and self.net.transitions[j].priority < t.priority
            for j, r in enumerate(self.reach)
        )


def recurring(consumed: Sequence[Sequence[frozenset[int]]], count: int) -> frozenset[int]:
    """Transitions of which at least one occurs in each cycle of the graph.

    What occurs in a cycle and takes tokens from a place needs another one (or itself) in it that puts some there.
    So a transition is in no cycle if nothing that is in one puts tokens into some place from which it takes. Of the
    others, each is followed back through one place, and some that lie on all ways round are picked.

    Args:
        consumed: of each transition, for each place from which it takes tokens, those that put some there.
        count: of the transitions.
    """
    left = set(range(count))
    while finite := {t for t in left if any(left.isdisjoint(made) for made in consumed[t])}:
        left -= finite
    found = {t for t in left if not consumed[t]}
    left -= found
    before: dict[int, set[int]] = {}
    for t in left:
        ways = sorted((sorted(made & left) for made in consumed[t]), key=len)
        before[t] = set(ways[0])
    while left:
        after: dict[int, int] = dict.fromkeys(left, 0)
        for t in left:
            before[t] &= left
            for made in before[t]:
                after[made] += 1
        ends = {t for t in left if not before[t] or not after[t]}
        if not ends:
            most = max(sorted(left), key=lambda t: len(before[t]) * after[t])
            found.add(most)
            ends = {most}
        left -= ends
    return frozenset(found)


def _sorted(found: Iterable[int], without: int) -> tuple[int, ...]:
    return tuple(sorted(set(found) - {without}))


def _reach(t: FlatTransition, effects: Effects) -> _Reach:
    demanded = [a.inscription.value for a in t.arcs if a.inscription and a.kind in _TAKING]
    searched = effects.of(t.guards, *demanded)
    occurs = effects.of(*occurring(t))
    return _Reach(
        searches=Effect.READ in searched,
        reads=Effect.READ in searched | occurs,
        writes=Effect.WRITE in searched | occurs,
    )


def raises_nothing(t: FlatTransition, apart: Collection[int] = ()) -> bool:
    """Whether no exception is raised while bindings are searched for, whatever the tokens are; `apart`: see below."""
    drawn = (s.symbol.colset for s in t.plan if isinstance(s, BindAll | BindRandom))
    if not all(c is not None and c.resolved.kind in _LISTED for c in drawn):
        return False  # what decides whether a value belongs to a subset may raise one
    return all(map(is_total, searched(t, apart)))


def searched(t: FlatTransition, apart: Collection[int] = ()) -> Iterator[core.Exp]:
    """What is worked out while bindings are searched for, but for some guards (by their numbers)."""
    yield from (g for i, g in enumerate(t.guards) if i not in apart)
    yield from (s.value for s in t.plan if isinstance(s, BindEquation) and s.guard not in apart)
    for a in t.arcs:
        if a.inscription is not None and a.kind in _TAKING:
            for term in a.inscription.terms:
                yield from (term.coefficient, term.value)
