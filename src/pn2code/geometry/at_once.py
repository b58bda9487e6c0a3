"""What two programs do to parts at once: whether it comes to the same in both orders, as far as that can be known."""

from __future__ import annotations

import itertools

from pn2code.geometry.activities import Activity, Doing
from pn2code.geometry.contents import Contents, spot
from pn2code.geometry.doubts import APART, Doubt, Doubts
from pn2code.geometry.graph import CellGraph
from pn2code.geometry.legs import Stand
from pn2code.geometry.prisms import PartEvent
from pn2code.geometry.situation import Met, Situation


class AtOnce:
    """Looks at what is under way in situations, and notes doubts.

    Args:
        graph, doing: of the cell.
        doubts: gets what is not known.
        with_tables: robots with turntables.
    """

    def __init__(
        self, graph: CellGraph, doing: Doing, doubts: Doubts, with_tables: frozenset[str]
    ) -> None:
        self._graph, self._doing, self._doubts = graph, doing, doubts
        self._with_tables = with_tables
        self._owner_names = {o.index: o.name for o in graph.partition.owners}
        self._near: dict[tuple[int, int], list[tuple[str, PartEvent]]] = {}

    def look(self, number: int, here: Situation, under_way: dict[int, Activity]) -> None:
        """Looks at one situation, and what is under way in it, by element."""
        self._expect_order(number, here, under_way)
        self._expect_leant_on(number, under_way)
        if self._with_tables:
            self._expect_still(number, under_way)
            self._expect_none_between(number, under_way)

    def turned(self, here: Situation) -> tuple[Stand, ...]:
        """Where the arms stand that have turntables, or parts in their tools: parts can be there."""
        holders = {p.holder for p in here.contents.parts.present.values()}
        return tuple(s for s in here.stands if s.robot in self._with_tables or s.robot in holders)

    def _expect_order(self, number: int, here: Situation, under_way: dict[int, Activity]) -> None:
        """What two do to parts must come to the same in both orders; else it depends on how far each is.

        Parts of different kinds stand on each other, too.
        """
        handling = [(e, a) for e, a in under_way.items() if a.kinds]
        for (e, a), (f, b) in itertools.combinations(handling, 2):
            if self._graph.elements[e].owner == self._graph.elements[f].owner:
                continue
            if a.fault or b.fault or not self._commute(here, e, a, f, b):
                self._in_order(number, (e, a), (f, b))

    def _in_order(
        self, number: int, one: tuple[int, Activity], other: tuple[int, Activity]
    ) -> None:
        """Two come to something else in the other order."""
        (e, a), (f, b) = one, other
        if a.fault or b.fault:  # which is told
            self._doubts.because("order")
            return
        does = "; ".join(self._does_to_parts(x) for x in (one, other))
        names = f"{self._doubts.name(e)} and {self._doubts.name(f)}"
        says = f"one of {names} is impossible, or comes to something else, after the other: {does}"
        self._doubts.note("order", number, (e, f), says, APART)

    def _does_to_parts(self, one: tuple[int, Activity]) -> str:
        element, activity = one
        name = self._owner_names[self._graph.elements[element].owner]
        said = dict.fromkeys(m.says for m in activity.part_events if m.goes)
        if said:
            return ", ".join(said)
        kinds = " and ".join(f"`{k}`" for k in sorted(activity.kinds))
        return f"`{name}` has to do with {kinds}"

    def _commute(self, here: Situation, e: int, a: Activity, f: int, b: Activity) -> bool:
        first = self.again(here, f, b, a.after)
        second = self.again(here, e, a, b.after)
        return not (first.fault or second.fault) and first.after is second.after

    def again(
        self, here: Situation, element: int, activity: Activity, contents: Contents
    ) -> Activity:
        """The same from other parts."""
        owner = self._graph.elements[element].owner
        stand = activity.legs[0][0].start if activity.legs else None
        name = self._owner_names[owner]
        commands = self._graph.commands(element)
        return self._doing.of(name, commands, stand, contents, self.turned(here))

    def _expect_leant_on(self, number: int, under_way: dict[int, Activity]) -> None:
        """An arm stands while a clamp closes on the part in its tool; else it may be gone, or not be there yet."""
        leans = {robot: e for e, a in under_way.items() for robot in a.leans}
        for element, activity in under_way.items():
            owner = self._owner_names[self._graph.elements[element].owner]
            if owner in leans and any(leg.is_moving for leg, _ in activity.legs):
                says = f"a clamp closes on what `{owner}` holds, which moves meanwhile"
                self._doubts.note("order", number, (leans[owner], element), says, APART)

    def _expect_none_between(self, number: int, under_way: dict[int, Activity]) -> None:
        """What somebody else has put on a turntable half way through is there before or after; else it is not seen."""
        for element, activity in under_way.items():
            if activity.kinds and len(activity.between) > 2:
                owner = self._owner_names[self._graph.elements[element].owner]
                ends = _on_plates(activity.between[0], owner) | _on_plates(activity.after, owner)
                if any(_on_plates(c, owner) - ends for c in activity.between[1:-1]):
                    name = self._doubts.name(element)
                    says = (
                        f"half way through {name} there is a part on a plate or belt of another one"
                    )
                    do = "let it be put there and taken from there by two transitions"
                    self._doubts.note("order", number, (element,), says, do)

    def _expect_still(self, number: int, under_way: dict[int, Activity]) -> None:
        """Nobody handles a part on a turntable, or where that could take one, while another arm turns it."""
        for (e, a), (f, b) in itertools.permutations(under_way.items(), 2):
            if not b.part_events or not (a.turns or a.may_run):
                continue
            if self._graph.elements[e].owner == self._graph.elements[f].owner:
                continue
            if (a.number, b.number) not in self._near:
                self._near[a.number, b.number] = self._doing.part_events_near(a, b)
            found = self._near[a.number, b.number]
            if found:
                self._turning(number, (e, a), (f, b), found)

    def _turning(
        self,
        number: int,
        mover: tuple[int, Activity],
        other: tuple[int, Activity],
        found: list[tuple[str, PartEvent]],
    ) -> None:
        """One handles parts where a plate of another one moves."""
        (e, a), (f, _) = mover, other
        self._doubts.because("turning")
        if other[1].fault:  # which is told
            return
        sure = [(p, m) for p, m in found if p in m.plates and self._doing.moves_first(a, p)]
        is_sure = bool(sure)
        plate, event = (sure or found)[0]
        x, y, z = (f"{1000.0 * v:.0f}" for v in event.point)
        if is_sure:
            moves = self._doing.does(plate)
            says = f"{event.says} {event.goes} `{plate}` while that {moves}, at ({x}, {y}, {z}) mm"
        else:
            on = "can be" if plate in event.plates else "can come"
            says = (
                f"{event.says} at ({x}, {y}, {z}) mm, where `{plate}`, or what it takes along, {on} meanwhile: what "
                "becomes of parts depends on how far that is"
            )
        key = ("turning", *(self._graph.elements[i].transition for i in (f, e)))
        doubt = Doubt("turning", says, APART, Met(number, (f, e)), is_sure)
        self._doubts.tell(key, doubt)


def _on_plates(contents: Contents, but: str) -> set[str]:
    """What stands on turntables of others."""
    parts = contents.parts.present.values()
    return {spot(p) for p in parts if p.plate and p.carrier != but}
