"""A cell's bodies in PyBullet: an arm with its tool, what stands in the scene, parts; made from URDF texts."""

from __future__ import annotations

import ctypes
import os
import sys
import tempfile
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from lxml import etree

from pn2code.base.frozen import record
from pn2code.robot import collision_meshes, urdf
from pn2code.robot.commands import Pose
from pn2code.robot.geometry import Body, Solid, body_of
from pn2code.robot.looks import Look
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.tools_table import ToolKind
from pn2code.robot.transforms import Array

_PAD = 0.004  # m: PyBullet has margins around shapes


@contextmanager
def silent() -> Iterator[None]:
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
class LoadedRobot:
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
class LoadedBody:
    """A scene body in PyBullet."""

    body: Body
    id: int


class BulletWorld:
    """PyBullet with its bodies, without a window or with one.

    Attributes:
        p: the module; client: the number of the connection.
        points: `getClosestPoints` of this connection.
    """

    def __init__(self, gui: bool) -> None:
        with silent():
            import pybullet

            self.p: Any = pybullet
            self.client: int = pybullet.connect(pybullet.GUI if gui else pybullet.DIRECT)
        if self.client < 0:
            raise RuntimeError("PyBullet cannot open its window; is there a display?")
        self.points: Callable[..., Sequence[Any]] = partial(
            pybullet.getClosestPoints, physicsClientId=self.client
        )
        self._folder = tempfile.TemporaryDirectory(prefix="pn2code-")

    def place(self, body: int, pose: Pose) -> None:
        """Puts the base of a body somewhere."""
        self.p.resetBasePositionAndOrientation(
            body,
            (pose.x, pose.y, pose.z),
            self.p.getQuaternionFromEuler((pose.rx, pose.ry, pose.rz)),
            physicsClientId=self.client,
        )

    def remove(self, body: int) -> None:
        """The body is there no more."""
        self.p.removeBody(body, physicsClientId=self.client)

    def load_urdf(self, name: str, text: str, *, fixed: bool = True, looks: bool = True) -> int:
        """Loads a URDF text; its number. `looks`: with what is only seen."""
        path = Path(self._folder.name) / f"{name.replace('/', '_')}.urdf"
        folder = Path(self._folder.name)
        read = urdf.for_bullet(
            text, looks, lambda mesh, most: collision_meshes.for_bullet(mesh, most, folder)
        )
        path.write_text(read, encoding="utf-8")
        # Implicit cylinders: as hulls of 32 sides they would be up to 1 mm too thin.
        return int(
            self.p.loadURDF(
                str(path),
                useFixedBase=fixed,
                flags=self.p.URDF_USE_IMPLICIT_CYLINDER,
                physicsClientId=self.client,
            )
        )

    def load_robot(self, robot: CellRobot, looks: bool) -> LoadedRobot:
        """An arm with its tool, or a device, at its base."""
        tree = robot.arm.urdf
        text = urdf.with_tool(tree, robot.arm.flange, robot.tool.urdf if robot.tool else None)
        body = self.load_urdf(robot.name, text, looks=looks)
        self.place(body, robot.base)
        root, links, joints, parents = tree.root, {-1: tree.root}, {}, {}
        for i in range(self.p.getNumJoints(body, physicsClientId=self.client)):
            info = self.p.getJointInfo(body, i, physicsClientId=self.client)
            links[i] = info[12].decode()
            joints[info[1].decode()] = i
            parents[i] = (info[16], info[2] == self.p.JOINT_FIXED)
        index = {name: i for i, name in links.items()}
        assert index[root] == -1
        tables = {index[name] for name in robot.arm.tables}
        pairs = _self_pairs(links, parents, tree.self_ignore, tables)
        return LoadedRobot(
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

    def load_body(self, body: Body, looks: bool) -> LoadedBody:
        """What stands in the scene."""
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
        return LoadedBody(body, self.load_urdf(body.name, "\n".join(lines)))

    def load_kind(self, kind: PartKind | ToolKind, name: str, looks: bool) -> int:
        """A part or tool, as one body without joints."""
        if isinstance(kind, PartKind):
            return self.load_body(body_of(replace(kind.shape, name=name)), looks).id
        text = urdf.as_one_link(kind.tool.urdf)
        return self.load_urdf(name, text, looks=looks)

    def box(self, loaded: LoadedRobot, link: str) -> tuple[Array, Array] | None:
        """The corners of a box around a link's collision shapes in its frame, a little too large; None: it has none."""
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
        with silent():
            body = self.load_urdf(f"box_{loaded.robot.name}_{link}", "\n".join(lines))
        return self._around(body)

    def part_box(self, kind: PartKind | ToolKind) -> tuple[Array, Array]:
        """The same around a part of a kind, or a tool, in its frame."""
        with silent():
            body = self.load_kind(kind, f"box_{kind.name}", False)
        return self._around(body)

    def _around(self, body: int) -> tuple[Array, Array]:
        low, high = self.p.getAABB(body, -1, physicsClientId=self.client)
        self.remove(body)
        return np.array(low) - _PAD, np.array(high) + _PAD

    def close(self) -> None:
        """Disconnects and removes the temporary files."""
        if self.client >= 0:
            with silent():
                self.p.disconnect(self.client)
            self.client = -1
            self._folder.cleanup()


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
