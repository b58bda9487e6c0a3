"""Makes the arms, the end effectors and their meshes: `python -m pn2code.robot.models.build`.

The dimensions that matter (axes, limits, speeds) are the published ones of the two arm classes; the
shapes are our own, drawn to look like castings, motors and covers of a large six-axis arm. Each link
has a few visual meshes (one a colour) and collision boxes and cylinders around them. A test compares
the files with what this module makes today.

At zero the arm is stretched out along x; the upper arm ("link 2") runs beside the forearm, on -y.
"""

from __future__ import annotations

import math
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.robot.models.chains import chains
from pn2code.robot.models.cobots import cobots
from pn2code.robot.models.shapes import (
    Mesh,
    block,
    bolts,
    lathe,
    loft,
    rod,
    slab,
    square,
)
from pn2code.robot.models.spherical import spherical
from pn2code.robot.models.urdf_text import (
    HEAD,
    Parts,
    Shapes,
    box,
    cylinder,
    fixed,
    link_text,
    materials,
    origin,
)


@frozen
class ArmSpec:
    """The published dimensions of an arm class, in m, degrees and degrees per second."""

    name: str
    d1: float
    a1: float
    a2: float
    offset: float
    d4: float
    d6: float
    limits: tuple[tuple[float, float], ...]
    speeds: tuple[float, ...]


_LIMITS = ((-185, 185), (-140, -5), (-120, 155), (-350, 350), (-125, 125), (-350, 350))
ARMS = (
    ArmSpec(
        "kr210_r2700", 0.675, 0.35, 1.15, 0.041, 1.2, 0.215, _LIMITS, (123, 115, 112, 179, 172, 219)
    ),
    ArmSpec(
        "kr120_r2500", 0.675, 0.35, 1.15, 0.041, 1.0, 0.215, _LIMITS, (136, 130, 120, 292, 258, 284)
    ),
)
_AXIS = ("0 0 -1", "0 1 0", "0 1 0", "-1 0 0", "0 1 0", "-1 0 0")


def _base() -> tuple[Shapes, Parts]:
    foot = loft(
        [
            (0.0, square(0.415, 0.07)),
            (0.045, square(0.415, 0.07)),
            (0.055, square(0.405, 0.07)),
            (0.055, square(0.345, 0.10)),
            (0.16, square(0.315, 0.14)),
            (0.25, square(0.300, 0.28)),
            (0.30, square(0.300, 0.29)),
        ]
    )
    plug = block((-0.50, -0.16, 0.10), (-0.28, 0.16, 0.24), 0.02)
    anchors = Mesh()
    for x in (-0.36, 0.36):
        for y in (-0.36, 0.36):
            anchors = anchors + rod("z", 0.055, 0.085, 0.028, (x, y, 0.0), 0.005)
    shapes = {
        "orange": foot,
        "dark": plug + lathe("z", [(0.30, 0.285), (0.365, 0.285)]),
        "steel": anchors,
    }
    parts = [
        box((-0.415, -0.415, 0.0), (0.415, 0.415, 0.06)),
        cylinder("z", 0.06, 0.36, 0.34, (0, 0, 0)),
        box((-0.50, -0.16, 0.10), (-0.28, 0.16, 0.24)),
    ]
    return shapes, parts


