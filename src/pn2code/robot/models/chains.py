"""Arms that are neither of the usual six axes nor collaborative: seven axes, a SCARA, a gantry.

Each is a chain of joints, with solids about them that are our own. Dimensions, limits and speeds of the first two are
the published ones; the gantry is of no maker.
"""

from __future__ import annotations

import math
from typing import Literal

from pn2code.base.frozen import frozen
from pn2code.robot.models.shapes import Mesh, block, rod
from pn2code.robot.models.urdf_text import (
    HEAD,
    Parts,
    Shapes,
    box,
    cylinder,
    fixed,
    held,
    link_text,
    materials,
    origin,
)

Place = tuple[float, float, float]
_BEVEL = 0.006


@frozen
class Step:
    """A joint: its place in the frame of the one before, its axis, limits and speed in degrees or m, and per second."""

    place: Place
    axis: str
    limits: tuple[float, float]
    speed: float
    kind: Literal["revolute", "prismatic"] = "revolute"


@frozen
class Rod:
    """A cylinder along x, y or z."""

    colour: str
    axis: str
    start: float
    end: float
    radius: float
    at: Place = (0, 0, 0)

    def solid(self) -> tuple[Mesh, str]:
        """As a mesh and as a collision shape."""
        bevel = min(_BEVEL, 0.2 * self.radius)
        return (
            rod(self.axis, self.start, self.end, self.radius, self.at, bevel),
            cylinder(self.axis, self.start, self.end, self.radius, self.at),
        )


@frozen
class Block:
    """A box between two corners."""

    colour: str
    low: Place
    high: Place

    def solid(self) -> tuple[Mesh, str]:
        """As a mesh and as a collision shape."""
        return block(self.low, self.high, _BEVEL), box(self.low, self.high)


Solid = Rod | Block


@frozen
class ChainSpec:
    """An arm.

    Args:
        links: solids of the base and of each link after its joint.
        flange: its place after the last joint; mount: its roll, pitch and yaw there, in degrees.
        ignore: pairs of links that are never tested against each other.
        data: what else is known of it, as a `pn2code` element; "": nothing.
    """

    name: str
    steps: tuple[Step, ...]
    links: tuple[tuple[Solid, ...], ...]
    flange: Place
    mount: Place
    ignore: str
    data: str = ""


def _limb(colour: str, length: float, radius: float) -> tuple[Solid, ...]:
    """A tube from a joint to the next one, which turns about y there."""
    return (
        Rod("silver", "z", 0.0, length - 0.02, radius),
        Rod(colour, "y", -radius, radius, radius, (0, 0, length)),
    )


