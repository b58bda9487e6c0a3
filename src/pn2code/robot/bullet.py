"""PyBullet as eyes and measuring tape: kinematic replay, distances, pictures.

Nothing is simulated by forces: joint positions are set (`resetJointStatesMultiDof`), so that both
backends show the same motion to the last bit, and PyBullet answers how close things are.
"""

from __future__ import annotations

import ctypes
import fnmatch
import importlib.util
import os
import sys
import tempfile
from collections.abc import Collection, Container, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import field, replace
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from lxml import etree

from pn2code.base.frozen import frozen, record
from pn2code.robot import collision_meshes, urdf
from pn2code.robot.backend import (
    BEFORE,
    BackendName,
    Beside,
    Camera,
    Clearance,
    ClearanceKind,
    Picture,
)
from pn2code.robot.commands import Pose
from pn2code.robot.geometry import Body, Solid, bodies, body_of, zone_body
from pn2code.robot.looks import Look
from pn2code.robot.parts import Part
from pn2code.robot.parts_table import PartKind
from pn2code.robot.placed_links import tool_links
from pn2code.robot.robot_cell import PART_CONTACT, CellRobot, RobotCell
from pn2code.robot.tools_table import ToolKind
from pn2code.robot.transforms import Array, pose_of, translation

_SKY = (148.0, 166.0, 186.0)
_HORIZON = (236.0, 239.0, 242.0)
_PAD = 0.004  # m: PyBullet has margins around shapes
_FIRST_GUESS = 0.05  # m: searched first; most queries find their answer this near to the last one
_EACH = (
    10  # pairs of links that are measured one by one; of more, those of whole bodies take less time
)

Near = Collection[tuple[str, str]]
"""Pairs of names (of links, or of parts) that may be near to each other; all others certainly are not."""


@contextmanager
def _silent() -> Iterator[None]:
    """PyBullet prints to file descriptors 1 and 2 from C: a build line, notes on masses we do not give."""
    sys.stdout.flush()
    sys.stderr.flush()
    saved = os.dup(1), os.dup(2)
    null = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(null, 1)
        os.dup2(null, 2)
        yield
    finally:
        # C's own buffer must be emptied into the void, or it appears when the program ends.
        ctypes.CDLL(None).fflush(None)
        for number, copy in enumerate(saved, 1):
            os.dup2(copy, number)
            os.close(copy)
        os.close(null)


@record
class _Loaded:
    """A robot in PyBullet: body, its links by index, which joints move, which pairs are tested.

    Of `plates` one is a turntable of the robot: of these pairs some may touch. `root` is the base link of the arm;
    `names` are those of links in messages.
    """

    robot: CellRobot
    body: int
    links: dict[int, str]
    index: dict[str, int]
    joints: list[int]
    pairs: list[tuple[int, int]]
    plates: list[tuple[int, int]]
    root: int
    names: dict[int, str]


@record
class _Standing:
    """A scene body in PyBullet."""

    body: Body
    id: int


@record
class _Placed:
    """A part in PyBullet; one that is hidden is there no more, but can be shown again quickly."""

    part: Part
    id: int
    hidden: bool = False


@frozen
class _Side:
    """One of two bodies between which something is measured.

    Args:
        robot: whose it is, "" if it stands.
        links: names by index, of a robot; indices: the same by name; whole: the name of a body without links.
        base: the robot whose base link it has, and `root` which it is; ignored_by: robots that stand on it.
        rides: the turntable of the robot on which it stands, a part that goes with it.
    """

    robot: str
    id: int
    links: dict[int, str]
    whole: str = ""
    base: str = ""
    ignored_by: tuple[str, ...] = ()
    root: int = -1
    rides: str = ""
    indices: Mapping[str, int] = field(default_factory=dict)

    @property
    def key(self) -> str:
        return self.whole or self.robot

    def link(self, index: int) -> str:
        """The name of a link."""
        return self.whole or self.links[index]

    def at(self, name: str) -> int | None:
        """The number of what has a name, -1 of a whole body; None: it is not of this side."""
        if self.whole:
            return -1 if name == self.whole else None
        return self.indices.get(name)


