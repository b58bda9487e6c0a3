"""A cell of which places are forgotten: how many parts wait on a tray, and which number a counter has.

    less = forgetful(partition, storage)    # None: the net has time
    less.net                                # places and transitions keep their numbers; arcs are left out

A cell has as many states as parts can be spread over trays; with the trays forgotten it has as many for 12 parts as for
1,000. The net that is left does all that the cell does, and more: it knows neither when a tray is empty nor when the
last part has gone, and nothing in it has a priority. So what holds in all of its runs holds in all runs of the cell; of
what is wrong in one of its runs nothing follows.

*Claim.* Let P be the forgotten places, and m| a marking m without its tokens there. To each run of the cell as it runs
(`running`) belongs a run of this net with the same transitions of robots and devices, with the same values, in the same
order. Wherever the former is in a state with marking m (of the places of the cell's net), the latter is in m|; and what
robots and devices can do in that state with which values is enabled in m|.

P are places that only transitions of the supervisor touch, none of them a channel, and no expression that goes with
them (of their arcs, of their initial marking) changes a reference, on which others may depend. Each run of the cell as
it runs is, without the steps of programs, an occurrence sequence of the closed net in which priorities count among the
transitions of an owner (`running`), hence one of the closed net without priorities. For each occurrence e that leads
there from m to m', by induction:

* *e is enabled in m|.* A transition asks the same of m and of m|, or less if it had arcs from P. A variable for which
  nothing is left that binds it takes all values of its colour set, among them the one that it has in e, since no
  variable takes others. (A place is not forgotten if such a colour set is large.) Guards are left out only if a
  variable is in them that takes no value any more.
* *It leads to m'|*, as it does the same to all other places, and to all references.
* A program may do less than the net: it has not seen a message yet, or does only the first of what is enabled. So what
  a robot can do in a state of the cell is enabled in m, and therefore, as it has no arcs from P, in m|.

Nets with time are left alone: a program may be late, which the net without programs does not show.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.cell.partition import SUPERVISOR, Partition
from pn2code.diagnostics import Diagnostics
from pn2code.ml.core.terms import Apply, Exp, RecordExp
from pn2code.net.binding import Parts, Planner
from pn2code.net.enumerable import size
from pn2code.net.flat import ArcKind, BindAll, BindRandom, BindStep, FlatNet, FlatTransition
from pn2code.net.terms import TermReader
from pn2code.net.uses import NetVariables
from pn2code.semantics.evaluation.effects import Effect, effects_of
from pn2code.structure import bounds

MANY = 3
"""Tokens that a place may hold to be forgotten."""
_MOST_VALUES = 64
"""Of a colour set: counters have more."""
_ROUNDS = 6


@frozen
class Forgetful:
    """A net that does more.

    Args:
        net: it; whole: the same with nothing forgotten.
        places: what is forgotten.
    """

    net: FlatNet
    whole: FlatNet
    places: frozenset[int]


def forgetful(partition: Partition, storage: Mapping[str, str]) -> Forgetful | None:
    """What is left; None: the net has time."""
    if partition.net.timed:
        return None
    alike = tuple(replace(t, priority=1000) for t in partition.net.transitions)
    whole = net = replace(partition.net, transitions=alike)
    candidates = _own_places(partition)
    chosen: frozenset[int] = frozenset()
    for _ in range(_ROUNDS):
        known = bounds(net, storage=storage)
        # Of a place for which no bound is left any more there might be any number of states.
        many = sorted(p for p in candidates - chosen if _is_large(net, p, known[p].bound))
        before = chosen
        for p in many:
            less = _without(whole, chosen | {p})
            if less is not None:
                chosen, net = chosen | {p}, less
        if chosen == before:
            break
    return Forgetful(net, whole, chosen)


def _own_places(partition: Partition) -> frozenset[int]:
    """Places that only transitions of the supervisor touch, and that are no channels."""
    others = {c.place for c in partition.channels}
    effects = effects_of(partition.net.program)
    others |= {
        p.index
        for p in partition.net.places
        if p.initial and Effect.WRITE in effects.of(p.initial[0])
    }
    for t, owner in zip(partition.net.transitions, partition.transition_owner, strict=True):
        if owner != SUPERVISOR:
            others |= {a.place for a in t.arcs}
    return frozenset(range(len(partition.net.places))) - others


def _is_large(net: FlatNet, place: int, bound: int | None) -> bool:
    """Whether a place holds many tokens, or one of many colours that is computed with."""
    touching = [a for t in net.transitions for a in t.arcs if a.place == place]
    if not touching:
        return False
    if bound is None or bound >= MANY:
        return True
    if size(net.places[place].colset, _MOST_VALUES) is not None:
        return False
    put = [a.inscription.value for a in touching if a.kind is ArcKind.OUTPUT and a.inscription]
    return any(map(_computes, put))


def _computes(value: Exp) -> bool:
    """Whether a value is no constant, nor a variable as it is."""
    match value:
        case Apply():
            return True
        case RecordExp(fields=fields):
            return any(_computes(v) for _, v in fields)
    return False


def _without(net: FlatNet, places: Collection[int]) -> FlatNet | None:
    """The net without the arcs of places; None: a variable would have no value, or a reference another one."""
    made: list[FlatTransition] = []
    for t in net.transitions:
        own = _less(net, t, places)
        if own is None:
            return None
        made.append(own)
    kept = tuple(replace(p, initial=None) if p.index in places else p for p in net.places)
    return replace(net, places=kept, transitions=tuple(made))


def _less(net: FlatNet, t: FlatTransition, places: Collection[int]) -> FlatTransition | None:
    """A transition without the arcs of places, and without guards that nothing is left for."""
    arcs = tuple(a for a in t.arcs if a.place not in places)
    if len(arcs) == len(t.arcs):
        return t
    variables = NetVariables(net.program.variables)
    gone = [a.inscription.value for a in t.arcs if a.place in places and a.inscription is not None]
    if Effect.WRITE in effects_of(net.program).of(*gone):
        return None
    lost = set(variables.of(*gone)) - {
        s for a in arcs if a.kind is not ArcKind.OUTPUT and a.inscription is not None
        for s in variables.of(a.inscription.value)
    }  # fmt: skip
    fewer = tuple(g for g in t.guards if not lost & set(variables.of(g)))
    for guards in dict.fromkeys((t.guards, fewer)):
        span = t.code.action.span if t.code is not None else None
        taken = [(a.kind, a.inscription) for a in arcs]
        parts = Parts(t.name, t.origin, taken, guards, t.delay, t.code, span)
        d = Diagnostics()
        terms = TermReader(net.program, variables, d)
        planned = Planner(variables, terms, frozenset(), d).plan(parts)
        if planned is not None and not d.has_errors:
            plan = _all_values(planned[1])
            return replace(t, arcs=arcs, guards=guards, variables=planned[0], plan=plan)
    return None


def _all_values(plan: Sequence[BindStep]) -> tuple[BindStep, ...]:
    """With all values of what would be drawn."""
    return tuple(BindAll(x.symbol) if isinstance(x, BindRandom) else x for x in plan)