def _column() -> tuple[Shapes, Parts]:
    table = lathe("z", [(-0.315, 0.30), (-0.30, 0.335), (-0.25, 0.345), (-0.215, 0.30)])
    body = slab("xz", [(-0.19, -0.13, 0.11), (0.02, -0.16, 0.10), (0.34, -0.04, 0.19), (0.35, 0.0, 0.21)],
                -0.13, 0.21, 0.03)  # fmt: skip
    neck = slab("xz", [(-0.16, -0.2, 0.08), (0.2, -0.2, 0.08)], -0.24, 0.26, 0.03)
    motor_1 = rod("z", -0.08, 0.20, 0.085, (-0.17, 0.08, 0.0)) + rod(
        "z", 0.20, 0.27, 0.07, (-0.17, 0.08, 0.0)
    )
    motor_2 = rod("y", 0.205, 0.42, 0.115, (0.35, 0, 0)) + rod("y", 0.42, 0.50, 0.09, (0.35, 0, 0))
    spring = rod("x", -0.42, 0.10, 0.095, (0.0, -0.235, -0.035), 0.02)
    shapes = {
        "orange": table + body + neck,
        "dark": motor_1 + motor_2 + rod("y", -0.15, -0.12, 0.17, (0.35, 0, 0)),
        "grey": spring,
        "steel": rod("x", -0.435, -0.415, 0.07, (0.0, -0.235, -0.035), 0.006)
        + rod("x", 0.09, 0.16, 0.035, (0.0, -0.235, -0.035), 0.004)
        + bolts("y", 0.21, 0.155, 12, 0.012, (0.35, 0, 0)),
    }
    parts = [
        cylinder("z", -0.315, -0.215, 0.345, (0, 0, 0)),
        box((-0.30, -0.13, -0.28), (0.14, 0.21, -0.02)),
        box((0.14, -0.13, -0.26), (0.42, 0.21, 0.05)),
        cylinder("y", -0.15, 0.21, 0.21, (0.35, 0, 0)),
        cylinder("y", 0.21, 0.50, 0.115, (0.35, 0, 0)),
        cylinder("z", -0.08, 0.27, 0.085, (-0.17, 0.08, 0)),
        cylinder("x", -0.435, 0.14, 0.095, (0, -0.235, -0.035)),
    ]
    return shapes, parts


def _lower_arm(length: float) -> tuple[Shapes, Parts]:
    y0, y1 = -0.325, -0.155
    casting = slab("xz", [(0, 0, 0.20), (0.30, 0, 0.165), (length, 0, 0.145)], y0, y1, 0.03)
    rib = slab("xz", [(0.27, 0, 0.085), (length - 0.24, 0, 0.07)], y0 - 0.012, y0 + 0.02, 0.01)
    covers = rod("y", y0 - 0.025, y0 + 0.02, 0.15, (0, 0, 0), 0.012) + rod(
        "y", y0 - 0.025, y0 + 0.02, 0.11, (length, 0, 0), 0.012
    )
    hoses = rod("x", 0.25, length - 0.2, 0.022, (0, y1 + 0.02, 0.09), 0.004) + rod(
        "x", 0.25, length - 0.2, 0.022, (0, y1 + 0.02, 0.04), 0.004
    )
    shapes = {
        "orange": casting,
        "grey": rib,
        "dark": covers + hoses,
        "steel": bolts("y", y0 - 0.025, 0.12, 10, -0.011)
        + bolts("y", y0 - 0.025, 0.085, 8, -0.01, (length, 0, 0)),
    }
    parts = [
        box((0.0, y0 - 0.03, -0.165), (length, y1 + 0.042, 0.165)),
        cylinder("y", y0 - 0.035, y1, 0.20, (0, 0, 0)),
        cylinder("y", y0 - 0.035, y1, 0.15, (length, 0, 0)),
    ]
    return shapes, parts


def _elbow(offset: float) -> tuple[Shapes, Parts]:
    z = -offset
    house = slab("xz", [(0, 0, 0.165), (0.16, z, 0.165), (-0.16, 0.02, 0.13)], -0.14, 0.17, 0.03)
    front = lathe("x", [(0.12, 0.15), (0.30, 0.17), (0.40, 0.16), (0.425, 0.145)], (0, 0, z))
    motors = Mesh()
    caps = Mesh()
    for y, up, r in ((-0.065, 0.085, 0.062), (0.10, 0.085, 0.062), (0.02, -0.055, 0.062)):
        motors = motors + rod("x", -0.44, -0.25, r, (0, y, up), 0.012)
        caps = caps + rod("x", -0.50, -0.44, r * 0.8, (0, y, up), 0.01)
    shapes = {
        "orange": house + front,
        "dark": motors
        + rod("y", 0.165, 0.36, 0.095, (0, 0, 0))
        + lathe("x", [(0.425, 0.125), (0.45, 0.125)], (0, 0, z)),
        "grey": caps
        + rod("y", -0.155, -0.13, 0.125, (0, 0, 0))
        + rod("y", 0.36, 0.42, 0.075, (0, 0, 0)),
        "steel": bolts("x", 0.405, 0.135, 14, 0.009, (0, 0, z)),
    }
    parts = [
        box((-0.29, -0.14, -0.13), (0.12, 0.17, 0.165)),
        cylinder("x", 0.10, 0.44, 0.17, (0, 0, z)),
        box((-0.50, -0.13, -0.12), (-0.25, 0.165, 0.15)),
        cylinder("y", 0.17, 0.42, 0.095, (0, 0, 0)),
        cylinder("y", -0.155, 0.17, 0.165, (0, 0, 0)),
    ]
    return shapes, parts