class BulletBackend:
    """PyBullet without a window, or with one (`gui`)."""

    name: BackendName = "bullet"

    def __init__(self, cell: RobotCell, *, gui: bool = False, looks: bool = True) -> None:
        """Builds the cell.

        Args:
            gui: open PyBullet's window (needs a display).
            looks: load the visual shapes; without them only distances can be asked for.
        """
        with _silent():
            import pybullet

            self._p: Any = pybullet
            self._client: int = pybullet.connect(pybullet.GUI if gui else pybullet.DIRECT)
        if self._client < 0:
            raise RuntimeError("PyBullet cannot open its window; is there a display?")
        self._cell = cell
        self._gui = gui
        self._egl: int | None = None
        self._ball: int | None = None
        self._folder = tempfile.TemporaryDirectory(prefix="pn2code-")
        self._names: dict[str, tuple[str, str | None]] = {}
        if looks and not gui:
            self._load_egl()
        with _silent():
            if gui:
                self._p.configureDebugVisualizer(
                    self._p.COV_ENABLE_GUI, 0, physicsClientId=self._client
                )
            self._robots = {r.name: self._load_robot(r, looks) for r in cell.moving}
            self._scene = [self._load_body(b, looks) for b in bodies(cell)]
            shown = cell.zones.values() if looks else ()
            self._zones = {z.name: self._load_body(zone_body(z), True).id for z in shown}
        self._looks = looks
        self._parts: dict[str, _Placed] = {}
        self._guess: dict[tuple[str, ...], float] = {}
        # What was measured since the robots concerned moved last: (kind, robots...) -> answer.
        self._known: dict[tuple[str, ...], list[Clearance]] = {}
        self._searched = 0.0
        self._q: dict[str, tuple[float, ...]] = {}
        self._axis: dict[str, int] = {}
        self._arms: dict[str, _Side] = {}
        self._rules: dict[tuple[str, str], float | None] = {}
        self._plates = {f"{r.name}/{a.name}" for r in cell.robots for a in r.axes.tables}
        for robot in cell.moving:
            self.set_joints(robot.name, robot.home)
        self._sunk = dict(self._depths_of_lifted())

    # Loading

    def _depths_of_lifted(self) -> Iterator[tuple[tuple[str, str], float]]:
        """How deep the base link of an arm on a lift may be in what it stands on: so deep as it is at HOME, and a bit.

        By robot and thing. The base of any other arm keeps its height, and is not tested against what it stands on.
        """
        for a in self._robots.values():
            robot = a.robot
            up = [robot.T_world_base[:3, :3] @ track.direction for track in robot.axes.tracks]
            if not any(abs(float(direction[2])) > 1e-9 for direction in up):
                continue
            for side in self._standing():
                if robot.name in side.ignored_by:
                    found = self._p.getClosestPoints(
                        a.body, side.id, 0.0, a.root, physicsClientId=self._client
                    )
                    deepest = min((float(c[8]) for c in found), default=0.0)
                    yield (robot.name, side.whole), PART_CONTACT - min(deepest, 0.0)

    def _load_egl(self) -> None:
        """The GPU renderer, where there is one; it must be there before any body. Asked for by name,
        because on a machine without a GPU it is slower and less portable than TinyRenderer."""
        if os.environ.get("PN2CODE_EGL") != "1":
            return
        spec = importlib.util.find_spec("eglRenderer")
        if spec is not None and spec.origin is not None:
            with _silent():
                plugin = self._p.loadPlugin(
                    spec.origin, "_eglRendererPlugin", physicsClientId=self._client
                )
            self._egl = plugin if plugin >= 0 else None

    def _load_urdf(self, name: str, text: str, *, fixed: bool = True, looks: bool = True) -> int:
        path = Path(self._folder.name) / f"{name.replace('/', '_')}.urdf"
        folder = Path(self._folder.name)
        read = urdf.for_bullet(
            text, looks, lambda mesh, most: collision_meshes.for_bullet(mesh, most, folder)
        )
        path.write_text(read, encoding="utf-8")
        # Implicit cylinders: as hulls of 32 sides they would be up to 1 mm too thin.
        return int(
            self._p.loadURDF(
                str(path),
                useFixedBase=fixed,
                flags=self._p.URDF_USE_IMPLICIT_CYLINDER,
                physicsClientId=self._client,
            )
        )

    def _load_robot(self, robot: CellRobot, looks: bool) -> _Loaded:
        tree = robot.arm.urdf
        text = urdf.with_tool(tree, robot.arm.flange, robot.tool.urdf if robot.tool else None)
        body = self._load_urdf(robot.name, text, looks=looks)
        base = robot.base
        self._p.resetBasePositionAndOrientation(
            body,
            (base.x, base.y, base.z),
            self._p.getQuaternionFromEuler((base.rx, base.ry, base.rz)),
            physicsClientId=self._client,
        )
        root, links, joints, parents = tree.root, {-1: tree.root}, {}, {}
        for i in range(self._p.getNumJoints(body, physicsClientId=self._client)):
            info = self._p.getJointInfo(body, i, physicsClientId=self._client)
            links[i] = info[12].decode()
            joints[info[1].decode()] = i
            parents[i] = (info[16], info[2] == self._p.JOINT_FIXED)
        index = {name: i for i, name in links.items()}
        assert index[root] == -1
        tables = {index[name] for name in robot.arm.tables}
        pairs = _self_pairs(links, parents, tree.self_ignore, tables)
        return _Loaded(
            robot,
            body,
            links,
            index,
            [joints[a] for a in robot.arm.axes],
            [x for x in pairs if tables.isdisjoint(x)],
            [x for x in pairs if not tables.isdisjoint(x)],
            index[robot.root],
            {i: f"{robot.name}/{name}" for i, name in links.items()},
        )

    def _load_body(self, body: Body, looks: bool) -> _Standing:
        lines = [f'<robot name={_quoted(body.name)}><link name="base">']
        lines += [f"<collision>{_solid(s)}</collision>" for s in body.solids]
        if body.hull is not None and body.hull.file is not None:
            lines.append(f"<collision>{_mesh(body.hull.file, body.hull, body.pieces)}</collision>")
        for i, look in enumerate(body.looks if looks else ()):
            path = look.file
            if look.mesh is not None:
                path = Path(self._folder.name) / f"{body.name.replace('/', '_')}_{i}.obj"
                path.write_text(look.mesh.obj(), encoding="utf-8")
            if path is not None:
                colour = " ".join(f"{c:g}" for c in look.colour)
                lines.append(
                    f'<visual>{_mesh(path, look)}<material name="m{i}"><color rgba="{colour}"/>'
                    "</material></visual>"
                )
        lines.append("</link></robot>")
        return _Standing(body, self._load_urdf(body.name, "\n".join(lines)))

    # Backend

    def set_joints(self, robot: str, q: Sequence[float] | Array) -> None:
        """Puts a robot at a joint position, rad."""
        loaded = self._robots[robot]
        old, new = self._q.get(robot), tuple(q)
        if old == new:
            return
        self._q[robot] = new
        if self._known:
            self._known = {k: v for k, v in self._known.items() if robot not in k}
        self._p.resetJointStatesMultiDof(
            loaded.body, loaded.joints, [[float(v)] for v in q], physicsClientId=self._client
        )
        for placed in self._parts.values():
            if placed.part.carrier != robot:
                continue
            if old is None or not placed.part.plate or self._turned(placed.part.plate, old, new):
                self._move(placed)

    def _turned(self, plate: str, old: Sequence[float], new: Sequence[float]) -> bool:
        """Whether what carries parts has moved between two joint positions: only its own axis moves it."""
        if plate not in self._axis:
            robot = self._robots[plate.partition("/")[0]].robot
            self._axis[plate] = robot.index(robot.plate(plate).name)
        return old[self._axis[plate]] != new[self._axis[plate]]

    def set_base(self, robot: str, base: Pose) -> None:
        """Puts the base of a robot elsewhere; what it stands on stays."""
        self._p.resetBasePositionAndOrientation(
            self._robots[robot].body,
            (base.x, base.y, base.z),
            self._p.getQuaternionFromEuler((base.rx, base.ry, base.rz)),
            physicsClientId=self._client,
        )
        self._known = {}
        # The joints are set again, so that all links follow.
        self._q.pop(robot, None)

    @property
    def things(self) -> tuple[str, ...]:
        """The names of what stands in the scene."""
        return tuple(thing.body.name for thing in self._scene)

    def set_part(self, part: Part) -> None:
        """Shows a part where it is from now on."""
        placed = self._parts.get(part.name)
        if placed is None:
            with _silent():
                placed = _Placed(part, self._load_kind(part.kind, part.name, self._looks))
            self._parts[part.name] = placed
        placed.part, placed.hidden = part, False
        self._known = {}
        self._move(placed)

    def hide_part(self, name: str) -> None:
        """The part is not there until it is shown again."""
        placed = self._parts[name]
        away = Part(name, placed.part.kind, translation(0.0, 0.0, -1000.0))
        placed.part, placed.hidden = away, True
        self._known = {}
        self._move(placed)

    def _move(self, placed: _Placed) -> None:
        frame = placed.part.frame
        if placed.part.holder:
            frame = self.tcp(placed.part.holder) @ frame
        elif placed.part.plate:
            frame = self._plate(placed.part.plate) @ frame
        pose = pose_of(frame)
        self._p.resetBasePositionAndOrientation(
            placed.id,
            (pose.x, pose.y, pose.z),
            self._p.getQuaternionFromEuler((pose.rx, pose.ry, pose.rz)),
            physicsClientId=self._client,
        )

    def _plate(self, plate: str) -> Array:
        """Where a turntable is, `T_world_plate`."""
        name = plate.partition("/")[0]
        robot = self._robots[name].robot
        return robot.T_world_plate(robot.plate(plate), self._q.get(name, robot.home))

    def remove_part(self, name: str) -> None:
        """The part has left the cell."""
        self._p.removeBody(self._parts.pop(name).id, physicsClientId=self._client)
        self._known = {}

    def around(self, name: str, limit: float) -> tuple[Beside, ...] | None:
        """How near a part is to each thing, part and turntable."""
        own = self._parts[name]
        out = []
        others = [(side.whole, side.id, -1) for side in self._standing()]
        for a in self._robots.values():
            others += [(side.whole, side.id, -1) for side in self._riding(a)]
            if not a.robot.is_device:  # what moves of devices is looked at with what moves
                others += [(f"{a.robot.name}/{t}", a.body, a.index[t]) for t in a.robot.arm.tables]
        for what, body, link in others:
            if body == own.id:
                continue
            found = self._p.getClosestPoints(
                own.id, body, limit, -1, link, physicsClientId=self._client
            )
            if found:
                out.append(Beside(what, min(float(c[8]) for c in found)))
        return tuple(sorted(out, key=lambda b: b.distance))

    def tcp(self, robot: str) -> Array:
        """`T_world_tcp` as PyBullet has it."""
        loaded = self._robots[robot]
        if loaded.robot.is_device:
            return np.asarray(loaded.robot.kinematics.forward(self._q[robot]))
        tip = "tool_tcp" if loaded.robot.tool is not None else loaded.robot.arm.flange
        state = self._p.getLinkState(
            loaded.body,
            loaded.index[tip],
            computeForwardKinematics=True,
            physicsClientId=self._client,
        )
        out = np.eye(4)
        out[:3, 3] = state[4]
        out[:3, :3] = np.array(self._p.getMatrixFromQuaternion(state[5])).reshape(3, 3)
        return out

    def clearances(self, limit: float) -> tuple[Clearance, ...] | None:
        """The closest pair of each kind and robot, and permitted contacts that overlap."""
        if limit != self._searched:
            self._known, self._searched = {}, limit
        out: list[Clearance] = []
        robots = list(self._robots.values())
        for i, a in enumerate(robots):
            me = a.robot.name
            for b in robots[i + 1 :]:
                key = ("robots", me, b.robot.name)
                if key not in self._known:
                    self._known[key] = self._robots_apart(a, b, limit)
                out += self._known[key]
            if ("scene", me) not in self._known:
                self._known["scene", me] = [
                    gap
                    for side in self._sides(a)
                    for other in self._standing()
                    for gap in self._between("scene", side, other, limit)
                ]
                self._known["self", me] = [
                    *self._self(a, limit),
                    *self._on_plates(a, limit),
                    *self._carried(a, limit),
                    *self._beside_riders(a, limit),
                ]
            out += self._known["scene", me] + self._known["self", me]
        return tuple(_closest(out))

    # Each pair, for those who sweep moves against each other

    def pairs(
        self,
        kind: ClearanceKind,
        robot: str,
        limit: float,
        other: str = "",
        only: Container[str] | None = None,
        near: Near | None = None,
    ) -> list[Clearance]:
        """The least distance of each two links, or link and thing, that are nearer than `limit` (m).

        Args:
            kind: to which things: of the robot `other`, of the scene (with the parts that stand), or its own.
            robot: of which the links are, with the part that it carries.
            only: of the scene, the things of these names.
            near: only these pairs can be nearer than `limit`, a link of `robot` first, of its own links and parts in
                both orders; None: nothing is known.
        """
        a = self._robots[robot]
        best: dict[tuple[str, str], Clearance] = {}
        if kind == "self":
            for gap in self._every_own(a, limit, near):
                _keep_nearest(best, gap)
            return list(best.values())
        others = self._standing() if kind == "scene" else self._sides(self._robots[other])
        for second in list(others):
            if only is not None and second.whole not in only:
                continue
            for first in self._sides(a):
                found = self._points(first, second, limit, near)
                skip_base = first.base != "" and first.base in second.ignored_by
                for c in found:
                    stands = skip_base and c[3] == first.root
                    one, two = first.link(c[3]), second.link(c[4])
                    allowed = self._permitted(first, second, one, two, stands=stands)
                    if stands and allowed is None:
                        continue
                    who = first.robot or robot
                    if kind == "scene" and first.rides:
                        allowed, stands = max(allowed or 0.0, PART_CONTACT), True
                    plates = self._near_plates((first, one), (second, two))
                    gap = Clearance(
                        kind,
                        who,
                        one,
                        two,
                        c[8],
                        allowed,
                        c[5],
                        c[6],
                        stands,
                        second.robot,
                        _robots_of(plates),
                        plates,
                    )
                    _keep_nearest(best, gap)
        return list(best.values())

    def _points(self, a: _Side, b: _Side, limit: float, near: Near | None) -> Sequence[Any]:
        """What is near between two bodies, as Bullet has it; of pairs in the order in which it goes through them."""
        if near is None:
            points: Sequence[Any] = self._p.getClosestPoints(
                a.id, b.id, limit, physicsClientId=self._client
            )
            return points
        pairs = sorted(
            (i, j)
            for i, j in ((a.at(x), b.at(y)) for x, y in near)
            if i is not None and j is not None
        )
        if len(pairs) > _EACH:
            return self._points(a, b, limit, None)
        return [
            c
            for i, j in pairs
            for c in self._p.getClosestPoints(a.id, b.id, limit, i, j, physicsClientId=self._client)
        ]

    def _every_own(self, a: _Loaded, limit: float, near: Near | None) -> Iterator[Clearance]:
        name = a.robot.name
        for i, j in a.pairs:
            one, two = a.names[i], a.names[j]
            if near is not None and (one, two) not in near:
                continue
            for c in self._p.getClosestPoints(
                a.body, a.body, limit, i, j, physicsClientId=self._client
            ):
                yield Clearance("self", name, one, two, c[8], None, c[5], c[6])
        yield from self._on_plates(a, limit, near)
        yield from self._every_carried(a, limit, near)
        yield from self._beside_riders(a, limit, near)

    def _on_plates(self, a: _Loaded, limit: float, near: Near | None = None) -> Iterator[Clearance]:
        """Between the turntables of a robot, with what is on them, and the rest of it; its tool may touch them."""
        for i, j in a.plates:
            one, two = a.names[i], a.names[j]
            if near is not None and (one, two) not in near:
                continue
            found = self._p.getClosestPoints(
                a.body, a.body, limit, i, j, physicsClientId=self._client
            )
            for c in found:
                allowed = self.allowed(one, two)
                yield Clearance("self", a.robot.name, one, two, c[8], allowed, c[5], c[6])

    def box(self, robot: str, link: str) -> tuple[Array, Array] | None:
        """The corners of a box around a link's collision shapes in its frame, a little too large; None: it has none."""
        loaded = self._robots[robot]
        tool = loaded.robot.tool
        text = urdf.with_tool(
            loaded.robot.arm.urdf, loaded.robot.arm.flange, tool.urdf if tool else None
        )
        root = etree.fromstring(text.encode())
        own = next(e for e in root.findall("link") if e.get("name") == link)
        shapes = [etree.tostring(e, encoding="unicode") for e in own.findall("collision")]
        if not shapes:
            return None
        lines = ['<robot name="box"><link name="base">', *shapes, "</link></robot>"]
        with _silent():
            body = self._load_urdf(f"box_{robot}_{link}", "\n".join(lines))
        return self._around(body)

    def part_box(self, kind: PartKind | ToolKind) -> tuple[Array, Array]:
        """The same around a part of a kind, or a tool, in its frame."""
        with _silent():
            body = self._load_kind(kind, f"box_{kind.name}", False)
        return self._around(body)

    def _load_kind(self, kind: PartKind | ToolKind, name: str, looks: bool) -> int:
        """A part or tool, as one body without joints."""
        if isinstance(kind, PartKind):
            return self._load_body(body_of(replace(kind.shape, name=name)), looks).id
        text = urdf.as_one_link(kind.tool.urdf)
        return self._load_urdf(name, text, looks=looks)

    def _around(self, body: int) -> tuple[Array, Array]:
        low, high = self._p.getAABB(body, -1, physicsClientId=self._client)
        self._p.removeBody(body, physicsClientId=self._client)
        return np.array(low) - _PAD, np.array(high) + _PAD

    def _robots_apart(self, a: _Loaded, b: _Loaded, limit: float) -> list[Clearance]:
        """Between two robots, with what they carry."""
        return [
            gap
            for one in self._sides(a)
            for other in self._sides(b)
            for gap in self._between("robots", one, other, limit)
        ]

    def _riding(self, a: _Loaded) -> Iterator[_Side]:
        """The parts that stand on turntables of a robot."""
        for part in self._parts.values():
            plate = part.part.plate
            if plate and part.part.carrier == a.robot.name:
                yield _Side(a.robot.name, part.id, {}, part.part.name, rides=plate)

    def _beside_riders(
        self, a: _Loaded, limit: float, near: Near | None = None
    ) -> Iterator[Clearance]:
        """Between what stands on turntables of a robot and the rest of it: arm, part in its tool, other plates."""
        riders = list(self._riding(a))
        if not riders:
            return
        name = a.robot.name
        held = [side for side in self._sides(a) if not side.links and not side.rides]
        for rider in riders:
            own = rider.rides.partition("/")[2]
            others = [(f"{name}/{x}", a.body, i) for i, x in a.links.items() if x != own]
            others += [(side.whole, side.id, -1) for side in held]
            others += [(x.whole, x.id, -1) for x in riders if x.rides < rider.rides]
            for other, body, link in others:
                if near is not None and (other, rider.whole) not in near:
                    continue
                found = self._p.getClosestPoints(
                    body, rider.id, limit, link, -1, physicsClientId=self._client
                )
                if found:
                    c = min(found, key=lambda point: float(point[8]))
                    allowed = self.allowed(other, rider.whole)
                    yield Clearance("self", name, other, rider.whole, c[8], allowed, c[5], c[6])

    def _sides(self, a: _Loaded) -> Iterator[_Side]:
        """A robot, the part that it carries, and those that stand on its turntables."""
        name = a.robot.name
        if name not in self._arms:
            indices = {link: i for i, link in a.names.items()}
            self._arms[name] = _Side(name, a.body, a.names, "", name, root=a.root, indices=indices)
        yield self._arms[name]
        for part in self._parts.values():
            if part.part.holder == name:
                whole = f"{name}/{part.part.name}"
                yield _Side(name, part.id, {}, whole)
        yield from self._riding(a)

    def _standing(self) -> Iterator[_Side]:
        """What stands still: the scene, and parts that neither a tool nor a turntable carries."""
        for thing in self._scene:
            yield _Side("", thing.id, {}, thing.body.name, ignored_by=thing.body.ignored_by)
        for part in self._parts.values():
            if not part.part.carrier and not part.hidden:
                yield _Side("", part.id, {}, part.part.name)

    def _between(self, kind: ClearanceKind, a: _Side, b: _Side, limit: float) -> list[Clearance]:
        key = (kind, a.key, b.key)
        if kind == "scene" and a.rides:
            limit = min(
                limit, _FIRST_GUESS
            )  # it may touch: only that it does not too deeply counts
        reach = min(limit, self._guess.get(key, _FIRST_GUESS))
        skip_base = a.base != "" and a.base in b.ignored_by
        while True:
            found = self._p.getClosestPoints(a.id, b.id, reach, physicsClientId=self._client)
            best: Clearance | None = None
            touching: dict[tuple[str, str], Clearance] = {}
            for c in found:
                stands = skip_base and c[3] == a.root
                name_a, name_b = a.link(c[3]), b.link(c[4])
                allowed = self._permitted(a, b, name_a, name_b, stands=stands)
                if stands and allowed is None:
                    continue
                if kind == "scene" and a.rides:
                    allowed, stands = max(allowed or 0.0, PART_CONTACT), True
                if allowed is not None:
                    old = touching.get((name_a, name_b))
                elif best is None or c[8] < best.distance:
                    best = Clearance(
                        kind, a.robot, name_a, name_b, c[8], None, c[5], c[6], second=b.robot
                    )
                    continue
                else:
                    continue
                if old is None or c[8] < old.distance:
                    plates = self._near_plates((a, name_a), (b, name_b))
                    item = Clearance(
                        kind, a.robot, name_a, name_b, c[8], allowed, c[5], c[6], stands, b.robot,
                        _robots_of(plates), plates,
                    )  # fmt: skip
                    touching[name_a, name_b] = item
            if best is not None or reach >= limit:
                break
            reach = min(limit, reach * 3.0)
        # The next question is about a moment later: search a little further than the last answer.
        near = limit if best is None else max(best.distance, 0.0)
        self._guess[key] = near + _FIRST_GUESS
        return [*touching.values(), best] if best is not None else list(touching.values())

    def _carried(self, a: _Loaded, limit: float) -> list[Clearance]:
        """Of what is carried and the links of its robot the nearest, and all that it may touch."""
        found = list(self._every_carried(a, limit))
        apart = [gap for gap in found if gap.allowed is None]
        nearest = min(apart, key=lambda gap: gap.distance, default=None)
        touching = [gap for gap in found if gap.allowed is not None]
        return touching if nearest is None else [nearest, *touching]

    def _every_carried(
        self, a: _Loaded, limit: float, near: Near | None = None
    ) -> Iterator[Clearance]:
        """Between what a robot carries (parts, a tool) and the robot itself, but for its tool and the last axis.

        On a turntable it may be put. How far a link may still come differs from one to the other: who looks between
        instants needs them all.
        """
        name = a.robot.name
        if a.robot.is_device:
            return
        last = a.joints[a.robot.kinematics.joints.stop - 1]
        tables = {a.index[t] for t in a.robot.arm.tables}
        of_tool = tool_links(a.robot)
        own = {i for i, link in a.links.items() if link in of_tool or i >= last} - tables
        for side in self._sides(a):
            for i in a.links if not side.links and not side.rides else ():
                other = a.names[i]
                if i in own or (near is not None and (side.whole, other) not in near):
                    continue
                allowed = self.allowed(side.whole, other) if i in tables else None
                for c in self._p.getClosestPoints(
                    side.id, a.body, limit, -1, i, physicsClientId=self._client
                ):
                    yield Clearance("self", name, side.whole, other, c[8], allowed, c[5], c[6])

    def _self(self, a: _Loaded, limit: float) -> list[Clearance]:
        key = ("self", a.robot.name)
        reach = min(limit, self._guess.get(key, _FIRST_GUESS))
        best: Clearance | None = None
        while True:
            # Pair by pair: asked about the whole body, Bullet measures all neighbours' overlaps too.
            for i, j in a.pairs:
                found = self._p.getClosestPoints(
                    a.body, a.body, reach, i, j, physicsClientId=self._client
                )
                for c in found:
                    if best is None or c[8] < best.distance:
                        one, two = (f"{a.robot.name}/{a.links[k]}" for k in (i, j))
                        best = Clearance("self", a.robot.name, one, two, c[8], None, c[5], c[6])
                        reach = min(reach, max(c[8], 1e-3))
            if best is not None or reach >= limit:
                break
            reach = min(limit, reach * 3.0)
        self._guess[key] = limit if best is None else max(best.distance, 0.0) + _FIRST_GUESS
        return [] if best is None else [best]

    def _near_plates(self, *near: tuple[_Side, str]) -> tuple[str, ...]:
        """The turntables of which one, or what stands on it, is near, and not the rest of its robot."""
        return tuple(
            side.rides or name for side, name in near if side.rides or name in self._plates
        )

    def _permitted(self, a: _Side, b: _Side, one: str, two: str, *, stands: bool) -> float | None:
        """The same of two sides; of what stands on the other one, None: it is not tested."""
        return self._sunk.get((a.base, b.whole)) if stands else self.allowed(one, two)

    def allowed(self, a: str, b: str) -> float | None:
        """How deep two parts may overlap; None: they must keep apart."""
        if (a, b) not in self._rules:
            depths = [
                rule.depth
                for rule in self._cell.scene.contacts
                if (fnmatch.fnmatchcase(a, rule.a) and fnmatch.fnmatchcase(b, rule.b))
                or (fnmatch.fnmatchcase(b, rule.a) and fnmatch.fnmatchcase(a, rule.b))
            ]
            self._rules[a, b] = max(depths, default=None)
        return self._rules[a, b]

    def mark(self, point: Sequence[float], radius: float) -> None:
        """Shows a red ball, of which no distances are measured; it moves when it is shown again."""
        if self._ball is None:
            shape = self._p.createVisualShape(
                self._p.GEOM_SPHERE,
                radius=radius,
                rgbaColor=[0.9, 0.05, 0.05, 1.0],
                physicsClientId=self._client,
            )
            self._ball = int(
                self._p.createMultiBody(0, -1, shape, point, physicsClientId=self._client)
            )
        self._p.resetBasePositionAndOrientation(
            self._ball, point, (0.0, 0.0, 0.0, 1.0), physicsClientId=self._client
        )

    def light_zone(self, name: str) -> None:
        """Its edges are thick from now on, and of another colour."""
        if name in self._zones:
            with _silent():
                self._p.removeBody(self._zones[name], physicsClientId=self._client)
                broken = zone_body(self._cell.zones[name], is_broken=True)
                self._zones[name] = self._load_body(broken, True).id

    def hidden(
        self, eye: tuple[float, float, float], points: Sequence[tuple[float, float, float]]
    ) -> int:
        """How many of some places something else hides from an eye: what is further before them than `BEFORE`."""
        self._p.performCollisionDetection(physicsClientId=self._client)
        found = self._p.rayTestBatch(
            [eye] * len(points), list(points), physicsClientId=self._client
        )
        far = [float(np.linalg.norm(np.subtract(p, eye))) for p in points]
        return sum(
            hit[0] >= 0 and (1.0 - hit[2]) * way > BEFORE
            for hit, way in zip(found, far, strict=True)
        )

    def render(self, camera: Camera, width: int, height: int) -> Picture | None:
        """A picture (height, width, 3), 0..255."""
        p = self._p
        view = p.computeViewMatrix(camera.eye, camera.target, (0.0, 0.0, 1.0))
        # The near plane matters to TinyRenderer's shadows: with 0.2 m everything lay in shadow.
        lens = p.computeProjectionMatrixFOV(camera.field_of_view, width / height, 0.05, 30.0)
        renderer = (
            p.ER_BULLET_HARDWARE_OPENGL
            if self._gui or self._egl is not None
            else p.ER_TINY_RENDERER
        )
        picture = p.getCameraImage(
            width,
            height,
            view,
            lens,
            lightDirection=(0.55, -0.75, 1.2),
            lightColor=(1.0, 1.0, 1.0),
            lightDistance=12.0,
            shadow=1,
            lightAmbientCoeff=0.52,
            lightDiffuseCoeff=0.52,
            lightSpecularCoeff=0.10,
            renderer=renderer,
            flags=p.ER_NO_SEGMENTATION_MASK,
            physicsClientId=self._client,
        )
        colours = np.array(picture[2], np.uint8).reshape(height, width, 4)[:, :, :3]
        nothing = np.asarray(picture[3], float).reshape(height, width) > 0.99999
        # A quiet backdrop instead of white paper, lighter towards the floor.
        up = np.linspace(0.0, 1.0, height)[:, None]
        backdrop = (np.array(_SKY) * (1.0 - up) + np.array(_HORIZON) * up).astype(np.uint8)
        colours[nothing] = np.repeat(backdrop[:, None], width, axis=1)[nothing]
        return colours

    def close(self) -> None:
        """Disconnects and removes the temporary files."""
        if self._client >= 0:
            with _silent():
                self._p.disconnect(self._client)
            self._client = -1
            self._folder.cleanup()


