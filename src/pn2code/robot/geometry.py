"""Scene objects as solids: boxes and cylinders to keep clear of, meshes to look at.

    for body in bodies(cell): body.name, body.solids, body.looks

A curved panel becomes flat boxes along the arc (0.35 mm off the true cylinder at a radius of 1.6 m)
for distances, which stay convex and fast, and a smooth mesh for the eye.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache, partial

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot import looks
from pn2code.robot.commands import Pose
from pn2code.robot.looks import Look
from pn2code.robot.panel import FLANGE, cut, frame, stand_parts, stand_places, stringers
from pn2code.robot.pedestal import WIDEST, half_width
from pn2code.robot.robot_cell import CellRobot, PanelConfig, RobotCell
from pn2code.robot.scene_objects import SceneObject
from pn2code.robot.table_poses import NO_POSE
from pn2code.robot.transforms import Array, matrix_of, pose_of
from pn2code.robot.zones_table import Zone

_RAIL = (0.32, 0.34, 0.37, 1.0)


@frozen
class Solid:
    """A box (full lengths) or a cylinder (radius, radius, length along z), placed in the world."""

    kind: str
    pose: Pose
    size: tuple[float, float, float]


@frozen(eq=False)
class Body:
    """A part of the scene that stands still.

    Args:
        name: as in contact rules and messages: "panel/skin".
        solids: what distances are measured to; hull: or that of a mesh file: its convex hull, or so many pieces.
        draw: makes its looks, which takes longer than its solids.
        ignored_by: robots that stand on it: their base link is not tested against it.
    """

    name: str
    solids: tuple[Solid, ...]
    draw: Callable[[], tuple[Look, ...]]
    hull: Look | None = None
    pieces: int = 1
    ignored_by: tuple[str, ...] = ()

    @property
    def looks(self) -> tuple[Look, ...]:
        """What is seen of it."""
        return self.draw()


def _in_world(device: CellRobot, thing: SceneObject) -> SceneObject:
    """A thing of a device that stands."""
    if device.base == NO_POSE:
        return thing
    return replace(thing, pose=pose_of(device.T_world_base @ matrix_of(thing.pose)))


def bodies(cell: RobotCell) -> tuple[Body, ...]:
    """Everything of the scene but the robots."""
    out: list[Body] = []
    scene = cell.scene
    if scene.floor:
        out.append(_floor(cell))
    for robot in cell.robots:
        if robot.axes.tracks:
            out += _rail(robot)
        elif robot.base.z > 0.05:
            out.append(_pedestal(robot))
    for device in cell.devices:
        for axis in device.belts:
            name = f"{device.name}/{axis.name}"
            out += [body_of(replace(_in_world(device, o), name=name)) for o in axis.objects]
    if scene.panel is not None:
        out += panel_bodies(scene.panel)
    out += [body_of(o) for o in scene.objects]
    return tuple(out)


def zone_body(zone: Zone, is_broken: bool = False) -> Body:
    """The edges of a zone, to be seen and nothing else: no distances are measured to them."""
    # PyBullet keeps what it has read from a file of the same name.
    name = f"zone/{zone.name}/broken" if is_broken else f"zone/{zone.name}"
    return Body(name, (), partial(looks.zone, zone, is_broken))


def _box(pose: Array, size: Sequence[float]) -> Solid:
    return Solid("box", pose_of(pose), (float(size[0]), float(size[1]), float(size[2])))


def _upright_box(low: Sequence[float], high: Sequence[float]) -> Solid:
    t = np.eye(4)
    t[:3, 3] = (np.asarray(low, float) + np.asarray(high, float)) / 2.0
    return _box(t, [b - a for a, b in zip(low, high, strict=True)])


def _floor(cell: RobotCell) -> Body:
    points = [(float(x), float(y)) for r in cell.robots for x, y in _stands_at(r)]
    if cell.scene.panel is not None:
        p = cell.scene.panel
        points += [(p.x_from, p.axis_y - p.radius), (p.x_to, p.axis_y)]
    points = points or [(0.0, 0.0)]
    low = [min(v) - 2.2 for v in zip(*points, strict=True)]
    high = [max(v) + 2.2 for v in zip(*points, strict=True)]
    solid = _upright_box((*low, -0.1), (*high, 0.0))
    names = tuple(r.name for r in cell.robots)
    return Body("floor", (solid,), partial(looks.floor, low, high), ignored_by=names)


def _stands_at(robot: CellRobot) -> Array:
    """Where the arm can stand, (n, 2): at the ends of its tracks, and at their zero; then its turntables."""
    base = robot.T_world_base
    ends = [
        [np.zeros(3), *(x * track.direction for x in (track.lower, track.upper))]
        for track in robot.axes.tracks
    ]
    own = [sum(x, np.zeros(3)) for x in itertools.product(*ends)]
    own += [a.T_base_axis[:3, 3] for a in robot.axes.tables]
    return np.array(
        [
            [robot.base.x, robot.base.y],
            *(base[:3, :3] @ np.array(own).T + base[:3, 3:4]).T[1:, :2].tolist(),
        ]
    )


def _pedestal(robot: CellRobot) -> Body:
    """What a robot whose base is above the floor stands on."""
    base, half = robot.base, half_width(robot)
    pose = matrix_of(Pose(base.x, base.y, base.z / 2.0, 0.0, 0.0, base.rz))
    solids = (_box(pose, (2 * half, 2 * half, base.z)),)
    draw = partial(looks.pedestal, half, base)
    return Body(f"{robot.name}_pedestal", solids, draw, ignored_by=(robot.name,))


def _rail(robot: CellRobot) -> Iterator[Body]:
    """Under the arm, wherever its tracks carry it, down to the floor; none where it comes down to the floor itself."""
    ends = [
        [x * track.direction for x in (track.lower, track.upper)] for track in robot.axes.tracks
    ]
    base = robot.T_world_base
    places = np.array([sum(x) for x in itertools.product(*ends)]) @ base[:3, :3].T + base[:3, 3]
    top = float(places[:, 2].min())
    if top <= 0.05:
        return
    yaw = robot.base.rz
    across = np.array([[math.cos(yaw), math.sin(yaw)], [-math.sin(yaw), math.cos(yaw)]])
    flat = places[:, :2] @ across.T
    low, high = flat.min(axis=0) - WIDEST, flat.max(axis=0) + WIDEST
    x, y = across.T @ ((low + high) / 2.0)
    size = (*(high - low).tolist(), top)
    pose = Pose(float(x), float(y), top / 2.0, 0.0, 0.0, yaw)
    solids = (Solid("box", pose, size),)
    name = f"{robot.name}_rail"
    thing = SceneObject(name, "box", pose, _RAIL, size=size)
    yield Body(name, solids, partial(looks.thing, thing), ignored_by=(robot.name,))


@lru_cache(maxsize=4)  # layouts differ in their robots, seldom in the panel
def panel_bodies(p: PanelConfig) -> tuple[Body, ...]:
    """Skin, ribs with stringers, and stands of a panel: "panel/skin", "panel/ribs", "panel/stand"."""
    arcs = cut(p.arc_from, p.arc_to)
    flat = tuple(_shell(p, a, b, p.x_from, p.x_to, p.radius, p.skin) for a, b in arcs)
    out = [Body("panel/skin", flat, partial(looks.skin_of_panel, p))]
    inner = p.radius - p.skin / 2.0
    frames: list[Solid] = []
    for x in p.ribs:
        x0, x1 = x - p.rib_thickness / 2, x + p.rib_thickness / 2
        middle = inner - p.rib_height / 2
        frames += [_shell(p, a, b, x0, x1, middle, p.rib_height) for a, b in arcs]
        # A flange makes a Z-section of the rib, as airframes have; it is inside the rib's solid but
        # for its width, which gets a solid of its own.
        low = inner - p.rib_height
        frames += [_shell(p, a, b, x0, x1 + FLANGE, low + 0.002, 0.004) for a, b in arcs]
    for angle in stringers(p):
        frames.append(_strip(p, angle, inner - p.stringer_height / 2, 0.02, p.stringer_height))
    if frames:
        out.append(Body("panel/ribs", tuple(frames), partial(looks.ribs, p)))
    if p.stands:
        out.append(_stands(p))
    return tuple(out)


def _shell(
    p: PanelConfig, a: float, b: float, x0: float, x1: float, radius: float, thick: float
) -> Solid:
    """A flat piece of shell between two arc angles; chords as long as the outer arc."""
    chord = 2.0 * (radius + thick / 2.0) * math.tan((b - a) / 2.0)
    place = frame(p, (a + b) / 2.0, (x0 + x1) / 2.0, radius)
    return _box(place, (x1 - x0, chord, thick))


def _strip(p: PanelConfig, angle: float, radius: float, width: float, height: float) -> Solid:
    place = frame(p, angle, (p.x_from + p.x_to) / 2.0, radius)
    return _box(place, (p.x_to - p.x_from, width, height))


def _stands(p: PanelConfig) -> Body:
    """Two end frames: an arc that holds the panel's edge, two posts, and a floor beam."""
    solids: list[Solid] = []
    for x0, x1 in stand_places(p):
        solids += [
            _shell(p, a, b, x0, x1, p.radius - 0.04, 0.10) for a, b in cut(p.arc_from, p.arc_to)
        ]
        posts, beam = stand_parts(p, x0, x1)
        solids += [_upright_box(*ends) for ends in (*posts, beam)]
    return Body("panel/stand", tuple(solids), partial(looks.stands, p))


def body_of(o: SceneObject) -> Body:
    """An object as a body."""
    if o.kind == "box":
        return Body(o.name, (Solid("box", o.pose, o.size),), partial(looks.thing, o))
    if o.kind == "cylinder":
        solid = Solid("cylinder", o.pose, (o.radius, o.radius, o.length))
        return Body(o.name, (solid,), partial(looks.thing, o))
    hull = Look(o.colour, file=o.mesh, pose=o.pose, scale=o.scale)
    return Body(o.name, (), partial(looks.thing, o), hull=hull, pieces=o.hulls)
