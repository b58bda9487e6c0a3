"""Turns: which programs of a cell have to be looked at in a state, so that each run is seen in one of its orders.

    table = turns(net, owners, probes=probes)    # raises NotPossibleError with what stands in the way
    path.write_text(table.text())

Of a net whose transitions belong to *owners*, each of which chooses among its own by priority and order, the explorer
(cnative/src/explore/search/explore_turns.c) explores in a state v what some owners F do, and leaves the others for
later. What an owner does in a state is found by asking some of its transitions, one after the other, whether they are
enabled, and with which bindings. The set is closed: with F comes a set D of disabled transitions that must stay so,

  1  of each owner in F, for each transition that was asked:
     *enabled*: with it come its rivals of other owners: those that might disable it, give it another binding, or be
     disabled by it, and those that change a place, or one of a group of places, that it changes, too;
     if it can occur, those that it might enable as well: none of them may hold others back that would occur before it;
     *disabled*: with it comes what can end one reason for its being disabled;
  2  of each transition in D: what can end one reason for its being disabled.

"It comes" means: what is disabled (because a place lacks tokens, where it was not asked) joins D, the owner of anything
else joins F. So whatever the owners outside F do, and
as long as nothing in D occurs (and it cannot, it is disabled), each question of an owner in F keeps its answer, and
what this owner does could as well come first. F and D are a *strong stubborn set* (A. Valmari, *Stubborn sets for
reduced state space generation*, 1990; its enabled part is *persistent*, P. Godefroid, 1996): with D1, what comes after
others that are outside can come before them, and the others after it, with the same bindings, since no question of
theirs has another answer then; and with D2, what is enabled in F remains so.

What follows. Let s be a state that is explored, and r a run from there to a dead state. Some owner of F acts in r (it
can act in s, and could still act in the last state); a is the first such action, r = x a y. By D1 a x y is a run to the
same state, and a is explored. No action of x changes a place that a changes, or that is in a group with one. So *each
place, and each group, holds the same one after the other* in both runs. By induction on the length, for each run to a
dead state a run is explored with the same actions, in the same order for each owner, in which each place and each group
holds the same one after the other. And if a run goes on for ever one is explored that does (by D2). Therefore, **if no
cycle is explored**, no run goes on for ever, each can be continued to a dead state, and exactly the same are found:

* the dead states;
* for each place, and for each group of places, what it ever holds: bounds, also those of colours, and whatever is said
  of one state by a formula about places of one group;
* the actions, and with them transitions that never occur, messages, what one firing needs of memory, and exceptions (an
  exception is an action of its owner after which this owner does nothing);
* of each owner the states in which it finds itself when it acts, as far as places are its own;
* the length of the longest run.

If there is a cycle nothing is said, for then an action may be put off for ever (the *ignoring problem*): then the whole
space decides.

Where it is asked what one owner does in one go (the *leading* one: the firings of a supervisor's cycle), a state in
which it can do so is explored for it alone if F can be this owner alone, else in full. So all its steps are seen there.

Random numbers, files, clocks and the number of steps are seen by everybody, so nets that use them are refused, and so
are timed ones and those that change references.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence

from pn2code.base.frozen import frozen
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.semantics.evaluation.effects import Effect, effects_of
from pn2code.semantics.evaluation.references import occurring
from pn2code.structure.relations import Relations, relations
from pn2code.verify.exploring.dependency import (
    MOST_TRANSITIONS,
    OUTSIDE,
    Touching,
    Use,
    raises_nothing,
)
from pn2code.verify.exploring.elements import NotPossibleError
from pn2code.verify.exploring.table_rows import END, Reason, listed, reason_rows, row

MAGIC = "pn2code-turns 1"


@frozen
class Member:
    """What is known of a transition.

    Args:
        rivals: of other owners, that come with it where it is enabled.
        enables: of other owners, that it might enable, and that would then hold others of their owner back.
        taken: by place, how many tokens it surely takes, and puts none.
        helpers: what may enable it, where none of the `reasons` is known to be why it is disabled.
    """

    rivals: tuple[int, ...]
    enables: tuple[int, ...]
    taken: tuple[tuple[int, int], ...]
    helpers: tuple[int, ...]
    reasons: tuple[Reason, ...]


@frozen
class Turns:
    """The table.

    Args:
        places: their number.
        leading: the owner of which all steps are seen that it does in one go; None: none is.
        members: by transition.
    """

    places: int
    leading: int | None
    members: tuple[Member, ...]

    def text(self) -> str:
        """In the form that the explorer reads: numbers, in lines for people."""
        return "\n".join(self._lines()) + "\n"

    def _lines(self) -> Iterator[str]:
        yield MAGIC
        leading = 0 if self.leading is None else self.leading + 1
        yield row(self.places, len(self.members), leading)
        for m in self.members:
            yield row(*listed(m.rivals))
            yield row(*listed(m.enables))
            yield row(len(m.taken), *(n for pair in m.taken for n in pair))
            yield row(*listed(m.helpers))
            yield from reason_rows(m.reasons)
        yield END


def turns(
    net: FlatNet,
    owners: Sequence[int],
    *,
    probes: Collection[int] = (),
    firsts: Collection[int] = (),
    chosen: Collection[int] = (),
    groups: Sequence[Collection[int]] = (),
    leading: int | None = None,
) -> Turns:
    """The table of a net.

    Args:
        net: the net.
        owners: by transition.
        probes: transitions that never occur, but hold others of their owner back.
        firsts: transitions of which only the first binding element in order occurs.
        chosen: transitions of which, of each owner, only the first in order occurs that is enabled.
        groups: places of which it matters what they hold at the same time.
        leading: see `Turns`.

    Raises:
        NotPossibleError: something stands in the way.
    """
    _check(net)
    known = relations(net)
    found = _Relation(net, owners, frozenset(probes), groups, known)
    found.find_holding(frozenset(firsts), frozenset(chosen))
    return Turns(len(net.places), leading, tuple(map(found.member, net.transitions)))


def _check(net: FlatNet) -> None:
    effects = effects_of(net.program)
    if net.timed:
        raise NotPossibleError("the net is timed")
    if len(net.transitions) > MOST_TRANSITIONS:
        raise NotPossibleError(f"the net has more than {MOST_TRANSITIONS:,} transitions")
    for t in net.transitions:
        own = effects.of(t.guards, *occurring(t))
        why = next((e for e in (*OUTSIDE, Effect.WRITE) if e in own), None)
        if why is not None:
            raise NotPossibleError(f"transition `{t.name}` {why.value}")


class _Relation:
    def __init__(
        self,
        net: FlatNet,
        owners: Sequence[int],
        probes: frozenset[int],
        groups: Sequence[Collection[int]],
        known: Relations,
    ) -> None:
        self.net = net
        self.owners = owners
        self.known = known
        self.at = [Touching() for _ in net.places]
        self.uses: list[dict[int, Use]] = []
        for t in net.transitions:
            own: dict[int, Use] = {}
            for arc in t.arcs:
                own.setdefault(arc.place, Use()).add(arc)
            for p in own if t.index in probes else known.kept[t.index]:
                _only_tests(own[p])
            self.uses.append(own)
            for p, use in own.items():
                self.at[p].uses[t.index] = use
        self.together: dict[int, set[int]] = {}
        """by place: all that change one of a group with it"""
        self.holding: set[int] = set()
        """transitions that hold others of their owner back where they are enabled, or take their place"""
        for group in groups:
            changing = {t for p in group for t in self.at[p].changing()}
            for p in group:
                self.together.setdefault(p, set()).update(changing)

    def find_holding(self, firsts: frozenset[int], chosen: frozenset[int]) -> None:
        """Sets `holding`: not those that are never enabled together with what they would hold back.

        What may raise an exception while it is asked would stop its owner, or be asked no more.
        """
        own: dict[int, list[FlatTransition]] = {}
        for t in self.net.transitions:
            own.setdefault(self.owners[t.index], []).append(t)
        for ts in own.values():
            for t in ts:
                later = (
                    u
                    for u in ts
                    if u.priority > t.priority or (u is not t and {t.index, u.index} <= chosen)
                )
                is_harmless = t.index not in firsts and raises_nothing(t)
                if not is_harmless or not all(self._is_apart(t, u) for u in later):
                    self.holding.add(t.index)

    def _is_apart(self, t: FlatTransition, u: FlatTransition) -> bool:
        """Whether it makes no difference to the second one that the first is enabled."""
        return raises_nothing(u) and self.known.exclude(t.index, u.index)

    def member(self, t: FlatTransition) -> Member:
        """What comes with a transition."""
        i = t.index
        uses = self.uses[i]
        taken = ((p, u.least) for p, u in uses.items() if u.takes and not u.puts and u.least)
        return Member(
            rivals=self._others(i, self._rivals(i)),
            enables=self._others(i, self._enables(i)),
            taken=tuple(sorted(taken)),
            helpers=_sorted(self._helpers(i), i),
            reasons=tuple(self._reasons(i)) if raises_nothing(t) else (),
        )

    def _others(self, i: int, found: Iterable[int]) -> tuple[int, ...]:
        return tuple(sorted({j for j in found if self.owners[j] != self.owners[i]}))

    def _rivals(self, i: int) -> Iterator[int]:
        for p, use in self.uses[i].items():
            if use.changes:
                yield from self.together.get(p, ())
            yield from (j for j, other in self.at[p].uses.items() if _conflicts(use, other))

    def _enables(self, i: int) -> Iterator[int]:
        for p, use in self.uses[i].items():
            for j, other in self.at[p].uses.items():
                more = use.puts and other.demands
                fewer = (use.takes or use.clears) and other.inhibits
                if (more or fewer) and j in self.holding:
                    yield j

    def _helpers(self, i: int) -> Iterator[int]:
        for p, use in self.uses[i].items():
            if use.demands:
                yield from self.at[p].putting()
            if use.inhibits:
                yield from self.at[p].removing()

    def _reasons(self, i: int) -> Iterator[Reason]:
        for p, use in self.uses[i].items():
            if use.demands and use.least > 0:
                more = (j for j in self.at[p].putting() if p in self.known.growing[j])
                yield Reason(p, use.least, _sorted(more, i))
            if use.inhibits:
                yield Reason(p, 0, _sorted(self.at[p].removing(), i))


def _only_tests(use: Use) -> None:
    """What is taken is there afterwards; of a probe that never occurs, too."""
    use.tests |= use.takes
    use.takes = use.puts = use.consumes = use.clears = False


def _conflicts(mine: Use, other: Use) -> bool:
    """Whether another one comes with an enabled one because of a place."""
    if mine.changes and other.changes:
        return True  # what the place holds one after the other depends on their order
    if (mine.takes or mine.clears) and other.demands:
        return True  # it might be disabled
    if other.changes and mine.demands:
        return True  # it might disable, or give other bindings
    if mine.puts and other.inhibits:
        return True
    return (other.puts or other.clears) and mine.inhibits


def _sorted(found: Iterable[int], without: int) -> tuple[int, ...]:
    return tuple(sorted(set(found) - {without}))