def _forearm(length: float) -> tuple[Shapes, Parts]:
    end = length - 0.24
    tube = lathe(
        "x",
        [
            (0.45, 0.135),
            (0.50, 0.15),
            (0.58, 0.145),
            (end - 0.05, 0.105),
            (end, 0.115),
            (end + 0.03, 0.115),
        ],
    )
    cheeks = Mesh()
    caps = Mesh()
    for side in (-1.0, 1.0):
        y = sorted((side * 0.085, side * 0.135))
        cheeks = cheeks + slab("xz", [(end - 0.02, 0, 0.10), (length, 0, 0.085)], y[0], y[1], 0.014)
        y = sorted((side * 0.13, side * 0.15))
        caps = caps + rod("y", y[0], y[1], 0.06, (length, 0, 0), 0.006)
    yoke = slab(
        "xy",
        [(end - 0.03, 0, 0.12), (end + 0.05, -0.05, 0.075), (end + 0.05, 0.05, 0.075)],
        -0.095,
        0.095,
        0.02,
    )
    shapes = {
        "orange": tube + cheeks + yoke,
        "dark": caps
        + rod("x", 0.60, end - 0.05, 0.02, (0, 0, 0.145), 0.004)
        + block((0.60, -0.03, 0.11), (0.66, 0.03, 0.155), 0.01),
        "steel": bolts("x", 0.50, 0.142, 12, -0.008),
    }
    parts = [
        cylinder("x", 0.45, end + 0.10, 0.15, (0, 0, 0)),
        box((end, -0.15, -0.105), (length, -0.085, 0.105)),
        box((end, 0.085, -0.105), (length, 0.15, 0.105)),
        cylinder("y", -0.15, -0.085, 0.09, (length, 0, 0)),
        cylinder("y", 0.085, 0.15, 0.09, (length, 0, 0)),
    ]
    return shapes, parts


def _wrist() -> tuple[Shapes, Parts]:
    hub = rod("y", -0.08, 0.08, 0.082, (0, 0, 0), 0.014)
    snout = lathe("x", [(0.0, 0.078), (0.08, 0.078), (0.13, 0.084), (0.165, 0.084), (0.175, 0.074)])
    shapes = {"orange": hub + snout, "dark": lathe("x", [(0.175, 0.068), (0.186, 0.068)])}
    parts = [
        cylinder("y", -0.08, 0.08, 0.083, (0, 0, 0)),
        cylinder("x", 0.0, 0.186, 0.085, (0, 0, 0)),
    ]
    return shapes, parts


def _flange_disc() -> tuple[Shapes, Parts]:
    disc = lathe("x", [(0.186, 0.07), (0.190, 0.08), (0.211, 0.08), (0.215, 0.076)])
    return {"steel": disc}, [cylinder("x", 0.186, 0.215, 0.08, (0, 0, 0))]


