"""All situations of a cell: each state that it can come to, with where each arm stands and which parts are there.

    found = Situations(graph, doing, robots)
    found.explore()
    found.activities[number]        # the first situation in which it is under way, ...
    found.pairs[(4, 9)]             # and the first one in which both are, of two arms
    found.path_to(situation)        # the elements that lead there

Where an arm stands is where its last transition has left it; so a situation is a state of the cell, a place for each
arm, and the parts. Of what is under way in one nobody knows how far it is. What a sensor that sees the scene cannot say
then (`seeing`) does not occur.
"""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace

from pn2code.cell.partition import OwnerKind
from pn2code.geometry.activities import Activity, Doing
from pn2code.geometry.at_once import AtOnce
from pn2code.geometry.contents import Contents
from pn2code.geometry.doubts import Doubt, Doubts
from pn2code.geometry.graph import MOST_STATES, CellGraph
from pn2code.geometry.legs import Leg, Stand
from pn2code.geometry.part_names import like
from pn2code.geometry.seeing import Scene, Seeing
from pn2code.geometry.situation import ON_PLATE, Met, Side, Situation
from pn2code.robot.part import Part

_NO_ARM = 1000
MOST = 1_000_000
"""Situations that are looked at ..."""
MORE = 4
"""... or, where more states than usual were asked for, so many times these."""


