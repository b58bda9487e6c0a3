"""Scene objects as solids: boxes and cylinders to keep clear of, meshes to look at.

    for body in bodies(cell): body.name, body.solids, body.looks

A curved panel becomes flat boxes along the arc (0.35 mm off the true cylinder at a radius of 1.6 m)
for distances, which stay convex and fast, and a smooth mesh for the eye.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from pn2code.robot.commands import Pose
from pn2code.robot.models.shapes import Mesh, block, rod, skin
from pn2code.robot.scene import Colour, PanelConfig, RobotCell, SceneObject
from pn2code.robot.transforms import Array, matrix_of, pose_of

_SEGMENT = math.radians(2.5)  # arc of one flat piece of the skin
_PRIMER = (0.62, 0.68, 0.52, 1.0)  # the green of zinc chromate primer
_SKIN = (0.78, 0.80, 0.82, 1.0)
_RIVET = (0.50, 0.52, 0.55, 1.0)
_STEEL = (0.32, 0.35, 0.40, 1.0)
_FLOOR = (0.70, 0.71, 0.72, 1.0)
_PEDESTAL = (0.24, 0.26, 0.30, 1.0)
_STRIPE = (0.92, 0.72, 0.08, 1.0)


@dataclass(frozen=True, slots=True)
class Solid:
    """A box (full lengths) or a cylinder (radius, radius, length along z), placed in the world."""

    kind: str
    pose: Pose
    size: tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Look:
    """Something to see: a mesh in world coordinates, or a mesh file in place."""

    colour: Colour
    mesh: Mesh | None = None
    file: Path | None = None
    pose: Pose = field(default_factory=lambda: Pose(0, 0, 0, 0, 0, 0))
    scale: float = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A part of the scene that stands still.

    Args:
        name: as in contact rules and messages: "panel/skin".
        solids: what distances are measured to; hull: or the convex hull of a mesh file.
        ignored_by: robots that stand on it: their base link is not tested against it.
    """

    name: str
    solids: tuple[Solid, ...]
    looks: tuple[Look, ...]
    hull: Look | None = None
    ignored_by: tuple[str, ...] = ()


def bodies(cell: RobotCell) -> tuple[Body, ...]:
    """Everything of the scene but the robots."""
    out: list[Body] = []
    scene = cell.scene
    if scene.floor:
        out.append(_floor(cell))
    for robot in cell.robots:
        if robot.base.z > 0.05:
            out.append(_pedestal(robot.name, robot.base))
    if scene.panel is not None:
        out += panel_bodies(scene.panel)
    out += [_object(o) for o in scene.objects]
    return tuple(out)


def _box(pose: Array, size: Sequence[float]) -> Solid:
    return Solid("box", pose_of(pose), (float(size[0]), float(size[1]), float(size[2])))


def _upright_box(low: Sequence[float], high: Sequence[float]) -> Solid:
    t = np.eye(4)
    t[:3, 3] = (np.asarray(low, float) + np.asarray(high, float)) / 2.0
    return _box(t, [b - a for a, b in zip(low, high, strict=True)])


def _floor(cell: RobotCell) -> Body:
    points = [(r.base.x, r.base.y) for r in cell.robots]
    if cell.scene.panel is not None:
        p = cell.scene.panel
        points += [(p.x_from, p.axis_y - p.radius), (p.x_to, p.axis_y)]
    points = points or [(0.0, 0.0)]
    low = [min(v) - 2.2 for v in zip(*points, strict=True)]
    high = [max(v) + 2.2 for v in zip(*points, strict=True)]
    solid = _upright_box((*low, -0.1), (*high, 0.0))
    plate = block((*low, -0.1), (*high, 0.0), 0.02, 0.005)
    lines = Mesh()
    m = 0.35
    for y in (low[1] + m, high[1] - m):
        lines = lines + block(
            (low[0] + m, y - 0.05, 0.001), (high[0] - m, y + 0.05, 0.005), 0.01, 0.001
        )
    for x in (low[0] + m, high[0] - m):
        lines = lines + block(
            (x - 0.05, low[1] + m, 0.001), (x + 0.05, high[1] - m, 0.005), 0.01, 0.001
        )
    names = tuple(r.name for r in cell.robots)
    return Body("floor", (solid,), (Look(_FLOOR, plate), Look(_STRIPE, lines)), None, names)


def _pedestal(robot: str, base: Pose) -> Body:
    """What a robot whose base is above the floor stands on."""
    half = 0.46
    t = matrix_of(Pose(base.x, base.y, 0.0, 0.0, 0.0, base.rz))
    column = block(
        (-half + 0.08, -half + 0.08, 0.03), (half - 0.08, half - 0.08, base.z - 0.04), 0.06
    )
    plates = block((-half - 0.08, -half - 0.08, 0.0), (half + 0.08, half + 0.08, 0.03), 0.04)
    plates = plates + block((-half, -half, base.z - 0.04), (half, half, base.z), 0.04)
    solid_pose = t.copy()
    solid_pose[2, 3] = base.z / 2.0
    looks = tuple(
        Look(colour, mesh.moved(t[:3, 3], t[:3, :3]))
        for colour, mesh in ((_PEDESTAL, column), (_STEEL, plates))
    )
    solids = (_box(solid_pose, (2 * half, 2 * half, base.z)),)
    return Body(f"{robot}_pedestal", solids, looks, None, (robot,))