def _robots_of(plates: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(p.partition("/")[0] for p in plates)


def _keep_nearest(best: dict[tuple[str, str], Clearance], gap: Clearance) -> None:
    old = best.get((gap.a, gap.b))
    if old is None or gap.distance < old.distance:
        best[gap.a, gap.b] = gap


def _closest(items: Sequence[Clearance]) -> Iterator[Clearance]:
    """Of each kind and robot the nearest pair that must keep apart; and all permitted contacts."""
    best: dict[tuple[str, str], Clearance] = {}
    for c in items:
        if c.allowed is not None:
            yield c
            continue
        key = (c.kind, c.robot)
        if key not in best or c.distance < best[key].distance:
            best[key] = c
    yield from best.values()


def _self_pairs(
    links: dict[int, str],
    parents: dict[int, tuple[int, bool]],
    ignore: frozenset[frozenset[str]],
    tables: Collection[int] = (),
) -> list[tuple[int, int]]:
    """Pairs of links that could meet: not in one rigid piece, and their pieces not joined by a joint.

    Turntables (`tables`) stand apart from whatever they are joined to.
    """
    piece = {-1: -1}
    above: dict[int, int] = {}
    for i, (parent, fixed) in sorted(parents.items()):
        piece[i] = piece[parent] if fixed else i
        if not fixed:
            above[i] = piece[parent]
    out = []
    for i in sorted(links):
        for j in sorted(links):
            a, b = piece[i], piece[j]
            joined = above.get(a) == b or above.get(b) == a
            joined = joined and i not in tables and j not in tables
            if i < j and a != b and not joined and frozenset((links[i], links[j])) not in ignore:
                out.append((i, j))
    # Far ends first: they are the likeliest to be near something, and the first answer cuts the rest.
    return sorted(out, key=lambda pair: (-pair[1], -pair[0]))


def _origin(pose: Pose) -> str:
    """A pose in URDF, whose `rpy` are the same angles as ours."""
    xyz = " ".join(repr(float(v)) for v in (pose.x, pose.y, pose.z))
    rpy = " ".join(repr(float(v)) for v in (pose.rx, pose.ry, pose.rz))
    return f'<origin xyz="{xyz}" rpy="{rpy}"/>'


def _solid(solid: Solid) -> str:
    a, b, c = (repr(float(v)) for v in solid.size)
    shape = (
        f'<box size="{a} {b} {c}"/>'
        if solid.kind == "box"
        else f'<cylinder radius="{a}" length="{c}"/>'
    )
    return f"{_origin(solid.pose)}<geometry>{shape}</geometry>"


def _quoted(text: str) -> str:
    """An attribute's value in XML; the standard library's own function for it loads its HTTP client."""
    return f'"{escape(text)}"'


def _mesh(path: Path, look: Look, hulls: int = 1) -> str:
    scale = " ".join([repr(look.scale)] * 3)
    name = _quoted(str(path.resolve()))
    of = f' {urdf.HULLS}="{hulls}"' if hulls > 1 else ""
    return f"{_origin(look.pose)}<geometry><mesh filename={name} scale={_quoted(scale)}{of}/></geometry>"
