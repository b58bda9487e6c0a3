"""The zones that a net does not guard: which transitions share them, and a place that would guard each, tried out.

zones = Zones(found, comparison, explore, refused)
zones.proposals(bad, touching)              # [Proposal(...)]
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Iterator, Sequence

from pn2code.cell.partition import Partition
from pn2code.geometry import mutex
from pn2code.geometry.activities import Activity
from pn2code.geometry.answers import Proposal, Rest, Served
from pn2code.geometry.apart import Apart
from pn2code.geometry.compare import Comparison
from pn2code.geometry.graph import CellGraph
from pn2code.geometry.legs import Leg
from pn2code.geometry.situation import ON_PLATE, Side, Situation
from pn2code.geometry.situations import Situations
from pn2code.geometry.where import at_rest, stands_at
from pn2code.geometry.words import listed, reason
from pn2code.robot.part import Part

Explore = Callable[[Partition], CellGraph | None]
Refused = Callable[[Partition], str]
"""What `generate` would say of a changed cell; "": nothing that it does not say of the cell as it is."""
Sides = tuple[Side, Side]
_NONE = (
    "no places of the supervisor are marked exactly while these robots are there: let it command each of them by a "
    "transition of its own, wait for the answer, and bring an arm out of the zone before it rests"
)
_STUCK = (
    "with it, states may have no way to the end that have one without it, as far as is known: mend first that some "
    "have none"
)
_RESTS = "no places of the supervisor are marked exactly while these are there"


class Zones:
    """Looks for places.

    Args:
        found: the situations of the cell as it is.
        comparison: of legs.
        explore: explores a changed cell; refused: asks what `generate` would say of it.
    """

    def __init__(
        self, found: Situations, comparison: Comparison, explore: Explore, refused: Refused
    ) -> None:
        self._cell = found.doing.planner.cell
        self._found, self._comparison, self._explore = found, comparison, explore
        self._refused = refused
        self._stuck = len(mutex.stuck(found.graph))

    def proposals(self, bad: Collection[Sides], touching: Sequence[Sides]) -> list[Proposal]:
        """One for each zone.

        Args:
            bad: pairs of sides that are not surely apart; touching: those that touch.
        """
        return [self._proposal(zone, bad) for zone in together(touching)]

    def _proposal(self, zone: frozenset[Side], bad: Collection[Sides]) -> Proposal:
        found, net = self._found, self._found.graph.partition.net
        arms = sorted({side[0] for side in zone})
        robots = tuple(map(found.name_of, arms))
        names = tuple(dict.fromkeys(net.transitions[t].name for _, t, _ in sorted(zone) if t >= 0))
        rests = tuple(dict.fromkeys(self._rest(side) for side in sorted(zone) if side[1] < 0))
        # What stands on a plate is there for whatever its owner does: that is a side of its own.
        whose = sorted({(s[0], s[1] == ON_PLATE) for s in zone})
        sides = [
            frozenset[int]().union(
                *(found.states[s] for s in zone if (s[0], s[1] == ON_PLATE) == own)
            )
            for own in whose
        ]
        name = mutex.free_name(net)
        tried = ""
        served = tuple(self._served(zone, None))
        for number, guard in enumerate(self._guards(sides)):
            if number == mutex.MOST_TRIED:
                break
            problem, says = self._tried(guard, name, zone, bad)
            if not problem:
                return Proposal(
                    robots,
                    names,
                    name if guard.place is None else net.places[guard.place].name,
                    tuple(net.transitions[h.transition].name for h in guard.takes),
                    tuple(net.transitions[h.transition].name for h in guard.gives),
                    tuple(net.places[g.place].name for g in guard.groups),
                    tuple(mutex.when(net, guard, h, takes=True) for h in guard.takes),
                    tuple(mutex.when(net, guard, h, takes=False) for h in guard.gives),
                    tuple(mutex.held_in_words(net, g) for g in guard.groups),
                    rests,
                    works=True,
                    says=says,
                    is_there=guard.place is not None,
                    served=served
                    if guard.place is None
                    else tuple(self._served(zone, guard.place)),
                    refused=self._refused(mutex.guarded(found.graph.partition, guard, name)),
                )
            tried = tried or f"{self._told(guard)}, does not help: {problem}"
        none = _RESTS if rests else _NONE
        says = f"no place that was tried helps; one that is {tried}" if tried else none
        return Proposal(robots, names, rests=rests, says=says, served=served)

    def _guards(self, sides: Sequence[frozenset[int]]) -> Iterator[mutex.Guard]:
        """First those by a place that is there."""
        graph = self._found.graph
        yield from itertools.islice(mutex.with_keepers(graph, sides), mutex.MOST_TRIED // 2)
        yield from mutex.guards(graph, sides, frozenset(s.state for s in self._found.situations))

    def _told(self, guard: mutex.Guard) -> str:
        """Who takes the token, and who gives it back."""
        net = self._found.graph.partition.net
        takes, gives = (
            listed(f"`{net.transitions[h.transition].name}`" for h in hands)
            for hands in (guard.takes, guard.gives)
        )
        return f"taken by {takes} and given back by {gives}" if gives else f"taken by {takes}"

    def _served(self, zone: frozenset[Side], only: int | None) -> Iterator[Served]:
        """The place whose token is away whenever some of the transitions are under way, but not for all of them."""
        graph, net = self._found.graph, self._found.graph.partition.net
        by_transition: dict[int, frozenset[int]] = {}
        for side in zone:
            if side[1] >= 0:
                before = by_transition.get(side[1], frozenset())
                by_transition[side[1]] = before | frozenset(self._found.states[side])
        for place in mutex.keepers(graph) if only is None else [only]:
            taken = {
                t for t, states in by_transition.items()
                if not any(graph.marked[s].get(place, 0) for s in states)
            }  # fmt: skip
            if taken and len(taken) < len(by_transition):
                yield Served(
                    net.places[place].name,
                    tuple(net.transitions[t].name for t in sorted(taken)),
                    tuple(net.transitions[t].name for t in sorted({*by_transition} - taken)),
                )
                return  # others are away for longer

    def _rest(self, side: Side) -> Rest:
        """Where who is at rest there rests."""
        arm, kind, number = side
        found = self._found
        if kind == ON_PLATE:
            part = found.riders[number]
            stands = (s.stands[arm] for s in found.situations if _has(s, part))
            stand = next(stands)
            where = at_rest(self._cell, part, stand)
            known = found.doing.start.parts.present.values()
            is_first = any((p.kind, p.plate) == (part.kind, part.plate) for p in known)
            thing = f"{part.kind.name} on {part.plate}"
            return Rest(found.robots[arm], where, is_first, thing)
        name = found.robots[arm]
        stands = (s.stands[arm] for s in found.situations)
        stand = next(s for s in stands if s.number == number)
        where = stands_at(self._cell.robot(name), stand)
        return Rest(name, where, found.situations[0].stands[arm].number == number)

    def _tried(
        self, guard: mutex.Guard, name: str, zone: frozenset[Side], bad: Collection[Sides]
    ) -> tuple[str, str]:
        """Why the net with the place is no better, "" if it is; and what was found."""
        before = self._found.graph
        graph = self._explore(mutex.guarded(before.partition, guard, name))
        if graph is None or graph.why or not graph.arcs:
            return "the cell with the place was not seen to its end", ""
        stuck = len(mutex.stuck(graph))
        if stuck > self._stuck:
            return (
                f"with it, {stuck:,} states have no way to the end, without it {self._stuck:,}",
                "",
            )
        if stuck and mutex.is_stuck_anew(before, graph, guard.place):
            return _STUCK, ""
        lost = mutex.fired(before) - mutex.fired(graph)
        if lost:
            return f"with it, `{before.partition.net.transitions[min(lost)].name}` never occurs", ""
        found = Situations(graph, self._found.doing, self._found.robots)
        found.explore()
        if found.why:
            return f"with it, {reason(found.why)}", ""
        if found.doubts:
            doubt = next(iter(found.doubts))
            return f"with it, {doubt.says}", ""
        if self._can_meet(found, zone, bad):
            return "with it, arms can still collide", ""
        if found.stopped:
            return (
                "with it, arms keep apart as far as runs get: a move is impossible, mend that first",
                "",
            )
        end = "the cell comes to its end from each of them"
        if not graph.partition.final_places:
            end = "there is no deadlock"
        if stuck:
            end = f"only states have no way to the end ({stuck:,}) that have none without it"
        return "", (
            f"tried: with it these arms keep apart in each of the {len(graph.arcs):,} states of the cell, and {end}"
        )

    def _can_meet(self, found: Situations, zone: frozenset[Side], bad: Collection[Sides]) -> bool:
        """Whether two of a zone are not surely apart, or others that were so before."""
        for pair, met in found.pairs.items():
            a, b = (found.doing.activities[number] for number in pair)
            whole = found.sides(a, b, met)
            for leg, other, apart in self._comparison.activities(a, b):
                if apart.outcome != "clear":
                    own = self._as_before(
                        sides_of(found, whole, (a, b), (leg, other), apart), found
                    )
                    if own not in bad or zone.issuperset(own):
                        return True
        return False

    def _as_before(self, sides: Sides, found: Situations) -> Sides:
        """Parts on plates have the numbers of the situations in which they are first."""
        one, other = (
            (*s[:2], self._found.number_of(found.riders[s[2]])) if s[1] == ON_PLATE else s
            for s in sides
        )
        return one, other


def _has(s: Situation, part: Part) -> bool:
    some = s.contents.parts.present.values()
    return any((p.kind, p.plate) == (part.kind, part.plate) for p in some)


def sides_of(
    found: Situations,
    sides: Sides,
    pair: tuple[Activity, Activity],
    legs: tuple[Leg, Leg],
    apart: Apart,
) -> Sides:
    """What touches of two arms: of one that rests it may be what stands on a plate of it."""
    if apart.where is None:
        return sides
    out = []
    for side, activity, leg, name in zip(
        sides, pair, legs, (apart.where.a, apart.where.b), strict=True
    ):
        contents = next((c for own, c in activity.legs if own is leg), None)
        if contents is not None:
            side = found.resting(side, name, leg, contents)
        out.append(side)
    return out[0], out[1]


def together(pairs: Sequence[Sides]) -> list[frozenset[Side]]:
    """Sides that hang together by pairs that touch."""
    groups: list[set[Side]] = []
    for pair in pairs:
        joined = set(pair)
        rest = []
        for group in groups:
            if group & joined:
                joined |= group
            else:
                rest.append(group)
        groups = [*rest, joined]
    return [frozenset(g) for g in groups]