def panel_bodies(p: PanelConfig) -> list[Body]:
    """Skin, ribs with stringers, and stands of a panel: "panel/skin", "panel/ribs", "panel/stand"."""
    arcs = _cut(p.arc_from, p.arc_to)
    outside, inside = p.radius + p.skin / 2, p.radius - p.skin / 2
    looks = [Look(_SKIN, _shell_mesh(p, p.x_from, p.x_to, outside, inside))]
    fasteners = _fasteners(p, outside)
    if fasteners.triangles:
        looks.append(Look(_RIVET, fasteners))
    flat = tuple(_shell(p, a, b, p.x_from, p.x_to, p.radius, p.skin) for a, b in arcs)
    out = [Body("panel/skin", flat, tuple(looks))]
    inner = p.radius - p.skin / 2.0
    frames: list[Solid] = []
    mesh = Mesh()
    for x in p.ribs:
        x0, x1 = x - p.rib_thickness / 2, x + p.rib_thickness / 2
        middle = inner - p.rib_height / 2
        frames += [_shell(p, a, b, x0, x1, middle, p.rib_height) for a, b in arcs]
        mesh = mesh + _shell_mesh(p, x0, x1, inner, inner - p.rib_height)
        # A flange makes a Z-section of the rib, as airframes have; it is inside the rib's solid but
        # for its width, which gets a solid of its own.
        f0, f1 = x0 - 0.0, x1 + 0.022
        low = inner - p.rib_height
        frames += [_shell(p, a, b, f0, f1, low + 0.002, 0.004) for a, b in arcs]
        mesh = mesh + _shell_mesh(p, f0, f1, low + 0.004, low)
    for angle in _stringers(p):
        h = p.stringer_height
        frames.append(_strip(p, angle, inner - h / 2, 0.02, h))
        mesh = mesh + _strip_mesh(p, angle, inner - h / 2, 0.02, h)
    if frames:
        out.append(Body("panel/ribs", tuple(frames), (Look(_PRIMER, mesh),)))
    if p.stands:
        out.append(_stands(p))
    return out


def _cut(start: float, end: float) -> list[tuple[float, float]]:
    count = max(1, math.ceil((end - start) / _SEGMENT))
    edges = np.linspace(start, end, count + 1).tolist()
    return list(zip(edges, edges[1:], strict=False))


def point_at(p: PanelConfig, angle: float, radius: float) -> tuple[float, float]:
    """(y, z) at an arc angle and a radius."""
    a = p.facing + angle
    return p.axis_y + radius * math.cos(a), p.axis_z + radius * math.sin(a)


def _frame(p: PanelConfig, angle: float, x: float, radius: float) -> Array:
    """A frame on the shell: x along the axis, y around, z outwards... as a 4x4."""
    a = p.facing + angle
    y, z = point_at(p, angle, radius)
    out = np.eye(4)
    out[:3, 1] = (0.0, -math.sin(a), math.cos(a))
    out[:3, 2] = (0.0, math.cos(a), math.sin(a))
    # Right-handed: x = y cross z.
    out[:3, 0] = np.cross(out[:3, 1], out[:3, 2])
    out[:3, 3] = (x, y, z)
    return out


def _shell(
    p: PanelConfig, a: float, b: float, x0: float, x1: float, radius: float, thick: float
) -> Solid:
    """A flat piece of shell between two arc angles; chords as long as the outer arc."""
    chord = 2.0 * (radius + thick / 2.0) * math.tan((b - a) / 2.0)
    frame = _frame(p, (a + b) / 2.0, (x0 + x1) / 2.0, radius)
    return _box(frame, (x1 - x0, chord, thick))


def _strip(p: PanelConfig, angle: float, radius: float, width: float, height: float) -> Solid:
    frame = _frame(p, angle, (p.x_from + p.x_to) / 2.0, radius)
    return _box(frame, (p.x_to - p.x_from, width, height))


def _strip_mesh(p: PanelConfig, angle: float, radius: float, width: float, height: float) -> Mesh:
    frame = _frame(p, angle, (p.x_from + p.x_to) / 2.0, radius)
    half = (p.x_to - p.x_from) / 2.0
    web = block((-half, -0.0015, -height / 2), (half, 0.0015, height / 2), 0.001, 0.0005)
    cap = block(
        (-half, -width / 2, -height / 2), (half, width / 2, -height / 2 + 0.003), 0.001, 0.0005
    )
    return (web + cap).moved(frame[:3, 3], frame[:3, :3])


def _stringers(p: PanelConfig) -> list[float]:
    if p.stringer_pitch <= 0.0:
        return []
    # Half a pitch beside angle 0, where the work is done.
    first = math.ceil(p.arc_from / p.stringer_pitch - 0.5)
    last = math.floor(p.arc_to / p.stringer_pitch - 0.5)
    return [(k + 0.5) * p.stringer_pitch for k in range(first, last + 1)]


