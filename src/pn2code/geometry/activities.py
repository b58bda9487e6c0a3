"""What a transition of a robot or device does, from where its arm stands and with the parts that are there then.

doing = Doing(planner, cell)
activity = doing.of("robot1", commands, stand, contents)
activity.legs                   # ((leg, contents while it lasts), ...)
activity.end, activity.after    # where the arm stands afterwards, and the parts
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cached_property, partial
from typing import TypeVar

from pn2code.base.frozen import frozen
from pn2code.geometry.activity import Activity
from pn2code.geometry.contents import Contents, parts_of, spot
from pn2code.geometry.legs import Leg, Planner, Stand
from pn2code.geometry.moved_plates import MovedPlates
from pn2code.geometry.pieces import ROUNDING
from pn2code.geometry.prisms import PartEvent, Prism, surface
from pn2code.geometry.shown import Shown
from pn2code.robot.active_motion import turned_by
from pn2code.robot.belts import told_to_run, until_stop
from pn2code.robot.clamps import (
    Held,
    Near,
    closes,
    closing,
    holding,
    nearest,
    on_nothing,
    taken_along,
)
from pn2code.robot.commands import CHANGES, Command, Handling, ToolAction
from pn2code.robot.ground import Ground
from pn2code.robot.lying import Trouble, overlap
from pn2code.robot.part import Part, PartChange, PartFault
from pn2code.robot.parts import Parts
from pn2code.robot.robot_cell import CellRobot, RobotCell
from pn2code.robot.transforms import Array, describe, matrix_of

_SLACKS = (0.0, ROUNDING, -ROUNDING)
_Done = TypeVar("_Done")


class Doing:
    """Works activities out, each once.

    Args:
        shown: where what is put down is looked at: does it overlap nothing? None: nowhere.
    """

    def __init__(self, planner: Planner, cell: RobotCell, shown: Shown | None = None) -> None:
        self.planner, self._cell, self._shown = planner, cell, shown
        self._known: dict[tuple[object, ...], Activity] = {}
        self._contents: dict[tuple[str, ...], Contents] = {}
        self._standing: dict[tuple[int, int], Activity] = {}
        self.activities: list[Activity] = []
        self._with_tables = frozenset(r.name for r in cell.moving if r.carrying)
        self.plates = MovedPlates(cell)
        self.start = self._kept(Parts(cell))

    def overlaps_at_start(self) -> list[tuple[Part, Trouble]]:
        """Parts of the start that are in something, or perhaps are: such a run ends before it begins."""
        if self._shown is None:
            return []
        parts = self.start.parts.present
        self._shown.show(parts.values())
        standing = [p for p in parts.values() if not p.holder]
        found = [(p, overlap(self._shown.backend, p.name, ROUNDING)) for p in standing]
        return [(part, trouble) for part, trouble in found if trouble is not None]

    def _kept(self, parts: Parts) -> Contents:
        key = tuple(sorted(spot(p) for p in parts.present.values()))
        if key not in self._contents:
            self._contents[key] = Contents(len(self._contents), parts)
        return self._contents[key]

    def standing(self, stand: Stand, contents: Contents) -> Activity:
        """An arm that does nothing."""
        key = (stand.number, contents.number)
        if key not in self._standing:
            leg = self.planner.standing(stand)
            self._standing[key] = self._added(Activity(0, ((leg, contents),), stand, contents))
        return self._standing[key]

    def of(
        self,
        owner: str,
        commands: tuple[Command, ...],
        stand: Stand | None,
        contents: Contents,
        others: tuple[Stand, ...] = (),
    ) -> Activity:
        """What an owner does on these commands.

        `others`: where arms with turntables, or with parts in their tools, stand meanwhile.
        """
        handles = any(isinstance(c, ToolAction) and c.handling is not None for c in commands)
        asked = self._with_tables if handles or owner in self._with_tables else frozenset()
        if stand is not None and any(closes(self._cell.robot(owner), c) for c in commands):
            asked |= {p.holder for p in contents.parts.present.values()}
        others = tuple(s for s in others if s.robot in asked)
        turned = tuple(s.number for s in others if s.robot != owner)
        key = (owner, commands, None if stand is None else stand.number, contents.number, turned)
        if key not in self._known:
            made = self._worked_out(owner, commands, stand, contents, others)
            self._known[key] = self._added(made)
        return self._known[key]

    def _added(self, a: Activity) -> Activity:
        made = replace(a, number=len(self.activities))
        self.activities.append(made)
        return made

    def _worked_out(
        self,
        owner: str,
        commands: tuple[Command, ...],
        stand: Stand | None,
        contents: Contents,
        others: tuple[Stand, ...],
    ) -> Activity:
        legs: list[tuple[Leg, Contents]] = []
        kinds = frozenset(
            c.handling.part
            for c in commands
            if isinstance(c, ToolAction) and c.handling is not None
        )
        turns: frozenset[str] = frozenset()
        may_run: frozenset[str] = frozenset()
        part_events: list[PartEvent] = []
        leans: frozenset[str] = frozenset()
        halfway: list[Contents] = []
        done = Activity(0, (), stand, contents, kinds=kinds)
        others = tuple(s for s in others if s.robot != owner)
        for command in commands:
            standing = others if stand is None else (*others, stand)
            if stand is not None:
                own = self._cell.robot(owner)
                if told := told_to_run(own, command):
                    may_run |= told
                    kinds |= frozenset(self._cell.parts)
                    done = replace(done, kinds=kinds)
                    ways = [
                        until_stop(own, parts_of(contents, standing, s), command) for s in _SLACKS
                    ]
                    command = ways[0]
                    if len(set(ways)) > 1 and not done.doubt:
                        nearly = f"`{min(told)}` runs past a part that is beyond its stop"
                        done = replace(done, doubt=_nearly(nearly), command=command)
                leg = self.planner.leg(stand, command)
                if leg.path is not None and leg.is_moving:
                    plates = turned_by(own, leg.path)
                    turns |= plates
                    line = turned_by(own, leg.path, own.belts)
                    done = self._turning(done, command, (plates, line), standing, contents)
                    if pulled := self._pulled(own, leg, plates, contents):
                        done = replace(done, fault=pulled, is_part=True, command=command, doubt="")
                    if done.fault:
                        legs = legs or [(self.planner.standing(stand), contents)]
                        break
                    part_events += self._beginning(plates, standing, contents)
                legs.append((leg, contents))
                if leg.fault is not None:
                    done = replace(done, fault=leg.fault.message, command=None, doubt="")
                    break
                stand = leg.end
                ran = turned_by(own, leg.path, own.belts) if leg.path is not None else None
                if ran:
                    before = contents
                    try:
                        contents, doubt = self._run_out(leg, ran, standing, contents)
                    except PartFault as fault:
                        done = replace(
                            done, fault=str(fault), is_part=True, command=command, doubt=""
                        )
                        break
                    if doubt and not done.doubt:
                        done = replace(done, doubt=doubt, command=command)
                    part_events += self._handed_on(ran, (*others, stand), before, contents)
                for held in closing(own, leg.start.q, leg.end.q):
                    kinds |= frozenset(self._cell.parts)
                    part_events.append(self._around_clamp(held))
                    near = self._nearest(held, contents, (*others, stand))
                    wrong = on_nothing(held, near)
                    done = replace(done, kinds=kinds)
                    if near.off > ROUNDING:
                        done = replace(done, fault=wrong, is_part=True, command=command, doubt="")
                    elif near.off > -ROUNDING and not done.doubt:
                        done = replace(done, doubt=_nearly(wrong), command=command)
                    if near.part is not None and near.part.holder:
                        leans |= {near.part.holder}
                if done.fault:
                    break
            else:
                halfway.append(contents)
            if isinstance(command, ToolAction) and command.handling is not None:
                tcp = None
                if stand is not None:
                    tcp = self._cell.robot(owner).T_world_base @ stand.T_base_tcp
                doing = _Handled(owner, command.handling, tcp, standing)
                try:
                    contents, doubt, event = self._handle(doing, contents)
                    part_events += event
                except PartFault as fault:
                    part_events += self._around(owner, command.handling, tcp)
                    done = replace(done, fault=str(fault), is_part=True, command=command, doubt="")
                    break
                if doubt and not done.doubt:
                    done = replace(done, doubt=doubt, command=command)
        return replace(
            done,
            legs=tuple(legs),
            end=stand,
            after=contents,
            turns=turns,
            may_run=may_run,
            part_events=tuple(part_events),
            leans=leans,
            halfway=tuple(halfway),
        )

    def _nearest(self, held: Held, contents: Contents, standing: tuple[Stand, ...]) -> Near:
        """The part that a clamp closes on."""
        parts = parts_of(contents, standing, 0.0)
        tcps = {s.robot: self._cell.robot(s.robot).T_world_base @ s.T_base_tcp for s in standing}
        there = [
            (p, tcps[p.holder] @ p.frame if p.holder else parts.world(p))
            for p in parts.present.values()
            if not p.is_tool
            if not p.holder or p.holder in tcps  # of one that moves nobody knows where it is
        ]
        return nearest(self._cell, held, there)

    def _around_clamp(self, held: Held) -> PartEvent:
        """Where a clamp closes on a part, whichever it is."""
        ground = Ground.of(self._cell)
        at = matrix_of(self._cell.places[held.clamp.place])[:3, 3]
        kinds = self._cell.parts.values()
        far = max((ground.radius(k.name) + k.tolerance for k in kinds), default=0.0)
        return PartEvent(
            (Prism.around(at[None], far),), f"`{held.name}` closes on a part", _point(at)
        )

    def _beginning(
        self, plates: frozenset[str], standing: tuple[Stand, ...], contents: Contents
    ) -> Iterator[PartEvent]:
        """Plates begin to move: what others take along must not stand on them then, nor theirs on others."""
        parts = parts_of(contents, standing, 0.0)
        ground = Ground.of(self._cell)
        for plate in sorted(plates):
            own = ground.plates[plate]
            riders = parts.riders(plate)
            prisms = [Prism.around(ground.corners_of(p.kind.name, parts.world(p))) for p in riders]
            frame = parts.plate_frame(plate)
            tops = [*surface(own), *(Prism.around(h.at(frame).corners) for h in own.hulls)]
            says = f"`{plate}` begins to move"
            at = _point(frame[:3, 3])
            yield PartEvent(tuple(prisms), says, at, goes="", surfaces=tuple(tops))

    def _run_out(
        self, leg: Leg, ran: frozenset[str], standing: tuple[Stand, ...], contents: Contents
    ) -> tuple[Contents, str]:
        """What belts have taken along, and why that is not known ("": it is). Raises PartFault: off their ends."""
        assert leg.path is not None
        device = self._cell.robot(leg.robot)
        stopped = leg.path.q(leg.path.duration)

        def run_out(parts: Parts) -> None:
            parts.stand(device.name, stopped)
            parts.run_out(ran)
            for axis in device.belts:
                plate = f"{device.name}/{axis.name}"
                if plate in ran:
                    parts.rewind(plate, device.T_world_plate(axis, leg.end.q))

        found, faults = _tried(contents, standing, run_out)
        return self._one_of(found, faults, f"`{min(ran)}` takes parts along")

    def _handed_on(
        self,
        ran: frozenset[str],
        standing: tuple[Stand, ...],
        before: Contents,
        contents: Contents,
    ) -> Iterator[PartEvent]:
        """Where belts have taken parts, as if they had been put there; on those of their line they stand as before."""
        parts = parts_of(contents, standing, 0.0)
        moved = {p.name for p in before.parts.present.values() if p.plate in ran}
        for part in parts.present.values():
            if part.name in moved and not part.holder:
                frame = parts.world(part)
                on = frozenset(parts.plates_under(part) - ran)
                says = f"`{min(ran)}` takes `{part.name}` along"
                prism = Prism.around(Ground.of(self._cell).corners_of(part.kind.name, frame))
                yield PartEvent((prism,), says, _point(frame[:3, 3]), on, "onto")

    def _prism(self, kind: str, frame: Array) -> Prism:
        """Around a part, and its frame, and as far as it can be off from where it is looked for."""
        return Prism.around(Ground.of(self._cell).corners_of(kind, frame), self._tolerance)

    @cached_property
    def _tolerance(self) -> float:
        return max((k.tolerance for k in self._cell.parts.values()), default=0.0)

    def _around(self, owner: str, handling: Handling, tcp: Array | None) -> Iterator[PartEvent]:
        """Where a part cannot be handled: around that, whichever it is and however it lies.

        Tools stand on no turntable.
        """
        if handling.effect not in CHANGES:
            frame = matrix_of(self._cell.places[handling.place]) if handling.place else tcp
            assert frame is not None, "only a tool handles parts where it is"
            kind = self._cell.parts[handling.part]
            far = 2.0 * Ground.of(self._cell).radius(kind.name) + self._tolerance
            says = f"`{owner}` {handling.effect} a part `{kind.name}`"
            at = frame[:3, 3]
            yield PartEvent((Prism.around(at[None], far),), says, _point(at))

    def _where(self, doing: _Handled, change: PartChange, before: Parts, after: Parts) -> PartEvent:
        """Where a part is handled, with what stands on it then."""
        handling, frame = doing.handling, matrix_of(change.pose)
        prisms = [self._prism(handling.part, frame)]
        if doing.tcp is not None:
            prisms.append(Prism.around(doing.tcp[None, :3, 3], self._tolerance))
            tool = after.tool_of(doing.owner)
            if tool:
                tip = self._cell.robot(doing.owner).of_tool(tool, doing.tcp)
                prisms.append(Prism.around(tip[None, :3, 3], self._tolerance))
        for other in after.settled:
            kind = (after.present.get(other.part) or before.present[other.part]).kind
            prisms.append(self._prism(kind.name, matrix_of(other.pose)))
        if handling.effect in ("takes", "removes"):
            plates, goes = {before.present[change.part].plate} - {""}, "from"
        else:
            plates, goes = after.plates_under(after.present[change.part]), "on"
        says = f"`{doing.owner}` {handling.effect} `{change.part}`"
        return PartEvent(tuple(prisms), says, _point(frame[:3, 3]), frozenset(plates), goes)

    def _pulled(self, own: CellRobot, leg: Leg, plates: frozenset[str], contents: Contents) -> str:
        """That a device takes a part along which a clamp of its own holds then; "": it does not."""
        if not own.axes.clamps:
            return ""
        for part, frame in taken_along(own, leg.start.q, contents.load(own.name), plates):
            for held in holding(self._cell, part.kind, frame):
                if held.device is own and held.holds(leg.start.q):
                    return held.words(own.name, part.name, leg.start.q)
        return ""

    def _turning(
        self,
        done: Activity,
        command: Command,
        turned: tuple[frozenset[str], frozenset[str]],
        standing: tuple[Stand, ...],
        contents: Contents,
    ) -> Activity:
        """Whether what stands on turntables stays there when they begin to turn: on these, of which some are belts."""
        plates, belts = turned
        for plate in sorted(plates):
            line = belts if plate in belts else frozenset()
            try:
                _, faults = _tried(contents, standing, partial(Parts.turn, plate=plate, line=line))
            except PartFault as fault:
                return replace(done, fault=str(fault), is_part=True, command=command, doubt="")
            if faults and not done.doubt:
                done = replace(done, doubt=_nearly(max(map(str, faults))), command=command)
        return done

    def _handle(
        self, doing: _Handled, contents: Contents
    ) -> tuple[Contents, str, tuple[PartEvent, ...]]:
        """What an action does to a part, why it is not known that it can ("": it can), and where; tools are nowhere.

        Raises PartFault if it cannot.
        """

        def handle(parts: Parts) -> PartChange:
            return parts.handle(doing.owner, doing.handling, doing.tcp)

        found, faults = _tried(contents, doing.standing, handle)
        change, parts = found[0]
        does = f"`{doing.owner}` {doing.handling.effect} `{change.part}`, or another one, or beside a turntable"
        after, doubt = self._one_of(found, faults, does)
        doubt = self._expect_unclamped(doing, change) or doubt
        where: tuple[PartEvent, ...] = ()
        if doing.handling.effect not in CHANGES:
            where = (self._where(doing, change, contents.parts, parts),)
        return after, self._expect_apart(doing, change, parts) or doubt, where

    def _expect_unclamped(self, doing: _Handled, change: PartChange) -> str:
        """Whether a part that leaves the cell is in no clamp that holds it.

        Gives why that is not known; "": it is so. Raises PartFault if it is not so.
        """
        if change.effect != "removes":
            return ""
        kind = self._cell.parts[doing.handling.part]
        doubt = ""
        for held in holding(self._cell, kind, matrix_of(change.pose)):
            own = next((s for s in doing.standing if s.robot == doing.owner), None)
            if own is None or held.device.name != doing.owner:
                # Another program moves it, perhaps meanwhile.
                does = f"`{doing.owner}` removes `{change.part}`"
                doubt = f"{does}: whether `{held.name}` has let go then is not followed"
            elif held.holds(own.q):
                raise PartFault(held.words(doing.owner, change.part, own.q, "removes"))
        return doubt

    def _one_of(
        self, found: list[tuple[_Done, Parts]], faults: list[PartFault], does: str
    ) -> tuple[Contents, str]:
        """What was tried has come to, and why that is not known ("": it is)."""
        kept = [self._kept(parts) for _, parts in found]
        if faults:
            return kept[0], _nearly(str(faults[0]))
        return kept[0], "" if len({c.number for c in kept}) == 1 else _nearly(does)

    def _expect_apart(self, doing: _Handled, change: PartChange, parts: Parts) -> str:
        """Whether a part that is put down overlaps nothing, as a run looks at it.

        Gives why that is not known; "": it is so. Raises PartFault if it is not so.
        """
        if self._shown is None or change.effect not in ("releases", "creates", "uncouples"):
            return ""
        self._shown.show(p for p in parts.present.values() if not p.holder)
        for stand in doing.standing:
            self._shown.backend.set_joints(stand.robot, stand.q)
        does = f"`{doing.owner}` releases `{change.part}`"
        if change.effect == "uncouples":
            does = f"`{doing.owner}` uncouples tool `{change.part}`"
        if change.effect == "creates":
            does = f"`{doing.owner}` puts `{change.part}` at `{doing.handling.place}`"
        doubt = ""
        riders = [c.part for c in parts.settled if c.effect == "releases"]
        for name in (change.part, *riders):
            trouble = overlap(self._shown.backend, name, ROUNDING)
            if trouble is None:
                continue
            what = does if name == change.part else f"{does} with `{name}` on it"
            if trouble.margin < -ROUNDING:
                raise PartFault(f"{what}, which {trouble.text}, part at {describe(change.pose)}")
            doubt = doubt or _nearly(f"{what}, which {trouble.text}")
        return doubt


@frozen(eq=False)
class _Handled:
    """Who handles a part, where its TCP is, and where arms with turntables stand."""

    owner: str
    handling: Handling
    tcp: Array | None
    standing: tuple[Stand, ...]


def _tried(
    contents: Contents, standing: tuple[Stand, ...], does: Callable[[Parts], _Done]
) -> tuple[list[tuple[_Done, Parts]], list[PartFault]]:
    """What is done to parts comes to, also as if what they stand on were a little further away, and a little nearer.

    Where these come to something else, it is not known. Raises PartFault if it can be done in none of these ways.
    """
    found: list[tuple[_Done, Parts]] = []
    faults: list[PartFault] = []
    for slack in _SLACKS:
        parts = parts_of(contents, standing, slack)
        try:
            found.append((does(parts), parts))
        except PartFault as fault:
            faults.append(fault)
    if not found:
        raise faults[0]
    return found, faults


def _point(at: Array) -> tuple[float, float, float]:
    x, y, z = map(float, at)
    return x, y, z


def _nearly(what: str) -> str:
    return f"{what}: that is as much as is permitted, to {1000.0 * ROUNDING:g} mm"