def _drill() -> dict[str, tuple[Shapes, Parts]]:
    """Drilling and riveting head: spindle and feed, rivet feeder, camera with ring light, nose."""
    plate = rod("z", 0.0, 0.025, 0.105, (0, 0, 0), 0.006)
    frame = block((-0.10, -0.085, 0.025), (0.10, 0.085, 0.27), 0.025, 0.012)
    spindle = rod("z", 0.05, 0.30, 0.05, (0.135, 0, 0), 0.01)
    feed = block((-0.15, -0.06, 0.06), (-0.09, 0.06, 0.24), 0.012)
    coil = rod("x", -0.035, 0.035, 0.055, (0.0, 0.13, 0.11), 0.01)
    hopper = rod("y", 0.08, 0.10, 0.04, (0, 0, 0.11), 0.004)
    camera = block((-0.045, -0.165, 0.13), (0.045, -0.09, 0.27), 0.012)
    light = lathe("z", [(0.27, 0.052), (0.285, 0.058), (0.295, 0.058)], (0, -0.127, 0))
    lens = rod("z", 0.28, 0.305, 0.028, (0, -0.127, 0), 0.003)
    collar = lathe("z", [(0.27, 0.075), (0.30, 0.075), (0.315, 0.062)])
    body = {
        "grey": plate + collar,
        "blue": frame,
        "dark": spindle + feed + camera + hopper,
        "yellow": coil,
        "steel": light + bolts("z", 0.025, 0.09, 8, 0.008),
        "glass": lens,
    }
    nose = lathe(
        "z",
        [(0.315, 0.05), (0.36, 0.046), (0.375, 0.036), (0.45, 0.026)],
    )
    tip = lathe("z", [(0.45, 0.026), (0.485, 0.017), (0.5, 0.013)])
    ring = lathe("z", [(0.375, 0.040), (0.385, 0.040)])
    return {
        "body": (
            body,
            [
                box((-0.15, -0.09, 0.0), (0.10, 0.09, 0.27)),
                cylinder("z", 0.05, 0.30, 0.05, (0.135, 0, 0)),
                box((-0.06, -0.185, 0.13), (0.06, -0.09, 0.305)),
                cylinder("x", -0.035, 0.035, 0.055, (0, 0.13, 0.11)),
                cylinder("z", 0.27, 0.315, 0.075, (0, 0, 0)),
            ],
        ),
        "nose": (
            {"steel": nose, "brass": ring},
            [
                cylinder("z", 0.315, 0.385, 0.05, (0, 0, 0)),
                cylinder("z", 0.385, 0.45, 0.036, (0, 0, 0)),
            ],
        ),
        "tip": ({"steel": tip}, [cylinder("z", 0.45, 0.50, 0.026, (0, 0, 0))]),
    }


def _counterpoint() -> dict[str, tuple[Shapes, Parts]]:
    """Counterpoint: a pneumatic cylinder with guide rods that presses a slender anvil to the skin."""
    plate = rod("z", 0.0, 0.025, 0.105, (0, 0, 0), 0.006)
    press = rod("z", 0.025, 0.27, 0.07, (0, 0, 0), 0.012)
    valve = block((-0.12, -0.045, 0.07), (-0.06, 0.045, 0.22), 0.01)
    rods = Mesh()
    for x, y in ((0.055, 0.06), (0.055, -0.06), (-0.075, 0.06), (-0.075, -0.06)):
        rods = rods + rod("z", 0.025, 0.30, 0.010, (x, y, 0), 0.002)
    head = block((-0.09, -0.08, 0.27), (0.075, 0.08, 0.305), 0.02, 0.006)
    body = {
        "grey": plate + head,
        "blue": press,
        "dark": valve,
        "steel": rods + bolts("z", 0.025, 0.09, 8, 0.008),
        "yellow": lathe("z", [(0.14, 0.0715), (0.165, 0.0715)]),
    }
    nose = lathe(
        "z",
        [(0.305, 0.040), (0.40, 0.034), (0.42, 0.024), (0.45, 0.022)],
    )
    return {
        "body": (
            body,
            [
                cylinder("z", 0.0, 0.025, 0.105, (0, 0, 0)),
                cylinder("z", 0.025, 0.27, 0.072, (0, 0, 0)),
                box((-0.12, -0.08, 0.025), (0.075, 0.08, 0.305)),
            ],
        ),
        "nose": (
            {"steel": nose, "brass": lathe("z", [(0.405, 0.036), (0.415, 0.036)])},
            [
                cylinder("z", 0.305, 0.42, 0.040, (0, 0, 0)),
                cylinder("z", 0.42, 0.45, 0.024, (0, 0, 0)),
            ],
        ),
        "tip": (
            {"steel": lathe("z", [(0.45, 0.022), (0.492, 0.018), (0.5, 0.013)])},
            [cylinder("z", 0.45, 0.50, 0.022, (0, 0, 0))],
        ),
    }


def _vacuum_gripper() -> dict[str, tuple[Shapes, Parts]]:
    """Vacuum gripper: a mounting plate, an ejector with its hose, a mast, and one suction cup."""
    body = {
        "grey": rod("z", 0.0, 0.02, 0.09, (0, 0, 0), 0.005)
        + block((-0.05, -0.05, 0.02), (0.05, 0.05, 0.075), 0.012, 0.004),
        "dark": block((0.05, -0.025, 0.025), (0.085, 0.025, 0.07), 0.006),
        "blue": rod("y", 0.05, 0.075, 0.008, (0.0, 0.0, 0.05), 0.002),
        "steel": bolts("z", 0.02, 0.075, 6, 0.007),
    }
    mast = rod("z", 0.075, 0.16, 0.016, (0, 0, 0), 0.003)
    cup = lathe("z", [(0.15, 0.018), (0.165, 0.028), (0.172, 0.021), (0.184, 0.033), (0.2, 0.038)])
    return {
        "body": (
            body,
            [
                cylinder("z", 0.0, 0.02, 0.09, (0, 0, 0)),
                box((-0.05, -0.05, 0.02), (0.085, 0.075, 0.075)),
            ],
        ),
        "nose": ({"steel": mast}, [cylinder("z", 0.075, 0.15, 0.016, (0, 0, 0))]),
        "tip": ({"dark": cup}, [cylinder("z", 0.15, 0.20, 0.038, (0, 0, 0))]),
    }