CHAINS = (
    ChainSpec(
        "iiwa14_r820",
        (
            Step((0, 0, 0.1575), "0 0 1", (-170, 170), 85),
            Step((0, 0, 0.2025), "0 1 0", (-120, 120), 85),
            Step((0, 0, 0.2045), "0 0 1", (-170, 170), 100),
            Step((0, 0, 0.2155), "0 -1 0", (-120, 120), 75),
            Step((0, 0, 0.1845), "0 0 1", (-170, 170), 130),
            Step((0, 0, 0.2155), "0 1 0", (-120, 120), 135),
            Step((0, 0, 0.081), "0 0 1", (-175, 175), 135),
        ),
        (
            (Rod("silver", "z", 0.0, 0.15, 0.095),),
            _limb("orange", 0.2025, 0.08),
            (Rod("silver", "z", 0.05, 0.2, 0.075),),
            _limb("orange", 0.2155, 0.075),
            (Rod("silver", "z", 0.05, 0.18, 0.07),),
            _limb("orange", 0.2155, 0.06),
            (Rod("silver", "z", 0.0, 0.075, 0.05),),
            (Rod("grey", "z", 0.0, 0.045, 0.045),),
        ),
        (0, 0, 0.045),
        (0, 0, 0),
        "link_1+link_3 link_3+link_5 link_5+link_7 link_5+flange link_6+flange",
        held(
            "speeds by KUKA, Spez LBR iiwa (axis data of LBR iiwa 14 R820), as Drake quotes it; payload is "
            "in the name that KUKA gives the arm"
        )
        + '  <pn2code payload="14"/>\n',
    ),
    ChainSpec(
        "cobra_s600",
        (
            Step((0, 0, 0.342), "0 0 1", (-105, 105), 386),
            Step((0.325, 0, 0), "0 0 1", (-150, 150), 720),
            Step((0.275, 0, 0.145), "0 0 -1", (0, 0.21), 1.1, "prismatic"),
            Step((0, 0, 0), "0 0 1", (-360, 360), 1200),
        ),
        (
            (
                Block("grey", (-0.1, -0.09, 0.0), (0.09, 0.09, 0.02)),
                Rod("grey", "z", 0.0, 0.32, 0.085),
            ),
            (
                Rod("silver", "z", -0.01, 0.06, 0.085),
                Block("silver", (0.0, -0.06, 0.0), (0.325, 0.06, 0.05)),
                Rod("silver", "z", 0.0, 0.05, 0.06, (0.325, 0, 0)),
            ),
            (
                Rod("silver", "z", 0.06, 0.2, 0.06),
                Block("silver", (0.0, -0.055, 0.06), (0.275, 0.055, 0.16)),
                Rod("silver", "z", 0.06, 0.2, 0.055, (0.275, 0, 0)),
            ),
            (Rod("steel", "z", -0.08, 0.2, 0.01),),
            (Rod("steel", "z", -0.1, -0.08, 0.025),),
        ),
        (0, 0, -0.1),
        (180, 0, 0),
        "link_2+link_4 link_2+flange link_3+flange",
        held(
            "axes, heights, limits and speeds by ROS-Industrial, adept_cobra_s600_support; payload by "
            "nothing"
        )
        + '  <pn2code payload="5.5"/>\n',
    ),
    ChainSpec(
        "gantry_3000",
        (
            Step((0, 0, 2.3), "1 0 0", (0, 3.0), 2.0, "prismatic"),
            Step((0, 0, 0), "0 1 0", (-1.0, 1.0), 2.0, "prismatic"),
            Step((0, 0, 0), "0 0 -1", (0, 1.2), 1.5, "prismatic"),
            Step((0, 0, -0.55), "0 0 1", (-180, 180), 180),
        ),
        (
            tuple(
                solid
                for y in (-1.5, 1.5)
                for solid in (
                    Block("grey", (-0.5, y - 0.08, 2.06), (3.5, y + 0.08, 2.2)),
                    *(
                        Block("grey", (x - 0.08, y - 0.08, 0.0), (x + 0.08, y + 0.08, 2.06))
                        for x in (-0.42, 3.42)
                    ),
                )
            ),
            (
                Block("silver", (-0.35, -1.6, -0.08), (-0.15, 1.6, 0.16)),
                Block("silver", (-0.35, -1.6, -0.1), (0.15, -1.4, -0.02)),
                Block("silver", (-0.35, 1.4, -0.1), (0.15, 1.6, -0.02)),
            ),
            (Block("orange", (-0.14, -0.15, -0.12), (-0.08, 0.15, 0.2)),),
            (Block("steel", (-0.07, -0.07, -0.5), (0.07, 0.07, 1.0)),),
            (Rod("dark", "z", 0.0, 0.04, 0.05),),
        ),
        (0, 0, 0),
        (180, 0, 0),
        "link_1+link_3 link_3+flange",
    ),
)


def chains(out: dict[str, str]) -> None:
    """Writes all of them and their meshes into `out`: relative name -> text."""
    for spec in CHAINS:
        _arm(spec, out)


def _content(solids: tuple[Solid, ...]) -> tuple[Shapes, Parts]:
    shapes: Shapes = {}
    parts: Parts = []
    for solid in solids:
        mesh, part = solid.solid()
        shapes[solid.colour] = shapes[solid.colour] + mesh if solid.colour in shapes else mesh
        parts.append(part)
    return shapes, parts


def _arm(spec: ChainSpec, out: dict[str, str]) -> None:
    contents = [_content(solids) for solids in spec.links]
    names = ["base_link", *(f"link_{i + 1}" for i in range(len(spec.steps)))]
    links = [
        link_text(name, f"{spec.name}_{name}", "", content, out)
        for name, content in zip(names, contents, strict=True)
    ]
    links.append(link_text("flange", "", "", None, out))
    joints = []
    for i, step in enumerate(spec.steps):
        turn = math.radians if step.kind == "revolute" else float
        low, high = map(turn, step.limits)
        joints.append(
            f'  <joint name="joint_{i + 1}" type="{step.kind}">{origin(step.place, "0 0 0")}'
            f'<parent link="{names[i]}"/><child link="{names[i + 1]}"/><axis xyz="{step.axis}"/>\n'
            f'    <limit lower="{low!r}" upper="{high!r}" effort="0" '
            f'velocity="{turn(step.speed)!r}"/></joint>\n'
        )
    mount = " ".join(repr(math.radians(v)) for v in spec.mount)
    flange = fixed("mount", names[-1], "flange", origin(spec.flange, mount))
    used = sorted({c for shapes, _ in contents for c in shapes})
    # Never tested against each other: neighbours, and what meets in a joint.
    ignore = f'  <pn2code ignore="{spec.ignore}"/>\n'
    out[f"{spec.name}.urdf"] = (
        f'{HEAD}<robot name="{spec.name}">\n{materials(used)}'
        f"{''.join(links)}{''.join(joints)}{flange}{ignore}{spec.data}</robot>\n"
    )
