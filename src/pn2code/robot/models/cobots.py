"""Collaborative robots: six axes, of which 2, 3 and 4 are parallel.

Published dimensions of the classes, shapes of our own: housings with caps at the joints, and tubes between them. At
zero the arm is stretched out along x, and its last axis looks along y.
"""

from __future__ import annotations

import math

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


@frozen
class CobotSpec:
    """The published dimensions of a class, in m, degrees and degrees per second.

    Args:
        d1, a2, a3, d4, d5, d6: Denavit-Hartenberg lengths.
        shoulder: how far the upper arm stands beside the column; forearm: how far the forearm does.
        radii: of the housings at the shoulder, the elbow and the wrist.
        speeds: of the axes.
        payload: kg; source: where that can be read.
    """

    name: str
    d1: float
    a2: float
    a3: float
    d4: float
    d5: float
    d6: float
    shoulder: float
    forearm: float
    radii: tuple[float, float, float]
    speeds: tuple[float, ...]
    payload: float
    source: str


COBOTS = (
    CobotSpec(
        "ur10e", 0.1807, 0.6127, 0.57155, 0.17415, 0.11985, 0.11655, 0.176, 0.039,
        (0.085, 0.068, 0.052), (120, 120, 180, 180, 180, 180), 12.5,
        "payload by a list of others, of today's ur10e (before: 10 kg, so with full acceleration)",
    ),
    CobotSpec(
        "ur5e", 0.1625, 0.425, 0.3922, 0.1333, 0.0997, 0.0996, 0.138, 0.007,
        (0.068, 0.056, 0.046), (180, 180, 180, 180, 180, 180), 5.0,
        "payload by Universal Robots, Hardware Manual UR5e (stopping distances)",
    ),
)  # fmt: skip
_LIMITS = (360, 360, 165, 360, 360, 360)
_AXIS = ("0 0 1", "0 1 0", "0 1 0", "0 1 0", "0 0 -1", "0 1 0")


def _housing(axis: str, start: float, end: float, radius: float) -> tuple[Mesh, Mesh, str]:
    """A joint's housing with a cap at its end, and its collision shape."""
    low, high = min(start, end), max(start, end)
    body = rod(axis, low, high, radius, (0, 0, 0), 0.3 * radius)
    part = cylinder(axis, low, high, radius, (0, 0, 0))
    low, high = sorted((end, end + math.copysign(0.006, end - start)))
    cap = rod(axis, low, high, 0.8 * radius, (0, 0, 0), 0.002)
    return body, cap, part


def _tube(length: float, side: float, radius: float) -> tuple[Mesh, str]:
    return (
        rod("x", 0.0, length, radius, (0, side, 0), 0.004),
        cylinder("x", 0.0, length, radius, (0, side, 0)),
    )