def _arm(spec: ArmSpec, out: dict[str, str]) -> None:
    long = f"{round(spec.d4 * 1000)}"
    links = [
        link_text("base_link", "base", "", _base(), out),
        link_text("link_1", "link_1", "", _column(), out),
        link_text("link_2", "link_2", "", _lower_arm(spec.a2), out),
        link_text("link_3", "link_3", "", _elbow(spec.offset), out),
        link_text("link_4", f"link_4_{long}", "", _forearm(spec.d4), out),
        link_text("link_5", "link_5", "", _wrist(), out),
        link_text("link_6", "link_6", "", _flange_disc(), out),
        link_text("flange", "", "", None, out),
    ]
    places = [
        (0.0, 0.0, spec.d1),
        (spec.a1, 0.0, 0.0),
        (spec.a2, 0.0, 0.0),
        (0.0, 0.0, -spec.offset),
        (spec.d4, 0.0, 0.0),
        (0.0, 0.0, 0.0),
    ]
    joints = []
    for i, place in enumerate(places):
        low, high = (math.radians(v) for v in spec.limits[i])
        parent = f"link_{i}" if i else "base_link"
        joints.append(
            f'  <joint name="joint_{i + 1}" type="revolute">{origin(place, "0 0 0")}'
            f'<parent link="{parent}"/><child link="link_{i + 1}"/><axis xyz="{_AXIS[i]}"/>\n'
            f'    <limit lower="{low!r}" upper="{high!r}" effort="0" '
            f'velocity="{math.radians(spec.speeds[i])!r}"/></joint>\n'
        )
    flange = fixed("mount", "link_6", "flange", origin((spec.d6, 0, 0), f"0 {math.pi / 2!r} 0"))
    # Never tested against each other: neighbours, and what meets in the wrist.
    ignore = '  <pn2code ignore="link_4+link_6 link_4+flange"/>\n'
    out[f"{spec.name}.urdf"] = (
        f'{HEAD}<robot name="{spec.name}">\n{materials(("orange", "dark", "grey", "steel"))}'
        f"{''.join(links)}{''.join(joints)}{flange}{ignore}</robot>\n"
    )


def _tool(
    name: str, tcp: float, links: dict[str, tuple[Shapes, Parts]], out: dict[str, str]
) -> None:
    text = [
        link_text(part, f"{name}_{part}", "../", content, out) for part, content in links.items()
    ]
    text += ['  <link name="tcp"/>\n', fixed("nose_mount", "body", "nose")]
    text += [fixed("tip_mount", "nose", "tip")]
    text += [fixed("tcp_mount", "tip", "tcp", origin((0, 0, tcp), "0 0 0"))]
    used = sorted({c for shapes, _ in links.values() for c in shapes})
    out[f"tools/{name}.urdf"] = (
        f'{HEAD}<robot name="{name}">\n{materials(used)}{"".join(text)}'
        "  <!-- Only the last 50 mm may touch the work piece. -->\n"
        '  <pn2code contact="tip"/>\n</robot>\n'
    )


def files() -> dict[str, str]:
    """Every file of the folder: relative name -> text."""
    out: dict[str, str] = {}
    for spec in ARMS:
        _arm(spec, out)
    cobots(out)
    spherical(out)
    chains(out)
    _tool("drill_riveter", 0.5, _drill(), out)
    _tool("counterpoint", 0.5, _counterpoint(), out)
    _tool("vacuum_gripper", 0.2, _vacuum_gripper(), out)
    return dict(sorted(out.items()))


def main() -> None:
    """Writes them beside this module."""
    for name, text in files().items():
        (Path(__file__).parent / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