class Situations:
    """Goes through them."""

    def __init__(self, graph: CellGraph, doing: Doing, robots: Sequence[str]) -> None:
        self.graph, self.doing = graph, doing
        self.robots = tuple(robots)
        self.situations: list[Situation] = []
        self._numbers: dict[tuple[object, ...], int] = {}
        self._from: list[tuple[int, int]] = []
        self.activities: dict[tuple[int, int], Met] = {}
        """by (activity, element or -1)"""
        self.pairs: dict[tuple[int, int], Met] = {}
        """by activities, of the earlier robot first"""
        self.beside: dict[tuple[int, int, str], Met] = {}
        """by (activity, leg of it, part that stands)"""
        self.states: dict[Side, set[int]] = {}
        """the states in which that is so"""
        self.riders: list[Part] = []
        """what stands on plates in some situation, the first of each kind on each plate"""
        self._rider: dict[tuple[str, str], int] = {}
        self._doubts = Doubts(graph)
        names = {o.name: o.index for o in graph.partition.owners}
        self._numbers_of = {r: i for i, r in enumerate(self.robots)}
        self._arm_of = {names[r]: i for i, r in enumerate(self.robots) if r in names}
        self._seen: set[tuple[object, ...]] = set()
        cell = doing.start.parts.cell
        tables = {r.name: r.carrying for r in cell.moving} if cell.kinds else {}
        with_tables = frozenset(name for name, own in tables.items() if own)
        self._at_once = AtOnce(graph, doing, self._doubts, with_tables)
        self._owner_names = {o.index: o.name for o in graph.partition.owners}
        self._acting = {
            o.index for o in graph.partition.owners if o.kind is not OwnerKind.SUPERVISOR
        }
        self._seeing = Seeing(graph, doing)

    def explore(self, more: Callable[[], None] = lambda: None) -> None:
        """Goes through all of them; `more` hears of each."""
        stands = tuple(self.doing.planner.home(r) for r in self.robots)
        self._number(self._begun(Situation(0, stands, self.doing.start)), -1, -1)
        todo = deque([0])
        is_large = len(self.graph.arcs) > MOST_STATES
        most = MORE * len(self.graph.arcs) if is_large else MOST
        while todo:
            number = todo.popleft()
            more()
            here = self.situations[number]
            under_way = self._under_way(here)
            if here.state not in self.graph.cut:  # else more may be under way
                self._note(number, here, under_way)
            for element, target in self.graph.arcs[here.state]:
                after = self._after(number, element, target, under_way)
                if after is None:
                    continue
                if len(self.situations) >= most and after.key not in self._numbers:
                    self._doubts.because("situations")
                    continue
                before = len(self.situations)
                found = self._number(after, number, element)
                if found == before:
                    todo.append(found)

    @property
    def why(self) -> str:
        """Why not all is known; empty: all is."""
        return self._doubts.why

    @property
    def doubts(self) -> Collection[Doubt]:
        """What keeps it from being known."""
        return self._doubts.told.values()

    @property
    def sees(self) -> bool:
        """Whether what is done depends on what sensors see there."""
        return bool(self._seeing)

    @property
    def stopped(self) -> bool:
        """Whether runs stop at something impossible, so that nobody has gone through what would come after it."""
        return any(self.doing.activities[number].fault for number, _ in self.activities)

    def path_to(self, situation: int) -> list[int]:
        """The elements that lead to a situation, from the start."""
        out = []
        while situation > 0:
            situation, element = self._from[situation]
            out.append(element)
        return out[::-1]

    def sides(self, a: Activity, b: Activity, met: Met) -> tuple[Side, Side]:
        """What two arms do."""
        one, other = met.elements
        return self._side(a, one), self._side(b, other)

    def _side(self, activity: Activity, element: int) -> Side:
        leg = activity.legs[0][0]
        arm = self.robots.index(leg.robot)
        if element < 0:
            return (arm, -1, leg.start.number)
        return (arm, self.graph.elements[element].transition, -1)

    def resting(self, side: Side, name: str, leg: Leg, contents: Contents) -> Side:
        """Of an arm what stands on a plate of it that stands, by a name of the collision library, whatever it does."""
        found = like(name, contents)
        if not found or self.doing.is_moved(leg, found[0].plate):
            return side
        return (side[0], ON_PLATE, self.number_of(found[0]))

    def number_of(self, part: Part) -> int:
        """Of the parts of its kind on its plate; -1: there are none."""
        return self._rider.get((part.kind.name, part.plate), -1)

    def at_once(self) -> Iterator[tuple[Side, Side]]:
        """What two programs do at once of which not all is known."""
        for doubt in self.doubts:
            if len(doubt.met.elements) == 2:
                one, other = (self._side_of(e) for e in doubt.met.elements)
                if one[0] != other[0]:
                    yield min(one, other), max(one, other)

    def _side_of(self, element: int) -> Side:
        e = self.graph.elements[element]
        return (self._arm_of.get(e.owner, _NO_ARM + e.owner), e.transition, -1)

    def name_of(self, arm: int) -> str:
        """Of an arm or device, also of one of which nothing moves."""
        return self.robots[arm] if arm < _NO_ARM else self._owner_names[arm - _NO_ARM]

    def _number(self, s: Situation, parent: int, element: int) -> int:
        if s.key not in self._numbers:
            self._numbers[s.key] = len(self.situations)
            self.situations.append(s)
            self._from.append((parent, element))
        return self._numbers[s.key]

    def _under_way(self, here: Situation) -> dict[int, Activity]:
        """By element: what can be under way."""
        out: dict[int, Activity] = {}
        for element, _ in self.graph.arcs[here.state]:
            if element in out:
                continue
            e = self.graph.elements[element]
            if e.is_step or e.owner not in self._acting:
                continue
            commands = self.graph.commands(element)
            if not commands or not self._was_told(here, element):
                continue
            if self.graph.outside.get(e.transition):
                self._outside(element, here)
            arm = self._arm_of.get(e.owner)
            stand = here.stands[arm] if arm is not None else None
            name = self._owner_names[e.owner]
            out[element] = self.doing.of(
                name, commands, stand, here.contents, self._at_once.turned(here)
            )
        return out

    def _after(
        self, number: int, element: int, target: int, under_way: dict[int, Activity]
    ) -> Situation | None:
        here = self.situations[number]
        activity = under_way.get(element)
        if not self._is_told(here, element, under_way):
            return None
        self._expect_kept(number, element, target, under_way)
        if activity is None:
            return self._begun(Situation(target, here.stands, here.contents, here.said), element)
        if activity.fault:
            return None
        stands, contents = self._done(here, element, activity)
        return self._begun(Situation(target, stands, contents, here.said), element)

    def _done(
        self, here: Situation, element: int, activity: Activity | None
    ) -> tuple[tuple[Stand, ...], Contents]:
        """Where arms and parts are when somebody has ended what it does."""
        if activity is None:
            return here.stands, here.contents
        stands = here.stands
        arm = self._arm_of.get(self.graph.elements[element].owner)
        if arm is not None and activity.end is not None:
            stands = (*stands[:arm], activity.end, *stands[arm + 1 :])
        return stands, activity.after

    # --- sensors that see the scene --------------------------------------------------------------

    def _scene(
        self,
        here: Situation,
        element: int,
        activity: Activity | None,
        under_way: dict[int, Activity],
    ) -> Scene:
        """What is there when an element asks; `activity`: what it has done by then."""
        owner = self.graph.elements[element].owner
        others = {
            a.number: a for e, a in under_way.items() if self.graph.elements[e].owner != owner
        }
        handles = activity is not None and bool(activity.kinds or activity.turns)
        stands, contents = self._done(here, element, activity)
        return Scene(stands, contents, handles, tuple(others[n] for n in sorted(others)))

    def _was_told(self, here: Situation, element: int) -> bool:
        """Whether sensors that were asked before the commands may have said what the element has."""
        owner = self.graph.elements[element].owner
        asked = self._seeing.asked(element) if self._seeing else ()
        return all((owner, x.sensor, x.value) in here.said for x in asked if x.first)

    def _is_told(self, here: Situation, element: int, under_way: dict[int, Activity]) -> bool:
        """Whether sensors may have said what the element has, which is about to occur."""
        if not self._seeing:
            return True
        asked = [x for x in self._seeing.asked(element) if not x.first]
        if asked:
            scene = self._scene(here, element, under_way.get(element), under_way)
            if any(x.value not in self._seeing.says(x.sensor, scene) for x in asked):
                return False
        return self._was_told(here, element)

    def _begun(self, here: Situation, element: int = -1) -> Situation:
        """With what sensors may say to those who ask before their commands, until they have done these.

        Who begins first sees nothing of what others begin, so what can be said grows from there.
        """
        if not self._seeing:
            return here
        owner = self.graph.elements[element].owner if element >= 0 else None
        asking = [
            (self.graph.elements[e].owner, x.sensor, e)
            for e, _ in self.graph.arcs[here.state]
            for x in self._seeing.asked(e)
            if x.first
        ]
        asked = {(o, sensor) for o, sensor, _ in asking}
        said = frozenset(x for x in here.said if x[0] != owner and x[:2] in asked)
        while True:
            here = replace(here, said=said)
            under_way = self._under_way(here) if asking else {}
            for o, sensor, e in asking:
                scene = self._scene(here, e, None, under_way)
                said |= {(o, sensor, value) for value in self._seeing.says(sensor, scene)}
            if said == here.said:
                return here

    def _expect_kept(
        self, number: int, element: int, target: int, under_way: dict[int, Activity]
    ) -> None:
        """What is under way stays so, whatever others do; else more could be under way than is seen."""
        e = self.graph.elements[element]
        if e.is_end or not under_way or target in self.graph.cut:
            return
        there: set[int] | None = None
        for other in under_way:
            if self.graph.elements[other].owner == e.owner:
                continue
            there = there if there is not None else {x for x, _ in self.graph.arcs[target]}
            if other not in there:
                says = f"when {self._doubts.name(element)} occurs, {self._doubts.name(other)} cannot any more"
                do = (
                    "let nothing but its own program take away what a transition with commands waits for, and let it "
                    "have one binding at a time"
                )
                self._doubts.note("overtaken", number, (other, element), says, do)

    def _note(self, number: int, here: Situation, under_way: dict[int, Activity]) -> None:
        busy: set[int] = set()
        for element in under_way:
            doing = self.graph.elements[element]
            arm = self._arm_of.get(doing.owner)
            if arm is not None:
                busy.add(arm)
            own = _NO_ARM + doing.owner if arm is None else arm
            self.states.setdefault((own, doing.transition, -1), set()).add(here.state)
        for arm, stand in enumerate(here.stands):
            if arm not in busy:
                self.states.setdefault((arm, -1, stand.number), set()).add(here.state)
        self._note_riders(here)
        key = (
            tuple(sorted((e, a.number) for e, a in under_way.items())),
            tuple(s.number for s in here.stands),
            here.contents.number,
        )
        if key in self._seen:
            return
        self._seen.add(key)
        by_arm: list[list[tuple[int, Activity]]] = [[] for _ in self.robots]
        for element, activity in under_way.items():
            owner = self._arm_of.get(self.graph.elements[element].owner)
            self.activities.setdefault((activity.number, element), Met(number, (element,)))
            if owner is not None:
                by_arm[owner].append((element, activity))
        for arm, stand in enumerate(here.stands):
            if (
                not by_arm[arm] or self.graph.wider
            ):  # of a net that does more it may be idle as well
                activity = self.doing.standing(stand, here.contents)
                by_arm[arm].append((-1, activity))
                self.activities.setdefault((activity.number, -1), Met(number, (-1,)))
        for one, other in itertools.combinations(by_arm, 2):
            for (e, a), (f, b) in itertools.product(one, other):
                self.pairs.setdefault((a.number, b.number), Met(number, (e, f)))
        self._note_parts(number, here, under_way, by_arm)
        self._note_put_down(number, here, under_way)
        self._at_once.look(number, here, under_way)

    def _note_riders(self, here: Situation) -> None:
        """What stands on plates, whatever their owners do."""
        for part in here.contents.parts.present.values():
            if part.plate and part.carrier in self._numbers_of:
                known = self._rider.setdefault((part.kind.name, part.plate), len(self.riders))
                if known == len(self.riders):
                    self.riders.append(part)
                side = (self._numbers_of[part.carrier], ON_PLATE, known)
                self.states.setdefault(side, set()).add(here.state)

    def _note_parts(
        self,
        number: int,
        here: Situation,
        under_way: dict[int, Activity],
        by_arm: list[list[tuple[int, Activity]]],
    ) -> None:
        """Parts that stand while arms move: those that are there, and those that others put there meanwhile."""
        if not self.doing.start.parts.cell.kinds:
            return
        own = here.contents.standing
        for acts in by_arm:
            for element, activity in acts:
                owner = self.graph.elements[element].owner if element >= 0 else None
                added: set[str] = set()
                for other, doing in under_way.items():
                    if self.graph.elements[other].owner != owner:
                        for contents in doing.between:
                            added |= contents.standing.keys() - own.keys()
                for i, (_, contents) in enumerate(activity.legs):
                    for where in contents.standing.keys() | added:
                        self.beside.setdefault((activity.number, i, where), Met(number, (element,)))

    def _note_put_down(self, number: int, here: Situation, under_way: dict[int, Activity]) -> None:
        """What is put down while somebody else is half way through with other parts: these may not be there, or be.

        What comes before and after all that the other one does is a situation of its own.
        """
        handling = [(e, a) for e, a in under_way.items() if a.kinds]
        for (e, a), (f, b) in itertools.permutations(handling, 2):
            if self.graph.elements[e].owner == self.graph.elements[f].owner or a.fault:
                continue
            halfway = {c.number: c for c in b.between[1:-1]}
            for contents in halfway.values():
                if contents not in (b.between[0], b.after):
                    again = self._at_once.again(here, e, a, contents)
                    if again.is_part or again.doubt:
                        self.activities.setdefault((again.number, e), Met(number, (e, f)))

    def _outside(self, element: int, here: Situation) -> None:
        """What an element has told depends on more than tokens."""
        self._doubts.because("outside")
        if here.key in self._numbers:  # else it will be
            says = f"what {self._doubts.name(element)} tells its robot depends on more than tokens"
            do = "let the net decide it by a token, or by a sensor"
            self._doubts.note("outside", self._numbers[here.key], (element,), says, do)

    def parts(self) -> dict[str, Part]:
        """Each part that ever stands somewhere, by its spot."""
        out = dict(self.doing.start.standing)
        for activity in self.doing.activities:
            for contents in activity.between:
                out |= contents.standing
        return out
