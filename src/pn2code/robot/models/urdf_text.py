"""What models are written with: links, joints, shapes and colours of URDF."""

from __future__ import annotations

import math
from collections.abc import Sequence

from pn2code.robot.models.shapes import Mesh

COLOURS = {
    "orange": "0.93 0.38 0.07 1",
    "dark": "0.13 0.14 0.16 1",
    "grey": "0.45 0.47 0.50 1",
    "steel": "0.76 0.78 0.80 1",
    "blue": "0.10 0.30 0.55 1",
    "glass": "0.05 0.12 0.20 1",
    "brass": "0.80 0.62 0.28 1",
    "yellow": "0.95 0.76 0.10 1",
    "silver": "0.78 0.80 0.82 1",
    "sky": "0.42 0.62 0.80 1",
}


UPRIGHT = {"x": f"0 {math.pi / 2} 0", "y": f"{math.pi / 2} 0 0", "z": "0 0 0"}

Shapes = dict[str, Mesh]
Parts = list[str]


def origin(at: Sequence[float], rpy: str) -> str:
    """An `<origin>`: m, and angles in rad as text."""
    return f'<origin xyz="{" ".join(f"{v:.6g}" for v in at)}" rpy="{rpy}"/>'


def box(low: Sequence[float], high: Sequence[float]) -> str:
    """The collision shape of a box between two corners."""
    size = [b - a for a, b in zip(low, high, strict=True)]
    centre = [(a + b) / 2 for a, b in zip(low, high, strict=True)]
    text = " ".join(f"{v:.6g}" for v in size)
    return f'{origin(centre, "0 0 0")}<geometry><box size="{text}"/></geometry>'


def cylinder(axis: str, start: float, end: float, radius: float, at: Sequence[float]) -> str:
    """The collision shape of a cylinder along an axis through a point."""
    centre = list(at)
    centre["xyz".index(axis)] += (start + end) / 2
    return (
        f"{origin(centre, UPRIGHT[axis])}<geometry>"
        f'<cylinder radius="{radius:.6g}" length="{end - start:.6g}"/></geometry>'
    )


def link_text(
    name: str, stem: str, folder: str, content: tuple[Shapes, Parts] | None, out: dict[str, str]
) -> str:
    """A link with its looks, whose meshes become files in `out`, and its collision shapes; None: an empty one."""
    if content is None:
        return f'  <link name="{name}"/>\n'
    shapes, parts = content
    lines = [f'  <link name="{name}">']
    for colour, mesh in shapes.items():
        file = f"meshes/{stem}_{colour}.obj"
        out[file] = mesh.obj()
        lines.append(
            f'    <visual><geometry><mesh filename="{folder}{file}"/></geometry>'
            f'<material name="{colour}"/></visual>'
        )
    lines += [f"    <collision>{part}</collision>" for part in parts]
    return "\n".join([*lines, "  </link>\n"])


def materials(used: Sequence[str]) -> str:
    """The materials of some colours."""
    return "".join(
        f'  <material name="{c}"><color rgba="{COLOURS[c]}"/></material>\n' for c in used
    )


def fixed(name: str, parent: str, child: str, origin: str = "") -> str:
    """A joint that does not move."""
    return (
        f'  <joint name="{name}" type="fixed">{origin}<parent link="{parent}"/>'
        f'<child link="{child}"/></joint>\n'
    )


HEAD = '<?xml version="1.0"?>\n<!-- Made by pn2code.robot.models.build; change that. -->\n'


def held(where: str) -> str:
    """A comment that says against what the numbers of an arm were held."""
    return f"  <!-- Held against: {where}. -->\n"
