"""What scene objects look like: smooth meshes, made only where somebody looks.

They take longer to make than the solids that distances are measured to (`geometry`), and a check of a cell needs none.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import field
from pathlib import Path

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.commands import Pose
from pn2code.robot.models.shapes import Mesh, block, rod, skin
from pn2code.robot.panel import (
    FLANGE,
    SEGMENT,
    frame,
    point_at,
    stand_parts,
    stand_places,
    stringers,
)
from pn2code.robot.robot_cell import PanelConfig
from pn2code.robot.scene_objects import Colour, SceneObject
from pn2code.robot.transforms import Array, matrix_of
from pn2code.robot.zones_table import Zone

_PRIMER = (0.62, 0.68, 0.52, 1.0)  # the green of zinc chromate primer
_SKIN = (0.78, 0.80, 0.82, 1.0)
_RIVET = (0.50, 0.52, 0.55, 1.0)
_STEEL = (0.32, 0.35, 0.40, 1.0)
_FLOOR = (0.70, 0.71, 0.72, 1.0)
_PEDESTAL = (0.24, 0.26, 0.30, 1.0)
_STRIPE = (0.92, 0.72, 0.08, 1.0)

_PEOPLE = (0.90, 0.62, 0.0, 1.0)
_SEEN = (0.0, 0.45, 0.70, 1.0)
_BROKEN = (0.84, 0.37, 0.0, 1.0)
_EDGE, _EDGE_BROKEN = 0.012, 0.035
"""m: how thick the edges of zones are drawn."""


@frozen(eq=False)
class Look:
    """Something to see: a mesh in world coordinates, or a mesh file in place."""

    colour: Colour
    mesh: Mesh | None = None
    file: Path | None = None
    pose: Pose = field(default_factory=lambda: Pose(0, 0, 0, 0, 0, 0))
    scale: float = 1.0


def floor(low: Sequence[float], high: Sequence[float]) -> tuple[Look, ...]:
    """A plate with a yellow line around."""
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
    return Look(_FLOOR, plate), Look(_STRIPE, lines)


def pedestal(half: float, base: Pose) -> tuple[Look, ...]:
    """A column between two plates, under a robot's base."""
    t = matrix_of(Pose(base.x, base.y, 0.0, 0.0, 0.0, base.rz))
    column = block(
        (-half + 0.08, -half + 0.08, 0.03), (half - 0.08, half - 0.08, base.z - 0.04), 0.06
    )
    plates = block((-half - 0.08, -half - 0.08, 0.0), (half + 0.08, half + 0.08, 0.03), 0.04)
    plates = plates + block((-half, -half, base.z - 0.04), (half, half, base.z), 0.04)
    return tuple(
        Look(colour, mesh.moved(t[:3, 3], t[:3, :3]))
        for colour, mesh in ((_PEDESTAL, column), (_STEEL, plates))
    )


def skin_of_panel(p: PanelConfig) -> tuple[Look, ...]:
    """A smooth shell, and the heads of its rivets."""
    outside, inside = p.radius + p.skin / 2, p.radius - p.skin / 2
    shell = Look(_SKIN, _shell_mesh(p, p.x_from, p.x_to, outside, inside))
    fasteners = _fasteners(p, outside)
    return (shell, Look(_RIVET, fasteners)) if fasteners.triangles else (shell,)


def ribs(p: PanelConfig) -> tuple[Look, ...]:
    """Ribs with their flanges, and stringers."""
    inner = p.radius - p.skin / 2.0
    low = inner - p.rib_height
    mesh = Mesh()
    for x in p.ribs:
        x0, x1 = x - p.rib_thickness / 2, x + p.rib_thickness / 2
        mesh = mesh + _shell_mesh(p, x0, x1, inner, low)
        mesh = mesh + _shell_mesh(p, x0, x1 + FLANGE, low + 0.004, low)
    for angle in stringers(p):
        h = p.stringer_height
        mesh = mesh + _strip_mesh(p, angle, inner - h / 2, 0.02, h)
    return (Look(_PRIMER, mesh),)