def _links(spec: CobotSpec) -> dict[str, tuple[Shapes, Parts]]:
    big, middle, small = spec.radii
    foot = lathe("z", [(0.0, 1.15 * big), (0.02, 1.15 * big), (0.03, big), (spec.d1 - big, big)])
    base_top = spec.d1 - big
    column, column_cap, column_part = _housing("z", -big, 0.9 * big, big)
    reach = spec.shoulder - 0.9 * big
    neck = rod("y", 0.0, reach, 0.95 * big, (0, 0, 0), 0.01)
    shoulder, shoulder_cap, shoulder_part = _housing("y", -0.9 * big, big, big)
    upper, upper_part = _tube(spec.a2, 0.0, 0.75 * middle)
    # The elbow and the forearm stand nearer to the column than the upper arm.
    gap = spec.shoulder - spec.forearm
    knee = rod("y", -0.45 * gap, middle, middle, (spec.a2, 0, 0), 0.3 * middle)
    elbow, elbow_cap, elbow_part = _housing("y", 0.5 * gap, -0.8 * middle, middle)
    fore, fore_part = _tube(spec.a3, 0.0, 0.85 * small)
    hand = spec.d4 - spec.forearm
    end = rod("y", -small, hand - 1.1 * small, small, (spec.a3, 0, 0), 0.3 * small)
    wrist_1, cap_1, part_1 = _housing("y", -small, small, small)
    wrist_2, cap_2, part_2 = _housing("z", 0.0, -(spec.d5 - small), small)
    wrist_3, cap_3, part_3 = _housing("y", -small, small, small)
    disc = rod("y", small, spec.d6, 0.75 * small, (0, 0, 0), 0.003)
    return {
        "base_link": ({"silver": foot}, [cylinder("z", 0.0, base_top, 1.1 * big, (0, 0, 0))]),
        "link_1": (
            {"silver": column + neck, "sky": column_cap},
            [column_part, cylinder("y", 0.0, reach, 0.95 * big, (0, 0, 0))],
        ),
        "link_2": (
            {"silver": shoulder + upper + knee, "sky": shoulder_cap},
            [
                shoulder_part,
                upper_part,
                cylinder("y", -0.45 * gap, middle, middle, (spec.a2, 0, 0)),
            ],
        ),
        "link_3": (
            {"silver": elbow + fore + end, "sky": elbow_cap},
            [
                elbow_part,
                fore_part,
                cylinder("y", -small, hand - 1.1 * small, small, (spec.a3, 0, 0)),
            ],
        ),
        "link_4": ({"silver": wrist_1, "sky": cap_1}, [part_1]),
        "link_5": ({"silver": wrist_2, "sky": cap_2}, [part_2]),
        "link_6": (
            {"silver": wrist_3, "sky": cap_3, "dark": disc},
            [part_3, cylinder("y", small, spec.d6, 0.75 * small, (0, 0, 0))],
        ),
    }


def cobots(out: dict[str, str]) -> None:
    """Writes all of them and their meshes into `out`: relative name -> text."""
    for spec in COBOTS:
        _cobot(spec, out)


def _cobot(spec: CobotSpec, out: dict[str, str]) -> None:
    contents = _links(spec)
    links = [
        link_text(name, f"{spec.name}_{name}", "", content, out)
        for name, content in contents.items()
    ]
    links.append(link_text("flange", "", "", None, out))
    places = [
        (0.0, 0.0, spec.d1),
        (0.0, spec.shoulder, 0.0),
        (spec.a2, spec.forearm - spec.shoulder, 0.0),
        (spec.a3, spec.d4 - spec.forearm, 0.0),
        (0.0, 0.0, 0.0),
        (0.0, 0.0, -spec.d5),
    ]
    joints = []
    for i, place in enumerate(places):
        limit = math.radians(_LIMITS[i])
        parent = f"link_{i}" if i else "base_link"
        joints.append(
            f'  <joint name="joint_{i + 1}" type="revolute">{origin(place, "0 0 0")}'
            f'<parent link="{parent}"/><child link="link_{i + 1}"/><axis xyz="{_AXIS[i]}"/>\n'
            f'    <limit lower="{-limit!r}" upper="{limit!r}" effort="0" '
            f'velocity="{math.radians(spec.speeds[i])!r}"/></joint>\n'
        )
    flange = fixed("mount", "link_6", "flange", origin((0, spec.d6, 0), f"{-math.pi / 2!r} 0 0"))
    used = sorted({c for shapes, _ in contents.values() for c in shapes})
    # Never tested against each other: neighbours, and what meets at the shoulder and in the wrist.
    ignore = '  <pn2code ignore="base_link+link_2 link_3+link_5 link_4+link_6 link_4+flange"/>\n'
    data = held(spec.source) + f'  <pn2code payload="{spec.payload:g}"/>\n'
    out[f"{spec.name}.urdf"] = (
        f'{HEAD}<robot name="{spec.name}">\n{materials(used)}'
        f"{''.join(links)}{''.join(joints)}{flange}{ignore}{data}</robot>\n"
    )
