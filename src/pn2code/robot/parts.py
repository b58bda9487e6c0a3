"""Parts in a run: where each is, who carries it, and what an action of a tool or device does to it.

    parts = Parts(cell)
    parts.stand("left", q)                                                      # where its turntables are now
    done = parts.handle("robot1", Handling("takes", "blank"), T_world_tcp)      # PartChange; PartFault if it cannot be
    parts.turn("left/plate")                                                    # PartFault if something would fall off

Parts have the name of their kind and a number, in the order in which they come into the cell. A part that is carried
keeps its place in the tool, one that stands on a turntable its place on the plate. What a part stands on is worked out
from the scene as it is then (`ground`); what it overlaps is the backend's to say.
"""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field, replace

import numpy as np

from pn2code.robot.commands import CHANGES, Handling
from pn2code.robot.ground import REST_GAP, Ground, Rest
from pn2code.robot.part import Part, PartChange, PartFault, carried_to
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.tool_change import tool_in_use, why_not_coupled, why_not_uncoupled
from pn2code.robot.transforms import Array, describe, difference, inverse, matrix_of, pose_of


@dataclass(slots=True)
class Parts:
    """All parts of a cell; begins with those that are there at the start.

    Args:
        turning: turntables that turn just now, on which nothing can be handled.
        slack: m, by how much a part that is handled, and what it stands on, may be off from what is asked for.
        settled: parts that now turn with another turntable, or with none, because of what was taken away last.
    """

    cell: RobotCell
    present: dict[str, Part] = field(default_factory=dict)
    turning: frozenset[str] = frozenset()
    slack: float = 0.0
    settled: tuple[PartChange, ...] = ()
    _plates: dict[str, Array] = field(init=False)
    _numbers: dict[str, Iterator[int]] = field(init=False)

    def __post_init__(self) -> None:
        """Puts the parts of the start into the cell."""
        self._plates = {}
        for robot in self.cell.moving:
            self.stand(robot.name, robot.home)
        self._numbers = {kind: itertools.count(1) for kind in self.cell.parts}
        for kind in self.cell.parts.values():
            for pose in kind.at:
                self._add(kind, matrix_of(pose))
        begins = {r.begins_with: r.name for r in self.cell.robots if r.begins_with}
        for name, tool in self.cell.tools.items():
            holder = begins.get(name, "")
            frame = np.eye(4) if holder else matrix_of(self.cell.places[tool.rack])
            self.present[name] = Part(name, tool, frame, holder)
        self._settle()

    @property
    def _ground(self) -> Ground:
        return Ground.of(self.cell)

    def _settle(self) -> None:
        """Parts of the start that stand on a turntable, or on others that do, turn with it."""
        found = True
        while found:
            found = False
            for part in self._work():
                plate = "" if part.carrier else self._plate_under(part)
                if plate and plate not in self.turning:
                    self._keep(part, self.world(part), plate)
                    found = True

    def _settle_again(self) -> None:
        """The same when something was taken away, on which parts stood.

        What turns just now keeps what is on it, and gets no more.
        """
        before = dict(self.present)
        for part in before.values():
            if part.plate and part.plate not in self.turning:
                self._keep(part, self.world(part), "")
        self._settle()
        for name, old in before.items():
            part = self.present[name]
            if part.plate == old.plate:
                self.present[name] = old
                continue
            on = self.rest(part).on
            on_plate = pose_of(part.frame) if part.plate else None
            pose = pose_of(self.world(part))
            self.settled += (PartChange("settles", name, pose, on, part.plate, on_plate),)

    def copy(self, slack: float = 0.0) -> Parts:
        """The same parts, to be handled otherwise; a new one gets the first number that none has."""
        out = copy.copy(self)
        out.present = dict(self.present)
        out.slack = slack
        out._plates = dict(self._plates)
        out._numbers = {}
        used = [p.name.rsplit(".", 1) for p in self._work()]
        for kind in self.cell.parts:
            last = max((int(number) for own, number in used if own == kind), default=0)
            out._numbers[kind] = itertools.count(last + 1)
        return out

    def stand(self, robot: str, q: Sequence[float] | Array) -> None:
        """A robot is at this joint position now: where its turntables are counts for what is handled."""
        own = self.cell.robot(robot)
        for axis in own.carrying:
            self._plates[f"{robot}/{axis.name}"] = own.T_world_plate(axis, q)

    def held_by(self, robot: str) -> Part | None:
        """The part that a robot carries; others may stand on it."""
        held = (p for p in self._work() if p.holder == robot and p.up is None)
        return next(held, None)

    def _work(self) -> list[Part]:
        """All that are no tools."""
        return [p for p in self.present.values() if not p.is_tool]

    def tool_of(self, robot: str) -> str:
        """The name of the tool that a robot has in use; "": none."""
        found = tool_in_use(self.present.values(), robot)
        return found.name if found is not None else ""

    def world(self, part: Part) -> Array:
        """`T_world_part` of a part that stands."""
        assert not part.holder, "where a part in a tool is, is the robot's to say"
        return self._plates[part.plate] @ part.frame if part.plate else part.frame

    def everywhere(self, joints: Mapping[str, Array]) -> list[tuple[Part, Array]]:
        """All parts, but no tools, with where they are in the world; `joints`: of the robots that hold some."""
        return [
            (p, carried_to(self.cell.robot(p.holder), joints[p.holder], p))
            if p.holder
            else (p, self.world(p))
            for p in self._work()
        ]

    def _grip(self, robot: str, tcp: Array) -> Array:
        """`T_world_tcp` of the tool that a robot has in use, with its own, the coupling, at `tcp`."""
        tool = self.tool_of(robot)
        return self.cell.robot(robot).of_tool(tool, tcp) if tool else tcp

    def plate_frame(self, plate: str) -> Array:
        """`T_world_plate` of a turntable, where it is now."""
        return self._plates[plate]

    def riders(self, plate: str) -> list[Part]:
        """What turns with a turntable."""
        return [p for p in self.present.values() if p.plate == plate]

    def rest(self, part: Part, without: Collection[str] = ()) -> Rest:
        """How a part stands, also if others were not there."""
        others = [
            (p.name, p.kind, self.world(p))
            for p in self.present.values()
            if isinstance(p.kind, PartKind)
            and not p.holder
            and p.name != part.name
            and p.name not in without
        ]
        kind = part.kind
        assert isinstance(kind, PartKind), "tools are in their racks"
        return self._ground.rest(kind, self.world(part), others, self._plates, self.slack)

    def turn(self, plate: str, line: frozenset[str] = frozenset()) -> None:
        """A turntable or belt begins to move. Raises PartFault if something on it would not go with it.

        `line`: the belts that run as one with it.
        """
        riders = self.riders(plate)
        self._expect_alone(plate, riders, line)
        if not riders:
            return
        if not self._ground.plates[plate].upright:
            raise PartFault(
                f"`{plate}` turns about a line that is not upright, and `{riders[0].name}` only lies on it"
            )
        own = {plate, *line, *(p.name for p in self._riders_of({plate, *line}))}
        for part in riders:
            off = [x for x in self.rest(part).on if x not in own]
            if off:
                raise PartFault(
                    f"`{plate}` {self._ground.plates[plate].does}, but `{part.name}` on it also stands on `{off[0]}`, "
                    "which does not"
                )

    def _riders_of(self, plates: Set[str]) -> Iterator[Part]:
        return (p for p in self.present.values() if p.plate in plates)

    def _expect_alone(self, plate: str, riders: list[Part], line: frozenset[str]) -> None:
        """Nothing that goes with another turntable or belt stands on this one as well."""
        own = {plate, *(p.name for p in riders)}
        for part in self.present.values():
            if part.plate in ("", plate, *line):
                continue
            on = sorted(own.intersection(self.rest(part).on))
            if on:
                raise PartFault(
                    f"`{plate}` {self._ground.plates[plate].does}, but `{part.name}` on `{part.plate}` also stands on "
                    f"`{on[0]}`"
                )

    def plates_under(self, part: Part) -> set[str]:
        """The turntables and belts on which a part stands, also by parts that do."""
        return self._plates_in(self.rest(part).on)

    def _plates_in(self, on: Iterable[str]) -> set[str]:
        """Those among what something stands on, and those with which it goes."""
        goes = {self.present[x].plate for x in on if x in self.present}
        return {x for x in on if x in self._plates} | goes - {""}

    def run_out(self, line: Set[str]) -> None:
        """Belts that have run as one come to rest. Raises PartFault if the middle of something has come off their end.

        Up to there they take it along, and it does not tip over on the way; beyond, nobody knows how far it goes.

        What stands on something else now is in `settled`.
        """
        self.settled = ()
        own = {p.name for p in self._riders_of(line)}
        for part in self._riders_of(line):
            does = f"`{part.plate}` takes `{part.name}` along until"
            rest = self.rest(part)
            if trouble := rest.trouble(self.slack):
                where = describe(pose_of(self.world(part)))
                raise PartFault(f"{does} it is {trouble}, part at {where}")
            off = min(self._beyond(belt, part) for belt in line)
            if off > self.slack and not own.intersection(rest.on):
                where = describe(pose_of(self.world(part)))
                plates = (x for x in rest.on if x in self._plates)
                other = next((f" (`{x}` does not run with it)" for x in plates), "")
                raise PartFault(
                    f"{does} its middle is {1000.0 * off:.1f} mm beyond the end, "
                    f"where nothing takes it further{other}, part at {where}"
                )
            self._expect_at_rest(f"`{part.plate}` takes `{part.name}` along", rest.on)
        self._settle_again()

    def _beyond(self, plate: str, part: Part) -> float:
        """How far (m) the middle of a part is beyond the end of a belt, negative: before it."""
        own = self._ground.plates[plate]
        kind = part.kind
        assert isinstance(kind, PartKind), "tools are on no belts"
        middle = self._ground.middle(kind, self.world(part))
        return float((inverse(own.T_world_axis) @ np.append(middle, 1.0))[0] - own.axis.upper)

    def rewind(self, plate: str, frame: Array) -> None:
        """The same belt with its beginning counted from where it is now: `T_world_plate` of that."""
        for part in self.riders(plate):
            self.present[part.name] = replace(part, frame=inverse(frame) @ self.world(part))
        self._plates[plate] = frame

    def handle(self, who: str, handling: Handling, T_world_tcp: Array | None) -> PartChange:
        """Does to a part what an action does at its end.

        Args:
            who: the robot or device, for messages.
            T_world_tcp: of the robot, of its coupling if it changes tools; None: a device.

        Raises PartFault when it is not possible; nothing has changed then.
        """
        self.settled = ()
        if handling.effect in CHANGES:
            assert T_world_tcp is not None, "only a robot changes tools"
            return self._change(who, handling, T_world_tcp)
        kind = self.cell.parts[handling.part]
        match handling.effect:
            case "takes":
                assert T_world_tcp is not None, "only a tool takes parts"
                return self._take(who, kind, T_world_tcp)
            case "releases":
                assert T_world_tcp is not None, "only a tool releases parts"
                return self._release(who, kind, T_world_tcp)
            case "creates":
                return self._create(who, kind, handling.place)
            case _:
                return self._remove(who, kind, handling.place)

    def _change(self, robot: str, handling: Handling, coupling: Array) -> PartChange:
        """A tool is coupled, and exactly at the coupling from then on; or it is left, exactly in its rack."""
        kind = self.cell.tools[handling.part]
        if handling.effect == "couples":
            why = why_not_coupled(self.present, robot, kind, coupling, self.slack)
            frame, holder = np.eye(4), robot
        elif not kind.rack:
            raise PartFault(f"`{robot}` uncouples tool `{kind.name}`, which has no place")
        else:
            frame, holder = matrix_of(self.cell.places[kind.rack]), ""
            why = why_not_uncoupled(self.present, robot, kind, coupling, frame, self.slack)
        if why:
            raise PartFault(why)
        pose = pose_of(self.present[kind.name].frame if holder else frame)
        self.present[kind.name] = Part(kind.name, kind, frame, holder)
        return PartChange(handling.effect, kind.name, pose)

    def _take(self, robot: str, kind: PartKind, tcp: Array) -> PartChange:
        held = self.held_by(robot)
        if held is not None:
            raise PartFault(
                f"`{robot}` takes a part `{kind.name}`, but its tool holds `{held.name}` already"
            )
        standing = [p for p in self.present.values() if p.kind is kind and not p.holder]
        grip = self._grip(robot, tcp)
        at = f"at TCP pose {describe(pose_of(grip))}"
        if not standing:
            held_by = (p for p in self.present.values() if p.kind is kind and p.holder)
            others = ", ".join(f"`{p.name}` is in the tool of `{p.holder}`" for p in held_by)
            more = f" that stands ({others}, and must be put down first)" if others else ""
            raise PartFault(
                f"`{robot}` grips air: there is no part `{kind.name}` to take{more}, {at}"
            )
        offs = {p.name: _off(kind, self.world(p), grip) for p in standing}
        near = self._nearest([(*offs[p.name], p) for p in standing])
        way, turn = offs[near.name]
        if way > kind.tolerance + self.slack or turn > kind.angle + self.slack:
            off = f"{1000.0 * way:.1f} mm"
            off += f" and {math.degrees(turn):.1f} deg" if turn > kind.angle else ""
            raise PartFault(
                f"`{robot}` grips air: the nearest part `{kind.name}`, `{near.name}`, is {off} from where it can be "
                f"gripped (at most {1000.0 * kind.tolerance:g} mm, {math.degrees(kind.angle):g} deg), {at}"
            )
        frame = self.world(near)
        riders, carries = self._lifted(f"`{robot}` takes `{near.name}`", near, at)
        back = inverse(tcp)
        frames = {p.name: self.world(p) for p in riders}
        if riders:
            goes = [(near, frame), *((p, frames[p.name]) for p in riders)]
            heavy = self.cell.robot(robot).overload_of(
                ((p.name, p.kind.mass, back @ own) for p, own in goes), self.tool_of(robot)
            )
            if heavy:
                on_it = " and ".join(f"`{p.name}`" for p in riders)
                raise PartFault(f"`{robot}` takes `{near.name}` with {on_it} on it: {heavy}, {at}")
        self.present[near.name] = Part(near.name, kind, back @ frame, robot)
        for part in riders:
            own = frames[part.name]
            up = own[2, :3].copy()
            self.present[part.name] = Part(part.name, part.kind, back @ own, robot, up=up)
            self.settled += (PartChange("takes", part.name, pose_of(own)),)
        if carries:
            self._settle_again()
        return PartChange("takes", near.name, pose_of(frame))

    def _release(self, robot: str, kind: PartKind, tcp: Array) -> PartChange:
        held = self.held_by(robot)
        if held is None or held.kind is not kind:
            what = f"`{held.name}`" if held else "nothing"
            grip = self._grip(robot, tcp)
            raise PartFault(
                f"`{robot}` releases a part `{kind.name}`, but its tool holds {what}, "
                f"at TCP pose {describe(pose_of(grip))}"
            )
        frame = tcp @ held.frame
        part = Part(held.name, kind, frame)
        rest = self.rest(part)
        if trouble := rest.trouble(self.slack):
            raise PartFault(
                f"`{robot}` releases `{part.name}` {trouble}, part at {describe(pose_of(frame))}"
            )
        before = dict(self.present)
        try:
            change = self._put_down(f"`{robot}` releases `{part.name}`", "releases", part, rest.on)
            self._put_riders(robot, part.name, tcp)
        except PartFault:
            self.present = before
            raise
        return change

    def _put_riders(self, robot: str, on: str, tcp: Array) -> None:
        """What stands on a part that has been put down stands there, with what that stands on."""
        riders = [p for p in self.present.values() if p.holder == robot and p.up is not None]
        for part in riders:
            self.present[part.name] = Part(part.name, part.kind, tcp @ part.frame)
        self._settle()
        for rider in riders:
            part = self.present[rider.name]
            pose = pose_of(self.world(part))
            rest = self.rest(part)
            if trouble := rest.trouble(self.slack):
                raise PartFault(
                    f"`{robot}` releases `{on}` with `{part.name}` on it, {trouble}, part at {describe(pose)}"
                )
            self._expect_at_rest(
                f"`{robot}` releases `{on}` with `{part.name}` on it,", rest.on, " also"
            )
            on_plate = pose_of(part.frame) if part.plate else None
            self.settled += (
                PartChange("releases", part.name, pose, rest.on, part.plate, on_plate),
            )

    def _create(self, who: str, kind: PartKind, place: str) -> PartChange:
        pose = self.cell.places[place]
        there = self._at(place, kind)
        if there is not None:
            raise PartFault(
                f"`{who}` puts a part `{kind.name}` at place `{place}`, but `{there.name}` is there"
            )
        part = Part(f"{kind.name}.{next(self._numbers[kind.name])}", kind, matrix_of(pose))
        does = f"`{who}` puts `{part.name}` at place `{place}`"
        return self._put_down(does, "creates", part, self.rest(part).on)

    def _put_down(self, does: str, effect: str, part: Part, on: tuple[str, ...]) -> PartChange:
        """A part stands from now on; `part` has its frame in the world."""
        plate = self._plate_of(on)
        self._expect_at_rest(does, on)
        kept = self._keep(part, part.frame, plate)
        on_plate = pose_of(kept.frame) if plate else None
        return PartChange(effect, part.name, pose_of(part.frame), on, plate, on_plate)

    def _expect_at_rest(self, does: str, on: Iterable[str], what: str = "") -> None:
        """What is put down does not stand on a turntable or belt that moves, or on what goes with one."""
        if moving := sorted(self.turning & self._plates_in(on)):
            plate = moving[0]
            raise PartFault(
                f"{does}{what} on `{plate}` while that {self._ground.plates[plate].does}"
            )

    def _remove(self, who: str, kind: PartKind, place: str) -> PartChange:
        there = self._at(place, kind)
        if there is None or there.kind is not kind:
            what = f"`{there.name}` is there" if there else "no part is there"
            raise PartFault(
                f"`{who}` removes a part `{kind.name}` from place `{place}`, but {what}"
            )
        frame = self.world(there)
        at = f"part at {describe(pose_of(frame))}"
        does = f"`{who}` removes `{there.name}` from place `{place}`"
        carries = self._expect_free(does, there, at)
        del self.present[there.name]
        if carries:
            self._settle_again()
        return PartChange("removes", there.name, pose_of(frame))

    def _expect_free(self, does: str, part: Part, at: str) -> bool:
        """A part can be taken away: it is not on the move, and nothing would fall without it.

        Gives whether others stand on it, and on something else as well.
        """
        if part.plate in self.turning:
            verb = self._ground.plates[part.plate].does
            raise PartFault(f"{does} from `{part.plate}` while that {verb}, {at}")
        carries = False
        place = self.world(part)[:3, 3]
        near = self._ground.radius(part.kind.name) + 2.0 * REST_GAP
        for other in self._work():
            if other.holder or other.name == part.name:
                continue
            off = float(np.linalg.norm(self.world(other)[:3, 3] - place))
            if off > near + self._ground.radius(other.kind.name):
                continue
            rest = self.rest(other)
            if part.name not in rest.on:
                continue
            carries = True
            without = self.rest(other, without=(part.name,))
            if not rest.trouble(self.slack) and without.trouble(self.slack):
                raise PartFault(f"{does}, but `{other.name}` stands on it, {at}")
        return carries

    def _lifted(self, does: str, part: Part, at: str) -> tuple[list[Part], bool]:
        """What goes along with a part that is taken: what stands on it, and would fall without it.

        Gives also whether others stand on any of these that stay, on something else.
        """
        if part.plate in self.turning:
            verb = self._ground.plates[part.plate].does
            raise PartFault(f"{does} from `{part.plate}` while that {verb}, {at}")
        lifted, is_new, carries = {part.name: part}, True, False
        while is_new:
            is_new = carries = False
            for other in self._work():
                if other.holder or other.name in lifted or not self._may_touch(other, lifted):
                    continue
                rest = self.rest(other)
                if lifted.keys().isdisjoint(rest.on):
                    continue
                carries = True
                falls = self.rest(other, without=lifted.keys()).trouble(self.slack)
                if falls and not rest.trouble(self.slack):
                    lifted[other.name] = other
                    is_new = True
        riders = list(lifted.values())[1:]
        for rider in riders:
            if off := [x for x in self.rest(rider).on if x not in lifted]:
                raise PartFault(f"{does}, but `{rider.name}` stands on it and on `{off[0]}`, {at}")
        return riders, carries

    def _may_touch(self, other: Part, some: Mapping[str, Part]) -> bool:
        """Whether a part is so near to one of others that it can stand on it."""
        place, own = self.world(other)[:3, 3], self._ground.radius(other.kind.name)
        return any(
            float(np.linalg.norm(self.world(p)[:3, 3] - place))
            <= self._ground.radius(p.kind.name) + own + 2.0 * REST_GAP
            for p in some.values()
        )

    def _plate_under(self, part: Part) -> str:
        """The turntable with which a part turns that stands where it is; "": with none."""
        return self._plate_of(self.rest(part).on)

    def _plate_of(self, on: tuple[str, ...]) -> str:
        for name in on:
            if name in self._plates:
                return name
            if name in self.present and self.present[name].plate:
                return self.present[name].plate
        return ""

    def _keep(self, part: Part, frame: Array, plate: str) -> Part:
        own = inverse(self._plates[plate]) @ frame if plate else np.asarray(frame)
        self.present[part.name] = replace(part, frame=own, holder="", plate=plate, up=None)
        return self.present[part.name]

    def is_seen(self, place: str, kind: str = "") -> bool:
        """Whether a part (of a kind; "": of any) stands at a place, as it would be found there to be removed."""
        spot = matrix_of(self.cell.places[place])
        return any(
            not p.holder
            and kind in ("", p.kind.name)
            and difference(self.world(p), spot)[0] <= p.kind.tolerance
            for p in self._work()
        )

    def _at(self, place: str, kind: PartKind) -> Part | None:
        """The part that stands at a place: those of the kind first, the nearest of them."""
        spot = matrix_of(self.cell.places[place])
        offs = [(difference(self.world(p), spot)[0], 0.0, p) for p in self._work() if not p.holder]
        near = [x for x in offs if x[0] <= x[2].kind.tolerance + self.slack]
        own = [x for x in near if x[2].kind is kind]
        return self._nearest(own or near) if near else None

    def _nearest(self, offs: list[tuple[float, float, Part]]) -> Part:
        """The part that is nearest (m), of these the one that is turned least (rad).

        With more slack the last one that is as near: where that matters, what is done comes to something else.
        """
        best = min(x[:2] for x in offs)
        same = [p for *off, p in offs if off[0] - best[0] <= max(self.slack, 0.0)]
        return same[-1] if self.slack > 0.0 else next(p for *off, p in offs if tuple(off) == best)

    def _add(self, kind: PartKind, frame: Array) -> Part:
        part = Part(f"{kind.name}.{next(self._numbers[kind.name])}", kind, np.asarray(frame))
        self.present[part.name] = part
        return part


def _off(kind: PartKind, frame: Array, tcp: Array) -> tuple[float, float]:
    """How far (m) and how much turned (rad) the TCP is from where a part can be gripped."""
    if not kind.grips:
        return difference(frame, tcp)[0], 0.0
    offs = [difference(frame @ matrix_of(g), tcp) for g in kind.grips]
    fits = [o for o in offs if o[1] <= kind.angle]
    return min(fits or offs)
