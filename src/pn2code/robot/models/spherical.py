"""Arms of several makers with a spherical wrist: published dimensions, zero positions, limits and speeds of the axes.

Each is given by where its axes are when all of them are at zero, as its maker counts them, so that joint positions mean
the same here as on the real arm. The shapes are our own: housings about the joints, and tubes between them; the upper
arm runs beside the forearm.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from pn2code.base.frozen import frozen
from pn2code.robot.models.shapes import Mesh, lathe, rod
from pn2code.robot.models.urdf_text import (
    HEAD,
    Parts,
    Shapes,
    cylinder,
    fixed,
    held,
    link_text,
    materials,
    origin,
)

Place = tuple[float, float, float]


@frozen
class SphericalSpec:
    """An arm class, in m, degrees and degrees per second.

    Args:
        places: of each axis in the frame of the one before, at zero; upper arms stand upright.
        axes: their directions at zero: of 1 about z, of 2, 3 and 5 about y, of 4 and 6 along the forearm, "x" or "z";
            a minus turns them the other way.
        flange: how far it is from the middle of the wrist.
        mount: roll, pitch and yaw of the flange at zero.
        radii: of the housings at the shoulder, the elbow and the wrist.
        colour: of what is painted.
        data: what else is known of it, as `pn2code` elements.
    """

    name: str
    places: tuple[Place, ...]
    axes: tuple[str, ...]
    flange: float
    mount: Place
    limits: tuple[tuple[float, float], ...]
    speeds: tuple[float, ...]
    radii: tuple[float, float, float]
    colour: str
    data: str = ""


def _payload(mass: float, moments: str = "") -> str:
    """Its rated payload, kg, and the moments (Nm) about axes 4, 5 and 6."""
    more = f' moments="{moments}"' if moments else ""
    return f'  <pn2code payload="{mass:g}"{more}/>\n'


def _coupled(low: float, high: float) -> str:
    """Axis 3 as its maker counts it, in degrees."""
    return (
        f'  <pn2code coupled="joint_3" with="joint_2" factor="-1" lower="{math.radians(low)!r}" '
        f'upper="{math.radians(high)!r}"/>\n'
    )


SPHERICAL = (
    SphericalSpec(
        "irb6700_200_260",
        ((0, 0, 0.78), (0.32, 0, 0), (0, 0, 1.125), (0, 0, 0.2), (1.1425, 0, 0), (0, 0, 0)),
        ("z", "y", "y", "x", "y", "x"),
        0.2,
        (0, 90, 0),
        ((-170, 170), (-65, 85), (-180, 70), (-300, 300), (-130, 130), (-360, 360)),
        (110, 110, 110, 190, 150, 210),
        (0.25, 0.18, 0.11),
        "orange",
        held("payload and reach are in the name that ABB gives the variant") + _payload(200),
    ),
    SphericalSpec(
        "gp25",
        ((0, 0, 0.505), (0.15, 0, 0), (0, 0, 0.76), (0, 0, 0.2), (0.795, 0, 0), (0, 0, 0)),
        ("z", "y", "-y", "-x", "-y", "-x"),
        0.1,
        (180, -90, 0),
        ((-180, 180), (-105, 155), (-86, 160), (-200, 200), (-150, 150), (-455, 455)),
        (210, 210, 265, 420, 420, 885),
        (0.15, 0.12, 0.06),
        "blue",
        held("payload is in the name that Yaskawa gives the arm; moments by nothing")
        + _payload(25, "52 52 32"),
    ),
    SphericalSpec(
        "tx2_90",
        ((0, 0, 0.478), (0.05, 0, 0), (0, 0.05, 0.425), (0, 0, 0), (0, 0, 0.425), (0, 0, 0)),
        ("z", "y", "y", "z", "y", "z"),
        0.1,
        (0, 0, 0),
        ((-180, 180), (-130, 147.5), (-145, 145), (-270, 270), (-115, 140), (-270, 270)),
        (400, 400, 430, 540, 475, 760),
        (0.10, 0.08, 0.05),
        "yellow",
    ),
    SphericalSpec(
        "lrmate200id",
        ((0, 0, 0.33), (0.05, 0, 0), (0, 0, 0.33), (0, 0, 0.035), (0.335, 0, 0), (0, 0, 0)),
        ("z", "y", "-y", "-x", "-y", "-x"),
        0.08,
        (180, -90, 0),
        ((-170, 170), (-100, 145), (-70, 205), (-190, 190), (-125, 125), (-360, 360)),
        (450, 380, 520, 550, 545, 1000),
        (0.075, 0.06, 0.035),
        "yellow",
        held(
            "limits and speeds by FANUC, B-83494EN/03, as in fanuc_lrmate200id_support (axis 3: its span "
            "of 420 degrees); payload by FANUC's product page, as others quote it; moments by nothing"
        )
        + _payload(7, "16.6 16.6 9.4")
        # The maker counts axis 3 from the horizontal: where axis 2 moves alone, the forearm keeps its direction.
        + _coupled(-215, 205),
    ),
)
_BEVEL = 0.008


def spherical(out: dict[str, str]) -> None:
    """Writes all of them and their meshes into `out`: relative name -> text."""
    for spec in SPHERICAL:
        _arm(spec, out)


def _solid(
    axis: str, start: float, end: float, radius: float, at: Place = (0, 0, 0)
) -> tuple[Mesh, str]:
    """A cylinder, as a mesh and as a collision shape."""
    return (
        rod(axis, start, end, radius, at, min(_BEVEL, 0.2 * radius)),
        cylinder(axis, start, end, radius, at),
    )


Solid = tuple[Mesh, str]


def _link(painted: Sequence[Solid], grey: Sequence[Solid], colour: str) -> tuple[Shapes, Parts]:
    """A link of painted solids and grey ones."""
    shapes: Shapes = {}
    for name, solids in ((colour, painted), ("grey", grey)):
        for mesh, _ in solids:
            shapes[name] = shapes[name] + mesh if name in shapes else mesh
    return shapes, [part for _, part in (*painted, *grey)]


def _links(spec: SphericalSpec) -> dict[str, tuple[Shapes, Parts]]:
    big, middle, small = spec.radii
    height, ahead = spec.places[0][2], spec.places[1][0]
    sideways, upper, rise = spec.places[2][1], spec.places[2][2], spec.places[3][2]
    along = spec.axes[3][-1]
    fore = spec.places[4]["xyz".index(along)]
    thin = 0.7 * middle
    # The upper arm is beside the forearm, so that the elbow can fold.
    beside = sideways - middle - thin - 0.01
    top = height - 1.35 * big
    foot = lathe("z", [(0.0, 1.3 * big), (0.03, 1.3 * big), (0.05, 1.1 * big), (top, big)])
    base = ({"grey": foot}, [cylinder("z", 0.0, top, 1.15 * big, (0, 0, 0))])
    column = [_solid("z", -1.35 * big, 0.0, 0.95 * big)]
    column.append(_solid("y", beside + thin, 0.8 * big, big, (ahead, 0, 0)))
    arm = [
        _solid("y", beside - thin, beside + thin - 0.004, 0.95 * big),
        _solid("z", 0.0, upper, thin, (0, beside, 0)),
        _solid("y", beside - thin, beside + thin - 0.004, 0.95 * middle, (0, 0, upper)),
    ]
    elbow = [_solid("y", beside + thin - sideways, middle, middle)]
    if rise:
        elbow.append(_solid("z", 0.0, rise + 0.8 * middle, 0.9 * middle))
    start = middle if rise else 0.9 * middle
    tube = 0.75 * middle
    forearm = [_solid(along, start, 0.6 * fore, tube), _solid(along, 0.6 * fore, fore, small)]
    wrist = [_solid("y", -small, small, 0.95 * small)]
    disc = [_solid(along, 0.9 * small, spec.flange, 0.8 * small)]
    return {
        "base_link": base,
        "link_1": _link(column, [], spec.colour),
        "link_2": _link(arm[1:2], [arm[0], arm[2]], spec.colour),
        "link_3": _link(elbow, [], spec.colour),
        "link_4": _link(forearm, [], spec.colour),
        "link_5": _link([], wrist, spec.colour),
        "link_6": _link([], disc, spec.colour),
    }


_DIRECTIONS = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}


def _direction(axis: str) -> str:
    text = _DIRECTIONS[axis[-1]]
    return text.replace("1", "-1") if axis.startswith("-") else text


def _arm(spec: SphericalSpec, out: dict[str, str]) -> None:
    contents = _links(spec)
    links = [
        link_text(name, f"{spec.name}_{name}", "", content, out)
        for name, content in contents.items()
    ]
    links.append(link_text("flange", "", "", None, out))
    joints = []
    for i, place in enumerate(spec.places):
        low, high = (math.radians(v) for v in spec.limits[i])
        parent = f"link_{i}" if i else "base_link"
        joints.append(
            f'  <joint name="joint_{i + 1}" type="revolute">{origin(place, "0 0 0")}'
            f'<parent link="{parent}"/><child link="link_{i + 1}"/>'
            f'<axis xyz="{_direction(spec.axes[i])}"/>\n'
            f'    <limit lower="{low!r}" upper="{high!r}" effort="0" '
            f'velocity="{math.radians(spec.speeds[i])!r}"/></joint>\n'
        )
    end = [spec.flange if name == spec.axes[5][-1] else 0.0 for name in "xyz"]
    turn = " ".join(repr(math.radians(v)) for v in spec.mount)
    flange = fixed("mount", "link_6", "flange", origin(end, turn))
    used = sorted({c for shapes, _ in contents.values() for c in shapes})
    # Never tested against each other: neighbours, and what meets in the wrist.
    ignore = '  <pn2code ignore="link_4+link_6 link_4+flange"/>\n'
    out[f"{spec.name}.urdf"] = (
        f'{HEAD}<robot name="{spec.name}">\n{materials(used)}'
        f"{''.join(links)}{''.join(joints)}{flange}{ignore}{spec.data}</robot>\n"
    )
