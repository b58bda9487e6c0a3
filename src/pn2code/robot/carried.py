"""An arm with its external axes as one tree of links, and its kinematics.

arm = with_axes(arm, axes, "left", at, d)           # tracks between the stand and the arm, turntables beside it
kinematics = WithAxes(own, axes, arm)               # `own`: of the arm alone, from its own base

The frame `base` is that of `base` in cell.toml, where the arm is with its tracks at zero. It stands still.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence

import numpy as np
from lxml import etree
from numpy.typing import ArrayLike

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot import codes, urdf
from pn2code.robot.commands import Pose
from pn2code.robot.external import ExternalAxis, Externals
from pn2code.robot.kinematics import Branch, Conditioning, Kinematics, Solution
from pn2code.robot.model import Arm
from pn2code.robot.scene_objects import SceneObject
from pn2code.robot.transforms import Array, inverse, pose_of

STAND = "stand"
"""The link that holds all: it has no shape."""
_PLATE = (0.45, 0.47, 0.5, 1.0)


def with_axes(arm: Arm, axes: Externals, robot: str, at: Origin, d: Diagnostics) -> Arm | None:
    """The arm on its tracks, with its turntables; None when something was reported."""
    own = {*arm.urdf.links, *(j.name for j in arm.urdf.joints)}
    for name in (STAND, *(a.name for a in axes)):
        if name in own or name.startswith("tool_") or (name == STAND and axes.axis(name)):
            d.error(
                codes.ROBOT_VALUE,
                f"an external axis of robot `{robot}` cannot be called `{name}`: its model `{arm.name}` has a part "
                "of that name",
                at,
                hint="choose another name",
            )
            return None
    return joined(arm, axes)


def joined(arm: Arm, axes: Externals) -> Arm:
    """The same, with axes whose names are known to be free."""
    tree = urdf.tree_of(arm.urdf.path, _tree(arm, axes))
    chain = tree.chain(arm.flange)
    return Arm(
        arm.name,
        tree,
        arm.flange,
        chain,
        np.array([*(a.lower for a in axes.tracks), *arm.lower, *(a.lower for a in axes.tables)]),
        np.array([*(a.upper for a in axes.tracks), *arm.upper, *(a.upper for a in axes.tables)]),
        np.array(
            [*(a.velocity for a in axes.tracks), *arm.velocity, *(a.velocity for a in axes.tables)]
        ),
        tuple(a.name for a in axes.tables),
        len(axes.tracks),
    )


def _tree(arm: Arm, axes: Externals) -> etree._Element:
    out: etree._Element = copy.deepcopy(arm.urdf.xml)
    etree.SubElement(out, "link", name=STAND)
    last = STAND
    for axis in axes.tracks:
        etree.SubElement(out, "link", name=axis.name)
        joint = add_joint(out, axis.name, "prismatic", last, axis.name, Pose(0, 0, 0, 0, 0, 0))
        etree.SubElement(joint, "axis", xyz=axis_words(axis.direction))
        add_limit(joint, axis.lower, axis.upper, axis.velocity)
        last = axis.name
    add_joint(out, f"{STAND}_mount", "fixed", last, arm.urdf.root, Pose(0, 0, 0, 0, 0, 0))
    for axis in axes.tables:
        link = etree.SubElement(out, "link", name=axis.name)
        for number, thing in enumerate((plate_of(axis), *axis.objects)):
            add_shape(link, thing, f"{axis.name}_{number}")
        place = pose_of(axis.T_base_axis)
        joint = add_joint(out, axis.name, "revolute", STAND, axis.name, place)
        etree.SubElement(joint, "axis", xyz=axis_words(axis.direction))
        add_limit(joint, axis.lower, axis.upper, axis.velocity)
    return out


def plate_of(axis: ExternalAxis) -> SceneObject:
    """The plate of a turntable, in its frame: its top is at z = 0."""
    return SceneObject(
        axis.name,
        "cylinder",
        Pose(0, 0, -axis.height / 2.0, 0, 0, 0),
        radius=axis.radius,
        length=axis.height,
        colour=_PLATE,
    )


def add_joint(
    out: etree._Element, name: str, kind: str, parent: str, child: str, place: Pose
) -> etree._Element:
    """A joint between two links, without its axis and limits."""
    joint = etree.SubElement(out, "joint", name=name, type=kind)
    _origin(joint, place)
    etree.SubElement(joint, "parent", link=parent)
    etree.SubElement(joint, "child", link=child)
    return joint


def add_limit(joint: etree._Element, lower: float, upper: float, velocity: float) -> None:
    """The limits of a joint."""
    etree.SubElement(
        joint,
        "limit",
        lower=repr(float(lower)),
        upper=repr(float(upper)),
        velocity=repr(float(velocity)),
        effort="0",
    )


def _origin(element: etree._Element, place: Pose) -> None:
    xyz = axis_words((place.x, place.y, place.z))
    etree.SubElement(element, "origin", xyz=xyz, rpy=axis_words((place.rx, place.ry, place.rz)))


def axis_words(values: Sequence[float] | Array) -> str:
    """Numbers in URDF."""
    return " ".join(repr(float(v)) for v in values)


def add_shape(link: etree._Element, thing: SceneObject, name: str) -> None:
    """What is seen of a thing, and what distances are measured to."""
    for tag in ("visual", "collision"):
        element = etree.SubElement(link, tag)
        _origin(element, thing.pose)
        geometry = etree.SubElement(element, "geometry")
        if thing.kind == "box":
            etree.SubElement(geometry, "box", size=axis_words(thing.size))
        elif thing.kind == "cylinder":
            etree.SubElement(
                geometry, "cylinder", radius=repr(thing.radius), length=repr(thing.length)
            )
        else:
            mesh = etree.SubElement(
                geometry,
                "mesh",
                filename=str(thing.mesh.resolve() if thing.mesh else ""),
                scale=axis_words([thing.scale] * 3),
            )
            if thing.hulls > 1:
                mesh.set(urdf.HULLS, str(thing.hulls))
        if tag == "visual":
            material = etree.SubElement(element, "material", name=name)
            etree.SubElement(material, "color", rgba=axis_words(thing.colour))


class WithAxes(Kinematics):
    """Kinematics of an arm with external axes: joint positions have them all.

    Args:
        own: of the arm alone, from its own base, which its tracks carry.
        axes: external ones.
        arm: with them.
    """

    def __init__(self, own: Kinematics, axes: Externals, arm: Arm) -> None:
        super().__init__(arm, own.T_flange_tcp, own._chain, own._form)
        self.alone = own
        self.axes = axes
        first = len(axes.tracks)
        self.joints = slice(first, first + len(own.arm.lower))

    # Parts of a joint position

    def shifts(self, q: Array) -> Array:
        """How far the tracks carry the arm, in the base frame: (n, 3)."""
        return np.asarray(q[:, : len(self.axes.tracks)] @ self.axes.directions)

    def T_base_arm(self, q: ArrayLike) -> Array:  # noqa: N802
        """The arm's own base."""
        out = np.eye(4)
        out[:3, 3] = self.shifts(np.asarray(q, float)[None])[0]
        return out

    def T_base_table(self, index: int, value: float) -> Array:  # noqa: N802
        """A turntable, by its index among the axes, at a position."""
        return self.axes.tables[index - self.joints.stop].at(value)

    def whole(self, q: Array, joints: Array) -> Array:
        """A joint position with other joints of the arm."""
        out = np.array(q, float)
        out[self.joints] = joints
        return out

    # Forward

    def forward_many(self, q: Array) -> Array:
        """`T_base_tcp`."""
        out = self.alone.forward_many(q[:, self.joints])
        out[:, :3, 3] += self.shifts(q)
        return out

    def link_frames(self, q: Array) -> list[Array]:
        """`T_base_axis` of each axis, after its own motion, and of the flange."""
        count = len(q)
        out = []
        carried = np.zeros((count, 3))
        for i, axis in enumerate(self.axes.tracks):
            carried = carried + q[:, i, None] * axis.direction
            frame = np.repeat(np.eye(4)[None], count, axis=0)
            frame[:, :3, 3] = carried
            out.append(frame)
        *joints, flange = [np.array(f) for f in self.alone.link_frames(q[:, self.joints])]
        for frame in (*joints, flange):
            frame[:, :3, 3] += carried
        out += joints
        out += [axis.at(q[:, self.joints.stop + i]) for i, axis in enumerate(self.axes.tables)]
        return [*out, flange]

    def joint_frames(self, q: ArrayLike) -> Array:
        """The same of one joint position."""
        return np.stack([f[0] for f in self.link_frames(np.asarray(q, float)[None])])

    def axes_of(self, frames: Sequence[Array]) -> Array:
        """Directions of all axes in the base frame."""
        count = len(frames[0])
        tracks = [np.repeat(a.direction[None], count, axis=0) for a in self.axes.tracks]
        own = self.alone.axes_of([*frames[self.joints], frames[-1]])
        joints = [own[:, i] for i in range(own.shape[1])]
        tables = [
            np.repeat((a.T_base_axis[:3, :3] @ a.direction)[None], count, axis=0)
            for a in self.axes.tables
        ]
        return np.stack([*tracks, *joints, *tables], axis=1)

    # Of the arm alone

    def _closed_form(self, T_base_tcp: Array, arm_angle: Array | None = None) -> Array:
        raise AssertionError(
            "the inverse is that of the arm alone: where its tracks stand is not known"
        )

    def jacobian_many(self, q: Array) -> Array:
        """That of the joints of the arm."""
        return self.alone.jacobian_many(q[:, self.joints])

    def conditioning_many(self, q: Array) -> list[Conditioning]:
        """That of the arm, with its external axes standing."""
        return self.alone.conditioning_many(q[:, self.joints])

    def states(self, q: Array) -> tuple[Array, list[Conditioning]]:
        """`T_base_tcp`, and the conditioning of the arm."""
        return self.forward_many(q), self.conditioning_many(q)

    def arm_angle_of(self, q: ArrayLike) -> float | None:
        """That of the arm."""
        return self.alone.arm_angle_of(np.asarray(q, float)[self.joints])

    def branch_of(self, q: ArrayLike) -> Branch:
        """The branch of the arm."""
        return self.alone.branch_of(np.asarray(q, float)[self.joints])

    def nearest(
        self,
        T_base_tcp: Array,
        reference: ArrayLike,
        branch: Branch | None = None,
        arm_angle: float | None = None,
    ) -> Solution | None:
        """As of the arm, with the external axes where they are in `reference`."""
        q = np.asarray(reference, float)
        target = inverse(self.T_base_arm(q)) @ T_base_tcp
        found = self.alone.nearest(target, q[self.joints], branch, arm_angle)
        return None if found is None else Solution(found.branch, self.whole(q, found.q))

    def limit_margin(self, q: ArrayLike) -> tuple[float, int]:
        """Of the joints of the arm; of an external axis only where it is outside."""
        q = np.asarray(q, float)
        margins = self.arm.margins(q)
        outside = np.array(margins)
        outside[self.joints] = np.inf
        if outside.min() < -1e-9:
            return float(outside.min()), int(np.argmin(outside))
        own, axis = self.alone.limit_margin(q[self.joints])
        return own, self.joints.start + axis