def stands(p: PanelConfig) -> tuple[Look, ...]:
    """End frames of steel on yellow pads."""
    steel, pads = Mesh(), Mesh()
    for x0, x1 in stand_places(p):
        steel = steel + _shell_mesh(p, x0, x1, p.radius + 0.01, p.radius - 0.09)
        posts, beam = stand_parts(p, x0, x1)
        for post in posts:
            steel = steel + block(*post, 0.012)
        steel = steel + block(*beam, 0.02)
        for y in (beam[0][1] + 0.06, beam[1][1] - 0.06):
            pads = pads + rod("z", 0.08, 0.11, 0.03, ((x0 + x1) / 2, y, 0.0))
    return Look(_STEEL, steel), Look(_STRIPE, pads)


def thing(o: SceneObject) -> tuple[Look, ...]:
    """A box, a cylinder, or what its file has."""
    t = matrix_of(o.pose)
    if o.kind == "mesh":
        return (Look(o.colour, file=o.mesh, pose=o.pose, scale=o.scale),)
    if o.kind == "box":
        x, y, z = (v / 2 for v in o.size)
        mesh = block((-x, -y, -z), (x, y, z), 0.01, 0.004)
    else:
        mesh = rod("z", -o.length / 2, o.length / 2, o.radius)
    return (Look(o.colour, mesh.moved(t[:3, 3], t[:3, :3])),)


def zone(z: Zone, is_broken: bool) -> tuple[Look, ...]:
    """The twelve edges of a zone: amber where people may be, blue where a sensor looks, thick in vermilion if broken.

    Colour-blind people can tell these.
    """
    thick = _EDGE_BROKEN if is_broken else _EDGE
    half = np.array(z.size) / 2.0
    mesh = Mesh()
    for axis in range(3):
        for one in (-1.0, 1.0):
            for other in (-1.0, 1.0):
                middle = half * np.insert([one, other], axis, 0.0)
                reach = np.full(3, thick / 2.0)
                reach[axis] += half[axis]
                mesh = mesh + block(middle - reach, middle + reach, 0.001, 0.0005)
    colour = _BROKEN if is_broken else (_SEEN if z.max_speed is None else _PEOPLE)
    t = matrix_of(z.pose)
    return (Look(colour, mesh.moved(t[:3, 3], t[:3, :3])),)


def _strip_mesh(p: PanelConfig, angle: float, radius: float, width: float, height: float) -> Mesh:
    place = frame(p, angle, (p.x_from + p.x_to) / 2.0, radius)
    half = (p.x_to - p.x_from) / 2.0
    web = block((-half, -0.0015, -height / 2), (half, 0.0015, height / 2), 0.001, 0.0005)
    cap = block(
        (-half, -width / 2, -height / 2), (half, width / 2, -height / 2 + 0.003), 0.001, 0.0005
    )
    return (web + cap).moved(place[:3, 3], place[:3, :3])


def _shell_mesh(p: PanelConfig, x0: float, x1: float, outer: float, inner: float) -> Mesh:
    angles = np.linspace(
        p.arc_from, p.arc_to, max(2, math.ceil((p.arc_to - p.arc_from) / SEGMENT)) * 2 + 1
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
        for angle in stringers(p)
        for x in np.arange(p.x_from + 0.05, p.x_to - 0.05, 0.1)
    ]
    for x, angle in places:
        if p.joint and abs(angle) * p.radius < 0.05:
            continue
        place = frame(p, angle, x, radius)
        out = out + head.moved(place[:3, 3], place[:3, :3])
    if p.joint:
        length = p.x_to - p.x_from
        for offset in (-0.03, 0.0, 0.03):
            wide = 0.002 if offset == 0.0 else 0.0006
            place = frame(p, offset / p.radius, (p.x_from + p.x_to) / 2, radius)
            strip = block((-length / 2, -wide, -0.0005), (length / 2, wide, 0.001), 0.0003, 0.0002)
            out = out + strip.moved(place[:3, 3], place[:3, :3])
    return out


def _ring(radius: float, z: float, count: int = 6) -> Array:
    a = np.arange(count) * (2.0 * math.pi / count)
    return np.stack([radius * np.cos(a), radius * np.sin(a), np.full(count, z)], axis=1)