def _shell_mesh(p: PanelConfig, x0: float, x1: float, outer: float, inner: float) -> Mesh:
    angles = np.linspace(
        p.arc_from, p.arc_to, max(2, math.ceil((p.arc_to - p.arc_from) / _SEGMENT)) * 2 + 1
    )
    rings = []
    for angle in angles.tolist():
        y0, z0 = point_at(p, angle, outer)
        y1, z1 = point_at(p, angle, inner)
        rings.append(np.array([[x0, y0, z0], [x0, y1, z1], [x1, y1, z1], [x1, y0, z0]]))
    return skin(rings)


def _fasteners(p: PanelConfig, radius: float) -> Mesh:
    """To look at only: rivet heads along ribs and stringers, and the joint line at arc angle 0."""
    out = Mesh()
    head = skin([_ring(0.0075, 0.0), _ring(0.005, 0.002)], caps=False)
    head = head + skin([_ring(0.005, 0.002), _ring(0.0, 0.002)], caps=False)
    places = [
        (x, angle)
        for x in p.ribs
        for angle in np.arange(p.arc_from + 0.02, p.arc_to - 0.02, 0.06 / p.radius).tolist()
    ]
    places += [
        (float(x), angle)
        for angle in _stringers(p)
        for x in np.arange(p.x_from + 0.05, p.x_to - 0.05, 0.1)
    ]
    for x, angle in places:
        if p.joint and abs(angle) * p.radius < 0.05:
            continue
        frame = _frame(p, angle, x, radius)
        out = out + head.moved(frame[:3, 3], frame[:3, :3])
    if p.joint:
        length = p.x_to - p.x_from
        for offset in (-0.03, 0.0, 0.03):
            wide = 0.002 if offset == 0.0 else 0.0006
            frame = _frame(p, offset / p.radius, (p.x_from + p.x_to) / 2, radius)
            strip = block((-length / 2, -wide, -0.0005), (length / 2, wide, 0.001), 0.0003, 0.0002)
            out = out + strip.moved(frame[:3, 3], frame[:3, :3])
    return out


def _ring(radius: float, z: float, count: int = 6) -> Array:
    a = np.arange(count) * (2.0 * math.pi / count)
    return np.stack([radius * np.cos(a), radius * np.sin(a), np.full(count, z)], axis=1)


def _stands(p: PanelConfig) -> Body:
    """Two end frames: an arc that holds the panel's edge, two posts, and a floor beam."""
    solids: list[Solid] = []
    steel, pads = Mesh(), Mesh()
    arcs = _cut(p.arc_from, p.arc_to)
    for x0, x1 in ((p.x_from - 0.06, p.x_from), (p.x_to, p.x_to + 0.06)):
        radius = p.radius - 0.04
        solids += [_shell(p, a, b, x0, x1, radius, 0.10) for a, b in arcs]
        steel = steel + _shell_mesh(p, x0, x1, radius + 0.05, radius - 0.05)
        ends = [point_at(p, a, radius) for a in (p.arc_from, p.arc_to)]
        low, high = sorted(ends, key=lambda e: e[1])
        posts = []
        for y, z in (low, high):
            # The post of the upper edge stands inside, clear of the arc.
            if z > 0.15:
                posts.append(y)
                size = ((x0, y - 0.05, 0.02), (x1, y + 0.05, z))
                solids.append(_upright_box(*size))
                steel = steel + block(*size, 0.012)
        inward = 0.6 if high[0] >= low[0] else -0.6
        y_low, y_high = min([*posts, low[0]]) - 0.25, max([*posts, high[0] + inward]) + 0.1
        beam = ((x0 - 0.03, y_low, 0.0), (x1 + 0.03, y_high, 0.08))
        solids.append(_upright_box(*beam))
        steel = steel + block(*beam, 0.02)
        for y in (y_low + 0.06, y_high - 0.06):
            pads = pads + rod("z", 0.08, 0.11, 0.03, ((x0 + x1) / 2, y, 0.0))
    return Body("panel/stand", tuple(solids), (Look(_STEEL, steel), Look(_STRIPE, pads)))


def _object(o: SceneObject) -> Body:
    t = matrix_of(o.pose)
    if o.kind == "box":
        x, y, z = (v / 2 for v in o.size)
        look = Look(
            o.colour, block((-x, -y, -z), (x, y, z), 0.01, 0.004).moved(t[:3, 3], t[:3, :3])
        )
        return Body(o.name, (Solid("box", o.pose, o.size),), (look,))
    if o.kind == "cylinder":
        mesh = rod("z", -o.length / 2, o.length / 2, o.radius).moved(t[:3, 3], t[:3, :3])
        solid = Solid("cylinder", o.pose, (o.radius, o.radius, o.length))
        return Body(o.name, (solid,), (Look(o.colour, mesh),))
    look = Look(o.colour, file=o.mesh, pose=o.pose, scale=o.scale)
    return Body(o.name, (), (look,), hull=look)
